#!/usr/bin/env python3
"""Makes the HTML pages: the guide, the reports and the references of C, Python and Fortran.

usage: make.py OUTPUT [--cc CC]

Needs Sphinx with myst_parser and furo, and the package granperi on the path of modules. Writes OUTPUT/html and, beside it,
OUTPUT/source, the pages that Sphinx reads. Any warning of Sphinx is an error. Prints the number of pages and names.
"""
import argparse
import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import text  # noqa: E402
from c_reference import read_header, write_c_reference  # noqa: E402
from fortran_reference import c_functions, write_fortran_reference  # noqa: E402
from mpi_reference import write_mpi_reference  # noqa: E402
from python_reference import write_python_reference  # noqa: E402

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
REPORTS = ["validation", "stability", "performance", "settings", "report", "hot-path", "trust", "abi"]
EXAMPLES = {"c": (".c", ".h"), "fortran": (".f90",), "python": (".py", ".toml")}
NEEDED = {"sphinx": "python3-sphinx", "myst_parser": "python3-myst-parser", "furo": "furo"}
MATH_FONT = "/usr/share/texmf/fonts/opentype/public/lm-math/latinmodern-math.otf"  # fonts-lmodern
LINK = re.compile(r"(!?)\[([^]]*)\]\(([^)#]*)(#[^)]*)?\)")


class PageError(Exception):
    """A page cannot be made; the text says which, and why."""


def target_of(page, link):
    """What a relative link of the page docs/PAGE becomes: a link within the pages, or None where there is no such page."""
    path = os.path.relpath(os.path.normpath(os.path.join(ROOT, "docs", os.path.dirname(page), link)), ROOT)
    if not os.path.exists(os.path.join(ROOT, path)):
        raise PageError("docs/%s: there is no %s" % (page, link))
    up = "../" * page.count("/")
    if path == "include/granperi/gp.h":
        return up + "reference/c/index.rst"
    if path == "include/granperi/gp_mpi.h":
        return up + "reference/c/mpi.rst"
    if path.startswith("examples/"):
        return up + "examples/" + (path[len("examples/"):] + ".md" if os.path.isfile(os.path.join(ROOT, path)) else "index.md")
    if path.startswith("docs/") and path.endswith((".md", ".png")):
        return up + path[len("docs/"):]
    return None


def staged(page):
    """The text of docs/PAGE with links that lead somewhere, and without what is meant for the test of its blocks."""
    with open(os.path.join(ROOT, "docs", page), encoding="utf-8") as source:
        lines = re.sub(r"<!-- block:.*?-->\n", "", source.read(), flags=re.S)

    def link(match):
        picture, words, path, anchor = match.groups()
        if not path or "://" in path:
            return match.group(0)
        target = target_of(page, path)
        return "%s[%s](%s%s)" % (picture, words, target, anchor or "") if target else words

    parts = re.split(r"(^```.*?^```$)", lines, flags=re.S | re.M)  # code is left alone
    return "".join(part if part.startswith("```") else LINK.sub(link, part) for part in parts)


def write(path, content):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as target:
        target.write(content)


def contents(caption, pages):
    return "\n```{toctree}\n:caption: %s\n:hidden:\n:maxdepth: 2\n\n%s\n```\n" % (caption, "\n".join(pages))


def stage_guide(source):
    """The pages of the guide in the order in which its README.md names them, and the front page."""
    guide = os.path.join(ROOT, "docs", "guide")
    front = staged("guide/README.md")
    with open(os.path.join(guide, "README.md"), encoding="utf-8") as page:
        links = [link for _, _, link, _ in LINK.findall(page.read()) if "/" not in link and link.endswith(".md")]
    pages = list(dict.fromkeys(links))
    there = {name for name in os.listdir(guide) if name.endswith(".md")} - {"README.md"}
    if set(pages) != there:
        raise PageError("docs/guide/README.md does not name: %s" % ", ".join(sorted(there - set(pages))))
    for page in pages:
        write(os.path.join(source, "guide", page), staged("guide/" + page))
    # The front page is a directory up.
    front = LINK.sub(lambda m: "%s[%s](%s%s)" % (m[1], m[2], m[3] if "://" in m[3] else os.path.normpath("guide/" + m[3]),
                                                 m[4] or ""), front)
    front += contents("Guide", ["guide/" + page[:-3] for page in pages])
    front += contents("Reference", ["reference/c/index", "reference/python/index", "reference/fortran/index"])
    front += contents("Reports", REPORTS) + contents("Programs", ["examples/index"])
    write(os.path.join(source, "index.md"), front)


def stage_examples(source):
    pages = []
    for language, ends in EXAMPLES.items():
        directory = os.path.join(ROOT, "examples", language)
        for name in sorted(name for name in os.listdir(directory) if name.endswith(ends)):
            with open(os.path.join(directory, name), encoding="utf-8") as program:
                code = program.read()
            pages.append("%s/%s" % (language, name))
            write(os.path.join(source, "examples", pages[-1] + ".md"),
                  "# %s\n\n```%s\n%s```\n" % (pages[-1], "toml" if name.endswith(".toml") else language, code))
    write(os.path.join(source, "examples", "index.md"),
          "# Example programs\n\n```{toctree}\n:maxdepth: 1\n\n%s\n```\n" % "\n".join(pages))


def stage_style(static):
    """The style, and a font for equations where the system has one: browsers stretch brackets and roots with its help only."""
    shutil.copytree(os.path.join(ROOT, "docs", "site", "static"), static)
    if os.path.exists(MATH_FONT):
        shutil.copy(MATH_FONT, static)
        with open(os.path.join(static, "granperi.css"), "a", encoding="utf-8") as style:
            style.write('@font-face { font-family: "Latin Modern Math"; src: url("%s"); }\n' % os.path.basename(MATH_FONT))


def stage(source, cc):
    """Writes what Sphinx reads; returns the names that the pages have to hold."""
    for report in REPORTS:
        write(os.path.join(source, report + ".md"), staged(report + ".md"))
    shutil.copytree(os.path.join(ROOT, "docs", "images"), os.path.join(source, "images"))
    stage_guide(source)
    stage_examples(source)
    path, fortran = os.path.join(ROOT, "include", "granperi", "gp.h"), os.path.join(ROOT, "bindings", "fortran")
    header, c_pages = read_header(path, cc, text.lines_of), os.path.join(source, "reference", "c")
    of_fortran = c_functions(fortran, header)
    functions = write_c_reference(path, cc, c_pages, of_fortran, more=["mpi"])
    of_mpi = write_mpi_reference(os.path.join(os.path.dirname(path), "gp_mpi.h"), path, cc, c_pages)
    bound = write_fortran_reference(fortran, header, os.path.join(source, "reference", "fortran"))
    return functions + of_mpi, write_python_reference(os.path.join(source, "reference", "python"), header, of_fortran), bound


def ids_in(directory):
    """The anchors of all pages in a directory, and their words without marks."""
    found, words = set(), []
    for root, _, names in os.walk(directory):
        for name in names:
            if name.endswith(".html"):
                with open(os.path.join(root, name), encoding="utf-8") as page:
                    page = page.read()
                found.update(re.findall(r'\bid="([^"]+)"', page))
                words.append(re.sub(r"<[^>]*>", "", page))
    return found, "\n".join(words)


def missing_in(html, functions, names, bound):
    """Public names that the pages do not describe."""
    ids, _ = ids_in(os.path.join(html, "reference", "c"))
    missing = [name for name in functions if "c." + name not in ids]
    ids, _ = ids_in(os.path.join(html, "reference", "python"))
    missing += [name for name in names if name not in ids]
    _, words = ids_in(os.path.join(html, "reference", "fortran"))
    return missing + [name for name in bound if name + "(" not in words]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("output", type=os.path.abspath)
    parser.add_argument("--cc", default=os.environ.get("CC", "cc"), type=shlex.split)
    arguments = parser.parse_args()
    absent = [package for module, package in NEEDED.items() if importlib.util.find_spec(module) is None]
    if absent:
        print("skipped: these packages are not installed: %s (scripts/install-dependencies docs)" % ", ".join(absent))
        return 77
    source, html = os.path.join(arguments.output, "source"), os.path.join(arguments.output, "html")
    for old in (source, html, os.path.join(arguments.output, "doctrees")):  # what pages were before may be elsewhere now
        shutil.rmtree(old, ignore_errors=True)
    try:
        functions, names, bound = stage(source, arguments.cc)
    except Exception as error:
        if type(error).__module__ == "builtins":
            raise
        sys.exit("docs/site: %s" % error)
    for name in ("conf.py", "mathml.py"):
        shutil.copy(os.path.join(ROOT, "docs", "site", name), source)
    stage_style(os.path.join(source, "static"))
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-n", "-b", "html",
               "-d", os.path.join(arguments.output, "doctrees"), source, html]
    if subprocess.run(command).returncode != 0:
        sys.exit("docs/site: Sphinx has something to say, see above")
    missing = missing_in(html, functions, names, bound)
    if missing:
        sys.exit("docs/site: the pages do not describe: %s" % ", ".join(missing))
    pages = sum(name.endswith(".html") for _, _, files in os.walk(html) for name in files)
    print("%d pages; %d functions of C, %d names of Python, %d procedures of Fortran" %
          (pages, len(functions), len(names), len(bound)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
