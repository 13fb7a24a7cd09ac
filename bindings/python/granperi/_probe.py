"""Probes: time series of fields at points and of the loads on plates."""
from __future__ import annotations

import csv
import os
import weakref
from typing import TYPE_CHECKING, Any

import numpy as np

from ._derived import names_with_derived
from ._errors import ArgumentError, ArgumentTypeError, FileError, near_match, number, whole
from ._plate import points_of
from ._tables import as_html, write_csv
from ._timer import Timer, interval

if TYPE_CHECKING:
    from ._simulation_reading import SimulationReading

MEANS = ("fx", "fy", "torque_pivot")  # over the time since the sample before
IMPULSES = ("impulse_x", "impulse_y", "impulse_torque")
LOADS = (*MEANS, *IMPULSES, "dx", "dy", "angle")


class Probe:
    """Fields at points, and loads on plates, after the first step at or past each multiple of `every` [s].

        probe = sim.add_probe(points=[[0.0, 0.01]], fields="pressure", plates=[0], every=0.001)
        sim.run(1.0)
        probe.time, probe["pressure"], probe["fy"]

    It begins with the state from which the simulation goes on next, and does not change the run. A field at a point is the mean
    of the particles within `radius` [m], nearer ones with more weight, (1 - r2 / radius2)^2; NaN where there is none. fx, fy
    [N/m] and torque_pivot [N] are means over the time since the sample before (NaN in the first), so that no single grain dominates;
    impulse_x, impulse_y, impulse_torque, dx, dy and angle are those of Load.
    """

    def __init__(self, sim: "SimulationReading", points: Any, fields: Any, plates: Any, every: float, radius: float | None):
        x, y = points_of("points", np.empty((0, 2)) if points is None else points)
        self.points = np.column_stack([x, y])
        if not np.isfinite(self.points).all():
            raise ArgumentError("points: expected finite numbers, x and y in m")
        self.fields = names_with_derived(fields) if len(self.points) else ()
        plates = [plates] if isinstance(plates, (int, np.integer)) else plates
        try:
            self.plates = tuple(whole("plates", plate, 32) for plate in plates)
        except TypeError:
            raise ArgumentTypeError(f"plates = {plates!r:.80}: expected numbers of plates") from None
        if missing := [plate for plate in self.plates if not 0 <= plate < len(sim.plates)]:
            raise ArgumentError(f"plates: there is no plate {missing[0]}: the simulation has {len(sim.plates)}, counted from 0")
        if not len(self.points) and not self.plates:
            raise ArgumentError("a probe of nothing: expected points = [[x, y], ...], or the numbers of plates, or both")
        config = sim.config
        self.radius = 2 * config.spacing if radius is None else number("radius", radius)
        if not 0 < self.radius < np.inf:
            raise ArgumentError(f"radius = {self.radius:g}: expected a finite number above 0, in m")
        self._period = max(config.periodic_x_max - config.periodic_x_min, 0.0)
        self._sim = weakref.ref(sim)
        self._rows: list[np.ndarray] = []
        self._timer = Timer(interval(every), self._sample)
        sim._engine.timers.append(self._timer)

    # ----------------------------------------------------------------------------------------------- sampling

    def _sample(self) -> None:
        sim = self._sim()
        assert sim is not None  # it has called
        values = [sim.time, *self._fields_of(sim).ravel()]
        for plate in self.plates:
            load = sim.plate_load(plate)
            values += [np.nan] * len(MEANS) + [getattr(load, name) for name in LOADS[len(MEANS):]]
        row = np.array(values)
        self._rows.append(row)
        if len(self._rows) > 1:
            self._fill_means(self._rows[-2], row)

    def _fields_of(self, sim: "SimulationReading") -> np.ndarray:
        found = np.full((len(self.fields), len(self.points)), np.nan)
        if not found.size:
            return found
        particles = sim.particles("position", *self.fields)
        values = np.array([particles[name] for name in self.fields], dtype=float)
        for k, (x, y) in enumerate(self.points):
            dx, dy = particles.x - x, particles.y - y
            if self._period:
                dx -= self._period * np.round(dx / self._period)
            distance = np.hypot(dx, dy)
            near = np.flatnonzero(distance < self.radius)
            if len(near):
                weight = (1 - (distance[near] / self.radius) ** 2) ** 2
                found[:, k] = values[:, near] @ (weight / weight.sum())
        return found

    def _fill_means(self, before: np.ndarray, row: np.ndarray) -> None:
        for plate in range(len(self.plates)):
            begin = 1 + len(self.fields) * len(self.points) + plate * len(LOADS)
            means, impulses = (slice(begin + at, begin + at + len(MEANS)) for at in (0, len(MEANS)))
            row[means] = (row[impulses] - before[impulses]) / (row[0] - before[0])

    # ------------------------------------------------------------------------------------------------ reading

    @property
    def time(self) -> np.ndarray:
        """s, shape (number of samples)"""
        return np.array([row[0] for row in self._rows])

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, name: str) -> np.ndarray:
        """A field, shape (samples, points), or a part of the loads, shape (samples, plates)."""
        n, rows = len(self.points), np.array(self._rows).reshape(len(self._rows), len(self.names))
        if name in self.fields:
            begin = 1 + self.fields.index(name) * n
            return rows[:, begin:begin + n]
        if self.plates and name in LOADS:
            return rows[:, 1 + len(self.fields) * n + LOADS.index(name)::len(LOADS)]
        raise KeyError(f"'{name}' is not here: {near_match(name, [*self.fields, *(LOADS if self.plates else ())])}")

    @property
    def names(self) -> list[str]:
        """The columns of the table: time, FIELD_POINT of each field and point, and PART_PLATE of each plate's load."""
        return ["time", *(f"{field}_{k}" for field in self.fields for k in range(len(self.points))),
                *(f"{part}_{plate}" for plate in self.plates for part in LOADS)]

    def to_csv(self, path: "str | os.PathLike[str]", overwrite: bool = False) -> None:
        """Writes the table as CSV.

        Args:
            path: of the file.
            overwrite: replaces a file that exists.

        Raises:
            FileError: the file exists, and overwrite is false; or it cannot be written.

        Example:
            probe = sim.add_probe(plates=[0], every=0.005)
            sim.run(0.02)
            probe.to_csv("floor.csv", overwrite=True)
        """
        write_csv(path, self.names, self._rows, overwrite)

    def read_csv(self, path: "str | os.PathLike[str]") -> None:
        """Takes over the samples that to_csv() has written, up to the simulation's time.

        Args:
            path: of the file.

        Raises:
            FileError: it cannot be read, or has other columns.

        Example:
            probe = sim.add_probe(plates=[0], every=0.005)
            sim.run(0.02)
            probe.to_csv("floor.csv", overwrite=True)
            probe.read_csv("floor.csv")
        """
        sim = self._sim()
        assert sim is not None
        try:
            with open(path, encoding="utf-8", newline="") as file:
                lines = list(csv.reader(file))
            if lines[:1] != [self.names]:
                raise ValueError("it has other columns")
            for k, line in enumerate(lines, 1):
                if len(line) != len(self.names):
                    raise ValueError(f"line {k} has {len(line)} values: expected {len(self.names)}")
            rows = (np.array([float(cell) for cell in line]) for line in lines[1:])
            self._rows = [row for row in rows if row[0] <= sim.time]
        except (OSError, ValueError, csv.Error) as error:
            raise FileError(f"{os.fspath(path)}: cannot be continued: {error}") from None
        if self._rows:
            self._timer.skip(self._rows[-1][0] + 1e-9 * sim.clock.dt)

    def remove(self) -> None:
        """Ends the sampling; the samples so far stay.

        Example:
            probe = sim.add_probe(plates=[0], every=0.005)
            sim.run(0.02)
            probe.remove()
        """
        sim = self._sim()
        if sim is not None and self._timer in sim._engine.timers:
            sim._engine.timers.remove(self._timer)

    def __repr__(self) -> str:
        return f"<granperi.Probe of {len(self.points)} points and {len(self.plates)} plates: {len(self)} samples>"

    def _repr_html_(self) -> str:
        rows = self._rows if len(self) <= 20 else [*self._rows[:10], *self._rows[-10:]]
        return as_html(self.names, rows, repr(self)[1:-1])
