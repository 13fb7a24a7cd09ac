"""What a report is made of: calls of programs."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Program:
    """A program of the build, and the files beside the library's that its numbers depend on."""

    path: str  # below the build directory; of a script below the root
    sources: tuple[str, ...]  # patterns below the root
    records: bool = False  # takes --output and writes tables beside its summary
    script: bool = False  # in Python; takes --build DIRECTORY before its other arguments
    refuses: bool = False  # a case that it refuses is one that it does not have yet


@dataclass(frozen=True)
class Run:
    """One call of one program. It is known by its name, and studies that ask for the same run share it."""

    name: str
    program: str
    arguments: tuple[str, ...]
    cost: float  # CPU s, estimated
    long: bool = False  # only run when long ones are asked for


def cheapest_first(studies: dict[str, list[Run]]) -> list[Run]:
    """Every run of the studies once."""
    unique = {run.name: run for members in studies.values() for run in members}
    return sorted(unique.values(), key=lambda run: (run.cost, run.name))


def list_runs(studies: dict[str, list[Run]]) -> None:
    """Prints them with their estimated costs, and the cost of each study."""
    every = cheapest_first(studies)
    for one in every:
        mark = "long" if one.long else ""
        print(f"{one.cost:7.1f} CPU s {mark:4}  {one.name:50} {one.program} {' '.join(one.arguments)}")
    print(f"{len(every)} runs, {sum(one.cost for one in every if not one.long) / 60:.0f} CPU min without long ones")
    for study, members in studies.items():
        print(f"  {study:18} {sum(one.cost for one in members) / 60:5.1f} CPU min (shared ones included)")
