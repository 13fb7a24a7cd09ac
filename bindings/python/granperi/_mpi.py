"""A scene on several processes, by the program granperi-mpi; what it writes is kept as that of one process is (_record)."""
from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from typing import Iterator

from ._enums import field_names
from ._errors import ArgumentError, Error, UnsupportedError
from ._output import DEFAULT_FIELDS
from ._record import CHECKPOINT_SECONDS, Place, begun, empty
from ._result import Result
from ._scene import Scene


def goes_on(ranks: int) -> str:
    return f"the same command with --resume in place of --mpi {ranks} goes on"


def run(scene: Scene, ranks: int, output: str, overwrite: bool, quiet: bool) -> None:
    """Runs a scene as its table [run] says, on so many processes, with the result at `output` once it is complete ("": none)."""
    if ranks < 1:
        raise ArgumentError(f"--mpi {ranks}: expected a number of processes, 1 or more")
    program, mpiexec = shutil.which("granperi-mpi"), shutil.which("mpiexec")
    if program is None or mpiexec is None:
        missing = "granperi-mpi (build and install granperi with -DGRANPERI_MPI=ON)" if program is None else "mpiexec (openmpi-bin)"
        raise UnsupportedError(f"--mpi needs the program {missing}, which is not in PATH")
    place = Place(output) if output else None
    with contextlib.ExitStack() as stack:
        with scene.build() as sim:  # all mistakes in it are found before a file is touched
            folder, held = stack.enter_context(_folder(place, overwrite))
            name = "" if place is None else os.path.basename(place.checkpoint)[:-len("gpc")]
            start = os.path.join(folder, name + "start.gpc")
            stack.callback(_remove, start)
            sim.save(start)
        command = [mpiexec, "-n", str(ranks), program, start, "--end", repr(float(scene.run.end))]
        if quiet:
            command += ["--quiet"]
        if place is not None:
            fields = field_names(DEFAULT_FIELDS if scene.run.fields == "default" else scene.run.fields)
            command += ["--output", place.in_part(place.path), "--every", repr(float(scene.run.every)),
                        "--fields", ",".join(fields), "--end-frame", "--save", place.in_part(place.checkpoint),
                        "--checkpoint", repr(CHECKPOINT_SECONDS)]
        status = _status_of(command, held)
        _remove(start)
        if status == 0:
            if place is not None:
                place.finish()
            return
        if place is not None:
            _tell(place, ranks, status, os.path.exists(start + ".stopped"))
    raise SystemExit(status if status > 0 else 128 - status)


@contextlib.contextmanager
def _folder(place: "Place | None", overwrite: bool) -> "Iterator[tuple[str, tuple[int, ...]]]":
    """Where all nodes can read the start, as they do the result; and what mpiexec holds open, so that a run that outlives this process
    keeps the place locked."""
    if place is not None:
        with begun(place, overwrite, []) as lock:
            yield place.part, (lock,)
        return
    folder = tempfile.mkdtemp(prefix="granperi-", dir=".")
    try:
        yield folder, ()
    finally:
        with contextlib.suppress(OSError):  # it has the state that a signal or an error has left
            os.rmdir(folder)


def _remove(file: str) -> None:
    with contextlib.suppress(FileNotFoundError):
        os.remove(file)


def _status_of(command: list[str], held: tuple[int, ...]) -> int:
    """In a session of its own, so that Ctrl-C does not kill it; whatever interrupts this process makes all of it save and end."""
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, start_new_session=True, pass_fds=held)
    try:
        return process.wait()
    except BaseException:
        process.send_signal(signal.SIGUSR1)  # which mpiexec hands on
        try:
            process.wait()
        except BaseException:  # asked once more: at once
            process.terminate()
            process.wait()
        raise


def _tell(place: Place, ranks: int, status: int, stopped: bool) -> None:
    if os.path.exists(place.in_part(place.checkpoint)):
        if status != 2:  # of an error the program has said all
            print(f"granperi: {goes_on(ranks)}", file=sys.stderr)
    elif not stopped and _frames_of(place.in_part(place.path)) < 2:  # nothing has been computed
        empty(place.part)


def _frames_of(path: str) -> int:
    try:
        with Result(path) as result:
            return len(result)
    except Error:
        return 0
