"""Error against run time, of one's own scene."""
from __future__ import annotations

import contextlib
import math
import os
import time
import warnings
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import Any, Callable, Iterator, Mapping, Sequence

from ._errors import ArgumentError, number, whole
from ._progress import new_bar
from ._report_growth import Growth, Next, missing, two_digits
from ._report_ladder import ROUNDED, Cost, Sides, given
from ._report_result import ASKED, Report, names_of
from ._report_runs import Measured, OutOfTime, Quantity, checked, measure, standard
from ._scene import Scene, scene_of

LEVELS = 4
KEPT_BACK = 0.85  # share of the budget that is planned with: runs differ, and a machine has other work


class _Bar:
    """Over the seconds of the budget, where tqdm is and it is wanted."""

    def __init__(self, budget: float, shown: bool):
        self._begin, self._bar, self._seen = time.monotonic(), None, -math.inf
        if shown:
            self._bar = new_bar(total=budget, unit="s", bar_format="{desc} |{bar}| {n:.0f}/{total:g} s of the budget")

    def show(self, text: str) -> None:
        if self._bar is not None:
            self._bar.set_description_str(text, refresh=False)
            self._seen = -math.inf
            self.move()

    def move(self) -> None:
        """Twice a second at most: runs call it between their steps."""
        now = time.monotonic()
        if self._bar is not None and now - self._seen >= 0.5:
            self._seen = now
            self._bar.n = min(now - self._begin, self._bar.total)
            self._bar.refresh()

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


class _Study:
    """The runs of a report while they are made."""

    def __init__(self, scene: Scene, end: float, budget: float, quantities: Mapping[str, Quantity], workers: int, bar: _Bar):
        self.scene, self.end, self.quantities, self.workers, self.bar = scene, end, quantities, workers, bar
        self.begin = time.monotonic()
        self.budget, self.deadline = budget, self.begin + budget
        self.runs: list[Measured] = []
        self.waited = 0.0  # s of wall-clock time inside the runs
        self.plan: list[Any] = []
        self.warned: dict[str, None] = {}  # what the library has said, each once

    @contextlib.contextmanager
    def listening(self) -> Iterator[None]:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            yield
        self.warned |= dict.fromkeys(str(one.message) for one in caught)

    def left(self) -> float:
        return self.deadline - time.monotonic()

    def run(self, jobs: Sequence[tuple[float, int]]) -> None:
        """Pairs of spacing and seed, in this order, as far as the time is enough."""
        with self.listening():
            self._run(jobs)

    def _run(self, jobs: Sequence[tuple[float, int]]) -> None:
        if self.workers == 1:
            for spacing, seed in jobs:
                if not self._fits(spacing):
                    return
                self.bar.show(f"spacing {spacing:.3g} m, run {seed}")
                if not self._keep(lambda: self._measured(spacing, seed)):
                    return
            return
        self._run_beside(list(jobs))

    def _run_beside(self, jobs: list[tuple[float, int]]) -> None:
        busy: dict[Future, float] = {}
        with ThreadPoolExecutor(self.workers) as pool:
            try:
                while jobs or busy:
                    while jobs and len(busy) < self.workers:
                        spacing, seed = jobs.pop(0)
                        if not self._fits(spacing):
                            jobs.clear()
                            break
                        self.bar.show(f"spacing {spacing:.3g} m, run {seed}")
                        busy[pool.submit(self._measured, spacing, seed)] = spacing
                    self.bar.move()
                    for done in wait(busy, timeout=1, return_when=FIRST_COMPLETED).done:
                        busy.pop(done)
                        self._keep(done.result)
            except BaseException:
                self.deadline = -math.inf  # what still runs ends at its next look
                raise

    def _measured(self, spacing: float, seed: int) -> tuple[Measured, list]:
        begin = time.monotonic()
        try:
            return measure(self.scene, spacing, seed, self.end, self.quantities, self._looked)
        finally:
            self.waited += time.monotonic() - begin

    def _looked(self) -> float:
        """The deadline, for a run that asks between its steps."""
        if self.workers == 1:
            self.bar.move()
        return self.deadline

    def _keep(self, result: Any) -> bool:
        try:
            one, plan = result()
        except OutOfTime:
            return False
        self.runs.append(one)
        if one.spacing <= min(run.spacing for run in self.runs):
            self.plan = plan
        return True

    def _fits(self, spacing: float) -> bool:
        return not self.runs or self.seconds(spacing) <= self.left()

    def seconds(self, spacing: float) -> float:
        """Wall-clock seconds of a run: CPU time, and as much more as the machine has taken so far."""
        return Cost(self.runs).seconds(spacing) * self.pace()

    def seconds_of(self, jobs: Sequence[tuple[float, int]]) -> float:
        """Wall-clock seconds of several, so many at a time."""
        busy = [0.0] * self.workers
        for spacing, _ in jobs:
            busy[busy.index(min(busy))] += self.seconds(spacing)
        return max(busy)

    def room(self) -> float:
        """Seconds that may still be planned with."""
        return KEPT_BACK * self.left()

    def enough(self) -> list[float]:
        """The spacings with two runs at least."""
        every = [run.spacing for run in self.runs]
        return [h for h in set(every) if every.count(h) >= 2]

    def pace(self) -> float:
        spent = sum(run.cpu_seconds for run in self.runs)
        return max(1.0, self.waited / spent) if spent > 0 else 1.0

    def done(self) -> set[tuple[float, int]]:
        return {(run.spacing, run.seed) for run in self.runs}


def _choose(study: _Study, sides: Sides, seeds: int) -> list[float]:
    """The finest ladder that the budget has room for, with two runs of each spacing at least; else the error says what it
    takes."""
    room = study.room() * study.workers
    best: tuple[float, list[float]] | None = None
    least = math.inf
    for runs in range(seeds, 1, -1):  # rather fewer runs than none at all
        for finest in range(sides.coarsest + 2, sides.finest + 1):
            for levels in (LEVELS, 3):
                ladder = [sides.spacing(n) for n in sides.ladder(finest, levels)]
                if len(ladder) < 3:
                    continue
                each = sum(study.seconds(h) for h in ladder)
                least = min(least, 2 * each)
                worth = math.log(finest) - ROUNDED * sides.rounded(ladder[-1]) + 0.1 * len(ladder)
                if runs * each <= room and (best is None or worth > best[0]):
                    best = worth, ladder
        if best is not None:
            break
    if best is None:
        spent = study.budget - study.left()
        raise ArgumentError(f"budget = {study.budget:g} s: two runs at each of three spacings do not fit in: expected some "
                            f"{spent + least / study.workers / KEPT_BACK:.2g} s at least, or a shorter end")
    return best[1]


def report(scene: "Scene | str | os.PathLike[str]", budget: float = 60.0, accuracy: float = 0.05, *, end: float | None = None,
           spacings: Sequence[float] | None = None, seeds: int = 4, quantities: Mapping[str, Quantity] | None = None,
           of: Sequence[str] | None = None, workers: int = 1, progress: bool = False) -> Report:
    """Error against run time of your own scene: the error and cost of each spacing, and which one is enough.

    Runs the scene at three or four spacings, several times each, within a budget; and at finer ones, or more often, as long as the
    accuracy is not reached, or something of which it is asked does not converge. In the runs of one spacing the particles begin
    0.01 spacings apart (or by the scene's own jitter): the differences are chance. From the means follow the observed order and
    the limit of zero spacing, and from both the error of one run, which holds in 9 of 10 cases (docs/report.md). The report
    says what does not converge, and why it ended (Report.ended).

    Args:
        scene: a Scene, or the path of a scene file.
        budget: s of wall-clock time, finite, above 0.
        accuracy: relative error of one run or of the mean of a few, above 0 and below 1, for which Report.recommendation names
            spacing, number of runs and cost, and up to which the budget is used.
        end: s, of the runs, finite, above 0; not given: that of the scene.
        spacings: m, at least three, and no others are run; not given: down to half of the scene's spacing, finer ones as the
            accuracy needs them, all as the budget allows, so that the columns' sides are whole numbers of them as far as possible.
        seeds: runs of each spacing, 2 to 100; more of them where chance is most of the error, unless spacings are given.
        quantities: more of them, {"name": function of the Simulation at its end}.
        of: the quantities that are to have the accuracy; not given: peak_height and width_90.
        workers: runs at a time, 1 to 64.
        progress: shows a bar (needs tqdm).

    Returns:
        The Report.

    Raises:
        ArgumentError: a budget too small for two runs at each of three spacings, a value out of range, a quantity
            that does not exist; a scene with particles given one by one, whose spacing is theirs.
        SceneError: what the library refuses of the scene.

    Example:
        report = granperi.report("collapse.toml", budget=20, accuracy=0.1)
        print(report)
        report.write("collapse.html", overwrite=True)  # one page with pictures, or .json
    """
    scene = scene_of(scene)
    end = scene.run.end if end is None else number("end", end)
    budget, accuracy = number("budget", budget), number("accuracy", accuracy)
    seeds, workers = whole("seeds", seeds), whole("workers", workers)
    for name, value, low, high in (("end", end, 0, math.inf), ("budget", budget, 0, math.inf), ("accuracy", accuracy, 0, 1)):
        if not low < value < high:
            raise ArgumentError(f"{name} = {value:g}: expected a number above {low}"
                                + (f" and below {high:g}" if high < math.inf else ""))
    if not (2 <= seeds <= 100 and 1 <= workers <= 64):
        raise ArgumentError(f"seeds = {seeds}, workers = {workers}: expected 2 to 100 and 1 to 64")
    own = checked({} if quantities is None else quantities)
    wanted = ASKED if of is None else names_of(of, tuple(own))
    if scene.fixed_spacing:
        raise ArgumentError(f"{scene.name}: has particles given one by one, whose spacing is theirs: expected a scene that can "
                            "be built at any spacing")
    sides = Sides(scene)
    named = None if spacings is None else given(spacings)
    bar = _Bar(budget, progress)
    study = _Study(scene, end, budget, own, workers, bar)
    try:
        with study.listening():
            start = _start(scene, named[-1] if named else scene.config.spacing, own)
        ladder = _ladder(study, sides, named, seeds)
        study.run(missing(ladder, seeds, study.done()))
        if len(study.enough()) < 3:
            raise ArgumentError(f"budget = {budget:g} s: not two runs at each of three spacings were done: expected some "
                                f"{1.3 * budget - 0.3 * study.left():.2g} s, or {1.3 * 2 * sum(map(study.seconds, ladder)):.2g} s; "
                                "the machine may be busy")

        def found() -> Report:
            return Report(scene, end, accuracy, budget, time.monotonic() - study.begin, study.runs, study.enough(), start,
                          study.plan, own, tuple(study.warned), wanted)

        return _grown(study, Growth(sides, seeds, study.seconds_of), found, named is not None)
    finally:
        bar.show(f"{len(study.runs)} runs")
        bar.close()


def _grown(study: _Study, growth: Growth, found: Callable[[], Report], named: bool) -> Report:
    """The report, once no more runs are worth their time or fit into what is left of the budget."""
    while True:
        one = found()
        if named:
            step = Next([], growth.over(one) or "the spacings were given, so no others were run")
        else:
            step = growth.next(one, study.done(), study.room(), study.budget - study.left())
        before = len(study.runs)
        study.run(step.jobs)
        if len(study.runs) == before:
            why = step.why or f"the runs at {step.jobs[0][0]:.3g} m were not done in time"
            one.ended = f"Ended after {two_digits(study.budget - study.left())} of {study.budget:g} s: {why}."
            return one


def _start(scene: Scene, spacing: float, own: Mapping[str, Quantity]) -> dict[str, float]:
    """What the quantities are before the first step."""
    with scene.build(spacing) as sim:
        if not sim.n_particles:
            raise ArgumentError(f"{scene.name}: has no particles to report on")
        return {**standard(sim.state), **dict.fromkeys(own, math.nan)}


def _ladder(study: _Study, sides: Sides, named: list[float] | None, seeds: int) -> list[float]:
    if named is not None:
        return named
    coarsest = sides.coarsest
    study.run([(sides.spacing(coarsest), 1)])
    if not study.runs:
        raise ArgumentError(f"budget = {study.budget:g} s: not one run at a spacing of {sides.spacing(coarsest):.3g} m was done: "
                            "expected many times more, or a shorter end")
    if study.seconds(sides.spacing(2 * coarsest)) < 0.1 * study.left():
        study.run([(sides.spacing(2 * coarsest), 1)])
    return _choose(study, sides, seeds)
