"""Result files that the library writes, and what Python adds to them when they are closed."""
from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from ._engine import Engine, log
from ._enums import field_bits, field_names
from ._errors import Error, StateError, UnsupportedError, check, number, path_bytes, whole
from ._library import ffi, lib
from ._objects import _initialised
from ._state import _STATE_NAMES, State, read_state

if TYPE_CHECKING:
    from ._simulation import Simulation

DEFAULT_FIELDS = ("column", "position", "velocity", "pressure", "stress", "shear_rate", "inertial_number")


class Output:
    """An open HDF5 file of frames. `with` or close() closes it.

    When it is closed, the states at the frames that write() has written go into the file's group /observables (H5MD), and
    the scene's parameters into /parameters, attribute "scene" (JSON): so pictures of the energy and of what yields can
    be drawn from the file alone. This needs h5py; without it the file is as the library writes it.
    """

    def __init__(self, sim: "Simulation", engine: Engine, path, every, fields, compression, single_precision,
                 append):
        self._sim: "Simulation | None" = sim
        self._engine = engine
        self.path = os.fspath(path) if isinstance(path, (str, bytes, os.PathLike)) else path
        encoded = path_bytes("path", path)
        struct = _initialised("gp_output")
        struct.every_seconds = number("gp_output.every_seconds", every)
        by_default = isinstance(fields, str) and fields == "default"
        struct.fields = field_bits(field_names(DEFAULT_FIELDS if by_default else fields))
        struct.compression = whole("gp_output.compression", compression, 32)
        struct.single_precision = whole("gp_output.single_precision", int(single_precision), 32)
        before: list[State] = []
        if append:
            if "append" not in dict(ffi.typeof("gp_output").fields):
                raise UnsupportedError("gp_output.append: this version of the library cannot go on with a file")
            struct.append = 1
            before = states_in(self.path)
        check(lib.gp_output_open(engine.sim, encoded, struct))
        engine.output_pid = os.getpid()
        step = read_state(engine.sim).step if before else 0
        self._states = [state for state in before if state.step <= step]

    @property
    def closed(self) -> bool:
        return self._sim is None or self._sim._output is not self

    def write(self) -> None:
        """Writes a frame of the present state."""
        with self._engine.locked("write") as engine:
            if self.closed:
                raise StateError(f"write: the output {self.path} is closed: write before, or open another one")
            check(lib.gp_output_write(engine.sim))
            self._states.append(read_state(engine.sim))

    def close(self) -> None:
        """Closes the file. Closing it twice does no harm."""
        if self.closed or self._engine.closed:
            return
        with self._engine.locked("close"):
            self._close_locked()

    def _close_locked(self) -> None:
        sim, self._sim = self._sim, None
        if sim is None:
            return
        try:
            check(lib.gp_output_close(self._engine.sim))
        except StateError:
            sim._output, self._sim = self, sim  # inside a callback: it is still open
            raise
        finally:
            if self._sim is None:
                sim._output = None
                self._engine.output_pid = 0
        add_to_file(self.path, self._states, describe(sim))

    def __enter__(self) -> "Output":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<granperi.Output {self.path}{', closed' if self.closed else ''}>"


def describe(sim: "Simulation") -> dict[str, Any]:
    """The scene as plain values: the material of each column, and where the plates began."""
    plain = lambda thing: {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in thing}
    return {"config": plain(sim._config), "materials": [plain(material) for material in sim._materials],
            "columns": [column if isinstance(column, int) else column.material for column in sim._columns],
            "plates": [plain(plate) for plate in sim._plates]}


def states_in(path) -> list[State]:
    """The states that Python has written into a file before; none if it has not."""
    from ._result import Result

    try:
        with Result(path) as result:
            return result.history.states
    except (Error, ImportError):
        return []  # the library says what is wrong with the file, if anything is


def add_to_file(path, states: list[State], scene: dict[str, Any]) -> None:
    try:
        import h5py
    except ImportError:
        log.info("%s: without h5py the file has no energies and no scene", path)
        return
    with h5py.File(path, "r+") as file:
        file["parameters"].attrs["scene"] = json.dumps(scene)
        # Of a file that was gone on with, some frames may have been taken back.
        steps = set(file["particles/all/position/step"][()].tolist())
        states = [state for state in states if state.step in steps]
        if not states:
            return
        if "observables" in file:
            del file["observables"]
        group = file.create_group("observables")
        step = group.create_dataset("step", data=np.array([state.step for state in states], dtype=np.int64))
        time = group.create_dataset("time", data=np.array([state.time for state in states]))
        time.attrs["unit"] = np.bytes_("s")
        for name in _STATE_NAMES:
            if name in ("time", "step"):
                continue
            element = group.create_group(name)
            element.create_dataset("value", data=np.array([getattr(state, name) for state in states], dtype=np.float64))
            element["step"], element["time"] = step, time  # hard links
