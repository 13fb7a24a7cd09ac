#!/usr/bin/python3
"""Runs what is missing of the studies of docs/performance.md: one at a time, so that none slows down another,
cheapest first, each once per state of the sources."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "common"))

import runs
from batch import run_missing
from run import ROOT

if __name__ == "__main__":
    sys.exit(run_missing(runs.studies(), runs.PROGRAMS, ROOT / "results" / "performance", __doc__, workers=1))
