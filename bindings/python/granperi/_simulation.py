"""Simulation: a scene, its run, what is read from it, and its files."""
from __future__ import annotations

import os
import tempfile
from typing import Any

from ._checkpoint import scene_in
from ._errors import FileError, check, path_bytes
from ._frames import end_of
from ._library import ffi, lib
from ._objects import Config, Material
from ._output import Output
from ._progress import require_tqdm
from ._simulation_running import SimulationRunning
from ._state import History
from ._timer import interval


class Simulation(SimulationRunning):
    """A granular flow in two dimensions.

        with granperi.Simulation(spacing=0.0025) as sim:
            sim.add_column(x_min=-0.04, width=0.08, height=0.05)
            sim.add_plate(granperi.Plate.floor(-0.3, 0.3))
            sim.run(1.0)
            print(sim.state.peak_height)

    All quantities are in SI units. What you read is a copy, in the order in which particles were added, unless you ask for
    a view(). One simulation belongs to one thread at a time; a second thread gets StateError. Steps run without the
    GIL. Errors are subclasses of granperi.Error with the library's text.
    """

    def record(self, path: "str | os.PathLike[str]", t_end: float, every: float = 0.01, fields: Any = "default",
               progress: bool = False, until_rest: bool = False, **options: Any) -> History:
        """Runs with a frame in the HDF5 file `path` at the start, after the first step at or past each multiple of `every`, and at
        the end.

        See frames() and output(). An existing file is replaced, which Scene.record() refuses.

        Args:
            path: of the file; beside it a .xdmf file is written, for ParaView.
            t_end: s, finite, not before what the clock shows.
            every: s between two frames, finite, above 0.
            fields: names or groups; "default" is what the pictures need.
            progress: shows a bar (needs tqdm).
            until_rest: ends when the material rests.
            **options: compression, single_precision and append of output().

        Returns:
            The History of the states at the frames.

        Raises:
            ArgumentError: t_end before the clock, every not above 0, a field that does not exist.
            FileError: the file cannot be written.
            UnsupportedError: a library without HDF5.

        Example:
            history = sim.record("frames.h5", 0.05, every=0.01)
            print(history.time)
        """
        t_end, every = end_of(self, "t_end", t_end), interval(every)
        require_tqdm(progress)
        with self.output(path, fields=fields, **options) as output:
            return History(output.write_each(self._frames(t_end, every, progress, until_rest)))

    def output(self, path: "str | os.PathLike[str]", every: float = 0.0, fields: Any = "default", compression: int = 4,
               single_precision: bool = False, append: bool = False) -> Output:
        """Opens an HDF5 file of frames (H5MD, beside it .xdmf for ParaView); one at a time. A context manager.

        Args:
            path: of the file, which is replaced if it exists.
            every: s; above 0: a frame at the start and after the first step at or past each multiple. 0: by write() only.
            fields: names or groups; "default" is position, velocity, pressure, stress, shear_rate, inertial_number and column,
                which is what the pictures need.
            compression: 0 .. 9, of gzip; 0: none.
            single_precision: 32 bits instead of 64; positions keep 64, rounded to 1e-5 spacings.
            append: goes on with a file of this simulation, after load().

        Returns:
            The open Output.

        Raises:
            ArgumentError: a field that does not exist, every below 0, compression outside its range.
            FileError: the file cannot be written, or is not this simulation's (append).
            StateError: another output is open.
            UnsupportedError: a library without HDF5.

        Example:
            with sim.output("by_hand.h5", fields=["position", "pressure"]) as output:
                sim.run(0.02)
                output.write()
        """
        with self._engine.locked("output") as engine:
            engine.output = Output(engine, path, every, fields, compression, single_precision, append)
            return engine.output

    def save(self, path: "str | os.PathLike[str]") -> None:
        """Writes a checkpoint, from which load() goes on with the same bits.

        Args:
            path: of the file, which is replaced as a whole if it exists.

        Raises:
            FileError: it cannot be written; the old file is still there.
            UnsupportedError: a library without HDF5.

        Example:
            sim.save("state.gpc")

        Restrictions:
            Callback, probes and open output are not in it.
        """
        encoded = path_bytes("path", path)
        with self._engine.locked("save") as engine:
            check(lib.gp_save(engine.sim, encoded))

    @classmethod
    def load(cls, path: "str | os.PathLike[str]", config: Config | None = None) -> "Simulation":
        """Goes on from a checkpoint.

        Args:
            path: of a file that save() or the library in another language has written.
            config: that of the saved simulation; not given: it is read from the file (needs h5py).

        Returns:
            A Simulation, at the time and with the bits of the saved one.

        Raises:
            FileError: no such file, or not a checkpoint; the text says what to do.
            VersionError: a file of another version.
            UnsupportedError: a library without HDF5.

        Example:
            sim.save("state.gpc")
            with granperi.load("state.gpc") as again:
                again.run(0.02)
        """
        self = cls.__new__(cls)
        encoded = path_bytes("path", path)
        sim = _loaded(encoded)
        try:
            scene = (config.replace(), [Material()], [], []) if config is not None else scene_in(os.fsdecode(encoded))
            self._config = scene[0]
        except BaseException:
            lib.gp_destroy(sim)
            raise
        self._restore(sim)
        _, self._materials, self._columns, self._plates = scene
        return self

    def _restore(self, sim) -> None:
        self._start(sim)
        self._engine.watch.step = self.clock.step

    def __getstate__(self) -> dict[str, Any]:
        """For pickle and copy: the checkpoint, and what Python knows of the scene. Callback, output and views stay."""
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, "checkpoint")
            self.save(path)
            with open(path, "rb") as file:
                checkpoint = file.read()
        return {"checkpoint": checkpoint, "config": self._config, "materials": self._materials, "columns": self._columns,
                "plates": self._plates, "history": self.history.states}

    def __setstate__(self, kept: dict[str, Any]) -> None:
        self._config = kept["config"]
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, "checkpoint")
            with open(path, "wb") as file:
                file.write(kept["checkpoint"])
            self._restore(_loaded(os.fsencode(path)))
        self._materials, self._columns, self._plates = kept["materials"], kept["columns"], kept["plates"]
        self.history = History(kept["history"])


def _loaded(path: bytes):
    handle = ffi.new("gp_sim **")
    try:
        check(lib.gp_load_file(path, handle))
    except FileError as error:
        raise FileError(f"{error}{_what_instead(os.fsdecode(path))}") from None
    return handle[0]


def _what_instead(path: str) -> str:
    """What to do about a file that is no checkpoint."""
    if not os.path.exists(path):
        return "; sim.save() writes checkpoints, and Scene.record() does as NAME.gpc"
    if os.path.isfile(path) and not os.path.getsize(path):
        return "; it is empty: take an earlier checkpoint, or run anew"
    return "; frames of a result file are read by granperi.Result" if path.endswith((".h5", ".hdf5")) else ""
