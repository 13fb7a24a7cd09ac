"""Config, Material and Column: keyword objects whose defaults are the library's own. Plate is in _plate.py."""
from __future__ import annotations

import copy
import enum
import inspect
import itertools
import keyword
import textwrap
from typing import Any, Iterator

import numpy as np

from ._enums import Density, InitialPressure, Preset, Stress, choice
from ._errors import ArgumentTypeError, check, doubles, near_match, number, pointer, whole
from ._library import ffi, lib
from ._reference import MEANINGS
from ._tables import as_html


class Parameters:
    """What the keyword objects share: one attribute per field of the library's struct.

    An unknown name is an error that lists the valid ones; numbers are checked by the library when the object is used.
    """

    _struct: str
    _enums: dict[str, type[enum.IntEnum]] = {}
    _tables: dict[str, tuple[str, ...]] = {}  # arrays of one length each, by the field that has their length
    _arrays: tuple[str, ...] = ()  # all of these
    _also: tuple[str, ...] = ()  # keywords that stand for several parameters
    _values: dict[str, Any]

    def __init_subclass__(cls) -> None:
        cls._arrays = tuple(name for table in cls._tables.values() for name in table)

    def __init__(self, **values: Any):
        object.__setattr__(self, "_values", dict(self._defaults()))
        for name, value in values.items():
            self._set(name, value)

    @classmethod
    def _defaults(cls) -> dict[str, Any]:
        return _defaults_of(cls)

    def _own_defaults(self) -> dict[str, Any]:
        return self._defaults()

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """The names of all parameters, in the library's order.

        Returns:
            A tuple of names.

        Example:
            print(granperi.Material.names())
        """
        return tuple(cls._defaults())

    def _set(self, name: str, value: Any) -> None:
        if name not in self._values:
            raise ArgumentTypeError(self._unknown(name))
        full = f"{self._struct}.{name}"
        if name in self._arrays:
            value = None if value is None else doubles(full, value).copy()
        elif name in self._enums:
            value = choice(self._enums[name], full, value)
        elif isinstance(self._defaults()[name], float):
            value = number(full, value)
        else:
            if isinstance(value, (bool, np.bool_)):
                value = int(value)
            value = whole(full, value)
        self._values[name] = value

    @classmethod
    def _unknown(cls, name: str) -> str:
        return f"{cls.__name__} has no '{name}': {near_match(name, [*cls.names(), *cls._also])}"

    def __getattr__(self, name: str) -> Any:
        values = object.__getattribute__(self, "__dict__").get("_values", {})
        if name in values:
            value = values[name]
            kind = self._enums.get(name)
            return kind(value) if kind and value in list(kind) else value
        if name.startswith("__"):
            raise AttributeError(name)
        raise AttributeError(self._unknown(name))

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._values and name not in self._also:
            raise AttributeError(self._unknown(name))
        self._set(name, value)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._values]

    def __iter__(self) -> Iterator[tuple[str, Any]]:
        return iter(self._values.items())

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(np.array_equal(a, b) if isinstance(a, np.ndarray) else a == b
                   for a, b in zip(self._values.values(), other._values.values()))  # type: ignore[attr-defined]

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        defaults = self._own_defaults()
        shown = [f"{name}={_shown(getattr(self, name))}" for name, value in self
                 if isinstance(value, np.ndarray) or value != defaults[name] or name == "preset" and value]
        return f"{type(self).__name__}({', '.join(shown)})"

    def _repr_html_(self) -> str:
        defaults = self._own_defaults()
        return as_html((type(self).__name__, "value", "default"),
                       [(name, _plain(getattr(self, name)), _plain(defaults[name])) for name, _ in self])

    def __getstate__(self) -> dict[str, Any]:
        return copy.deepcopy(self._values)

    def __setstate__(self, state: dict[str, Any]) -> None:
        object.__setattr__(self, "_values", {**self._defaults(), **state})

    def replace(self, **values: Any):
        """A copy with some values changed.

        Args:
            **values: parameters by keyword.

        Returns:
            The copy.

        Raises:
            ArgumentTypeError: a name that does not exist, or a value of the wrong type.

        Example:
            smooth = granperi.Plate.floor(-0.3, 0.3).replace(friction="free_slip")
        """
        other = copy.deepcopy(self)
        for name, value in values.items():
            other._set(name, value)
        return other

    def _fill(self):
        """The struct, and what has to live as long as it."""
        struct = _initialised(self._struct, *self._init_arguments())
        keep = []
        for length, names in self._tables.items():
            lengths = {name: len(self._values[name]) for name in names if self._values[name] is not None}
            if lengths:
                setattr(struct, length, self._length_of(names, lengths))
        for name, value in self._values.items():
            if name in self._arrays:
                if value is not None:
                    keep.append(pointer(value))
                    setattr(struct, name, keep[-1])
                continue
            field = name.rstrip("_")  # nonlocal_, because Python keeps nonlocal for itself
            try:
                setattr(struct, field, value)
            except OverflowError:
                raise ArgumentTypeError(f"{self._struct}.{field} = {value}: expected a number that fits into "
                                        f"{ffi.sizeof(_types(self._struct)[field].type) * 8} bits"
                                        f"{' and is not below 0' if value < 0 else ''}") from None
        return struct, keep

    def _length_of(self, names: tuple[str, ...], lengths: dict[str, int]) -> int:
        needed = [name for name in names if self._is_needed(name, lengths)]
        missing = [name for name in needed if name not in lengths]
        if missing or len(set(lengths.values())) > 1:
            raise ArgumentTypeError(
                f"{self._struct}: expected {', '.join(dict.fromkeys([*needed, *lengths]))} of one length, got "
                + ", ".join([f"{name} of {n}" for name, n in lengths.items()] + [f"no {name}" for name in missing]))
        return next(iter(lengths.values()))

    def _is_needed(self, name: str, given: dict[str, int]) -> bool:
        """Whether this array has to be there if those are."""
        return True

    def _init_arguments(self) -> tuple:
        return ()


def _shown(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"<{len(value)} values>"
    return repr(value.name.lower()) if isinstance(value, enum.Enum) else repr(value)


def _plain(value: Any) -> Any:
    """For tables: numbers as they are, the rest as its repr has it."""
    return value if isinstance(value, (int, float)) and not isinstance(value, enum.Enum) else "" if value is None else _shown(value)


def _types(struct: str) -> dict:
    return dict(ffi.typeof(struct).fields)


def _initialised(name: str, *more):
    struct = ffi.new(name + " *")
    check(getattr(lib, name + "_init")(struct, ffi.sizeof(name), *more))
    return struct


_cache: dict[Any, dict[str, Any]] = {}


def _defaults_of(cls, *more) -> dict[str, Any]:
    """Every parameter with the library's default; arrays are None, their length is no parameter of its own."""
    key = (cls, *more)
    if key not in _cache:
        struct = _initialised(cls._struct, *more)
        _cache[key] = {name + "_" * keyword.iskeyword(name): None if name in cls._arrays else getattr(struct, name)
                       for name in _types(cls._struct) if name not in ("struct_size", *cls._tables)}
    return _cache[key]


def described(struct: str, head: str) -> str:
    """A docstring: its head, and each parameter or value of the struct with type and meaning."""
    lines = [inspect.cleandoc(head), ""]
    for (kind, meaning), same in itertools.groupby(MEANINGS[struct].items(), lambda item: item[1]):
        lines.append(f"{', '.join(name for name, _ in same)}: {kind}")
        lines += textwrap.wrap(meaning, 100, initial_indent="    ", subsequent_indent="    ")
    if any("[1]" in meaning or "[4]" in meaning for _, meaning in MEANINGS[struct].values()):
        lines += ["", "[1] Jin, Lu, Tai & Xu (2021), J. Fluid Mech. 917; [4] Henann & Kamrin (2013), Proc. Natl. Acad. Sci. USA 110."]
    return "\n".join(lines)


def _signed(cls):
    """Shows the parameters, their defaults and meanings in help() and in the hints of editors."""
    kinds = {name: kind for name, (kind, _) in MEANINGS[cls._struct].items()}
    cls.__annotations__ = {name: kinds[name] for name in cls._defaults()}
    parameters = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=value,
                                    annotation=kinds.get(name, inspect.Parameter.empty))
                  for name, value in [*cls._defaults().items(), *((also, None) for also in cls._also)]]
    cls.__signature__ = inspect.Signature(parameters)
    cls.__doc__ = described(cls._struct, cls.__doc__)
    return cls


@_signed
class Material(Parameters):
    """A granular material; the default is glass beads."""

    _struct = "gp_material"


@_signed
class Column(Parameters):
    """A rectangle of particles."""

    _struct = "gp_column"
    _enums = {"initial_pressure": InitialPressure}


@_signed
class Config(Parameters):
    """The parameters of a simulation, in SI units; lengths in dl are in spacings. The defaults follow from the preset.

    Each with its unit, meaning, range and [default]:
    """

    _struct = "gp_config"
    _enums = {"preset": Preset, "stress": Stress, "density": Density}

    def __init__(self, preset: "int | str | Preset" = Preset.DEFAULT, **values: Any):
        chosen = choice(Preset, "gp_config.preset", preset)
        object.__setattr__(self, "_values", dict(_defaults_of(type(self), chosen)))
        for name, value in values.items():
            self._set(name, value)

    @classmethod
    def _defaults(cls) -> dict[str, Any]:
        return _defaults_of(cls, int(Preset.DEFAULT))

    def _own_defaults(self) -> dict[str, Any]:
        return _defaults_of(Config, self._values["preset"])

    def _init_arguments(self) -> tuple:
        return (self._values["preset"],)
