"""The section of docs/validation.md on walls and inclines."""
from __future__ import annotations

import math

import wall_runs as runs
from markdown import NONE, cpu, fixed, percent, table
from results import Collection

HEADER = ["case", "right", "ours", "error", "CPU s"]

MU_S, MU_2, I0 = math.tan(math.radians(21)), math.tan(math.radians(32)), 0.3
GRAIN_DENSITY, DENSITY, GRAVITY, DIAMETER = 2500.0, 1550.0, 9.81, 0.002
SILO_WIDTH, SILO_SPEED = 0.06, 0.01  # m, m/s


def _value(results: Collection, run: runs.Run, name: str) -> float | None:
    result = results(run)
    return result.summary.get(name) if result else None


def _cpu(results: Collection, *asked: runs.Run) -> str:
    found = [result.cpu for run in asked if (result := results(run))]
    return cpu(sum(found)) if found else NONE


def slide_coulomb(results: Collection) -> str:
    rows = []
    for n in runs.COULOMB_ROWS:
        for coulomb in (False, True):
            run = runs.slide_coulomb(n, coulomb)
            traction, way, exact = (_value(results, run, name) for name in ("traction", "way", "exact"))
            rows.append(
                [
                    f"{n} {'row' if n == 1 else 'rows'}, {'Coulomb' if coulomb else 'rough'} floor",
                    "1",
                    fixed(traction, 4),
                    percent(traction, 1, 2),
                    fixed(exact, 4),
                    fixed(way, 4),
                    percent(way, exact, 2),
                    _cpu(results, run),
                ]
            )
    return table(["case", "right T/(μW)", "ours", "error", "right way (m)", "ours", "error", "CPU s"], rows)


def slide_inertial(results: Collection) -> str:
    rows = []
    for n in runs.INERTIAL_ROWS:
        run = runs.slide_inertial(n)
        way, exact = _value(results, run, "way"), _value(results, run, "exact")
        name = f"{n} {'row' if n == 1 else 'rows'}"
        rows.append([name, fixed(exact, 4), fixed(way, 4), percent(way, exact), _cpu(results, run)])
    return table(["case", "right way (m)", "ours", "error", "CPU s"], rows)


def incline_start(results: Collection) -> str:
    rows = []
    for n in runs.START_ROWS:
        run = runs.incline_start(n)
        for k, time in enumerate(runs.START_TIMES):
            ours, exact = _value(results, run, f"surface_{k}"), _value(results, run, f"exact_{k}")
            last = k + 1 == len(runs.START_TIMES)
            rows.append(
                [
                    f"h/dl = {n}, surface at {time:g} s (m/s)",
                    fixed(exact, 4),
                    fixed(ours, 4),
                    percent(ours, exact),
                    _cpu(results, run) if last else "",
                ]
            )
    return table(HEADER, rows)


def incline_column(results: Collection) -> str:
    rows = []
    for angle in runs.COLUMN_ANGLES:
        finest = runs.incline_column(angle, runs.COLUMN_ROWS[-1])
        for n in runs.COLUMN_ROWS:
            run = runs.incline_column(angle, n)
            values = {name: _value(results, run, name) for name in ("x_90", "x_98", "tip", "detached", "time", "at_rest")}
            to_finest = [
                NONE if n == runs.COLUMN_ROWS[-1] else percent(values[name], _value(results, finest, name))
                for name in ("x_90", "x_98")
            ]
            detached = values["detached"]
            rows.append(
                [
                    f"{angle:g}°, dl = {1000 * runs.COLUMN_HEIGHT / n:g} mm",
                    fixed(values["x_90"]),
                    to_finest[0],
                    fixed(values["x_98"]),
                    to_finest[1],
                    fixed(values["tip"]),
                    NONE if detached is None else f"{100 * detached:.2f} %",
                    fixed(values["time"], 2) if values["at_rest"] else (f"not by {values['time']:g}" if values["time"] else NONE),
                    _cpu(results, run),
                ]
            )
    header = ["case", "R90 (m)", "to the finest", "R98 (m)", "to the finest", "tip (m)", "detached", "at rest (s)", "CPU s"]
    return table(header, rows)


def wall_friction(rows: int) -> float:
    """mu(I) at the silo's walls where all of the slip is sheared within one spacing, at the pressure rho g W / (2 mu)."""
    rate = SILO_SPEED / (SILO_WIDTH / rows)
    mu = MU_S
    for _ in range(20):
        pressure = DENSITY * GRAVITY * SILO_WIDTH / (2 * mu)
        inertial = rate * DIAMETER / math.sqrt(pressure / GRAIN_DENSITY)
        mu = MU_S + (MU_2 - MU_S) * inertial / (I0 + inertial)
    return mu


def silo(results: Collection) -> str:
    rows = []
    for n in runs.SILO_ROWS:
        run = runs.silo(n)
        friction, floor, janssen = (_value(results, run, name) for name in ("friction", "floor", "janssen"))
        law = wall_friction(n)
        rows.append([f"W/dl = {n}, T/N at the walls", fixed(law), fixed(friction), percent(friction, law), ""])
        rows.append(
            [f"W/dl = {n}, floor over weight", fixed(janssen), fixed(floor), percent(floor, janssen), _cpu(results, run)]
        )
    return table(HEADER, rows)


def section(results: Collection) -> str:
    return f"""Glass beads of 21° and 32°, I0 = 0.3; the program is [bench/walls](../bench/walls.c). "The law" is μ(I) in one
dimension, solved beside ours by implicit finite volumes ([plane_flow.c](../bench/plane_flow.c)).

### Layers that slide

Thrown along a level floor at 0.5 m/s, dl = 2.5 mm, with a friction of tan 21° at any rate: the traction T is μ times the
weight, however few rows there are, and the layer stops after u²/(2 μ g). The floor rough, or with Coulomb friction of the
same coefficient.

{slide_coulomb(results)}

With μ(I), 5 mm thick, at 0.8 m/s; right is the law.

{slide_inertial(results)}

### From rest on an incline

21.5°, half a degree above yield, h = 4 cm = 20 d. Right is the law.

{incline_start(results)}

### Columns on inclines

H = 0.14 m, L = 0.20 m (a = 0.7), d = 0.7 mm, a smooth wall at the upper end, the floor rough. R90 and R98: distance from
the wall within which 90 and 98 % of the mass lie, all of it at rest or at 3 s; "detached" is what lies outside of the connected
deposit. There is no exact value: the coarser is compared with the finest.

{incline_column(results)}

### A tall silo

0.06 m wide, 0.36 m high, rough walls; the floor, free to slip, sinks at 1 cm/s; means from 0.5 to 1.5 s. Right for T/N is
μ(I) with all of the slip within a spacing of the walls (tan 21° = {MU_S:.3f} at yield), for the floor Janssen's share of the
weight with K = 1 and tan 21°.

{silo(results)}"""
