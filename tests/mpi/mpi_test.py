#!/usr/bin/env python3
"""Tests of several processes: mpi_test.py same_values|restarts|program|kill|memory|failing|scene, with the programs' paths as options."""
import argparse
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

try:
    import h5py
except ImportError:
    h5py = None

ENVIRONMENT = {
    **os.environ,
    "OMPI_MCA_mpi_yield_when_idle": "1",  # more processes than cores
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",  # which containers may not do
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMP_WAIT_POLICY": "passive",
}


class Tests:
    def __init__(self, options, folder):
        self.options = options
        self.folder = folder
        self.failures = 0

    def command(self, ranks, *arguments):
        return [self.options.mpiexec, "-n", str(ranks), *map(str, arguments)]

    def run(self, ranks, *arguments):
        return subprocess.run(self.command(ranks, *arguments), cwd=self.folder, env=ENVIRONMENT, text=True,
                              capture_output=True, timeout=300)

    def check(self, good, what, result=None):
        print("ok  " if good else "FAIL", what, flush=True)
        if not good:
            self.failures += 1
            if result:
                print(result.stdout[-2000:], result.stderr[-2000:])

    def must(self, ranks, *arguments):
        result = self.run(ranks, *arguments)
        if result.returncode != 0:
            print(result.stdout[-2000:], result.stderr[-2000:])
            sys.exit(f"{arguments}: status {result.returncode}")

    def same_values(self):
        """Each scene on 1 to 4 processes, with one and two threads, as on one."""
        for ranks, threads in ((2, 1), (3, 1), (4, 1), (2, 2)):
            result = self.run(ranks, self.options.same_values, "all", threads)
            self.check(result.returncode == 0, f"{ranks} processes, {threads} threads", result)

    def same(self, a, b, what):
        result = self.run(1, self.options.restarts, "compare", a, b)
        self.check(result.returncode == 0, what, result)

    def restarts(self):
        program = self.options.restarts
        # Of the bed a part sleeps when it is saved first, all of it at the second time, and nothing at the third, after the blow.
        for scene, parts in (("periodic", (113, 101, 60, 63)), ("gate", (113, 101, 60, 63)), ("implicit", (5, 4, 3, 2)),
                             ("sleep", (760, 90, 120, 60))):
            steps = sum(parts)
            self.must(1, program, "make", scene, steps, "whole.h5")
            self.must(1, program, "make", scene, parts[0], "a.h5")
            self.must(3, program, "go_on", "a.h5", parts[1], "b.h5")
            self.must(2, program, "go_on", "b.h5", parts[2], "c.h5")
            self.must(1, program, "alone", "c.h5", parts[3], "d.h5")
            self.same("whole.h5", "d.h5", f"{scene}: 1, 3, 2 processes, one without MPI")
            self.must(3, program, "make", scene, 0, "first.h5")
            self.must(4, program, "go_on", "first.h5", steps, "e.h5")
            self.same("whole.h5", "e.h5", f"{scene}: saved before the first step")
            # In the layout of a process alone.
            self.must(1, program, "alone", "b.h5", 0, "one.h5")
            self.must(3, program, "go_on", "b.h5", 0, "three.h5")
            one, three = ((self.folder / name).read_bytes() for name in ("one.h5", "three.h5"))
            self.check(one == three, f"{scene}: the same file by one and by three")
        result = self.run(2, program, "threads", "threads.h5")
        self.check(result.returncode == 0, "several threads are for an MPI that was begun with them", result)
        for ranks in 2, 4:
            result = self.run(ranks, program, "warnings")
            self.check(result.returncode == 0, f"the warnings of a scene by {ranks}", result)

    def program(self):
        """granperi-mpi: what it writes, what it says."""
        program = self.options.program
        self.must(1, self.options.restarts, "make", "gate", 0, "first.h5")
        self.must(2, program, "first.h5", "--end", 0.02, "--output", "two.h5", "--every", 0.005, "--save", "two.end.h5")
        self.must(1, program, "first.h5", "--end", 0.02, "--output", "one.h5", "--every", 0.005, "--save", "one.end.h5")
        self.same("one.end.h5", "two.end.h5", "the same end")
        frames = []
        for name in "one.h5", "two.h5":
            with h5py.File(self.folder / name) as file:
                position = file["particles/all/position"]
                frames.append((position["value"][...].tobytes(), position["time"][...].tobytes()))
        self.check(frames[0] == frames[1], "the same frames")
        to_the_end = "first.h5", "--end", 0.02, "--end-frame", "--output"
        self.must(2, program, *to_the_end, "more.h5", "--every", 0.015, "--fields", "stress,column")
        self.must(2, program, *to_the_end, "even.h5", "--every", 0.01)
        for name, count in ("more.h5", 3), ("even.h5", 3):
            with h5py.File(self.folder / name) as file:
                times = file["particles/all/position/time"][...]
                self.check(len(times) == count and times[-1] == 0.02, f"{name}: one frame at the end")
                self.check(("sxy" in file["particles/all"]) == (name == "more.h5") != ("pressure" in file["particles/all"]),
                           f"{name}: the fields that are asked for")
        for arguments, expected in (((), "no file given"), (("first.h5",), "--end is missing"),
                                    (("none.h5", "--end", 1), "none.h5"), (("first.h5", "--end", "x"), "expected a number"),
                                    (("first.h5", "--end", 0), "expected a time after"),
                                    (("first.h5", "--end", 1, "--what"), "no such option"),
                                    (("first.h5", "--end", 1, "--output", "n.h5", "--every", 0), "--every 0: expected a number"),
                                    (("first.h5", "--end", 1, "--output", "n.h5", "--fields", "speed"), "no field 'speed'"),
                                    (("first.h5", "--end", 1, "--checkpoint", 1), "--checkpoint is of --save"),
                                    (("first.h5", "--end", 1, "--save", "none/e.h5"), "--save none/e.h5: cannot be"),
                                    (("first.h5", "--end", 1, "--save", "first.h5/e"), "--save first.h5/e: cannot be"),
                                    (("first.h5", "--end", 1, "--save", "."), "--save .: cannot be written")):
            result = self.run(2, program, *arguments)
            self.check(result.returncode != 0 and result.stderr.count(expected) == 1, f"{expected}, once", result)
        self.check(not (self.folder / "n.h5").exists(), "mistakes are found before a file is touched")
        self.failed_runs(program)

    def failed_runs(self, program):
        """What was computed before an error is kept."""
        self.must(1, self.options.restarts, "make", "blow", 0, "blow.h5")
        for there, saved in ((None, "blow.end.h5"), (b"a checkpoint", "blow.h5.stopped")):
            if there:
                (self.folder / "blow.end.h5").write_bytes(there)
            result = self.run(2, program, "blow.h5", "--end", 0.1, "--save", "blow.end.h5")
            self.check(result.returncode == 2 and result.stderr.count(f"the last good step is saved to {saved}") == 1
                       and "of particle" in result.stderr, f"a step that diverges: saved to {saved}", result)
        self.check((self.folder / "blow.end.h5").read_bytes() == there, "a checkpoint is not replaced by what has diverged")
        result = self.run(1, program, "blow.h5.stopped", "--end", 0.1)
        self.check(result.returncode == 2 and "saved to" not in result.stderr
                   and not (self.folder / "blow.h5.stopped.stopped").exists(), "nothing computed, nothing saved", result)

        # A disk that is full: no file of this process may be larger.
        full = ["sh", "-c", 'trap "" XFSZ; ulimit -f 400; exec "$@"', "sh"]
        command = self.command(1, *full, program, "first.h5", "--end", 10, "--output", "f.h5", "--every", 0.005, "--save", "f.end.h5")
        result = subprocess.run(command, cwd=self.folder, env={**ENVIRONMENT, "OMPI_MCA_btl": "self"}, text=True, capture_output=True,
                                timeout=120)
        self.check(result.returncode == 2 and "write a frame" in result.stderr
                   and "the last good step is saved to f.end.h5" in result.stderr, "a frame that cannot be written", result)
        self.must(1, self.options.restarts, "alone", "f.end.h5", 3, "f.end.h5")

        (self.folder / "gone").mkdir()
        process = self.start(2, program, "first.h5", "--end", 10, "--output", "g.h5", "--every", 0.005, "--save", "gone/e.h5")
        self.wait_for_frames(process, "g.h5", 3)
        (self.folder / "gone").rmdir()
        process.send_signal(signal.SIGUSR1)
        _, errors = process.communicate(timeout=120)
        self.check(process.returncode == 2 and "saved to first.h5.stopped instead of gone/e.h5" in errors,
                   "where the checkpoint cannot be written any more")
        self.must(2, program, "first.h5.stopped", "--end", 0.05, "--output", "g.h5", "--every", 0.005, "--append")

    SCENE = """\
[config]
spacing = 0.005
[run]
end = 0.2
every = 0.0123
output = "run.h5"
fields = ["velocity", "stress"]
[[column]]
width = 0.08
height = 0.05
[[floor]]
x_left = -0.3
x_right = 0.4
"""

    def granperi(self, *arguments, start=False):
        """python3 -m granperi in a folder of its own, beside the programs."""
        paths = os.pathsep.join([os.path.dirname(self.options.program), os.path.dirname(self.options.mpiexec),
                                 os.environ["PATH"]])
        options = {"cwd": self.folder, "text": True, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE,
                   "env": {**ENVIRONMENT, "PATH": paths, "PYTHONPATH": self.options.package, "PYTHONDONTWRITEBYTECODE": "1"}}
        command = [sys.executable, "-m", "granperi", *map(str, arguments)]
        return subprocess.Popen(command, **options) if start else subprocess.run(command, timeout=120, **options)

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())

    def wait_for_ranks(self, process, program, frames=None):
        """Both of them, once they have written some frames."""
        ranks = []
        while process.poll() is None and len(ranks) < 2:
            time.sleep(0.05)
            ranks = self.ranks_of(process, program)
        if frames:
            self.wait_for_frames(process, frames, 3)
        return ranks

    def is_whole(self, name, what, result=None):
        """The result that one process has written, and nothing beside it."""
        same = self.files() == self.complete
        if same:
            with h5py.File(self.folder / "one" / "run.h5") as one, h5py.File(self.folder / name) as other:
                one, other = one["particles/all"], other["particles/all"]
                pairs = [(one[name][part][...], other[name][part][...]) for name in one if name in other and "value" in one[name]
                         for part in ("time", "value")]
                same = set(one) == set(other) and len(pairs) >= 6 and all(a.shape == b.shape and (a == b).all() for a, b in pairs)
        self.check(same, what, result)

    def scene(self):
        """python3 -m granperi run --mpi N: nothing that was computed is lost, nothing that exists is replaced too soon."""
        program = self.options.program
        (self.folder / "s.toml").write_text(self.SCENE)
        (self.folder / "one").mkdir()
        one = self.granperi("run", "s.toml", "--output", "one/run.h5")
        self.complete = sorted([*self.files(), *(path.name for path in (self.folder / "one").iterdir())])
        result = self.granperi("run", "s.toml", "--mpi", 2, "--no-progress")
        self.check(one.returncode == result.returncode == 0 and not result.stderr, "--no-progress", result)
        self.is_whole("run.h5", "the result of one process", result)
        result = self.granperi("run", "s.toml", "--resume", "--end", 0.21)
        self.check(result.returncode == 0, "one process goes on with a complete run", result)
        old = (self.folder / "run.h5").read_bytes()
        result = self.granperi("run", "s.toml", "--mpi", 2)
        self.check(result.returncode == 1 and "run.h5 exists" in result.stderr, "what exists is not replaced", result)
        for number, status in (signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGHUP, 129):
            process = self.granperi("run", "s.toml", "--mpi", 2, "--end", 100, "--overwrite", "--progress", start=True)
            ranks = self.wait_for_ranks(process, program, "run.part/run.h5")
            process.send_signal(number)
            told = process.communicate(timeout=120)[1]
            self.check(process.returncode == status and "saved to run.part/run.gpc" in told and "Traceback" not in told
                       and "--resume in place of --mpi 2 goes on" in told and "t = " in told, f"{number.name} saves and ends")
            before = time.monotonic()
            while any(os.path.exists(f"/proc/{rank}") for rank in ranks) and time.monotonic() < before + 10:
                time.sleep(0.02)  # mpiexec goes when it has been told of the end of all
            self.check(len(ranks) == 2 and time.monotonic() < before + 10, "it ends all")
            self.check((self.folder / "run.h5").read_bytes() == old, "the old result stays")
        result = self.granperi("run", "s.toml", "--mpi", 2)
        self.check(result.returncode == 1 and "run.h5 exists" in result.stderr, "what was interrupted is not begun anew", result)

        # A run that is ended from within; one without a result.
        process = self.granperi("run", "s.toml", "--mpi", 2, "--end", 100, "--overwrite", start=True)
        os.kill(self.wait_for_ranks(process, program, "run.part/run.h5")[0], signal.SIGUSR1)
        told = process.communicate(timeout=120)[1]
        self.check(process.returncode == 75 and "goes on" in told, "SIGUSR1 to one process")
        with h5py.File(self.folder / "run.part/run.h5") as file:
            end = file["particles/all/position/time"][-1] + 0.02
        result = self.granperi("run", "s.toml", "--resume", "--end", end)
        self.check(result.returncode == 0, "one process goes on", result)
        with h5py.File(self.folder / "run.h5") as file:
            times = file["particles/all/position/time"][...]
            self.check(len(times) == int(end / 0.0123) + 2 and times[-1] == end, "without a gap, to the end")
        self.check(self.files() == self.complete, "all in its place")
        process = self.granperi("run", "s.toml", "--mpi", 2, "--end", 100, "--output", "none", start=True)
        self.wait_for_ranks(process, program)
        time.sleep(1)
        process.terminate()
        told = process.communicate(timeout=120)[1]
        saved = told.partition("saved to ")[2].partition("\n")[0]
        self.check(process.returncode == 143 and saved.endswith(".stopped") and (self.folder / saved).is_file(),
                   f"without a result, too: {saved}")

    def memory(self):
        """What the start, states, frames and checkpoints take on the first process of two, per particle of the whole. Where it had
        all of it that was 510 bytes at the start, 500 in states and frames, 640 to save and 630 to load. What is left is its half
        of the particles, at the start and in loading, and the scene as it was laid out."""
        taken = []
        for particles in 40_000, 200_000:
            result = self.run(2, self.options.memory, particles, "memory.h5", "saved.h5")
            if result.returncode != 0:
                print(result.stdout[-2000:], result.stderr[-2000:])
                sys.exit(77 if "exit code: 77" in result.stderr.lower() or result.returncode == 77 else 1)
            taken.append((particles, *map(float, result.stdout.split())))
        for k, what, most in (1, "first step", 350), (2, "state", 250), (3, "frame", 250), (4, "save", 150), (5, "load", 480):
            # Between two sizes: what is the same for any size falls out.
            each = (taken[1][k] - taken[0][k]) / (taken[1][0] - taken[0][0])
            self.check(each < most, f"a {what} takes {each:.0f} bytes for each particle more")

    def failing(self):
        """One process runs out of memory, some make mistakes: all are told, and none waits for ever."""
        for ranks in 2, 3, 4:
            result = self.run(ranks, self.options.failing, self.folder, self.options.runs)
            self.check(result.returncode == 0, result.stdout.strip() or f"{ranks} processes", result)

    def start(self, ranks, *arguments):
        return subprocess.Popen(self.command(ranks, *arguments), cwd=self.folder, env=ENVIRONMENT, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    @staticmethod
    def ranks_of(process, program):
        """Of the program among the descendants of mpiexec."""
        children = {}
        for entry in pathlib.Path("/proc").iterdir():
            if entry.name.isdigit():
                try:
                    fields = (entry / "stat").read_text().rpartition(")")[2].split()
                    children.setdefault(int(fields[1]), []).append(int(entry.name))
                except OSError:
                    continue
        found, left = [], [process.pid]
        while left:
            for child in children.get(left.pop(), []):
                left.append(child)
                try:
                    if os.path.samefile(f"/proc/{child}/exe", program):
                        found.append(child)
                except OSError:
                    continue
        return found

    def wait_for_frames(self, process, name, count):
        path = self.folder / name
        while process.poll() is None:
            try:
                with h5py.File(path) as file:
                    if len(file["particles/all/position/time"]) >= count:
                        return
            except (OSError, KeyError):
                pass
            time.sleep(0.02)

    def kill(self):
        """A signal saves and ends; killed at any moment, what is on disk is whole."""
        program = self.options.program
        self.must(1, self.options.restarts, "make", "gate", 0, "first.h5")
        process = self.start(2, program, "first.h5", "--end", 10, "--output", "f.h5", "--every", 0.005, "--save", "s.h5")
        self.wait_for_frames(process, "f.h5", 3)
        ranks = self.ranks_of(process, program)
        os.kill(ranks[-1], signal.SIGUSR1)
        _, errors = process.communicate(timeout=120)
        self.check(process.returncode == 75 and "stopped by a signal" in errors, "a signal to one process ends all")
        self.must(3, program, "s.h5", "--end", 0.06, "--output", "f.h5", "--every", 0.005, "--append", "--save", "e.h5")
        self.must(1, program, "first.h5", "--end", 0.06, "--save", "whole.h5")
        with h5py.File(self.folder / "f.h5") as file:
            self.check(len(file["particles/all/position/time"]) >= 12, "frames go on")
        process = self.start(2, program, "first.h5", "--end", 10, "--save", "way.h5", "--checkpoint", 0.1)
        while process.poll() is None and not (self.folder / "way.h5").exists():
            time.sleep(0.02)
        self.kill_some(process, program, True, 0.3)
        self.must(1, self.options.restarts, "alone", "way.h5", 3, "way.h5")
        self.kill_writers(program)

    def kill_writers(self, program):
        """One process or all of them, at random moments, of a program that writes frames and of one that saves."""
        restarts = self.options.restarts
        self.must(1, program, "s.h5", "--end", 0.2, "--output", "all.h5", "--every", 0.002)
        frames = self.frames_of("all.h5")
        (self.folder / "saves").mkdir()
        self.must(1, restarts, "saves", "s.h5", 3, "saves/")
        chooser = random.Random(20)
        for turn in range(self.options.kills):
            for name in "k.h5", "c.h5":
                (self.folder / name).unlink(missing_ok=True)
            if turn % 2:
                process = self.start(2 + turn // 4 % 2, program, "s.h5", "--end", 10, "--output", "k.h5", "--every", 0.002)
                self.wait_for_frames(process, "k.h5", 1 + turn // 2 % 4)
                ranks = self.kill_some(process, program, turn // 2 % 2, 0.1 * chooser.random())
                found = self.frames_of("k.h5")
                self.check(len(found) > 0 and found == frames[:len(found)],
                           f"{len(found)} frames are whole after a kill of {ranks} processes")
            else:
                process = self.start(2 + turn // 4 % 2, restarts, "saves", "s.h5", 3, "c.h5")
                while process.poll() is None and not (self.folder / "c.h5").exists():
                    time.sleep(0.01)
                ranks = self.kill_some(process, restarts, turn // 2 % 2, 0.3 * chooser.random())
                result = self.run(1, restarts, "whole", "c.h5", "saves/")
                self.check(result.returncode == 0, f"a checkpoint is whole after a kill of {ranks} processes", result)

    def kill_some(self, process, program, everybody, after):
        """Which it killed: one of them or all."""
        time.sleep(after)
        ranks = self.ranks_of(process, program)
        chosen = ranks if everybody else [ranks[int(1000 * after) % len(ranks)]]
        for rank in chosen:
            os.kill(rank, signal.SIGKILL)
        process.communicate(timeout=120)
        self.check(process.returncode != 0, "mpiexec tells of it")
        return f"{len(chosen)} of {len(ranks)}"

    def frames_of(self, name):
        with h5py.File(self.folder / name) as file:
            position = file["particles/all/position"]
            velocity = file["particles/all/velocity/value"]
            return [(time, position["value"][k].tobytes(), velocity[k].tobytes()) for k, time in enumerate(position["time"])]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("check", choices=["same_values", "restarts", "program", "kill", "memory", "failing", "scene"])
    parser.add_argument("--mpiexec", default="mpiexec")
    parser.add_argument("--same-values")
    parser.add_argument("--restarts")
    parser.add_argument("--program")
    parser.add_argument("--memory")
    parser.add_argument("--failing")
    parser.add_argument("--package", help="where the Python package is")
    parser.add_argument("--runs", type=int, default=40)
    parser.add_argument("--kills", type=int, default=4)
    options = parser.parse_args()
    if h5py is None and options.check in ("program", "kill", "scene"):
        print("no h5py")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        tests = Tests(options, pathlib.Path(folder))
        getattr(tests, options.check)()
    return 1 if tests.failures else 0


if __name__ == "__main__":
    sys.exit(main())
