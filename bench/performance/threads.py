#!/usr/bin/python3
"""Wall-clock and CPU time of a step in the middle of the collapse with one thread and with several, in turn: medians. Also what
the machine has to give: the same one-thread program as many times side by side, whose processors may share caches, clock
and, under a hypervisor, cores. Lines of "name value unit". Says something only on a machine at rest: the load is printed, too."""
from __future__ import annotations

import argparse
import os
import re
import resource
import subprocess
import tempfile
from pathlib import Path
from statistics import mean, median

FROM = 0.15  # s


def start(program: Path, options: list[str], threads: int) -> subprocess.Popen[str]:
    return subprocess.Popen([str(program), *options, "--threads", str(threads)], stdout=subprocess.PIPE, text=True)


def finish(run: subprocess.Popen[str]) -> dict[str, float]:
    text, _ = run.communicate()
    if run.returncode:
        raise SystemExit(f"{run.args}: status {run.returncode}")
    return {name: float(value) for name, value in re.findall(r"^(\w+) (\S+)", text, re.M)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--resolution", type=int, required=True)
    parser.add_argument("--steps", type=int, required=True)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeat", type=int, default=9)
    arguments = parser.parse_args()
    program, several = arguments.build / "bench" / "step", arguments.threads
    load = os.getloadavg()[0]  # before these runs make one themselves
    with tempfile.TemporaryDirectory() as work:
        particles = f"{work}/particles"
        options = ["--resolution", str(arguments.resolution)]
        finish(start(program, [*options, "--from", str(FROM), "--write", particles], 1))
        options += ["--from", "0", "--steps", str(arguments.steps), "--read", particles]
        turns = [
            (
                finish(start(program, options, 1)),
                finish(start(program, options, several)),
                [finish(run) for run in [start(program, options, 1) for _ in range(several)]],
            )
            for _ in range(arguments.repeat)
        ]
    side_by_side = [several * one["wall"] / mean(run["wall"] for run in beside) for one, _, beside in turns]
    print(f"particles {turns[0][0]['particles']:.0f} 1")
    print(f"wall_one {median(one['wall'] for one, _, _ in turns):.6g} ns/particle-step")
    print(f"wall_several {median(many['wall'] for _, many, _ in turns):.6g} ns/particle-step")
    print(f"speed_up {median(one['wall'] / many['wall'] for one, many, _ in turns):.6g} of the wall-clock time")
    print(f"best_speed_up {max(one['wall'] / many['wall'] for one, many, _ in turns):.6g} of the wall-clock time")
    print(f"side_by_side {median(side_by_side):.6g} times the work of one program, by {several}")
    print(f"more_cpu {median(many['cpu'] / one['cpu'] for one, many, _ in turns) - 1:.6g} of the CPU time, more")
    print(f"load {load:.2f} over the minute before")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"cpu_seconds {used.ru_utime + used.ru_stime:.3f} s")


main()
