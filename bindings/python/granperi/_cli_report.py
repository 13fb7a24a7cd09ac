"""python3 -m granperi report: error against run time of a scene file."""
from __future__ import annotations

import argparse
import os
from typing import Any

from ._cli import bar_is_shown
from ._errors import ArgumentError, FileError
from ._report import report

HELP = "Runs a scene at several spacings and tells what each errs by, what it costs, and which is enough."
EPILOG = """\
The runs of one spacing begin with particles 0.01 spacings beside each other's; what they differ by is chance. Errors
hold in 9 of 10 cases. NAME.html is one page that needs nothing beside it, NAME.json has all numbers.

  python3 -m granperi report collapse.toml --budget 120 --accuracy 0.03
  python3 -m granperi report silo.toml --of peak_height --output silo_report.html
"""


def add(commands: Any) -> None:
    """commands.add(name, function, help, ...) makes the parser of a command."""
    parser = commands.add("report", _report, HELP, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="scene file (TOML)")
    parser.add_argument("--budget", type=float, default=60.0, help="seconds that it may take, used up to the accuracy [60]")
    parser.add_argument("--accuracy", type=float, default=0.05, help="relative error that is asked for [0.05]")
    parser.add_argument("--of", nargs="+", metavar="NAME",
                        help="what it is asked of: peak_height, width_50, width_90, width_98, rest_time, x_q01 ... x_q99 "
                             "[peak_height width_90]")
    parser.add_argument("--end", type=float, help="end of the runs, s [that of the scene]")
    parser.add_argument("--spacings", type=float, nargs="+", metavar="M", help="m, at least three [by budget and accuracy]")
    parser.add_argument("--seeds", type=int, default=4, help="runs of each spacing [4]")
    parser.add_argument("--workers", type=int, default=1, help="runs beside each other [1]")
    parser.add_argument("--output", nargs="+", metavar="FILE", help=".html or .json [SCENE_report.html SCENE_report.json]")
    parser.add_argument("--overwrite", action="store_true", help="replaces reports that are there")
    parser.add_argument("--progress", action=argparse.BooleanOptionalAction, default=None,
                        help="a progress bar [where stderr is a terminal]")


def _report(options: argparse.Namespace) -> None:
    name = os.path.splitext(os.path.basename(options.scene))[0]
    outputs = options.output or [f"{name}_report.html", f"{name}_report.json"]
    for path in outputs:  # before the work, not after it
        if not path.endswith((".html", ".json")):
            raise ArgumentError(f"--output {path}: expected a name that ends in .html or .json")
        if not options.overwrite and os.path.exists(path):
            raise FileError(f"{path}: exists: name another one with --output, or replace it with --overwrite")
    found = report(options.scene, options.budget, options.accuracy, end=options.end, spacings=options.spacings,
                   seeds=options.seeds, of=options.of, workers=options.workers,
                   progress=bar_is_shown(options))
    print(found)
    for path in outputs:
        found.write(path, options.overwrite)
        print(path)
