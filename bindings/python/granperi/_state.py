"""What is read from a simulation: state, load on a plate, plan."""
from __future__ import annotations

import dataclasses
import os
from typing import NamedTuple

import numpy as np

from ._enums import StepLimit
from ._errors import check
from ._library import ffi, lib, text_of
from ._objects import described
from ._tables import as_html, write_csv


@dataclasses.dataclass(frozen=True)
class State:
    """Clock, energy ledger, shape and rest of a simulation at one instant (gp_state).

    Energies are in J per metre of depth, momenta in kg/s, lengths in m, times in s:
    """

    time: float
    step: int
    dt: float
    n_particles: int
    n_awake: int
    kinetic: float
    potential: float
    elastic: float
    dissipated: float
    plate_work: float
    energy_error: float
    momentum_x: float
    momentum_y: float
    max_speed: float
    rms_speed: float
    x_left: float
    x_right: float
    peak_x: float
    peak_height: float
    max_pressure: float
    at_rest: bool
    collisions: int
    wall_seconds: float
    sound_speed: float
    penalty_dissipated: float
    wall_dissipated: float
    diffusion_dissipated: float
    bulk_dissipated: float
    collision_dissipated: float
    channel_dissipated: float
    dt_reason: StepLimit
    implicit_last: int
    implicit_newton: int
    implicit_linear: int
    implicit_failures: int
    implicit_residual: float
    retries: int
    dt_limit: float
    max_compression: float
    spacing_dissipated: float
    x_q01: float
    x_q05: float
    x_q25: float
    x_q50: float
    x_q75: float
    x_q95: float
    x_q99: float
    centre_x: float
    centre_y: float
    detached: float
    volume_drift: float
    gravity_x: float
    gravity_y: float

    @property
    def quantiles(self) -> dict[float, float]:
        """Marks of the mass: x [m] that have these shares of it on their left, {0.01: x_q01, ..., 0.99: x_q99}."""
        return {share: getattr(self, name) for share, name in MARKS.items()}

    def _repr_html_(self) -> str:
        return as_html(("state", "value"), [*vars(self).items(), ("energy_initial", self.energy_initial)])

    @property
    def energy_initial(self) -> float:
        """The energy that the ledger began with, J/m."""
        return self.kinetic + self.potential + self.elastic + self.dissipated + self.plate_work + self.energy_error


MARKS = {int(name[3:]) / 100: name for name in
          ("x_q01", "x_q05", "x_q25", "x_q50", "x_q75", "x_q95", "x_q99")}
_STATE_NAMES = tuple(field.name for field in dataclasses.fields(State))
# Of a table for people.
_SHOWN = ("time", "step", "dt", "kinetic", "potential", "dissipated", "energy_error", "max_speed", "x_q05", "x_q95", "peak_height",
          "at_rest")


def read_state(sim, parts: int = lib.GP_STATE_ALL) -> State:
    struct = ffi.new("gp_state *")
    struct.struct_size = ffi.sizeof("gp_state")
    check(lib.gp_get_state_parts(sim, parts, struct))
    values = {name: getattr(struct, name) for name in _STATE_NAMES}
    values["at_rest"] = bool(values["at_rest"])
    values["dt_reason"] = StepLimit(values["dt_reason"])
    return State(**values)


class Clock(NamedTuple):
    """The clock of a simulation: time [s], dt [s] of the last step (0 before the first), and the number of steps taken."""

    time: float
    dt: float
    step: int


def read_clock(sim) -> Clock:
    time, dt, step = ffi.new("double *"), ffi.new("double *"), ffi.new("int64_t *")
    check(lib.gp_get_clock(sim, time, dt, step))
    return Clock(time[0], dt[0], step[0])


@dataclasses.dataclass(frozen=True)
class Load:
    """Load of the material on a plate, and how far the plate has moved."""

    fx: float
    fy: float
    torque: float
    dx: float
    dy: float
    impulse_x: float
    impulse_y: float
    torque_pivot: float
    angle: float
    impulse_torque: float

    def _repr_html_(self) -> str:
        return as_html(("load", "value"), vars(self).items())


_LOAD_NAMES = tuple(field.name for field in dataclasses.fields(Load))


def read_load(sim, plate: int) -> Load:
    struct = ffi.new("gp_load *")
    struct.struct_size = ffi.sizeof("gp_load")
    check(lib.gp_get_plate_load(sim, plate, struct))
    return Load(*(getattr(struct, name) for name in _LOAD_NAMES))


@dataclasses.dataclass(frozen=True)
class PlanEntry:
    """A stage (kind 0, in the order in which they run) or a field or table (kind 1) of the engine, and why."""

    name: str
    reason: str
    kind: int
    active: bool
    bytes: int
    seconds: float
    calls: int


class Plan(list[PlanEntry]):
    """The entries of a plan; printed and in notebooks a table."""

    _NAMES = ("", "name", "bytes", "seconds", "calls", "why")

    def _rows(self) -> list[list[str]]:
        return [[("stage" if e.kind == 0 else "field") if e.active else "-", e.name, str(e.bytes or ""),
                 f"{e.seconds:.3g}" if e.seconds else "", str(e.calls or ""), e.reason] for e in self]

    def __str__(self) -> str:
        return "\n".join(f"{kind:<9}{name:<28}{size:>12}{seconds:>10}{calls:>8}  {why}"
                         for kind, name, size, seconds, calls, why in [list(self._NAMES), *self._rows()])

    def _repr_html_(self) -> str:
        return as_html(self._NAMES, self._rows())


def read_plan(sim) -> Plan:
    n = ffi.new("int64_t *")
    check(lib.gp_get_plan(sim, 0, ffi.NULL, n))
    entries = ffi.new("gp_plan_entry[]", n[0])
    check(lib.gp_get_plan(sim, n[0], entries, n))
    return Plan(PlanEntry(text_of(e.name), text_of(e.reason), e.kind, bool(e.active), e.bytes, e.seconds, e.calls)
                for e in entries)


State.__doc__ = described("gp_state", State.__doc__)
Load.__doc__ = described("gp_load", Load.__doc__)
PlanEntry.__doc__ = described("gp_plan_entry", PlanEntry.__doc__)


class History:
    """States one after the other; history.time, history.kinetic, ... are arrays of shape (number of states)."""

    def __init__(self, states=()):
        self.states: list[State] = list(states)

    def append(self, state: State) -> None:
        """Adds a state at the end.

        Args:
            state: a State, later than those that are there.

        Example:
            history = granperi.History()
            history.append(sim.state)
            print(history.time)
        """
        self.states.append(state)

    def __len__(self) -> int:
        return len(self.states)

    def __iter__(self):
        return iter(self.states)

    def __getitem__(self, k) -> State:
        return self.states[k]

    def __getattr__(self, name: str) -> np.ndarray:
        if name in _STATE_NAMES or name == "energy_initial":
            return np.array([getattr(state, name) for state in self.states])
        raise AttributeError(f"a history has no '{name}'; it has the fields of granperi.State")

    def to_csv(self, path: "str | os.PathLike[str]", overwrite: bool = False) -> None:
        """Writes a line per state, with a column for each field of State, as CSV.

        Args:
            path: of the file.
            overwrite: replaces a file that exists.

        Raises:
            FileError: the file exists, and overwrite is false; or it cannot be written.

        Example:
            list(sim.frames(0.02, every=0.01))
            sim.history.to_csv("history.csv", overwrite=True)
        """
        write_csv(path, _STATE_NAMES, ([getattr(state, name) for name in _STATE_NAMES] for state in self.states), overwrite)

    def _repr_html_(self) -> str:
        shown = self.states if len(self) <= 20 else [*self.states[:10], *self.states[-10:]]
        return as_html(_SHOWN, ([getattr(state, name) for name in _SHOWN] for state in shown), repr(self)[1:-1])

    def __repr__(self) -> str:
        span = f", {self.states[0].time:g} to {self.states[-1].time:g} s" if self.states else ""
        return f"<granperi.History of {len(self)} states{span}>"
