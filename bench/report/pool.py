#!/usr/bin/env python3
"""Runs the scenes of docs/report.md at several spacings and seeds, one JSON line per run, behind those that are there.

    PYTHONPATH=build/python /usr/bin/python3 bench/report/pool.py bench/report/pool.jsonl

What has run once is not run again; a file of its own for another library.
"""
from __future__ import annotations

import argparse
import dataclasses
import json
from pathlib import Path

import numpy as np

import granperi
from granperi import _report_runs as runs

HERE = Path(__file__).parent


@dataclasses.dataclass(frozen=True)
class Study:
    """The length that the resolutions of a scene count in, and how many runs there are of each. The finest is the truth."""

    length: float  # m
    seeds: dict[int, int]


STUDIES = {
    "a125": Study(0.08, {8: 12, 16: 12, 24: 12, 32: 8, 40: 6, 48: 4, 64: 4, 96: 2}),
    "a5": Study(0.08, {6: 12, 8: 12, 10: 12, 12: 12, 16: 8, 20: 6, 24: 4, 32: 3, 48: 1}),
    "hopper": Study(0.05, {4: 12, 5: 12, 6: 12, 8: 10, 10: 8, 12: 5, 16: 4, 20: 3, 24: 1}),
}
QUANTITIES = {"hopper": {"left": lambda sim: float(np.mean(sim.y > 0))}}


def read(path: Path) -> list[dict]:
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pool", type=Path)
    parser.add_argument("--only", nargs="+", choices=STUDIES, default=list(STUDIES))
    options = parser.parse_args()
    done = {(row["scene"], row["resolution"], row["seed"]) for row in read(options.pool)}
    cheapest_first = sorted((resolution / min(STUDIES[name].seeds), name, resolution, seed) for name in options.only
                            for resolution, seeds in STUDIES[name].seeds.items() for seed in range(1, seeds + 1))
    for _, name, resolution, seed in cheapest_first:
        if (name, resolution, seed) in done:
            continue
        scene = granperi.Scene.read(HERE / f"{name}.toml")
        one, _ = runs.measure(scene, STUDIES[name].length / resolution, seed, scene.run.end, QUANTITIES.get(name, {}))
        row = {"scene": name, "resolution": resolution, **dataclasses.asdict(one)}
        with options.pool.open("a") as file:
            file.write(json.dumps(row) + "\n")
        print(f"{name} {resolution} {seed}: {one.cpu_seconds:.2f} s", flush=True)


if __name__ == "__main__":
    main()
