"""Numbers that other pages repeat: the report has the one that counts, scripts/numbers copies it.

A report marks a number, as it prints it, where it prints it; once in all reports, by a name that begins with the report's:

    from headlines import headline

    f"Peak y/L {headline('validation.both_side.peak', fixed(peak))} at 0.42 s"

which is <!--n=validation.both_side.peak-->0.410<!--/n--> in docs/validation.md; most are in the table that ends it (section(), of the rows of
bench/validation/repeated.py). A report written by hand has the marks typed in. Any other page says <!--n:validation.both_side.peak--> ... <!--/n-->, and scripts/numbers writes the number in between. There a format may follow
the name: <!--n:validation.both_side.peak .2f--> makes 0.41 of it, "abs .0f" makes 12 % of -12.1 %; "text" asks for words, as
they are. What is no number in the report (a dash, where a run is missing) is an error, and the page keeps what it has.

Markdown shows nothing of the marks, but in code, and where they begin a line, which makes it a line of HTML: neither is allowed. Each number
that is marked is used by a page. tests/docs/numbers_test.py holds the pages to all this.
"""
from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable
from pathlib import Path

NAME = r"[a-z][a-z0-9_]*(?:\.[a-z0-9_]+)+"
MARK = re.compile(rf"<!--n(?P<kind>[=:])(?P<name>{NAME})(?: (?P<format>[^>]*?))?-->(?P<text>[^<]*)<!--/n-->")
ANY_MARK = re.compile(r"<!--\s*/?\s*n\b")
BEGINS_LINE = re.compile(r"^[ >]*(?:[-*+] +|\d+[.)] +)?<!--")
VALUE = re.compile(r"([+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?)(.*)", re.S)


def headline(name: str, text: str) -> str:
    """A number of a report, marked."""
    if not re.fullmatch(NAME, name):
        raise ValueError(f"{name!r}: names are of the form report.scene.what")
    return f"<!--n={name}-->{text}<!--/n-->"


def section(rows: Iterable[tuple[str, str, str]]) -> str:
    """What a report ends with, of (name, what it is, number)."""
    lines = [f"| {what} | {headline(name, text)} |" for name, what, text in rows]
    return "\n".join(["## Numbers that other pages repeat", "", "| | |", "|---|---:|", *lines])


@dataclasses.dataclass(frozen=True)
class Number:
    text: str
    page: str

    def written(self, how: str | None) -> str:
        """As a page wants it."""
        if how == "text":
            if not re.search(r"\w", self.text):
                raise ValueError(f"{self.page} has {self.text!r}, which says nothing")
            return self.text
        value = VALUE.fullmatch(self.text)
        if value is None:
            raise ValueError(f"{self.page} has {self.text!r}, which is no number")
        if not how:
            return self.text
        *words, digits = how.split()
        number = float(value[1])
        if words not in ([], ["abs"]):
            raise ValueError(f"no format {how!r}: one of Python's, or abs and one of these")
        return f"{abs(number) if words else number:{digits}}{value[2]}"


@dataclasses.dataclass
class Pages:
    """All pages, what is wrong with them, and what they should be."""

    texts: dict[str, str]  # by path
    numbers: dict[str, Number] = dataclasses.field(default_factory=dict)
    used: set[str] = dataclasses.field(default_factory=set)
    faults: list[str] = dataclasses.field(default_factory=list)

    def __post_init__(self) -> None:
        for page, text in self.texts.items():
            self._find(page, text)

    def _find(self, page: str, text: str) -> None:
        inside = False
        for k, line in enumerate(text.split("\n"), 1):
            inside ^= line.lstrip().startswith("```")
            if not ANY_MARK.search(line):
                continue
            if inside or line.startswith("    ") or ANY_MARK.search("".join(line.split("`")[1::2])):
                self.faults.append(f"{page}:{k}: a mark in code, where it shows")
            elif BEGINS_LINE.match(line):
                self.faults.append(f"{page}:{k}: a mark begins the line: Markdown takes that for HTML")
            if ANY_MARK.search(MARK.sub("", line)):
                self.faults.append(f"{page}:{k}: not <!--n:NAME-->NUMBER<!--/n--> within one line")
        for mark in MARK.finditer(text):
            if mark["kind"] == ":":
                continue
            if mark["name"] in self.numbers:
                self.faults.append(f"{page}: {mark['name']} is that of {self.numbers[mark['name']].page}, too")
            self.numbers[mark["name"]] = Number(mark["text"], page)

    def rewritten(self) -> dict[str, str]:
        """The pages with the numbers of the reports; what is in the way becomes a fault."""
        return {page: MARK.sub(lambda mark: self._replaced(page, mark), text) for page, text in self.texts.items()}

    def _replaced(self, page: str, mark: re.Match[str]) -> str:
        if mark["kind"] == "=":
            return mark[0]
        self.used.add(mark["name"])
        if mark["name"] not in self.numbers:
            self.faults.append(f"{page}: no report has {mark['name']}")
            return mark[0]
        try:
            text = self.numbers[mark["name"]].written(mark["format"])
        except ValueError as error:
            self.faults.append(f"{page}: {mark['name']}: {error}")
            return mark[0]
        return f"<!--n:{mark['name']}{' ' + mark['format'] if mark['format'] else ''}-->{text}<!--/n-->"

    def unused(self) -> Iterable[str]:
        """Once the pages are rewritten."""
        return (f"{self.numbers[name].page}: no page uses {name}" for name in sorted(set(self.numbers) - self.used))


def read(root: Path) -> Pages:
    """README.md, CHANGELOG.md and the pages of docs."""
    paths = [root / "README.md", root / "CHANGELOG.md", *sorted((root / "docs").rglob("*.md"))]
    return Pages({path.relative_to(root).as_posix(): path.read_text(encoding="utf-8") for path in paths})
