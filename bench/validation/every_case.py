"""The table of every case of docs/validation.md: what was asked, what came out, whether that is enough, what it cost."""
from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import convergence_section as convergence
import exact_cases
import fluid_cases
import headlines
import matplotlib.pyplot as plt
import wall_cases
from case import Case
from markdown import NONE, cpu, table
from plotting import finish
from results import Collection
from run import ROOT

GROUPS: dict[str, Callable[[Collection], list[Case]]] = {
    "exact solutions": exact_cases.cases,
    "collapses": lambda results: collapses(results),
    "walls and inclines": wall_cases.cases,
    "granular fluidity": fluid_cases.cases,
    "several processes": lambda results: [speed_of_two()],
}
EFFICIENCY = 0.96  # that two processes are asked for


def collapses(results: Collection) -> list[Case]:
    found = []
    for case in convergence.CASES.values():
        worst = convergence.worst_of(results, case)
        measured = "; ".join(f"{w.label} {100 * w.off:+.1f} % at {w.resolution}" for w in worst)
        found.append(
            Case(
                f"collapse, {case.label}" if not case.label.startswith("the same") else f"collapse, a = 1.25{case.label[8:]}",
                "3, 5, 5, 2 %",
                measured,
                max((w.share for w in worst), default=math.nan),
                convergence.spent(results, case) or None,
            )
        )
    of = {"late_pressure": "highest pressure", "late_mean": "highest mean of a particle's and its neighbours' pressures"}
    for column, name in of.items():
        pressure = convergence.highest_pressure(results, convergence.CASES["beads"], column)
        found.append(
            Case(
                f"collapse, a = 1.25: {name} from 0.05 s on",
                f"≤ {convergence.PRESSURE:g} ρ g H",
                "" if math.isnan(pressure) else f"{pressure:.2f} ρ g H",
                pressure / convergence.PRESSURE,
                None,
            )
        )
    return found


def speed_of_two() -> Case:
    """Measured by hand, with the program bench/mpi: the guide has the number."""
    page = "docs/guide/mpi.md"
    text = headlines.Pages({page: (ROOT / page).read_text(encoding="utf-8")}).numbers["mpi.two_processes"].text
    return Case(
        "collapse of 40 000 particles on two processes: speed over that of the library without MPI",
        f"≥ {2 * EFFICIENCY:g}",
        text,
        (1 - float(text) / 2) / (1 - EFFICIENCY),
        None,
    )


def every(results: Collection) -> dict[str, list[Case]]:
    return {group: cases(results) for group, cases in GROUPS.items()}


def section(results: Collection) -> str:
    rows = []
    for group, cases in every(results).items():
        rows.append([f"**{group}**", "", "", "", ""])
        rows += [[c.name, c.asked, c.measured or NONE, c.verdict, cpu(c.cpu)] for c in cases]
    lines = table(["case", "asked", "measured, the worst", "verdict", "CPU s"], rows).split("\n")
    lines[1] = "|---|---|---|---|---:|"
    return """Every case that the library is held to, at full size; small ones are tests. "Missed" says how many times as large as asked the
departure is. The sections below have the numbers; CPU s are those of all runs of the row. Collapses are asked to be within so much of
their finest run: peak and run-out of 90 % of the mass 3 % from L/dl = 32 on, 5 % at 16 and 24, run-out of 98 % 5 % from 32 on, mean
distance from the middle (the wall) in mid-flow, at 0.1 s, 2 % at 32. Equal values on 1 to 4 processes are tests; two processes are
asked to waste 4 % of their time at most, and [the guide](guide/mpi.md#how-many-processes) has what else was measured of their speed.

""" + "\n".join(lines)


@dataclass(frozen=True)
class Count:
    met: int
    known: int
    missed: list[Case]


def count(results: Collection) -> Count:
    known = [c for cases in every(results).values() for c in cases if not math.isnan(c.share)]
    missed = sorted((c for c in known if not c.met), key=lambda c: -c.share)
    return Count(len(known) - len(missed), len(known), missed)


FARTHEST = 3  # that the head names; the table has all


def sentence(results: Collection) -> str:
    """What the head of the report says of them."""
    n = count(results)
    if not n.known:
        return ""
    text = f"Of {n.known} cases with a right answer {n.met} are met"
    if n.missed:
        near = sum(c.share < 2 for c in n.missed)
        farthest = "; ".join(f"{c.name} ({c.times})" for c in n.missed[:FARTHEST])
        text += f", {near} of the others are off by less than twice what is allowed. Farthest off: {farthest}"
    return text + "."


LEAST, MOST, OFFSETS = 0.01, 20.0, (0.0, -0.17, 0.17, -0.32, 0.32)  # departures that are drawn; of dots, in rows


def figure(path: Path, results: Collection) -> bool:
    """Each case's departure over what is allowed; those that are missed have a row and their name."""
    groups = {group: [c for c in cases if not math.isnan(c.share)] for group, cases in every(results).items()}
    if not any(groups.values()):
        return False
    missed = {group: sorted((c for c in cases if not c.met), key=lambda c: -c.share) for group, cases in groups.items()}
    rows = sum(1.2 + 0.6 * len(cases) for cases in missed.values())
    drawing, axes = plt.subplots(figsize=(12, 1.3 + 0.42 * rows), layout="constrained")
    row, ticks = 0.0, []
    for group, cases in groups.items():
        met = sorted((c.share for c in cases if c.met))
        ticks.append((row, f"{group}: {len(met)} of {len(cases)}"))
        for k, value in enumerate(met):
            axes.plot([max(value, LEAST)], [row + OFFSETS[k % len(OFFSETS)]], "o", color="#0072B2", ms=8, mec="white")
        for c in missed[group]:
            row += 0.6
            axes.plot([min(c.share, MOST)], [row], "o", color="#D55E00", ms=9)
            axes.text(min(c.share, MOST) * 1.3, row, f"{c.name}: {c.times}", va="center", fontsize=13, color="#B04A00")
        row += 1.2
    axes.axvline(1, color="black", lw=1.4)
    axes.set_xscale("log")
    axes.set_xlim(LEAST * 0.8, 3000)
    axes.set_ylim(row - 0.5, -0.7)
    axes.set_yticks([place for place, _ in ticks], [name for _, name in ticks])
    axes.set_xticks([0.01, 0.1, 1, 10], ["0.01 and less", "0.1", "1", "10"])
    axes.minorticks_off()
    axes.set_xlabel("departure over what is allowed", loc="left")
    return finish(drawing, path)
