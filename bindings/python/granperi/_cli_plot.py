"""python3 -m granperi plot: a picture of a result file."""
from __future__ import annotations

import argparse
import os

from ._cli import Commands
from ._errors import ArgumentError, near_match
from ._result import Result


def _plot(options: argparse.Namespace) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from . import plot

    pictures = plot.known_pictures()
    if options.what not in pictures:
        raise ArgumentError(f"picture '{options.what}': {near_match(options.what, pictures)}")
    output = options.output or f"{os.path.splitext(os.path.basename(options.result))[0]}_{options.what}.png"
    with Result(options.result) as result:
        axes = pictures[options.what](result, options.time)
        try:
            axes.figure.savefig(output, dpi=options.dpi)
        except ValueError as error:
            raise ArgumentError(f"{output}: {error}") from None
    print(output)


def add(commands: Commands) -> None:
    plot = commands.add("plot", _plot, "Draws a result file.")
    plot.add_argument("result", help="HDF5 file")
    plot.add_argument("what", nargs="?", default="speed",
                      help="speed, pressure, inertial_number, yielded, any other field, surface, interface, energy, fronts "
                           "[speed]")
    plot.add_argument("--time", type=float, help="s [the last frame]")
    plot.add_argument("--output", help="picture, .png, .pdf or .svg [RESULT_WHAT.png]")
    plot.add_argument("--dpi", type=int, default=110)
