"""Figures beyond the paper's scenes. Each function draws one file and says whether there was anything to draw."""
from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import references as ref
import runs
from drawing import MARKERS, STYLES, label_of
from measures import contact_front, couette_profile, exact_error, peak
from plotting import finish, legend_above
from results import Collection


def lift(path: Path, results: Collection) -> bool:
    found = [(t, results(runs.lift_run(t))) for t in runs.LIFT_TIMES]
    found = [(t, result) for t, result in found if result]
    if not found:
        return False
    figure, axes = plt.subplots(figsize=(10, 4.8), layout="constrained")
    colors = plt.get_cmap("viridis")(np.linspace(0, 0.9, len(found)))
    for (t, result), color in zip(found, colors):
        series = result.tables["series"]
        axes.plot(
            series["time"],
            series["peak_height"] / ref.WIDTH,
            color=color,
            label="instant" if t == 0 else f"lifted in {t:g} s",
        )
    axes.plot([ref.PEAK_TIME], [ref.EXPERIMENT_PEAK], "o", color="black", ms=8, mfc="none", mew=2, label="experiment")
    axes.set_xlim(0, 1)
    axes.set_xlabel("t (s)")
    axes.set_ylabel("peak y/L")
    axes.legend()
    return finish(figure, path)


def scaling(path: Path, results: Collection) -> bool:
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5.6), layout="constrained")
    a = np.geomspace(0.4, 12, 200)
    laws = (
        (ref.lagree_run_out, "Lagrée et al. 2011, μ(I) continuum", "-"),
        (ref.staron_run_out, "Staron & Hinch 2005, discs", "--"),
        (ref.lajeunesse_run_out, "Lajeunesse et al. 2005, experiment", "-."),
        (ref.lube_run_out, "Lube et al. 2005, experiment", ":"),
    )
    for law, label, line in laws:
        values = np.array([law(one) for one in a])
        values[1:][np.abs(np.diff(np.log(values))) > 0.05] = np.nan  # the laws jump between their branches
        left.plot(a, values, color="0.35", linestyle=line, lw=1.7, label=label)
    right.plot(a, [ref.staron_height(one) for one in a], color="0.35", linestyle="--", lw=1.7)
    right.plot(a, [ref.lube_height(one) for one in a], color="0.35", linestyle=":", lw=1.7)
    drawn = False
    for sides, marker, color, size, label in (
        (2, "o", "#0072B2", 7, "default, two sides"),
        (1, "s", "#D55E00", 13, "default, one side"),
    ):
        style = {
            "marker": marker,
            "linestyle": "none",
            "color": color,
            "ms": size,
            "mew": 2,
            "mfc": color if sides == 2 else "none",
        }
        found = [(one, results(runs.scaling(one, sides))) for one in runs.ASPECTS]
        found = [(one, result) for one, result in found if result]
        drawn = drawn or bool(found)
        left.plot([one for one, _ in found], [r.summary["run_out_98"] for _, r in found], label=label, **style)
        right.plot(
            [one for one, _ in found],
            [r.summary["peak_height"] / r.summary["reference_length"] for _, r in found],
            **style,
        )
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("a = H0/L0")
        axes.set_xticks([0.5, 1, 2, 5, 10], ["0.5", "1", "2", "5", "10"])
        axes.minorticks_off()
    left.set_yticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"])
    right.set_yticks([0.5, 1, 2, 3], ["0.5", "1", "2", "3"])
    left.set_ylabel("run-out of 98 % of the mass / L0")
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
        left.plot(
            data["times"], data["front_05"], "x", color=color, ms=8, mew=2, label=f"discs, a = {a:g}, h > 0.05 H0"
        )
        right.plot(
            series["time"] / unit, series["peak_height"] / data["height"], color=color, label=f"default, a = {a:g}"
        )
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


TIMED = ("default", "raised", "walls", "nonlocal_2")  # schemes in the figure
DRAWN = (  # exact solutions in theirs
    "operators, jittered lattice", "hydrostatic", "shear box", "Bagnold, c0 = 20 u", "Bagnold start-up, c0 = 40 u", "chute",
    "chute, horizon 2.5", "Couette, Cawthorn's cell",
)  # fmt: skip


def run_time(path: Path, results: Collection) -> bool:
    """Error against CPU s to 0.42 s. Left: from the experiment, a property of the model. Right: from each code's own
    finest grid, a property of the numerics."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5.6), layout="constrained")
    drawn = False

    def add(cpu: list[float], peaks: list[float], **style) -> None:
        left.plot(cpu, [100 * abs(p / ref.EXPERIMENT_PEAK - 1) for p in peaks], **style)
        if len(peaks) > 2:
            right.plot(cpu[:-1], [max(100 * abs(p / peaks[-1] - 1), 0.05) for p in peaks[:-1]], **style)

    series = [
        (key, lambda r, key=key: runs.resolution_run(key, r), all_r, label_of(key), STYLES[key], MARKERS[key])
        for key, all_r in runs.RESOLUTION_STUDY.items()
        if key in TIMED
    ]
    series.append(("codes", runs.code_run, runs.CODE_RESOLUTIONS, "default, instant release", ("#0072B2", ":"), "o"))
    for _, run_of, all_r, label, (color, line), marker in series:
        found = [result for result in (results(run_of(r)) for r in all_r) if result]
        if found:
            drawn = True
            add(
                [result.cpu_to(ref.PEAK_TIME) for result in found],
                [peak(result) for result in found],
                color=color,
                linestyle=line,
                marker=marker,
                ms=8,
                label=label,
            )
    for code, name, line, marker in (
        ("Matter bf948b6, c = 10 m/s", "MPM (Matter)", "-", "P"),
        ("Basilisk c7be0ad, half column", "VOF (Basilisk)", "--", "X"),
        ("LAMMPS granular", "DEM (LAMMPS)", "none", "*"),
    ):
        rows = [row for row in ref.INDEPENDENT_CODES if row[0] == code]
        add(
            [row[3] * ref.PEAK_TIME for row in rows],
            [row[4] for row in rows],
            color="0.4",
            linestyle=line,
            marker=marker,
            ms=9,
            label=name,
        )
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
    colors = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "0.35", "#7A3B69")
    drawn = False
    for color, marker, case in zip(colors, "os^Dv<>P", DRAWN):
        found = [(r, results(runs.exact(case, r))) for r in runs.EXACT_CASES[case][2]]
        found = [(r, result) for r, result in found if result and exact_error(result)[0] > 0]
        if not found:
            continue
        drawn = True
        errors = [exact_error(result)[0] for _, result in found]
        left.plot([r for r, _ in found], errors, f"{marker}-", color=color, ms=7, label=case)
        right.plot([max(result.cpu, 1e-3) for _, result in found], errors, f"{marker}-", color=color, ms=7)
    if not drawn:
        plt.close(figure)
        return False
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set_yscale("log")
    left.set_xlabel("resolution")
    left.set_xticks([10, 20, 40, 80], ["10", "20", "40", "80"])
    left.minorticks_off()
    left.set_ylabel("error, as the table defines it")
    right.set_xlabel("CPU s")
    legend_above(figure, left, 4)
    return finish(figure, path)
