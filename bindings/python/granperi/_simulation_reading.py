"""What is read from a simulation."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _state
from ._derived import DERIVED, derived, names_with_derived
from ._engine import Engine
from ._enums import FIELD_MEANINGS, FIELD_NAMES, Field, field_names
from ._errors import ArgumentError, check, doubles, pointer, whole
from ._library import ffi, lib
from ._simulation_scene import SimulationScene
from ._state import Clock, Load, Plan, State
from ._views import Particles, View

if TYPE_CHECKING:
    from numpy.typing import NDArray

_INTEGERS = {"id": np.int64, "column": np.int32}


class SimulationReading(SimulationScene):
    """State, fields, surface and loads of a simulation."""

    if TYPE_CHECKING:  # copies of the fields, shape (n), in the order of id; see the end of this file
        id: NDArray[np.int64]
        column: NDArray[np.int32]
        x: NDArray[np.float64]
        y: NDArray[np.float64]
        vx: NDArray[np.float64]
        vy: NDArray[np.float64]
        pressure: NDArray[np.float64]
        density: NDArray[np.float64]
        sxx: NDArray[np.float64]
        sxy: NDArray[np.float64]
        syy: NDArray[np.float64]
        shear_rate: NDArray[np.float64]
        inertial_number: NDArray[np.float64]
        viscosity: NDArray[np.float64]
        number_density: NDArray[np.float64]
        fluidity: NDArray[np.float64]
        speed: NDArray[np.float64]

    @property
    def state(self) -> State:
        """Clock, energy ledger, shape and rest at this instant."""
        with self._engine.locked("state") as engine:
            return _state.read_state(engine.sim)

    def state_parts(self, *, deposit: bool = False, marks: bool = False, drift: bool = False) -> State:
        """The state without what is slow to compute, except for the parts asked for; the fields of the others are NaN.

        Without any of them it costs 5 % of a time step, the whole state 1.5 to 2.5 steps.

        Args:
            deposit: x_left, x_right, peak_x, peak_height, detached.
            marks: x_q01 to x_q99.
            drift: volume_drift.

        Returns:
            A State.

        Example:
            print(sim.state_parts().at_rest, sim.state_parts(marks=True).x_q50)
        """
        parts = deposit * lib.GP_STATE_DEPOSIT | marks * lib.GP_STATE_MARKS | drift * lib.GP_STATE_DRIFT
        with self._engine.locked("state_parts") as engine:
            return _state.read_state(engine.sim, parts)

    @property
    def clock(self) -> Clock:
        """Time [s], last time step [s] and number of steps, at no cost: the state takes as long as a step or two."""
        with self._engine.locked("clock") as engine:
            return _state.read_clock(engine.sim)

    @property
    def time(self) -> float:
        """The clock, s."""
        return self.clock.time

    @property
    def quantiles(self) -> dict[float, float]:
        """Marks of the mass: x [m] that have 1, 5, 25, 50, 75, 95 and 99 % of it on their left, by share.

            sim.quantiles[0.95] - sim.quantiles[0.05]

        Unlike the fronts (state.x_left, state.x_right), which single grains set, they converge with the spacing.
        """
        return self.state_parts(marks=True).quantiles

    @property
    def n_particles(self) -> int:
        """Number of particles n."""
        with self._engine.locked("n_particles") as engine:
            return engine.count()

    def __len__(self) -> int:
        return self.n_particles

    @property
    def epoch(self) -> int:
        """Number of changes to the simulation so far: a view is valid while this stays the same."""
        with self._engine.locked("epoch") as engine:
            return engine.epoch()

    def field(self, name: str) -> np.ndarray:
        """A copy of one field, in the order of id.

        Args:
            name: of a field of Field, in small letters, or "speed" (m/s), "shear_stress" (Pa), "yielded" (bool).

        Returns:
            An array of shape (n), float64; id int64, column int32, yielded bool. Units: those of Field.

        Raises:
            ArgumentError: a name that does not exist, or a group.

        Example:
            print(sim.field("pressure").max(), "Pa;", sim.field("yielded").sum(), "particles at yield")
        """
        if isinstance(name, str) and name in DERIVED:
            with self._engine.locked(name) as engine:
                return self._copy(engine, name)
        names = field_names(name)
        if len(names) != 1:
            raise ArgumentError(f"field {name!r}: expected the name of a single field; particles() takes groups")
        with self._engine.locked(names[0]) as engine:
            return self._copy(engine, names[0])

    def _copy(self, engine: Engine, name: str) -> np.ndarray:
        if name in DERIVED:
            return derived(name, lambda field: self._copy(engine, field), self._friction_of_columns)
        values = np.empty(engine.count())
        check(lib.gp_copy_field(engine.sim, Field[name.upper()].value, ffi.from_buffer("double[]", values), len(values)))
        return values.astype(_INTEGERS[name]) if name in _INTEGERS else values

    def _friction_of_columns(self) -> np.ndarray:
        """mu_s of the material of each column and set of particles, as the stresses have it."""
        friction = np.array([material.mu_s for material in self._materials]) * self._config.friction_factor
        return friction[[column if isinstance(column, int) else column.material for column in self._columns]]

    def particles(self, *fields: str) -> Particles:
        """Copies of fields, each of shape (n), in the order of id.

        Args:
            *fields: names of fields, "speed", "shear_stress" and "yielded", or the groups "position", "velocity", "stress" and
                "all"; none: all.

        Returns:
            Particles, with the fields as attributes.

        Raises:
            ArgumentError: a name that does not exist.

        Example:
            fields = sim.particles("position", "pressure")
            print(fields.x.shape, fields.pressure.max())
        """
        names = names_with_derived(fields or "all")
        with self._engine.locked("particles") as engine:
            return Particles({name: self._copy(engine, name) for name in names})

    def view(self, *fields: str) -> View:
        """Read-only views of fields without copies, in the library's own order, which changes; see View.

        Args:
            *fields: names or groups of fields; none: all. Not what follows from fields, such as "speed".

        Returns:
            The View, valid until the next call that changes the simulation.

        Raises:
            ArgumentError: a name that does not exist.

        Example:
            view = sim.view("x", "id")
            print(view.x.max(), view.valid)
        """
        return View(self._engine, fields or "all")

    def surface(self, x) -> np.ndarray:
        """Heights of the free surface of the deposit.

        Args:
            x: stations, m, shape (n), finite.

        Returns:
            m, shape (n); 0 outside the deposit's fronts.

        Raises:
            ArgumentTypeError: another shape than (n).
            ArgumentError: a value that is not finite.

        Example:
            print(sim.surface([0.0, 0.02]))

        Restrictions:
            What lies apart from the connected deposit is not in it: state.detached is the share of that.
        """
        x = doubles("x", x)
        height = np.zeros(len(x))
        with self._engine.locked("surface") as engine:
            check(lib.gp_get_surface(engine.sim, len(x), pointer(x), ffi.from_buffer("double[]", height)))
        return height

    def interface(self, left: int, right: int, y) -> np.ndarray:
        """Positions of the interface of two columns.

        Args:
            left, right: numbers of two columns or sets of particles.
            y: heights, m, shape (n), finite.

        Returns:
            x in m, shape (n); NaN where they do not touch.

        Raises:
            ArgumentError: a column that does not exist, the same one twice, or a value that is not finite.
            ArgumentTypeError: another shape than (n).

        Example:
            other = sim.add_column(x_min=0.05, width=0.05, height=0.05)
            sim.run(0.01)
            print(sim.interface(0, other, [0.01, 0.02]))
        """
        left, right, y = whole("left", left, 32), whole("right", right, 32), doubles("y", y)
        x = np.zeros(len(y))
        with self._engine.locked("interface") as engine:
            check(lib.gp_get_interface(engine.sim, left, right, len(y), pointer(y), ffi.from_buffer("double[]", x)))
        return x

    def plate_load(self, plate: int) -> Load:
        """The load of the material on a plate, and the plate's displacement and turn.

        Args:
            plate: number of the plate.

        Returns:
            The Load, of the last step; per metre of depth.

        Raises:
            ArgumentError: a plate that does not exist.

        Example:
            sim.run(0.01)
            print(sim.plate_load(0).fy, "N/m")
        """
        plate = whole("plate", plate, 32)
        with self._engine.locked("plate_load") as engine:
            return _state.read_load(engine.sim, plate)

    def plan(self) -> Plan:
        """What the engine does for this scene and what it leaves out, with bytes and seconds.

        Returns:
            The Plan, a list of PlanEntry that prints as a table.

        Example:
            print([entry.name for entry in sim.plan() if entry.active][:3])
        """
        with self._engine.locked("plan") as engine:
            return _state.read_plan(engine.sim)


def _field_property(name: str) -> property:
    return property(
        lambda self: self.field(name),
        doc=f"{name}: {(FIELD_MEANINGS | DERIVED)[name]}. A copy of shape (n), in the order of id.",
    )


for _name in (*FIELD_NAMES, "speed"):
    setattr(SimulationReading, _name, _field_property(_name))
