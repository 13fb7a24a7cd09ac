"""A scene on several processes: by the program granperi-mpi."""
from __future__ import annotations

import os
import shutil
import subprocess
import tempfile

from ._errors import ArgumentError, UnsupportedError
from ._scene import Scene


def run(scene: Scene, ranks: int, output: str) -> None:
    """Runs a scene as its table [run] says, on so many processes; the frames go to `output`."""
    if ranks < 1:
        raise ArgumentError(f"--mpi {ranks}: expected a number of processes, 1 or more")
    if scene.run.fields != "default":
        raise ArgumentError(f"fields = {scene.run.fields!r}: with --mpi expected \"default\"")
    program, mpiexec = shutil.which("granperi-mpi"), shutil.which("mpiexec")
    if program is None or mpiexec is None:
        missing = "granperi-mpi (build and install granperi with -DGRANPERI_MPI=ON)" if program is None else "mpiexec (openmpi-bin)"
        raise UnsupportedError(f"--mpi needs the program {missing}, which is not in PATH")
    with tempfile.TemporaryDirectory() as folder:
        start = os.path.join(folder, "start.h5")
        with scene.build() as sim:
            sim.save(start)
        command = [mpiexec, "-n", str(ranks), program, start, "--end", repr(float(scene.run.end))]
        if output:
            command += ["--output", output, "--every", repr(float(scene.run.every))]
        status = subprocess.run(command).returncode
    if status:
        raise SystemExit(status)
