"""python -m granperi: run a scene file, draw and compare results, ask what the library has."""
from __future__ import annotations

import argparse
import os
import sys
import types
import warnings
from typing import Any, Sequence

import granperi

from . import _cli_report, _compare
from ._errors import Error, near_match
from ._result import Result
from ._scene import Scene

SCENE_HELP = """\
A scene file (TOML):

  [config]                 # gp_config; every key has a default
  spacing = 0.0025         # m
  [run]
  end = 1.0                # s
  every = 0.01             # s between frames
  output = "collapse.h5"
  [[material]]             # any number; number 0 is glass beads
  name = "coarse"
  grain_diameter = 0.004   # m
  [[column]]               # m
  x_min = -0.04
  width = 0.08
  height = 0.05
  material = "coarse"
  [[floor]]
  x_left = -0.3
  x_right = 0.3
  [[gate]]                 # lifted with uniform acceleration
  x = 0.04
  height = 0.05            # m, that it clears in
  lift_time = 0.1          # s
  material = "left"        # side of the material

Others: [[plate]] (gp_plate), [[wall]] (x, y_bottom, y_top, material), [[particles]] (x, y, vx, vy).
"""


def _run(options: argparse.Namespace) -> None:
    scene = Scene.read(options.scene)
    if options.end is not None:
        scene.run.end = options.end
    if options.spacing is not None:
        scene.config = scene.config.replace(spacing=options.spacing)
    if options.threads is not None:
        scene.config = scene.config.replace(threads=options.threads)
    output = options.output or scene.run.output or os.path.splitext(os.path.basename(options.scene))[0] + ".h5"
    if output == "none":
        scene.run.output = output = ""
    history = scene.record(output or None, progress=options.progress if options.progress is not None
                           else sys.stderr.isatty() and _has_tqdm())
    last = history[-1]
    for name, unit in (("time", "s"), ("n_particles", ""), ("step", ""), ("peak_height", "m"), ("peak_x", "m"),
                       ("x_left", "m"), ("x_right", "m"), ("at_rest", ""), ("energy_initial", "J/m"), ("kinetic", "J/m"),
                       ("potential", "J/m"), ("dissipated", "J/m"), ("energy_error", "J/m"), ("wall_seconds", "s")):
        print(f"{name:<16}{getattr(last, name):>14.6g} {unit}".rstrip())
    if output:
        print(f"frames in {output}")


def _has_tqdm() -> bool:
    import importlib.util

    return importlib.util.find_spec("tqdm") is not None


def _plot(options: argparse.Namespace) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from . import plot

    pictures = plot.known_pictures()
    if options.what not in pictures:
        raise granperi.ArgumentError(f"picture '{options.what}': {near_match(options.what, pictures)}")
    output = options.output or f"{os.path.splitext(os.path.basename(options.result))[0]}_{options.what}.png"
    with Result(options.result) as result:
        axes = pictures[options.what](result, options.time)
        try:
            axes.figure.savefig(output, dpi=options.dpi)
        except ValueError as error:
            raise granperi.ArgumentError(f"{output}: {error}") from None
    print(output)


def _animate(options: argparse.Namespace) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from . import plot

    output = options.output or os.path.splitext(os.path.basename(options.result))[0] + ".gif"
    plot.animate(options.result, output, options.what, fps=options.fps)
    print(output)


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


def _info(options: argparse.Namespace) -> None:
    if options.file is None:
        print(f"granperi {granperi.__version__}")
        for feature in ("hdf5", "openmp"):
            print(f"{feature:<8}{'yes' if granperi.has_feature(feature) else 'no'}")
        levels = ("generic", "x86-64", "x86-64-v2", "x86-64-v3", "x86-64-v4")
        print(f"{'runs for':<10}{next(level for level in levels if granperi.has_feature(level))}")
        return
    if options.file.endswith((".h5", ".hdf5")):
        with Result(options.file) as result:
            print(f"{len(result)} frames from {result.times[0]:g} to {result.times[-1]:g} s" if len(result) else "no frames")
            print(f"{len(result[0].x) if len(result) else 0} particles, spacing {result.spacing:g} m")
            print(f"fields: {', '.join(result.fields)}")
        return
    scene = Scene.read(options.file)
    with scene.build() as sim:
        print(f"{scene!r}: {sim.n_particles} particles")
        print(f"{'':<9}{'name':<28}{'bytes':>12}  why")
        for entry in sim.plan():
            what = ("stage" if entry.kind == 0 else "field") if entry.active else "-"
            print(f"{what:<9}{entry.name:<28}{entry.bytes or '':>12}  {entry.reason}")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m granperi", description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True, metavar="command")

    def command(name: str, function: Any, help: str, **more: Any) -> argparse.ArgumentParser:
        one = commands.add_parser(name, help=help, description=help, **more)
        one.set_defaults(function=function)
        return one

    run = command("run", _run, "Runs a scene file; the frames go to an HDF5 file.", epilog=SCENE_HELP,
                  formatter_class=argparse.RawDescriptionHelpFormatter)
    run.add_argument("scene", help="scene file (TOML)")
    run.add_argument("--output", help="HDF5 file, \"none\" for no file [that of the scene, or its name with .h5]")
    run.add_argument("--end", type=float, help="end of the run, s [that of the scene]")
    run.add_argument("--spacing", type=float, help="m [that of the scene]")
    run.add_argument("--threads", type=int, help="0: the OpenMP default [that of the scene]")
    run.add_argument("--progress", action=argparse.BooleanOptionalAction, default=None,
                     help="a progress bar [where stderr is a terminal]")

    plot = command("plot", _plot, "Draws a result file.")
    plot.add_argument("result", help="HDF5 file")
    plot.add_argument("what", nargs="?", default="speed",
                      help="speed, pressure, inertial_number, yielded, any other field, surface, interface, energy, fronts "
                           "[speed]")
    plot.add_argument("--time", type=float, help="s [the last frame]")
    plot.add_argument("--output", help="picture, .png, .pdf or .svg [RESULT_WHAT.png]")
    plot.add_argument("--dpi", type=int, default=110)

    animate = command("animate", _animate, "Makes an animation of a result file: MP4 (needs ffmpeg) or GIF (needs Pillow).")
    animate.add_argument("result", help="HDF5 file")
    animate.add_argument("what", nargs="?", default="speed", help="a field [speed]")
    animate.add_argument("--output", help=".mp4 or .gif [RESULT.gif]")
    animate.add_argument("--fps", type=int, default=20, help="pictures per second")

    compare = command("compare", _compare_results, "Compares two result files.")
    compare.add_argument("first")
    compare.add_argument("second")
    compare.add_argument("--time", type=float, nargs="+", help="s, one or several [the last frames]")
    compare.add_argument("--picture", help="draws the two surfaces over each other")

    info = command("info", _info, "Version and features; the plan of a scene file; what is in a result file.")
    info.add_argument("file", nargs="?", help="scene file or result file")

    _cli_report.add(types.SimpleNamespace(add=command))
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Returns the exit status: 0, 1 for an error, 2 for wrong arguments, 130 after Ctrl-C."""
    options = _parser().parse_args(arguments)
    try:
        with warnings.catch_warnings():
            warnings.showwarning = lambda message, *more, **others: print(f"granperi: {message}", file=sys.stderr)
            options.function(options)
    except KeyboardInterrupt:
        print("granperi: interrupted", file=sys.stderr)
        return 130
    except (Error, ImportError, OSError) as error:
        print(f"granperi: {error}", file=sys.stderr)
        return 2 if isinstance(error, granperi.ArgumentError) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
