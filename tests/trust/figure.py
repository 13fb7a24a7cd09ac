#!/usr/bin/env python3
"""Draws docs/images/trust.png: how often each promise of docs/trust.md was put to the test, from the first table of that page.

    /usr/bin/python3 tests/trust/figure.py
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench" / "common"))

import matplotlib.pyplot as plt  # noqa: E402
from plotting import finish  # noqa: E402

# What is counted, and the pattern of its count in an answer of the table.
TRIED = {
    "saved runs that went on": r"(\d+) of \1 restarts",
    "frames read after a kill": r"(\d+) frames read",
    "kills": r"nothing in (\d+) kills",
    "runs compared bit by bit": r"none of (\d+) comparisons",
    "allocations that failed": r"(\d+) allocations failed",
    "calls, checkpoints, result files at random": r"none of (\d+) inputs",
    "tests under ThreadSanitizer": r"none in (\d+) unit and api tests under ThreadSanitizer",
    "tests under AddressSanitizer and UBSan": r"none in (\d+) unit, api and extreme tests under AddressSanitizer",
    "runs in which one of several processes fails": r"(\d+) runs in which one lacks memory",
}


def counts(page: str) -> dict[str, int]:
    table = page[page.index("| question |"):].split("\n\n")[0]
    found = {}
    for what, pattern in TRIED.items():
        matches = re.findall(pattern, table)
        if len(matches) != 1:
            raise SystemExit(f"docs/trust.md: its first table has {len(matches)} counts of {what!r} ({pattern})")
        found[what] = int(matches[0])
    return found


def main() -> None:
    found = sorted(counts((ROOT / "docs" / "trust.md").read_text(encoding="utf-8")).items(), key=lambda item: item[1])
    figure, axes = plt.subplots(figsize=(9.2, 4.8), layout="constrained")
    bars = axes.barh([what for what, _ in found], [count for _, count in found], color="#0072B2")
    axes.bar_label(bars, [f"{count}" for _, count in found], padding=4)
    axes.set(xscale="log", xlim=(50, 3e5), xlabel="how often it was tried; none failed")
    finish(figure, ROOT / "docs" / "images" / "trust.png")


if __name__ == "__main__":
    main()
