"""Two results beside each other."""
from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from ._errors import ArgumentError
from ._result import Result, snapshot
from ._snapshot import Snapshot


@dataclasses.dataclass(frozen=True)
class Difference:
    """One quantity of two results at one time."""

    time: float
    name: str
    unit: str
    first: float
    second: float

    @property
    def difference(self) -> float:
        """second - first."""
        return self.second - self.first


def compare(first: Any, second: Any, times: Any = None) -> list[Difference]:
    """Compares two sources: peak, fronts, centre of mass, and the distance between particles of the same id.

    Args:
        first, second: results, their paths, simulations or snapshots.
        times: s, one or shape (n), of result files; not given: the last frame, or now.

    Returns:
        A list of Difference.

    Raises:
        ArgumentError: a time at which there is no frame, or of a simulation.
        FileError: a file that is no result.

    Example:
        for row in granperi.compare("collapse.h5", "collapse.h5"):
            print(row.name, row.difference)
    """
    rows: list[Difference] = []
    for time in [None] if times is None else np.atleast_1d(times):
        rows += _at_one_time(snapshot(first, time), snapshot(second, time))
    return rows


def _at_one_time(first: Snapshot, second: Snapshot) -> list[Difference]:
    time = first.time

    def row(name: str, unit: str, a: float, b: float) -> Difference:
        return Difference(time, name, unit, float(a), float(b))

    a, b = first.state, second.state
    rows = [row("time", "s", first.time, second.time), row("particles", "", len(first.x), len(second.x))]
    rows += [row(name, "m", getattr(a, name), getattr(b, name)) for name in ("peak_height", "peak_x", "x_left", "x_right")]
    if len(first.x) and len(second.x):
        rows += [row(name, "m", getattr(a, name), getattr(b, name)) for name in ("centre_x", "centre_y")]  # NaN in files of 0.1
    if len(first.x) == len(second.x) and len(first.x):
        apart = np.hypot(second.x - first.x, second.y - first.y)
        rows += [row("particles_apart_rms", "m", 0, np.sqrt((apart**2).mean())),
                 row("particles_apart_max", "m", 0, apart.max())]
    return rows


def same_bits(first: Result, second: Result) -> bool:
    """Whether two result files have the same frames to the last bit."""
    if len(first) != len(second) or first.fields != second.fields:
        return False
    if not len(first):
        raise ArgumentError("there are no frames to compare")
    return np.array_equal(first.times, second.times) and all(
        np.array_equal(a.field(name), b.field(name), equal_nan=True) for a, b in zip(first, second) for name in first.fields)


def table(rows: list[Difference]) -> str:
    """The rows as text."""
    lines = [f"{'quantity':<22}{'first':>14}{'second':>14}{'difference':>14}"]
    lines += [f"{row.name + (f' ({row.unit})' if row.unit else ''):<22}{row.first:>14.6g}{row.second:>14.6g}"
              f"{row.difference:>14.3g}" for row in rows]
    return "\n".join(lines)
