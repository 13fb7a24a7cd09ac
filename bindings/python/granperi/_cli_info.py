"""python3 -m granperi info: of the library, of a scene file or of a result file."""
from __future__ import annotations

import argparse

import granperi

from ._cli import Commands, whole_above_0
from ._errors import ArgumentError
from ._result import Result
from ._scene import Scene

STEPS = "100"


def _steps(options: argparse.Namespace) -> int:
    """How many for the plan; 0: none asked for."""
    if options.plan is None:
        return 0
    if options.file is None and not options.plan.lstrip("+-").isdigit():  # info --plan scene.toml
        options.file, options.plan = options.plan, STEPS
    try:
        return whole_above_0(options.plan)
    except argparse.ArgumentTypeError as error:
        raise ArgumentError(f"--plan {error}") from None


def _info(options: argparse.Namespace) -> None:
    steps = _steps(options)
    if steps and (options.file is None or options.file.endswith((".h5", ".hdf5"))):
        raise ArgumentError("--plan: expected a scene file, whose plan it is")
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
        if steps:
            sim.step(steps)
            print(f"after {steps} steps, to {sim.time:.4g} s:")
        print(sim.plan())


def add(commands: Commands) -> None:
    info = commands.add("info", _info, "Version and features; the plan of a scene file; what is in a result file.")
    info.add_argument("file", nargs="?", help="scene file or result file")
    info.add_argument("--plan", nargs="?", const=STEPS, metavar="STEPS",
                      help="take so many steps of the scene first, so that the plan tells what each stage costs [100]")
