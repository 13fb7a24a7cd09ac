"""The runs of a report: a scene at one spacing and one seed, what came out, and what it cost."""
from __future__ import annotations

import copy
import dataclasses
import math
import time
from typing import Any, Callable, Mapping

from ._errors import ArgumentError, ArgumentTypeError
from ._scene import Scene
from ._simulation import Simulation
from ._state import MARKS, PlanEntry, State

JITTER = 0.01  # spacings: runs of one spacing begin this far beside each other, if the scene has no jitter of its own
STILL = 1e-4  # of the largest kinetic energy: below it only single grains move, whose end is as they please
LOOK = 20  # steps between looks at rest and at the clock on the wall

Quantity = Callable[[Simulation], float]
#: Name: unit, what it is, and how it is read from the last state. Widths hold the middle share of the mass.
QUANTITIES: dict[str, tuple[str, str, Callable[[State], float]]] = {
    "peak_height": ("m", "highest point of the deposit", lambda state: state.peak_height),
    "width_50": ("m", "width that holds the middle 50 % of the mass", lambda state: state.x_q75 - state.x_q25),
    "width_90": ("m", "the middle 90 %", lambda state: state.x_q95 - state.x_q05),
    "width_98": ("m", "the middle 98 %", lambda state: state.x_q99 - state.x_q01),
    **{name: ("m", f"mark that has {100 * share:g} % of the mass on its left", lambda state, name=name: getattr(state, name))
       for share, name in MARKS.items()},
}
REST = "rest_time"


@dataclasses.dataclass(frozen=True)
class Measured:
    """One run: values by name of quantity at its end, NaN where there is none (rest_time of what still moves).

    cpu_seconds: to the end; cpu_to_rest: until gp_state.at_rest has become 1 for good, NaN if it has not.
    """

    spacing: float
    seed: int
    particles: int
    steps: int
    cpu_seconds: float
    cpu_to_rest: float
    values: dict[str, float]

    @property
    def cost(self) -> float:
        """CPU s per particle and step."""
        return self.cpu_seconds / max(1, self.particles * self.steps)


class OutOfTime(Exception):
    """A run that the budget has ended."""


class _Watch:
    """Between two steps: since when does it rest, and is there time left?"""

    def __init__(self, sim: Simulation, deadline: Callable[[], float]):
        self.begin, self.deadline, self.late = time.thread_time(), deadline, False
        self.most_kinetic = 0.0  # J/m
        self.still: float | None = None  # time since when the kinetic energy has been below STILL of the largest
        self.rest: float | None = None  # CPU s at which the present rest began
        self.plan: list[PlanEntry] = []  # early: at the end most of it may have nothing to do
        sim.set_callback(self.look, LOOK)

    def look(self, sim: Simulation) -> bool:
        self.plan = self.plan or sim.plan()
        state = sim.state_parts()
        self.most_kinetic = max(self.most_kinetic, state.kinetic)
        if state.kinetic > STILL * self.most_kinetic:
            self.still = None
        elif self.still is None:
            self.still = state.time
        if not state.at_rest:
            self.rest = None
        elif self.rest is None:
            self.rest = time.thread_time() - self.begin
        self.late = time.monotonic() > self.deadline()
        return self.late


def at(scene: Scene, spacing: float, seed: int) -> Scene:
    """The scene at another spacing, by one thread, with its own jitter or one that is just enough to see chaos."""
    one = copy.copy(scene)
    one.config = scene.config.replace(spacing=spacing, seed=seed, threads=1, jitter=scene.config.jitter or JITTER)
    return one


def measure(scene: Scene, spacing: float, seed: int, end: float, quantities: Mapping[str, Quantity] = {},
            deadline: Callable[[], float] = lambda: math.inf) -> tuple[Measured, list[PlanEntry]]:
    """Runs the scene to `end` [s]. OutOfTime once time.monotonic is beyond what deadline() says."""
    begin = time.thread_time()
    with at(scene, spacing, seed).build() as sim:
        watch = _Watch(sim, deadline)
        sim.run(end)
        if watch.late:
            raise OutOfTime
        watch.look(sim)
        cpu = time.thread_time() - begin
        state = sim.state
        values = standard(state)
        values[REST] = math.nan if watch.still is None else watch.still
        values.update({name: _own(name, read, sim) for name, read in quantities.items()})
        return Measured(sim.config.spacing, seed, state.n_particles, state.step, cpu,
                        math.nan if watch.rest is None else watch.rest, values), _spent(watch.plan, sim.plan())


def _spent(early: list[PlanEntry], late: list[PlanEntry]) -> list[PlanEntry]:
    """What was active early on, with what it took until the end."""
    return [dataclasses.replace(then, seconds=now.seconds, calls=now.calls, bytes=now.bytes)
            for then, now in zip(early, late, strict=True)]


def standard(state: State) -> dict[str, float]:
    """The quantities that every scene has."""
    return {name: float(read(state)) for name, (_, _, read) in QUANTITIES.items()}


def _own(name: str, read: Quantity, sim: Simulation) -> float:
    value = read(sim)
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ArgumentTypeError(f"quantities[{name!r}]: returned {value!r:.80}: expected a number") from None


def checked(quantities: Any) -> dict[str, Quantity]:
    """The host's own quantities: a mapping of new names to functions of the simulation."""
    if not isinstance(quantities, Mapping):
        raise ArgumentTypeError(f"quantities = {quantities!r:.80}: expected a dict of names and functions of the simulation")
    for name, read in quantities.items():
        if not isinstance(name, str) or not callable(read):
            raise ArgumentTypeError(f"quantities[{name!r}] = {read!r:.80}: expected a name and a function of the simulation")
        if name in QUANTITIES or name == REST:
            raise ArgumentError(f"quantities[{name!r}]: the report has a quantity of this name: expected another one")
    return dict(quantities)
