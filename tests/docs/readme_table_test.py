#!/usr/bin/env python3
"""The table in README.md is what its first command prints: the same rows, and figures within what single runs scatter by.

usage: readme_table_test.py BOTH_SIDE PYTHON
"""
import os
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
# Relative scatter of a run at L/dl = 32 (peak 0.4 %, docs/guide/model.md; run-out 0.7 %, the yardstick of docs/stability.md), times
# four. A row that is not here holds what a machine or the last digits decide.
SCATTER = {"peak y/L at 0.42 s": 0.016, "run-out, 90 % of the mass": 0.028}
# The energy error is a few hundredths of a per cent from run to run; the file has a frame every 0.02 s.
ABSOLUTE = {"error of the energy ledger": 0.1, "at rest": 0.06}


def rows_of(text):
    """{row: its line} of a table as scripts/plot_collapse.py writes it."""
    return {line[:29].strip(): line for line in text.split("\n") if line[:29].strip() and len(line) > 40}


def figure_of(row, line):
    found = re.search(r"since ([\d.]+) s" if row == "at rest" else r"^.{29,36}? ([\d.e+-]+) ", line)
    return float(found.group(1)) if found else None


def main():
    program, python = os.path.abspath(sys.argv[1]), sys.argv[2]
    with open(os.path.join(ROOT, "scripts", "collapse"), encoding="utf-8") as script:
        script = script.read().replace("\\\n", " ")
    options = re.search(r"^build/examples/c/both_side (.*?)>", script, re.M).group(1)
    with tempfile.TemporaryDirectory() as work:
        os.mkdir(os.path.join(work, "results"))
        with open(os.path.join(work, "results", "both_side.txt"), "w", encoding="utf-8") as summary:
            subprocess.run([program, *shlex.split(options)], cwd=work, check=True, stdout=summary)
        subprocess.run([python, os.path.join(ROOT, "scripts", "plot_collapse.py"), "results/both_side.h5", "--summary",
                        "results/both_side.txt", "--picture", "results/both_side.png", "--table", "results/table.txt"],
                       cwd=work, check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(work, "results", "table.txt"), encoding="utf-8") as table:
            printed = rows_of(table.read())
    with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as page:
        told = rows_of(re.search(r"\n\n((?:    .*\n)*    peak y/L.*\n(?:    .*\n)*)", page.read()).group(1).replace("\n    ", "\n").lstrip())
    faults = [row for row in printed if row not in told] + [row for row in told if row not in printed]
    for row, tolerance in [*SCATTER.items(), *ABSOLUTE.items()]:
        ours, theirs = figure_of(row, told[row]), figure_of(row, printed[row])
        off = abs(ours - theirs) / (abs(theirs) if row in SCATTER else 1)
        print("%-28s README %g, printed %g" % (row, ours, theirs))
        if not off <= tolerance:
            faults.append(row)
    if faults:
        sys.exit("README.md: not what scripts/collapse prints: " + ", ".join(faults))


if __name__ == "__main__":
    main()
