"""The runs of the section on walls and inclines, by the program bench/walls."""
from __future__ import annotations

from run import Program, Run

PROGRAM = Program(
    "bench/walls",
    ("bench/walls*.[ch]", "bench/plane_flow.[ch]", "bench/options.[ch]", "examples/c/example.[ch]"),
)

COULOMB_ROWS = (1, 2, 3, 4, 6, 10, 20)
INERTIAL_ROWS = (1, 2, 4, 8, 16, 32)
START_ROWS = (10, 20)
START_TIMES = (0.5, 1, 2, 5)  # s, as the program has them
COLUMN_ANGLES = (5, 10, 16)  # degrees
COLUMN_ROWS = (28, 56)  # spacings in the height
COLUMN_HEIGHT = 0.14  # m
BED_ANGLE, BED = 10, 0.01  # degrees, m: the column on a layer of its grains
SILO_ROWS = (12, 24)  # spacings in the width
HOPPERS = ((10, False), (20, False), (10, True), (20, True))  # spacings in the outlet; glass beads, or the published friction
HOPPER_FILLINGS = (5, 10)  # outlets, height of the filling
HOPPER_PARTS = 4  # of the time, as the program has them


def slide_coulomb(rows: int, coulomb: bool) -> Run:
    """Friction at rest at any rate; the floor rough, or with Coulomb friction of the same coefficient."""
    return Run(
        f"slide_{'coulomb' if coulomb else 'rough'}_{rows}",
        "walls",
        ("slide_coulomb", "--rows", str(rows), "--coulomb", str(int(coulomb))),
        0.25 + 0.05 * rows,
    )


def slide_inertial(rows: int) -> Run:
    return Run(f"slide_inertial_{rows}", "walls", ("slide_inertial", "--rows", str(rows)), 0.3 + 0.015 * rows**2)


def incline_start(rows: int) -> Run:
    return Run(f"incline_start_{rows}", "walls", ("incline_start", "--rows", str(rows)), 4.0 * (rows / 20) ** 3 + 1)


def incline_column(angle: float, rows: int, bed: float = 0) -> Run:
    return Run(
        f"incline_column_{angle:g}_{rows}{f'_bed_{bed:g}' if bed else ''}",
        "walls",
        ("incline_column", "--angle", f"{angle:g}", "--rows", str(rows), *(("--bed", f"{bed:g}") if bed else ())),
        0.3 * angle * (rows / 28) ** 3 * (2 if bed else 1),
    )


def silo(rows: int) -> Run:
    return Run(f"silo_{rows}", "walls", ("silo", "--rows", str(rows)), 4.0 * (rows / 12) ** 3)


def hopper(rows: int, filling: float, beads: bool = False) -> Run:
    return Run(
        f"hopper_{'beads_' if beads else ''}{rows}_{filling:g}",
        "walls",
        ("hopper", *(("--beads", "1") if beads else ()), "--rows", str(rows), "--filling", f"{filling:g}"),
        1.7 * filling * (rows / 10) ** 3,
    )


def hoppers() -> list[Run]:
    return [hopper(rows, filling, beads) for rows, beads in HOPPERS for filling in HOPPER_FILLINGS]


def walls() -> list[Run]:
    return (
        [slide_coulomb(rows, coulomb) for coulomb in (False, True) for rows in COULOMB_ROWS]
        + [slide_inertial(rows) for rows in INERTIAL_ROWS]
        + [incline_start(rows) for rows in START_ROWS]
        + [incline_column(angle, rows) for angle in COLUMN_ANGLES for rows in COLUMN_ROWS]
        + [incline_column(BED_ANGLE, rows, BED) for rows in COLUMN_ROWS]
        + [silo(rows) for rows in SILO_ROWS]
    )
