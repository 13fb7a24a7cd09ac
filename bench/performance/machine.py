#!/usr/bin/python3
"""What the figures were measured on: processor, caches, cores, compiler, load. Lines of "name value unit"."""
from __future__ import annotations

import argparse
import os
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "common"))

from computer import compiler, processor

CACHES = Path("/sys/devices/system/cpu/cpu0/cache")
UNITS = {"K": 1 << 10, "M": 1 << 20, "G": 1 << 30}


def caches() -> dict[int, float]:
    """Bytes by level, of one core's own or of the share that it sees."""
    found = {}
    for entry in sorted(CACHES.glob("index*")):
        size = re.fullmatch(r"(\d+)([KMG])", (entry / "size").read_text().strip())
        if size and (entry / "type").read_text().strip() != "Instruction":
            found[int((entry / "level").read_text())] = float(size[1]) * UNITS[size[2]]
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, required=True)
    arguments = parser.parse_args()
    print(f"processor: {processor()}")
    print(f"compiler: {compiler(arguments.build)}")
    print(f"cores {os.cpu_count()} 1")
    for level, size in caches().items():
        print(f"cache_{level} {size:.0f} bytes")
    print(f"load {os.getloadavg()[2]:.2f} over 15 minutes")
    print("cpu_seconds 0 s")


main()
