"""What a report says: its tables, the recommendation, and how it is written."""
from __future__ import annotations

import dataclasses
import json
import math
import os
from typing import Any, Mapping, Sequence

from ._errors import ArgumentError, ArgumentTypeError, FileError, StateError, near_match, number, whole
from ._library import lib, text_of
from ._objects import Config
from ._report_ladder import BARELY, Cost, Sides
from ._report_runs import QUANTITIES, REST, Measured
from ._report_statistics import CONVERGES, DIVERGES, IRREGULAR, UNSURE, Convergence
from ._scene import Scene
from ._state import MARKS, PlanEntry

FORMAT = 1  # of the JSON file
MAIN = ("peak_height", "width_50", "width_90", "width_98", REST)
ASKED = ("peak_height", "width_90")
MOST_RUNS = 16  # that a recommendation asks for
OTHERS = {REST: ("s", "time since when the kinetic energy has been below 1e-4 of its largest")}
NOT_REACHED = "not in every run"  # a quantity that some runs do not have


@dataclasses.dataclass(frozen=True)
class Row:
    """One spacing: run (runs > 0) or forecast. errors: of one run, by quantity, in its unit, in 9 of 10 cases not more; NaN where
    none is forecast, as the quantity does not converge."""

    spacing: float
    runs: int
    particles: int
    cpu_seconds: float
    errors: dict[str, float]


@dataclasses.dataclass(frozen=True)
class Recommendation:
    """What reaches an accuracy at the least cost: the mean of `runs` runs at this spacing. cpu_seconds: of all of them.

    runs 0: nothing that the report can judge reaches it; reason says why.
    """

    accuracy: float
    of: tuple[str, ...]
    spacing: float
    runs: int
    cpu_seconds: float
    errors: dict[str, float]
    reason: str

    def config(self, config: Config) -> Config:
        """A configuration with the recommended spacing.

        Args:
            config: whose other values stay.

        Returns:
            A Config.

        Raises:
            StateError: nothing is recommended; reason says why.

        Example:
            scene = granperi.Scene.read("collapse.toml")
            if report.recommendation.runs:
                scene.config = report.recommendation.config(scene.config)
        """
        if not self.runs:
            raise StateError(f"nothing is recommended: {self.reason}")
        if not isinstance(config, Config):
            raise ArgumentTypeError(f"config = {config!r:.80}: expected a Config, such as scene.config")
        return config.replace(spacing=self.spacing)

    def __str__(self) -> str:
        what = " and ".join(self.of)
        if not self.runs:
            return f"{what} within {100 * self.accuracy:g} %: {self.reason}"
        errors = ", ".join(f"{name} {100 * error:.1f} %" for name, error in self.errors.items())
        runs = "one run" if self.runs == 1 else f"the mean of {self.runs} runs"
        return (f"{what} within {100 * self.accuracy:g} %: {runs} with a spacing of {self.spacing:.4g} m, "
                f"{self.cpu_seconds:.2g} CPU s ({errors}){'; ' + self.reason if self.reason else ''}")


class Report:
    """Error against run time of a scene; print() shows it, write() keeps it, see granperi.report.

    runs: every run (spacing, seed, particles, steps, CPU seconds, values). rows: from the coarsest to the finest spacing, run or
    forecast. convergence: by quantity; scale: what its relative errors are relative to. recommendation: for the accuracy asked for.
    plan: stages and fields of the finest run. warnings: what the library said of the scene. ended: why no more was run.
    """

    ended = ""

    def __init__(self, scene: Scene, end: float, accuracy: float, budget: float, seconds: float, runs: Sequence[Measured],
                 spacings: Sequence[float], start: Mapping[str, float], plan: Sequence[PlanEntry], own: Mapping[str, Any],
                 warnings: Sequence[str], of: Sequence[str]):
        self.name, self.end, self.accuracy, self.budget, self.seconds = scene.name, end, accuracy, budget, seconds
        self.runs, self.plan, self.warnings = tuple(runs), tuple(plan), tuple(warnings)
        self.spacings = tuple(sorted(spacings, reverse=True))
        self.cost = Cost(self.runs)
        self.own = tuple(own)
        self._config, self._start, self._sides = scene.config, start, Sides(scene)
        self.convergence: dict[str, Convergence] = {}
        for name in (*MAIN, *self.own, *MARKS.values()):
            values = self._values(name)
            if all(math.isfinite(value) for some in values.values() for value in some):
                self.convergence[name] = Convergence(values)
        self.scale = {name: self._scale(name) for name in self.convergence}
        self.recommendation = self.recommend(accuracy, of)
        finer = [self.spacings[-1] / factor for factor in (1.4, 2.0, 2.8)]
        self.rows = [self._row(h) for h in (*self.spacings, *finer)]

    # ------------------------------------------------------------------------------------------ what it says

    def _scale(self, name: str) -> float:
        """Heights, times and own quantities are relative to themselves, widths to what they have changed by where that is much
        (a run-out), and the marks of the mass as the width of its middle 90 %."""
        if name in MARKS.values():
            return self._scale("width_90") if "width_90" in self.convergence else 0.0
        value = abs(self.convergence[name].limit)
        if name.startswith("width"):
            change = abs(self.convergence[name].limit - self._start[name])
            return change if change > 0.25 * value else value
        return value

    def _runs_at(self, spacing: float) -> list[Measured]:
        return [run for run in self.runs if run.spacing == spacing]

    def _values(self, name: str) -> dict[float, list[float]]:
        return {h: [run.values[name] for run in self._runs_at(h)] for h in self.spacings}

    def _stated(self, name: str, spacing: float) -> bool:
        """Whether an error is: a forecast takes for granted that it shrinks with the spacing."""
        return self.convergence[name].verdict != DIVERGES or spacing >= 0.999 * self.spacings[-1]

    def error(self, name: str, spacing: float, runs: int = 1) -> float:
        """Relative error of the mean of this many runs at any spacing, not exceeded in 9 of 10 cases.

        Args:
            name: of a quantity in convergence, such as "peak_height" or "width_90".
            spacing: m, above 0.
            runs: number of runs, at least 1.

        Returns:
            A fraction (0.05 is 5 %); NaN where there is nothing to relate it to, and at spacings finer than all that were run of
            what does not converge.

        Raises:
            ArgumentError: a quantity that the report does not have, a spacing or number of runs outside its range.

        Example:
            print(report.error("width_90", report.spacings[0]))
        """
        if name not in self.convergence:
            raise ArgumentError(f"name = {name!r}: {near_match(name, list(self.convergence))}")
        spacing, runs = number("spacing", spacing), whole("runs", runs)
        if not (0 < spacing < math.inf and runs >= 1):
            raise ArgumentError(f"spacing = {spacing:g}, runs = {runs}: expected a finite number above 0 (m), and a whole one >= 1")
        scale = self.scale[name]
        return self.convergence[name].error(spacing, runs) / scale if scale > 0 and self._stated(name, spacing) else math.nan

    def _row(self, spacing: float) -> Row:
        there = self._runs_at(spacing)
        particles = there[0].particles if there else round(self.cost.particles(spacing))
        seconds = sum(run.cpu_seconds for run in there) / len(there) if there else self.cost.seconds(spacing)
        return Row(spacing, len(there), particles, seconds,
                   {name: one.error(spacing) if self._stated(name, spacing) else math.nan
                    for name, one in self.convergence.items()})

    def recommend(self, accuracy: float, of: Sequence[str] = ASKED) -> Recommendation:
        """The cheapest spacing and number of runs by which these quantities err by less than an accuracy in 9 of 10 cases.

        It looks from the coarsest spacing that was run to a fourth of the finest one.

        Args:
            accuracy: relative, above 0 and below 1.
            of: names of quantities in convergence.

        Returns:
            A Recommendation; its runs are 0 if nothing reaches the accuracy, and reason says why.

        Raises:
            ArgumentError: an accuracy outside its range, a quantity that does not exist.

        Example:
            print(report.recommend(0.2, of=["peak_height"]))
        """
        accuracy = number("accuracy", accuracy)
        if not 0 < accuracy < 1:
            raise ArgumentError(f"accuracy = {accuracy:g}: expected a number above 0 and below 1")
        of = names_of(of, self.own)

        def none(reason: str) -> Recommendation:
            return Recommendation(accuracy, of, math.nan, 0, math.nan, {}, reason)

        for name in of:
            if name not in self.convergence:
                return none(f"{name} is {NOT_REACHED}: run longer, to a later end")
            if self.convergence[name].verdict == DIVERGES:
                return none(f"{name} does not converge at the spacings that were run, {self.spacings[0]:.3g} to {self.spacings[-1]:.3g} "
                            "m, so nothing is forecast for it; only finer ones could show that it does")
        best: Recommendation | None = None
        for spacing in self._candidates():
            each = self.cost.seconds(spacing)
            for runs in range(1, MOST_RUNS + 1):
                errors = {name: self.error(name, spacing, runs) for name in of}
                if max(errors.values()) <= accuracy:
                    if best is None or runs * each < best.cpu_seconds:
                        best = Recommendation(accuracy, of, spacing, runs, runs * each, errors, self._because(spacing, of))
                    break
        if best is None:
            least = self.spacings[-1] / 4
            worst = max(of, key=lambda name: self.error(name, least))
            return none(f"not even a spacing of {least:.3g} m, {self.cost.seconds(least):.2g} CPU s a run, is sure to: {worst} may "
                        f"err by {100 * self.error(worst, least):.1f} %; a report with a larger budget knows more")
        return best

    def _candidates(self) -> list[float]:
        wanted = [h for h in self.spacings]
        n, last = self._sides.smallest / self.spacings[0], self._sides.smallest / self.spacings[-1]
        wanted += [self._sides.spacing(k) for k in range(math.ceil(n), math.floor(4 * last) + 1)
                   if self._sides.rounded(self._sides.spacing(k)) < BARELY]
        return sorted(set(wanted), reverse=True)

    def _because(self, spacing: float, of: Sequence[str]) -> str:
        said = []
        if spacing < 0.999 * self.spacings[-1]:
            said.append("extrapolated: finer than what was run")
        said += [f"{name} {verdict}" for name in of if (verdict := self.convergence[name].verdict) in (IRREGULAR, UNSURE)]
        return ", ".join(said)

    def advice(self) -> list[str]:
        """What else saves time in this scene.

        Returns:
            A list of sentences, which may be empty.

        Example:
            print(report.advice())
        """
        said = []
        share = self.cost.share_to_rest
        if math.isfinite(share) and share < 0.9:
            said.append(f"All rests after {100 * share:.0f} % of the CPU time: a run that ends there needs no more.")
            if not self._config.sleep:
                said.append("sleep = 1 leaves out of the work what rests.")
        rounded = self._sides.rounded(self._config.spacing)
        if rounded > 0.01:
            said.append(f"The scene's spacing of {self._config.spacing:.4g} m rounds the side of a column by {100 * rounded:.1f} %: "
                        "take a whole fraction of the sides.")
        return said

    def _judged(self, name: str) -> tuple[str, str]:
        """Verdict and observed order, in words."""
        if name not in self.convergence:
            return NOT_REACHED, ""
        one = self.convergence[name]
        order = f"{one.order:.1f} ({one.order_range[0]:.2g} to {one.order_range[1]:.2g})"
        return one.verdict, order if one.verdict in (CONVERGES, UNSURE) else ""

    def _percent(self, row: Row, name: str, none: str = "-") -> str:
        """The relative error of one run, where one is stated."""
        error = row.errors[name] / self.scale[name] if self.scale[name] > 0 else math.nan
        return f"{100 * error:.1f} %" if math.isfinite(error) else none

    def __str__(self) -> str:
        names = [name for name in (*MAIN, *self.own) if name in self.convergence]
        lines = [f"{self.name} to {self.end:g} s: {len(self.runs)} runs in {self.seconds:.3g} s",
                 "relative error of one run, in 9 of 10 cases less:",
                 f"{'spacing (m)':>12} {'particles':>9} {'CPU (s)':>8} {'runs':>4}" + "".join(f" {name:>11}" for name in names)]
        for row in self.rows:
            lines.append(f"{row.spacing:>12.4g} {row.particles:>9} {row.cpu_seconds:>8.2g} {row.runs or '-':>4}"
                         + "".join(f" {self._percent(row, name):>11}" for name in names))
        lines.append(f"{'':12} {'limit':>12} {'+-':>9} {'scatter':>9}  observed order")
        for name in (*MAIN, *self.own):
            verdict, order = self._judged(name)
            if name not in self.convergence:
                lines.append(f"{name:<12} {'':>32}  {verdict}")
                continue
            one = self.convergence[name]
            lines.append(f"{name:<12} {one.limit:>12.5g} {one.limit_error:>9.2g} {one.levels[-1].scatter:>9.2g}  {verdict}"
                         + (f", order {order}" if order else ""))
        return "\n".join([*lines, str(self.recommendation), *([self.ended] if self.ended else []), *self.advice()])

    # --------------------------------------------------------------------------------------------- writing

    def data(self) -> dict[str, Any]:
        """Everything as numbers, texts, lists and dicts, as in the JSON file; missing values are None.

        Returns:
            A dict.

        Example:
            print(report.data()["spacings"])
        """
        quantities = {}
        for name in (*MAIN, *self.own, *MARKS.values()):
            unit, meaning = QUANTITIES[name][:2] if name in QUANTITIES else OTHERS.get(name, ("", "the host's own"))
            verdict, _ = self._judged(name)
            entry: dict[str, Any] = {"unit": unit, "meaning": meaning, "verdict": verdict}
            if name in self.convergence:
                one = self.convergence[name]
                entry |= {"limit": one.limit, "limit_error": one.limit_error, "scale": self.scale[name], "order": one.order,
                          "order_range": list(one.order_range),
                          "levels": [{"spacing": level.spacing, "runs": level.runs, "mean": level.mean, "scatter": level.scatter,
                                      "bias": one.bias(level.spacing), "error_of_mean": one.error(level.spacing, level.runs)}
                                     for level in one.levels]}
            quantities[name] = entry
        stages = [{"name": entry.name, "seconds": entry.seconds, "calls": entry.calls} for entry in self.plan
                  if entry.kind == 0 and entry.active]
        return _plain({
            "format": FORMAT, "granperi": text_of(lib.gp_version_string()), "scene": self.name, "end": self.end,
            "budget": self.budget, "seconds": self.seconds, "spacings": list(self.spacings),
            "rows": [dataclasses.asdict(row) for row in self.rows], "quantities": quantities,
            "recommendation": dataclasses.asdict(self.recommendation), "ended": self.ended, "advice": self.advice(),
            "warnings": list(self.warnings),
            "stages": stages,
            "left_out": [{"name": entry.name, "kind": "field" if entry.kind else "stage", "reason": entry.reason}
                         for entry in self.plan if not entry.active],
            "runs": [dataclasses.asdict(run) for run in self.runs]})

    def html(self) -> str:
        """One self-contained page with pictures.

        Returns:
            HTML.

        Example:
            print(len(report.html()), "characters")
        """
        from ._report_html import page

        return page(self)

    def _repr_html_(self) -> str:
        from ._report_html import body

        return body(self)

    def write(self, path: "str | os.PathLike[str]", overwrite: bool = False) -> None:
        """Writes the report; beside its place first, then renamed.

        Args:
            path: a name that ends in .html or .json.
            overwrite: replaces a file that exists.

        Raises:
            ArgumentError: another ending of the name.
            FileError: the file exists, and overwrite is false; or it cannot be written.

        Example:
            report.write("collapse.json", overwrite=True)
        """
        path = os.fspath(path)
        if path.endswith(".html"):
            text = self.html()
        elif path.endswith(".json"):
            text = json.dumps(self.data(), indent=1, allow_nan=False) + "\n"
        else:
            raise ArgumentError(f"path = {path!r:.200}: expected a name that ends in .html or .json")
        if not overwrite and os.path.exists(path):
            raise FileError(f"{path}: exists: expected another name, or overwrite=True")
        part = f"{path}.part-{os.getpid()}"
        try:
            with open(part, "w", encoding="utf-8") as file:
                file.write(text)
            os.replace(part, path)
        except OSError as error:
            raise FileError(f"{path}: cannot be written: {error.strerror}") from None


def names_of(of: Any, own: Sequence[str]) -> tuple[str, ...]:
    """The quantities that an accuracy is asked of; own: those of the host."""
    if isinstance(of, str) or not isinstance(of, Sequence) or not of:
        raise ArgumentTypeError(f"of = {of!r:.80}: expected a list of names of quantities")
    for name in of:
        if name not in (valid := [*QUANTITIES, REST, *own]):
            raise ArgumentError(f"of: {name!r:.80}: {near_match(str(name), valid)}")
    return tuple(of)


def _plain(value: Any) -> Any:
    """NaN and infinity are no JSON."""
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
