"""The tables of a scene file: what keys each has, and what it adds to a simulation."""
from __future__ import annotations

import dataclasses
import inspect
import math
from typing import Any, Callable

from ._enums import field_names
from ._errors import ArgumentError, ArgumentTypeError, near_match, number
from ._objects import Column, Config, Material
from ._plate import Plate
from ._profile import read_points
from ._simulation import Simulation


@dataclasses.dataclass
class Run:
    """How a scene is run: to `end` [s], a frame each `every` [s] in the file `output` ("" for none).

    until: "end", or "rest": the run is over when the material rests, at the latest at `end`.
    """

    end: float = 1.0
    every: float = 0.01
    output: str = ""
    fields: Any = "default"
    until: str = "end"


def _callable_keys(function: Callable) -> list[str]:
    return [name for name, parameter in inspect.signature(function).parameters.items()
            if parameter.kind is not inspect.Parameter.VAR_KEYWORD]


# Tables that may stand several times, and what they accept.
LISTS: dict[str, list[str]] = {
    "material": ["name", *Material.names()],
    "column": list(Column.names()),
    "particles": ["x", "y", "vx", "vy", "material"],
    "plate": list(Plate.names()),
    "floor": [*_callable_keys(Plate.floor), "friction", "wall_mu", "fluidity"],
    "wall": [*_callable_keys(Plate.wall), "friction", "wall_mu", "fluidity"],
    "gate": [name for name in _callable_keys(Plate.gate) if name != "spacing"],
    "polygon": ["points", "file", "material", "vx", "vy"],
    "mask": ["file", "mask", "x_min", "y_min", "width", "material", "vx", "vy"],
    "probe": ["points", "fields", "plates", "every", "radius", "output"],
    "wall_line": ["points", "file", "closed", "material",
                  *[name for name in Plate.names() if name not in ("x0", "y0", "x1", "y1", "point_x", "point_y")]],
}
RUN = [field.name for field in dataclasses.fields(Run)]
CONFIG = [name.rstrip("_") for name in Config.names()]


def make_config(values: dict[str, Any]) -> Config:
    return Config(**{"nonlocal_" if key == "nonlocal" else key: value for key, value in values.items()})


def make_run(values: dict[str, Any]) -> Run:
    run = Run(**values)
    run.end, run.every = number("end", run.end), number("every", run.every)
    if not (0 < run.end < math.inf and 0 < run.every < math.inf):
        raise ArgumentError(f"end = {run.end:g}, every = {run.every:g}: expected finite numbers above 0")
    if not isinstance(run.output, str):
        raise ArgumentTypeError(f"output = {run.output!r}: expected the name of a file")
    if run.until not in ("end", "rest"):
        raise ArgumentError(f"until = {run.until!r:.80}: expected 'end' or 'rest'")
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


def _points(values: dict[str, Any]) -> Any:
    """The points of a line, given as such or in a file."""
    points, file = values.pop("points", None), values.pop("file", None)
    if (points is None) == (file is None):
        raise ArgumentError("expected either points = [[x, y], ...] or file = the name of a file of two columns, x and y"
                            + ("" if file is None else ", not both"))
    return read_points(file) if points is None else points


def _mask(values: dict[str, Any]) -> Any:
    """A mask, given as such or as the file of an image."""
    mask, file = values.pop("mask", None), values.pop("file", None)
    if (mask is None) == (file is None):
        raise ArgumentError("expected either mask = [[0, 1, ...], ...] or file = the name of an image"
                            + ("" if file is None else ", not both"))
    return file if mask is None else mask


def _wall_line(values: dict[str, Any]) -> Plate:
    points, closed = _points(values), values.pop("closed", None)
    if closed is not None and not isinstance(closed, bool):
        raise ArgumentTypeError(f"closed = {closed!r}: expected true or false")
    return Plate.line(points, bool(closed), **values)


BUILDERS: dict[str, Callable[[Simulation, dict[str, Any], dict[Any, int]], Any]] = {
    "material": _build_material,
    "column": lambda sim, values, materials: sim.add_column(**_with_material(values, materials)),
    "particles": lambda sim, values, materials: sim.add_particles(**_with_material(values, materials)),
    "polygon": lambda sim, values, materials: sim.add_polygon(_points(values), **_with_material(values, materials)),
    "mask": lambda sim, values, materials: sim.add_mask(_mask(values), **_with_material(values, materials)),
    "probe": lambda sim, values, materials: None,  # Scene.add_probes: what a run asks for, not the scene
    "plate": lambda sim, values, materials: sim.add_plate(**values),
    "floor": lambda sim, values, materials: sim.add_plate(Plate.floor(**values)),
    "wall": lambda sim, values, materials: sim.add_plate(Plate.wall(**values)),
    "gate": lambda sim, values, materials: sim.add_plate(Plate.gate(**values, spacing=sim.config.spacing)),
    "wall_line": lambda sim, values, materials: sim.add_plate(_wall_line(values)),
}
