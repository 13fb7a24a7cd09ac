"""Figures of the scenes of Jin et al. (2021). Each function draws one file and tells whether there was anything to."""
from __future__ import annotations

from pathlib import Path
from typing import Callable, Iterable

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

import references as ref
import runs
from drawing import MARKERS, STYLES, Available, available, label_of
from measures import peak, run_out_at
from plotting import finish, legend_above
from results import Collection

INTERFACE_JUMP = 0.006  # m: where the interface moves further from one row to the next it is not drawn
SLOWEST = 1e-7  # of sqrt(g d): slower is drawn as this

# ------------------------------------------------------------------------------------------------ free surfaces


def profiles(
    path: Path,
    chosen: Available,
    times: Iterable[float],
    unit: float,
    unit_name: str,
    start: list[tuple[float, float, float]],
    marks: Callable[[Axes, float], None] | None = None,
    everything: bool = False,
) -> bool:
    """Surfaces at several times, one panel below the other. start: columns as (x_min, width, height)."""
    surfaces = {time: [(key, *result.surface(time, everything)) for key, result in chosen] for time in times}
    surfaces = {time: [one for one in found if len(one[1])] for time, found in surfaces.items()}
    surfaces = {time: found for time, found in surfaces.items() if found}
    if not surfaces:
        return False
    left = min(x.min() for found in surfaces.values() for _, x, _ in found) / unit
    right = max(x.max() for found in surfaces.values() for _, x, _ in found) / unit
    top = max(height for _, _, height in start) / unit * 1.12
    width = 10.0
    each = max(1.2, width * top / (right - left))
    figure, panels = plt.subplots(
        len(surfaces),
        1,
        figsize=(width, len(surfaces) * (each + 0.35)),
        sharex=True,
        squeeze=False,
        layout="compressed",
    )
    for axes, (time, found) in zip(panels[:, 0], surfaces.items()):
        for x, w, h in start:
            axes.add_patch(
                plt.Rectangle((x / unit, 0), w / unit, h / unit, fill=False, color="0.6", linestyle=":", lw=1.4)
            )
        for key, x, height in found:
            color, line = STYLES[key]
            axes.plot(x / unit, height / unit, color=color, linestyle=line, label=label_of(key))
        if marks:
            marks(axes, time)
        axes.axhline(0, color="black", linewidth=1.2)
        axes.set_xlim(left, right)
        axes.set_ylim(0, top)
        axes.set_aspect("equal", adjustable="box")
        axes.text(0.99, 0.97, f"t = {time:g} s", transform=axes.transAxes, va="top", ha="right", fontweight="bold")
        axes.set_ylabel(f"y{unit_name}")
    panels[-1, 0].set_xlabel(f"x{unit_name}")
    panels[0, 0].legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=3)
    return finish(figure, path)


def both_side(path: Path, results: Collection) -> bool:
    def marks(axes: Axes, time: float) -> None:
        if time == ref.PEAK_TIME:
            axes.plot([-0.12, 0.12], [ref.EXPERIMENT_PEAK] * 2, color="black", lw=3, label="experiment, peak")
            axes.annotate(
                "experiment, peak",
                (0.12, ref.EXPERIMENT_PEAK),
                (0.45, ref.EXPERIMENT_PEAK),
                va="center",
                fontsize=12.5,
                arrowprops={"arrowstyle": "-", "lw": 1},
            )

    chosen = available(results, lambda key: runs.main_run("both_1.25", key), runs.SCHEMES)
    return profiles(path, chosen, (0.12, 0.22, 0.42), ref.WIDTH, "/L", [(-0.04, 0.08, 0.05)], marks)


def tall(path: Path, results: Collection) -> bool:
    chosen = available(results, lambda key: runs.main_run("both_5", key), runs.MAIN_SCENES["both_5"])
    return profiles(path, chosen, (0.2, 0.36, 0.67), ref.WIDTH, "/L", [(-0.04, 0.08, 0.20)])


def one_side(path: Path, results: Collection) -> bool:
    chosen = available(results, lambda key: runs.main_run("one_side", key), runs.MAIN_SCENES["one_side"])
    return profiles(path, chosen, (0.18, 0.3, 0.42, 1.02), 1.0, " (m)", [(0, 0.20, 0.14)])


def colliding(path: Path, results: Collection) -> bool:
    chosen = available(results, lambda key: runs.main_run("colliding_1", key), runs.MAIN_SCENES["colliding_1"])
    return profiles(
        path,
        chosen,
        (0.1, 0.2, 0.3, 0.4, 1.61),
        1.0,
        " (m)",
        [(-0.10, 0.08, 0.156), (0.02, 0.08, 0.054)],
        everything=True,
    )


def interface(path: Path, results: Collection) -> bool:
    """Case II: the line between the columns; heights in m, both axes alike."""
    chosen = available(results, lambda key: runs.main_run("colliding_2", key), runs.MAIN_SCENES["colliding_2"])
    times = (0.15, 0.2, 0.4, 0.6)
    if not chosen:
        return False
    figure, panels = plt.subplots(1, len(times), figsize=(11, 5.2), sharey=True, layout="compressed")
    for axes, time in zip(panels, times):
        for key, result in chosen:
            rows = result.select("interface", time)
            color, line = STYLES[key]
            if rows:
                x = rows["x"].copy()
                x[1:][np.abs(np.diff(rows["x"])) > INTERFACE_JUMP] = np.nan
                axes.plot(x, rows["y"], color=color, linestyle=line, label=label_of(key))
        axes.set_xlim(-0.035, 0.015)
        axes.set_ylim(0, 0.1)
        axes.set_aspect("equal", adjustable="box")
        axes.set_title(f"t = {time:g} s", fontsize=14)
        axes.set_xlabel("x (m)")
        axes.set_xticks([-0.02, 0.0])
    foot, height = 0.0, 0.04
    slope = np.tan(np.radians(ref.EXPERIMENT_INTERFACE_ANGLE))
    rows = chosen[0][1].select("interface", 0.6)
    if rows and len(rows["x"]):
        foot = float(np.interp(0.01, rows["y"], rows["x"]))
    sign = 1 if chosen[0][1].interface_angle(0.6, 0.1, 0.6) >= 0 else -1
    panels[-1].plot(
        [foot, foot + sign * slope * height],
        [0.01, 0.01 + height],
        color="black",
        lw=1.6,
        label=f"{ref.EXPERIMENT_INTERFACE_ANGLE}° (experiment), from the default's foot",
    )
    panels[0].set_ylabel("y (m)")
    legend_above(figure, panels[-1], 3)
    return finish(figure, path)


# ---------------------------------------------------------------------------------------------- the peak, a = 1.25


def peak_in_time(path: Path, results: Collection) -> bool:
    """Above: schemes. Below: horizons, with the paper's numbers."""
    chosen = available(results, lambda key: runs.main_run("both_1.25", key), runs.SCHEMES)
    if not chosen:
        return False
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(11, 8), sharex=True, sharey=True, layout="constrained")
    for key, result in chosen:
        series = result.tables["series"]
        color, line = STYLES[key]
        upper.plot(series["time"], series["peak_height"] / ref.WIDTH, color=color, linestyle=line, label=label_of(key))
    lines = {2.2: "--", 4.0: "-"}
    for scheme, horizons in runs.HORIZON_STUDY.items():
        for horizon in (min(horizons), max(horizons)):
            result = results(runs.horizon_run(scheme, horizon))
            if result:
                series = result.tables["series"]
                lower.plot(
                    series["time"],
                    series["peak_height"] / ref.WIDTH,
                    color=STYLES[scheme][0],
                    linestyle=lines[horizon],
                    label=f"{label_of(scheme)}, horizon {horizon:g} dl",
                )
    creep = {ref.PEAK_TIME: ref.PAPER_PEAK[2.2], **ref.PAPER_CREEP_2_2}
    lower.plot(list(creep), list(creep.values()), "kx", ms=9, mew=2, label="paper, horizon 2.2 dl")
    lower.plot([ref.PEAK_TIME], [ref.PAPER_PEAK[4.0]], "k+", ms=12, mew=2, label="paper, horizon 4 dl")
    for axes in (upper, lower):
        axes.plot(
            [ref.PEAK_TIME], [ref.EXPERIMENT_PEAK], "o", color="black", ms=8, mfc="none", mew=2, label="experiment"
        )
        axes.set_ylabel("peak y/L")
        axes.set_xlim(0, 3.05)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    lower.set_xlabel("t (s)")
    return finish(figure, path)


def resolution(path: Path, results: Collection) -> bool:
    """Peak and run-out at 0.42 s against L/dl."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5), layout="constrained")
    drawn = False
    for scheme, all_r in runs.RESOLUTION_STUDY.items():
        if len(all_r) == 1:
            continue
        found = [(r, results(runs.resolution_run(scheme, r))) for r in all_r]
        found = [(r, result) for r, result in found if result]
        if not found:
            continue
        drawn = True
        style = {
            "color": STYLES[scheme][0],
            "linestyle": STYLES[scheme][1],
            "marker": MARKERS[scheme],
            "ms": 8,
            "label": label_of(scheme),
        }
        left.plot([r for r, _ in found], [peak(result) for _, result in found], **style)
        right.plot([r for r, _ in found], [run_out_at(result, ref.PEAK_TIME) for _, result in found], **style)
    left.plot(
        list(ref.PAPER_RESOLUTION),
        list(ref.PAPER_RESOLUTION.values()),
        "k+",
        ms=13,
        mew=2.5,
        linestyle="none",
        label="paper, printed",
    )
    left.axhline(ref.EXPERIMENT_PEAK, color="black", lw=1.2, label="experiment")
    left.axhspan(*ref.CODES_PEAK_BAND, color="0.88", zorder=0, label="MPM and VOF codes, factor 1")
    left.set_ylabel("peak y/L at 0.42 s")
    right.set_ylabel("run-out of 90 % of the mass at 0.42 s")
    for axes in (left, right):
        axes.set_xscale("log", base=2)
        axes.set_xticks(runs.RESOLUTIONS, [str(r) for r in runs.RESOLUTIONS])
        axes.set_xlabel("L/dl")
    legend_above(figure, left, 3)
    return finish(figure, path) if drawn else (plt.close(figure) or False)


def velocity(path: Path, results: Collection) -> bool:
    """Horizontal velocity on the paper's sections."""
    chosen = available(results, lambda key: runs.main_run("both_1.25", key), runs.SCHEMES)
    if not chosen:
        return False
    scale = np.sqrt(runs.GRAVITY * 0.002)
    figure, panels = plt.subplots(2, 2, figsize=(13, 7.6), sharex=True, layout="constrained")
    for row, time in zip(panels, (0.129, 0.189)):
        for axes, y in zip(row, (0.01, 0.03)):
            for key, result in chosen:
                rows = result.select("section", time, y=y)
                color, line = STYLES[key]
                if rows:
                    axes.plot(
                        rows["x"] / ref.WIDTH, rows["vx"] / scale, color=color, linestyle=line, label=label_of(key)
                    )
            axes.set_title(f"t = {time:g} s, y/L = {y / ref.WIDTH:g}", fontsize=14)
            axes.axhline(0, color="0.6", lw=0.8)
    for axes in panels[-1]:
        axes.set_xlabel("x/L")
    for axes in panels[:, 0]:
        axes.set_ylabel("u / √(g d)")
    legend_above(figure, panels[0, 0], 3)
    return finish(figure, path)


def solid_speed(path: Path, results: Collection) -> bool:
    """Speed left on y/L = 0.25 at 1 s, a = 5."""
    chosen = available(results, lambda key: runs.main_run("both_5", key), runs.MAIN_SCENES["both_5"])
    if not chosen:
        return False
    scale = np.sqrt(runs.GRAVITY * 0.002)
    figure, axes = plt.subplots(figsize=(10, 4.8), layout="constrained")
    for key, result in chosen:
        rows = result.select("section", 1.0, y=0.02)
        color, line = STYLES[key]
        if rows:
            axes.plot(
                rows["x"] / ref.WIDTH,
                np.maximum(rows["speed"] / scale, SLOWEST),
                color=color,
                linestyle=line,
                label=label_of(key),
            )
    axes.set_yscale("log")
    axes.set_xlabel("x/L")
    axes.set_ylabel("|u| / √(g d)")
    legend_above(figure, axes, 3)
    return finish(figure, path)
