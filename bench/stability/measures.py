"""Quantities that tables and figures share."""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

import runs
from coefficients import CRITERION, Coefficient
from markdown import NONE, signed
from results import Collection, Result

QUANTITIES = {"peak": "peak", "bulk": "run-out of 90 % of the mass", "spread": "run-out of 98 % of the mass"}
SURE = 2.0  # standard errors


@dataclass(frozen=True)
class Mean:
    """Of an ensemble; NaN where nothing is known."""

    value: float
    scatter: float  # standard deviation of one run
    error: float  # standard error of the mean


def mean(result: Result, column: str) -> Mean:
    values = result.tables["seeds"][column]
    values = values[~np.isnan(values)]
    if len(values) == 0:
        return Mean(math.nan, math.nan, math.nan)
    scatter = float(np.std(values, ddof=1)) if len(values) > 1 else math.nan
    return Mean(float(np.mean(values)), scatter, scatter / math.sqrt(len(values)))


@dataclass(frozen=True)
class Change:
    """Of a mean against that of the defaults, and what the scatter of both leaves open (two standard errors)."""

    value: float
    doubt: float

    @property
    def text(self) -> str:
        return NONE if math.isnan(self.value) else f"{signed(100 * self.value, 1)} ± {100 * self.doubt:.1f} %"

    @property
    def verdict(self) -> str:
        size = abs(self.value)
        if math.isnan(size):
            return ""
        if size + self.doubt <= CRITERION:
            return "passes"
        if size - self.doubt > CRITERION:
            return "FAILS"
        return "passes within doubt" if size <= CRITERION else "fails within doubt"


def change(result: Result, base: Result, column: str) -> Change:
    a, b = mean(result, column), mean(base, column)
    value = a.value / b.value - 1
    return Change(value, SURE * math.hypot(a.error / b.value, b.error * a.value / b.value**2))


def changes(results: Collection, c: Coefficient, resolution: int, column: str) -> list[tuple[float, Change]]:
    """For half and twice the default, or as near as the library takes."""
    base = results(runs.base_ensemble(resolution))
    found = [(value, results(runs.varied(c, value, resolution))) for value in (c.half, c.twice)]
    return [(value, change(result, base, column)) for value, result in found if result and base]


def same_bits(a: Result, b: Result) -> bool:
    """Whether the seeds that both have ended the same, to all digits written."""
    n = min(len(a.tables["seeds"]["peak"]), len(b.tables["seeds"]["peak"]))
    return all(
        np.array_equal(a.tables["seeds"][column][:n], b.tables["seeds"][column][:n], equal_nan=True)
        for column in a.tables["seeds"]
    )


def share_at_rest(result: Result) -> float:
    rest = result.tables["seeds"]["rest"]
    return float(np.mean(~np.isnan(rest)))


def between(result: Result, column: str, low: float, high: float) -> np.ndarray:
    """A column of the series over an interval of time."""
    series = result.tables["series"]
    return series[column][(series["time"] >= low) & (series["time"] <= high)]


def root_mean_square(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else math.nan


def decay_rate(result: Result) -> float:
    """1/s, of the kinetic energy from the start to a tenth of it or to the end."""
    series = result.tables["series"]
    time, energy = series["time"], series["kinetic_share"]
    first = energy > 0.1 * energy[0]
    last = len(first) if first.all() else int(np.argmin(first))
    if last < 3:
        last = 3
    return -float(np.polyfit(time[:last], np.log(energy[:last]), 1)[0])
