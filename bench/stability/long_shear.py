"""The section on long shear: its runs, by the program bench/walls, and its table."""
from __future__ import annotations

from markdown import NONE, cpu, fixed, table
from results import Collection
from run import Program, Run

PROGRAM = Program(
    "bench/walls",
    ("bench/walls*.[ch]", "bench/rings.[ch]", "bench/plane_flow.[ch]", "bench/options.[ch]", "examples/c/example.[ch]"),
)

ANGLE, END = 26, 40  # degrees, s
ROWS = (10, 20)
JITTERS = (0.0, 0.2)  # dl


def shear(rows: int, jitter: float) -> Run:
    return Run(
        f"shear_{rows}_jitter{jitter:g}",
        "walls",
        (
            "incline_shear", "--rows", str(rows), "--jitter", f"{jitter:g}", "--angle", str(ANGLE), "--end", str(END),
        ),
        32 * (rows / 20) ** 2,
    )  # fmt: skip


def long_shear() -> list[Run]:
    return [shear(rows, jitter) for rows in ROWS for jitter in JITTERS]


def section(results: Collection) -> str:
    """Mean height over that of the start and velocity of the surface over Bagnold's, at four times."""
    rows = []
    for n in ROWS:
        for jitter in JITTERS:
            result = results(shear(n, jitter))
            summary = result.summary if result else {}
            speeds = [summary[f"surface_{k}"] for k in (1, 2, 3, 4)] if result else []
            rows.append(
                [f"{n}", f"{jitter:g}"]
                + [fixed(summary.get(f"{name}_{k}")) for name in ("height", "surface") for k in (1, 2, 3, 4)]
                + [fixed(sum(speeds) / 4) if speeds else NONE]
                + [cpu(result.cpu) if result else NONE]
            )
    times = [f"{END * k / 4:g} s" for k in (1, 2, 3, 4)]
    return table(
        ["h/dl", "jitter (dl)", *(f"height, {t}" for t in times), *(f"surface, {t}" for t in times), "mean", "CPU s"], rows
    )
