"""Lines from files of two columns: profiles of terrain, outlines of obstacles."""
from __future__ import annotations

import os
import re

import numpy as np

from ._errors import ArgumentError, ArgumentTypeError


def read_points(path: "str | os.PathLike[str]") -> np.ndarray:
    """Points [m], shape (n, 2), of a text file: one x and one y per line, with a comma, a semicolon or blanks between them.

    Empty lines and what follows a # do not count; the first line that does may be a title. Anything else is an
    ArgumentError that names file and line.
    """
    if not isinstance(path, (str, os.PathLike)):
        raise ArgumentTypeError(f"file = {path!r}: expected the name of a file of two columns, x and y")
    try:
        with open(path, encoding="utf-8-sig") as file:
            lines = file.read().splitlines()
    except OSError as error:
        raise ArgumentError(f"{os.fspath(path)}: cannot be read: {error.strerror}") from None
    except ValueError as error:  # no UTF-8; a 0 in the name
        raise ArgumentError(f"{os.fspath(path)!r}: cannot be read as text: {error}") from None
    points: list[list[float]] = []
    titled = False
    for k, line in enumerate(lines, 1):
        content = line.partition("#")[0].strip()
        if not content:
            continue
        try:
            x, y = (float(word) for word in re.split(r"\s*[,;]\s*|\s+", content))
            points.append([x, y])
        except ValueError:
            if points or titled or re.search(r"\d", content):
                raise ArgumentError(f"{os.fspath(path)}, line {k}: expected two numbers, x and y in m, got "
                                    f"{content!r:.60}") from None
            titled = True
    if len(points) < 2:
        raise ArgumentError(f"{os.fspath(path)}: has {len(points)} points, expected two or more lines of x and y")
    return np.array(points)
