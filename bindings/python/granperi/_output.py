"""Result files that the library writes."""
from __future__ import annotations

import os
from typing import Iterable, Iterator

from ._engine import Engine
from ._enums import field_bits, field_names
from ._errors import StateError, UnsupportedError, check, number, path_bytes, whole
from ._library import ffi, lib
from ._objects import _initialised
from ._state import State

DEFAULT_FIELDS = ("column", "position", "velocity", "pressure", "stress", "shear_rate", "inertial_number")


class Output:
    """An open HDF5 file of frames. `with` or close() closes it."""

    def __init__(self, engine: Engine, path, every, fields, compression, single_precision, append):
        self._engine = engine
        self.path = os.fspath(path) if isinstance(path, (str, bytes, os.PathLike)) else path
        encoded = path_bytes("path", path)
        struct = _initialised("gp_output")
        struct.every_seconds = number("gp_output.every_seconds", every)
        by_default = isinstance(fields, str) and fields == "default"
        struct.fields = field_bits(field_names(DEFAULT_FIELDS if by_default else fields))
        struct.compression = whole("gp_output.compression", compression, 32)
        struct.single_precision = whole("gp_output.single_precision", int(single_precision), 32)
        if append:
            if "append" not in dict(ffi.typeof("gp_output").fields):
                raise UnsupportedError("gp_output.append: this version of the library cannot go on with a file")
            struct.append = 1
        check(lib.gp_output_open(engine.sim, encoded, struct))
        engine.output_pid = os.getpid()

    @property
    def closed(self) -> bool:
        """Whether the file is closed."""
        return self._engine.output is not self

    def write(self) -> None:
        """Writes a frame of the present state.

        Raises:
            StateError: the output is closed.
            FileError: the file cannot be written, the disk is full.

        Example:
            with sim.output("by_hand.h5") as output:
                output.write()
        """
        with self._engine.locked("write") as engine:
            if self.closed:
                raise StateError(f"write: the output {self.path} is closed: write before, or open another one")
            check(lib.gp_output_write(engine.sim))

    def write_each(self, states: Iterable[State]) -> Iterator[State]:
        """Each state of Simulation.frames(), once its frame is written.

        Args:
            states: an iterable of State.

        Returns:
            An iterator of State.

        Raises:
            StateError: the output is closed.
            FileError: the file cannot be written, the disk is full.

        Example:
            with sim.output("each.h5") as output:
                for state in output.write_each(sim.frames(0.02, every=0.01)):
                    print(state.time)
        """
        for state in states:
            self.write()
            yield state

    def close(self) -> None:
        """Closes the file. Closing it twice does no harm.

        Raises:
            StateError: from inside the simulation's callback.
            FileError: what is left cannot be written.

        Example:
            output = sim.output("by_hand.h5")
            output.close()
        """
        if self.closed or self._engine.closed:
            return
        with self._engine.locked("close"):
            self._close_locked()

    def _close_locked(self) -> None:
        engine = self._engine
        engine.output = None
        try:
            check(lib.gp_output_close(engine.sim))
        except StateError:
            engine.output = self  # inside a callback: it is still open
            raise
        finally:
            if engine.output is None:
                engine.output_pid = 0

    def __enter__(self) -> "Output":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<granperi.Output {self.path}{', closed' if self.closed else ''}>"
