"""The owner of a gp_sim: who may call it, what it calls back, and when it is freed."""
from __future__ import annotations

import gc
import logging
import math
import os
import sys
import threading
import warnings
import weakref
from typing import Any, Callable

from ._errors import GranperiWarning, StateError, check
from ._library import ffi, lib, text_of
from ._state import read_clock
from ._timer import Timer

log = logging.getLogger("granperi")

_PACKAGE = os.path.dirname(os.path.abspath(__file__))
_LOOK = 0.1  # s of wall-clock time between looks at signals and progress bars

_ran_threads = False  # this process has run a simulation with more threads than one
_forked_after = False  # so had its parent, before the fork
_main_thread = threading.main_thread().ident  # the one in which Python's signal handlers run


def _after_fork_in_child() -> None:
    global _forked_after, _main_thread
    _main_thread = threading.get_ident()
    _forked_after = _forked_after or _ran_threads


os.register_at_fork(after_in_child=_after_fork_in_child)


class _Lock:
    """with engine.locked(name): one thread at a time; a second one is refused, not kept waiting for a whole run."""

    __slots__ = ("engine", "name")

    def __init__(self, engine: "Engine", name: str):
        self.engine, self.name = engine, name

    def __enter__(self) -> "Engine":
        engine = self.engine
        if not engine.lock.acquire(blocking=False):
            raise StateError(f"{self.name}: the simulation is in use by another thread; one simulation belongs to one "
                             "thread at a time: wait until that one's step() or run() has returned")
        if engine.closed:
            engine.lock.release()
            raise StateError(f"{self.name}: the simulation is closed, by close() or the end of its with block: do it before, "
                             "or make a new Simulation")
        return engine

    def __exit__(self, kind, error, traceback) -> None:
        engine = self.engine
        try:
            if engine.messages and engine.running == 0:
                engine.deliver()
        except GranperiWarning as warning:  # made an error by a filter
            if error is None:
                raise
            error.add_note(f"granperi has also warned: {warning}")
        finally:
            engine.lock.release()


class Engine:
    """One gp_sim with its watch (granperi_watch.c)."""

    def __init__(self, sim, threads: int):
        self.lib, self.getpid = lib, os.getpid  # for __del__, which may outlive the modules
        self.sim = sim
        self.threads = threads
        self.lock = threading.RLock()
        self.closed = False
        self.running = 0  # depth of step() and run(): 1 also while their callbacks run
        self.exports: set[int] = set()  # of raw arrays of this simulation's memory
        self.output: Any = None  # the open Output
        self.output_pid = 0  # of the process that has opened it
        self.callback: Callable[[Any], Any] | None = None
        self.on_look: Callable[[], None] | None = None
        self.timers: list[Timer] = []
        self.stopped = False  # by the callback: the run that has just ended
        self.failure: BaseException | None = None
        self.messages: list[tuple[int, str]] = []
        self.owner: Callable[[], Any] = lambda: None  # weak reference to the Simulation
        self._particles = ffi.new("gp_particles *")
        self._particles.struct_size = ffi.sizeof("gp_particles")
        hook = _Hook()
        hook.engine = weakref.ref(self)
        self._hook, self._handle = hook, ffi.new_handle(hook)
        self.watch = ffi.new("granperi_watch *")
        self.watch.self = self._handle
        self.watch.due = math.inf
        check(lib.granperi_attach(sim, self.watch))

    def __del__(self):
        self.destroy()

    def destroy(self) -> None:
        # A child of a fork must not close the output of its parent.
        if getattr(self, "watch", None) is not None and self.output_pid not in (0, self.getpid()):
            return
        sim, self.sim = getattr(self, "sim", None), None
        if sim:
            self.lib.gp_destroy(sim)

    def forget_export(self, export: int) -> None:
        self.exports.discard(export)
        if self.closed and not self.exports:
            self.destroy()

    def locked(self, name: str) -> _Lock:
        """For `with`: the calling thread has the simulation, which is open; else StateError on the call of this name."""
        return _Lock(self, name)

    def epoch(self) -> int:
        check(lib.gp_get_particles(self.sim, 0, self._particles))
        return self._particles.epoch

    def reached(self) -> float:
        """The clock [s]. A step that ends within rounding of a time has reached it."""
        clock = read_clock(self.sim)
        return clock.time + 1e-9 * clock.dt

    def count(self) -> int:
        check(lib.gp_get_particles(self.sim, 0, self._particles))
        return self._particles.count

    # ------------------------------------------------------------------------------------------------ changes

    def before_change(self, name: str) -> None:
        """Refuses while raw arrays show memory that the change may move."""
        if self.exports:
            gc.collect()
        if self.exports:
            raise StateError(f"{name}: {len(self.exports)} array(s) made by np.asarray of a view still show the memory "
                             "of this simulation: delete them first (del), or use copies (view.x.copy(), sim.x)")

    def advance(self, name: str, call: Callable[..., int], amount) -> int:
        """gp_step or gp_run, with what Python wants to happen in between. The engine is locked."""
        global _ran_threads
        if self.threads != 1:
            if _forked_after:
                raise StateError(f"{name}: this process was forked from one that had run simulations with several threads, "
                                 "and threads do not survive that: use threads=1, or the start method 'spawn'")
            _ran_threads = True
        if self.exports:
            self.before_change(name)
        watch = self.watch
        # In the main thread Python's signal handlers run: Ctrl-C and others stop the run.
        main = threading.get_ident() == _main_thread
        watch.interval = _LOOK if main or self.on_look else 0.0
        self.stopped = False
        watch.rested = 0
        self.running += 1
        try:
            if self.timers:
                self.ring()
            status = call(self.sim, watch, amount, main)
            if status < 0 and self.failure is None:
                check(status)
        finally:
            self.running -= 1
            if self.failure is not None:
                self._raise_failure()
        return status

    def _raise_failure(self) -> None:
        """The exception of a callback, as it was raised there."""
        failure, self.failure = self.failure, None
        assert failure is not None
        try:
            raise failure
        finally:
            del failure  # its traceback refers to this frame

    # ---------------------------------------------------------------------------------------------- call-backs

    def ring(self) -> bool:
        """Calls the timers that are due, and has the next one looked for. True if one of them stops the run."""
        reached, stop = self.reached(), False
        for timer in self.timers:
            stop = timer.ring(reached) or stop
        self.watch.due = min((timer.due for timer in self.timers), default=math.inf)
        return stop

    def look(self, due: int) -> int:
        """What is due between two steps. A non-zero return stops the run."""
        self.deliver()
        stop = due & 4 and self.ring()
        if due & 1 and self.callback is not None:
            self.stopped = bool(self.callback(self.owner()))
            if self.exports:
                self.before_change("the callback has returned, but")
        if due & 2 and self.on_look is not None:
            self.on_look()
        return int(stop or self.stopped)

    def fail(self, error: BaseException) -> None:
        """Keeps what a callback has raised until the library has returned."""
        if self.failure is None:
            self.failure = error

    def deliver(self) -> None:
        """What the library has said: warnings to the module warnings, the rest to the logger "granperi"."""
        while self.messages:
            level, text = self.messages.pop(0)
            if level >= lib.GP_LOG_WARNING:
                warnings.warn(text, GranperiWarning, stacklevel=_stack_level())
            else:
                log.info(text)


class _Hook:
    """What the library is given to find its engine by."""

    engine: weakref.ref


def _stack_level() -> int:
    """The level of the first caller outside the package, for warnings.warn in Engine.deliver."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back
    return level


def _store(kind, error, traceback) -> None:
    engine = ffi.from_handle(traceback.tb_frame.f_locals["handle"]).engine()
    if engine is not None:
        engine.fail(error.with_traceback(traceback))  # CFFI hands them over separately


@ffi.def_extern(name="granperi_look", error=1, onerror=_store)
def _on_look(handle, due):
    return ffi.from_handle(handle).engine().look(due)


@ffi.def_extern(name="granperi_log", onerror=_store)
def _on_log(handle, level, text):
    # The library may not be called from here, so what is said is delivered after the step or the call.
    engine = ffi.from_handle(handle).engine()
    if engine is not None:
        engine.messages.append((level, text_of(text)))
        engine.watch.attention = 1
