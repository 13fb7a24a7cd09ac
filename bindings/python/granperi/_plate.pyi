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
    the parameter, and the point.

    It is at rest, or moves at vx, vy and turns at omega about its pivot; or by the table knot_t, knot_x, knot_y, knot_angle
    (displacements and turn since the start; knot_angle, or knot_x and knot_y, may be left out), or as the host says
    (Simulation.set_plate_motion), or under normal_pressure. The lengths n_points and n_knots are those of the arrays.

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
        """m, shape (n, 2): the line, also of a plate that has two ends only."""
        ...

    @points.setter
    def points(self, value: Any) -> None: ...

    def placed(self, dx: float, dy: float, angle: float=0.0) -> np.ndarray:
        """m, shape (n, 2): the line when the plate is displaced by dx, dy [m] and turned by angle [rad] about its pivot,
        as Simulation.plate_load tells.
        """
        ...

    def at(self, time: float) -> np.ndarray:
        """m, shape (n, 2): the line at this time [s], as far as the motion is prescribed."""
        ...

    @classmethod
    def floor(cls, x_left: float, x_right: float, y: float=0.0, **more: Unpack[PlateValues]) -> 'Plate':
        """A floor at the height y [m] from x_left to x_right [m], material above it."""
        ...

    @classmethod
    def wall(cls, x: float, y_bottom: float, y_top: float, material: str='right', **more: Unpack[PlateValues]) -> 'Plate':
        """An upright wall at x [m] with the material on its "left" or "right"."""
        ...

    @classmethod
    def gate(cls, x: float, height: float, lift_time: float, material: str='right', spacing: float=0.0025, **more: Unpack[PlateValues]) -> 'Plate':
        """A smooth upright gate on the floor y = 0 that is lifted with uniform acceleration.

        It clears the height [m] of its column within lift_time [s], and goes on until it is six spacings [m] above it.
        """
        ...

    @classmethod
    def line(cls, points: Any, closed: bool=False, material: str='right', **more: Unpack[PlateValues]) -> 'Plate':
        """A line through points [m], shape (n, 2). closed: on to the first point again, if the last is not that already.

        material: the side on which it is, "right" or "left" of the way (a profile of terrain from left to right has it on
        the left), of a closed line "inside" or "outside". The plate's own way has it on its right, so it may be the other
        one round: surface_velocity goes by the plate's.
        """
        ...

def _turned_round(x: np.ndarray, y: np.ndarray, material: str) -> bool:
    """Whether the material is on the left of the way through these points."""
    ...

def points_of(name: str, points: Any) -> tuple[np.ndarray, np.ndarray]:
    """x and y of points of the shape (n, 2), or the error on what is none."""
    ...
