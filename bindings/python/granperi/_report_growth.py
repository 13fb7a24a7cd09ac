"""What a report does with what is left of its budget, once it has three or four spacings."""
from __future__ import annotations

import dataclasses
import math
from collections import Counter
from typing import Callable, Collection, Sequence

import numpy as np

from ._report_ladder import Sides
from ._report_result import MOST_RUNS, Report
from ._report_statistics import DIVERGES, Convergence

MOST_SEEDS = 100
LITTLE = 0.05  # of the stated error: more runs of the same spacings that take less than this off it are not made

Jobs = list[tuple[float, int]]  # spacing and seed of each run


@dataclasses.dataclass(frozen=True)
class Next:
    """The runs that come next; none: it is over, and why."""

    jobs: Jobs
    why: str = ""


class Growth:
    """Decides what comes next. seconds(jobs): of wall-clock time that runs are expected to take."""

    def __init__(self, sides: Sides, seeds: int, seconds: Callable[[Jobs], float]):
        self.sides, self.seeds, self.seconds = sides, seeds, seconds

    @staticmethod
    def over(found: Report) -> str:
        """Why no run is asked for any more, where that is so."""
        chosen = found.recommendation
        for name in chosen.of:
            if name not in found.convergence:
                return f"{name} is not in every run, which only a later end would change"
            if not found.scale[name] > 0:
                return f"{name} tends to 0, to which no error can be relative"
        if chosen.runs and chosen.spacing >= 0.999 * found.spacings[-1]:
            return "the accuracy is reached at a spacing no finer than what was run"
        return ""

    def next(self, found: Report, done: Collection[tuple[float, int]], room: float, used: float) -> Next:
        """A finer spacing or more runs of those that are there, whichever takes more off the stated error for its time; a finer
        one in any case where something does not converge.

        found: what the runs say that are there; done: these. room: s that may still be planned with; used: s, so far.
        """
        if over := self.over(found):
            return Next([], over)
        diverges = any(found.convergence[name].verdict == DIVERGES for name in found.recommendation.of)
        finer, more = self._finer(found, done, room), self._more(found, done, room)
        worth = {}
        if finer:
            worth["finer"] = math.inf if diverges else _gain(found, finer) / self.seconds(finer)
        if more and not diverges and (gain := _gain(found, more)) > LITTLE:
            worth["more"] = gain / self.seconds(more)
        if worth:
            return Next(finer if max(worth, key=worth.__getitem__) == "finer" else more)
        return Next([], self._no_room(found, done, used) + ("; more runs of these spacings would change little" if more else ""))

    def _finer(self, found: Report, done: Collection[tuple[float, int]], room: float) -> Jobs:
        """Rather fewer runs than none at all, rather a smaller step than none."""
        for runs in range(self.seeds, 1, -1):
            for spacing in self.sides.finer(found.spacings[-1]):
                jobs = missing([spacing], runs, done)
                if self.seconds(jobs) <= room:
                    return jobs
        return []

    def _more(self, found: Report, done: Collection[tuple[float, int]], room: float) -> Jobs:
        """Up to twice as many runs of each spacing."""
        most = max(len(found._runs_at(h)) for h in found.spacings)
        for runs in range(min(2 * most, MOST_SEEDS), most, -1):
            jobs = missing(found.spacings, runs, done)
            if self.seconds(jobs) <= room:
                return jobs
        return []

    def _no_room(self, found: Report, done: Collection[tuple[float, int]], used: float) -> str:
        jobs = {h: missing([h], 2, done) for h in self.sides.finer(found.spacings[-1])}
        spacing = min(jobs, key=lambda h: self.seconds(jobs[h]))
        whole = self.seconds(missing([*found.spacings, spacing], self.seeds, done))  # the coarser ones would be complete, too
        return (f"a finer spacing is not sure to fit into what is left: two runs at {spacing:.3g} m take some "
                f"{two_digits(self.seconds(jobs[spacing]))} s, for which a budget of {two_digits(1.2 * (used + whole))} s has room")


def missing(spacings: Sequence[float], runs: int, done: Collection[tuple[float, int]]) -> Jobs:
    """What is not there yet of so many runs of each spacing; one of each after the other, as the time may be over before."""
    return [(h, seed) for seed in range(1, runs + 1) for h in spacings if (h, seed) not in done]


def _gain(found: Report, jobs: Jobs) -> float:
    """Logarithm of how many times smaller the worst stated error is to be expected after these runs, that of the mean of a few."""
    def worst(of: dict[str, Convergence]) -> float:
        return max(one.error(one.levels[-1].spacing, MOST_RUNS) / found.scale[name] for name, one in of.items())

    now = {name: found.convergence[name] for name in found.recommendation.of}
    return math.log(worst(now) / worst({name: Convergence(_imagined(one, found._values(name), jobs)) for name, one in now.items()}))


def _imagined(one: Convergence, values: dict[float, list[float]], jobs: Jobs) -> dict[float, list[float]]:
    """With the runs that are to come: about where the mean of that spacing most likely is, scattered as those of the nearest one."""
    with_them = dict(values)
    for spacing, count in Counter(h for h, _ in jobs).items():
        near = np.array(values[min(values, key=lambda h: abs(math.log(h / spacing)))])
        scattered = near[np.arange(count) % len(near)]
        with_them[spacing] = values.get(spacing, []) + list(scattered - scattered.mean() + one.limit + one.bias(spacing))
    return with_them


def two_digits(value: float) -> str:
    return f"{float(f'{value:.2g}'):g}"
