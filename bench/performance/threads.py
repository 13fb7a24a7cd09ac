#!/usr/bin/python3
"""Wall-clock and CPU time of a step with one thread and with several, in turn: medians. Lines of "name value unit". Says
something only on a machine at rest: the load is printed, too."""
from __future__ import annotations

import argparse
import os
import re
import resource
import subprocess
from pathlib import Path
from statistics import median


def measure(program: Path, resolution: int, threads: int, steps: int) -> dict[str, float]:
    command = [
        str(program),
        "--resolution",
        str(resolution),
        "--from",
        "0",
        "--steps",
        str(steps),
        "--threads",
        str(threads),
    ]
    run = subprocess.run(
        command, capture_output=True, text=True, check=True, env={**os.environ, "OMP_WAIT_POLICY": "passive"}
    )
    return {name: float(value) for name, value in re.findall(r"^(\w+) (\S+)", run.stdout, re.M)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--resolution", type=int, required=True)
    parser.add_argument("--steps", type=int, required=True)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeat", type=int, default=7)
    arguments = parser.parse_args()
    program = arguments.build / "bench" / "step"
    pairs = [
        [measure(program, arguments.resolution, threads, arguments.steps) for threads in (1, arguments.threads)]
        for _ in range(arguments.repeat)
    ]
    print(f"particles {pairs[0][0]['particles']:.0f} 1")
    print(f"wall_one {median(one['wall'] for one, _ in pairs):.6g} ns/particle-step")
    print(f"wall_several {median(several['wall'] for _, several in pairs):.6g} ns/particle-step")
    print(f"speed_up {median(one['wall'] / several['wall'] for one, several in pairs):.6g} of the wall-clock time")
    print(f"more_cpu {median(several['cpu'] / one['cpu'] for one, several in pairs) - 1:.6g} of the CPU time, more")
    print(f"load {os.getloadavg()[0]:.2f} over a minute")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"cpu_seconds {used.ru_utime + used.ru_stime:.3f} s")


main()
