"""The parts of a docstring of the Python package: what a call does, and its sections.

    Does a thing; returns its number.

    Args:
        x, y: m, shape (n), finite.
        material: number of the material; further lines
            of it are indented more.

    Returns:
        What it gives back.

    Raises:
        ArgumentError: when.

    Example:
        x = sim.x

    Restrictions:
        What it does not do.
"""
import collections
import inspect
import re
import textwrap

SECTIONS = ("Args", "Returns", "Raises", "Example", "Restrictions")

# doc, returns, example, restrictions: text; args, raises: [(name, text)]
Parts = collections.namedtuple("Parts", "doc args returns raises example restrictions")


class DocstringError(Exception):
    """A docstring that cannot be read."""


def entries_of(lines):
    """[(name, text)] of a section: NAME, NAME: text, further lines of it indented."""
    found = []
    for line in lines:
        head = re.match(r"(\*{0,2}\w+(?:, \*{0,2}\w+)*): (.*)$", line)
        if head:
            found.append([head.group(1), [head.group(2)]])
        elif found and line.startswith("    "):
            found[-1][1].append(line.strip())
        elif line:
            raise DocstringError("expected NAME: text, got %r" % line)
    return [(name, " ".join(text)) for names, text in found for name in names.split(", ")]


def parts_of(docstring):
    lines = inspect.cleandoc(docstring or "").split("\n")
    begins = [k for k, line in enumerate(lines) if re.match(r"(%s):$" % "|".join(SECTIONS), line)]
    sections = {}
    for begin, end in zip(begins, begins[1:] + [len(lines)]):
        sections[lines[begin][:-1]] = textwrap.dedent("\n".join(lines[begin + 1:end])).strip("\n")
    doc = "\n".join(lines[:begins[0]] if begins else lines).strip("\n")
    return Parts(doc, entries_of(sections.get("Args", "").split("\n")), " ".join(sections.get("Returns", "").split()),
                 entries_of(sections.get("Raises", "").split("\n")), sections.get("Example", ""),
                 sections.get("Restrictions", ""))


def examples_in(docstring):
    """All code of a docstring: that of its Example, and of indented paragraphs of the text before."""
    parts = parts_of(docstring)
    paragraphs = [paragraph for paragraph in parts.doc.split("\n\n")
                  if all(line.startswith("    ") for line in paragraph.split("\n"))]
    return [textwrap.dedent(one) for one in [*paragraphs, parts.example] if one]
