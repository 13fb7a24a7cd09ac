"""The runs of the section on walls and inclines, by the program bench/walls."""
from __future__ import annotations

from run import Program, Run

PROGRAM = Program(
    "bench/walls",
    ("bench/walls*.[ch]", "bench/cost.[ch]", "bench/rings.[ch]", "bench/plane_flow.[ch]", "bench/options.[ch]", "examples/c/example.[ch]"),
)

COULOMB_ROWS = (1, 2, 3, 4, 6, 10, 20)
INERTIAL_ROWS = (1, 2, 4, 8, 16, 32)
START_ROWS = (10, 20)
START_TIMES = (0.5, 1, 2, 5)  # s, as the program has them
START_ANGLES = (21.5, 26)  # degrees; the first is the program's own
COLUMN_ANGLES = (5, 10, 16)  # degrees
COLUMN_ROWS = (28, 56)  # spacings in the height
COLUMN_HEIGHT = 0.14  # m
BED_ANGLE, BED = 10, 0.01  # degrees, m: the column on a layer of its grains
SILO_ROWS = (12, 24, 36)  # spacings in the width
PIECES = (1, 2, 3, 9, 32)  # plates of a level floor
SLOPE_PIECES = (1, 9, 96, 240)  # of a slope of 120 spacings
PIECE_WALLS = ("rough", "smooth", "coulomb")
BOWL_SEGMENTS, BOWL_ROWS, BOWL_END = (8, 24, 96), (20, 40), 2  # -, spacings in the radius, s
FACES = ((16, 0), (16, 0.01), (24, 0.01), (32, 0), (32, 0.03), (64, 0.01))  # spacings in the width, jitter in spacings
DRUM_SEGMENTS, DRUM_FROUDES, DRUM_TURNS = (24, 96), (1e-2, 1e-3, 1e-4), 5
ANNULAR_ROWS = (16, 24, 32)  # spacings in the inner radius
SHEAR_ANGLE, SHEAR_END, SHEAR_ROWS, SHEAR_JITTERS = 26, 40, (10, 20), (0.0, 0.2)  # degrees, s, -, spacings
HOPPERS = ((10, False), (20, False), (10, True), (20, True))  # spacings in the outlet; glass beads, or the published friction
HOPPER_FILLINGS = (5, 10)  # outlets, height of the filling
HOPPER_PARTS = 4  # of the time, as the program has them


def slide_coulomb(rows: int, coulomb: bool) -> Run:
    """Friction at rest at any rate; the floor rough, or with Coulomb friction of the same coefficient."""
    return Run(
        f"slide_{'coulomb' if coulomb else 'rough'}_{rows}",
        "walls",
        ("slide_coulomb", "--rows", str(rows), "--coulomb", str(int(coulomb))),
        0.15 + 0.03 * rows,
    )


def slide_inertial(rows: int) -> Run:
    return Run(f"slide_inertial_{rows}", "walls", ("slide_inertial", "--rows", str(rows)), 0.2 + 0.01 * rows**2)


def incline_start(rows: int, angle: float = START_ANGLES[0]) -> Run:
    own = angle == START_ANGLES[0]
    return Run(
        f"incline_start{'' if own else f'_{angle:g}'}_{rows}",
        "walls",
        ("incline_start", "--rows", str(rows), *(() if own else ("--angle", f"{angle:g}"))),
        3.0 * (rows / 20) ** 3,
    )


def incline_column(angle: float, rows: int, bed: float = 0) -> Run:
    return Run(
        f"incline_column_{angle:g}_{rows}{f'_bed_{bed:g}' if bed else ''}",
        "walls",
        ("incline_column", "--angle", f"{angle:g}", "--rows", str(rows), *(("--bed", f"{bed:g}") if bed else ())),
        0.2 * angle * (rows / 28) ** 3 * (2 if bed else 1),
    )


def silo(rows: int) -> Run:
    return Run(f"silo_{rows}", "walls", ("silo", "--rows", str(rows)), 3.0 * (rows / 12) ** 3)


def hopper(rows: int, filling: float, beads: bool = False) -> Run:
    return Run(
        f"hopper_{'beads_' if beads else ''}{rows}_{filling:g}",
        "walls",
        ("hopper", *(("--beads", "1") if beads else ()), "--rows", str(rows), "--filling", f"{filling:g}"),
        1.5 * filling * (rows / 10) ** 3,
    )


def shear(rows: int, jitter: float) -> Run:
    """A layer of 20 d that flows for long."""
    options = ("--rows", str(rows), "--jitter", f"{jitter:g}", "--angle", str(SHEAR_ANGLE), "--end", str(SHEAR_END))
    return Run(f"shear_{rows}_jitter{jitter:g}", "walls", ("incline_shear", *options), 32 * (rows / 20) ** 2)


def long_shear() -> list[Run]:
    return [shear(rows, jitter) for rows in SHEAR_ROWS for jitter in SHEAR_JITTERS]


def pieces(count: int, wall: str) -> Run:
    return Run(f"pieces_{wall}_{count}", "walls", ("pieces", "--segments", str(count), "--wall", wall), 0.35)


def slope(count: int, wall: str) -> Run:
    return Run(f"pieces_slope_{wall}_{count}", "walls", ("pieces_slope", "--segments", str(count), "--wall", wall), 0.12)


def bowl(segments: int, rows: int) -> Run:
    options = ("--segments", str(segments), "--rows", str(rows), "--end", f"{BOWL_END:g}")
    return Run(f"bowl_{segments}_{rows}", "walls", ("bowl", *options), 1.5 * (rows / 20) ** 3)


def face(rows: int, jitter: float) -> Run:
    options = ("--rows", str(rows), "--jitter", f"{jitter:g}")
    return Run(f"face_{rows}_jitter{jitter:g}", "walls", ("face", *options), 0.1 * (rows / 16) ** 3)


def drum(segments: int, froude: float) -> Run:
    options = ("--segments", str(segments), "--froude", f"{froude:g}", "--turns", f"{DRUM_TURNS:g}")
    return Run(f"drum_{segments}_froude{froude:g}", "walls", ("drum", *options), 1.2 * DRUM_TURNS * (0.01 / froude) ** 0.5)


def annular(rows: int) -> Run:
    return Run(f"annular_{rows}", "walls", ("annular", "--rows", str(rows)), 3.2 * (rows / 16) ** 3)


def tilt(scene: str) -> Run:
    """scene: layer or box."""
    return Run(f"tilt_{scene}", "walls", (f"tilt_{scene}",), 3.0)


def hoppers() -> list[Run]:
    return [hopper(rows, filling, beads) for rows, beads in HOPPERS for filling in HOPPER_FILLINGS]


def walls() -> list[Run]:
    return (
        [slide_coulomb(rows, coulomb) for coulomb in (False, True) for rows in COULOMB_ROWS]
        + [slide_inertial(rows) for rows in INERTIAL_ROWS]
        + [incline_start(rows, angle) for angle in START_ANGLES for rows in START_ROWS]
        + [incline_column(angle, rows) for angle in COLUMN_ANGLES for rows in COLUMN_ROWS]
        + [incline_column(BED_ANGLE, rows, BED) for rows in COLUMN_ROWS]
        + [silo(rows) for rows in SILO_ROWS]
        + long_shear()
        + [pieces(count, wall) for wall in PIECE_WALLS for count in PIECES]
        + [slope(count, wall) for wall in PIECE_WALLS for count in SLOPE_PIECES]
        + [bowl(segments, rows) for rows in BOWL_ROWS for segments in BOWL_SEGMENTS]
        + [face(*one) for one in FACES]
        + [drum(segments, froude) for froude in DRUM_FROUDES for segments in DRUM_SEGMENTS]
        + [annular(rows) for rows in ANNULAR_ROWS]
        + [tilt("layer"), tilt("box")]
    )
