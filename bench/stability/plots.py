"""The figures of docs/stability.md. Each function draws one file and says whether there was anything to draw."""
from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Iterable

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

import runs
import theory
from coefficients import COEFFICIENTS, CRITERION
from measures import QUANTITIES, change, mean
from plotting import Figures, finish, legend_above
from results import Collection, Result
from sections import present, pressure_rows

COLORS = {"default": "#0072B2", "paper": "#D55E00", "local": "#CC79A7", "implicit": "#009E73"}
QUANTITY_STYLES = {"peak": ("#0072B2", "o", "-"), "bulk": ("#D55E00", "s", "-"), "spread": ("0.6", "^", ":")}
SPEED_UNIT = math.sqrt(runs.GRAVITY * 0.002)  # m/s, sqrt(g d)


def _shades(color: str, n: int) -> list[tuple[float, ...]]:
    """From light to full."""
    full = np.array(plt.matplotlib.colors.to_rgb(color))
    return [tuple(1 - (1 - full) * share) for share in np.linspace(0.35, 1, max(n, 2))][:n] if n > 1 else [tuple(full)]


def _legend_of_schemes(
    figure: plt.Figure, schemes: Iterable[runs.Scheme], lines: list[tuple[str, dict[str, Any]]], columns: int
) -> None:
    """A colour for each scheme, and what the kinds of lines are."""
    handles = [Line2D([], [], color=COLORS[s.key], lw=4, label=s.label) for s in schemes]
    handles += [Line2D([], [], color="black", label=label, **style) for label, style in lines]
    figure.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=columns)


def sensitivity(path: Path, results: Collection) -> bool:
    base = results(runs.base_ensemble())
    shown = [c for c in COEFFICIENTS if not c.inert]
    if not base:
        return False
    columns = 3
    figure, axes = plt.subplots(
        math.ceil(len(shown) / columns), columns, figsize=(14, 3.3 * math.ceil(len(shown) / columns)),
        layout="constrained", squeeze=False,
    )  # fmt: skip
    for ax, c in zip(axes.flat, shown):
        ax.axhspan(-100 * CRITERION, 100 * CRITERION, color="0.92")
        if c.in_criterion:
            ax.axvspan(c.half, c.twice, color="#FFF3C4", zorder=0, alpha=0.6)
        for column, label in QUANTITIES.items():
            color, marker, line = QUANTITY_STYLES[column]
            found = [(value, results(runs.varied(c, value))) for value in c.all_values]
            points = [(value, change(result, base, column)) for value, result in found if result]
            points = [(v, one.value if v != c.default else 0.0, one.doubt) for v, one in points]
            ax.errorbar(
                [v for v, _, _ in points], [100 * y for _, y, _ in points], [100 * e for _, _, e in points],
                color=color, marker=marker, linestyle=line, lw=1.5, ms=5, capsize=2, label=label,
            )  # fmt: skip
        positive = [v for v in c.all_values if v > 0]
        if max(positive) / min(positive) > 3 and len(positive) == len(c.all_values):
            ax.set_xscale("log")
            ax.set_xticks(positive, [f"{v:g}" for v in positive])
            ax.minorticks_off()
        elif max(positive) / min(positive) > 9:
            ax.set_xscale("symlog", linthresh=min(positive))
            ax.set_xticks(c.all_values, [f"{v:g}" for v in c.all_values])
            ax.minorticks_off()
        ax.set_ylim(-12, 12)
        ax.set_xlabel(f"{c.name}{f' ({c.unit})' if c.unit else ''}", fontsize=12)
        ax.tick_params(labelsize=11)
    for ax in axes[:, 0]:
        ax.set_ylabel("change (%)")
    for ax in axes.flat[len(shown) :]:
        ax.set_visible(False)
    legend_above(figure, axes[0, 0], 3)
    return finish(figure, path)


def limits(path: Path, results: Collection) -> bool:
    schemes = present(results)
    if not schemes:
        return False
    figure, axes = plt.subplots(2, 2, figsize=(10.5, 8), layout="constrained", sharey=True)
    drawn = False
    for ax, axis in zip(axes.flat, runs.AXES):
        for s in schemes:
            found = [(v, results(axis.run(s.key, v))) for v in axis.of(s)]
            found = [(v, result) for v, result in found if result]
            drawn = drawn or bool(found)
            for grade, line, filled in (("bounded", ":", "none"), ("stable", "-", COLORS[s.key])):
                ax.plot(
                    [v for v, _ in found], [r.summary[grade] for _, r in found], color=COLORS[s.key], linestyle=line,
                    marker="o", mfc=filled,
                )  # fmt: skip
        if axis.values == runs.SCHEMES["default"].limit_horizons:
            h = np.linspace(min(axis.values), max(axis.values), 8)
            ax.plot(h, [theory.surface(x) for x in h], color="black", lw=1.2)
            ax.plot(h, [theory.interior(x) for x in h], color="black", lw=1.2, ls=":")
        else:
            ax.set_xscale("log")
            ax.set_xticks(axis.values, [f"{v:g}" for v in axis.values])
            ax.minorticks_off()
        ax.axhline(1, color="0.7", lw=1, zorder=0)
        ax.set_xlabel(axis.name)
    for ax in axes[:, 0]:
        ax.set_ylabel("largest dt × wave speed / dl")
    axes[0, 0].set_ylim(bottom=0)
    _legend_of_schemes(
        figure, schemes, [("calm up to", {"marker": "o"}), ("makes no energy up to", {"marker": "o", "mfc": "none", "ls": ":"}),
                          ("theory, free surface", {"lw": 1.2}), ("theory, inside", {"lw": 1.2, "ls": ":"})], 4,
    )  # fmt: skip
    return drawn and finish(figure, path)


def creep(path: Path, results: Collection) -> bool:
    schemes = present(results)
    if not schemes:
        return False
    figure, axes = plt.subplots(
        len(schemes), 2, figsize=(11, 3.3 * len(schemes)), layout="constrained", squeeze=False, sharey="col", sharex=True
    )
    for (left, right), s in zip(axes, schemes):
        by_step = [(f"cfl {c:g}", runs.creep(s.key, cfl=c)) for c in s.cfls]
        by_delta = [(f"delta {d:g}", runs.creep(s.key, delta=d)) for d in s.deltas[1:]]
        for tried, color, line in ((by_step, COLORS[s.key], "-"), (by_delta, "#444444", "--")):
            for (label, run), shade in zip(tried, _shades(color, len(tried))):
                result = results(run)
                if not result:
                    continue
                series = result.tables["series"]
                left.plot(series["time"], series["peak_height"] / runs.WIDTH, line, color=shade, lw=1.7, label=label)
                speed = np.maximum(series["rms_speed"] / SPEED_UNIT, 1e-9)
                right.plot(series["time"], speed, line, color=shade, lw=1.2)
        left.set_title(s.label, fontsize=14, loc="left")
        left.set_ylabel("peak y/L")
        right.legend(*left.get_legend_handles_labels(), fontsize=12, loc="center left", bbox_to_anchor=(1.0, 0.5))
        right.set_yscale("log")
        right.set_ylabel("rms speed / √(g d)")
    for ax in axes[-1]:
        ax.set_xlabel("t (s)")
    return finish(figure, path)


def drift(path: Path, results: Collection) -> bool:
    """Which of a scheme's lines is which: from light to dark in the order of the table."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
    drawn = []
    for s in runs.SCHEMES.values():
        rests = runs.rests_of(s)
        for rest, shade in zip(rests, _shades(COLORS[s.key], len(rests))):
            line = "-" if rest.resolution == 16 else "--"
            result = results(rest.run)
            if not result:
                continue
            drawn += [s] * (s not in drawn)
            series = result.tables["series"]
            later = series["time"] > runs.DRIFT_FROM
            left.plot(series["time"][later], np.maximum(series["drift"][later], 1e-12), line, color=shade)
            right.plot(series["time"], np.maximum(series["kinetic_share"], 1e-34), line, color=shade, lw=1.2)
    left.set_ylabel("largest displacement since 3 s / dl")
    right.set_ylabel("kinetic energy / E0")
    for ax in (left, right):
        ax.set_yscale("log")
        ax.set_xscale("log")
        ax.set_xlabel("t (s)")
    for ax, first in ((right, 0.1), (left, 3)):
        ax.set_xlim(first, 60)
        ticks = [t for t in (0.1, 0.3, 1, 3, 10, 30, 60) if t >= first]
        ax.set_xticks(ticks, [f"{t:g}" for t in ticks])
        ax.minorticks_off()
    _legend_of_schemes(figure, drawn, [("L/dl = 16", {}), ("L/dl = 32", {"ls": "--"})], 6)
    return bool(drawn) and finish(figure, path)


def pressure(path: Path, results: Collection) -> bool:
    rows: list[tuple[str, Result]] = [
        row for row in pressure_rows(results) if "horizon" not in row[0] and " no " not in row[0]
    ]
    if not rows:
        return False
    figure, (left, right) = plt.subplots(1, 2, figsize=(14, 5), layout="constrained")
    for s, (label, result) in zip(present(results), rows):
        series = result.tables["series"]
        left.plot(series["time"], series["max_pressure"], color=COLORS[s.key], lw=1.2, label=label)
        right.plot(series["time"], series["pressure_noise"], color=COLORS[s.key], lw=1.2)
    left.set_ylabel("highest p / (ρ g H)")
    right.set_ylabel("rms departure of p from its\nneighbours' plane / (ρ g H)")
    right.set_yscale("log")
    right.set_ylim(3e-3, 1)
    for ax in (left, right):
        ax.set_xlim(0, 1)
        ax.set_xlabel("t (s)")
    legend_above(figure, left, 4)
    return finish(figure, path)


def modes(path: Path, results: Collection) -> bool:
    figure, axes = plt.subplots(1, len(runs.MODES), figsize=(13, 4.8), layout="constrained", sharey=True)
    drawn = False
    for ax, pattern in zip(axes, runs.MODES):
        for penalty, shade in zip(
            runs.MODE_PENALTIES, plt.get_cmap("viridis")(np.linspace(0, 0.9, len(runs.MODE_PENALTIES)))
        ):
            result = results(runs.mode(pattern, penalty))
            if not result:
                continue
            drawn = True
            series = result.tables["series"]
            unit = result.summary["sound_speed"] * 32 / runs.WIDTH
            time = series["time"] * unit
            ax.plot(time, series["kinetic_share"] / series["kinetic_share"][0], color=shade, label=f"penalty {penalty:g}")
            ax.plot(time, np.exp(-theory.checkerboard_decay(4, penalty, pattern) * time), ":", color=shade, lw=1.2)
        ax.set_yscale("log")
        ax.set_ylim(1e-4, 1.5)
        ax.set_xlabel("t c0 / dl")
        ax.set_title(pattern)
    axes[0].set_ylabel("kinetic energy / at the start")
    legend_above(figure, axes[0], 6)
    return drawn and finish(figure, path)


def resolution(path: Path, results: Collection) -> bool:
    found = [(r, results(runs.resolution_run(r))) for r in runs.RESOLUTIONS]
    found = [(r, result) for r, result in found if result]
    if not found:
        return False
    figure, axes = plt.subplots(1, 3, figsize=(15, 4.8), layout="constrained")
    for ax, columns in zip(axes, (("peak",), ("bulk", "spread"))):
        for column in columns:
            color, marker, line = QUANTITY_STYLES[column]
            unit = runs.WIDTH if column == "peak" else 1
            means = [mean(result, column) for _, result in found]
            ax.errorbar(
                [r for r, _ in found], [m.value / unit for m in means],
                [0 if math.isnan(m.error) else 2 * m.error / unit for m in means],
                color=color, marker=marker, linestyle=line, capsize=3, label=QUANTITIES[column],
            )  # fmt: skip
    axes[0].set_ylabel("peak y/L")
    axes[1].set_ylabel("(x - L0) / L0")
    axes[1].legend()
    axes[2].plot([r for r, _ in found], [r.cpu / runs.RESOLUTIONS[n] for n, r in found], "o-", color="#0072B2")
    axes[2].set_yscale("log")
    axes[2].set_ylabel("CPU s per run, to rest")
    for ax in axes:
        ax.set_xscale("log", base=2)
        ax.set_xticks([r for r, _ in found], [f"{r}" for r, _ in found])
        ax.set_xlabel("L/dl")
    return finish(figure, path)


FIGURES: Figures = {
    "sensitivity": sensitivity,
    "limits": limits,
    "creep": creep,
    "drift": drift,
    "pressure": pressure,
    "modes": modes,
    "resolution": resolution,
}
