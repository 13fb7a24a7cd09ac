#!/usr/bin/python3
"""Builds the library with the given options of CMake: size when stripped, what it needs and loads, how long the smallest
program takes to start. Lines of "name value unit" and "needs NAME"."""
from __future__ import annotations

import argparse
import os
import re
import resource
import subprocess
import tempfile
import time
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parents[2]
STARTS = 41


def call(*command: object) -> str:
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True).stdout


def start(program: Path, environment: dict[str, str]) -> tuple[float, float]:
    """Wall-clock and CPU s of one start."""
    begin = time.monotonic()
    pid = os.posix_spawn(program, [str(program)], environment)
    _, status, used = os.wait4(pid, 0)
    assert status == 0, "the smallest program failed"
    return time.monotonic() - begin, used.ru_utime + used.ru_stime


def print_library(library: Path, work: Path) -> None:
    stripped = work / "stripped.so"
    call("strip", "-o", stripped, library)
    print(f"size {library.stat().st_size} bytes")
    print(f"size_stripped {stripped.stat().st_size} bytes")
    for name in re.findall(r"NEEDED.*\[(.*)\]", call("readelf", "-dW", library)):
        print(f"needs {name}")
    print(f"loaded {len(re.findall(r'=>', call('ldd', library)))} libraries in all")


def print_start(library: Path, work: Path) -> None:
    program, empty, source = work / "smallest", work / "empty", work / "empty.c"
    source.write_text("int main(void) { return 0; }\n")
    call("cc", "-std=c99", "-O2", ROOT / "bench" / "smallest.c", "-I", ROOT / "include", "-o", program, library)
    call("cc", "-std=c99", "-O2", source, "-o", empty)
    environment = {**os.environ, "LD_LIBRARY_PATH": str(library.parent)}
    starts = [(start(program, environment), start(empty, environment)) for _ in range(STARTS)]
    print(f"start_cpu {1e3 * median(own[1] - base[1] for own, base in starts):.6g} ms, more than an empty program's")
    print(f"start_wall {1e3 * min(own[0] for own, _ in starts):.6g} ms, the shortest")
    print(f"start_empty {1e3 * min(base[0] for _, base in starts):.6g} ms, the shortest of an empty program")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, required=True, help="not used: every build is one of its own")
    parser.add_argument("options", nargs="*", metavar="NAME=VALUE")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        work = Path(scratch)
        parts = [f"-DGRANPERI_BUILD_{part}=OFF" for part in ("TESTS", "EXAMPLES", "FORTRAN", "BENCH")]
        options = [f"-DGRANPERI_{option}" for option in arguments.options]
        call("cmake", "-S", ROOT, "-B", work, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", *parts, *options)
        call("cmake", "--build", work, "--target", "granperi", "-j2")
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        library = (work / "libgranperi.so").resolve()
        print(f"build_cpu {used.ru_utime + used.ru_stime:.3f} s")
        print_library(library, work)
        print_start(library, work)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"cpu_seconds {used.ru_utime + used.ru_stime:.3f} s")


main()
