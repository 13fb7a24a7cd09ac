"""Cases of granular fluidity, for the table of every case."""
from __future__ import annotations

import math

import fluid_runs as runs
from case import Case, Labelled, present, spent, worst
from fluid_sections import FLOWS, STOPS
from results import Collection

VELOCITY, TORQUE, FRICTION = 0.02, 0.02, 0.002  # of the wall's; of the solution's; of mu(I)
LEAST_ROWS = 4  # of a layer that is resolved


def cases(results: Collection) -> list[Case]:
    free = [(f"dl = d/{n}", runs.couette(n)) for n in runs.PER_GRAIN]
    glued = [(f"dl = d/{n}", runs.glued(n)) for n in runs.PER_GRAIN[1:]]
    return [
        _velocity("Couette cell with gravity: u/U at 1, 2, 3, 5 d, dl = d/2 to d/8", results, free),
        _velocity("Couette cell below a lid of glued grains: u/U, dl = d/4 and d/8", results, glued),
        _shear(results),
        *_annular(results),
        *_inclines(results),
    ]


def _velocity(name: str, results: Collection, tried: Labelled) -> Case:
    found = present(results, tried)
    offs = [
        (f"{z} d, {label}", r.summary[f"u_{z}"] - r.summary[f"u_{z}_exact"]) for label, r in found for z in runs.GRAINS
    ]
    return worst(name, f"± {VELOCITY:g}", VELOCITY, offs, "{off:+.4f} at {label}", spent(found))


def _shear(results: Collection) -> Case:
    found = present(results, ((f"dl = d/{n}", runs.shear(n)) for n in runs.PER_GRAIN[:2]))
    offs = [(label, r.summary["friction"] / r.summary["friction_exact"] - 1) for label, r in found]
    return worst("uniform shear: friction of μ(I)", "± 0.2 %", FRICTION, offs, "{percent}, {label}", spent(found))


def _annular(results: Collection) -> list[Case]:
    found = present(results, ((f"horizon {h:g}", runs.annular(n, h)) for n, h in runs.ANNULAR if n == 4))
    return [
        worst(
            "annular cell with fluidity, dl = d/4: torque", "± 2 %", TORQUE,
            [(label, r.summary["torque"] / r.summary["torque_exact"] - 1) for label, r in found], "{percent}, {label}", spent(found),
        ),
        worst(
            "annular cell with fluidity, dl = d/4: velocity", f"± {VELOCITY:g}", VELOCITY,
            [(label, r.summary["profile"]) for label, r in found], "{off:.3f}, {label}", None,
        ),
    ]  # fmt: skip


def _inclines(results: Collection) -> list[Case]:
    """Layers that do what their height says, of those that are resolved."""
    wrong, found = {False: [], True: []}, {False: [], True: []}
    for n, angle, both in runs.LAYERS:
        for rows, flows in zip(both, (False, True)):
            result = results(runs.incline(n, angle, rows))
            if result is None or rows < LEAST_ROWS:
                continue
            found[flows].append(("", result))
            g = result.summary["fluidity"]
            if not (g > FLOWS if flows else g < STOPS):
                wrong[flows].append(f"{angle}°, dl = d/{n}, {rows} rows")
    names = {
        False: (f"layers of {LEAST_ROWS} rows and more on 22 to 28°, below 0.93 h_stop", "stop"),
        True: (f"layers of {LEAST_ROWS} rows and more on 22 to 28°, above 1.05 h_stop", "flow"),
    }
    made = []
    for flows, (name, asked) in names.items():
        if not found[flows]:
            made.append(Case(name, asked, "", math.nan, None))
            continue
        measured = f"{len(found[flows]) - len(wrong[flows])} of {len(found[flows])}"
        measured += f", but {'; '.join(wrong[flows])}" if wrong[flows] else ""
        made.append(Case(name, asked, measured, math.inf if wrong[flows] else 0.0, spent(found[flows])))
    return made
