#!/usr/bin/env python3
"""Runs the scenes of docs/report.md at several spacings and seeds: one line of JSON per run, behind those that are there.

    PYTHONPATH=build/python /usr/bin/python3 bench/report/pool.py bench/report/pool.jsonl

Some 500 CPU s. What is there is not run again: begin with an empty file for another library.
"""
from __future__ import annotations

import argparse
import dataclasses
import datetime
import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
from granperi import _report_runs as runs

import granperi

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "common"))

from batch import commit_of  # noqa: E402
from computer import processor  # noqa: E402

# The first rows do not say of what they are.
ENTERED = "c5e310b, f22daf8 and 7ec88e9 of 2026-11-26"


@dataclasses.dataclass(frozen=True)
class Study:
    """The length that the resolutions of a scene count in, and how many runs there are of each."""

    length: float  # m
    seeds: dict[int, int]


STUDIES = {
    "a125": Study(0.08, {8: 12, 16: 12, 24: 12, 32: 8, 40: 6, 48: 4, 64: 4, 96: 2}),
    "a5": Study(0.08, {6: 12, 8: 12, 10: 12, 12: 12, 16: 8, 20: 6, 24: 4, 32: 3, 48: 1}),
    "hopper": Study(0.05, {4: 12, 5: 12, 6: 12, 8: 10, 10: 8, 12: 5, 16: 4, 20: 3, 24: 1}),
    "one_side": Study(0.2, {10: 8, 20: 8, 30: 8, 40: 6, 50: 4, 60: 3, 80: 1}),
    "colliding": Study(0.02, {2: 8, 3: 8, 4: 8, 5: 6, 6: 4, 8: 3, 10: 1}),
    "low": Study(0.025, {4: 8, 6: 8, 8: 8, 10: 8, 12: 8, 16: 6, 20: 4, 24: 3, 32: 2}),
    "ramp": Study(0.08, {8: 8, 12: 8, 16: 8, 20: 6, 24: 6, 32: 4, 40: 3, 48: 1}),
}
QUANTITIES = {"hopper": {"left": lambda sim: np.mean(sim.y > 0)}}  # the share of the mass that is still in the bin


def read(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def origin(rows: list[dict[str, Any]]) -> str:
    """Of which sources, machines and days the runs are."""
    said, silent = [row for row in rows if "commit" in row], sum("commit" not in row for row in rows)
    parts = []
    if said:
        commits, machines, days = (sorted({row[name] for row in said}) for name in ("commit", "machine", "date"))
        parts.append(f"{len(said)} runs are of commit {', '.join(commits)}, on {' and '.join(machines)}, "
                     f"{' to '.join(sorted({days[0], days[-1]}))}")
    if silent:
        parts.append(f"{f'{silent} runs' if said else 'They'} do not say of which sources, machine and day they are: "
                     f"the commits {ENTERED} entered them")
    return "; ".join(parts) + "."


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _plain(one) for name, one in value.items()}
    if isinstance(value, float):
        return float(f"{value:.6g}") if math.isfinite(value) else None
    return value


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pool", type=Path)
    parser.add_argument("--only", nargs="+", choices=STUDIES, default=list(STUDIES), help="scenes [all]")
    options = parser.parse_args()
    about = {"commit": commit_of(HERE), "machine": processor(), "date": datetime.date.today().isoformat()}
    done = {(row["scene"], row["resolution"], row["seed"]) for row in read(options.pool)}
    # The runs of each resolution are spread over the whole time, so that what else the machine does is in the CPU times of all.
    spread = sorted(((seed - 0.5) / seeds, name, resolution, seed) for name in options.only
                    for resolution, seeds in STUDIES[name].seeds.items() for seed in range(1, seeds + 1))
    for _, name, resolution, seed in spread:
        if (name, resolution, seed) in done:
            continue
        scene = granperi.Scene.read(HERE / f"{name}.toml")
        one, _ = runs.measure(scene, STUDIES[name].length / resolution, seed, scene.run.end, QUANTITIES.get(name, {}))
        row = _plain({"scene": name, "resolution": resolution, **dataclasses.asdict(one), **about})
        del row["spacing"]
        with options.pool.open("a") as file:
            file.write(json.dumps(row) + "\n")
        print(f"{name} {resolution} {seed}: {one.cpu_seconds:.2f} CPU s", flush=True)


if __name__ == "__main__":
    main()
