"""python3 -m granperi run: a scene file becomes a result file."""
from __future__ import annotations

import argparse
import os
import sys

from . import _mpi
from ._cli import Commands, bar_is_shown, saved_when_terminated
from ._errors import ArgumentError, Error
from ._objects import Config
from ._scene import Scene
from ._scene_tables import make_run
from ._simulation import Simulation
from ._tables import require_free


SCENE_HELP = """\
A scene file (TOML):

  [config]                 # gp_config; every key has a default
  spacing = 0.0025         # m
  [run]
  end = 1.0                # s
  every = 0.01             # s between frames
  until = "rest"           # over when it rests, at the latest at end ["end"]
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

  [[probe]]                # a time series beside the result (CSV)
  points = [[0.0, 0.01]]   # m
  fields = ["pressure"]
  plates = [0]             # loads on them
  every = 0.001            # s

Others: [[plate]] (gp_plate), [[wall]] (x, y_bottom, y_top, material), [[wall_line]] (points or file, closed, material),
[[particles]] (x, y, vx, vy), [[polygon]] (points or file), [[mask]] (file, x_min, y_min, width).

A run is written into a directory beside its place (collapse.part/ for collapse.h5) and moved there when it is complete.
A result that exists is neither replaced (--overwrite) nor gone on with (--resume) unless you say so. A checkpoint is
saved each minute, by Ctrl-C, SIGTERM and SIGHUP and at the end, from which --resume goes on with the same bits, also
with a run on several processes (--mpi N), then on one.
"""


def _output(options: argparse.Namespace, scene: Scene) -> str:
    output = options.output or scene.run.output or os.path.splitext(os.path.basename(options.scene))[0] + ".h5"
    return "" if output == "none" else output


def _replace(scene: Scene, name: str, value: "float | None") -> None:
    """What an option says in place of the scene file, which would be blamed for it."""
    if value is None:
        return
    try:
        Simulation(Config(**{name: value})).close()
    except Error as error:
        raise ArgumentError(str(error).replace(f"gp_config.{name} =", f"--{name}")) from None
    scene.config = scene.config.replace(**{name: value})


def _run(options: argparse.Namespace) -> None:
    scene = Scene.read(options.scene)
    if options.end is not None:
        scene.run.end = options.end
    if options.until is not None:
        scene.run.until = options.until
    for name in ("spacing", "threads"):
        _replace(scene, name, getattr(options, name))
    make_run(vars(scene.run))  # the check of what the options have changed
    output = scene.run.output = _output(options, scene)
    progress = bar_is_shown(options)
    if options.mpi is not None:
        if options.resume or options.csv or scene.run.until != "end" or scene.has_probes():
            raise ArgumentError("--mpi: expected no --resume, no --csv, no [[probe]] and until = \"end\"")
        quiet = not (options.progress if options.progress is not None else sys.stderr.isatty())
        with saved_when_terminated(_mpi.goes_on(options.mpi) if output else ""):
            _mpi.run(scene, options.mpi, output, options.overwrite, quiet)
        if output:
            print(f"frames in {output}")
        return
    if options.csv:
        require_free(options.csv, options.overwrite or options.resume)
    with saved_when_terminated("the same command with --resume goes on" if output else ""):
        history = scene.record(output, progress, overwrite=options.overwrite, resume=options.resume)
    last = history[-1]
    for name, unit in (("time", "s"), ("n_particles", ""), ("step", ""), ("peak_height", "m"), ("peak_x", "m"),
                       ("x_left", "m"), ("x_right", "m"), ("x_q05", "m"), ("x_q95", "m"), ("at_rest", ""),
                       ("energy_initial", "J/m"), ("kinetic", "J/m"), ("potential", "J/m"), ("dissipated", "J/m"),
                       ("energy_error", "J/m"), ("wall_seconds", "s")):
        print(f"{name:<16}{getattr(last, name):>14.6g} {unit}".rstrip())
    if scene.run.until == "rest" and not last.at_rest:
        print(f"granperi: still moves at the end, {last.time:g} s: --end with a later time and --resume go on", file=sys.stderr)
    if options.csv:
        history.to_csv(options.csv, overwrite=True)
        print(f"history in {options.csv}")
    if output:
        print(f"frames in {output}")


def add(commands: Commands) -> None:
    run = commands.add("run", _run, "Runs a scene file; the frames go to an HDF5 file.", epilog=SCENE_HELP,
                       formatter_class=argparse.RawDescriptionHelpFormatter)
    run.add_argument("scene", help="scene file (TOML)")
    run.add_argument("--output", help="HDF5 file, \"none\" for no file [that of the scene, or its name with .h5]")
    existing = run.add_mutually_exclusive_group()
    existing.add_argument("--overwrite", action="store_true", help="replace a result that exists, once the new one is complete")
    existing.add_argument("--resume", action="store_true",
                          help="go on with a run that was interrupted, or to a later --end; does nothing where all is done")
    run.add_argument("--end", type=float, help="end of the run, s [that of the scene]")
    run.add_argument("--until", choices=("end", "rest"), help="rest: over when the material rests [as the scene says]")
    run.add_argument("--spacing", type=float, help="m [that of the scene]")
    run.add_argument("--mpi", type=int, metavar="N",
                     help="on N processes, by mpiexec and granperi-mpi; without --resume, --csv and probes")
    run.add_argument("--threads", type=int, help="0: the OpenMP default [that of the scene]")
    run.add_argument("--csv", help="a file for the states at the frames, too")
    run.add_argument("--progress", action=argparse.BooleanOptionalAction, default=None,
                     help="a progress bar [where stderr is a terminal]")
