#!/usr/bin/env python3
"""Restarts, kills and equal bits, with trust_host (host.cpp) as the host. docs/trust.md has the figures.

    trust.py restart   --host PROGRAM          N steps, save, load in a new process, M steps: the bits of N + M steps
    trust.py output    --host PROGRAM          the result file of a restarted run has the frames of the unbroken one
    trust.py kill      --host PROGRAM [--count N]   SIGKILL at random moments, then the files are read and gone on with
    trust.py same_bits --host PROGRAM --static PROGRAM   threads, libraries, output, callbacks, what is not used
    trust.py golden    --host PROGRAM --table FILE [--update]   the bits of short runs, by instruction set (GRANPERI_LEVEL)

Exit status 77: this machine cannot run it.
"""
import argparse
import os
import platform
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
    system = "/usr/bin/python3"  # for which the packages are installed
    if __name__ == "__main__" and os.path.realpath(sys.executable) != os.path.realpath(system) and os.path.exists(system):
        os.execv(system, [system, *sys.argv])

# What there is to go wrong: the schemes; plates that move by tables, by the host, under loads, that turn; periods, side walls,
# retries; a material with a granular fluidity in these; gravity that the host turns; material that sleeps.
SCENES = ["default", "implicit", "regularized", "paper", "paper_local", "periodic", "driven", "paper_driven", "loaded",
          "channel", "retry", "turning", "fluid", "fluid_periodic", "fluid_retry", "gravity", "sleep"]
DIVERGING = ["diverge", "diverge_periodic"]
END = 90
SAVED = (0, 1, 10, 44, 45)


class Failure(Exception):
    pass


class Bench:
    def __init__(self, host, directory):
        self.host, self.directory, self.runs = host, directory, 0

    def path(self, name):
        return os.path.join(self.directory, name)

    def run(self, *arguments, host=None, threads=None, level=None):
        environment = dict(os.environ, OMP_WAIT_POLICY="passive")
        if threads:
            environment["OMP_NUM_THREADS"] = str(threads)
        if level is not None:
            environment["GRANPERI_LEVEL"] = level
        self.runs += 1
        done = subprocess.run([host or self.host, *map(str, arguments)], env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=250)
        if done.returncode != 0:
            raise Failure(f"{' '.join(map(str, arguments))}: status {done.returncode}: {done.stderr.strip()}")
        return done.stdout.splitlines()


def state(line):
    """Step, time and hashes of a line, without its first word."""
    return line.split(" ", 1)[1]


def logs(*outputs):
    return [line for lines in outputs for line in lines if line.startswith("log ")]


def require(good, text):
    if not good:
        raise Failure(text)


def check_restart(bench, scene, save_step, whole, extra=(), threads=(None, None), expect=()):
    file = bench.path("state.gpc")
    before = bench.run(scene, "--to-step", save_step, "--save-at", save_step, file, "--log", *extra, *expect,
                       threads=threads[0])
    after = bench.run(scene, "--load", file, "--to-step", END, "--log", *expect, threads=threads[1])
    where = f"{scene}, saved at step {save_step}, threads {threads}"
    require(state(after[0]) == state(before[-1]), f"{where}: loaded is not what was saved")
    require(state(after[-1]) == state(whole[-1]), f"{where}: ends with {after[-1]}, without a restart {whole[-1]}")
    require(logs(before, after) == logs(whole), f"{where}: warnings are lost or repeated")


def check_sleep(bench):
    """That there is something to forget: after each of the steps saved some go on to sleep, some fall asleep and some wake."""
    lines = bench.run("sleep", "--to-step", END, "--awake")
    asleep = [int(line.split()[3]) for line in lines if line.startswith("awake ")]
    for step in SAVED:
        later = asleep[step:]
        changes = [after - before for before, after in zip(later, later[1:])]
        require(later[0] > 0 and min(changes) < 0 < max(changes), f"after step {step} there sleep {later}")


def restart(bench, _):
    restarts = 0
    check_sleep(bench)
    for scene in SCENES + DIVERGING:
        expect = ("--expect-diverged",) if scene in DIVERGING else ()
        whole = bench.run(scene, "--to-step", END, "--log", *expect)
        for step in SAVED:
            check_restart(bench, scene, step, whole, expect=expect)
            restarts += 1
    # Inside a callback, in a run to a point in time: also in the step that lands on it.
    for scene in ("default", "paper"):
        last = int(bench.run(scene, "--to-time", 4e-4)[-1].split()[1])
        whole = bench.run(scene, "--to-time", 4e-4, "--to-step", END)
        for step in (3, last):
            file = bench.path("callback.gpc")
            bench.run(scene, "--to-time", 4e-4, "--save-in-callback", step, file)
            after = bench.run(scene, "--load", file, "--to-time", 4e-4, "--to-step", END)
            require(state(after[-1]) == state(whole[-1]), f"{scene}: saved in the callback of step {step}")
            restarts += 1
    # With enough particles for the threads to share them.
    for scene in ("default", "implicit", "paper", "paper_local", "periodic", "fluid", "fluid_periodic", "sleep"):
        extra = ("--size", 3 if scene not in ("implicit", "sleep") else 2, "--threads", 0)
        whole = bench.run(scene, "--to-step", END, "--log", *extra, threads=1)
        for threads in ((1, 2), (4, 1), (3, 3)):
            check_restart(bench, scene, 40, whole, extra, threads)
            restarts += 1
    return f"{restarts} restarts, {bench.runs} processes"


def frames_of(path):
    """Step, time and all values of the complete frames, as bytes."""
    with h5py.File(path, "r") as file:
        elements = file["particles/all"]
        times, steps = elements["position/time"][:], elements["position/step"][:]
        values = {name: group["value"] for name, group in elements.items() if "value" in group}
        return [(int(steps[k]), float(times[k]), b"".join(values[name][k].tobytes() for name in sorted(values)))
                for k in range(len(times))]


def check_listed(path, frames):
    """The XDMF file is XML and lists so many frames."""
    import xml.etree.ElementTree
    tree = xml.etree.ElementTree.parse(os.path.splitext(path)[0] + ".xdmf")
    listed = len(tree.findall(".//Time"))
    require(listed in frames, f"{path}: the XDMF file lists {listed} frames, expected {frames}")


def output(bench, _):
    every, continued = 1e-4, 0
    for scene in ("default", "paper", "periodic"):
        whole, parts = bench.path("whole.h5"), bench.path("parts.h5")
        bench.run(scene, "--to-step", END, "--output", whole, every)
        expected = frames_of(whole)
        require(len(expected) > 4, "too few frames for a test")
        for save, on in ((0, 5), (20, 20), (33, 70), (50, END)):
            file = bench.path("state.gpc")
            # It goes on after it has been saved: those frames are to vanish.
            bench.run(scene, "--to-step", on, "--save-at", save, file, "--output", parts, every)
            bench.run(scene, "--load", file, "--to-step", END, "--output", parts, every, "--append")
            require(frames_of(parts) == expected, f"{scene}: saved at {save}, went on to {on}: other frames")
            check_listed(parts, [len(expected)])
            continued += 1
    return f"{continued} outputs continued"


def kill(bench, options):
    rng = random.Random(options.seed)
    whole, every = bench.path("whole.h5"), 1e-4
    reference = bench.run("default", "--to-step", 1300, "--save-every", 5, bench.path("whole.gpc"), "--output", whole,
                          every)
    hashes = {line.split()[1]: state(line) for line in reference}
    expected = frames_of(whole)
    parts, file = bench.path("killed.h5"), bench.path("killed.gpc")
    kills = frames = step = 0
    while kills < options.count:
        begin = ["--load", file, "--append"] if step > 0 else []
        often = rng.choice(["5", "50"])  # most kills fall on a checkpoint's way to the disk, or on steps and frames
        child = subprocess.Popen([bench.host, "default", *begin, "--until-killed", "--save-every", often, file, "--output",
                                  parts, str(every)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        # From the first saved state on, so that there is one to go on from.
        line = child.stdout.readline() and child.stdout.readline()
        if not line.startswith("saved"):
            raise Failure(f"after {kills} kills: {line} {child.stderr.read()}")
        time.sleep(rng.uniform(0, 0.06))
        child.send_signal(signal.SIGKILL)
        told = [line] + child.stdout.read().splitlines()
        if child.wait() != -signal.SIGKILL:
            raise Failure(f"ended by itself: {child.stderr.read()}")
        kills += 1
        last_told = int([l for l in told if l.startswith("saved") and len(l.split()) == 6][-1].split()[1])
        # The last checkpoint is whole, is not older than what the program has told, and has the bits of the unbroken run.
        loaded = bench.run("default", "--load", file)[0]
        step = int(loaded.split()[1])
        require(step >= last_told, f"kill {kills}: step {last_told} was saved, but {step} is loaded")
        if str(step) in hashes:
            require(state(loaded) == hashes[str(step)], f"kill {kills}: other bits at step {step}")
        # So is every complete frame.
        found = frames_of(parts)
        due = [frame for frame in expected if frame[0] <= last_told]
        require(len(found) >= len(due), f"kill {kills}: {len(found)} frames, {len(due)} were complete")
        require(found[:len(expected)] == expected[:len(found)], f"kill {kills}: a frame has other values")
        check_listed(parts, range(len(found) - 1, len(found) + 2))
        frames += len(found)
        if step >= 1200:
            step = 0
    behind = len([name for name in os.listdir(bench.directory) if ".part" in name])
    return f"{kills} kills, {frames} frames read after them, {behind} parts left behind"


def same_bits(bench, options):
    comparisons = 0
    for scene in ("default", "implicit", "paper", "paper_local", "periodic", "sleep"):
        size = ("--size", 4 if scene not in ("implicit", "sleep") else 2, "--to-step", 40)
        one = bench.run(scene, *size, "--threads", 1)[-1]
        for threads in (2, 3, 4):
            require(bench.run(scene, *size, "--threads", threads)[-1] == one, f"{scene}: {threads} threads differ from one")
            comparisons += 1
    for scene in SCENES:
        plain = bench.run(scene, "--to-step", END)[-1]
        ways = {"the static library": dict(host=options.static), "a callback": dict(extra=["--callback"]),
                "an output": dict(extra=["--output", bench.path("same.h5"), 1e-4]),
                "a material that is not used": dict(extra=["--unused-material"])}
        for name, way in ways.items():
            if way.get("host", "") is None or ("--output" in way.get("extra", ()) and not h5py):
                continue
            found = bench.run(scene, "--to-step", END, *way.get("extra", ()), host=way.get("host"))[-1]
            require(found == plain, f"{scene}: {name} changes the bits: {found}, without {plain}")
            comparisons += 1
        # One more plate has a load of its own, so only the particles are compared.
        found = bench.run(scene, "--to-step", END, "--spare-plate")[-1]
        require(found.split()[-1] == plain.split()[-1], f"{scene}: a plate out of reach changes the bits")
        comparisons += 1
    return f"{comparisons} comparisons"


# Of the engine: cmake/levels.cmake.
LEVELS = ["x86-64", "x86-64-v3"]


def levels():
    """Those that this processor has, by the C library, to which the library's own choice (src/levels/dispatch.cpp) is held: some
    virtual machines leave flags out of /proc/cpuinfo."""
    told = subprocess.run(["/lib64/ld-linux-x86-64.so.2", "--help"], capture_output=True, text=True, check=False).stdout
    return LEVELS if "x86-64-v3 (supported" in told else LEVELS[:1]


def golden(bench, options):
    if platform.machine() != "x86_64":
        print("the table is of x86-64")
        sys.exit(77)
    table = {}
    if os.path.exists(options.table):
        with open(options.table) as file:
            for line in file:
                if line.strip() and not line.startswith("#"):
                    level, scene, bits = line.split()
                    table[level, scene] = bits
    found = {(level, scene): bench.run(scene, "--to-step", 30, level=level)[-1].split()[-1]
             for level in levels() for scene in SCENES}
    if options.update:
        if levels() != LEVELS:
            sys.exit(f"this processor has {', '.join(levels())} alone: the table is of {', '.join(LEVELS)}")
        with open(options.table, "w") as file:
            file.write("# Bits of all particles after 30 steps of each scene of host_scenes.cpp, by instruction set. Written by\n"
                       "# scripts/trust golden --update\n")
            for (level, scene), bits in sorted(found.items()):
                file.write(f"{level} {scene} {bits}\n")
        return f"{len(found)} written"
    wrong = [f"{scene} ({level})" for level, scene in found if table.get((level, scene)) != found[level, scene]]
    require(not wrong, f"other bits than in {options.table}: {', '.join(wrong)}. Is that meant? Then scripts/trust golden --update")
    # What docs/trust.md says of other processors: the levels have different bits in each scene.
    alike = [scene for scene in SCENES if len({table.get((level, scene)) for level in LEVELS}) < len(LEVELS)]
    require(not alike, f"docs/trust.md says that each instruction set has bits of its own, but not in {', '.join(alike)}")
    best = levels()[-1]
    chosen = bench.run(SCENES[0], "--to-step", 30)[-1].split()[-1]
    require(chosen == found[best, SCENES[0]], f"without GRANPERI_LEVEL it is not {best} that runs")
    for unknown in ("x86-64-v9", ""):
        try:
            bench.run(SCENES[0], "--to-step", 1, level=unknown)
        except Failure as failure:
            require("GRANPERI_LEVEL" in str(failure), f"GRANPERI_LEVEL={unknown}: {failure}")
        else:
            raise Failure(f"GRANPERI_LEVEL={unknown} is accepted")
    return f"{len(SCENES)} scenes as in the table, for {' and '.join(levels())}"


def main():
    checks = {check.__name__: check for check in (restart, output, kill, same_bits, golden)}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("check", choices=checks)
    parser.add_argument("--host")
    parser.add_argument("--static")
    parser.add_argument("--count", type=int, default=8)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--table")
    parser.add_argument("--update", action="store_true")
    options = parser.parse_args()
    if options.check in ("output", "kill") and not h5py:
        print("python3-h5py is not there")
        sys.exit(77)
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as directory:
        try:
            result = checks[options.check](Bench(options.host, directory), options)
        except (Failure, subprocess.TimeoutExpired) as failure:
            print(f"{options.check}: FAILED: {failure}")
            sys.exit(1)
    print(f"{options.check}: {result}, {time.monotonic() - begin:.0f} s")


if __name__ == "__main__":
    main()
