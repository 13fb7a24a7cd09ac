"""What a simulation holds: the engine, what it was made of, and when it ends."""
from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any, Mapping

from ._engine import Engine
from ._errors import ArgumentTypeError, StateError, check, near_match
from ._library import ffi, lib
from ._objects import Column, Config, Material, Parameters
from ._plate import Plate
from ._state import History

if TYPE_CHECKING:
    from typing import Self, Unpack

    from ._objects import ConfigValues


def taken(kind: type[Parameters], given: Any, values: Mapping[str, Any]) -> Any:
    """The object given, with the values given, or a new one; always one that nobody else can change."""
    if given is None:
        return kind(**values)
    if not isinstance(given, kind):
        raise ArgumentTypeError(f"expected a {kind.__name__} or its parameters by keyword, got {given!r:.80}")
    return given.replace(**values)


class SimulationBase:
    """The first of the classes that Simulation is made of: scene, reading, running and files come on top of it."""

    def __init__(self, config: Config | None = None, **values: Unpack[ConfigValues]):
        """config: a Config, or its parameters by keyword."""
        self._config = taken(Config, config, values)
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
        #: States that frames() and record() have kept.
        self.history = History()

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
            output, engine.output = engine.output, None
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

    def __enter__(self) -> Self:
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

    def _changing(self, name: str):
        engine = self._engine
        if engine.exports and not engine.closed:
            engine.before_change(name)
        return engine.locked(name)
