"""python3 -m granperi history: the states at the frames of a result file, as CSV."""
from __future__ import annotations

import argparse
import os

from ._cli import Commands
from ._result import Result


def _history(options: argparse.Namespace) -> None:
    output = options.output or os.path.splitext(os.path.basename(options.result))[0] + ".csv"
    with Result(options.result) as result:
        result.history.to_csv(output, options.overwrite)
    print(output)


def add(commands: Commands) -> None:
    history = commands.add("history", _history, "Writes the states at the frames of a result file (time, energies, fronts, ...) as CSV.")
    history.add_argument("result", help="HDF5 file")
    history.add_argument("--output", help="CSV file [RESULT.csv]")
    history.add_argument("--overwrite", action="store_true", help="replace a file that exists")
