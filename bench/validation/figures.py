"""The figures of docs/validation.md. Each function draws one file and says whether there was anything to draw."""
from __future__ import annotations

from pathlib import Path
from typing import Callable, Iterable

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

import references as ref
import runs
from measures import contact_front, couette_profile, peak, run_out_at
from results import Collection, Result

STYLES = {  # colour (readable with colour blindness), line
    "default": ("#0072B2", "-"),
    "raised": ("#56B4E9", "--"),
    "walls": ("#009E73", "-."),
    "nonlocal_1": ("#E69F00", "-"),
    "nonlocal_2": ("#D55E00", "-"),
    "local_1": ("#CC79A7", "--"),
    "local_2": ("#7A3B69", "--"),
}
MARKERS = {"default": "o", "raised": "s", "walls": "^", "nonlocal_1": "D", "nonlocal_2": "v", "local_1": "<", "local_2": ">"}

plt.rcParams.update({"font.size": 14, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False,
                     "lines.linewidth": 2.0, "axes.labelsize": 15, "legend.fontsize": 12.5, "figure.dpi": 100})

INTERFACE_JUMP = 0.006  # m: where the interface moves further from one row to the next it is not drawn
SLOWEST = 1e-7  # of sqrt(g d): slower is drawn as this

Available = list[tuple[str, Result]]


def available(results: Collection, run_of: Callable[[str], runs.Run], schemes: Iterable[str]) -> Available:
    """The schemes that have a result."""
    pairs = ((key, results(run_of(key))) for key in schemes)
    return [(key, result) for key, result in pairs if result is not None]


def finish(figure: plt.Figure, path: Path) -> bool:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, bbox_inches="tight", pad_inches=0.12)
    plt.close(figure)
    return True


def legend_above(figure: plt.Figure, axes: Axes, columns: int) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=columns)


def label_of(scheme: str) -> str:
    return runs.SCHEMES[scheme].label


# ------------------------------------------------------------------------------------------------ free surfaces

def profiles(path: Path, chosen: Available, times: Iterable[float], unit: float, unit_name: str,
             start: list[tuple[float, float, float]], marks: Callable[[Axes, float], None] | None = None) -> bool:
    """Surfaces at several times, one panel below the other. start: columns as (x_min, width, height)."""
    times = [t for t in times if any(len(result.surface(t)[0]) for _, result in chosen)]
    if not times:
        return False
    left = min(result.surface(t)[0].min() for _, result in chosen for t in times if len(result.surface(t)[0])) / unit
    right = max(result.surface(t)[0].max() for _, result in chosen for t in times if len(result.surface(t)[0])) / unit
    top = max(height for _, _, height in start) / unit * 1.12
    width = 10.0
    each = max(1.2, width * top / (right - left))
    figure, panels = plt.subplots(len(times), 1, figsize=(width, len(times) * (each + 0.35)), sharex=True, squeeze=False,
                                  layout="compressed")
    for axes, time in zip(panels[:, 0], times):
        for x, w, h in start:
            axes.add_patch(plt.Rectangle((x / unit, 0), w / unit, h / unit, fill=False, color="0.6", linestyle=":", lw=1.4))
        for key, result in chosen:
            x, height = result.surface(time)
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
    legend_above(figure, panels[0, 0], 3)
    return finish(figure, path)


def both_side(path: Path, results: Collection) -> bool:
    def marks(axes: Axes, time: float) -> None:
        if time == ref.PEAK_TIME:
            axes.plot([-0.12, 0.12], [ref.EXPERIMENT_PEAK] * 2, color="black", lw=3, label="experiment, peak")
            axes.annotate("experiment, peak", (0.12, ref.EXPERIMENT_PEAK), (0.45, ref.EXPERIMENT_PEAK), va="center",
                          fontsize=12.5, arrowprops={"arrowstyle": "-", "lw": 1})
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
    return profiles(path, chosen, (0.1, 0.2, 0.3, 0.4, 1.61), 1.0, " (m)", [(-0.10, 0.08, 0.156), (0.02, 0.08, 0.054)])


def interface(path: Path, results: Collection) -> bool:
    """Case II: the line between the columns; heights in m, both axes alike."""
    chosen = available(results, lambda key: runs.main_run("colliding_2", key), runs.MAIN_SCENES["colliding_2"])
    times = (0.15, 0.2, 0.4, 0.6)
    if not chosen:
        return False
    figure, panels = plt.subplots(1, len(times), figsize=(13, 4.9), sharey=True, layout="compressed")
    for axes, time in zip(panels, times):
        for key, result in chosen:
            rows = result.select("interface", time)
            color, line = STYLES[key]
            if rows:
                x = rows["x"].copy()
                x[1:][np.abs(np.diff(rows["x"])) > INTERFACE_JUMP] = np.nan
                axes.plot(x, rows["y"], color=color, linestyle=line, label=label_of(key))
        axes.set_xlim(-0.055, 0.015)
        axes.set_ylim(0, 0.1)
        axes.set_aspect("equal", adjustable="box")
        axes.set_title(f"t = {time:g} s", fontsize=14)
        axes.set_xlabel("x (m)")
        axes.set_xticks([-0.04, -0.02, 0.0])
    foot, height = 0.0, 0.04
    slope = np.tan(np.radians(ref.EXPERIMENT_INTERFACE_ANGLE))
    rows = chosen[0][1].select("interface", 0.6)
    if rows and len(rows["x"]):
        foot = float(np.interp(0.01, rows["y"], rows["x"]))
    sign = 1 if chosen[0][1].interface_angle(0.6, 0.1, 0.6) >= 0 else -1
    panels[-1].plot([foot, foot + sign * slope * height], [0.01, 0.01 + height], color="black", lw=1.6,
                    label=f"{ref.EXPERIMENT_INTERFACE_ANGLE}° (experiment), from the default's foot")
    panels[0].set_ylabel("y (m)")
    legend_above(figure, panels[-1], 3)
    return finish(figure, path)


# ---------------------------------------------------------------------------------------------- the peak, a = 1.25

def peak_in_time(path: Path, results: Collection) -> bool:
    """Left: schemes. Right: horizons, with the paper's numbers."""
    chosen = available(results, lambda key: runs.main_run("both_1.25", key), runs.SCHEMES)
    if not chosen:
        return False
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5), sharey=True, layout="constrained")
    for key, result in chosen:
        series = result.tables["series"]
        color, line = STYLES[key]
        left.plot(series["time"], series["peak_height"] / ref.WIDTH, color=color, linestyle=line, label=label_of(key))
    lines = {2.2: ":", 3.0: "--", 4.0: "-"}
    for scheme, horizons in runs.HORIZON_STUDY.items():
        for horizon in horizons:
            result = results(runs.horizon_run(scheme, horizon))
            if result:
                series = result.tables["series"]
                right.plot(series["time"], series["peak_height"] / ref.WIDTH, color=STYLES[scheme][0], linestyle=lines[horizon],
                           label=f"{label_of(scheme)}, horizon {horizon:g} dl")
    creep = {ref.PEAK_TIME: ref.PAPER_PEAK[2.2], **ref.PAPER_CREEP_2_2}
    right.plot(list(creep), list(creep.values()), "kx", ms=9, mew=2, label="paper, horizon 2.2 dl")
    right.plot([ref.PEAK_TIME], [ref.PAPER_PEAK[4.0]], "k+", ms=12, mew=2, label="paper, horizon 4 dl")
    for axes in (left, right):
        axes.plot([ref.PEAK_TIME], [ref.EXPERIMENT_PEAK], "o", color="black", ms=8, mfc="none", mew=2, label="experiment")
        axes.set_xlabel("t (s)")
        axes.set_xlim(0, 3.05)
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=2, fontsize=11.5)
    left.set_ylabel("peak y/L")
    return finish(figure, path)


def resolution(path: Path, results: Collection) -> bool:
    """Peak and run-out at 0.42 s against L/dl."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5), layout="constrained")
    drawn = False
    for scheme, all_r in runs.RESOLUTION_STUDY.items():
        found = [(r, results(runs.resolution_run(scheme, r))) for r in all_r]
        found = [(r, result) for r, result in found if result]
        if not found:
            continue
        drawn = True
        style = {"color": STYLES[scheme][0], "linestyle": STYLES[scheme][1], "marker": MARKERS[scheme], "ms": 8,
                 "label": label_of(scheme)}
        left.plot([r for r, _ in found], [peak(result) for _, result in found], **style)
        right.plot([r for r, _ in found], [run_out_at(result, ref.PEAK_TIME) for _, result in found], **style)
    left.plot(list(ref.PAPER_RESOLUTION), list(ref.PAPER_RESOLUTION.values()), "k+", ms=13, mew=2.5, linestyle="none",
              label="paper, printed")
    left.axhline(ref.EXPERIMENT_PEAK, color="black", lw=1.2, label="experiment")
    left.axhspan(*ref.CODES_PEAK_BAND, color="0.88", zorder=0, label="independent codes, factor 1")
    left.set_ylabel("peak y/L at 0.42 s")
    right.set_ylabel("run-out (x - L0)/L0 at 0.42 s")
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
                    axes.plot(rows["x"] / ref.WIDTH, rows["vx"] / scale, color=color, linestyle=line, label=label_of(key))
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
            axes.plot(rows["x"] / ref.WIDTH, np.maximum(rows["speed"] / scale, SLOWEST), color=color, linestyle=line,
                      label=label_of(key))
    axes.set_yscale("log")
    axes.set_xlabel("x/L")
    axes.set_ylabel("|u| / √(g d)")
    legend_above(figure, axes, 3)
    return finish(figure, path)


# ------------------------------------------------------------------------------------------------- other studies

def lift(path: Path, results: Collection) -> bool:
    found = [(t, results(runs.lift_run(t))) for t in runs.LIFT_TIMES]
    found = [(t, result) for t, result in found if result]
    if not found:
        return False
    figure, axes = plt.subplots(figsize=(10, 4.8), layout="constrained")
    colors = plt.get_cmap("viridis")(np.linspace(0, 0.9, len(found)))
    for (t, result), color in zip(found, colors):
        series = result.tables["series"]
        axes.plot(series["time"], series["peak_height"] / ref.WIDTH, color=color,
                  label="instant" if t == 0 else f"lifted in {t:g} s")
    axes.plot([ref.PEAK_TIME], [ref.EXPERIMENT_PEAK], "o", color="black", ms=8, mfc="none", mew=2, label="experiment")
    axes.set_xlim(0, 1)
    axes.set_xlabel("t (s)")
    axes.set_ylabel("peak y/L")
    axes.legend()
    return finish(figure, path)


def scaling(path: Path, results: Collection) -> bool:
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5.6), layout="constrained")
    a = np.geomspace(0.4, 12, 200)
    laws = ((ref.lagree_run_out, "Lagrée et al. 2011, μ(I) continuum", "-"),
            (ref.staron_run_out, "Staron & Hinch 2005, discs", "--"),
            (ref.lajeunesse_run_out, "Lajeunesse et al. 2005, experiment", "-."),
            (ref.lube_run_out, "Lube et al. 2005, experiment", ":"))
    for law, label, line in laws:
        values = np.array([law(one) for one in a])
        values[1:][np.abs(np.diff(np.log(values))) > 0.05] = np.nan  # the laws jump between their branches
        left.plot(a, values, color="0.35", linestyle=line, lw=1.7, label=label)
    right.plot(a, [ref.staron_height(one) for one in a], color="0.35", linestyle="--", lw=1.7)
    right.plot(a, [ref.lube_height(one) for one in a], color="0.35", linestyle=":", lw=1.7)
    drawn = False
    for sides, marker, color, size, label in ((2, "o", "#0072B2", 7, "default, two sides"),
                                              (1, "s", "#D55E00", 13, "default, one side")):
        style = {"marker": marker, "linestyle": "none", "color": color, "ms": size, "mew": 2,
                 "mfc": color if sides == 2 else "none"}
        found = [(one, results(runs.scaling(one, sides))) for one in runs.ASPECTS]
        found = [(one, result) for one, result in found if result]
        drawn = drawn or bool(found)
        left.plot([one for one, _ in found], [r.summary["run_out"] for _, r in found], label=label, **style)
        right.plot([one for one, _ in found], [r.summary["peak_height"] / r.summary["reference_length"] for _, r in found],
                   **style)
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("a = H0/L0")
        axes.set_xticks([0.5, 1, 2, 5, 10], ["0.5", "1", "2", "5", "10"])
        axes.minorticks_off()
    left.set_yticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"])
    right.set_yticks([0.5, 1, 2, 3], ["0.5", "1", "2", "3"])
    left.set_ylabel("run-out (x - L0)/L0")
    right.set_ylabel("final height / L0")
    legend_above(figure, left, 3)
    return finish(figure, path) if drawn else (plt.close(figure) or False)


def contact_dynamics(path: Path, results: Collection) -> bool:
    found = [(a, results(runs.contact_dynamics(a))) for a in ref.CONTACT_DYNAMICS]
    found = [(a, result) for a, result in found if result]
    if not found:
        return False
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5.2), layout="constrained")
    for (a, result), color in zip(found, ("#0072B2", "#D55E00")):
        data = ref.CONTACT_DYNAMICS[a]
        unit = np.sqrt(data["height"] / runs.GRAVITY)
        series = result.tables["series"]
        fronts = [contact_front(result, t * unit, data["height"], 0.02) for t in data["times"]]
        left.plot(data["times"], fronts, color=color, label=f"default, a = {a:g}")
        left.plot(data["times"], data["front_02"], "o", color=color, ms=8, label=f"discs, a = {a:g}, h > 0.02 H0")
        left.plot(data["times"], data["front_05"], "x", color=color, ms=8, mew=2, label=f"discs, a = {a:g}, h > 0.05 H0")
        right.plot(series["time"] / unit, series["peak_height"] / data["height"], color=color, label=f"default, a = {a:g}")
        right.plot(data["times"], data["peak"], "o", color=color, ms=8, label=f"discs, a = {a:g}")
    left.set_ylabel("front x/H0")
    right.set_ylabel("peak h/H0")
    right.set_ylim(0, 1.1)
    for axes in (left, right):
        axes.set_xlabel("t / √(H0/g)")
        axes.set_ylim(bottom=0)
        axes.legend(fontsize=11.5)
    return finish(figure, path)


def couette(path: Path, results: Collection) -> bool:
    found = [(case, results(runs.couette(case))) for case in runs.COUETTE_CASES]
    found = [(case, result) for case, result in found if result]
    if not found:
        return False
    names = {1: "U = 0.0003 m/s", 2: "U = 0.0013 m/s", 3: "Cawthorn's cell"}
    figure, panels = plt.subplots(1, len(found), figsize=(4.4 * len(found), 5), squeeze=False, layout="constrained")
    for axes, (case, result) in zip(panels[0], found):
        depth, ours, theory = couette_profile(result)
        axes.plot(theory, depth, color="black", lw=1.6, label="μ(I), exact")
        axes.plot(ours, depth, "o", color="#0072B2", ms=6, label="default")
        axes.invert_yaxis()
        axes.set_title(names[case], fontsize=14)
        axes.set_xlabel("u/U")
    panels[0, 0].set_ylabel("depth below the plate / d")
    panels[0, 0].legend(loc="lower right")
    return finish(figure, path)


def run_time(path: Path, results: Collection) -> bool:
    """Error against CPU s to 0.42 s. Left: from the experiment, a property of the model. Right: from each code's own finest
    grid, a property of the numbers."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5.6), layout="constrained")
    drawn = False

    def add(cpu: list[float], peaks: list[float], **style) -> None:
        left.plot(cpu, [100 * abs(p / ref.EXPERIMENT_PEAK - 1) for p in peaks], **style)
        if len(peaks) > 2:
            right.plot(cpu[:-1], [max(100 * abs(p / peaks[-1] - 1), 0.05) for p in peaks[:-1]], **style)

    series = [(key, lambda r, key=key: runs.resolution_run(key, r), all_r, label_of(key), STYLES[key], MARKERS[key])
              for key, all_r in runs.RESOLUTION_STUDY.items()]
    series.append(("codes", runs.code_run, runs.CODE_RESOLUTIONS, "default, instant release", ("#0072B2", ":"), "o"))
    for _, run_of, all_r, label, (color, line), marker in series:
        found = [result for result in (results(run_of(r)) for r in all_r) if result]
        if found:
            drawn = True
            add([result.cpu_to(ref.PEAK_TIME) for result in found],
                [peak(result) for result in found],
                color=color, linestyle=line, marker=marker, ms=8, label=label)
    for code, name, line, marker in (("Matter bf948b6, c = 10 m/s", "MPM (Matter)", "-", "P"),
                                     ("Basilisk c7be0ad, half column", "VOF (Basilisk)", "--", "X"),
                                     ("LAMMPS granular", "DEM (LAMMPS)", "none", "*")):
        rows = [row for row in ref.INDEPENDENT_CODES if row[0] == code]
        add([row[3] * ref.PEAK_TIME for row in rows], [row[4] for row in rows], color="0.4", linestyle=line, marker=marker,
            ms=9, label=name)
    left.set_ylabel("peak at 0.42 s: % off the experiment")
    right.set_ylabel("% off the own finest grid")
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set_xlabel("CPU s to t = 0.42 s")
    left.set_ylim(bottom=0)
    right.set_yscale("log")
    legend_above(figure, left, 3)
    return finish(figure, path) if drawn else (plt.close(figure) or False)


def exact(path: Path, results: Collection) -> bool:
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5.2), layout="constrained")
    colors = plt.get_cmap("tab10").colors
    drawn = False
    for color, (case, (all_r, _)) in zip(colors, runs.EXACT_CASES.items()):
        found = [(r, results(runs.exact(case, r))) for r in all_r]
        found = [(r, result) for r, result in found if result and result.summary.get("error", 0) != 0]
        if not found:
            continue
        drawn = True
        errors = [abs(result.summary["error"]) for _, result in found]
        left.plot([r for r, _ in found], errors, "o-", color=color, ms=7, label=case.replace("_", " "))
        right.plot([max(result.cpu, 1e-3) for _, result in found], errors, "o-", color=color, ms=7)
    if not drawn:
        plt.close(figure)
        return False
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set_yscale("log")
    left.set_xlabel("resolution")
    left.set_ylabel("error, as the table defines it")
    right.set_xlabel("CPU s")
    legend_above(figure, left, 4)
    return finish(figure, path)


FIGURES: dict[str, Callable[[Path, Collection], bool]] = {
    "both_side": both_side, "peak_in_time": peak_in_time, "resolution": resolution, "velocity": velocity, "tall": tall,
    "solid_speed": solid_speed, "one_side": one_side, "colliding": colliding, "interface": interface, "lift": lift,
    "scaling": scaling, "contact_dynamics": contact_dynamics, "couette": couette, "run_time": run_time, "exact": exact,
}


def draw_all(directory: Path, results: Collection) -> set[str]:
    """Names of the figures that were drawn; files of those that were not are removed."""
    drawn = set()
    for name, draw in FIGURES.items():
        path = directory / f"validation_{name}.png"
        if draw(path, results):
            drawn.add(name)
        else:
            path.unlink(missing_ok=True)
    return drawn
