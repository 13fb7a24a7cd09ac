"""Runs what is missing of the studies: two at a time, cheapest first, each once per state of the sources."""
from __future__ import annotations

import argparse
import datetime
import hashlib
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import computer
import results
from run import ROOT, Program, Run, cheapest_first, list_runs

# Exit status of our programs when an argument is wrong, and when the library does not have what was asked for.
REFUSED, UNSUPPORTED = 2, 3
QUICK = 15.0  # CPU s, estimated: what a quick pass leaves out

LIBRARY_SOURCES = ("include/**/*.h", "src/**/*.?pp")


def source_hash(root: Path, program: Program) -> str:
    """Of all that a program's numbers depend on: the library's sources and its own."""
    digest = hashlib.sha256()
    for pattern in LIBRARY_SOURCES + program.sources:
        for path in sorted(root.glob(pattern)):
            digest.update(str(path.relative_to(root)).encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def commit_of(root: Path) -> str:
    """Of the working tree; with a plus sign if it has changes, but in docs: reports write these. Empty outside a repository."""
    if not shutil.which("git"):
        return ""

    def git(*arguments: str) -> str:
        return subprocess.run(["git", *arguments], cwd=root, capture_output=True, text=True, check=False).stdout.strip()

    changed = git("status", "--porcelain", "--untracked-files=no", "--", ":/", ":(top,exclude)docs")
    return git("describe", "--always") + ("+" if changed else "")


def execute(run: Run, program: Program, build: Path) -> dict[str, Any]:
    """Calls the program. What goes wrong becomes part of the result."""
    path = (ROOT if program.script else build.resolve()) / program.path
    data: dict[str, Any] = {
        "name": run.name,
        "program": run.program,
        "arguments": run.arguments,
        "summary": {},
        "tables": {},
        "output": "",
        "message": "",
    }
    if not path.exists():
        return {**data, "status": "missing", "message": f"there is no program {run.program}"}
    with tempfile.TemporaryDirectory() as scratch:
        prefix = Path(scratch) / "run"
        command = [str(path), *run.arguments]
        if program.script:
            command = [sys.executable, str(path), "--build", str(build.resolve()), *run.arguments]
        if program.records:
            command += ["--output", str(prefix)]
        begin = time.monotonic()
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=scratch)
        data["wall_seconds"] = time.monotonic() - begin
        data["output"] = done.stdout
        data["message"] = (done.stderr.strip().splitlines() or [""])[-1]
        if done.returncode == 0:
            data.update(status="ok", summary=results.read_summary(done.stdout), tables=results.read_tables(prefix))
            if "cpu_seconds" not in data["summary"]:
                data.update(status="failed", message="its summary has no cpu_seconds")
        elif done.returncode == REFUSED and program.refuses:
            data["status"] = "missing"  # a case that this program does not have
        else:
            data["status"] = "unsupported" if done.returncode == UNSUPPORTED else "failed"
    return data


class Progress:
    """Counts what is done and estimates what is left from the speed so far."""

    def __init__(self, runs: list[Run], workers: int):
        self.lock = threading.Lock()
        self.total, self.workers = len(runs), workers
        self.left = sum(run.cost for run in runs)
        self.done, self.estimated, self.spent = 0, 0.0, 0.0

    def finished(self, run: Run, data: dict[str, Any]) -> None:
        with self.lock:
            self.done += 1
            self.left -= run.cost
            if data["status"] == "ok":
                self.estimated += run.cost
                self.spent += data["wall_seconds"]
            pace = self.spent / self.estimated if self.estimated > 0 else 1.0
            what = (
                f"{data['summary']['cpu_seconds']:.1f} CPU s"
                if data["status"] == "ok"
                else f"{data['status']}: {data['message']}"
            )
            print(
                f"[{self.done}/{self.total}] {run.name}: {what}; about "
                f"{self.left * pace / self.workers / 60:.0f} min left",
                flush=True,
            )


def is_current(run: Run, directory: Path, source: str, accept_older: bool) -> bool:
    """Whether there is a good result of the same options from the same sources."""
    data = results.load_raw(run, directory)
    return (
        data is not None
        and data["status"] == "ok"
        and tuple(data["arguments"]) == run.arguments
        and (accept_older or data["source"] == source)
    )


def run_missing(
    studies: dict[str, list[Run]], programs: dict[str, Program], directory: Path, about: str, workers: int = 2
) -> int:
    """The command line of a report's runner: its exit status. directory, workers: where results go and how many runs go
    at a time, by default."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--build", type=Path, default=ROOT / "build", help="where the programs are [build]")
    parser.add_argument(
        "--results", type=Path, default=directory, help=f"where results go [{directory.relative_to(ROOT)}]"
    )
    parser.add_argument("--quick", action="store_true", help=f"only runs of an estimated {QUICK:g} CPU s or less")
    parser.add_argument("--long", action="store_true", help="also the runs that take very long")
    parser.add_argument("--only", metavar="TEXT", help="only the run of this name, or runs with this in it")
    parser.add_argument("--accept-older", action="store_true", help="keep results of other states of the sources")
    parser.add_argument("--workers", type=int, default=workers, help=f"runs at a time [{workers}]")
    parser.add_argument("--list", action="store_true", help="list the runs and their estimated costs; run nothing")
    arguments = parser.parse_args()
    if arguments.list:
        list_runs(studies)
        return 0

    sources = {name: source_hash(ROOT, program) for name, program in programs.items()}
    commit, machine = commit_of(ROOT), computer.description(arguments.build)
    every = cheapest_first(studies)
    named = [run for run in every if run.name == arguments.only]
    wanted = [
        run
        for run in named or every
        if (not arguments.quick or run.cost <= QUICK)
        and (not run.long or arguments.long)
        and (not arguments.only or arguments.only in run.name)
    ]
    missing = [
        run
        for run in wanted
        if not is_current(run, arguments.results, sources[run.program], arguments.accept_older)
    ]
    print(
        f"{len(wanted)} runs, {len(wanted) - len(missing)} of them done before; {len(missing)} to do, "
        f"about {sum(run.cost for run in missing) / arguments.workers / 60:.0f} min",
        flush=True,
    )
    progress = Progress(missing, arguments.workers)
    counts: dict[str, int] = {}

    def work(run: Run) -> None:
        data = execute(run, programs[run.program], arguments.build)
        origin = {
            "program": run.program,
            "source": sources[run.program],
            "commit": commit,
            "machine": machine,
            "date": datetime.date.today().isoformat(),
        }
        results.save(run, {**data, **origin}, arguments.results)
        progress.finished(run, data)
        counts[data["status"]] = counts.get(data["status"], 0) + 1

    pool = ThreadPoolExecutor(arguments.workers)
    try:
        for future in [pool.submit(work, run) for run in missing]:
            future.result()
    except KeyboardInterrupt:
        pool.shutdown(cancel_futures=True)
        print("stopped; what was finished is kept", file=sys.stderr)
        return 130
    pool.shutdown()
    if missing:
        print(", ".join(f"{count} {status}" for status, count in sorted(counts.items())))
    return 1 if counts.get("failed") else 0

