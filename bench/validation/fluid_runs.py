"""The runs of the section on granular fluidity, by the program bench/fluidity."""
from __future__ import annotations

from run import Program, Run

PROGRAM = Program(
    "bench/fluidity",
    ("bench/fluid*.[ch]", "bench/cost.[ch]", "bench/rings.[ch]", "bench/marks.[ch]", "bench/options.[ch]", "examples/c/example.[ch]"),
)

SPEED, SLOW_SPEED = 0.003, 0.0003  # m/s, of the lid; the slow one is that of Jin et al. (2021)
GRAINS = (1, 2, 3, 5)  # depths below the lid at which the program prints the velocity
PER_GRAIN = (2, 4, 8)  # spacings
ANNULAR = ((2, 4), (2, 2.2), (4, 4), (4, 2.2))  # spacings in a grain, horizon in spacings
HORIZONS = (2.2, 3)  # beside the default's
# Spacings in a grain, degrees, spacings in the layers: the highest below .93 and the lowest above 1.05 stopping heights.
LAYERS = (
    (2, 22, (9, 11)), (2, 24, (4, 6)), (2, 26, (3, 4)), (2, 28, (2, 3)),
    (4, 22, (18, 22)), (4, 24, (9, 12)), (4, 26, (6, 8)), (4, 28, (4, 6)),
    (8, 22, (37, 43)), (8, 24, (19, 23)), (8, 26, (13, 15)), (8, 28, (9, 11)),
)  # fmt: skip
COLUMNS = (16, 32, 80)  # spacings in the width; 80: half a grain
LONG_JITTER = 0.2
ENSEMBLE = (0, 0.02, 0.05, 0.08, 0.1, 0.12, 0.15, 0.2)  # jitter
SMALL_AMPLITUDE = 0.001


def couette(
    per_grain: int, horizon: float = 4, amplitude: float = 0.48, preset: str = "default", slow: bool = False
) -> Run:
    arguments = ["couette", "--per-grain", str(per_grain), "--amplitude", f"{amplitude:g}", "--preset", preset]
    if horizon != 4:
        arguments += ["--horizon", f"{horizon:g}"]
    if slow:
        arguments += ["--speed", f"{SLOW_SPEED:g}", "--sound-speed", "10", "--end", "6"]
    name = f"fluid_couette_{per_grain}_h{horizon:g}_a{amplitude:g}_{preset}{'_slow' if slow else ''}"
    cost = 0.23 * per_grain**2.2 * (horizon / 4) ** 2 * (4 if preset == "paper" else 1) * (12 if slow else 1)
    return Run(name, "fluidity", tuple(arguments), cost)


def glued(per_grain: int) -> Run:
    """Below a lid whose grains are glued to it: the fluidity is 0 there."""
    arguments = ("couette", "--per-grain", str(per_grain), "--lid", "zero")
    return Run(f"fluid_couette_{per_grain}_glued", "fluidity", arguments, 0.16 * per_grain**2.3)


def annular(per_grain: int, horizon: float = 4) -> Run:
    more = () if horizon == 4 else ("--horizon", f"{horizon:g}")
    arguments = ("annular", "--per-grain", str(per_grain), *more)
    return Run(f"fluid_annular_{per_grain}_h{horizon:g}", "fluidity", arguments, 0.22 * per_grain**3 * (horizon / 4) ** 0.5)


def shear(per_grain: int) -> Run:
    return Run(f"fluid_shear_{per_grain}", "fluidity", ("shear", "--per-grain", str(per_grain)), 0.1 * per_grain**3)


def incline(per_grain: int, angle: int, rows: int) -> Run:
    return Run(
        f"fluid_incline_{per_grain}_{angle}_{rows}",
        "fluidity",
        ("incline", "--per-grain", str(per_grain), "--angle", str(angle), "--rows", str(rows), "--end", "3"),
        0.05 * per_grain * rows,
    )


def collapse(rows: int, amplitude: float = 0.48, jitter: float = 0, end: float = 2) -> Run:
    options = ("--rows", str(rows), "--amplitude", f"{amplitude:g}", "--jitter", f"{jitter:g}", "--end", f"{end:g}")
    return Run(
        f"fluid_collapse_{rows}_a{amplitude:g}_j{jitter:g}_t{end:g}",
        "fluidity",
        ("collapse", *options),
        2.5 * (rows / 32) ** 3 * end / 2,
    )


def fluid() -> list[Run]:
    return (
        [couette(n) for n in PER_GRAIN]
        + [couette(n, horizon) for n in PER_GRAIN[:2] for horizon in HORIZONS]
        + [couette(2, slow=True)]
        + [couette(n, amplitude=0) for n in PER_GRAIN[:2]]
        + [couette(2, amplitude=0, preset="paper")]
        + [glued(n) for n in PER_GRAIN]
        + [annular(n, horizon) for n, horizon in ANNULAR]
        + [shear(n) for n in PER_GRAIN[:2]]
        + [incline(n, angle, rows) for n, angle, both in LAYERS for rows in both]
        + [collapse(rows, amplitude) for rows in COLUMNS for amplitude in (0, 0.48)]
        + [collapse(COLUMNS[0], amplitude, LONG_JITTER, 30) for amplitude in (0, 0.48)]
        + [collapse(24, amplitude, jitter) for amplitude in (0, SMALL_AMPLITUDE) for jitter in ENSEMBLE]
    )
