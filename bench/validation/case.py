"""A case with a right answer."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Iterable

from results import Collection, Result
from run import Run


@dataclass(frozen=True)
class Case:
    name: str
    asked: str
    measured: str  # of the run that is farthest off
    share: float  # departure over what is allowed; NaN: not run
    cpu: float | None  # s, of all its runs

    @property
    def met(self) -> bool:
        return self.share <= 1

    @property
    def times(self) -> str:
        return "not at all" if math.isinf(self.share) else f"{self.share:.2f} times" if self.share < 10 else f"{self.share:.0f} times"

    @property
    def verdict(self) -> str:
        if math.isnan(self.share):
            return "not run"
        return "met" if self.met else f"**missed**, {self.times}"


Labelled = Iterable[tuple[str, Run]]


def present(results: Collection, runs: Labelled) -> list[tuple[str, Result]]:
    pairs = ((label, results(run)) for label, run in runs)
    return [(label, result) for label, result in pairs if result is not None]


def spent(found: Iterable[tuple[str, Result]]) -> float | None:
    """CPU s."""
    each = {result.name: result.cpu for _, result in found}
    return sum(each.values()) if each else None


def worst(
    name: str, asked: str, allowed: float, offs: Iterable[tuple[str, float]], form: str, cpu: float | None
) -> Case:
    """The largest of |departures|, of which `allowed` is enough. form: of the measured value, with {label} and {off} (as it is)
    or {percent}."""
    known = [(label, off) for label, off in offs if not math.isnan(off)]
    if not known:
        return Case(name, asked, "", math.nan, None)
    label, off = max(known, key=lambda one: abs(one[1]))
    measured = form.format(label=label, off=off, percent=f"{100 * off:+.2f} %")
    return Case(name, asked, measured, abs(off) / allowed, cpu)
