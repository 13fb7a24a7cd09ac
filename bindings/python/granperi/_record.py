"""A run of a scene into a result file of which nothing is ever lost: written beside its place, resumed, not replaced unasked."""
from __future__ import annotations

import contextlib
import fcntl
import math
import os
import shutil
import tempfile
import time
from typing import TYPE_CHECKING, Any, Iterator

import numpy as np

from ._checkpoint import scene_in
from ._errors import ArgumentError, Error, FileError, StateError, UnsupportedError, number
from ._library import has_feature
from ._objects import Config
from ._progress import require_tqdm
from ._result import Result
from ._simulation import Simulation
from ._state import History

if TYPE_CHECKING:
    from ._probe import Probe

CHECKPOINT_SECONDS = 60.0
GO_ON = "go on with it by resume=True (--resume)"
ANEW = "run it anew by overwrite=True (--overwrite)"


class Place:
    """Where a result is to be, and the directory beside it in which it is until the run is complete.

        collapse.h5        the result; beside it collapse.xdmf (for ParaView), collapse.gpc (the checkpoint of its end)
        collapse.part/     the same three of a run that is going on, or was interrupted
    """

    def __init__(self, path: "str | os.PathLike[str]"):
        path = os.fspath(path)
        stem, extension = os.path.splitext(path)
        if not os.path.basename(path) or extension in (".xdmf", ".gpc", ".part") or os.path.isdir(path):
            raise ArgumentError(f"output = {path!r}: expected the name of a file for the result, such as collapse.h5")
        directory = os.path.dirname(path) or "."
        if not os.path.isdir(directory):
            raise FileError(f"{path}: the directory {directory} does not exist: make it, or name another output")
        if not os.access(directory, os.W_OK):
            raise FileError(f"{path}: the directory {directory} may not be written to: name another output")
        self.path, self.part = path, stem + ".part"
        self._names = [os.path.basename(name) for name in (path, stem + ".xdmf", stem + ".gpc")]
        self.checkpoint = stem + ".gpc"

    def in_part(self, name: str) -> str:
        return os.path.join(self.part, os.path.basename(name))

    def finish(self) -> None:
        """The complete run in its place, the result first: with it there, what is left to move belongs to it."""
        directory = os.path.dirname(self.path)
        for name in [*self._names, *sorted(set(os.listdir(self.part)) - {*self._names, "lock"})]:
            if os.path.exists(source := os.path.join(self.part, name)):
                os.replace(source, os.path.join(directory, name))

    def copy_to_part(self, series: list[str]) -> None:
        """The complete run once more beside its place, for it to be continued: whole copies or none, the result last."""
        files = [*(file for file in series if os.path.exists(file)), self.checkpoint, self.path]
        for source in files:
            shutil.copy2(source, self.in_part(source) + ".new")
        for source in files:
            os.replace(self.in_part(source) + ".new", self.in_part(source))

    @contextlib.contextmanager
    def locked(self) -> Iterator[int]:
        """One process at a time runs into this place: it, and who inherits what this gives, a file descriptor."""
        os.makedirs(self.part, exist_ok=True)
        lock = os.open(os.path.join(self.part, "lock"), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        try:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise StateError(f"{self.path}: another process runs into {self.part} just now: wait for it, or name another "
                                 "output") from None
            for name in os.listdir(self.part):
                if name.endswith(".new"):  # of a copy that was interrupted
                    os.remove(os.path.join(self.part, name))
            try:
                yield lock
            finally:
                if os.listdir(self.part) == ["lock"]:  # all is in its place, or nothing has been begun
                    shutil.rmtree(self.part, ignore_errors=True)
        finally:
            os.close(lock)


class _Saving:
    """with _Saving(sim, path): a checkpoint every so many seconds of wall-clock time, between two steps."""

    def __init__(self, sim: Simulation, path: str, seconds: float, probes: "list[tuple[Probe, str]]"):
        self._sim, self._path, self._seconds, self._probes = sim, path, seconds, probes

    def __enter__(self) -> "_Saving":
        self._before, self._next = self._sim._engine.on_look, time.monotonic() + self._seconds
        self._sim._engine.on_look = self._look
        return self

    def _look(self) -> None:
        if self._before is not None:
            self._before()
        if time.monotonic() >= self._next:
            self.save()

    def save(self) -> None:
        for probe, file in self._probes:
            probe.to_csv(file, overwrite=True)
        self._sim.save(self._path)
        self._next = time.monotonic() + self._seconds

    def __exit__(self, *error: object) -> None:
        self._sim._engine.on_look = self._before


def record_scene(scene: Any, path: "str | os.PathLike[str]", progress: bool, overwrite: bool, resume: bool,
                 checkpoint_seconds: float) -> History:
    """See Scene.record: scene is a Scene."""
    run = scene.run
    checkpoint_seconds = number("checkpoint", checkpoint_seconds)
    if not checkpoint_seconds > 0:
        raise ArgumentError(f"checkpoint = {checkpoint_seconds:g}: expected seconds of wall-clock time above 0")
    if overwrite and resume:
        raise ArgumentError("overwrite and resume: expected one of them: the first begins anew, the second goes on")
    if not has_feature("hdf5"):
        raise UnsupportedError("this build of the library has no HDF5 and writes no result files: run without an output")
    require_tqdm(progress)
    place = Place(path)
    with scene.build() as built:  # all mistakes in it are found before a file is touched
        probes = scene.add_probes(built)
        if not resume:
            with begun(place, overwrite, scene.probe_files(place.path)):
                return _recorded(scene, built, probes, place, progress, checkpoint_seconds)
        asked = _Asked(built)
    with place.locked():
        if os.path.exists(place.path) and not os.path.exists(place.in_part(place.path)):
            if len(os.listdir(place.part)) > 1:  # interrupted while it was put in its place
                place.finish()
            if not os.path.exists(place.checkpoint):
                raise FileError(f"{place.path} cannot be resumed: its checkpoint {place.checkpoint} is not there; "
                                f"{ANEW}, or name another output")
            asked.require_same(place, place.checkpoint, place.path)
            if _is_complete(_history_of(place.path), run.end, run.until):
                return _history_of(place.path)
            place.copy_to_part(scene.probe_files(place.path))
        if not os.path.exists(place.in_part(place.checkpoint)):  # interrupted before there was one
            empty(place.part)
            with scene.build() as sim:
                return _recorded(scene, sim, scene.add_probes(sim), place, progress, checkpoint_seconds)
        asked.require_same(place, place.in_part(place.checkpoint), place.in_part(place.path))
        with Simulation.load(place.in_part(place.checkpoint)) as sim:
            return _recorded(scene, sim, scene.add_probes(sim), place, progress, checkpoint_seconds, goes_on=True)


class _Asked:
    """What a run is of: it goes on with the scene that it was begun with; only its end and its frames may change."""

    def __init__(self, sim: Simulation):
        self._x, self._y = sim.x, sim.y
        with tempfile.TemporaryDirectory() as directory:  # as a checkpoint has it, in which sides are rounded to the spacing
            sim.save(path := os.path.join(directory, "asked.gpc"))
            self._scene = scene_in(path)

    def require_same(self, place: Place, checkpoint: str, result: str) -> None:
        there = scene_in(checkpoint)
        for name, here, other in zip(("config", "materials", "columns", "plates"), self._scene, there):
            if isinstance(here, Config) and isinstance(other, Config):
                keys = [key for key, value in other if getattr(here, key) != value and key != "threads"][:3]
                if keys:  # the results do not depend on the threads
                    self._refuse(place, f"{name} differs" + "".join(f"; {key} = {getattr(other, key)!r} there, "
                                                                    f"{getattr(here, key)!r} here" for key in keys))
            elif here != other:
                self._refuse(place, f"{name} differ")
        with Result(result) as frames:
            if len(frames) and not (np.array_equal(frames[0].x, self._x) and np.array_equal(frames[0].y, self._y)):
                self._refuse(place, "particles begin elsewhere")

    @staticmethod
    def _refuse(place: Place, what: str) -> None:
        raise ArgumentError(f"{place.path} cannot be resumed: it is of another scene, whose {what}; {ANEW}, or name another output")


@contextlib.contextmanager
def begun(place: Place, overwrite: bool, probe_files: list[str]) -> Iterator[int]:
    """Place.locked(), for a run from the start: nothing of an earlier one is beside it."""
    _require_new(place, overwrite, probe_files)
    with place.locked() as lock:
        empty(place.part)
        yield lock


def _require_new(place: Place, overwrite: bool, probe_files: list[str]) -> None:
    if overwrite:
        return
    if taken := [file for file in (place.path, *probe_files) if os.path.exists(file)]:
        raise FileError(f"{taken[0]} exists: name another output; {GO_ON}; {ANEW}, which replaces it when the new run is "
                        "complete")
    if os.path.isdir(place.part) and os.listdir(place.part) not in ([], ["lock"]):
        raise FileError(f"{place.part} has a run that was interrupted: {GO_ON}; {ANEW}")


def empty(directory: str) -> None:
    for name in os.listdir(directory):
        if name != "lock":
            os.remove(os.path.join(directory, name))


def _history_of(path: str) -> History:
    with Result(path) as result:
        return result.history


def _is_complete(history: History, end: float, until: str) -> bool:
    return bool(len(history)) and (history[-1].time >= end or until == "rest" and history[-1].at_rest)


def _recorded(scene: Any, sim: Simulation, probes: "list[Probe]", place: Place, progress: bool, seconds: float,
              goes_on: bool = False) -> History:
    run, path = scene.run, place.in_part(place.path)
    series = [(probe, place.in_part(file)) for probe, file in zip(probes, scene.probe_files(place.path))]
    history, last_frame = History(), None
    saving = _Saving(sim, place.in_part(place.checkpoint), seconds, series)
    try:
        with sim.output(path, fields=run.fields, append=goes_on) as output:
            if goes_on:
                history, last_frame = _history_of(path), -math.inf
                for probe, file in series:
                    if os.path.exists(file):  # else it is new in the scene, and begins now
                        probe.read_csv(file)
            if len(history):
                last_frame = history[-1].time + 1e-9 * history[-1].dt
            try:
                with saving:
                    for state in output.write_each(sim._frames(run.end, run.every, progress, run.until == "rest", last_frame)):
                        history.append(state)
            except BaseException:
                with contextlib.suppress(Error):  # the disk may be full: what has gone wrong first is to be told
                    saving.save()
                raise
            saving.save()
    except Error:
        if sim.clock.step == 0:  # a mistake of the scene that only its first step finds
            empty(place.part)
        raise
    place.finish()
    return history
