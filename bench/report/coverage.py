#!/usr/bin/env python3
"""How often the errors that granperi.report states hold (docs/report.md): reports drawn from one pool of runs.

A case is a scene, a quantity and a ladder of spacings. Many reports are drawn of each: some runs of each spacing, without doubles.
The truth is the mean of the finest runs, which no ladder has.
"""
from __future__ import annotations

import argparse
import dataclasses
import itertools
import json
import math
from collections import defaultdict
from pathlib import Path

import numpy as np

from granperi import _report_statistics as statistics

LADDERS = {
    "a125": [(8, 16, 24), (8, 16, 24, 32), (16, 24, 32), (16, 24, 40)],
    "a5": [(6, 8, 12), (6, 8, 10, 12), (8, 12, 16), (8, 10, 12, 16)],
    "hopper": [(4, 5, 6, 8), (4, 6, 8), (5, 8, 12), (4, 6, 8, 12)],
}
TRUTH = {"a125": (64, 96), "a5": (32, 48), "hopper": (20, 24)}
QUANTITIES = {
    "a125": ("peak_height", "width_50", "width_90", "width_98", "rest_time"),
    "a5": ("peak_height", "width_50", "width_90", "width_98", "rest_time"),
    "hopper": ("peak_height", "width_50", "width_90", "width_98", "left"),
}
NEXT = {24: 32, 32: 48, 12: 16, 16: 24, 8: 12, 40: 48}  # resolutions that the report has not run: their stated errors


def read(paths: list[Path]) -> dict[tuple[str, str], dict[int, list[float]]]:
    """(scene, quantity): resolution: values of the runs."""
    values: dict = defaultdict(lambda: defaultdict(list))
    for path in paths:
        for line in path.read_text().splitlines():
            row = json.loads(line)
            for name, value in row["values"].items():
                values[row["scene"], name][row["resolution"]].append(value)
    return values


@dataclasses.dataclass(frozen=True)
class Drawn:
    """One report: stated error over true error, of the mean and of one other run at its finest spacing, and beyond."""

    mean: float
    one: float
    beyond: float
    verdict: str


def draw(values: dict[int, list[float]], ladder: tuple[int, ...], truth: float, seeds: int, rng) -> Drawn:
    sample, rest = {}, {}
    for n in ladder:
        order = rng.permutation(len(values[n]))
        take = min(seeds, len(order) - 1)
        sample[1 / n] = [values[n][k] for k in order[:take]]
        rest[n] = [values[n][k] for k in order[take:]]
    found = statistics.Convergence(sample)
    n = ladder[-1]
    error = abs(np.mean(sample[1 / n]) - truth)
    one = abs(rng.choice(rest[n]) - truth)
    next_one = NEXT.get(n)
    beyond = math.nan
    if next_one in values and len(values[next_one]):
        beyond = found.error(1 / next_one, 1) / max(1e-12, abs(rng.choice(values[next_one]) - truth))
    return Drawn(found.error(1 / n, len(sample[1 / n])) / max(1e-12, error), found.error(1 / n, 1) / max(1e-12, one), beyond,
                 getattr(found, "verdict", ""))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pool", type=Path, nargs="+")
    parser.add_argument("--draws", type=int, default=40)
    parser.add_argument("--seeds", type=int, default=4, help="runs per spacing of a report")
    options = parser.parse_args()
    values, rng = read(options.pool), np.random.default_rng(1)
    total = []
    for scene in LADDERS:
        for name, ladder in itertools.product(QUANTITIES[scene], LADDERS[scene]):
            of = values[scene, name]
            fine = [v for n in TRUTH[scene] for v in of.get(n, [])]
            if not fine or any(len(of.get(n, [])) < 3 for n in ladder) or ladder[-1] >= min(TRUTH[scene]):
                continue
            truth = float(np.mean(fine))
            drawn = [draw(of, ladder, truth, options.seeds, rng) for _ in range(options.draws)]
            total += drawn
            mean, one, beyond = (np.array([getattr(d, what) for d in drawn]) for what in ("mean", "one", "beyond"))
            means = [np.mean(of[n]) / truth - 1 for n in ladder]
            print(f"{scene:7}{name:12}{str(ladder):18} mean {100 * np.mean(mean >= 1):3.0f} % ratio {np.median(mean):5.2f}  "
                  f"one {100 * np.mean(one >= 1):3.0f} % {np.median(one):5.2f}  beyond {100 * np.mean(beyond >= 1):3.0f} % "
                  f"{np.median(beyond):5.2f}  bias " + " ".join(f"{100 * m:+.1f}" for m in means)
                  + "  " + ",".join(f"{v}:{k}" for v, k in zip(*np.unique([d.verdict for d in drawn], return_counts=True))))
    for what in ("mean", "one", "beyond"):
        ratio = np.array([getattr(d, what) for d in total])
        ratio = ratio[np.isfinite(ratio)]
        print(f"{what}: {len(ratio)} held {100 * np.mean(ratio >= 1):.0f} %, at most 3 times too wide "
              f"{100 * np.mean(ratio <= 3):.0f} %")


if __name__ == "__main__":
    main()
