"""The section of docs/validation.md on the flow rate of a hopper, and its figure."""
from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt

import references as ref
import wall_runs as runs
from markdown import NONE, cpu, fixed, percent, table
from plotting import finish
from results import Collection

MARKERS = {5: "o", 10: "s"}
COLORS = {(10, False): "#0072B2", (20, False): "#D55E00", (10, True): "#009E73", (20, True): "#CC79A7"}


def _value(results: Collection, run: runs.Run, name: str) -> float | None:
    result = results(run)
    return result.summary.get(name) if result else None


def _parts(results: Collection, run: runs.Run) -> list[tuple[float, float]]:
    """Filling left, in outlets, and flow rate, of each part of the run."""
    result = results(run)
    if not result:
        return []
    filling = float(run.arguments[-1])
    return [(filling * result.summary[f"left_{k}"], result.summary[f"rate_{k}"]) for k in range(runs.HOPPER_PARTS)]


def _name(rows: int, beads: bool, filling: int) -> str:
    return f"{'glass beads, ' if beads else ''}D/dl = {rows}, filled to {filling} D"


def figure(path: Path, results: Collection) -> bool:
    drawn = False
    fig, axes = plt.subplots(figsize=(9, 4.8), layout="constrained")
    cases = [(rows, beads, filling) for rows, beads in runs.HOPPERS for filling in runs.HOPPER_FILLINGS]
    for rows, beads, filling in cases:
        parts = _parts(results, runs.hopper(rows, filling, beads))
        if not parts:
            continue
        drawn = True
        axes.plot(
            [left for left, _ in parts],
            [rate for _, rate in parts],
            linestyle="none",
            marker=MARKERS[filling],
            color=COLORS[rows, beads],
            ms=9,
            label=_name(rows, beads, filling),
        )
    axes.axhline(ref.BASILISK_SILO_RATE, color="0.35", linestyle="--", lw=1.7, label="Basilisk, for D = 0.31 to 1.1")
    axes.set_xlabel("filling left, H/D")
    axes.set_ylabel("Q / (ρ √g D^1.5)")
    axes.set_ylim(0, 1.7)
    axes.legend(loc="lower right")
    return finish(fig, path) if drawn else False


def _table(results: Collection) -> str:
    rows = []
    for spacings, beads in runs.HOPPERS:
        low = _value(results, runs.hopper(spacings, runs.HOPPER_FILLINGS[0], beads), "rate")
        for filling in runs.HOPPER_FILLINGS:
            run = runs.hopper(spacings, filling, beads)
            rate = _value(results, run, "rate")
            of_parts = [value for _, value in _parts(results, run)]
            spread = f"{min(of_parts):.3f} … {max(of_parts):.3f}" if of_parts else NONE
            rows.append(
                [
                    _name(spacings, beads, filling),
                    fixed(rate),
                    spread,
                    NONE if filling == runs.HOPPER_FILLINGS[0] else percent(rate, low, 1),
                    NONE if beads else percent(rate, ref.BASILISK_SILO_RATE, 0),
                    cpu(results(run).cpu) if results(run) else NONE,
                ]
            )
    header = ["case", "Q / (ρ √g D^1.5)", "in four parts of the time", "to the lower filling", "to Basilisk", "CPU s"]
    return table(header, rows)


def _result(results: Collection) -> str:
    pairs = [
        [_value(results, runs.hopper(rows, filling, beads), "rate") for filling in runs.HOPPER_FILLINGS]
        for rows, beads in runs.HOPPERS
    ]
    known = [(low, high) for low, high in pairs if low is not None and high is not None]
    if not known:
        return ""
    worst = max(abs(high / low - 1) for low, high in known)
    rates = [rate for pair in known for rate in pair]
    return (
        f"**The flow rate is {min(rates):.2f} to {max(rates):.2f} ρ √g D^1.5, and twice the filling changes it by "
        f"{100 * worst:.1f} % at most.**"
    )


def section(results: Collection, drawn_figure: str) -> str:
    return f"""{_result(results)}

A silo 5 D wide with a flat floor and rough walls, an outlet of D = 0.05 m in its middle, open from the start; means from
0.2 to 0.8 s. μ_s = {ref.SILO_MU_S:g}, μ_2 = {ref.SILO_MU_2:g}, I0 = {ref.SILO_I0:g}; glass beads have 21°, 32° and 0.3; d = D/20. A
fluid's rate would go by the square root of the filling: {100 * (2**0.5 - 1):.0f} % more at twice as much.

Beside it: {ref.BASILISK_SILO_SOURCE}.
{ref.STARON_SILO} report by the same law that the rate
does not depend on the filling and goes by the power 1.5; their coefficient could not be looked up.

{_table(results)}

{drawn_figure}"""
