"""Cases of walls and inclines, for the table of every case."""
from __future__ import annotations

import math

import wall_runs as runs
import wall_sections as sections
from case import Case, present, spent, worst
from results import Collection, Result

REST, BOWL_REST = 0.5, 1.0  # s, by when
SLOPE_LOW, SLOPE_HIGH = 21, 32  # degrees, of a drum's surface


def cases(results: Collection) -> list[Case]:
    return [
        *_slides(results),
        *_long_shear(results),
        *_silo(results),
        *_pieces(results),
        *_bowl(results),
        *_columns(results),
        *_start(results),
        _face(results),
        *_drum(results),
        *_annular(results),
        *_tilt(results),
    ]


def _late(result: Result, limit: float) -> float:
    """When it came to rest over by when it should."""
    rest = result.summary["rest"]
    return math.inf if math.isnan(rest) else rest / limit


def _slides(results: Collection) -> list[Case]:
    both = [
        (f"{n} rows, {'Coulomb' if coulomb else 'rough'}", runs.slide_coulomb(n, coulomb))
        for n in runs.COULOMB_ROWS
        for coulomb in (False, True)
    ]
    found = present(results, both)
    inertial = present(results, ((f"{n} rows", runs.slide_inertial(n)) for n in runs.INERTIAL_ROWS if n >= 4))
    return [
        worst(
            "sliding layer, 1 to 20 rows: traction over friction times weight", "1 ± 0.01", 0.01,
            [(label, r.summary["traction"] - 1) for label, r in found], "{off:+.4f}, {label}", spent(found),
        ),
        worst(
            "sliding layer: way to the stop, u²/(2 μ g)", "± 2 %", 0.02,
            [(label, r.summary["way"] / r.summary["exact"] - 1) for label, r in found], "{percent}, {label}", None,
        ),
        worst(
            "sliding layer with μ(I), 5 mm, 4 to 32 rows: way to the stop", "± 3 %", 0.03,
            [(label, r.summary["way"] / r.summary["exact"] - 1) for label, r in inertial], "{percent}, {label}", spent(inertial),
        ),
    ]  # fmt: skip


def _long_shear(results: Collection) -> list[Case]:
    found = present(
        results, ((f"h/dl = {n}, jitter {j:g}", runs.shear(n, j)) for n in runs.SHEAR_ROWS for j in runs.SHEAR_JITTERS)
    )
    times = (1, 2, 3, 4)
    return [
        worst(
            "layer on 26°, 40 s: mean height", "± 1 %", 0.01,
            [(label, r.summary[f"height_{k}"] - 1) for label, r in found for k in times], "{percent}, {label}", spent(found),
        ),
        worst(
            "layer on 26°, 40 s: surface speed of Bagnold's", "± 2 %", 0.02,
            [(label, sum(r.summary[f"surface_{k}"] for k in times) / 4 - 1) for label, r in found], "{percent}, {label}", None,
        ),
    ]  # fmt: skip


def _silo(results: Collection) -> list[Case]:
    found = present(results, ((f"W/dl = {n}", runs.silo(n)) for n in runs.SILO_ROWS))
    law, floor = sections.wall_friction(), sections.janssen(sections.MU_S)
    return [
        worst(
            "tall silo: friction of its walls", "≤ μ(I) + 2 %", 0.02,
            [(label, max(0.0, r.summary["friction"] / law - 1)) for label, r in found], "{percent}, {label}", spent(found),
        ),
        worst(
            f"tall silo: load of the floor, {floor:.3f} of the weight (Janssen, K = 1)", "± 10 %", 0.10,
            [(label, r.summary["floor"] / floor - 1) for label, r in found], "{percent}, {label}", None,
        ),
        worst(
            "tall silo: load of the floor, to Janssen's with K above the floor and T/N of the run", "± 10 %", 0.10,
            [(label, r.summary["floor"] / sections.own_floor(r) - 1) for label, r in found], "{percent}, {label}", None,
        ),
    ]  # fmt: skip


def _pieces(results: Collection) -> list[Case]:
    found, offs, rests = [], [], []
    ways, slopes = [], []
    for wall in runs.PIECE_WALLS:
        one = results(runs.pieces(1, wall))
        level = present(results, ((f"{n} {'plate' if n == 1 else 'plates'}, {wall}", runs.pieces(n, wall)) for n in runs.PIECES))
        found += level
        rests += [(label, r.summary["rest"], _late(r, REST)) for label, r in level]
        if one:
            offs += [
                (label, r.summary[key] / one.summary[key] - 1)
                for label, r in level
                if r.name != one.name
                for key in ("pressure_least", "pressure_most")
            ]
        plane = results(runs.slope(1, wall))
        down = present(results, ((f"{n} {'plate' if n == 1 else 'plates'}, {wall}", runs.slope(n, wall)) for n in runs.SLOPE_PIECES))
        slopes += down
        if plane:
            ways += [(label, r.summary["way"] / plane.summary["way"] - 1) for label, r in down if r.name != plane.name]
    label, when, late = max(rests, key=lambda one: one[2], default=("", math.nan, math.nan))
    return [
        worst("level floor in 2 to 32 pieces: pressure as on one plate", "± 2 %", 0.02, offs, "{percent}, {label}", spent(found)),
        Case("level floor in pieces: at rest", f"by {REST:g} s", f"{when:.2f} s, {label}" if label else "", late, None),
        worst("30° in 9 to 240 pieces: way as on one plate", "± 0.5 %", 0.005, ways, "{percent}, {label}", spent(slopes)),
    ]


def _bowl(results: Collection) -> list[Case]:
    found = present(
        results,
        (
            (f"{s} segments, dl = {50 / n:g} mm", runs.bowl(s, n))
            for n in runs.BOWL_ROWS
            for s in runs.BOWL_SEGMENTS
        ),
    )
    names = ("bowl of 8, 24, 96 segments: at rest", "bowl: energy that its walls give back, of what they took")
    asked = (f"by {BOWL_REST:g} s", "none, to 1 %")
    if not found:
        return [Case(name, want, "", math.nan, None) for name, want in zip(names, asked)]
    label, result = max(found, key=lambda one: _late(one[1], BOWL_REST))
    rest = result.summary["rest"]
    return [
        Case(
            names[0], asked[0], f"{f'not by {runs.BOWL_END:g}' if math.isnan(rest) else f'{rest:.2f}'} s, {label}",
            _late(result, BOWL_REST), spent(found),
        ),
        worst(names[1], asked[1], 0.01, [(one, r.summary["fallen"]) for one, r in found], "{percent}, {label}", None),
    ]  # fmt: skip


def _columns(results: Collection) -> list[Case]:
    coarse, fine = runs.COLUMN_ROWS
    found, offs, clumps = [], [], []
    for angle in runs.COLUMN_ANGLES:
        pair = present(results, ((f"{angle}°, dl = {1000 * runs.COLUMN_HEIGHT / n:g} mm", runs.incline_column(angle, n)) for n in (coarse, fine)))
        found += pair
        clumps += [(label, r.summary["clump"]) for label, r in pair]
        if len(pair) == 2:
            offs.append((f"{angle}°", pair[0][1].summary["x_98"] / pair[1][1].summary["x_98"] - 1))
    beds, changes = [], []
    for n in runs.COLUMN_ROWS:
        rigid, bed = (results(runs.incline_column(runs.BED_ANGLE, n, b)) for b in (0, runs.BED))
        if rigid and bed:
            beds.append(("", bed))
            spacing = f"dl = {1000 * runs.COLUMN_HEIGHT / n:g} mm"
            changes += [(f"{key.replace('x_', 'R')}, {spacing}", bed.summary[key] / rigid.summary[key] - 1) for key in ("x_90", "x_98")]
    return [
        worst("column on 5, 10, 16°: R98, 5 against 2.5 mm", "± 5 %", 0.05, offs, "{percent}, {label}", spent(found)),
        worst("column on inclines: clump that bears no pressure", "≤ 1 row", 1, clumps, "{off:.0f} rows, {label}", None),
        worst("column on 10°, over an erodible layer: against the rigid floor", "± 10 %", 0.10, changes, "{percent}, {label}", spent(beds)),
    ]


def _start(results: Collection) -> list[Case]:
    rows, cases = runs.START_ROWS[-1], []
    for angle in runs.START_ANGLES:
        found = present(results, [("", runs.incline_start(rows, angle))])
        name = f"{angle:g}° from rest, h/dl = {rows}"
        speeds = [
            (f"{time:g} s", r.summary[f"surface_{k}"] / r.summary[f"exact_{k}"] - 1)
            for _, r in found
            for k, time in enumerate(runs.START_TIMES)
        ]
        cases.append(worst(f"{name}: surface speed at 0.5 to 5 s", "± 5 %", 0.05, speeds, "{percent}, {label}", spent(found)))
        if angle != runs.START_ANGLES[0]:
            reached = [(share, sections.reached(r, rows, angle, share)) for _, r in found for share in sections.START_SHARES]
            times = [(f"to {100 * share:g} %", ours / exact - 1) for share, (exact, ours) in reached]
            cases.append(worst(f"{name}: times to 50 and 90 % of the final speed", "± 5 %", 0.05, times, "{percent}, {label}", None))
    return cases


def _face(results: Collection) -> Case:
    found = present(results, ((f"L/dl = {n}, jitter {j:g}", runs.face(n, j)) for n, j in runs.FACES))
    name, asked = "vertical face, μ = 1.5: peak at 1 s", "≥ 0.97 H"
    offs = [(label, max(0.0, 1 - r.summary["peak"])) for label, r in found]
    if not offs:
        return Case(name, asked, "", math.nan, None)
    label, sunk = max(offs, key=lambda one: one[1])
    return Case(name, asked, f"{1 - sunk:.3f} H, {label}", sunk / 0.03, spent(found))


def _drum(results: Collection) -> list[Case]:
    found = present(
        results,
        ((f"{s} segments, Froude {f:g}", runs.drum(s, f)) for f in runs.DRUM_FROUDES for s in runs.DRUM_SEGMENTS),
    )
    names = ("drum, 24 and 96 segments, Froude 1e-4 to 1e-2, 5 turns: grains that leave", "drum: slope of the surface, at any instant")
    asked = ("none", f"{SLOPE_LOW} to {SLOPE_HIGH}°")
    if not found:
        return [Case(name, want, "", math.nan, None) for name, want in zip(names, asked)]
    lost, label = max((r.summary["outside"], label) for label, r in found)
    middle, reach = (SLOPE_LOW + SLOPE_HIGH) / 2, (SLOPE_HIGH - SLOPE_LOW) / 2
    least, most = min(r.summary["slope_least"] for _, r in found), max(r.summary["slope_most"] for _, r in found)
    return [
        Case(names[0], asked[0], f"{lost:.0f}{f', {label}' if lost else ''}", math.inf if lost else 0.0, spent(found)),
        Case(names[1], asked[1], f"{least:.1f} to {most:.1f}°", max(middle - least, most - middle) / reach, None),
        worst(
            "drum: slope, second half of the time against the first", "± 1°", 1,
            [(one, r.summary["slope_late"] - r.summary["slope_early"]) for one, r in found], "{off:+.2f}°, {label}", None,
        ),
        worst(
            "drum: torque times angle against dissipation", "± 3 %", 0.03,
            [(one, r.summary["work"] - 1) for one, r in found], "{percent}, {label}", None,
        ),
    ]  # fmt: skip


def _annular(results: Collection) -> list[Case]:
    found = present(results, ((f"R/dl = {n}", runs.annular(n)) for n in runs.ANNULAR_ROWS))
    return [
        worst(
            "annular Couette cell: torque of the inner ring", "± 2 %", 0.02,
            [(label, r.summary["torque"] / r.summary["torque_exact"] - 1) for label, r in found], "{percent}, {label}", spent(found),
        ),
        worst(
            "annular Couette cell: where the speed is 0.02 of the ring's", "± 2 %", 0.02,
            [(label, r.summary["edge"] / r.summary["edge_exact"] - 1) for label, r in found], "{percent}, {label}", None,
        ),
    ]  # fmt: skip


def _tilt(results: Collection) -> list[Case]:
    layer, box = (present(results, [(scene, runs.tilt(scene))]) for scene in ("layer", "box"))
    found = []
    name, asked = "layer tilted by 1° per second: from where it flows", "20.5 to 22°"
    if layer:
        s = layer[0][1].summary
        share = math.inf if math.isnan(s["flow"]) else abs(s["flow"] - 21.25) / 0.75
        found.append(Case(name, asked, f"{s['flow']:.1f}°; {s['held']:.2g} dl by 20.5°, {s['way']:.1f} dl by 22°", share, spent(layer)))
    else:
        found.append(Case(name, asked, "", math.nan, None))
    name, asked = "closed box tilted by 1° per second: its surface to gravity at 26°", "22 ± 1°; holds to 20.5°"
    if box:
        s = box[0][1].summary
        share = max(abs(s["surface"] - 22), s["held"] / 0.1)
        found.append(Case(name, asked, f"{s['surface']:.1f}°; {s['held']:.1g} dl from 20 to 20.5°", share, spent(box)))
    else:
        found.append(Case(name, asked, "", math.nan, None))
    return found
