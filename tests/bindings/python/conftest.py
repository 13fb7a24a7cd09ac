"""What the tests share. They run against the package of the build tree: PYTHONPATH=<build>/python."""
import dataclasses
import math
import os
import subprocess
import sys
from pathlib import Path

import matplotlib
import pytest

import granperi

matplotlib.use("Agg")

ROOT = Path(__file__).parents[3]
# Children leave the package's own directory as it is.
os.environ["PYTHONDONTWRITEBYTECODE"] = "1"


def block(**config):
    """A small block of 10 x 5 particles on a floor, with nothing around it."""
    sim = granperi.Simulation(**{"spacing": 0.01, "threads": 1, **config})
    sim.add_column(x_min=-0.05, width=0.1, height=0.05)
    sim.add_plate(granperi.Plate.floor(-0.5, 0.5))
    return sim


@pytest.fixture
def sim():
    with block() as simulation:
        yield simulation


@pytest.fixture
def make_block():
    return block


@pytest.fixture
def python():
    """Runs a program in an interpreter of its own: python("print(1)") or python("-m", "granperi", ...)."""

    def run(*arguments, **options):
        if len(arguments) == 1:
            arguments = ("-c", *arguments)
        return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, timeout=120, **options)

    return run


needs_hdf5 = pytest.mark.skipif(not granperi.has_feature("hdf5"), reason="the library has no HDF5")
needs_openmp = pytest.mark.skipif(not granperi.has_feature("openmp"), reason="the library has no threads")


def frames_in(path):
    """The number of frames that a run has written by now."""
    try:
        with granperi.Result(path) as result:
            return len(result)
    except granperi.FileError:
        return 0


def assert_same_state(kept, live):
    """All but the wall-clock time, which a file does not keep."""
    assert math.isnan(kept.wall_seconds)
    assert dataclasses.replace(kept, wall_seconds=0) == dataclasses.replace(live, wall_seconds=0)
