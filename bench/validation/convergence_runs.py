"""The runs of the section on convergence: ensembles of collapses that differ by a small jitter, by the program bench/stability."""
from __future__ import annotations

import math
from dataclasses import dataclass

from run import Program, Run

PROGRAM = Program(
    "bench/stability",
    (
        *(f"bench/{name}.[ch]" for name in ("stability", "limit", "follow", "marks", "roughness", "trial", "table", "options")),
        "examples/c/example.[ch]",
    ),
    records=True,
)

JITTER = 0.01  # dl: enough for runs to be independent, too little to matter itself
TYPICAL_RATE = 2.4e6  # particle-steps per CPU s of one core, for the estimates of the remaining time only
COARSE = (16, 24)  # where more may be wrong than from 32 on


@dataclass(frozen=True)
class Case:
    key: str
    label: str
    options: tuple[str, ...]
    seeds: dict[int, int]  # runs by L/dl, of the two-sided column with the same spacing
    sides: int = 2
    aspect: float = 1.25
    horizon: float = 4
    reference: str = ""  # the case whose finest run is right; its own, if not said
    rest: float = 0.42  # s, about


SEEDS = {16: 8, 24: 8, 32: 8, 48: 3, 64: 3}
LENGTH = 0.08  # m, of two-sided columns; half of it of the one-sided
CASES = {
    case.key: case
    for case in (
        Case("beads", "a = 1.25, 21° and 32°", (), {**SEEDS, 128: 1}),
        Case("horizon3", "the same, horizon 3", ("--horizon", "3"), SEEDS, horizon=3, reference="beads"),
        Case("horizon2.5", "the same, horizon 2.5", ("--horizon", "2.5"), SEEDS, horizon=2.5, reference="beads"),
        Case(
            "raised", "a = 1.25, 25.5° and 36.5°", ("--mu-s-degrees", "25.5", "--mu-2-degrees", "36.5"), {**SEEDS, 128: 1},
        ),
        Case("tall", "a = 5", ("--aspect", "5"), {16: 4, 24: 4, 32: 4, 48: 2, 64: 1}, aspect=5, rest=0.75),
        Case("one_side", "one side, a = 1.25", ("--sides", "1", "--length", "0.04"), {**SEEDS, 128: 1}, sides=1),
    )
}  # fmt: skip


def ensemble(case: Case, resolution: int) -> Run:
    """To rest, or to 2 s. resolution: L/dl; of the one-sided column, of half the length, twice its own."""
    spacing, height = LENGTH / resolution, case.aspect * LENGTH / 2
    arguments = (
        "collapse", "--resolution", str(resolution * case.sides // 2), "--end", "2", "--interval", "0.005", "--rested",
        "0.05", "--seeds", str(case.seeds[resolution]), "--jitter", f"{JITTER:g}", *case.options,
    )  # fmt: skip
    particles = LENGTH * case.sides / 2 * height / spacing**2
    steps = (case.rest + 0.05) * 10 * math.sqrt(2 * 9.81 * height) * 1.14 / (0.9 * spacing)
    cost = case.seeds[resolution] * particles * steps / TYPICAL_RATE * max(0.5, (case.horizon / 4) ** 2)
    return Run(f"convergence_{case.key}_{resolution}", "collapse", arguments, cost)


def finest(case: Case) -> Run:
    right = CASES[case.reference or case.key]
    return ensemble(right, max(right.seeds))


def convergence() -> list[Run]:
    return [ensemble(case, resolution) for case in CASES.values() for resolution in case.seeds]
