"""Sections of docs/validation.md on walls of several plates, walls that turn, and gravity that does."""
from __future__ import annotations

import math

import wall_runs as runs
from markdown import NONE, cpu, fixed, percent, significant, table
from results import Collection, Result


def _rest(result: Result) -> str:
    rest = result.summary["rest"]
    return f"not by {result.summary['time']:g}" if math.isnan(rest) else f"{rest:.2f}"


def _pieces(results: Collection) -> str:
    rows = []
    for wall in runs.PIECE_WALLS:
        for n in runs.PIECES:
            result = results(runs.pieces(n, wall))
            if result:
                low, high = (fixed(result.summary[f"pressure_{end}"], 4) for end in ("least", "most"))
                rows.append([f"{n} {'plate' if n == 1 else 'plates'}, {wall}", low, high, _rest(result), cpu(result.cpu)])
    return table(["floor", "pressure of the lowest row over ρ g h: least", "most", "at rest (s)", "CPU s"], rows) if rows else NONE


def _slope(results: Collection) -> str:
    rows = []
    for wall in runs.PIECE_WALLS:
        plane = results(runs.slope(1, wall))
        for n in runs.SLOPE_PIECES:
            result = results(runs.slope(n, wall))
            if result:
                way = result.summary["way"]
                off = percent(way, plane.summary["way"], 3) if plane and n > 1 else NONE
                rows.append([f"{n} {'plate' if n == 1 else 'plates'}, {wall}", f"{1000 * way:.3f}", off, cpu(result.cpu)])
    return table(["slope", "way (mm)", "off one plate", "CPU s"], rows) if rows else NONE


def _bowl(results: Collection) -> str:
    rows = []
    for n in runs.BOWL_ROWS:
        for segments in runs.BOWL_SEGMENTS:
            result = results(runs.bowl(segments, n))
            if result:
                s = result.summary
                back, energy = f"{100 * s['fallen']:.1f} %", significant(s["fallen_energy"], 2)
                rows.append([f"{segments} segments, dl = {50 / n:g} mm", _rest(result), back, energy, cpu(result.cpu)])
    header = ["bowl", "at rest (s)", "given back, of what they took", "of weight times radius", "CPU s"]
    return table(header, rows) if rows else NONE


def _face(results: Collection) -> str:
    rows = []
    for n, jitter in runs.FACES:
        result = results(runs.face(n, jitter))
        if result:
            resting = "yes" if result.summary["at_rest"] else "no"
            rows.append([f"L/dl = {n}, jitter {jitter:g}", fixed(result.summary["peak"], 4), resting, cpu(result.cpu)])
    return table(["column", "peak at 1 s / H", "at rest", "CPU s"], rows) if rows else NONE


def _drum(results: Collection) -> str:
    rows = []
    for froude in runs.DRUM_FROUDES:
        for segments in runs.DRUM_SEGMENTS:
            result = results(runs.drum(segments, froude))
            if result:
                s = result.summary
                rows.append(
                    [
                        f"{segments} segments, Froude {froude:g}", fixed(s["slope"], 1), f"{s['slope_least']:.1f} to {s['slope_most']:.1f}",
                        f"{s['slope_early']:.1f}, {s['slope_late']:.1f}", f"{s['outside']:.0f}", fixed(s["work"], 4), cpu(result.cpu),
                    ]
                )  # fmt: skip
    header = ["drum", "slope (degrees)", "least to most", "first, second half", "grains outside", "work / (dissipated + stored)", "CPU s"]
    return table(header, rows) if rows else NONE


def _annular(results: Collection) -> str:
    rows = []
    for n in runs.ANNULAR_ROWS:
        result = results(runs.annular(n))
        if result:
            s = result.summary
            rows.append([f"R/dl = {n}"])
            for name, unit, digits in (("torque", 1, 3), ("edge", 1000, 2), ("yield_radius", 1000, 2)):
                right, ours = s[f"{name}_exact"], s[name]
                rows[-1] += [fixed(unit * right, digits), fixed(unit * ours, digits), percent(ours, right)]
            rows[-1] += [fixed(s["profile"]), cpu(result.cpu)]
    header = ["cell"]
    for name in ("torque (N)", "speed is 0.02 of the ring's at (mm)", "yield radius by the torque (mm)"):
        header += [f"{name}, right", "ours", "error"]
    return table([*header, "largest error of u/U", "CPU s"], rows) if rows else NONE


def _tilt(results: Collection) -> str:
    lines = []
    if layer := results(runs.tilt("layer")):
        s = layer.summary
        lines.append(
            f"A layer without ends, 10 spacings thick, tilted from the level on: by 20.5° it has moved by {s['held']:.2g} dl, from "
            f"{s['flow']:.1f}° on something is faster than 1 mm/s, by 22° it has moved by {s['way']:.1f} dl ({cpu(layer.cpu)} CPU s)."
        )
    if box := results(runs.tilt("box")):
        s = box.summary
        lines.append(
            f"A closed box of 60 spacings, 6 of them filled, tilted from 19° on: its middle moves by {s['held']:.1g} dl from 20 to 20.5°; at "
            f"26° the surface is at {s['surface']:.1f}° to gravity ({cpu(box.cpu)} CPU s)."
        )
    return " ".join(lines) or NONE


def section(results: Collection) -> str:
    return f"""Glass beads of 21° and 32°, I0 = 0.3; the program is [bench/walls](../bench/walls.c).

### Floors in pieces

A column of 0.2 x 0.1 m, dl = 5 mm, between smooth walls, on a level floor whose joints are off its lattice: rough, smooth, or with a
Coulomb friction of 0.3. In pieces it is to be the floor that one plate is.

{_pieces(results)}

A block of 40 x 10 spacings, down 30° for 0.15 s.

{_slope(results)}

### Bowls

A half circle of 5 cm radius, filled to its middle on a lattice that does not fit it. What comes to rest should only take energy: "given
back" is the most by which `gp_state.wall_dissipated` is below an earlier value. What moves on is no single grain but the whole, up and
down in its lowest wave (a quarter of a wave from the bottom to the surface). Its walls take pressure times way from what comes nearer,
and give it back to what goes away, as a spring does: their ghosts carry a quarter of the motion normal to them, so that the density
does not tell the rest of the compression there. Little but the bulk viscosity damps that wave, which is in proportion to the spacing:
the kinetic energy falls at 15, 6, 4 /s with dl = 2.5, 1.25, 0.625 mm (24 segments, the first half second). 96 segments with dl = 1.25 mm
are at rest at 0.54 s with `bulk_viscosity` 0.4 in place of 0.1, and at 0.33 s with a `sound_speed` of 20 m/s in place of 9.9, which gives back 2.4 %.

{_bowl(results)}

### A vertical face

A column of a = 1.25 with μ_s = μ_2 = 1.5, released at once: it should stand.

{_face(results)}

### A rotating drum

0.1 m radius, dl = R/16, 30 % full, {runs.DRUM_TURNS} turns; Froude is ω² R / g. Slope of a straight line through the surface in the middle half, from
0.3 of a turn on, 20 times a turn.

{_drum(results)}

### An annular Couette cell

Inner ring of R = 4 cm that turns by 1 rad/s, outer ring of 24 plates that bear 1000 Pa each, no gravity; grains of 1 cm with
μ_s = 0.2, μ_2 = 0.8. Right is μ(I) in one dimension at the pressure where it flows.

{_annular(results)}

### Gravity that turns

By 1° per second, with `gp_set_gravity`. {_tilt(results)}"""
