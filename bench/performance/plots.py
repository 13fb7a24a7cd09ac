"""The figures of docs/performance.md. Each function draws one file and says whether there was anything to draw."""
from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

import measures
import runs
from measures import QUANTITIES, Point, Reference
from plotting import Figures, finish, legend_above
from results import Collection

HORIZON_COLORS = {2.2: "#CC79A7", 2.5: "#E69F00", 3.0: "#009E73", 4.0: "#0072B2"}
FLOOR = 1e-4  # below, an error is drawn here
SHOWN = (0.3, 80)  # %, of collapses: bars of errors may reach down to zero


def _log_log(ax: Axes) -> None:
    """Plain numbers at 1, 2 and 5 where an axis has few decades, at powers of ten else."""
    ax.set_xscale("log")
    ax.set_yscale("log")
    for axis, (low, high) in ((ax.xaxis, ax.get_xlim()), (ax.yaxis, ax.get_ylim())):
        few = high / low < 300
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if few else (1,)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())


def _percent(value: float) -> float:
    return 100 * max(abs(value), FLOOR)


def _work_precision(ax: Axes, points: list[Point], ref: Reference, quantity: str) -> list[tuple[float, float]]:
    """Draws them; returns the places, of the points in order."""
    places = []
    for horizon in sorted({p.horizon for p in points}):
        line = [p for p in points if p.horizon == horizon and not p.setting and p.resolution != ref.resolution]
        line = [p for p in line if not np.isnan(measures.error(p.result, ref, quantity).one_run)]
        errors = [measures.error(p.result, ref, quantity) for p in line]
        ax.errorbar(
            [p.cost for p in line], [_percent(e.one_run) for e in errors], np.nan_to_num([100 * e.one_run_doubt for e in errors]),
            color=HORIZON_COLORS[horizon], marker="o", ms=5, lw=1.6, capsize=2, label=f"horizon {horizon:g}",
        )  # fmt: skip
    line = [p for p in points if p.setting]  # which is which is in the table
    if line:
        ax.plot(
            [p.cost for p in line], [_percent(measures.error(p.result, ref, quantity).one_run) for p in line],
            linestyle="none", marker="x", color="0.55", ms=7, mew=1.6, label="other settings",
        )  # fmt: skip
    for p in points:
        off = measures.error(p.result, ref, quantity).one_run if p.resolution != ref.resolution else np.nan
        places.append((p.cost, off))
    front = measures.pareto(places, places)
    ax.plot([x for x, _ in front], [_percent(y) for _, y in front], color="black", lw=1, ls=":", label="Pareto front")
    ax.axhline(100 * measures.AIM, color="0.8", lw=1, zorder=0)
    ax.set_ylim(*SHOWN)
    _log_log(ax)
    ax.set_xlabel("CPU s per simulated s")
    ax.set_title(QUANTITIES[quantity], fontsize=14)
    return places


def others(path: Path, results: Collection, scenes: tuple[str, ...] = ("a5", "one_side")) -> bool:
    found = [(s, measures.reference(results, s), measures.points(results, s)) for s in scenes]
    shown = [(s, ref, points) for s, ref, points in found if ref and len(points) > 1]
    if not shown:
        return False
    figure, axes = plt.subplots(len(shown), 2, figsize=(11, 5.2 * len(shown)), layout="constrained", squeeze=False)
    for row, (scene, ref, points) in zip(axes, shown):
        for ax, quantity in zip(row, measures.AIMED_AT):
            _work_precision(ax, points, ref, quantity)
        row[0].set_ylabel(f"{runs.SCENES[scene].label}: error of one run (%)")
    legend_above(figure, axes[0, 0], 4)
    return finish(figure, path)


def exact(path: Path, results: Collection) -> bool:
    figure, axes = plt.subplots(4, 2, figsize=(10.5, 16), layout="constrained")  # as wide as a page: readable at half size
    drawn = False
    for ax, case in zip(axes.flat, runs.CASES.values()):
        places: list[tuple[float, float]] = []
        for h in runs.HORIZONS:
            line = [r for r in (results(runs.exact(case.name, n, h)) for n in case.resolutions) if r]
            where = [(max(r.cpu, 1e-3), 100 * abs(r.summary[case.measure])) for r in line]
            places += where
            ax.plot([x for x, _ in where], [y for _, y in where], "o-", color=HORIZON_COLORS[h], label=f"horizon {h:g}")
        if case.varied_at:
            for key, marker, tried in (
                (
                    "sound speed 5, 7, 20 u_max",
                    "d",
                    [results(runs.exact(case.name, case.varied_at, sound=s)) for s in runs.SOUNDS],
                ),
                ("cfl 0.4, 1", "x", [results(runs.exact(case.name, case.varied_at, cfl=c)) for c in case.cfls]),
            ):
                where = [(r.cpu, 100 * abs(r.summary[case.measure])) for r in tried if r]
                places += where
                ax.plot([x for x, _ in where], [y for _, y in where], marker, color="0.35", ms=8, mew=1.8, label=key)
        front = measures.pareto(places, places)
        ax.plot([x for x, _ in front], [y for _, y in front], color="black", lw=1, ls=":", label="Pareto front")
        drawn = drawn or bool(places)
        _log_log(ax)
        ax.set_title(case.label, fontsize=14)
        ax.set_ylabel(f"error (%), {case.unit}", fontsize=13)
        ax.set_xlabel("CPU s")
    last = axes.flat[len(runs.CASES) :]
    for ax in last:
        ax.set_visible(False)
    legend_above(figure, axes.flat[1], 3)
    return drawn and finish(figure, path)


def growth(path: Path, results: Collection) -> bool:
    at_rest = [r for r in (results(runs.growth(n)) for n in runs.GROWTH) if r]
    flow = [r for r in (results(runs.flow(n)) for n in runs.FLOW) if r]
    if not at_rest:
        return False
    figure, (left, right) = plt.subplots(1, 2, figsize=(14, 5.5), layout="constrained")
    for line, color, label in (
        (at_rest, "#0072B2", "at rest between walls"),
        (flow, "#D55E00", "in the middle of the flow"),
    ):
        left.plot(
            [r.summary["particles"] for r in line], [r.summary["cpu"] for r in line], "o-", color=color, label=label
        )
    machine = results(runs.machine())
    for level, name in ((2, "L2"), (3, "L3")):
        if machine and f"cache_{level}" in machine.summary:
            particles = machine.summary[f"cache_{level}"] / at_rest[-1].summary["bytes"]
            left.axvline(particles, color="0.75", lw=1, zorder=0)
            left.annotate(
                f" {name} full", (particles, 0.02), xycoords=("data", "axes fraction"), fontsize=11, color="0.4"
            )
    left.set_xscale("log")
    left.set_ylim(bottom=0)
    left.set_xlabel("particles")
    left.set_ylabel("CPU ns per particle and step")
    left.legend()
    size = [r.summary["particles"] for r in at_rest]
    right.plot(
        size,
        [r.summary["bytes"] * n for r, n in zip(at_rest, size)],
        "o-",
        color="#0072B2",
        label="held by the library",
    )
    right.plot(
        size, [r.summary["peak_memory"] for r in at_rest], "s--", color="#009E73", label="peak of the whole program"
    )
    right.set_xscale("log")
    right.set_yscale("log")
    right.set_xlabel("particles")
    right.set_ylabel("bytes")
    right.legend()
    return finish(figure, path)


FIGURES: Figures = {"others": others, "exact": exact, "growth": growth}
