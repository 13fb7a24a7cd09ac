"""python -m granperi run: a scene file becomes a result file."""
from __future__ import annotations

import argparse
import os
import sys

from ._cli import Commands
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


def add(commands: Commands) -> None:
    run = commands.add("run", _run, "Runs a scene file; the frames go to an HDF5 file.", epilog=SCENE_HELP,
                       formatter_class=argparse.RawDescriptionHelpFormatter)
    run.add_argument("scene", help="scene file (TOML)")
    run.add_argument("--output", help="HDF5 file, \"none\" for no file [that of the scene, or its name with .h5]")
    run.add_argument("--end", type=float, help="end of the run, s [that of the scene]")
    run.add_argument("--spacing", type=float, help="m [that of the scene]")
    run.add_argument("--threads", type=int, help="0: the OpenMP default [that of the scene]")
    run.add_argument("--progress", action=argparse.BooleanOptionalAction, default=None,
                     help="a progress bar [where stderr is a terminal]")
