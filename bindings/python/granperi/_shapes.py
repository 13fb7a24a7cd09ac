"""Bodies of other shapes than a rectangle: the places of their particles."""
from __future__ import annotations

import os
from typing import Any

import numpy as np

from ._errors import ArgumentError, ArgumentTypeError, FileError, number, refuse_masked
from ._plate import points_of

MOST = 50_000_000  # places that are looked at


def _lattice(box: tuple[float, float, float, float], spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """The places of a column that fills the box x_min, y_min, x_max, y_max [m]: the first half a spacing inside its corner."""
    x_min, y_min, x_max, y_max = box
    n_x, n_y = (max(int(min(np.ceil(side / spacing - 1e-9), 1e9)), 0) for side in (x_max - x_min, y_max - y_min))
    if n_x * n_y > MOST:
        raise ArgumentError(f"a body of {x_max - x_min:g} x {y_max - y_min:g} m has more than {MOST} places at the spacing "
                            f"{spacing:g} m: expected a larger spacing, or a smaller body (lengths are in m)")
    x, y = np.meshgrid(x_min + (np.arange(n_x) + 0.5) * spacing, y_min + (np.arange(n_y) + 0.5) * spacing)
    return x.ravel(), y.ravel()


def in_polygon(points: Any, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """x, y [m] of the particles inside a polygon, by the even-odd rule; points: m, shape (n, 2), first = last or not."""
    px, py = points_of("points", points)
    if len(px) > 1 and px[0] == px[-1] and py[0] == py[-1]:
        px, py = px[:-1], py[:-1]
    if len(px) < 3 or not (np.isfinite(px).all() and np.isfinite(py).all()):
        raise ArgumentError(f"points: expected three or more finite corners, got {len(px)}"
                            + ("" if len(px) < 3 else ", of which some are not finite"))
    x, y = _lattice((px.min(), py.min(), px.max(), py.max()), spacing)
    inside = np.zeros(len(x), dtype=bool)
    for x0, y0, x1, y1 in zip(px, py, np.roll(px, -1), np.roll(py, -1)):
        if y0 != y1:
            crosses = (y0 <= y) != (y1 <= y)
            inside ^= crosses & (x < x0 + (y - y0) * ((x1 - x0) / (y1 - y0)))
    return _some(x[inside], y[inside], "polygon", spacing)


def in_mask(mask: Any, x_min: float, y_min: float, width: float, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """x, y [m] of the particles where a mask is true; mask: shape (rows, columns), the first row at the top, or the path of an
    image, in which what is darker than half is material. The left lower corner is at x_min, y_min [m]; pixels are square."""
    x_min, y_min, width = number("x_min", x_min), number("y_min", y_min), number("width", width)
    if not (np.isfinite([x_min, y_min]).all() and 0 < width < np.inf):
        raise ArgumentError(f"x_min = {x_min:g}, y_min = {y_min:g}, width = {width:g}: expected finite lengths in m, width above 0")
    filled = _dark(mask) if isinstance(mask, (str, os.PathLike)) else _as_mask(mask)
    rows, columns = filled.shape
    pixel = width / columns
    x, y = _lattice((x_min, y_min, x_min + width, y_min + rows * pixel), spacing)
    column = np.minimum(((x - x_min) / pixel).astype(int), columns - 1)
    row = rows - 1 - np.minimum(((y - y_min) / pixel).astype(int), rows - 1)
    inside = filled[row, column]
    return _some(x[inside], y[inside], "mask", spacing)


def _as_mask(mask: Any) -> np.ndarray:
    refuse_masked("mask", mask)
    try:
        array = np.asarray(mask)
    except ValueError:  # rows of different lengths
        array = np.empty(0)
    if array.ndim != 2 or not array.size or array.dtype.kind not in "biu" or not np.isin(array, (0, 1)).all():
        raise ArgumentTypeError(f"mask: expected true and false (or 1 and 0) of the shape (rows, columns), got {mask!r:.80}")
    return array.astype(bool)


def _dark(path: "str | os.PathLike[str]") -> np.ndarray:
    try:
        from PIL import Image
    except ImportError:
        raise ImportError("the image of a mask is read with Pillow (pip install pillow, or Debian's python3-pil); or give the "
                          "mask as an array") from None
    try:
        with open(path, "rb") as file, Image.open(file) as image:
            image = image.convert("RGBA")
            paper = Image.new("RGBA", image.size, "white")  # what is transparent is empty
            return np.asarray(Image.alpha_composite(paper, image).convert("L")) < 128
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        why = getattr(error, "strerror", None) or error
        raise FileError(f"{os.fspath(path)!r}: cannot be read as an image: {why}") from None


def _some(x: np.ndarray, y: np.ndarray, what: str, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    if not len(x):
        raise ArgumentError(f"the {what} holds no particle at the spacing {spacing:g} m: expected one wider than that, "
                            "in m; in an image the material is dark")
    return x, y
