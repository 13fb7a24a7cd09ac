"""python3 -m granperi compare: what two result files differ in."""
from __future__ import annotations

import argparse

from . import _compare
from ._cli import Commands
from ._result import Result


def _compare_results(options: argparse.Namespace) -> None:
    with Result(options.first) as first, Result(options.second) as second:
        print(_compare.table(_compare.compare(first, second, options.time)))
        print("the files have the same frames to the last bit" if _compare.same_bits(first, second)
              else "the files differ")
        if options.picture:
            import matplotlib

            matplotlib.use("Agg")
            from . import plot

            time = options.time[-1] if options.time else None
            axes = plot.compare(first, second, time, (options.first, options.second))
            axes.figure.savefig(options.picture)
            print(options.picture)


def add(commands: Commands) -> None:
    compare = commands.add("compare", _compare_results, "Compares two result files.")
    compare.add_argument("first")
    compare.add_argument("second")
    compare.add_argument("--time", type=float, nargs="+", help="s, one or several [the last frames]")
    compare.add_argument("--picture", help="draws the two surfaces over each other")
