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
    """Nothing if it was not drawn."""
    return f"![{caption}](images/{prefix}_{name}.png)\n\n*{caption}*" if name in drawn else ""


def provenance(collection: Collection, command: str) -> str:
    found = collection.found.values()
    total = sum(result.cpu for result in found)
    commits = sorted({result.commit for result in found if result.commit})
    sources: dict[str, set[str]] = {}
    for result in found:
        sources.setdefault(result.program, set()).add(result.source)
    states = max((len(of_program) for of_program in sources.values()), default=0)
    text = (
        f"{len(collection.found)} runs, {total / 60:.0f} CPU minutes in all, one thread each; sources at "
        f"commit {', '.join(commits) or 'unknown'}."
    )
    if states > 1:
        text += (
            f" **The results come from {states} states of the sources**: run `{command}` again for one state."
        )
    if collection.absent:
        text += f" {len(collection.absent)} runs are missing: they are listed at the end, and their places hold a dash."
    return text


def missing_runs(collection: Collection) -> str:
    if not collection.absent:
        return ""
    reasons: dict[str, list[str]] = {}
    for name, why in collection.absent.items():
        reasons.setdefault(why, []).append(name)
    return (
        "\n## Missing runs\n\n" + bullets(f"{why}: {', '.join(sorted(names))}" for why, names in reasons.items()) + "\n"
    )


def bullets(lines: Iterable[str]) -> str:
    return "\n".join(f"- {line}" for line in lines)


def tidy(text: str) -> str:
    """One empty line where a figure is missing."""
    while "\n\n\n" in text:
        text = text.replace("\n\n\n", "\n\n")
    return text.rstrip() + "\n"


def changelog_versions() -> list[str]:
    """The headings of CHANGELOG.md, the latest first."""
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    return re.findall(r"^## (.*)$", text, re.MULTILINE)


def split_sections(text: str) -> dict[str, str]:
    """Parts of a report by their titles, in order; what is above the first has the title ""."""
    parts = re.split(r"^## (.*)\n", text, flags=re.MULTILINE)
    return {"": parts[0], **dict(zip(parts[1::2], parts[2::2]))}


MIXED = "**Sections of more than one version.**"


def with_sections(old: str, new: str, titles: Iterable[str], versions: list[str]) -> str:
    """The old report with these sections of the new one, at their places in it, and a paragraph that says so."""
    kept, made = split_sections(old), split_sections(new)
    titles = list(titles)
    for title in titles:
        if title not in made:
            raise SystemExit(f"no section {title!r}: there are {', '.join(list(made)[1:])}")
    before = re.search(rf"{re.escape(MIXED)} (.*): of {re.escape(versions[0])}\.", kept[""])
    earlier = before[1].split(", ") if before else []
    of_latest = [title for title in kept if title in titles or title in earlier]
    of_latest += [title for title in titles if title not in kept]
    said = (
        f"{MIXED} {', '.join(of_latest)}: of {versions[0]}. All others: of {versions[1]}, made anew with the release. "
        "The summary below is theirs, too."
    )
    paragraphs = [one for one in kept[""].split("\n\n") if not one.startswith(MIXED)]
    paragraphs.insert(1, said)
    order = [title for title in made if title in kept or title in titles]
    order += [title for title in kept if title not in made]
    body = {title: made[title] if title in titles else kept[title] for title in order if title}
    head = "\n\n".join(paragraphs)
    return tidy(head + "".join(f"## {title}\n{text}" for title, text in body.items()))


def write_report(
    name: str, description: str, figures: dict, every_run: Iterable[Run], compose: Callable[[Collection, set[str]], str]
) -> None:
    """The command line of report.py: draws the figures, looks which runs are there, and writes docs/NAME.md."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument(
        "--results", type=Path, default=ROOT / "results" / name, help=f"where the results are [results/{name}]"
    )
    parser.add_argument("--docs", type=Path, default=ROOT / "docs", help=f"where {name}.md goes [docs]")
    parser.add_argument(
        "--section",
        metavar="TITLE",
        action="append",
        help="write only this section anew and leave the rest of the report as it is; more than once for more",
    )
    parser.add_argument(
        "--figure",
        metavar="NAME",
        action="append",
        default=[],
        choices=sorted(figures),
        help="with --section: a figure to be drawn anew for it; more than once for more",
    )
    arguments = parser.parse_args()
    collection = Collection(arguments.results)
    report = arguments.docs / f"{name}.md"
    if arguments.section:
        drawn = draw_all({name: figures[name] for name in arguments.figure}, arguments.docs / "images", name, collection)
        text = with_sections(
            report.read_text(encoding="utf-8"), compose(collection, drawn), arguments.section, changelog_versions()
        )
    else:
        drawn = draw_all(figures, arguments.docs / "images", name, collection)
        for run in every_run:
            collection(run)
        text = compose(collection, drawn)
    report.write_text(text, encoding="utf-8")
    print(f"{report}: {len(collection.found)} results, {len(collection.absent)} missing, {len(drawn)} figures")
