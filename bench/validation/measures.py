"""Quantities that tables and figures share, from one result each."""
from __future__ import annotations

import math

import numpy as np

import references as ref
from results import Result


def peak(result: Result, time: float = ref.PEAK_TIME) -> float:
    """Highest point over L, of the paper's two-sided columns."""
    return result.at("peak_height", time) / ref.WIDTH


def run_out_at(result: Result, time: float, share: str = "90") -> float:
    """(x - L0)/L0 of 90 or 98 % of the mass (bench/marks.h), mean of both sides; "tip": of the connected deposit's ends."""
    return result.at("tip" if share == "tip" else f"run_out_{share}", time)


def contact_front(result: Result, time: float, height: float, threshold: float) -> float:
    """Outermost x/H0 at which the surface is above the threshold x H0, mean of both sides, as in references.py."""
    x, surface = result.surface(time, everything=True)
    above = x[surface > threshold * height]
    return float((above.max() - above.min()) / 2 / height) if len(above) else math.nan


def section_speed(result: Result, time: float, y: float) -> float:
    """Mean |u| (m/s) over the particles of a horizontal section."""
    rows = result.select("section", time, y=y)
    return float(np.average(rows["speed"], weights=rows["particles"])) if rows and len(rows["speed"]) else math.nan


def couette_profile(result: Result) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Depth below the plate / d, u/U, and the exact u/U: the lines of the program that are three numbers."""
    rows = []
    for line in result.output.splitlines():
        words = line.split()
        try:
            numbers = [float(word) for word in words]
        except ValueError:
            continue
        if len(numbers) == 3:
            rows.append(numbers)
    table = np.array(rows).reshape(-1, 3)
    return table[:, 0], table[:, 1], table[:, 2]


def exact_error(result: Result) -> tuple[float, str]:
    """The error of a run against an exact solution, without its sign, and what the program says it is."""
    for name in ("error", "error_max", "error_l2"):
        if name in result.summary:
            line = next(line for line in result.output.splitlines() if line.split()[:1] == [name])
            return abs(result.summary[name]), " ".join(line.split()[2:])
    return math.nan, ""


def interface_spread(result: Result, time: float, fits: list[tuple[float, float]]) -> tuple[float, float]:
    """Smallest and largest |angle| (degrees) over several choices of the part of the interface that is fitted."""
    angles = [abs(result.interface_angle(time, low, high)) for low, high in fits]
    angles = [angle for angle in angles if not math.isnan(angle)]
    return (min(angles), max(angles)) if angles else (math.nan, math.nan)


def surface_difference(one: Result, other: Result, time: float) -> float:
    """Mean distance of two surfaces (m) over the length that either covers."""
    (x1, h1), (x2, h2) = one.surface(time, everything=True), other.surface(time, everything=True)
    if not len(x1) or not len(x2):
        return math.nan
    x = np.linspace(min(x1[0], x2[0]), max(x1[-1], x2[-1]), 800)
    return float(np.mean(np.abs(np.interp(x, x1, h1, 0, 0) - np.interp(x, x2, h2, 0, 0))))
