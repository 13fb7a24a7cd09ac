"""Which spacings a report runs, and what a run at a spacing costs."""
from __future__ import annotations

import math
from typing import Iterable, Sequence

import numpy as np

from ._errors import ArgumentError, number
from ._report_runs import Measured
from ._scene import Scene

LEAST = 5  # spacings over the smallest side, at least: below it is not the same scene any more
RATIO = 1.4  # of neighbouring spacings; at least 1.3 is the advice of Celik et al. (2008)
BARELY = 0.02  # of a side: what is rounded by less than this counts as whole
ROUNDED = 20.0  # what the rounded share of a side counts against the wish for that ratio: it moves widths by as much


class Sides:
    """The sides of a scene's columns, which are rounded to whole spacings: a source of errors that no order describes. Spacings are
    whole fractions of the smallest side; where there are no columns, of ten spacings of the scene."""

    def __init__(self, scene: Scene):
        self.sides = scene.column_sides()
        self.smallest = min(self.sides, default=10 * scene.config.spacing)
        self._own = self.smallest / scene.config.spacing
        self.coarsest = min(range(self._least(), math.ceil(1.35 * self._least()) + 1),
                            key=lambda n: ROUNDED * self.rounded(self.spacing(n)) + math.log(n))

    def _least(self) -> int:
        """What is smaller than a column, an opening or an obstacle, the scene's own spacing has to resolve: a fourth of it is
        the least."""
        return max(LEAST, math.ceil(self._own / 4))

    @property
    def finest(self) -> int:
        return math.floor(2 * max(self._own, self.coarsest))

    def spacing(self, n: int) -> float:
        return self.smallest / n

    def rounded(self, spacing: float) -> float:
        """The largest share of a side that is lost or won by rounding."""
        return max((abs(round(side / spacing) - side / spacing) * spacing / side for side in self.sides), default=0.0)

    def finer(self, spacing: float) -> list[float]:
        """What may follow a spacing, from a sixth to two thirds finer; what comes closest to RATIO first, and what rounds sides
        only where all of them do."""
        n = self.smallest / spacing
        near = range(math.ceil(1.2 * n - 1e-9), math.floor(1.2 * RATIO * n) + 1)
        whole = [k for k in near if self.rounded(self.spacing(k)) < BARELY]
        return [self.spacing(k) for k in sorted(whole or near, key=lambda k: ROUNDED * self.rounded(self.spacing(k))
                                                + abs(math.log(k / (RATIO * n))))]

    def ladder(self, finest: int, levels: int) -> list[int]:
        """So many spacings over the smallest side, from coarse to fine; fewer where the coarsest would be too coarse."""
        chosen = [finest]
        for k in range(1, levels):
            wanted = finest / RATIO**k
            near = [n for n in range(max(self._least(), math.ceil(wanted / 1.35)), math.floor(wanted * 1.2) + 1)
                    if n * 1.2 <= chosen[-1]]
            if not near:
                break
            chosen.append(min(near, key=lambda n: ROUNDED * self.rounded(self.spacing(n)) + abs(math.log(n / wanted))))
        return chosen[::-1]


class Cost:
    """CPU s of a run, of its time per particle and step, its particles and its steps, from runs that are there."""

    def __init__(self, runs: Iterable[Measured]):
        by_spacing: dict[float, list[Measured]] = {}
        for run in runs:
            by_spacing.setdefault(run.spacing, []).append(run)
        self._spacing = np.array(sorted(by_spacing, reverse=True))
        of = [by_spacing[h] for h in self._spacing]
        self._particles = np.array([np.median([run.particles for run in some]) for some in of])
        self._steps = np.array([np.median([run.steps for run in some]) for some in of])
        self._per_step = np.array([np.median([run.cost for run in some]) for some in of])  # s per particle and step
        self._runs = [len(some) for some in of]
        rest = [run.cpu_to_rest / run.cpu_seconds for some in of[-2:] for run in some]
        self.share_to_rest = float(np.median(rest)) if rest and np.isfinite(rest).all() else math.nan

    def particles(self, spacing: float) -> float:
        return float(self._particles[-1]) * (float(self._spacing[-1]) / spacing) ** 2

    def steps(self, spacing: float) -> float:
        power = 1.0  # waves set the step, which goes with the spacing; measured, where plates or the flow do
        if len(self._spacing) > 1:
            power = math.log(self._steps[-1] / self._steps[-2]) / math.log(self._spacing[-2] / self._spacing[-1])
        return float(self._steps[-1]) * (float(self._spacing[-1]) / spacing) ** min(max(power, 0.0), 2.0)

    def per_step(self, spacing: float) -> float:
        """s per particle and step: work by the volume, and by the surface and its ghosts, which is less of finer ones."""
        x, y = 1 / np.sqrt(self._particles), self._per_step
        surface = 0.0
        if len(x) > 1:
            away = x - np.average(x, weights=self._runs)
            slope = np.average(away * y, weights=self._runs) / np.average(away**2, weights=self._runs)
            surface = min(max(slope, 0.0), 0.5 * y[-1] / x[-1])  # half of it at most
        bulk = float(np.mean((y - surface * x)[-2:]))
        return bulk + surface / math.sqrt(self.particles(spacing))

    def seconds(self, spacing: float) -> float:
        """CPU s of one run to the end. spacing: m, above 0."""
        if not number("spacing", spacing) > 0:
            raise ArgumentError(f"spacing = {spacing:g}: expected a number above 0, in m")
        return self.per_step(spacing) * self.particles(spacing) * self.steps(spacing)


def given(spacings: Sequence[float]) -> list[float]:
    """Spacings that the host has named, from coarse to fine."""
    try:
        values = sorted({number("spacings", h) for h in spacings}, reverse=True)
    except TypeError:
        raise ArgumentError(f"spacings = {spacings!r:.80}: expected several numbers in m") from None
    if not all(math.isfinite(h) and h > 0 for h in values) or len(values) < 3:
        raise ArgumentError(f"spacings = {spacings!r:.80}: expected at least three different numbers above 0 m")
    close = [(a, b) for a, b in zip(values, values[1:]) if a < 1.1 * b]
    if close:
        raise ArgumentError("spacings = {:g} and {:g} m: expected spacings at least a tenth apart; what differs less does not show "
                            "in a chaotic flow".format(*close[0]))
    return values
