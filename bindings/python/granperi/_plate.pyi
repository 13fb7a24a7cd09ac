# Written by bindings/generate from include/granperi/gp.h and _plate.py. Do not edit.

from __future__ import annotations
import math
from typing import Any, Iterator, Literal, TypedDict, Unpack
import numpy as np
from ._enums import Fluidity, Wall
from ._errors import ArgumentError, ArgumentTypeError, doubles, number, refuse_masked
from ._objects import Parameters, _signed


class PlateValues(TypedDict, total=False):
    x0: float
    y0: float
    x1: float
    y1: float
    friction: Wall | int | Literal["no_slip", "free_slip", "coulomb"]
    wall_mu: float
    vx: float
    vy: float
    knot_t: Any
    knot_x: Any
    knot_y: Any
    normal_pressure: float
    mass_per_length: float
    point_x: Any
    point_y: Any
    pivot_x: float
    pivot_y: float
    omega: float
    knot_angle: Any
    surface_velocity: float
    fluidity: Fluidity | int | Literal["free", "zero"]
    points: Any


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
    x0: float
    """m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is on the right; the plate acts on material on that side only, so a plate wetted on both sides is two plates back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of both sides at their foot. The two ends differ"""
    y0: float
    """m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is on the right; the plate acts on material on that side only, so a plate wetted on both sides is two plates back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of both sides at their foot. The two ends differ"""
    x1: float
    """m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is on the right; the plate acts on material on that side only, so a plate wetted on both sides is two plates back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of both sides at their foot. The two ends differ"""
    y1: float
    """m, ends of the wetted line. The plate's body is on the left of the way from end 0 to end 1, material is on the right; the plate acts on material on that side only, so a plate wetted on both sides is two plates back to back, best a horizon apart: nearer to each other, a floor under both sees the mean of both sides at their foot. The two ends differ"""
    friction: Wall
    """one of "no_slip", "free_slip", "coulomb" ["no_slip"]"""
    wall_mu: float
    """Coulomb coefficient, for Wall.COULOMB only; >= 0 [0]"""
    vx: float
    """m/s, constant velocity; not with a table [0, 0]"""
    vy: float
    """m/s, constant velocity; not with a table [0, 0]"""
    knot_t: np.ndarray | None
    """s, shape (n_knots), strictly increasing"""
    knot_x: np.ndarray | None
    """m, shape (n_knots), displacement; linear between knots, at rest before and after"""
    knot_y: np.ndarray | None
    """m, shape (n_knots)"""
    normal_pressure: float
    """Pa, a load on the plate's back: the plate moves along its normal as a rigid body under this load and the material's reaction (its own weight is part of the load), and along its tangent as prescribed: vx, vy then have no normal part, and there is no table and no turn. Of a line of several points the straight way from the first to the last counts; a closed one bears no load. 0: all of the motion is prescribed [0]"""
    mass_per_length: float
    """kg/m2, inertia of a loaded plate per length; only with normal_pressure. 0: light, as half a spacing of the heaviest material: it follows its load at once. A heavy plate rings on confined material, which damps its slow motion little [0]"""
    point_x: np.ndarray | None
    """m, shape (n_points); body on the left of the way. Last point = first point: a closed line, as a drum (clockwise: material inside) or an obstacle (counter-clockwise) [None]"""
    point_y: np.ndarray | None
    """m, shape (n_points) [None]"""
    pivot_x: float
    """m, about this the plate turns, as a rigid body; it is displaced as the plate is. A plate that turns in a periodic scene is no longer, corner to corner, than the period [0, 0]"""
    pivot_y: float
    """m, about this the plate turns, as a rigid body; it is displaced as the plate is. A plate that turns in a periodic scene is no longer, corner to corner, than the period [0, 0]"""
    omega: float
    """rad/s, constant rate of turning, counter-clockwise; not with a table or a load [0]"""
    knot_angle: np.ndarray | None
    """rad, shape (n_knots), counter-clockwise, as knot_x; knot_x and knot_y may then both be None, for none. None: the table does not turn the plate [None]"""
    surface_velocity: float
    """m/s, along the line from its first point to its last, of the wall's surface alone, which stays where it is: a belt, a turning roll. Not with Wall.FREE_SLIP [0]"""
    fluidity: Fluidity
    """one of "free", "zero", of materials with nonlocal_amplitude ["free"]"""

    def __init__(
        self,
        *,
        x0: float = ...,
        y0: float = ...,
        x1: float = ...,
        y1: float = ...,
        friction: Wall | int | Literal["no_slip", "free_slip", "coulomb"] = ...,
        wall_mu: float = 0,
        vx: float = ...,
        vy: float = ...,
        knot_t: Any = ...,
        knot_x: Any = ...,
        knot_y: Any = ...,
        normal_pressure: float = 0,
        mass_per_length: float = 0,
        point_x: Any = ...,
        point_y: Any = ...,
        pivot_x: float = ...,
        pivot_y: float = ...,
        omega: float = 0,
        knot_angle: Any = ...,
        surface_velocity: float = 0,
        fluidity: Fluidity | int | Literal["free", "zero"] = ...,
        points: Any = ...,
    ) -> None: ...

    def replace(self, **values: Unpack[PlateValues]) -> Plate: ...

    def _set(self, name: str, value: Any) -> None: ...

    def _is_needed(self, name: str, given: dict[str, int]) -> bool: ...

    def _length_of(self, names: tuple[str, ...], lengths: dict[str, int]) -> int: ...

    @property
    def points(self) -> np.ndarray:
        """m, shape (n, 2): the line, also of a plate with two ends only."""
        ...

    @points.setter
    def points(self, value: Any) -> None: ...

    def placed(self, dx: float, dy: float, angle: float=0.0) -> np.ndarray:
        """The line when the plate is displaced and turned about its pivot, as Simulation.plate_load tells.

        Args:
            dx, dy: displacement, m.
            angle: turn, rad, counter-clockwise.

        Returns:
            m, shape (n, 2).

        Example:
            print(granperi.Plate.floor(0, 1).placed(0.0, 0.1))
        """
        ...

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
        ...

    @classmethod
    def floor(cls, x_left: float, x_right: float, y: float=0.0, **more: Unpack[PlateValues]) -> 'Plate':
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
        ...

    @classmethod
    def wall(cls, x: float, y_bottom: float, y_top: float, material: str='right', **more: Unpack[PlateValues]) -> 'Plate':
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
        ...

    @classmethod
    def gate(cls, x: float, height: float, lift_time: float, material: str='right', spacing: float=0.0025, **more: Unpack[PlateValues]) -> 'Plate':
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
        ...

    @classmethod
    def line(cls, points: Any, closed: bool=False, material: str='right', **more: Unpack[PlateValues]) -> 'Plate':
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
        ...

def _turned_round(x: np.ndarray, y: np.ndarray, material: str) -> bool:
    """Whether the material is on the left of the way through these points."""
    ...

def points_of(name: str, points: Any) -> tuple[np.ndarray, np.ndarray]:
    """x and y of points of the shape (n, 2), or the error on what is none."""
    ...
