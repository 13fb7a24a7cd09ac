"""What a run left behind, as one JSON file, and how to read it."""
from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from run import Run

FORMAT = 4  # of the files: those of another one are as if they were not there


class Result:
    """A run that went well. Times are looked up to a thousandth of a second."""

    def __init__(self, data: dict[str, Any]):
        self.name: str = data["name"]
        self.program: str = data["program"]
        self.source: str = data["source"]
        self.commit: str = data["commit"]
        self.machine: str = data["machine"]
        self.date: str = data["date"]
        self.output: str = data["output"]
        self.summary: dict[str, float] = data["summary"]
        self.tables = {
            name: {column: np.array(values, dtype=float) for column, values in table.items()}
            for name, table in data["tables"].items()
        }

    @property
    def cpu(self) -> float:
        """CPU s of the whole run."""
        return self.summary["cpu_seconds"]

    def cpu_to(self, time: float) -> float:
        """CPU s up to this time. The sound speed, hence the time step, does not change within a run."""
        return self.cpu * min(1.0, time / self.summary["time"])

    def at(self, column: str, time: float) -> float:
        """A column of the series at the row of this time; NaN if the run is shorter."""
        series = self.tables["series"]
        if len(series["time"]) == 0:
            return math.nan
        row = int(np.argmin(np.abs(series["time"] - time)))
        near = abs(series["time"][row] - time) < 1.01 * max(1e-3, np.diff(series["time"]).max() / 2)
        return float(series[column][row]) if near else math.nan

    def select(self, table: str, time: float, **equal: float) -> dict[str, np.ndarray]:
        """Rows of a table at this time (and these values of other columns)."""
        columns = self.tables.get(table, {})
        if not columns:
            return {}
        chosen = np.abs(columns["time"] - time) < 1e-3
        for name, value in equal.items():
            chosen &= np.abs(columns[name] - value) < 1e-9
        return {name: values[chosen] for name, values in columns.items()}

    def surface(self, time: float, everything: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """x and height of the connected deposit, or of all material; x has no gaps."""
        rows = self.select("surface", time)
        if rows and not everything:
            rows = {name: values[rows["connected"] == 1] for name, values in rows.items()}
        return (rows["x"], rows["height"]) if rows else (np.array([]), np.array([]))

    def interface_angle(self, time: float, low: float, high: float) -> float:
        """Degrees to the vertical of the line fitted to the interface between two fractions of its height; NaN for
        none. Positive: it leans to the right."""
        rows = self.select("interface", time)
        if not rows or len(rows["y"]) < 4:
            return math.nan
        top = rows["y"].max()
        inside = (rows["y"] >= low * top) & (rows["y"] <= high * top)
        if inside.sum() < 4:
            return math.nan
        return math.degrees(math.atan(np.polyfit(rows["y"][inside], rows["x"][inside], 1)[0]))


def path_of(run: Run, directory: Path) -> Path:
    return directory / f"{run.name}.json"


def load(run: Run, directory: Path) -> Result | None:
    """The result of a run; None if it is not there or did not go well."""
    data = load_raw(run, directory)
    return Result(data) if data and data["status"] == "ok" else None


def load_raw(run: Run, directory: Path) -> dict[str, Any] | None:
    path = path_of(run, directory)
    if not path.exists():
        return None
    data = json.loads(path.read_text(encoding="utf-8"))
    return data if data.get("format") == FORMAT else None


def save(run: Run, data: dict[str, Any], directory: Path) -> None:
    """Under another name first: a file that exists is whole."""
    directory.mkdir(parents=True, exist_ok=True)
    path = path_of(run, directory)
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps({**data, "format": FORMAT}), encoding="utf-8")
    partial.replace(path)


def read_summary(text: str) -> dict[str, float]:
    """Lines of "name value unit"; those whose value is not a number are left out."""
    summary = {}
    for line in text.splitlines():
        words = line.split()
        if len(words) < 2 or not words[0].isidentifier():
            continue
        try:
            summary[words[0]] = float(words[1])
        except ValueError:
            continue
    return summary


def read_tables(prefix: Path) -> dict[str, dict[str, list[float]]]:
    """The tables that a program wrote as prefix.name.csv, by name and column."""
    tables = {}
    for path in sorted(prefix.parent.glob(f"{prefix.name}.*.csv")):
        name = path.name[len(prefix.name) + 1 : -len(".csv")]
        with path.open(encoding="utf-8", newline="") as lines:
            rows = list(csv.reader(lines))
        header, body = rows[0], rows[1:]
        tables[name] = {column: [float(row[k]) for row in body] for k, column in enumerate(header)}
    return tables


class Collection:
    """All results of a directory, read when asked for; it remembers what was asked for and was not there."""

    def __init__(self, directory: Path):
        self.directory = directory
        self.found: dict[str, Result] = {}
        self.absent: dict[str, str] = {}  # name: why

    def __call__(self, run: Run) -> Result | None:
        if run.name in self.found:
            return self.found[run.name]
        raw = load_raw(run, self.directory)
        if raw is None:
            self.absent[run.name] = "not run"
        elif tuple(raw["arguments"]) != run.arguments:
            self.absent[run.name] = "its options have changed since it was run"
        elif raw["status"] != "ok":
            self.absent[run.name] = f"{raw['status']}: {raw['message']}"
        else:
            self.found[run.name] = Result(raw)
        return self.found.get(run.name)
