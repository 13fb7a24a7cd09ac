"""The section of docs/validation.md on walls and inclines."""
from __future__ import annotations

import math
from typing import Sequence

import wall_runs as runs
from markdown import NONE, cpu, fixed, percent, table
from results import Collection, Result

HEADER = ["case", "right", "ours", "error", "CPU s"]

MU_S, MU_2, I0 = math.tan(math.radians(21)), math.tan(math.radians(32)), 0.3
GRAIN_DENSITY, DENSITY, GRAVITY, DIAMETER = 2500.0, 1550.0, 9.81, 0.002
START_HEIGHT = 0.04  # m
START_SHARES = (0.5, 0.9)  # of the final speed
SILO_WIDTH, SILO_HEIGHT, SILO_SPEED = 0.06, 0.36, 0.01  # m, m, m/s


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


def incline_start(results: Collection, angle: float, shares: Sequence[float] = ()) -> str:
    """Speeds of the surface beside the law's, and when it has these shares of the final one."""
    rows = []
    for n in runs.START_ROWS:
        run = runs.incline_start(n, angle)
        for k, time in enumerate(runs.START_TIMES):
            ours, exact = _value(results, run, f"surface_{k}"), _value(results, run, f"exact_{k}")
            rows.append([f"h/dl = {n}, surface at {time:g} s (m/s)", fixed(exact, 4), fixed(ours, 4), percent(ours, exact), ""])
        for share in shares:
            result = results(run)
            exact, ours = reached(result, n, angle, share) if result else (None, None)
            rows.append([f"h/dl = {n}, {100 * share:g} % of the final speed (s)", fixed(exact, 2), fixed(ours, 2), percent(ours, exact), ""])
        rows[-1][-1] = _cpu(results, run)
    return table(HEADER, rows)


def bagnold(angle: float, height: float, depth: float) -> float:
    """m/s, the steady speed of a layer of this height (m) at a depth (m) below its surface."""
    slope = math.radians(angle)
    inertial = I0 * (math.tan(slope) - MU_S) / (MU_2 - math.tan(slope))
    factor = 2 / 3 * inertial / DIAMETER * math.sqrt(DENSITY / GRAIN_DENSITY * GRAVITY * math.cos(slope))
    return factor * (height**1.5 - depth**1.5)


def reached(result: Result, rows: int, angle: float, share: float) -> tuple[float, float]:
    """When the surface has this share of its final speed (s): the law's and ours, whose uppermost row is half a spacing deep.
    What is missing of the final speed falls by the same factor in equal times, between two instants that are known."""
    times = []
    for name, depth in (("exact", 0.0), ("surface", START_HEIGHT / rows / 2)):
        final = bagnold(angle, START_HEIGHT, depth)
        missing = [1 - result.summary[f"{name}_{k}"] / final for k in range(len(runs.START_TIMES))]
        k = sum(part > 1 - share for part in missing[1:-1])
        before, after = missing[k : k + 2]
        known = 0 < after < before and after <= 1 - share <= before
        begin, end = runs.START_TIMES[k : k + 2]
        times.append(begin + (end - begin) * math.log(before / (1 - share)) / math.log(before / after) if known else math.nan)
    return times[0], times[1]


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


def incline_bed(results: Collection) -> str:
    """On a layer of the column's grains against the rigid floor."""
    rows = []
    for n in runs.COLUMN_ROWS:
        rigid, run = (runs.incline_column(runs.BED_ANGLE, n, bed) for bed in (0, runs.BED))
        cells = []
        for name in ("x_90", "x_98"):
            on_floor, on_bed = (_value(results, one, name) for one in (rigid, run))
            cells += [fixed(on_floor), fixed(on_bed), percent(on_bed, on_floor)]
        rows.append([f"{1000 * runs.COLUMN_HEIGHT / n:g}", *cells, _cpu(results, run)])
    header = ["dl (mm)", "R90, rigid (m)", "over the layer", "change", "R98, rigid (m)", "over the layer", "change", "CPU s"]
    return table(header, rows)


def _sheared(mu_wall: float) -> float:
    """Thickness of the layer at a wall where tau > mu_s p, m: tau falls linearly to the middle."""
    return SILO_WIDTH / 2 * (1 - MU_S / mu_wall)


def _plug_speed(mu_wall: float) -> float:
    """Of the core of a deep silo whose walls bear this shear over normal stress, m/s; p = rho g W / (2 mu_wall) across."""
    pressure = DENSITY * GRAVITY * SILO_WIDTH / (2 * mu_wall)
    thickness, steps = _sheared(mu_wall), 400
    speed = 0.0
    for k in range(steps):
        mu = mu_wall * (1 - 2 * (k + 0.5) * thickness / steps / SILO_WIDTH)
        inertial = I0 * (mu - MU_S) / (MU_2 - mu)
        speed += inertial / DIAMETER * math.sqrt(pressure / GRAIN_DENSITY) * thickness / steps
    return speed


def wall_friction() -> float:
    """Shear over normal stress at the silo's walls by the law, deep below its surface."""
    low, high = MU_S, MU_2 - 1e-6
    while high - low > 1e-9:
        middle = (low + high) / 2
        low, high = (middle, high) if _plug_speed(middle) < SILO_SPEED else (low, middle)
    return low


def janssen(mu: float, ratio: float = 1.0) -> float:
    """Share of the weight on the floor; ratio: K, of the pressure on the walls to the vertical stress."""
    depth = 2 * mu * ratio * SILO_HEIGHT / SILO_WIDTH
    return (1 - math.exp(-depth)) / depth


def own_floor(result: Result) -> float:
    """Janssen's share with T/N at the walls, and K in the lowest width of the silo, of the run."""
    return janssen(result.summary["friction"], result.summary["ratio"])


def silo(results: Collection) -> str:
    rows, law = [], wall_friction()
    for n in runs.SILO_ROWS:
        run = runs.silo(n)
        result = results(run)
        friction, floor, ratio = (_value(results, run, name) for name in ("friction", "floor", "ratio"))
        own = own_floor(result) if result else None
        rows.append([f"W/dl = {n}, T/N at the walls", fixed(law), fixed(friction), percent(friction, law), ""])
        rows.append([f"W/dl = {n}, floor over weight", fixed(janssen(MU_S)), fixed(floor), percent(floor, janssen(MU_S)), ""])
        rows.append([f"W/dl = {n}, the same, with K and T/N of ours", fixed(own), fixed(floor), percent(floor, own), ""])
        rows.append([f"W/dl = {n}, K", "1", fixed(ratio, 2), percent(ratio, 1), _cpu(results, run)])
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

21.5°, half a degree above yield, h = 4 cm = 20 d. Right is the law. So near yield one per cent of the stress is
{100 * 0.01 * math.tan(math.radians(21.5)) / (math.tan(math.radians(21.5)) - MU_S):.0f} % of the velocity.

{incline_start(results, 21.5)}

26°, where the final speed is Bagnold's, {bagnold(26, START_HEIGHT, 0):.4f} m/s at the surface. Times are between those at which there is a
speed: what is missing of the final one falls as an exponential there.

{incline_start(results, 26, START_SHARES)}

### Columns on inclines

H = 0.14 m, L = 0.20 m (a = 0.7), d = 0.7 mm, a smooth wall at the upper end, the floor rough. R90 and R98: distance from
the wall within which 90 and 98 % of the mass lie, all of it at rest or at 3 s; "detached" is what lies outside of the connected
deposit. There is no exact value: the coarser is compared with the finest.

{incline_column(results)}

On a layer of the same grains, {1000 * runs.BED:g} mm thick, at {runs.BED_ANGLE}°; the marks are of the column's mass. In experiments such a layer
matters little on slopes as small as this one (Mangeney et al. 2010); right is within 10 % of the rigid floor.

{incline_bed(results)}

### A tall silo

0.06 m wide, 0.36 m high, rough walls; the floor, free to slip, sinks at 1 cm/s; means from 0.5 to 1.5 s. Right for T/N is what
μ(I) has deep in the silo: the shear stress falls linearly from the walls, the core moves as a plug, and the layers beside
the walls that take its {1000 * SILO_SPEED:g} mm/s are {1000 * _sheared(wall_friction()):.1f} mm thick. For the floor "right" is Janssen's share of the
weight with K = 1 and tan 21°: a convention, not a solution. The law does not say what the vertical stress of the plug is, which
is not at yield; a floor that gives way takes it off the plug above, while the pressure on the walls stays. K of ours is the
horizontal stress beside the walls, 2 dl wide, over the vertical stress, both less than a width above the floor: from 0.8 at the top
of the silo it grows to 1 in its middle and 1.3 to 1.5 at the floor. With this K and T/N of the run Janssen's formula has the floor's
load: what the floor lacks of "right" is K.

{silo(results)}"""
