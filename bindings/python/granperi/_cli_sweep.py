"""python3 -m granperi sweep: a scene with many values, run beside each other."""
from __future__ import annotations

import argparse
import tomllib
from typing import Any

from . import _sweep
from ._cli import Commands, bar_is_shown, saved_when_terminated, whole_above_0
from ._errors import ArgumentError, Error

HELP = """\
All combinations of the values are run. Keys: config.NAME, run.NAME, TABLE.NAME, or TABLE.NUMBER.NAME where there are several.

  python3 -m granperi sweep collapse.toml --set config.spacing=0.005,0.0025 --set column.height=0.05,0.1

The directory then has a scene file, a result, a checkpoint and a log per point, and the table sweep.csv. Say the same once
more to go on with what was interrupted. To run the points by other means, GNU parallel or a batch system:

  python3 -m granperi sweep collapse.toml --set config.spacing=0.005,0.0025 --prepare
  (cd sweep; parallel python3 -m granperi run {} --resume :::: points.txt)
  python3 -m granperi sweep --collect
"""


def _values(text: str) -> tuple[str, list[Any]]:
    """KEY=VALUE,VALUE: numbers, true and false, texts with or without quotation marks."""
    key, equals, values = text.partition("=")
    if not (key and equals and values):
        raise argparse.ArgumentTypeError(f"{text!r}: expected KEY=VALUE,VALUE, as config.spacing=0.005,0.0025")
    try:
        return key, tomllib.loads(f"values = [{values}]")["values"]
    except tomllib.TOMLDecodeError:
        return key, [_value(value.strip()) for value in values.split(",")]


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _sweep_scene(options: argparse.Namespace) -> None:
    if options.collect:
        if options.scene or options.set:
            raise ArgumentError("--collect: takes the directory only, as it reads what was run: no scene, no --set")
        print(_sweep.collect(options.directory))
        return
    if not options.scene or not options.set:
        raise ArgumentError("sweep: expected a scene file and at least one --set KEY=VALUE,VALUE")
    parameters = dict(options.set)
    if len(parameters) < len(options.set):
        raise ArgumentError("--set: a key stands twice: expected all of its values in one, KEY=VALUE,VALUE")
    if options.prepare:
        names = _sweep.prepare(options.scene, parameters, options.directory, options.overwrite)
        print(f"{len(names)} scenes in {options.directory}, their names in {options.directory}/points.txt")
        return
    with saved_when_terminated("the same command goes on"):
        table = _sweep.sweep(options.scene, parameters, options.directory, options.workers,
                             bar_is_shown(options), options.overwrite)
    print(table)
    print(f"table in {options.directory}/sweep.csv")
    if table.failed:
        raise Error(f"{len(table.failed)} of {len(table)} points have no result, {table.failed[0]['point']}: "
                    f"{table.failed[0]['status']}")


def add(commands: Commands) -> None:
    sweep = commands.add("sweep", _sweep_scene, "Runs a scene file with many values beside each other; one table of the results.",
                         epilog=HELP, formatter_class=argparse.RawDescriptionHelpFormatter)
    sweep.add_argument("scene", nargs="?", help="scene file (TOML)")
    sweep.add_argument("--set", type=_values, action="append", default=[], metavar="KEY=VALUE,VALUE", help="once per parameter")
    sweep.add_argument("--directory", default="sweep", help="[sweep]")
    sweep.add_argument("--workers", type=whole_above_0, help="runs at a time [processors / threads of the scene]")
    sweep.add_argument("--overwrite", action="store_true", help="delete results of points whose scene is another by now")
    what = sweep.add_mutually_exclusive_group()
    what.add_argument("--prepare", action="store_true", help="write the scene files, run nothing")
    what.add_argument("--collect", action="store_true", help="make the table of what was run")
    sweep.add_argument("--progress", action=argparse.BooleanOptionalAction, default=None,
                       help="a progress bar [where stderr is a terminal]")
