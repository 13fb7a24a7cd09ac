#!/usr/bin/python3
"""Instructions per particle and step of the smallest scene, and of the same with a feature that has nothing to do: by
callgrind, so that they do not depend on load. Lines of "name value unit"; status 3 without valgrind."""
from __future__ import annotations

import argparse
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

UNSUPPORTED = 3
STEPS = (60, 120)  # the difference is that of the steps alone


def count(program: Path, feature: str, state: str, steps: int, resolution: int) -> tuple[float, float]:
    """Instructions of one run, and its number of particles."""
    with tempfile.TemporaryDirectory() as work:
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={work}/out", str(program), feature]
        command += [
            "--alone",
            state,
            "--resolution",
            str(resolution),
            "--steps",
            str(steps),
            "--file",
            f"{work}/frames.h5",
        ]
        run = subprocess.run(command, capture_output=True, text=True, check=True)
        total = re.search(r"^(?:summary|totals): (\d+)", Path(work, "out").read_text(), re.M)
        particles = re.search(r"^particles (\d+)", run.stdout, re.M)
        assert total and particles
        return float(total[1]), float(particles[1])


def per_step(program: Path, feature: str, state: str, resolution: int) -> float:
    short, particles = count(program, feature, state, STEPS[0], resolution)
    long, _ = count(program, feature, state, STEPS[1], resolution)
    return (long - short) / particles / (STEPS[1] - STEPS[0])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--resolution", type=int, default=32)
    parser.add_argument("features", nargs="+")
    arguments = parser.parse_args()
    if not shutil.which("valgrind"):
        print("valgrind is not installed", file=sys.stderr)
        sys.exit(UNSUPPORTED)
    program = arguments.build / "bench" / "features"
    minimal = per_step(program, "none", "minimal", arguments.resolution)
    print(f"minimal {minimal:.6g} instructions/particle-step")
    for feature in arguments.features:
        idle = per_step(program, feature, "idle", arguments.resolution)
        print(f"{feature} {idle / minimal - 1:.6g} of the smallest scene's, more")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"cpu_seconds {used.ru_utime + used.ru_stime:.3f} s")


main()
