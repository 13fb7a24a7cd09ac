"""How a simulation runs, and what looks at it on the way."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Iterator

from ._errors import ArgumentError, ArgumentTypeError, StateError, number, whole
from ._frames import end_of, frames, run_to_rest
from ._library import lib
from ._probe import Probe
from ._progress import Progress
from ._simulation_reading import SimulationReading
from ._state import State
from ._timer import interval

if TYPE_CHECKING:
    from typing import Self


class SimulationRunning(SimulationReading):
    """Steps, runs, frames, probes and the callback of a simulation."""

    def step(self, n: int = 1) -> bool:
        """Takes n time steps.

        Args:
            n: number of steps, at least 0.

        Returns:
            False if the callback stopped it before the end.

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
            False if the callback stopped it before the end.

        Raises:
            ArgumentError: t_end before the clock or not finite, a sound speed that is wrong for the scene (at the first step).
            DivergedError: a value became unbounded; the simulation is at its last good step and can be read, not stepped.
            FileError: a frame of an open output could not be written; the step is complete.
            ImportError: progress, and no tqdm.
            KeyboardInterrupt: Ctrl-C, after the current step; the next run goes on.

        Example:
            sim.run(0.05)
            print(sim.state.peak_height, "m")

        Restrictions:
            A run with another end has other bits, since steps are shortened to land on it: to look on the way use frames(), a
            probe or a callback.
        """
        t_end = number("t_end", t_end)
        with self._engine.locked("run") as engine:
            if not progress:
                return engine.advance("run", lib.granperi_run, t_end) == 0
            with Progress(self._engine, t_end):
                return engine.advance("run", lib.granperi_run, t_end) == 0

    def run_until_rest(self, t_max: float, progress: bool = False) -> bool:
        """Steps until the material rests (state.at_rest), which is checked after every tenth step.

        Args:
            t_max: s, the latest end; finite, not before what the clock shows.
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
        with Progress(self._engine, t_max, shown=progress):
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
        with Progress(self._engine, t_end, shown=progress):
            if last_frame is None:
                yield self._keep(self.state)
                last_frame = self._engine.reached()
            for state in frames(self, t_end, every, until_rest, last_frame):
                yield self._keep(state)

    def _keep(self, state: State) -> State:
        if not self.history or self.history[-1].time < state.time:
            self.history.append(state)
        return state

    def add_probe(self, points: Any = None, fields: Any = ("pressure", "speed"), plates: Any = (), every: float = 0.01,
                  radius: float | None = None) -> Probe:
        """A time series of fields at points, and of the loads on plates.

        It begins with the present state when the simulation goes on, and does not change the run. See Probe.

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

    def set_callback(self, callback: Callable[[Self], Any] | None, every: int = 1) -> None:
        """Has a function called after every `every`-th step.

        A true return value stops the run. An exception stops the run and comes out of step() or run() as it was raised. In the
        callback the simulation can be read, driven (set_plate_velocity, set_plate_motion, set_gravity) and written to its open
        output.

        Args:
            callback: function of the simulation; None: removes it.
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
