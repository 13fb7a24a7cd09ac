"""Scenes: what a simulation is made of, from a TOML file or by keyword, to build at any spacing."""
from __future__ import annotations

import dataclasses
import inspect
import math
import os
import re
import tomllib
from typing import Any, Callable, Iterator

from ._enums import field_names
from ._errors import ArgumentError, ArgumentTypeError, Error, near_match, number
from ._objects import Column, Config, Material
from ._plate import Plate
from ._profile import read_points
from ._simulation import Simulation
from ._state import History


class SceneError(ArgumentError):
    """A scene file that cannot be read as one; the text names file, line and table."""


@dataclasses.dataclass
class Run:
    """How a scene is run: to `end` [s], a frame each `every` [s] in the file `output` ("" for none)."""

    end: float = 1.0
    every: float = 0.01
    output: str = ""
    fields: Any = "default"


@dataclasses.dataclass
class _Part:
    """One table of the file: its values, and where it stands."""

    kind: str
    values: dict[str, Any]
    file: str
    line: str  # ", line N" or nothing
    title: str

    def where(self, line: str = "") -> str:
        return f"{self.file}{line or self.line}, {self.title}"


def _callable_keys(function: Callable) -> list[str]:
    return [name for name, parameter in inspect.signature(function).parameters.items()
            if parameter.kind is not inspect.Parameter.VAR_KEYWORD]


# Tables that may stand several times, and what they accept.
_LISTS: dict[str, list[str]] = {
    "material": ["name", *Material.names()],
    "column": list(Column.names()),
    "particles": ["x", "y", "vx", "vy", "material"],
    "plate": list(Plate.names()),
    "floor": [*_callable_keys(Plate.floor), "friction", "wall_mu", "fluidity"],
    "wall": [*_callable_keys(Plate.wall), "friction", "wall_mu", "fluidity"],
    "gate": [name for name in _callable_keys(Plate.gate) if name != "spacing"],
    "wall_line": ["points", "file", "closed", "material",
                  *[name for name in Plate.names() if name not in ("x0", "y0", "x1", "y1", "point_x", "point_y")]],
}
_RUN = [field.name for field in dataclasses.fields(Run)]
_CONFIG = [name.rstrip("_") for name in Config.names()]


class Scene:
    """A scene, independent of its spacing.

        scene = granperi.Scene.read("collapse.toml")
        with scene.build() as sim:
            sim.run(scene.run.end)

    A scene file (TOML) has the sections [config], [run], [[material]], [[column]], [[particles]], [[plate]], [[floor]],
    [[wall]], [[gate]] and [[wall_line]], whose points may be in a file beside it.
    """

    def __init__(self, config: Config | None = None, run: Run | None = None, name: str = "scene"):
        self.config, self.run, self.name = config or Config(), run or Run(), name
        self._parts: list[_Part] = []
        self._config_line = ""

    def add(self, kind: str, **values: Any) -> None:
        """Adds a table as in a scene file: "material", "column", "particles", "plate", "floor", "wall", "gate" or
        "wall_line"."""
        number_of_kind = 1 + sum(part.kind == kind for part in self._parts)
        self._add(_Part(kind, values, self.name, "", f"{kind} {number_of_kind}"), lambda key: "")

    def _add(self, part: _Part, line_of: Callable[[str], str]) -> None:
        if part.kind not in _LISTS:
            raise SceneError(f"{part.where()}: there is no table '{part.kind}': {near_match(part.kind, _LISTS)}")
        for key in part.values:
            if key not in _LISTS[part.kind]:
                raise SceneError(f"{part.where(line_of(key))}: unknown key '{key}': {near_match(key, _LISTS[part.kind])}")
        self._parts.append(part)

    # ------------------------------------------------------------------------------------------------ reading

    @classmethod
    def read(cls, path: "str | os.PathLike[str]") -> "Scene":
        """Reads a scene file (TOML). What is unknown or of the wrong type is a SceneError with its line."""
        path = os.fspath(path)
        try:
            with open(path, "rb") as file:
                text = file.read().decode("utf-8")
        except OSError as error:
            raise SceneError(f"{path}: cannot be read: {error.strerror}") from None
        except UnicodeDecodeError as error:
            raise SceneError(f"{path}: is not UTF-8 text (byte {error.start})") from None
        return cls.parse(text, path)

    @classmethod
    def parse(cls, text: str, name: str = "scene") -> "Scene":
        """A scene from the text of a scene file."""
        try:
            tables = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise SceneError(f"{name}: is not TOML: {error}") from None
        lines = _Lines(text)
        scene = cls(name=name)
        known = ["config", "run", *_LISTS]
        for kind, content in tables.items():
            if kind not in known:
                raise SceneError(f"{name}{lines.where(kind)}: unknown table or key '{kind}': {near_match(kind, known)}")
        scene.config = scene._keywords(tables, lines, "config", _CONFIG, _make_config)
        scene.run = scene._keywords(tables, lines, "run", _RUN, _make_run)
        for kind in _LISTS:
            several = tables.get(kind, [])
            if not isinstance(several, list) or not all(isinstance(one, dict) for one in several):
                raise SceneError(f"{name}{lines.where(kind)}: expected [[{kind}]] with two brackets, as there may be "
                                 "several")
            for k, values in enumerate(several):
                if kind == "wall_line" and isinstance(values.get("file"), str):
                    values = {**values, "file": os.path.join(os.path.dirname(name), values["file"])}
                part = _Part(kind, values, name, lines.where(kind, k), f"[[{kind}]] number {k + 1}")
                scene._add(part, lambda key: lines.where(kind, k, key))
        # Columns and plates are numbered as they stand in the file, of whatever kind.
        scene._parts.sort(key=lambda part: int(part.line.rpartition(" ")[2] or 0))
        scene._config_line = lines.where("config")
        return scene

    def _keywords(self, tables: dict, lines: "_Lines", kind: str, valid: list[str], make: Callable) -> Any:
        values = tables.get(kind, {})
        if not isinstance(values, dict):
            raise SceneError(f"{self.name}{lines.where(kind)}: expected a table [{kind}]")
        for key in values:
            if key not in valid:
                raise SceneError(f"{self.name}{lines.where(kind, 0, key)}, [{kind}]: unknown key '{key}': "
                                 f"{near_match(key, valid)}")
        try:
            return make(values)
        except Error as error:
            raise SceneError(f"{self.name}{lines.where(kind)}, [{kind}]: {error}") from None

    # ----------------------------------------------------------------------------------------------- building

    def build(self, spacing: float | None = None) -> Simulation:
        """A simulation of the scene, at its own spacing or at another one [m]."""
        config = self.config if spacing is None else self.config.replace(spacing=spacing)
        try:
            sim = Simulation(config)
        except Error as error:
            raise SceneError(f"{self.name}{self._config_line}, [config]: {error}") from None
        materials: dict[Any, int] = {0: 0}
        order = sorted(self._parts, key=lambda part: part.kind != "material")  # stable: materials first
        for part in order:
            try:
                _builders[part.kind](sim, dict(part.values), materials)
            except (Error, TypeError) as error:
                sim.close()
                raise SceneError(f"{part.where()}: {error}") from None
        return sim

    @property
    def fixed_spacing(self) -> bool:
        """Whether it has particles given one by one, whose spacing is theirs."""
        return any(part.kind == "particles" for part in self._parts)

    def smallest_side(self) -> float:
        """The smallest width or height [m] of the scene's columns. ArgumentError: it has none, or particles given one by one,
        whose spacing is theirs."""
        if self.fixed_spacing:
            raise ArgumentError(f"{self.name}: has particles given one by one, whose spacing is theirs: expected a scene of "
                                "columns, or a length in m")
        sides = self.column_sides()
        if not sides:
            raise ArgumentError(f"{self.name}: has no column whose sides could be resolved: expected a scene of columns, or a "
                                "length in m")
        return min(sides)

    def column_sides(self) -> list[float]:
        """Width and height [m] of each of the scene's columns."""
        return [self._side(part, key) for part in self._parts if part.kind == "column" for key in ("width", "height")]

    @staticmethod
    def _side(column: _Part, key: str) -> float:
        try:
            side = number(f"gp_column.{key}", column.values.get(key, 0.0))
            if not (math.isfinite(side) and side > 0):
                raise ArgumentError(f"gp_column.{key} = {side:g}: expected a finite number above 0")
        except Error as error:
            raise SceneError(f"{column.where()}: {error}") from None
        return side

    def record(self, path: str | None = None, progress: bool = False) -> History:
        """Builds the scene and runs it as its table [run] says; the frames go to `path` or run.output."""
        with self.build() as sim:
            path = path or self.run.output
            if path:
                return sim.record(path, self.run.end, self.run.every, self.run.fields, progress)
            for _ in sim.frames(self.run.end, self.run.every, progress):
                pass
            return sim.history

    def __repr__(self) -> str:
        counts = {kind: sum(part.kind == kind for part in self._parts) for kind in _LISTS}
        return f"<granperi.Scene {self.name}: {', '.join(f'{n} {kind}' for kind, n in counts.items() if n)}>"


def _make_config(values: dict[str, Any]) -> Config:
    return Config(**{"nonlocal_" if key == "nonlocal" else key: value for key, value in values.items()})


def _make_run(values: dict[str, Any]) -> Run:
    run = Run(**values)
    run.end, run.every = number("end", run.end), number("every", run.every)
    if not (run.end > 0 and run.every > 0):
        raise ArgumentError(f"end = {run.end:g}, every = {run.every:g}: expected numbers above 0")
    if not isinstance(run.output, str):
        raise ArgumentTypeError(f"output = {run.output!r}: expected the name of a file")
    if run.fields != "default":
        field_names(run.fields)
    return run


def _with_material(values: dict[str, Any], materials: dict[Any, int]) -> dict[str, Any]:
    wanted = values.get("material", 0)
    if isinstance(wanted, str):
        if wanted not in materials:
            names = [name for name in materials if isinstance(name, str)]
            raise ArgumentError(f"material = {wanted!r}: {near_match(wanted, names)}")
        values["material"] = materials[wanted]
    return values


def _build_material(sim: Simulation, values: dict[str, Any], materials: dict[Any, int]) -> None:
    name = values.pop("name", None)
    if name in materials:
        raise ArgumentError(f"name = {name!r}: another material has this name")
    k = sim.add_material(**values)
    if name is not None:
        materials[name] = k


def _wall_line(values: dict[str, Any]) -> Plate:
    points, file, closed = (values.pop(name, None) for name in ("points", "file", "closed"))
    if (points is None) == (file is None):
        raise ArgumentError("expected either points = [[x, y], ...] or file = the name of a file of two columns, x and y"
                            + ("" if file is None else ", not both"))
    if closed is not None and not isinstance(closed, bool):
        raise ArgumentTypeError(f"closed = {closed!r}: expected true or false")
    return Plate.line(read_points(file) if points is None else points, bool(closed), **values)


_builders: dict[str, Callable[[Simulation, dict[str, Any], dict[Any, int]], Any]] = {
    "material": _build_material,
    "column": lambda sim, values, materials: sim.add_column(**_with_material(values, materials)),
    "particles": lambda sim, values, materials: sim.add_particles(**_with_material(values, materials)),
    "plate": lambda sim, values, materials: sim.add_plate(**values),
    "floor": lambda sim, values, materials: sim.add_plate(Plate.floor(**values)),
    "wall": lambda sim, values, materials: sim.add_plate(Plate.wall(**values)),
    "gate": lambda sim, values, materials: sim.add_plate(Plate.gate(**values, spacing=sim.config.spacing)),
    "wall_line": lambda sim, values, materials: sim.add_plate(_wall_line(values)),
}


class _Lines:
    """Where tables and keys stand in the text, for messages; tomllib does not tell."""

    def __init__(self, text: str):
        self._at: dict[tuple[str, int, str], int] = {}
        count: dict[str, int] = {}
        table, k = "", 0
        for line, content in enumerate(text.splitlines(), 1):
            if header := re.match(r"\s*\[\[?\s*[\"']?([\w-]+)[\"']?\s*\]", content):
                table = header.group(1)
                k = count.get(table, 0)
                count[table] = k + 1
                self._at[table, k, ""] = line
            elif key := re.match(r"\s*[\"']?([\w-]+)[\"']?\s*[=.]", content):
                self._at.setdefault((table, k, key.group(1)), line)
                if not table:
                    self._at.setdefault((key.group(1), 0, ""), line)

    def where(self, table: str, k: int = 0, key: str = "") -> str:
        """", line N" of the key or the table; nothing if it cannot be told."""
        line = self._at.get((table, k, key), self._at.get((table, k, "")))
        return f", line {line}" if line else ""


def scene_of(scene: Any) -> Scene:
    """A scene, or that of a path."""
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, (str, os.PathLike)):
        return Scene.read(scene)
    raise ArgumentTypeError(f"{scene!r:.80}: expected a Scene or the path of a scene file")
