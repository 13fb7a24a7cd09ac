"""Views of the library's own arrays that cannot be read once they are out of date."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterator

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from ._enums import FIELD_NAMES, field_bits, field_names
from ._errors import StateError, check, near_match
from ._library import ffi, lib
from ._tables import as_html

if TYPE_CHECKING:
    from ._engine import Engine

_TYPES = {"id": "<i8", "column": "<i4"}


class _Memory:
    """The owner of a raw array: while it lives, the engine lives and refuses to change."""

    def __init__(self, engine: "Engine", address: int, count: int, typestr: str):
        self.engine = engine
        self.__array_interface__ = {"data": (address, True), "shape": (count,), "typestr": typestr, "version": 3}
        engine.exports.add(id(self))

    def __del__(self):
        self.engine.forget_export(id(self))


class FieldView(NDArrayOperatorsMixin):
    """One field of a View: float64 (id: int64, column: int32) of shape (n), read-only, in the library's own order.

    It can be used like an array. Each use checks whether the simulation has changed since, and raises StateError if so.
    What indexing, arithmetic and copy() give is independent of the simulation. np.asarray gives the memory itself: while
    such an array exists, the simulation refuses to step, so that the array never changes.
    """

    def __init__(self, view: "View", name: str, address: int):
        self._view, self._name, self._address = view, name, address

    def _raw(self) -> np.ndarray:
        engine, count = self._view._current()
        if count == 0:
            return np.empty(0, _TYPES.get(self._name, "<f8"))
        return np.asarray(_Memory(engine, self._address, count, _TYPES.get(self._name, "<f8")))

    def __array__(self, dtype=None, copy=None) -> np.ndarray:
        raw = self._raw()
        if copy or (dtype is not None and np.dtype(dtype) != raw.dtype):
            return np.array(raw, dtype=dtype)
        return raw

    def __array_ufunc__(self, ufunc, method, *inputs, **keywords):
        if any(isinstance(out, FieldView) for out in keywords.get("out", ())):
            raise ValueError(f"the view of {self._name} is read-only: take a copy")
        return getattr(ufunc, method)(*map(_plain, inputs), **keywords)

    def __array_function__(self, function, types, arguments, keywords):
        result = function(*map(_plain, arguments), **{name: _plain(value) for name, value in keywords.items()})
        return result

    def __getitem__(self, key):
        part = self._raw()[_plain(key)]
        return part.copy() if isinstance(part, np.ndarray) else part

    def __len__(self) -> int:
        return self._view._current()[1]

    def __iter__(self) -> Iterator:
        return iter(self.copy())

    def copy(self) -> np.ndarray:
        """An array of its own, in the library's order.

        Returns:
            Shape (n).

        Raises:
            StateError: the simulation has changed since.

        Example:
            print(sim.view("x").x.copy().shape)
        """
        return self._raw().copy()

    @property
    def shape(self) -> tuple[int]:
        """(n,)"""
        return (len(self),)

    @property
    def dtype(self) -> np.dtype:
        """Of numpy: float64; of id int64, of column int32."""
        return np.dtype(_TYPES.get(self._name, "<f8"))

    ndim = 1

    @property
    def size(self) -> int:
        """n"""
        return len(self)

    def min(self):
        """The smallest value.

        Returns:
            A number.

        Example:
            print(sim.view("x").x.min(), "m")
        """
        return self._raw().min()

    def max(self):
        """The largest value.

        Returns:
            A number.

        Example:
            print(sim.view("x").x.max(), "m")
        """
        return self._raw().max()

    def sum(self):
        """The sum of all values.

        Returns:
            A number.

        Example:
            print(sim.view("pressure").pressure.sum())
        """
        return self._raw().sum()

    def mean(self):
        """The mean of all values.

        Returns:
            A number.

        Example:
            print(sim.view("pressure").pressure.mean(), "Pa")
        """
        return self._raw().mean()

    def argmin(self):
        """The index of the smallest value in the library's order.

        Returns:
            A whole number.

        Example:
            view = sim.view("y", "id")
            print(view.id[view.y.argmin()], "is the lowest")
        """
        return self._raw().argmin()

    def argmax(self):
        """The index of the largest value in the library's order.

        Returns:
            A whole number.

        Example:
            view = sim.view("y", "id")
            print(view.id[view.y.argmax()], "is the highest")
        """
        return self._raw().argmax()

    def __repr__(self) -> str:
        if not self._view.valid:
            return f"<view of {self._name}, out of date>"
        return f"<view of {self._name}: {self._raw()!r}>"


def _plain(value: Any) -> Any:
    if isinstance(value, FieldView):
        return value._raw()
    if isinstance(value, (list, tuple)):
        return type(value)(map(_plain, value))
    return value


class View:
    """Fields of all particles without copies, as attributes: view.x, view.pressure, ...

    They are in the library's own order, which changes from step to step: ask for "id", too, where it matters. The view
    keeps the simulation alive, and is valid until the next call that changes it; then every use raises StateError.
    """

    def __init__(self, engine: "Engine", fields):
        names = field_names(fields)
        self._engine = engine
        with engine.locked("view"):
            particles = ffi.new("gp_particles *")
            particles.struct_size = ffi.sizeof("gp_particles")
            check(lib.gp_get_particles(engine.sim, field_bits(names), particles))
            self._count: int = particles.count
            self.epoch: int = particles.epoch
            self._fields = {name: FieldView(self, name, int(ffi.cast("uintptr_t", getattr(particles, name))))
                            for name in names}

    def _current(self) -> "tuple[Engine, int]":
        engine = self._engine
        with engine.locked("the use of a view"):
            if engine.epoch() != self.epoch:
                raise StateError(f"this view shows the simulation as it was (epoch {self.epoch}); it has changed since "
                                 f"(epoch {engine.epoch()}): take a new view, or a copy before the step")
        return engine, self._count

    @property
    def valid(self) -> bool:
        """Whether the simulation is still as the view shows it."""
        try:
            return self._current() is not None
        except StateError:
            return False

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the fields, in the library's order."""
        return tuple(self._fields)

    def __len__(self) -> int:
        return self._current()[1]

    def __getattr__(self, name: str) -> FieldView:
        fields = object.__getattribute__(self, "__dict__").get("_fields", {})
        if name in fields:
            self._current()
            return fields[name]
        if name in FIELD_NAMES:
            raise AttributeError(f"this view was not asked for '{name}': it has {', '.join(fields)}")
        raise AttributeError(f"a view has no '{name}': {near_match(name, FIELD_NAMES)}")

    def __getitem__(self, name: str) -> FieldView:
        try:
            return getattr(self, name)
        except AttributeError as error:
            raise KeyError(str(error)) from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._fields]

    def __repr__(self) -> str:
        return f"<granperi.View of {', '.join(self.names)}, epoch {self.epoch}{'' if self.valid else ', out of date'}>"


class Particles:
    """Copies of fields of all particles, each of shape (n), in the order of id, as attributes or by name."""

    def __init__(self, fields: dict[str, np.ndarray]):
        self.__dict__.update(fields)
        self._names = tuple(fields)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the fields."""
        return self._names

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._names:
            raise KeyError(f"'{name}' is not here: {near_match(name, self._names)}")
        return self.__dict__[name]

    def __getattr__(self, name: str) -> np.ndarray:
        raise AttributeError(f"'{name}' is not here: {near_match(name, self.__dict__.get('_names', ()))}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self.__dict__[self._names[0]]) if self._names else 0

    def _repr_html_(self) -> str:
        rows = range(len(self)) if len(self) <= 20 else [*range(10), *range(len(self) - 10, len(self))]
        return as_html(self._names, ([self[name][k] for name in self._names] for k in rows), repr(self)[1:-1])

    def __repr__(self) -> str:
        return f"<granperi.Particles: {', '.join(self._names)} of {len(self)} particles>"
