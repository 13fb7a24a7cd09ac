"""Simulation: a scene, its run, and everything that is read from it."""
from __future__ import annotations

import os
import tempfile
import weakref
from typing import TYPE_CHECKING, Any, Callable, Iterator, Mapping

import numpy as np

from . import _state
from ._checkpoint import scene_in
from ._derived import DERIVED, derived, names_with_derived
from ._engine import Engine
from ._enums import FIELD_MEANINGS, FIELD_NAMES, Field, field_names
from ._errors import ArgumentError, ArgumentTypeError, FileError, StateError, check, doubles, near_match, number, path_bytes, pointer, whole
from ._library import ffi, lib
from ._objects import Column, Config, Material, Parameters
from ._output import Output
from ._plate import Plate
from ._frames import end_of, frames, run_to_rest
from ._probe import Probe
from ._progress import Progress, require_tqdm
from ._timer import interval
from ._shapes import in_mask, in_polygon
from ._state import Clock, History, Load, Plan, State
from ._views import Particles, View

if TYPE_CHECKING:
    from typing import Unpack

    from numpy.typing import NDArray

    from ._objects import ColumnValues, ConfigValues, MaterialValues
    from ._plate import PlateValues

_INTEGERS = {"id": np.int64, "column": np.int32}


class Simulation:
    """A granular flow in two dimensions.

        with granperi.Simulation(spacing=0.0025) as sim:
            sim.add_column(x_min=-0.04, width=0.08, height=0.05)
            sim.add_plate(granperi.Plate.floor(-0.3, 0.3))
            sim.run(1.0)
            print(sim.state.peak_height)

    All quantities are in SI units. What is read are copies, in the order in which particles were added, unless it is asked
    for by view(). One simulation belongs to one thread at a time; a second thread gets StateError. Steps run without the
    GIL. Errors are subclasses of granperi.Error with the library's text.
    """

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

    def __init__(self, config: Config | None = None, **values: Unpack[ConfigValues]):
        """config: a Config, or its parameters by keyword."""
        self._config = _taken(Config, config, values)
        self._start(self._create())

    def _create(self):
        struct, keep = self._config._fill()
        handle = ffi.new("gp_sim **")
        check(lib.gp_create(struct, handle))
        return handle[0]

    def _start(self, sim) -> None:
        self._engine = Engine(sim, self._config.threads)
        self._engine.owner = weakref.ref(self)
        self._materials = [Material()]
        self._columns: list[Column | int] = []
        self._plates: list[Plate] = []
        self._output: Output | None = None
        #: States that frames() and record() have kept.
        self.history = History()

    # -------------------------------------------------------------------------------------------------- life

    def close(self) -> None:
        """Frees the simulation and closes its output; arrays made from views keep its memory until they go. Closing it twice does
        no harm.

        Raises:
            StateError: from inside the simulation's callback.

        Example:
            sim.close()
            print(sim.closed)
        """
        engine = self._engine
        if engine.closed:
            return
        with engine.locked("close"):
            if engine.running:
                raise StateError("close: called from inside the simulation's callback")
            output, self._output = self._output, None
            try:
                if output is not None:
                    output._close_locked()
            finally:
                engine.closed = True
                engine.callback = engine.on_look = None
                if not engine.exports:
                    engine.destroy()

    @property
    def closed(self) -> bool:
        """Whether close() was called, or the with block has ended."""
        return self._engine.closed

    def __enter__(self) -> "Simulation":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    if not TYPE_CHECKING:  # a type checker is to find what does not exist
        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(name)
            raise AttributeError(f"a Simulation has no '{name}': {near_match(name, [n for n in dir(self) if n[0] != '_'])}")

    def __repr__(self) -> str:
        if self.closed:
            return "<granperi.Simulation, closed>"
        return f"<granperi.Simulation of {self._engine.count()} particles, {len(self._plates)} plates>"

    # ------------------------------------------------------------------------------------------------- scene

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

        They are on the lattice of the spacing, the first half a spacing inside the left lower corner. Sides that are not whole
        numbers of spacings are rounded, with a warning.

        Args:
            column: its values; not given: those of Column.
            **values: parameters of Column by keyword, over those of `column`.

        Returns:
            The number of the column, from 0 on, counted together with sets of particles.

        Raises:
            ArgumentError: a side that is not above 0 or rounds to nothing, a material that does not exist, a place outside a
                period, more particles than 2147483647 in all.
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
        thing = _taken(kind, given, values)
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
            ArgumentError: a value that is not finite, one of vx and vy alone, a material that does not exist, places outside a
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

        Its pixels are square; else as add_polygon.

        Args:
            mask: true and false, or 1 and 0, shape (rows, columns), the first row at the top; or the path of an image (Pillow
                reads it), in which what is darker than half is material.
            x_min, y_min: left lower corner of the mask, m, finite.
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

    def add_probe(self, points: Any = None, fields: Any = ("pressure", "speed"), plates: Any = (), every: float = 0.01,
                  radius: float | None = None) -> Probe:
        """A time series of fields at points, and of the loads on plates.

        It begins when the simulation goes on next, at its present state, and does not change the run. See Probe.

        Args:
            points: m, shape (n, 2), finite; not given: none.
            fields: names or groups of fields, as particles() takes them.
            plates: numbers of plates, or one.
            every: s between two samples, finite, above 0.
            radius: m, of the means at points, finite, above 0; not given: two spacings.

        Returns:
            The Probe.

        Raises:
            ArgumentError: neither points nor plates, a plate or field that does not exist, a value out of range.
            ArgumentTypeError: points of another shape.

        Example:
            probe = sim.add_probe(points=[[0.0, 0.01]], fields="pressure", plates=[0], every=0.005)
            sim.run(sim.time + 0.02)
            print(probe.time, probe["pressure"], probe["fy"])
        """
        return Probe(self, points, fields, plates, every, radius)

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
        """Gravity from now on; possible at any time, also in a callback. Before the first step it replaces the config's.

        Args:
            gx, gy: m/s2, to the right and upwards, finite.

        Raises:
            ArgumentError: a value that is not finite.

        Example:
            sim.set_gravity(1.0, -9.76)
            sim.run(sim.time + 0.01)
            print(sim.state.gravity_x, "m/s2")

        Restrictions:
            The sound speed stays that of the first gravity, and a warning says so where it is too low: then set
            Config.sound_speed.
        """
        gx, gy = number("gx", gx), number("gy", gy)
        with self._engine.locked("set_gravity") as engine:
            if engine.exports and not engine.running:
                engine.before_change("set_gravity")
            check(lib.gp_set_gravity(engine.sim, gx, gy))

    def _changing(self, name: str):
        engine = self._engine
        if engine.exports and not engine.closed:
            engine.before_change(name)
        return engine.locked(name)

    # ----------------------------------------------------------------------------------------------- running

    def step(self, n: int = 1) -> bool:
        """Takes n time steps.

        Args:
            n: number of steps, at least 0.

        Returns:
            False if the callback stopped it before.

        Raises:
            ArgumentError: n below 0, a sound speed that is wrong for the scene (at the first step).
            DivergedError: a value became unbounded; the simulation is at its last good step and can be read, not stepped.
            FileError: a frame of an open output could not be written; the step is complete.

        Example:
            sim.step(10)
            print(sim.clock.step, "steps,", sim.time, "s")
        """
        if type(n) is not int or n >> 63:
            n = whole("n", n)
        with self._engine.locked("step") as engine:
            return engine.advance("step", lib.granperi_step, n) == 0

    def run(self, t_end: float, progress: bool = False) -> bool:
        """Steps until the clock shows t_end exactly; the last steps are shortened to land on it.

        Args:
            t_end: s, finite, not before what the clock shows.
            progress: shows a bar (needs tqdm), in a terminal or a notebook.

        Returns:
            False if the callback stopped it before.

        Raises:
            ArgumentError: t_end before the clock or not finite, a sound speed that is wrong for the scene (at the first step).
            DivergedError: a value became unbounded; the simulation is at its last good step and can be read, not stepped.
            FileError: a frame of an open output could not be written; the step is complete.
            ImportError: progress, and no tqdm.
            KeyboardInterrupt: Ctrl-C, after the present step; the next run goes on.

        Example:
            sim.run(0.05)
            print(sim.state.peak_height, "m")

        Restrictions:
            Each end is another run, since steps are shortened for it: look on the way by frames(), a probe or a callback.
        """
        t_end = number("t_end", t_end)
        with self._engine.locked("run") as engine:
            if not progress:
                return engine.advance("run", lib.granperi_run, t_end) == 0
            with Progress(self, t_end):
                return engine.advance("run", lib.granperi_run, t_end) == 0

    def run_until_rest(self, t_max: float, progress: bool = False) -> bool:
        """Steps until the material rests (state.at_rest), which is looked at after every tenth step.

        Args:
            t_max: s, at the latest until the clock shows this; finite, not before what it shows.
            progress: shows a bar (needs tqdm).

        Returns:
            True if it rests; False if t_max came first or the callback stopped it.

        Raises:
            ArgumentError: t_max before the clock or not finite.
            DivergedError: a value became unbounded.

        Example:
            if not sim.run_until_rest(0.1):
                print("still moves at", sim.time)
        """
        t_max = end_of(self, "t_max", t_max)
        with Progress(self, t_max, shown=progress):
            return run_to_rest(self, t_max)

    def frames(self, t_end: float, every: float, progress: bool = False, until_rest: bool = False) -> Iterator[State]:
        """Runs and yields the state at the start, after the first step at or past each multiple of `every` on the way, and at the
        end.

        No step is made shorter for it: the run has the same bits without frames, and state.time is up to a time step past the
        multiple. The states are kept in sim.history. Where the callback stops the run, the iteration ends.

        Args:
            t_end: s, finite, not before what the clock shows.
            every: s between two frames, finite, above 0.
            progress: shows a bar (needs tqdm).
            until_rest: ends when the material rests, as run_until_rest() does.

        Returns:
            An iterator of State.

        Raises:
            ArgumentError: t_end before the clock, every not above 0; at once, not at the first state.
            DivergedError: a value became unbounded.

        Example:
            for state in sim.frames(0.05, every=0.01):
                print(state.time, state.kinetic)
        """
        t_end, every = end_of(self, "t_end", t_end), interval(every)
        return self._frames(t_end, every, progress, until_rest)

    def _frames(self, t_end: float, every: float, progress: bool = False, until_rest: bool = False,
                last_frame: float | None = None) -> Iterator[State]:
        """last_frame [s]: of a run that is continued; without, it begins with a frame of the present state."""
        with Progress(self, t_end, shown=progress):
            if last_frame is None:
                yield self._keep(self.state)
                last_frame = self._engine.reached()
            for state in frames(self, t_end, every, until_rest, last_frame):
                yield self._keep(state)

    def _keep(self, state: State) -> State:
        if not self.history or self.history[-1].time < state.time:
            self.history.append(state)
        return state

    def record(self, path: "str | os.PathLike[str]", t_end: float, every: float = 0.01, fields: Any = "default",
               progress: bool = False, until_rest: bool = False, **options: Any) -> History:
        """Runs with a frame in the HDF5 file `path` at the start, after the first step at or past each multiple of `every`, and at
        the end.

        See frames() and output(). An existing file is replaced: Scene.record() refuses to.

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

    def set_callback(self, callback: "Callable[[Simulation], Any] | None", every: int = 1) -> None:
        """Has a function called after every `every`-th step.

        A true return value stops the run. An exception stops the run and comes out of step() or run() as it was raised. In the
        callback the simulation can be read, driven (set_plate_velocity, set_plate_motion, set_gravity) and written to its open
        output.

        Args:
            callback: function of the simulation; None: no longer.
            every: steps between two calls, at least 1.

        Raises:
            ArgumentError: every below 1.
            ArgumentTypeError: a callback that cannot be called.
            StateError: from inside the callback.

        Example:
            sim.set_callback(lambda sim: sim.time > 0.02, every=5)
            print(sim.run(1.0), sim.time)  # False: it was stopped
        """
        every = whole("every", every)
        if callback is not None and not callable(callback):
            raise ArgumentTypeError(f"callback = {callback!r}: expected a function of the simulation, or None")
        if callback is not None and every < 1:
            raise ArgumentError(f"every = {every}: expected a whole number >= 1")
        with self._engine.locked("set_callback") as engine:
            if engine.running:
                raise StateError("set_callback: called from inside the simulation's callback")
            engine.callback = callback
            engine.watch.every = every if callback is not None else 0

    # ----------------------------------------------------------------------------------------------- reading

    @property
    def state(self) -> State:
        """Clock, energy ledger, shape and rest at this instant."""
        with self._engine.locked("state") as engine:
            return _state.read_state(engine.sim)

    def state_parts(self, *, deposit: bool = False, marks: bool = False, drift: bool = False) -> State:
        """The state without what takes time to find, but for the parts asked for; the fields of the others are NaN.

        Without any it costs 2 to 5 % of a time step, the whole state about one.

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
        """Time [s], last time step [s] and number of steps, at no cost: the state takes about as long as a step."""
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
        """Number of changes to the simulation so far: a view is valid while it is the same."""
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
            What lies apart from the connected deposit is not in it: state.detached is its share.
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
            ArgumentError: a column that does not exist, twice the same, or a value that is not finite.
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

    # ------------------------------------------------------------------------------------------------- files

    def output(self, path: "str | os.PathLike[str]", every: float = 0.0, fields: Any = "default", compression: int = 4,
               single_precision: bool = False, append: bool = False) -> Output:
        """Opens an HDF5 file of frames (H5MD, beside it .xdmf for ParaView); one at a time. A context manager.

        Args:
            path: of the file, which is replaced if it exists.
            every: s; above 0: a frame at the start and after the first step at or past each multiple. 0: by write() only.
            fields: names or groups; "default" is position, velocity, pressure, stress, shear_rate, inertial_number and column,
                which is what the pictures need.
            compression: 0 .. 9, of gzip; 0: none.
            single_precision: 32 bits in place of 64.
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
            self._output = Output(self, engine, path, every, fields, compression, single_precision, append)
            return self._output

    def save(self, path: "str | os.PathLike[str]") -> None:
        """Writes a checkpoint, from which load() goes on bit by bit.

        Args:
            path: of the file, which is replaced as a whole if it exists.

        Raises:
            FileError: it cannot be written; what was there is still there.
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
            FileError: no such file, or none of a checkpoint; the text says what to do.
            VersionError: a file of a newer version.
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


def _taken(kind: type[Parameters], given: Any, values: Mapping[str, Any]) -> Any:
    """The object given, with the values given, or a new one; always one that nobody else can change."""
    if given is None:
        return kind(**values)
    if not isinstance(given, kind):
        raise ArgumentTypeError(f"expected a {kind.__name__} or its parameters by keyword, got {given!r:.80}")
    return given.replace(**values)


def _field_property(name: str) -> property:
    return property(
        lambda self: self.field(name),
        doc=f"{name}: {(FIELD_MEANINGS | DERIVED)[name]}. A copy of shape (n), in the order of id.",
    )


for _name in (*FIELD_NAMES, "speed"):
    setattr(Simulation, _name, _field_property(_name))
