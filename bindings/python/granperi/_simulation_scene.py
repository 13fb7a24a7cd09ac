"""What a simulation is made of, and what the host drives."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping

import numpy as np

from ._errors import check, doubles, number, pointer, whole
from ._library import ffi, lib
from ._objects import Column, Config, Material, Parameters
from ._plate import Plate
from ._shapes import in_mask, in_polygon
from ._simulation_base import SimulationBase, taken

if TYPE_CHECKING:
    from typing import Unpack

    from ._objects import ColumnValues, MaterialValues
    from ._plate import PlateValues


class SimulationScene(SimulationBase):
    """A simulation's config, materials, columns, particles and plates."""

    @property
    def config(self) -> Config:
        """A copy of the parameters that the simulation was made with."""
        return self._config.replace()

    @property
    def materials(self) -> tuple[Material, ...]:
        """Copies of the materials, by number."""
        return tuple(material.replace() for material in self._materials)

    @property
    def plates(self) -> tuple[Plate, ...]:
        """Copies of the plates as they were added, by number."""
        return tuple(plate.replace() for plate in self._plates)

    def add_material(self, material: Material | None = None, **values: Unpack[MaterialValues]) -> int:
        """Adds a Material, or one of these parameters; returns its number. Material 0, glass beads, is always there.

        Args:
            material: its values; not given: those of the library, glass beads.
            **values: parameters of Material by keyword, over those of `material`.

        Returns:
            The number of the material, from 1 on, for add_column and the like.

        Raises:
            ArgumentError: a value out of range, or mu_2 below mu_s; the text names it.

        Example:
            sand = sim.add_material(mu_s=0.6, mu_2=0.9, grain_diameter=0.0005)
            sim.add_column(x_min=0.2, width=0.04, height=0.03, material=sand)

        Restrictions:
            Before the first step.
        """
        return self._add("material", Material, material, values, self._materials)

    def add_column(self, column: Column | None = None, **values: Unpack[ColumnValues]) -> int:
        """Adds a rectangle of particles; returns its number, which is the value of the field column.

        They are on the lattice of the spacing, the first half a spacing inside the lower left corner. Sides that are not whole
        numbers of spacings are rounded, with a warning.

        Args:
            column: its values; not given: those of Column.
            **values: parameters of Column by keyword, over those of `column`.

        Returns:
            The number of the column, from 0 on, counted together with sets of particles.

        Raises:
            ArgumentError: a side that is not above 0 or rounds to nothing, a material that does not exist, a place outside a
                period, more particles than 2147483646 in all.
            OutOfMemoryError: more particles than there is memory for.

        Example:
            number = sim.add_column(x_min=0.1, width=0.05, height=0.03)
            print((sim.column == number).sum(), "particles")

        Restrictions:
            Before the first step.
        """
        return self._add("column", Column, column, values, self._columns)

    def add_plate(self, plate: Plate | None = None, **values: Unpack[PlateValues]) -> int:
        """Adds a Plate, or one of these parameters: a floor, wall, gate, lid or line; returns its number.

        Args:
            plate: its values, or what Plate.floor, Plate.wall, Plate.gate and Plate.line make.
            **values: parameters of Plate by keyword, over those of `plate`.

        Returns:
            The number of the plate, from 0 on.

        Raises:
            ArgumentError: a line without length, tables of different lengths or times that do not increase, a value out of
                range; the text names the parameter, and the point.

        Example:
            lid = sim.add_plate(x0=-0.05, y0=0.055, x1=0.05, y1=0.055, normal_pressure=100)
            print(sim.plates[lid].normal_pressure, "Pa")

        Restrictions:
            Before the first step.
        """
        return self._add("plate", Plate, plate, values, self._plates)

    def _add(self, name: str, kind: type[Parameters], given: Any, values: Mapping[str, Any], kept: list) -> int:
        thing = taken(kind, given, values)
        number_out = ffi.new("int32_t *")
        with self._changing("add_" + name) as engine:
            struct, keep = thing._fill()
            check(getattr(lib, "gp_add_" + name)(engine.sim, struct, number_out))
            kept.append(thing)
        return number_out[0]

    def add_particles(self, x, y, vx=None, vy=None, material: int = 0) -> int:
        """Adds a set of particles; returns the set's number, which is the value of the field column.

        Each has the area of a spacing squared, and begins without pressure.

        Args:
            x, y: places, m, shape (n), n at least 1, finite.
            vx, vy: velocities, m/s, shape (n), finite; both, or none: at rest.
            material: number of the material, 0 to the number of materials - 1.

        Returns:
            The number of the set, from 0 on, counted together with columns.

        Raises:
            ArgumentTypeError: arrays of other shapes or of different lengths.
            ArgumentError: a value that is not finite, only one of vx and vy, a material that does not exist, places outside a
                period.

        Example:
            angle = np.linspace(0, 6, 20)
            ring = sim.add_particles(0.3 + 0.05 * np.cos(angle), 0.1 + 0.05 * np.sin(angle))

        Restrictions:
            Before the first step.
        """
        x = doubles("x", x)
        y = doubles("y", y, len(x))
        vx = None if vx is None else doubles("vx", vx, len(x))
        vy = None if vy is None else doubles("vy", vy, len(x))
        number_out = ffi.new("int32_t *")
        with self._changing("add_particles") as engine:
            check(lib.gp_add_particles(engine.sim, whole("material", material, 32), len(x), pointer(x), pointer(y),
                                       pointer(vx), pointer(vy), number_out))
            self._columns.append(int(material))
        return number_out[0]

    def add_polygon(self, points, material: int = 0, vx: float = 0.0, vy: float = 0.0) -> int:
        """Adds the particles inside a polygon; returns the set's number, as add_particles.

        They are on the lattice of a column of the polygon's extent, so a rectangle gives the same places as add_column; but
        they begin without pressure, as all sets of particles, and settle within the first instants. Where edges cross, what
        they enclose twice is outside.

        Args:
            points: corners, m, shape (n, 2), three or more, finite, in any order of turning; the first again at the end or not.
            material: number of the material, 0 to the number of materials - 1.
            vx, vy: velocity of all of them, m/s, finite.

        Returns:
            The number of the set, from 0 on, counted together with columns.

        Raises:
            ArgumentTypeError: points of another shape.
            ArgumentError: fewer than three corners, one that is not finite, or a polygon that holds no particle at this
                spacing.

        Example:
            heap = sim.add_polygon([[0.1, 0.0], [0.3, 0.0], [0.2, 0.08]])

        Restrictions:
            Before the first step.
        """
        return self._add_shape(*in_polygon(points, self._config.spacing), material, vx, vy)

    def add_mask(self, mask, x_min: float, y_min: float, width: float, material: int = 0, vx: float = 0.0,
                 vy: float = 0.0) -> int:
        """Adds the particles where a mask is true; returns the set's number, as add_particles.

        Its pixels are square; otherwise as add_polygon.

        Args:
            mask: true and false, or 1 and 0, shape (rows, columns), the first row at the top; or the path of an image (Pillow
                reads it), in which what is darker than half is material.
            x_min, y_min: lower left corner of the mask, m, finite.
            width: of all columns, m, finite, above 0.
            material: number of the material, 0 to the number of materials - 1.
            vx, vy: velocity of all of them, m/s, finite.

        Returns:
            The number of the set, from 0 on, counted together with columns.

        Raises:
            ArgumentTypeError: a mask of another shape, or of other values.
            ArgumentError: a length out of range, or a mask that holds no particle at this spacing.
            FileError: an image that cannot be read.
            ImportError: an image, and no Pillow.

        Example:
            number = sim.add_mask([[0, 1, 0], [1, 1, 1]], x_min=0.1, y_min=0.0, width=0.09)

        Restrictions:
            Before the first step.
        """
        return self._add_shape(*in_mask(mask, x_min, y_min, width, self._config.spacing), material, vx, vy)

    def _add_shape(self, x, y, material, vx, vy) -> int:
        vx, vy = number("vx", vx), number("vy", vy)
        return self.add_particles(x, y, np.full(len(x), vx), np.full(len(x), vy), material)

    def set_plate_velocity(self, plate: int, vx: float, vy: float) -> None:
        """Drives a plate at this velocity from now on, from where it is; possible at any time, also in a callback.

        Args:
            plate: number of the plate.
            vx, vy: m/s, finite.

        Raises:
            ArgumentError: a plate that does not exist, or a value that is not finite.

        Example:
            sim.set_plate_velocity(0, 0.0, -0.01)
            sim.run(sim.time + 0.01)
            print(sim.plate_load(0).dy, "m")
        """
        self._drive("set_plate_velocity", plate, vx, vy)

    def set_plate_motion(self, plate: int, vx: float, vy: float, omega: float) -> None:
        """The same for any rigid motion: the plate's pivot moves, and the plate turns about it.

        Args:
            plate: number of the plate.
            vx, vy: velocity of the pivot, m/s, finite.
            omega: rad/s, counter-clockwise, finite.

        Raises:
            ArgumentError: a plate that does not exist or is under a load, which does not turn; a value that is not finite.

        Example:
            sim.set_plate_motion(0, 0.0, 0.0, 0.5)
            sim.run(sim.time + 0.01)
            print(sim.plate_load(0).angle, "rad")
        """
        self._drive("set_plate_motion", plate, vx, vy, omega)

    def _drive(self, name: str, plate: int, *motion: float) -> None:
        values = [number(of, value) for of, value in zip(("vx", "vy", "omega"), motion)]
        with self._engine.locked(name) as engine:
            if engine.exports and not engine.running:
                engine.before_change(name)
            check(getattr(lib, "gp_" + name)(engine.sim, whole("plate", plate, 32), *values))

    def set_gravity(self, gx: float, gy: float) -> None:
        """Gravity from now on; possible at any time, also in a callback. Before the first step, and while no output is open, it
        replaces the config's.

        Args:
            gx, gy: m/s2, to the right and upwards, finite.

        Raises:
            ArgumentError: a value that is not finite.

        Example:
            sim.set_gravity(1.0, -9.76)
            sim.run(sim.time + 0.01)
            print(sim.state.gravity_x, "m/s2")

        Restrictions:
            The sound speed stays that of the first gravity; if it becomes too low, a warning says so: then set
            Config.sound_speed.
        """
        gx, gy = number("gx", gx), number("gy", gy)
        with self._engine.locked("set_gravity") as engine:
            if engine.exports and not engine.running:
                engine.before_change("set_gravity")
            check(lib.gp_set_gravity(engine.sim, gx, gy))
