"""What all reports have: figures with captions, where the numbers come from, what is missing."""
from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import Callable, Iterable

from plotting import draw_all
from results import Collection
from run import ROOT, Run


def figure(prefix: str, name: str, drawn: set[str], caption: str) -> str:
    """Nothing if it was not drawn. The caption's first sentence stands for the picture where it cannot be seen."""
    short = re.split(r"(?<=[^.]{8})[.;:] ", caption, maxsplit=1)[0]
    return f"![{short}](images/{prefix}_{name}.png)\n\n*{caption}*" if name in drawn else ""


def footer(collection: Collection, report: str, script: str, said: str) -> str:
    """What a report ends with: where its numbers come from, and the runs that are missing. said: of what its numbers are."""
    found = list(collection.found.values())
    commits, machines, days = (sorted({getattr(r, name) for r in found}) for name in ("commit", "machine", "date"))
    sources: dict[str, set[str]] = {}
    for result in found:
        sources.setdefault(result.program, set()).add(result.source)
    states = max((len(of_program) for of_program in sources.values()), default=0)
    text = (
        f"By `{script}` ([bench/{report}](../bench/{report})), which does the runs that are missing; with `--report-only` it writes this "
        f"report from the results in `results/{report}`. {said}\n\n"
    )
    lines = [
        f"{len(found)} runs, {sum(result.cpu for result in found) / 60:.0f} CPU minutes in all, one thread each unless a table says otherwise",
        f"machine: {' and '.join(machines) or 'unknown'}",
        f"sources: commit {', '.join(commits) or 'unknown'}; {' to '.join(sorted({days[0], days[-1]})) if days else 'no day'}",
    ]
    if states > 1:
        lines.append(f"**the results come from {states} states of the sources**: run `{script}` again for one state")
    if collection.absent:
        lines.append(f"{len(collection.absent)} runs are missing, and their places hold a dash:")
    text += bullets(lines)
    for why, names in _reasons(collection).items():
        text += f"\n  - {why}: {', '.join(sorted(names))}"
    return f"## How these numbers were made\n\n{text}\n"


def _reasons(collection: Collection) -> dict[str, list[str]]:
    reasons: dict[str, list[str]] = {}
    for name, why in collection.absent.items():
        reasons.setdefault(why, []).append(name)
    return reasons


def bullets(lines: Iterable[str]) -> str:
    return "\n".join(f"- {line}" for line in lines)


def tidy(text: str) -> str:
    """One empty line where a figure is missing."""
    while "\n\n\n" in text:
        text = text.replace("\n\n\n", "\n\n")
    return text.rstrip() + "\n"


def write_report(
    name: str, description: str, figures: dict, every_run: Iterable[Run], compose: Callable[[Collection, set[str]], str]
) -> None:
    """The command line of report.py: draws the figures, looks which runs are there, and writes docs/NAME.md."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument(
        "--results", type=Path, default=ROOT / "results" / name, help=f"where the results are [results/{name}]"
    )
    parser.add_argument("--docs", type=Path, default=ROOT / "docs", help=f"where {name}.md goes [docs]")
    arguments = parser.parse_args()
    collection = Collection(arguments.results)
    report = arguments.docs / f"{name}.md"
    drawn = draw_all(figures, arguments.docs / "images", name, collection)
    for run in every_run:
        collection(run)
    text = compose(collection, drawn)
    report.write_text(text, encoding="utf-8")
    print(f"{report}: {len(collection.found)} results, {len(collection.absent)} missing, {len(drawn)} figures")
