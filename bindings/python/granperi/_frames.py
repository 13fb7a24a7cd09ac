"""Runs that are looked at on the way: states at multiples of a time, and the end when the material rests."""
from __future__ import annotations

import contextlib
import math
from typing import TYPE_CHECKING, Iterator

from ._errors import ArgumentError, number
from ._library import lib
from ._state import State
from ._timer import Timer

if TYPE_CHECKING:
    from ._simulation_reading import SimulationReading

REST_EVERY = 10  # steps between looks at rest, each 5 % of a step


@contextlib.contextmanager
def _timed(sim: "SimulationReading", timer: Timer) -> Iterator[None]:
    timers = sim._engine.timers
    timers.append(timer)
    try:
        yield
    finally:
        timers.remove(timer)


def end_of(sim: "SimulationReading", name: str, t_end: float) -> float:
    """The end of a run [s] as a number, or the error on it."""
    t_end, now = number(name, t_end), sim.time
    if not (math.isfinite(t_end) and t_end >= now):
        raise ArgumentError(f"{name} = {t_end:g}: expected a finite time not before the clock's {now:g} s")
    return t_end


def run_to_rest(sim: "SimulationReading", t_end: float) -> bool:
    """True if the material rests, False where t_end [s] or the callback has ended the run."""
    with sim._engine.locked("run_until_rest") as engine:
        engine.watch.rest_every = REST_EVERY
        try:
            engine.advance("run_until_rest", lib.granperi_run, t_end)
        finally:
            engine.watch.rest_every = 0
        return bool(engine.watch.rested)


def frames(sim: "SimulationReading", t_end: float, every: float, until_rest: bool, frame_before: float) -> Iterator[State]:
    """The states after the first step at or past each multiple of `every` [s] after frame_before [s], and at the end."""
    def go_on(name: str) -> bool:
        """To the next frame or the end; False if the run is over."""
        with sim._engine.locked(name) as engine:
            if until_rest:
                run_to_rest(sim, t_end)
            else:
                engine.advance(name, lib.granperi_run, t_end)
            return not (engine.stopped or engine.watch.rested or sim.time >= t_end)

    state = sim.state
    due = Timer(every, lambda: True, after=frame_before)
    if state.time > frame_before:  # goes on with an interrupted run
        rests = until_rest and state.at_rest and state.step % REST_EVERY == 0
        if due.ring(sim._engine.reached()) or rests or state.time >= t_end:  # the interruption has cut off this frame
            yield state
        if rests:
            return
    while state.time < t_end:
        with _timed(sim, due):
            going = go_on("frames")
        before, state = state, sim.state
        if state.step > before.step:
            yield state
        if not going:
            return
