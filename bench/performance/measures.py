"""Errors, what they cost, and which settings no other one beats."""
from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Iterable, Sequence, TypeVar

import numpy as np

import runs
from results import Collection, Result

sys.path.append(str(Path(__file__).resolve().parents[1] / "validation"))
from references import INDEPENDENT_CODES  # noqa: E402

QUANTITIES = {
    "peak": "peak",
    "bulk": "run-out of 90 % of the mass",
    "spread": "run-out of 98 % of the mass",
    "front": "run-out of the front (0.05 H thick)",
    "tip": "run-out of the tips",
}
SHORT = {
    "peak": "peak",
    "bulk": "run-out, 90 %",
    "spread": "run-out, 98 %",
    "front": "run-out, front",
    "tip": "run-out, tips",
}
AIMED_AT = ("peak", "bulk")  # what "the error" of a deposit is about
AIM = 0.02
SURE = 2.0  # standard errors
DIVERGENT = 0.5  # share of the runs: beyond, an ensemble has no error


@dataclass(frozen=True)
class Reference:
    """The converged deposit: means of the finest ensemble, in units of L0 or m, and their standard errors."""

    resolution: int
    seeds: int
    value: dict[str, float]
    error: dict[str, float]
    result: Result


def _good(result: Result, column: str) -> np.ndarray:
    """Of the runs that did not diverge. None where the result is older than the measure."""
    seeds = result.tables["seeds"]
    if column not in seeds:
        return np.array([])
    return seeds[column][(seeds["diverged"] == 0) & ~np.isnan(seeds[column])]


def _finest_first(scene: str) -> list[tuple[int, runs.Run]]:
    """What the converged solution may be taken from."""
    s = runs.SCENES[scene]
    found = [(r, runs.reference(scene, r)) for r in sorted(s.references, reverse=True)]
    return found + [(r, runs.collapse(scene, r)) for r in sorted(s.resolutions, reverse=True)]


def reference(results: Collection, scene: str) -> Reference | None:
    """The finest that is there; where none of the references is, the finest ensemble of the default scheme."""
    for resolution, run in _finest_first(scene):
        result = results(run)
        if result:
            values, one = {q: _good(result, q) for q in QUANTITIES}, scatter(results, scene)
            return Reference(
                resolution,
                len(values["peak"]),
                {q: mean(result, q) for q in QUANTITIES},
                {q: _standard_error(v, one.get(q, math.nan)) for q, v in values.items()},
                result,
            )
    return None


def _standard_error(values: np.ndarray, one: float) -> float:
    """one: the scatter of a run, where a single one cannot tell it."""
    scattered = float(np.std(values, ddof=1)) if len(values) > 1 else one
    return scattered / math.sqrt(max(1, len(values)))


def scatter(results: Collection, scene: str) -> dict[str, float]:
    """Standard deviation of one run, of the finest ensemble of three or more."""
    for _, run in _finest_first(scene):
        result = results(run)
        if result and len(_good(result, "peak")) > 2:
            return {q: float(np.std(_good(result, q), ddof=1)) for q in QUANTITIES if len(_good(result, q)) > 2}
    return {}


def mean(result: Result, quantity: str) -> float:
    values = _good(result, quantity)
    return float(np.mean(values)) if len(values) else math.nan


@dataclass(frozen=True)
class Error:
    """Of an ensemble against the reference, as shares of it. one_run: root mean square of its runs: what a single run is
    off by its bias and its scatter together. The doubts are two standard errors, the reference's included."""

    bias: float
    bias_doubt: float
    one_run: float
    one_run_doubt: float


def error(result: Result, ref: Reference, quantity: str) -> Error:
    values, exact = _good(result, quantity), ref.value[quantity]
    if len(values) < DIVERGENT * len(result.tables["seeds"]["seed"]) or len(values) == 0:
        return Error(math.nan, math.nan, math.nan, math.nan)
    off = values / exact - 1
    of_reference = ref.error[quantity] / exact
    n = len(off)
    own = float(np.std(off, ddof=1)) / math.sqrt(n) if n > 1 else math.nan
    one_run = math.sqrt(float(np.mean(off**2)))
    squares = float(np.std(off**2, ddof=1)) / math.sqrt(n) / (2 * one_run) if n > 1 and one_run > 0 else math.nan
    bias = float(np.mean(off))
    return Error(
        bias,
        SURE * math.hypot(own, of_reference),
        one_run,
        SURE * math.hypot(squares, of_reference * abs(bias) / one_run if one_run > 0 else of_reference),
    )


def cost(result: Result) -> float:
    """CPU s of one run per simulated s, which is what one run to 1 s costs."""
    return result.cpu / len(result.tables["seeds"]["peak"]) / runs.END


@dataclass(frozen=True)
class Point:
    """One setting of one scene."""

    label: str
    resolution: int
    horizon: float
    setting: str  # "" for those of the horizons
    cost: float
    result: Result


def points(results: Collection, scene: str) -> list[Point]:
    """Every setting that has been run to its end."""
    s = runs.SCENES[scene]
    found = []
    for h in s.horizons:
        for r in s.resolutions:
            result = results(runs.collapse(scene, r, h))
            if result:
                found.append(Point(f"horizon {h:g}", r, h, "", cost(result), result))
    for key, r in runs.settings_of(scene):
        result = results(runs.varied(scene, r, key))
        if result:
            setting = runs.SETTINGS[key]
            found.append(Point(setting.label, r, setting.horizon, key, cost(result), result))
    return found


def worst(result: Result, ref: Reference) -> float:
    """Error of one run, of the peak and the run-out whichever is larger."""
    return largest(error(result, ref, q).one_run for q in AIMED_AT)


def largest(values: Iterable[float]) -> float:
    """NaN if one of them is."""
    found = list(values)
    return math.nan if any(map(math.isnan, found)) else max(found)


def cheapest(points: list[Point], measure: Callable[[Point], float], aim: float) -> Point | None:
    """That is within the aim with all finer ones of its setting: an error may pass through zero on its way."""

    def reached(p: Point) -> bool:
        return all(measure(one) <= aim for one in points if one.label == p.label and one.resolution >= p.resolution)

    return min((p for p in points if reached(p)), key=lambda p: p.cost, default=None)


Item = TypeVar("Item")


def pareto(items: Sequence[Item], places: Sequence[tuple[float, float]]) -> list[Item]:
    """Those for which no other one is both cheaper and better, cheapest first. places: cost and error."""
    front: list[Item] = []
    best = math.inf
    for place, item in sorted(zip(places, items), key=lambda pair: pair[0]):
        if not math.isnan(place[1]) and place[1] < best:
            front.append(item)
            best = place[1]
    return front


@dataclass(frozen=True)
class Peer:
    """Another code's run of a = 1.25, and its error against our converged solution."""

    label: str
    method: str
    resolution: int | None
    cost: float
    inflated: bool
    peak: float
    tip: float


def peers(ref: Reference) -> list[Peer]:
    """Those with the friction as given. Their run-out is that of their front."""
    length = runs.SCENES["a1.25"].length
    return [
        Peer(code, method, resolution, cpu, busy, peak * length / ref.value["peak"] - 1, run_out / ref.value["tip"] - 1)
        for code, method, resolution, cpu, _, peak, run_out, busy in INDEPENDENT_CODES
        if cpu is not None
    ]


def at_error(costs: Iterable[float], errors: Iterable[float], aim: float) -> float:
    """Cost at which a curve of errors first falls to the aim and stays there, between two points by their logarithms; NaN
    if it does not."""
    curve = sorted(zip(costs, errors))
    for k in range(len(curve)):
        if all(e <= aim for _, e in curve[k:]):
            if k == 0:
                return curve[0][0]
            (c0, e0), (c1, e1) = curve[k - 1], curve[k]
            share = math.log(e0 / aim) / math.log(e0 / e1)
            return math.exp(math.log(c0) + share * math.log(c1 / c0))
    return math.nan
