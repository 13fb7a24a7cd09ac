"""Other public particle codes' throughput and memory, one thread. validation/references.py has their runs of the collapse, of the same
machine, aims.json those of Matter on another one."""
from __future__ import annotations

import functools
import json
import sys
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).resolve().parents[1] / "validation"))
from references import INDEPENDENT_CODES  # noqa: E402

SAME = "c = 10 m/s"  # the sound speed of ours, too: ten times the fastest flow of the column
ANOTHER_MACHINE = "a machine of two x86-64 cores (51 GFLOP/s double, 17 GB/s copy per core)"

# Code, precision, neighbours of a particle, million particle-steps per s at 1e3, 1e4, 1e5 particles, ns per neighbour.
THROUGHPUT = [
    ("DualSPHysics 5.4, CPU (SPH)", "single, positions double", "47", (0.47, 0.53, 0.54), 40.0),
    ("LAMMPS peri/pmb", "double", "46", (0.68, 0.54, 0.50), 40.0),
    ("LAMMPS peri/lps (state-based peridynamics)", "double", "46", (0.33, 0.29, 0.25), 74.0),
    ("PySPH 1.0b1", "double", "20", (0.38, 0.48, 0.45), 105.0),
    ("Matter (MPM)", "double", "9 nodes", (1.65, 1.73, 2.08), None),
    ("LAMMPS gran/hooke (DEM)", "double", "6", (10.8, 5.2, 4.4), 32.0),
]
OUR_NEIGHBOURS = 48  # of a particle inside, horizon 4

MEMORY = {"Matter (MPM)": 244}  # bytes per particle at the peak, a million particles


@functools.lru_cache(maxsize=1)
def matter() -> dict[str, Any]:
    """Its runs of the collapse on the first machine: "mpm" of aims.json (aims.py says what that is)."""
    return json.loads(Path(__file__).with_name("aims.json").read_text(encoding="utf-8"))["mpm"]


def matter_run_outs() -> list[float]:
    """Of 90 % of the mass, at each spacing, with either sound speed."""
    return [run_out for curve in (SAME, "tuned") for *_, run_out in matter()[curve]]


def second_machine() -> dict[int, float]:
    """CPU s of Matter by L/dl on ANOTHER_MACHINE."""
    return {n: cpu for code, _, n, cpu, *_ in INDEPENDENT_CODES if n and cpu and code.startswith("Matter") and SAME in code}
