"""How often the errors hold that granperi.report states: reports drawn from one pool of runs.

A case is a scene, a quantity and a ladder of spacings. Many reports are drawn of each: some runs of each spacing, none twice. The
truth is the mean of the finest runs, which no ladder has.
"""
from __future__ import annotations

import dataclasses
import itertools
import math
from collections import defaultdict
from typing import Any, Iterable, Iterator

import numpy as np
from granperi import _report_ladder as ladder_costs
from granperi import _report_runs as runs
from granperi import _report_statistics as statistics

SEEDS = 4  # runs of each spacing of a report
LADDERS = {
    "a125": [(8, 16, 24), (8, 16, 24, 32), (16, 24, 32), (16, 24, 40)],
    "a5": [(6, 8, 12), (6, 8, 10, 12), (8, 12, 16), (8, 10, 12, 16)],
    "hopper": [(4, 5, 6, 8), (4, 6, 8), (5, 8, 12), (4, 6, 8, 12)],
    "one_side": [(10, 20, 30), (10, 20, 30, 40), (20, 30, 40)],
    "colliding": [(2, 3, 4), (2, 3, 4, 5), (3, 4, 5), (3, 4, 6)],
    "low": [(4, 6, 8), (4, 6, 8, 12), (6, 8, 12), (6, 8, 12, 16)],
    "ramp": [(8, 12, 16), (8, 12, 16, 20), (12, 16, 24), (12, 16, 20, 24)],
}
GROWING = {"a125": (8, 16, 24, 32, 40), "a5": (6, 8, 10, 12, 16), "hopper": (4, 5, 6, 8, 12), "one_side": (10, 20, 30, 40, 50),
           "colliding": (2, 3, 4, 5, 6), "low": (4, 6, 8, 12, 16), "ramp": (8, 12, 16, 20, 24)}
LATER = ("one_side", "colliding", "low", "ramp")  # run once bounds and shares had been chosen by the others
TRUTH = {"a125": (64, 96), "a5": (32, 48), "hopper": (20, 24), "one_side": (60, 80), "colliding": (8, 10),
         "low": (24, 32), "ramp": (40, 48)}
QUANTITIES = {
    "a125": ("peak_height", "width_50", "width_90", "width_98", "rest_time"),
    "a5": ("peak_height", "width_50", "width_90", "width_98", "rest_time"),
    "hopper": ("peak_height", "width_50", "width_90", "width_98", "left"),
    "one_side": ("peak_height", "x_q75", "x_q95", "x_q99", "rest_time"),
    "colliding": ("peak_height", "width_50", "width_90", "width_98", "rest_time"),
    "low": ("peak_height", "width_50", "width_90", "width_98", "rest_time"),
    "ramp": ("peak_height", "x_q75", "x_q95", "x_q99", "rest_time"),
}

Values = dict[tuple[str, str], dict[int, list[float]]]


@dataclasses.dataclass(frozen=True)
class Drawn:
    """One report: relative true and stated error of the mean and of one more run at its finest spacing, and of one run at a
    finer one."""

    scene: str
    quantity: str
    ladder: tuple[int, ...]
    verdict: str
    mean: tuple[float, float]
    one: tuple[float, float]
    finer: tuple[float, float]


def values_of(rows: Iterable[dict[str, Any]]) -> Values:
    """(scene, quantity): resolution: values of the runs."""
    values: Values = defaultdict(lambda: defaultdict(list))
    for row in rows:
        for name, value in row["values"].items():
            values[row["scene"], name][row["resolution"]].append(value)
    return values


def cases() -> Iterator[tuple[str, str, tuple[int, ...]]]:
    for scene, ladders in LADDERS.items():
        yield from ((scene, *case) for case in itertools.product(QUANTITIES[scene], ladders))


def truth(values: Values, scene: str, quantity: str) -> float:
    return float(np.mean([value for n in TRUTH[scene] for value in values[scene, quantity][n]]))


def draw(values: Values, scene: str, quantity: str, ladder: tuple[int, ...], rng: np.random.Generator) -> Drawn:
    of, right = values[scene, quantity], truth(values, scene, quantity)
    sample, others = {}, {}
    for n in ladder:
        order = rng.permutation(len(of[n]))
        take = min(SEEDS, len(order) - 1)
        sample[1 / n] = [of[n][k] for k in order[:take]]
        others[n] = [of[n][k] for k in order[take:]]
    found, n = statistics.Convergence(sample), ladder[-1]
    finer = min(m for m in of if m >= 1.2 * n)

    def pair(value: float, stated: float) -> tuple[float, float]:
        return abs(value / right - 1), stated / abs(right)

    return Drawn(scene, quantity, ladder, found.verdict,
                 pair(float(np.mean(sample[1 / n])), found.error(1 / n, len(sample[1 / n]))),
                 pair(float(rng.choice(others[n])), found.error(1 / n)),
                 pair(float(rng.choice(of[finer])), found.error(1 / finer)))


def draw_all(values: Values, draws: int, later: bool = False) -> list[Drawn]:
    """later: of the scenes that had no part in the choices, else of the others."""
    rng = np.random.default_rng(1)
    return [draw(values, *case, rng) for case in cases() if (case[0] in LATER) == later for _ in range(draws)]


def grow(values: Values, draws: int, accuracy: float, later: bool, kept: int = 9) -> list[tuple[float, float]]:
    """True and stated error of the mean where a report ends that takes a finer spacing as long as what it states is above an accuracy.
    kept: spacings that it goes by, the finest ones."""
    rng, found = np.random.default_rng(1), []
    for scene, ladder in GROWING.items():
        for quantity in QUANTITIES[scene] if (scene in LATER) == later else ():
            of, right = values[scene, quantity], truth(values, scene, quantity)
            for _ in range(draws):
                sample = {n: rng.permutation(of[n])[:min(SEEDS, len(of[n]) - 1)] for n in ladder}
                for count in range(3, len(ladder) + 1):
                    seen, n = ladder[max(0, count - kept):count], ladder[count - 1]
                    stated = statistics.Convergence({1 / k: list(sample[k]) for k in seen}).error(1 / n, len(sample[n])) / abs(right)
                    if stated <= accuracy:
                        break
                found.append((abs(float(np.mean(sample[n])) / right - 1), stated))
    return found


def held(drawn: Iterable[Drawn], what: str) -> tuple[float, float, float]:
    """Share of the errors that are below the stated one, share of the stated ones that are at most three times the true one, and the
    median of that ratio."""
    pairs = np.array([getattr(one, what) for one in drawn])
    ratio = pairs[:, 1] / np.maximum(pairs[:, 0], 1e-12)
    return float(np.mean(ratio >= 1)), float(np.mean(ratio <= 3)), float(np.median(ratio))


def cost_forecasts(rows: list[dict[str, Any]]) -> list[tuple[str, tuple[int, ...], int, float, float]]:
    """Scene, ladder, finer resolution, CPU s of a run as forecast and as it was (the median)."""
    by: dict = defaultdict(lambda: defaultdict(list))
    for row in rows:
        rest = math.nan if row["cpu_to_rest"] is None else row["cpu_to_rest"]
        by[row["scene"]][row["resolution"]].append(runs.Measured(
            1 / row["resolution"], row["seed"], row["particles"], row["steps"], row["cpu_seconds"], rest, {}))
    found = []
    for scene, ladders in LADDERS.items():
        for ladder in ladders:
            cost = ladder_costs.Cost([run for n in ladder for run in by[scene][n][:SEEDS]])
            found += [(scene, ladder, n, cost.seconds(1 / n), float(np.median([run.cpu_seconds for run in by[scene][n]])))
                      for n in sorted(by[scene]) if ladder[-1] < n <= 2 * ladder[-1]]
    return found
