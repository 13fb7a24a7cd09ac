"""The scene in a checkpoint: what Python wants to know of a simulation that it has not built itself."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._errors import FileError
from ._objects import Column, Config, Material
from ._plate import Plate


def scene_in(path: str) -> tuple[Config, list[Material], "list[Column | int]", list[Plate]]:
    """Config, materials, columns (of a set of particles the material only) and plates of a checkpoint."""
    try:
        import h5py
    except ImportError:
        raise ImportError("what scene a checkpoint has is read with h5py (pip install h5py, or Debian's python3-h5py); or give load() the "
                          "config of the simulation that was saved") from None
    try:
        with h5py.File(path, "r") as file:
            attributes = {name + "_" * (name == "nonlocal"): value for name, value in file["config"].attrs.items()}
            config = Config(attributes.pop("preset"), **{name: _plain(attributes[name]) for name in attributes
                                                         if name in Config.names()})
            materials = [Material(**row) for row in _rows(file["materials"], Material.names())]
            columns = [_column(row) for row in _rows(file["bodies"], _BODY)]
            return config, materials, columns, _plates(file["plates"])
    except (OSError, KeyError) as error:
        raise FileError(f"{path}: the scene in this checkpoint cannot be read: {error}") from None


_BODY = ("material", "is_column", "initial_pressure", "x_min", "y_min", "width", "height", "column_vx", "column_vy")


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, (np.ndarray, np.generic)) else value


def _rows(group: Any, names: tuple[str, ...]) -> list[dict[str, Any]]:
    table = [group[name][()].tolist() for name in names]
    return [dict(zip(names, row)) for row in zip(*table)]


def _column(row: dict[str, Any]) -> "Column | int":
    if not row.pop("is_column"):
        return row["material"]
    row["vx"], row["vy"] = row.pop("column_vx"), row.pop("column_vy")
    return Column(**row)


def _plates(group: Any) -> list[Plate]:
    """The arrays of all plates stand one after the other; a straight plate has two points, which are its ends."""
    arrays = {name: group[name][()] for name in Plate._arrays}
    taken = dict.fromkeys(arrays, 0)

    def take(name: str, n: int) -> np.ndarray:
        begin = taken[name]
        taken[name] += n
        return arrays[name][begin:begin + n]

    numbers = tuple(name for name in Plate.names() if name not in Plate._arrays and name not in _ENDS)
    plates = []
    for row, counts in zip(_rows(group, numbers), _rows(group, ("n_points", "n_knots", "n_knot_angles"))):
        x, y = (take(name, counts["n_points"] or 2) for name in ("point_x", "point_y"))
        row.update({"point_x": x, "point_y": y} if counts["n_points"] else dict(zip(_ENDS, (x[0], y[0], x[1], y[1]))))
        if counts["n_knots"]:
            row.update({name: take(name, counts["n_knots"]) for name in ("knot_t", "knot_x", "knot_y")})
        if counts["n_knot_angles"]:
            row["knot_angle"] = take("knot_angle", counts["n_knot_angles"])
        plates.append(Plate(**row))
    return plates


_ENDS = ("x0", "y0", "x1", "y1")
