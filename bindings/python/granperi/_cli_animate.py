"""python3 -m granperi animate: a film of a result file."""
from __future__ import annotations

import argparse
import os

from ._cli import Commands


def _animate(options: argparse.Namespace) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from . import plot

    output = options.output or os.path.splitext(os.path.basename(options.result))[0] + ".gif"
    plot.animate(options.result, output, options.what, fps=options.fps)
    print(output)


def add(commands: Commands) -> None:
    animate = commands.add("animate", _animate, "Makes an animation of a result file: MP4 (needs ffmpeg) or GIF (needs Pillow).")
    animate.add_argument("result", help="HDF5 file")
    animate.add_argument("what", nargs="?", default="speed", help="a field [speed]")
    animate.add_argument("--output", help=".mp4 or .gif [RESULT.gif]")
    animate.add_argument("--fps", type=int, default=20, help="pictures per second")
