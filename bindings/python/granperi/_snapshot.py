"""One look at a simulation, as it is now, or at a frame of a result file (_result) alike."""
from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from ._derived import DERIVED, derived
from ._enums import FIELD_NAMES
from ._errors import ArgumentError, near_match
from ._simulation import Simulation
from ._state import State


class Snapshot:
    """Particles at one instant. The same for a simulation (as it is now) and a frame of a result file."""

    time: float
    spacing: float

    def field(self, name: str) -> np.ndarray:
        """A field of the particles at that instant, in the order of id.

        Args:
            name: of a field of Field, in small letters, or "speed" (m/s), "shear_stress" (Pa), "yielded" (bool).

        Returns:
            An array of shape (n). Units: those of Field.

        Raises:
            ArgumentError: a name that does not exist, or a field that the file does not have.

        Example:
            with granperi.Result("collapse.h5") as result:
                print(result[-1].field("pressure").max(), "Pa")
        """
        if name in DERIVED:
            return derived(name, self._read, self._friction_of_columns)
        if name not in FIELD_NAMES:
            raise ArgumentError(f"field {name!r} does not exist: {near_match(name, [*DERIVED, *FIELD_NAMES])}")
        return self._read(name)

    @property
    def x(self) -> np.ndarray:
        """m, shape (n)"""
        return self._read("x")

    @property
    def y(self) -> np.ndarray:
        """m, shape (n)"""
        return self._read("y")

    def _read(self, name: str) -> np.ndarray:
        raise NotImplementedError

    def _shape(self) -> Simulation:
        """A simulation of these particles and plates, which the library is asked for surface and interface."""
        raise NotImplementedError

    def _friction_of_columns(self) -> np.ndarray:
        raise NotImplementedError

    def plate_lines(self) -> list[np.ndarray]:
        """The line of each plate where it is now, as far as that is known.

        Returns:
            A list of arrays, m, shape (number of its points, 2); less whole periods, so that the middle of each is in
            the period.

        Example:
            with granperi.Result("collapse.h5") as result:
                print(result[-1].plate_lines()[0])
        """
        raise NotImplementedError

    @property
    def state(self) -> State:
        """Clock, energies, fronts and peak.

        In a frame wall_seconds is NaN; so is what the version that wrote the file did not know, but None for at_rest
        and dt_reason.
        """
        raise NotImplementedError

    def surface(self, x) -> np.ndarray:
        """Heights of the free surface.

        Args:
            x: stations, m, shape (n), finite.

        Returns:
            m, shape (n); 0 outside the fronts.

        Raises:
            ArgumentTypeError: another shape than (n).
            ArgumentError: a value that is not finite.

        Example:
            with granperi.Result("collapse.h5") as result:
                print(result[-1].surface([0.0, 0.02]))
        """
        return self._shape().surface(x)

    def interface(self, left: int, right: int, y) -> np.ndarray:
        """Positions of the interface of two columns.

        Args:
            left, right: numbers of two columns or sets of particles.
            y: heights, m, shape (n), finite.

        Returns:
            x in m, shape (n); NaN where they do not touch.

        Raises:
            ArgumentError: a column that does not exist, or the same one twice.
            ArgumentTypeError: another shape than (n).
        """
        return self._shape().interface(left, right, y)


class LiveSnapshot(Snapshot):
    """A simulation as it is now."""

    def __init__(self, sim: Simulation):
        self._sim, self.time, self.spacing = sim, sim.time, sim.config.spacing

    @property
    def state(self) -> State:
        return self._sim.state

    def _read(self, name: str) -> np.ndarray:
        return self._sim.field(name)

    def _shape(self) -> Simulation:
        return self._sim

    def _friction_of_columns(self) -> np.ndarray:
        return self._sim._friction_of_columns()

    def plate_lines(self) -> list[np.ndarray]:
        loads = [self._sim.plate_load(k) for k in range(len(self._sim._plates))]
        lines = [plate.placed(at.dx, at.dy, at.angle) for plate, at in zip(self._sim._plates, loads)]
        return within_period(lines, dict(self._sim._config))


def period_of(config: Mapping[str, Any]) -> tuple[float, float]:
    """Where the period begins, and its length, m; 0: there is none."""
    x_min = config.get("periodic_x_min", 0.0)
    return x_min, config.get("periodic_x_max", 0.0) - x_min


def within_period(lines: list[np.ndarray], config: Mapping[str, Any]) -> list[np.ndarray]:
    """Lines less whole periods, so that the middle of each is in the period.

    The library takes them off when it makes its lists anew: until then a line in a file may be beyond an end.
    """
    x_min, length = period_of(config)
    if not length > 0:
        return lines

    def within(line: np.ndarray) -> np.ndarray:
        middle = 0.5 * (line[:, 0].min() + line[:, 0].max())
        # What is at an end is at the left one, whichever way its place was rounded.
        return line - [length * np.floor((middle - x_min) / length + 1e-9), 0.0]

    return [within(line) for line in lines]
