"""Plate: floors, walls, gates, lines of any shape, and how they move."""
from __future__ import annotations

import math
from typing import Any

import numpy as np

from ._enums import Fluidity, Wall
from ._errors import ArgumentError, ArgumentTypeError, doubles, number, refuse_masked
from ._objects import Parameters, _signed


@_signed
class Plate(Parameters):
    """A floor, wall, gate, lid, or a line of any shape: a rigid body whose surface the material touches.

    Its line goes from (x0, y0) to (x1, y1), or through point_x, point_y, which points (shape (n, 2)) sets at once. floor,
    wall, gate and line make the usual ones, turned the right way. What the library refuses is an ArgumentError that names
    the parameter and the point.

    It is at rest, or moves at vx, vy and turns at omega about its pivot; or by the table knot_t, knot_x, knot_y, knot_angle
    (displacements and turn since the start; knot_angle, or knot_x and knot_y, may be left out), or follows the host
    (Simulation.set_plate_motion), or moves under normal_pressure. The lengths n_points and n_knots are those of the arrays.

    Each parameter with its unit, meaning, range and [default]:
    """

    _struct = "gp_plate"
    _enums = {"friction": Wall, "fluidity": Fluidity}
    _tables = {"n_knots": ("knot_t", "knot_x", "knot_y", "knot_angle"), "n_points": ("point_x", "point_y")}
    _also = ("points",)

    def _set(self, name: str, value: Any) -> None:
        if name == "points":
            x, y = (None, None) if value is None else points_of("gp_plate.points", value)
            super()._set("point_x", x)
            super()._set("point_y", y)
        else:
            super()._set(name, value)

    def _is_needed(self, name: str, given: dict[str, int]) -> bool:
        if name == "knot_angle":
            return False
        return name not in ("knot_x", "knot_y") or "knot_angle" not in given or "knot_x" in given or "knot_y" in given

    def _length_of(self, names: tuple[str, ...], lengths: dict[str, int]) -> int:
        n = super()._length_of(names, lengths)
        if n == 0 and "point_x" in names:  # 0 would stand for a plate without such a table
            raise ArgumentError("gp_plate.point_x has no values: expected 2 or more points")
        return n

    @property
    def points(self) -> np.ndarray:
        """m, shape (n, 2): the line, also of a plate with two ends only."""
        if self.point_x is not None and self.point_y is not None:
            return np.column_stack([self.point_x, self.point_y])
        return np.array([[self.x0, self.y0], [self.x1, self.y1]])

    @points.setter
    def points(self, value: Any) -> None:
        self._set("points", value)

    def placed(self, dx: float, dy: float, angle: float = 0.0) -> np.ndarray:
        """The line when the plate is displaced and turned about its pivot, as Simulation.plate_load tells.

        Args:
            dx, dy: displacement, m.
            angle: turn, rad, counter-clockwise.

        Returns:
            m, shape (n, 2).

        Example:
            print(granperi.Plate.floor(0, 1).placed(0.0, 0.1))
        """
        pivot = np.array([self.pivot_x, self.pivot_y])
        cosine, sine = math.cos(angle), math.sin(angle)
        turned = (self.points - pivot) @ np.array([[cosine, sine], [-sine, cosine]]) + pivot if angle else self.points
        return turned + np.array([dx, dy])

    def at(self, time: float) -> np.ndarray:
        """The line at a time, as far as the motion is prescribed.

        Args:
            time: s.

        Returns:
            m, shape (n, 2).

        Example:
            gate = granperi.Plate.gate(0.04, height=0.05, lift_time=0.1)
            print(gate.at(0.1)[:, 1].min(), "m above the floor")

        Restrictions:
            Where the host or a load has moved a plate, only Simulation.plate_load knows.
        """
        if self.knot_t is None:
            return self.placed(self.vx * time, self.vy * time, self.omega * time)
        return self.placed(*(0.0 if values is None else float(np.interp(time, self.knot_t, values))
                             for values in (self.knot_x, self.knot_y, self.knot_angle)))

    # ------------------------------------------------------------------------------------------- the usual ones

    @classmethod
    def floor(cls, x_left: float, x_right: float, y: float = 0.0, **more: Any) -> "Plate":
        """A level floor, material above it.

        Args:
            x_left, x_right: its ends, m, finite, in any order.
            y: its height, m, finite.
            **more: other parameters of Plate, such as friction.

        Returns:
            The Plate, to be added by Simulation.add_plate.

        Raises:
            ArgumentTypeError: a name that does not exist, or a value that is not a number.

        Example:
            sim.add_plate(granperi.Plate.floor(-1, 1, y=-0.2, friction="coulomb", wall_mu=0.3))
        """
        left, right = sorted((number("x_left", x_left), number("x_right", x_right)))
        return cls(**{"x0": right, "y0": y, "x1": left, "y1": y, **more})

    @classmethod
    def wall(cls, x: float, y_bottom: float, y_top: float, material: str = "right", **more: Any) -> "Plate":
        """An upright wall.

        Args:
            x: its place, m, finite.
            y_bottom, y_top: its ends, m, finite, in any order.
            material: "left" or "right", the side on which the material is.
            **more: other parameters of Plate, such as friction.

        Returns:
            The Plate, to be added by Simulation.add_plate.

        Raises:
            ArgumentTypeError: another material, a name that does not exist, or a value that is not a number.

        Example:
            sim.add_plate(granperi.Plate.wall(0.06, 0.0, 0.1, "left", friction="free_slip"))
        """
        if not isinstance(material, str) or material not in ("left", "right"):
            raise ArgumentTypeError(f"material = {material!r}: expected 'left' or 'right', the wetted side of the wall")
        ends = sorted((number("y_bottom", y_bottom), number("y_top", y_top)), reverse=material == "left")
        return cls(**{"x0": x, "y0": ends[0], "x1": x, "y1": ends[1], **more})

    @classmethod
    def gate(cls, x: float, height: float, lift_time: float, material: str = "right", spacing: float = 0.0025,
             **more: Any) -> "Plate":
        """A smooth upright gate on the floor y = 0 that is lifted with uniform acceleration.

        It clears the height of its column within lift_time, and goes on until it is six spacings above it.

        Args:
            x: its place, m, finite.
            height: of the column that it holds, m, finite, above 0.
            lift_time: s, finite, above 0.
            material: "left" or "right", the side on which the material is.
            spacing: of the simulation, m, finite, above 0.
            **more: other parameters of Plate, such as friction.

        Returns:
            The Plate, to be added by Simulation.add_plate.

        Raises:
            ArgumentError: height, lift_time or spacing not above 0.
            ArgumentTypeError: another material, or a value that is not a number.

        Example:
            sim.add_plate(granperi.Plate.gate(0.05, height=0.05, lift_time=0.1, material="left", spacing=0.01))
        """
        values = {"height": height, "lift_time": lift_time, "spacing": spacing}
        height, lift_time, spacing = (number(name, value) for name, value in values.items())
        for name, value in (("height", height), ("lift_time", lift_time), ("spacing", spacing)):
            if not 0 < value < math.inf:
                raise ArgumentError(f"{name} = {value:g}: expected a finite number > 0")
        clear = height + 6 * spacing
        part = np.arange(41) / 40
        plate = cls.wall(x, 0.0, clear, material, **{"friction": "free_slip", **more})
        return plate.replace(knot_t=part * (lift_time * math.sqrt(clear / height)), knot_x=0 * part,
                             knot_y=part * part * clear)

    @classmethod
    def line(cls, points: Any, closed: bool = False, material: str = "right", **more: Any) -> "Plate":
        """A line of any shape through points.

        The plate's line has the material on its right, so it may run against the order of the points: surface_velocity
        is along the plate's line.

        Args:
            points: m, shape (n, 2), n at least 2, finite.
            closed: back to the first point, if the last one is not there already.
            material: its side, "right" or "left" as seen along the points (a profile of terrain from left to right has it on
                the left), or "inside" or "outside" of a closed line.
            **more: other parameters of Plate, such as friction or omega.

        Returns:
            The Plate, to be added by Simulation.add_plate.

        Raises:
            ArgumentTypeError: points of another shape, another material.
            ArgumentError: "inside" or "outside" of a line that is not closed.

        Example:
            slope = granperi.Plate.line([[-0.5, 0.3], [0.0, 0.0], [0.5, 0.0]], material="left")
        """
        x, y = points_of("points", points)
        if closed and len(x) and (x[0] != x[-1] or y[0] != y[-1]):
            x, y = np.append(x, x[0]), np.append(y, y[0])
        if _turned_round(x, y, material):
            x, y = x[::-1], y[::-1]
        return cls(**{"point_x": x, "point_y": y, **more})


def _turned_round(x: np.ndarray, y: np.ndarray, material: str) -> bool:
    """Whether the material is on the left of the way through these points."""
    if isinstance(material, str) and material in ("right", "left"):
        return material == "left"
    if not isinstance(material, str) or material not in ("inside", "outside"):
        raise ArgumentTypeError(f"material = {material!r}: expected 'right' or 'left', the wetted side of the line, or "
                                "'inside' or 'outside' of a closed one")
    if not len(x) or x[0] != x[-1] or y[0] != y[-1]:
        raise ArgumentError(f"material = {material!r}: expected 'right' or 'left', as the line is not closed")
    x, y = x - x[0], y - y[0]  # a small line far from the origin keeps its digits
    area = np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])  # twice; > 0: counter-clockwise, the inside is on the left
    return bool(area > 0) == (material == "inside")


def points_of(name: str, points: Any) -> tuple[np.ndarray, np.ndarray]:
    """x and y of points of the shape (n, 2), or the error on what is none."""
    refuse_masked(name, points)
    try:
        array = np.asarray(points)
    except ValueError:  # rows of different lengths
        array = np.empty(0)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ArgumentTypeError(f"{name}: expected numbers of the shape (n, 2), one x and one y per point, got "
                                + (f"the shape {array.shape}" if array.size else f"{points!r:.80}"))
    return doubles(f"{name}[:, 0]", array[:, 0]), doubles(f"{name}[:, 1]", array[:, 1])
