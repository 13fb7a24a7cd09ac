"""What a report does with what is left of its budget, once it has three or four spacings."""
from __future__ import annotations

import dataclasses
import itertools
import math
from typing import Callable, Collection, Sequence

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
            return "the accuracy is reached, at spacings that were run"
        return ""

    def next(self, found: Report, done: Collection[tuple[float, int]], room: float, used: float) -> Next:
        """A finer spacing or more runs of those that are there, whichever takes more off the stated error for its time; a finer
        one in any case where something does not converge.

        found: what the runs say that are there; done: these. room: s that may still be planned with; used: s, so far.
        """
        if over := self.over(found):
            return Next([], over)
        now = {name: found.convergence[name] for name in found.recommendation.of}
        diverges = any(one.verdict == DIVERGES for one in now.values())
        finer, more = self._finer(found, done, room), self._more(found, done, room)
        worth = {}
        if finer:
            worth["finer"] = math.inf if diverges else self._gain(found, now, finer[0][0]) / self.seconds(finer)
        if more and not diverges:
            new = {name: Convergence(_longer(found._values(name), more)) for name in now}
            gain = self._gain(found, new, found.spacings[-1])
            if gain > LITTLE:
                worth["more"] = gain / self.seconds(more)
        if worth:
            return Next(finer if max(worth, key=worth.__getitem__) == "finer" else more)
        return Next([], self._no_room(found, done, used) + ("; more runs of these spacings would change little" if more else ""))

    def _gain(self, found: Report, new: dict[str, Convergence], spacing: float) -> float:
        """Logarithm of how many times smaller the worst stated error would be, that of the mean of a few runs."""
        def worst(of: dict[str, Convergence], at: float) -> float:
            return max(one.error(at, MOST_RUNS) / found.scale[name] for name, one in of.items())

        return math.log(worst({name: found.convergence[name] for name in new}, found.spacings[-1]) / worst(new, spacing))

    def _finer(self, found: Report, done: Collection[tuple[float, int]], room: float) -> Jobs:
        """Rather fewer runs than none at all, rather a smaller step than none."""
        for runs in range(self.seeds, 1, -1):
            for spacing in self.sides.finer(found.spacings[-1]):
                jobs = _missing([spacing], runs, done)
                if self.seconds(jobs) <= room:
                    return jobs
        return []

    def _more(self, found: Report, done: Collection[tuple[float, int]], room: float) -> Jobs:
        """Up to twice as many runs of each spacing."""
        most = max(len(found._runs_at(h)) for h in found.spacings)
        for runs in range(min(2 * most, MOST_SEEDS), most, -1):
            jobs = _missing(found.spacings, runs, done)
            if self.seconds(jobs) <= room:
                return jobs
        return []

    def _no_room(self, found: Report, done: Collection[tuple[float, int]], used: float) -> str:
        jobs = {h: _missing([h], 2, done) for h in self.sides.finer(found.spacings[-1])}
        spacing = min(jobs, key=lambda h: self.seconds(jobs[h]))
        takes = self.seconds(jobs[spacing])
        return (f"a finer spacing needs more than what is left: two runs at {spacing:.3g} m take some {two_digits(takes)} s, for which "
                f"a budget of {two_digits(1.2 * (used + takes))} s has room")


def _missing(spacings: Sequence[float], runs: int, done: Collection[tuple[float, int]]) -> Jobs:
    """What is not there yet of so many runs of each spacing; one of each after the other, as the time may be over before."""
    return [(h, seed) for seed in range(1, runs + 1) for h in spacings if (h, seed) not in done]


def _longer(values: dict[float, list[float]], jobs: Jobs) -> dict[float, list[float]]:
    """As many more values as there would be runs, which scatter as those do that are there."""
    return {h: list(itertools.islice(itertools.cycle(some), len(some) + sum(spacing == h for spacing, _ in jobs)))
            for h, some in values.items()}


def two_digits(value: float) -> str:
    return f"{float(f'{value:.2g}'):g}"
