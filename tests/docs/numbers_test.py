#!/usr/bin/env python3
"""The numbers that pages repeat are those of the reports: in the repository as it is, and what is wrong in one edited by hand is found."""
import contextlib
import importlib.machinery
import importlib.util
import io
import pathlib
import shutil
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench" / "common"))

import headlines


def faults_of(pages):
    after = pages.rewritten()
    return [*pages.faults, *pages.unused(), *NUMBERS.differences(pages, after)]


def loaded():
    loader = importlib.machinery.SourceFileLoader("numbers_script", str(ROOT / "scripts" / "numbers"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


NUMBERS = loaded()


def check_rules():
    report = "Peak " + headlines.headline("v.peak", "0.410") + ", " + headlines.headline("v.off", "-12.1 %") + ".\n"

    def found(page, of=report):
        return faults_of(headlines.Pages({"docs/v.md": of, "README.md": page}))

    right = "It is <!--n:v.peak-->0.410<!--/n-->, <!--n:v.peak .2f-->0.41<!--/n-->, <!--n:v.off abs .0f-->12 %<!--/n--> below.\n"
    assert found(right) == [], found(right)
    for wrong, what in (
        (right.replace("0.410", "0.409"), "README.md:1: v.peak is 0.410 (docs/v.md), not 0.409"),
        (right.replace(">12 %", ">13 %"), "v.off is 12 %"),
        (right.replace("n:v.off", "n:v.of"), "no report has v.of"),
        (right.replace("It is ", ""), "begins the line"),
        ("- " + right.replace("It is ", ""), "begins the line"),
        ("    " + right, "in code"),
        ("```\n" + right + "```\n", "in code"),
        ("`" + right.rstrip() + "`\n", "in code"),
        (right.replace("<!--/n-->, ", ", ", 1), "not <!--n:NAME-->NUMBER<!--/n-->"),
        (right.replace(".0f", "0.q"), "v.off: Format"),
        ("Nothing.\n", "no page uses v.off"),
    ):
        assert any(what in fault for fault in found(wrong)), (what, found(wrong))
    assert any("no number" in fault for fault in found(right, report.replace("0.410", "–"))), "a dash is no number"
    words = found("It is <!--n:v.words text-->`a` 1, `b` 2<!--/n-->.\n", headlines.headline("v.words", "`a` 1, `b` 2"))
    assert words == ["docs/v.md:1: a mark begins the line: Markdown takes that for HTML"], words
    assert any("says nothing" in fault for fault in found("It is <!--n:v.words text-->x<!--/n-->.\n", headlines.headline("v.words", "–")))
    assert any("is that of docs/v.md, too" in fault for fault in found(right, report + report)), "each number has one source"


def check_by_hand():
    """Each number, edited in its report or in a page, is found; and the script puts it right."""
    pages = headlines.read(ROOT)
    for page, text in pages.texts.items():
        for mark in headlines.MARK.finditer(text):
            edited = text[:mark.start("text")] + "9" + mark["text"] + text[mark.end("text"):]
            edited = edited.replace("9+", "+9").replace("9-", "-9") if mark["text"][0] in "+-" else edited
            faults = faults_of(headlines.Pages({**pages.texts, page: edited}))
            assert any(mark["name"] in fault for fault in faults), f"{page}: {mark['name']} edited by hand is not found"
    with tempfile.TemporaryDirectory() as work:
        copy = pathlib.Path(work)
        shutil.copytree(ROOT / "docs", copy / "docs", ignore=shutil.ignore_patterns("*.png"))
        readme = pages.texts["README.md"]
        mark = next(headlines.MARK.finditer(readme))
        shutil.copyfile(ROOT / "CHANGELOG.md", copy / "CHANGELOG.md")
        (copy / "README.md").write_text(readme[:mark.start("text")] + "7" + readme[mark.end("text"):], encoding="utf-8")
        with contextlib.redirect_stderr(io.StringIO()) as said:
            assert NUMBERS.main(["--check"], copy) == 1
        assert mark["name"] in said.getvalue()
        NUMBERS.write(headlines.read(copy), copy)
        assert (copy / "README.md").read_text(encoding="utf-8") == readme and NUMBERS.main(["--check"], copy) == 0


def main():
    check_rules()
    faults = faults_of(headlines.read(ROOT))
    if faults:
        sys.exit("\n".join([*faults, "run scripts/numbers"]))
    check_by_hand()
    print(len(headlines.read(ROOT).numbers), "numbers, each of one report")


if __name__ == "__main__":
    main()
