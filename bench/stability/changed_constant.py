#!/usr/bin/python3
"""Runs a program of the build with a library in which one constant of the engine has another value.

The sources are copied into constants/ in the build directory and the library is compiled there: all of it the first time, afterwards
only what the constant is in. The sources themselves stay as they are, and so does the program, which loads that library in place
of its own. Its summary ends with the CPU time of compiler and program."""
from __future__ import annotations

import argparse
import fcntl
import os
import re
import resource
import shutil
import subprocess
import sys
from pathlib import Path

from constants import CONSTANTS, Constant

ROOT = Path(__file__).resolve().parents[2]
PARTS = ("CMakeLists.txt", "cmake", "include", "pkgconfig", "src")  # what the library is made of
LIBRARY = "libgranperi.so"


def copy_sources(target: Path, constant: Constant, value: str) -> None:
    """Writes only what differs from what is there, so that only that is compiled."""
    paths = [path for part in PARTS for path in (ROOT / part, *sorted((ROOT / part).rglob("*"))) if path.is_file()]
    for path in paths:
        name = path.relative_to(ROOT)
        wanted = constant.changed(ROOT, value) if str(name) == constant.file else path.read_bytes()
        copy = target / name
        if not copy.exists() or copy.read_bytes() != wanted:
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(wanted)


def call(*command: str) -> None:
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{done.stdout}\n{command[0]} failed")


def build_library(place: Path, constant: Constant, value: str) -> Path:
    """One at a time: all share a copy of the sources."""
    place.mkdir(parents=True, exist_ok=True)
    source, build = place / "source", place / "build"
    with (place / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        copy_sources(source, constant, value)
        if not (build / "build.ninja").exists():
            options = ["HDF5=OFF", "MPI=OFF", "LEVEL=native"]
            options += [f"BUILD_{name}=OFF" for name in ("TESTS", "EXAMPLES", "BENCH", "PYTHON", "FORTRAN")]
            call(
                "cmake", "-S", str(source), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                *(f"-DGRANPERI_{option}" for option in options),
            )  # fmt: skip
        call("cmake", "--build", str(build), "--target", "granperi", "--parallel", "2")
        made = place / f"{constant.name}_{value}" / LIBRARY
        made.parent.mkdir(exist_ok=True)
        shutil.copy(build / LIBRARY, made)
    return made


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, default=ROOT / "build", help="where the program is [build]")
    parser.add_argument("constant", choices=[c.name for c in CONSTANTS])
    parser.add_argument("value")
    parser.add_argument("program", help="in bench/ of the build")
    parser.add_argument("arguments", nargs=argparse.REMAINDER, help="its own")
    given = parser.parse_args()
    constant = next(c for c in CONSTANTS if c.name == given.constant)
    library = build_library(given.build.resolve() / "constants", constant, given.value)
    done = subprocess.run(
        [str(given.build / "bench" / given.program), *given.arguments], stdout=subprocess.PIPE, text=True, check=False,
        env={**os.environ, "LD_PRELOAD": str(library)},
    )  # fmt: skip
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(re.sub(r"^cpu_seconds .*\n", "", done.stdout, flags=re.M), end="")
    print(f"cpu_seconds {spent.ru_utime + spent.ru_stime:.2f} s")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
