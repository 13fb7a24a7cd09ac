"""The section of docs/validation.md on granular fluidity, and its figure."""
from __future__ import annotations

import statistics
from pathlib import Path
from typing import Callable

import fluid_runs as runs
import matplotlib.pyplot as plt
from markdown import NONE, cpu, fixed, percent, significant, table
from measures import couette_profile
from plotting import finish
from results import Collection

CELLS = [  # name, run
    *((f"fluidity, dl = d/{n}", runs.couette(n)) for n in runs.PER_GRAIN),
    *((f"fluidity, dl = d/{n}, horizon {h:g}", runs.couette(n, h)) for n in runs.PER_GRAIN[:2] for h in runs.HORIZONS),
    (f"fluidity, dl = d/2, lid at {1000 * runs.SLOW_SPEED:g} mm/s", runs.couette(2, slow=True)),
    *((f"local law, dl = d/{n}", runs.couette(n, amplitude=0)) for n in runs.PER_GRAIN[:2]),
    ("paper as printed, dl = d/2", runs.couette(2, amplitude=0, preset="paper")),
]
STOPS, FLOWS = 0.02, 0.02  # 1/s: below it is dying away at 3 s, above it flows


def _value(results: Collection, run: runs.Run, name: str) -> float | None:
    result = results(run)
    return result.summary.get(name) if result else None


def figure(path: Path, results: Collection) -> bool:
    drawn = [
        ("fluidity, dl = d/2", runs.couette(2), "o", "#0072B2"),
        ("fluidity, dl = d/4", runs.couette(4), "s", "#D55E00"),
        ("local law, dl = d/2", runs.couette(2, amplitude=0), "^", "0.55"),
        ("paper as printed, dl = d/2", runs.couette(2, amplitude=0, preset="paper"), "x", "#009E73"),
    ]
    if not results(drawn[0][1]):
        return False
    drawing, panels = plt.subplots(1, 2, figsize=(12, 5), layout="constrained")
    depth, _, exact = couette_profile(results(drawn[0][1]))
    for axes in panels:
        axes.plot(exact, depth, color="black", lw=1.6, label="fluidity, one dimension")
        for label, run, marker, color in drawn:
            if results(run):
                z, ours, _ = couette_profile(results(run))
                axes.plot(ours, z, marker, color=color, ms=6, mfc="none", mew=1.6, label=label)
        axes.set_ylim(10, 0)
        axes.set_xlabel("u/U")
    panels[0].set_ylabel("depth below the plate / d")
    panels[0].legend(loc="lower right")
    panels[1].set_xscale("log")
    panels[1].set_xlim(1e-3, 1.2)
    return finish(drawing, path)


def cells(results: Collection) -> str:
    rows = []
    reference = runs.couette(2)
    exact = [_value(results, reference, f"u_{z}_exact") for z in runs.GRAINS]
    rows.append(["fluidity, one dimension", *(fixed(u) for u in exact), fixed(_value(results, reference, "stress_exact"), 2), NONE, ""])
    for name, run in CELLS:
        values = [_value(results, run, f"u_{z}") for z in runs.GRAINS]
        stress, right = _value(results, run, "stress"), _value(results, run, "stress_exact")
        low, high = _value(results, run, "stress_least"), _value(results, run, "stress_most")
        spread = "" if low is None or high is None or high - low < 0.05 * high else f" ({low:.0f} to {high:.0f})"
        rows.append(
            [name, *(fixed(u) for u in values), fixed(stress, 2) + spread, percent(stress, right), cpu(_value(results, run, "cpu_seconds"))]
        )
    rows.append(["experiment", "figure only", "", "", "", NONE, NONE, ""])
    return table(["cell", *(f"u/U at {z} d" for z in runs.GRAINS), "stress (Pa)", "error", "CPU s"], rows)


def glued(results: Collection) -> str:
    rows = []
    for n in runs.PER_GRAIN:
        result = results(runs.glued(n))
        if result:
            s = result.summary
            off = max(abs(s[f"u_{z}"] - s[f"u_{z}_exact"]) for z in runs.GRAINS)
            cells = [f"{s[f'u_{z}']:.3f} ({s[f'u_{z}_exact']:.3f})" for z in runs.GRAINS]
            rows.append([f"dl = d/{n}", *cells, fixed(off), fixed(s["stress"], 2), percent(s["stress"], s["stress_exact"]), cpu(result.cpu)])
    return table(["cell", *(f"u/U at {z} d (right)" for z in runs.GRAINS), "largest error", "stress (Pa)", "error", "CPU s"], rows)


def annular(results: Collection) -> str:
    rows = []
    for n, h in runs.ANNULAR:
        result = results(runs.annular(n, h))
        if result:
            s = result.summary
            torque = [fixed(s["torque_exact"], 2), fixed(s["torque"], 2), percent(s["torque"], s["torque_exact"])]
            rows.append([f"dl = d/{n}, horizon {h:g}", *torque, fixed(s["profile"]), cpu(result.cpu)])
    return table(["cell", "torque (N), right", "ours", "error", "largest error of u/U", "CPU s"], rows)


def shear(results: Collection) -> str:
    rows = []
    for n in runs.PER_GRAIN[:2]:
        ours, exact, bent, spent = (
            _value(results, runs.shear(n), name) for name in ("friction", "friction_exact", "from_linear", "cpu_seconds")
        )
        rows.append([f"dl = d/{n}", fixed(exact, 4), fixed(ours, 4), percent(ours, exact, 2), fixed(bent, 4), cpu(spent)])
    return table(["case", "right friction", "ours", "error", "largest u/U off a line", "CPU s"], rows)


def layers(results: Collection) -> str:
    rows = []
    for n, angle, both in runs.LAYERS:
        cells, spent = [], 0.0
        for count, flows in zip(both, (False, True)):
            run = runs.incline(n, angle, count)
            height, fluidity = _value(results, run, "height"), _value(results, run, "fluidity")
            spent += _value(results, run, "cpu_seconds") or 0
            if height is None or fluidity is None:
                cells += [NONE, NONE]
                continue
            right = fluidity > FLOWS if flows else fluidity < STOPS
            cells += [f"{count} rows, {height:.2f}", significant(fluidity, 2) + ("" if right else ", **wrong**")]
        stop = _value(results, runs.incline(n, angle, both[0]), "stopping_height")
        rows.append([f"{angle}°, dl = d/{n}", fixed(stop, 2), *cells, cpu(spent)])
    header = ["case", "h_stop / d", "below: h / h_stop", "g at 3 s (1/s)", "above: h / h_stop", "g at 3 s (1/s)", "CPU s"]
    return table(header, rows)


def columns(results: Collection) -> str:
    rows = []
    cases = [(n, amplitude, 0.0, 2) for n in runs.COLUMNS for amplitude in (0, 0.48)]
    cases += [(runs.COLUMNS[0], amplitude, runs.LONG_JITTER, 30) for amplitude in (0, 0.48)]
    for n, amplitude, jitter, end in cases:
        run = runs.collapse(n, amplitude, jitter, end)
        drift = [_value(results, run, f"{name}_drift") for name in ("peak", "run_out_90")]
        rows.append(
            [
                f"L/dl = {n}{f', jitter {jitter:g}' if jitter else ''}, A = {amplitude:g}",
                fixed(_value(results, run, "peak")),
                fixed(_value(results, run, "run_out_90")),
                fixed(_value(results, run, "rest"), 2),
                significant(_value(results, run, "kinetic"), 2),
                *(NONE if end == 2 or one is None else f"{100 * one:.2f} %" for one in drift),
                cpu(_value(results, run, "cpu_seconds")),
            ]
        )
    header = ["column", "peak/L", "run-out, 90 %", "at rest (s)", "KE/E0 at 2 s", "peak, 2 to 30 s", "run-out, 2 to 30 s", "CPU s"]
    return table(header, rows)


def small_amplitude(results: Collection) -> str:
    rows = []
    for amplitude in (0, runs.SMALL_AMPLITUDE):
        cells = []
        for name in ("peak", "run_out_90"):
            found = [_value(results, runs.collapse(24, amplitude, jitter), name) for jitter in runs.ENSEMBLE]
            values = [one for one in found if one is not None]
            enough = len(values) > 1
            cells += [fixed(statistics.mean(values), 4), fixed(statistics.stdev(values), 4)] if enough else [NONE, NONE]
        rows.append([f"A = {amplitude:g}", *cells])
    return table(["amplitude", "peak/L", "scatter", "run-out, 90 %", "scatter"], rows)


def _largest(results: Collection, n: int) -> float | None:
    """Largest error of u/U at the depths of the table."""
    errors = [
        abs(ours - right)
        for z in runs.GRAINS
        if (ours := _value(results, runs.couette(n), f"u_{z}")) is not None
        and (right := _value(results, runs.couette(n), f"u_{z}_exact")) is not None
    ]
    return max(errors) if errors else None


def in_short(results: Collection) -> str:
    parts = [
        f"{significant(_largest(results, n), 2)} at dl = d/{n}" for n in runs.PER_GRAIN if _largest(results, n) is not None
    ]
    stresses = [
        f"{percent(_value(results, runs.couette(n), 'stress'), _value(results, runs.couette(n), 'stress_exact'))} at d/{n}"
        for n in runs.PER_GRAIN
        if _value(results, runs.couette(n), "stress") is not None
    ]
    if not parts:
        return "No runs."
    return (
        f"With the default horizon and penalty the velocity below a slow plate is that of the law in one dimension: u/U errs by "
        f"at most {', '.join(parts)}, the plate's stress by {', '.join(stresses)}. The local law has no band there at all."
    )


def section(results: Collection, figure_of: Callable[[str, str], str]) -> str:
    caption = "Velocity below a slow plate with gravity; right: the same with a logarithmic axis"
    return f"""{in_short(results)}

{figure_of("fluidity", caption)}

Glass beads, A = 0.48, tan 21° and tan 32°, I0 = 0.3, t0 = 1e-4 s; the program is [bench/fluidity](../bench/fluidity.c). "One
dimension" is the fluidity in steady layers, solved by finite volumes ([fluid_layer.c](../bench/fluid_layer.c)).

### Couette cell with gravity

The cell of Jin et al. (2021): d = 1 mm, 10 d high, 102.3 Pa on the plate, which goes at {1000 * runs.SPEED:g} mm/s and passes no flux
of fluidity; means from 0.5 to 1 s. The profile is the same at their {1000 * runs.SLOW_SPEED:g} mm/s (flow that slow has no rate to
depend on). What is left of the stress' error is the horizon, two grains at dl = d/2, and goes with it. The stress of a cell
that is not steady has its least and largest value in brackets. The experiment is that of Siavoshi, Orpe & Kudrolli (2006),
who print a figure, no numbers: there is nothing here to be set beside ours but the shape.

{cells(results)}

### Below a lid of glued grains

The same with a lid that has `GP_FLUIDITY_ZERO`: grains that are glued to it hold their neighbours, and the profile has its steepest part
some grains below.

{glued(results)}

### Annular Couette cell

Inner ring of 10 grains' radius (d = 5 mm) that turns by 0.4 rad/s, outer one of 15, closed in by a twentieth of a spacing and held; no
gravity. Right is the fluidity in one dimension at the pressure beside the inner ring. The torque errs with the horizon, two grains at
dl = d/2.

{annular(results)}

### Couette cell without gravity

The shear is uniform, and the fluidity that of μ(I): d = 2 mm, 10 d high, 500 Pa, 50 1/s.

{shear(results)}

### Layers on inclines

From rest, the fluidity 0 at the base; d = 1 mm. Thinner than h_stop = (π/2) A d √((μ2 - tan θ) / ((μ2 - μs)(tan θ - μs)))
they come to rest, thicker ones flow. Heights are whole rows: the highest below 0.93 h_stop, the lowest above 1.05 h_stop.
Below h_stop the fluidity dies away, the more slowly the nearer; "wrong" is what does not. Layers of two and three rows
are no test of the law: they are not resolved. Measured stopping heights (Pouliquen 1999, GDR MiDi 2004) were not found as
numbers, but two fits to such of glass beads: they stand beside the law in [the guide](guide/fluidity.md#walls), and are higher near the
angle of repose. Kamrin & Henann (2015) derive such a height from the same law.

{layers(results)}

### Collapse, a = 1.25

L = 0.08 m, d = 2 mm, instant release. The length A d is resolved at L/dl = 80 (half a grain) only.

{columns(results)}

The smaller the amplitude, the nearer to the local law: means of {len(runs.ENSEMBLE)} columns of L/dl = 24 with jitter from
{min(runs.ENSEMBLE):g} to {max(runs.ENSEMBLE):g} dl, and the scatter of a single one.

{small_amplitude(results)}"""
