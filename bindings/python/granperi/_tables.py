"""Tables: CSV files that are whole or not there, and HTML for notebooks."""
from __future__ import annotations

import csv
import html
import io
import math
import os
from typing import Any, Iterable, Sequence

from ._errors import FileError


def require_free(path: "str | os.PathLike[str]", overwrite: bool) -> None:
    """The error on a file that exists and is not to be replaced."""
    if not overwrite and os.path.lexists(path):
        raise FileError(f"{os.fspath(path)} exists: name another file, or say overwrite=True to replace it")


def write_text(path: "str | os.PathLike[str]", text: str) -> None:
    """The new file or the old one, nothing between."""
    path = os.fspath(path)
    part = f"{path}.part-{os.getpid()}"
    try:
        with open(part, "w", encoding="utf-8", newline="") as file:
            file.write(text)
        os.replace(part, path)
    except OSError as error:
        if os.path.exists(part):
            os.remove(part)
        raise FileError(f"{path}: cannot be written: {error.strerror}") from None


def write_csv(path: "str | os.PathLike[str]", names: Sequence[str], rows: Iterable[Sequence[Any]], overwrite: bool) -> None:
    """A line of names and one per row; numbers with all their digits, true and false as 1 and 0."""
    require_free(path, overwrite)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    writer.writerows([_cell(value) for value in row] for row in rows)
    write_text(path, text.getvalue())


def _cell(value: Any) -> Any:
    value = value.item() if hasattr(value, "item") else value
    if isinstance(value, int):  # also bool and enumerations
        return int(value)
    return repr(value) if isinstance(value, float) else value


def shown(value: Any) -> str:
    """A value as a table for people has it: six digits."""
    value = value.item() if hasattr(value, "item") else value
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.6g}"
    return getattr(value, "name", None) or str(value)


def as_html(names: Sequence[str], rows: Iterable[Sequence[Any]], title: str = "") -> str:
    """For _repr_html_ of notebooks."""
    def line(cells: Iterable[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    return ("<table>" + (f"<caption>{html.escape(title)}</caption>" if title else "")
            + f"<thead>{line(names, 'th')}</thead><tbody>"
            + "".join(line(map(shown, row), "td") for row in rows) + "</tbody></table>")
