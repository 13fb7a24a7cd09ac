"""Result files and their frames."""
from __future__ import annotations

import functools
import json
import os
from typing import TYPE_CHECKING, Any, Iterator, Mapping

import numpy as np

from ._enums import FIELD_NAMES, StepLimit
from ._errors import ArgumentError, ArgumentTypeError, FileError, StateError
from ._objects import Config
from ._plate import Plate
from ._simulation import Simulation
from ._snapshot import LiveSnapshot, Snapshot, period_of, within_period
from ._state import History, State
from ._tables import as_html

if TYPE_CHECKING:
    import h5py

HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"  # behind a block of text in a checkpoint
_VECTORS = {"x": ("position", 0), "y": ("position", 1), "vx": ("velocity", 0), "vy": ("velocity", 1)}


class FileSnapshot(Snapshot):
    """A frame of a result file."""

    def __init__(self, result: "Result", frame: int):
        self._result, self._frame = result, frame
        self.time, self.spacing = float(result.times[frame]), result.spacing
        self._sim: Simulation | None = None

    @property
    def state(self) -> State:
        return self._result._state(self._frame)

    def _read(self, name: str) -> np.ndarray:
        return self._result._read(name, self._frame)

    def _shape(self) -> Simulation:
        if self._sim is None:
            scene = self._result.scene
            # The scheme and its reach say which plates a particle is in contact with.
            known = {name: scene["config"].get(name.rstrip("_")) for name in Config.names()}
            config = {name: value for name, value in known.items() if value is not None}
            config |= {"spacing": self.spacing, "sound_speed": self._result.sound_speed, "threads": 1, "sleep": 0}
            sim = Simulation(**config)
            x, y = self.x, self.y
            x_min, length = period_of(scene["config"])
            if length > 0:  # particles return into the period now and then only, and none may be added beyond its ends
                x = np.clip(x - length * np.floor((x - x_min) / length), x_min, x_min + length)
            columns = self._read("column") if self._result.has("column") else np.zeros(len(x), int)
            for column in range(columns.max(initial=0) + 1):
                here = columns == column
                if here.any():  # there may be no particles at all; a column always has some
                    sim.add_particles(x[here], y[here])
            # The surface is mirrored at plates, and what is behind them is hidden. Plates that meet are one wall if
            # they move together, so each has a velocity that stands for its motion: by the scene, as the file does not
            # say which ones the host has driven.
            for line, motion in zip(self.plate_lines(), _motions(scene["plates"])):
                ends = {"points": line} if len(line) > 2 else dict(zip(("x0", "y0", "x1", "y1"), line.ravel()))
                sim.add_plate(**ends, vx=motion)
            self._sim = sim
        return self._sim

    def _friction_of_columns(self) -> np.ndarray:
        friction = np.array([values["mu_s"] for values in self._result.scene["materials"]]) * self._result.friction_factor
        return friction[self._result.scene["columns"]]

    def plate_lines(self) -> list[np.ndarray]:
        return within_period(self._result._plate_lines(self._frame), self._result.scene["config"])


class Result:
    """A result file (HDF5, H5MD layout), written from Python, C or Fortran.

        with granperi.Result("collapse.h5") as result:
            last = result[-1]
            print(last.time, last.field("speed").max())

    times [s] has the shape (number of frames). history has the states at the frames, scene the parameters of the scene.
    """

    def __init__(self, path: "str | os.PathLike[str]"):
        try:
            import h5py
        except ImportError:
            raise ImportError("result files are read with h5py (pip install h5py, or Debian's python3-h5py)") from None
        self.path = os.fspath(path)
        try:
            self._file: "h5py.File | None" = h5py.File(self.path, "r")
        except OSError as error:
            raise FileError(f"{self.path}: {_why_unreadable(self.path, error)}") from None
        try:
            self._particles = self._file["particles/all"]
            self.times: np.ndarray = self._particles["position/time"][()]
            attributes = self._file["parameters"].attrs
            self.spacing = float(attributes["spacing"])
            self.sound_speed = float(attributes["sound_speed"])
            self.friction_factor = float(attributes["friction_factor"])
            self.scene: dict[str, Any] = json.loads(self._file["parameters/scene"][()])
        except (KeyError, ValueError, TypeError, AttributeError) as error:
            what = _what_else(self._file)
            self._file.close()
            raise FileError(f"{self.path}: is no result file of granperi but {what}: expected a file that sim.record(), "
                            f"sim.output(), gp_output_open or python3 -m granperi run has written ({error})") from None

    @functools.cached_property
    def _plates(self) -> list[Plate]:
        return [Plate(**values) for values in self.scene["plates"]]

    def close(self) -> None:
        """Closes the file; closing it twice does no harm.

        Example:
            result = granperi.Result("collapse.h5")
            result.close()
        """
        if self._file is not None:
            self._file.close()
            self._file = None

    def __enter__(self) -> "Result":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def __len__(self) -> int:
        return len(self.times)

    def __getitem__(self, frame: int) -> FileSnapshot:
        try:
            return FileSnapshot(self, range(len(self))[frame])
        except IndexError:
            if not len(self):
                raise FrameError(f"{self.path} has no frames: the run that wrote it has ended before the first one; run it anew") \
                    from None
            raise FrameError(f"frame {frame}: {self.path} has {len(self)} frames") from None
        except TypeError:
            raise ArgumentTypeError(f"frame = {frame!r}: expected the number of a frame") from None

    def __iter__(self) -> Iterator[FileSnapshot]:
        return (self[k] for k in range(len(self)))

    def at(self, time: float) -> FileSnapshot:
        """The frame nearest to a time.

        Args:
            time: s.

        Returns:
            The Snapshot of that frame.

        Raises:
            ArgumentError: there is no frame within the usual distance of two frames.

        Example:
            with granperi.Result("collapse.h5") as result:
                print(result.at(0.02).field("speed").max(), "m/s")
        """
        if not len(self):
            return self[0]  # which says why there is none
        frame = int(np.argmin(np.abs(self.times - time)))
        usual = np.median(np.diff(self.times)) if len(self) > 1 else 0.0
        if not abs(self.times[frame] - time) <= usual + 1e-9:
            raise ArgumentError(f"time = {time:g} s: {self.path} has frames from {self.times[0]:g} to {self.times[-1]:g} s")
        return self[frame]

    def has(self, name: str) -> bool:
        """Whether the file has a field.

        Args:
            name: of a field of Field, in small letters.

        Returns:
            True or False.

        Example:
            with granperi.Result("collapse.h5") as result:
                print(result.has("viscosity"))
        """
        return _VECTORS.get(name, (name,))[0] in self._particles

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the fields in the file."""
        return tuple(name for name in FIELD_NAMES if self.has(name))

    def _read(self, name: str, frame: int) -> np.ndarray:
        self._open()
        if not self.has(name):
            raise ArgumentError(f"{self.path} has no field '{name}': it has {', '.join(self.fields)}; write it with "
                                "output(fields=...) or gp_output.fields")
        if name in _VECTORS:
            element, component = _VECTORS[name]
            return self._particles[element]["value"][frame, :, component].astype(np.float64)
        whole = self._particles[name]
        return whole["value"][frame].astype(np.float64) if "value" in whole else whole[()]

    @property
    def history(self) -> History:
        """The states at the frames. wall_seconds, which differs from run to run, is not in the file: NaN."""
        return History(self._state(frame) for frame in range(len(self)))

    def universe(self) -> Any:
        """An MDAnalysis.Universe of the particles and all frames, in m, m/s and s; resid is the column.

        Returns:
            The Universe, which reads from this file as long as that is open.

        Raises:
            ImportError: no MDAnalysis.
            StateError: the file is closed.

        Example:
            with granperi.Result("collapse.h5") as result:
                for at in result.universe().trajectory:
                    print(at.time)
        """
        try:
            from ._mdanalysis import universe
        except ImportError:
            raise ImportError("Universe is of MDAnalysis (pip install MDAnalysis, or Debian's python3-mdanalysis)") from None
        self._open()
        return universe(self)

    def _plate_lines(self, frame: int) -> list[np.ndarray]:
        file = self._open()
        if "walls" not in file:  # of 0.1: no more than the scene is known
            return [plate.at(float(self.times[frame])) for plate in self._plates]
        plate, points = file["walls/plate"][()], file[f"frames/{frame - frame % 256:06d}/{frame:06d}/walls"][:, :2]
        return np.split(points, np.flatnonzero(np.diff(plate)) + 1)

    def _open(self) -> "h5py.File":
        if self._file is None:
            raise StateError(f"{self.path} is closed: read within its with block, or open it anew")
        return self._file

    def _state(self, frame: int) -> State:
        values = self._open()["observables/state/value"]
        return _state_of(dict(zip((name.decode() for name in values.attrs["names"]), values[frame])))

    def _repr_html_(self) -> str:
        rows = [("frames", len(self)), *((("from", f"{self.times[0]:g} s"), ("to", f"{self.times[-1]:g} s")) if len(self) else ()),
                ("particles", len(self[0].x) if len(self) else 0), ("spacing", f"{self.spacing:g} m"),
                ("fields", ", ".join(self.fields))]
        return as_html((self.path, ""), rows)

    def __repr__(self) -> str:
        return f"<granperi.Result {self.path}: {len(self)} frames>"


# How a number in a file becomes a field of State, and what stands for one that is not there. Of whole numbers that is
# NaN as well, with which the arrays of a history are numbers; but NaN would count as true, and is no StepLimit.
_KINDS: dict[str, tuple[Any, Any]] = {"float": (float, float("nan")), "int": (int, float("nan")), "bool": (bool, None),
                                      "StepLimit": (lambda value: StepLimit(int(value)), None)}


def _state_of(values: Mapping[str, Any]) -> State:
    """The State of a frame, which lacks wall_seconds and what the version that wrote the file did not know."""
    def field(name: str, kind: str) -> Any:
        read, absent = _KINDS[kind]
        return read(values[name]) if name in values else absent

    return State(**{name: field(name, kind) for name, kind in State.__annotations__.items()})


def _motions(plates: list[dict[str, Any]]) -> list[int]:
    """A number for the motion of each plate of a scene, the same for those that move together (Plate::moves_with)."""
    numbers: dict[tuple[Any, ...], int] = {}

    def number(plate: int, values: dict[str, Any]) -> int:
        names = ["vx", "vy", "omega", "knot_t", "knot_x", "knot_y", "knot_angle"]
        if values.get("omega") or values.get("knot_angle"):
            names += ["pivot_x", "pivot_y"]
        alone = plate if values.get("normal_pressure") else None  # it moves by what it bears
        return numbers.setdefault((alone, *(str(values.get(name)) for name in names)), plate)

    return [number(plate, values) for plate, values in enumerate(plates)]


class FrameError(ArgumentError, IndexError):
    """A result file without the frame that is asked for."""


def _why_unreadable(path: str, error: OSError) -> str:
    if not os.path.exists(path):
        return "there is no such file: name the result file that a run has written"
    if os.path.isdir(path):
        return "is a directory: expected a result file in it" + (
            ", of a run that is going on or was interrupted" if path.rstrip("/").endswith(".part") else "")
    if os.path.getsize(path) == 0:
        return "is empty: the run that made it was stopped before its first frame, or the disk was full; run it anew"
    try:
        with open(path, "rb") as file:
            begin = file.read(8)
    except OSError as why:
        return f"cannot be read: {why.strerror}"
    if begin != HDF5_SIGNATURE:
        return "is no HDF5 file" + (": ParaView opens this one; here name the .h5 beside it" if path.endswith(".xdmf") else
                                    ": expected a result file (.h5), not a scene; python3 -m granperi run makes one of it"
                                    if path.endswith(".toml") else ": expected a result file (.h5)")
    return f"cannot be read as an HDF5 file, it may be cut off: {error}"


def _what_else(file: "h5py.File") -> str:
    if "bodies" in file and "config" in file:
        return "a checkpoint, from which granperi.load() goes on"
    return "an H5MD file of another program" if "h5md" in file else "another HDF5 file"


def snapshot(source: Any, time: float | None = None) -> Snapshot:
    """One look at a simulation (now), a result or its path (at this time [s], or the last frame), or a snapshot."""
    if isinstance(source, (str, os.PathLike)):
        source = Result(source)
    if isinstance(source, Result):
        return source[-1] if time is None else source.at(time)
    if time is not None:
        raise ArgumentError(f"time = {time}: only a result file can be looked at at another time than now")
    if isinstance(source, Simulation):
        return LiveSnapshot(source)
    if isinstance(source, Snapshot):
        return source
    raise ArgumentTypeError(f"{source!r:.80}: expected a Simulation, a Result, a Snapshot or the path of a result file")


def history(source: Any) -> History:
    """The states of a history, of a result or its path, or those that a simulation has kept in frames() or record()."""
    if isinstance(source, (str, os.PathLike)):
        with Result(source) as result:
            return history(result)
    if isinstance(source, Result):
        source[0]  # the error of a file without frames
        return source.history
    kept = source.history if isinstance(source, Simulation) else source
    if not isinstance(kept, History):
        raise ArgumentTypeError(f"{source!r:.80}: expected a Simulation, a History, a Result or the path of a result file")
    if len(kept) < 2:
        raise ArgumentError("there is no history to draw: run with `for state in sim.frames(t_end, every): ...` or "
                            "sim.record(...)")
    return kept
