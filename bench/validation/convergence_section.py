"""The section of docs/validation.md on what the spacing changes in a collapse, its measures and its figure."""
from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import convergence_runs as runs
import matplotlib.pyplot as plt
import numpy as np
from convergence_runs import CASES, COARSE, Case
from markdown import NONE, cpu, fixed, percent, table
from plotting import finish
from results import Collection, Result

ASKED = {"peak": 0.03, "bulk": 0.03, "spread": 0.05, "early": 0.02}  # of the finest, from L/dl = 32 on; early: at 32
ASKED_COARSE = 0.05  # of peak and run-out of 90 % at 16 and 24
PRESSURE = 1.3  # rho g H, the highest from .05 s on
STYLES = {
    "beads": ("#0072B2", "o-"),
    "horizon3": ("#56B4E9", "s--"),
    "horizon2.5": ("#009E73", "^:"),
    "raised": ("#D55E00", "D-"),
    "tall": ("#CC79A7", "v-"),
    "one_side": ("#E69F00", "<-"),
}


def mean(result: Result, column: str) -> float:
    values = result.tables["seeds"][column]
    values = values[~np.isnan(values)]
    return float(np.mean(values)) if len(values) else math.nan


def error_of_mean(result: Result, column: str) -> float:
    """Standard error; of a single run it is not known."""
    values = result.tables["seeds"][column]
    return float(np.std(values, ddof=1) / math.sqrt(len(values))) if len(values) > 1 else math.nan


def off(results: Collection, case: Case, resolution: int, column: str) -> float:
    """Of the mean from that of the finest run."""
    result, right = results(runs.ensemble(case, resolution)), results(runs.finest(case))
    return mean(result, column) / mean(right, column) - 1 if result and right else math.nan


@dataclass(frozen=True)
class Worst:
    """Of a case: the largest departure from the finest run, its resolution, and what is asked."""

    label: str
    off: float
    resolution: int
    asked: float

    @property
    def share(self) -> float:
        return abs(self.off) / self.asked


def worst_of(results: Collection, case: Case) -> list[Worst]:
    fine = [r for r in case.seeds if r not in COARSE and runs.ensemble(case, r) != runs.finest(case)]
    coarse = [r for r in case.seeds if r in COARSE]
    asked = [
        ("peak", "peak", fine, ASKED["peak"]),
        ("run-out of 90 %", "bulk", fine, ASKED["bulk"]),
        ("run-out of 98 %", "spread", fine, ASKED["spread"]),
        ("peak", "peak", coarse, ASKED_COARSE),
        ("run-out of 90 %", "bulk", coarse, ASKED_COARSE),
        ("mean distance at 0.1 s", "early", [32], ASKED["early"]),
    ]
    found = []
    for label, column, resolutions, limit in asked:
        known = [(r, off(results, case, r, column)) for r in resolutions]
        known = [(r, value) for r, value in known if not math.isnan(value)]
        if known:
            r, value = max(known, key=lambda one: abs(one[1]))
            found.append(Worst(label, value, r, limit))
    return found


def spent(results: Collection, case: Case) -> float:
    return sum(result.cpu for r in case.seeds if (result := results(runs.ensemble(case, r))))


def highest_pressure(results: Collection, case: Case, column: str) -> float:
    """Of all runs from .05 s on, rho g H: late_pressure, of single particles; late_mean, of the means about them."""
    found = [result.tables["seeds"][column].max() for r in case.seeds if (result := results(runs.ensemble(case, r)))]
    return float(max(found)) if found else math.nan


def figure(path: Path, results: Collection) -> bool:
    drawing, panels = plt.subplots(1, 2, figsize=(12, 5), sharey=True, layout="constrained")
    drawn = False
    for case in CASES.values():
        color, line = STYLES[case.key]
        for axes, column in zip(panels, ("peak", "bulk")):
            known = [(r, 100 * off(results, case, r, column)) for r in case.seeds]
            known = [(r, value) for r, value in known if not math.isnan(value)]
            if known:
                drawn = True
                axes.plot(*zip(*known), line, color=color, ms=7, label=case.label)
    for axes, name in zip(panels, ("peak", "run-out of 90 % of the mass")):
        axes.fill_between([28, 150], -100 * ASKED["peak"], 100 * ASKED["peak"], color="0.9", zorder=0, lw=0)
        axes.fill_between([14, 28], -100 * ASKED_COARSE, 100 * ASKED_COARSE, color="0.9", zorder=0, lw=0)
        axes.axhline(0, color="black", lw=1)
        axes.set_xscale("log", base=2)
        axes.set_xlim(14, 150)
        axes.set_xticks([16, 24, 32, 48, 64, 128], ["16", "24", "32", "48", "64", "128"])
        axes.minorticks_off()
        axes.set_xlabel("L/dl")
        axes.set_title(name, fontsize=14)
    panels[0].set_ylabel("% off the finest")
    handles, labels = panels[0].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=3)
    return finish(drawing, path) if drawn else (plt.close(drawing) or False)


def _table(results: Collection) -> str:
    rows = []
    for case in CASES.values():
        for k, (r, seeds) in enumerate(case.seeds.items()):
            result = results(runs.ensemble(case, r))
            if not result:
                rows.append([case.label if k == 0 else "", f"{r}", f"{seeds}", *[NONE] * 12])
                continue
            cells = []
            for column, unit in (("peak", runs.LENGTH), ("bulk", 1), ("spread", 1), ("early", 1)):
                value, doubt, change = mean(result, column) / unit, error_of_mean(result, column) / unit, off(results, case, r, column)
                is_finest = runs.ensemble(case, r) == runs.finest(case)
                cells += [
                    fixed(value) + ("" if math.isnan(doubt) else f" ± {2 * doubt:.3f}"),
                    NONE if is_finest else percent(1 + change, 1),
                ]
            resting = np.mean(~np.isnan(result.tables["seeds"]["rest"]))
            rest = fixed(mean(result, "rest"), 2) + ("" if resting == 1 else f" ({100 * resting:.0f} %)")
            pressures = [fixed(float(result.tables["seeds"][column].max()), 2) for column in ("late_pressure", "late_mean")]
            rows.append([case.label if k == 0 else "", f"{r}", f"{seeds}", *cells, *pressures, rest, cpu(result.cpu / seeds)])
    header = ["case", "L/dl", "runs"]
    for name in ("peak y/L", "run-out, 90 %", "run-out, 98 %", "mean distance at 0.1 s / L0"):
        header += [name, "off"]
    return table([*header, "highest p / (ρ g H)", "of means", "at rest (s)", "CPU s per run"], rows)


def section(results: Collection, drawn_figure: str) -> str:
    return f"""Columns of glass beads released at once, L = {runs.LENGTH:g} m (one side: half of that, from a smooth wall on; L/dl is that of the
two-sided column with the same spacing), in ensembles whose particles start up to {runs.JITTER:g} dl beside their places; ± is two
standard errors. "Off" is from the finest run of the case, of the narrower horizons from that of the default. The highest pressure is
that of any particle of all runs from 0.05 s on: of a grain that the floor stops, ρ c v, a step long, or of one at the front's foot
that is squeezed onto the floor among grains without pressure; "of means" that of the means of a particle and its neighbours within
4 dl by the method's weight, which of a column at rest are 0.90, 0.95, 0.97 ρ g H at L/dl = 16, 32, 64. "Mean
distance" is that of the material from the middle, or the wall, in mid-flow.

{drawn_figure}

{_table(results)}"""
