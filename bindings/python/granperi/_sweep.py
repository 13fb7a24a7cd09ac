"""Many runs of one scene with other values: a scene file for each, run beside each other, one table of the results."""
from __future__ import annotations

import concurrent.futures
import copy
import hashlib
import itertools
import json
import os
import re
import subprocess
import sys
from typing import Any, Iterable, Mapping

import numpy as np

from ._errors import ArgumentError, ArgumentTypeError, Error, FileError, whole
from ._progress import new_bar, require_tqdm
from ._result import Result
from ._scene import Scene, scene_of
from ._state import State
from ._tables import as_html, shown, write_csv, write_text

RESULTS = tuple(name for name in State.__annotations__ if name != "wall_seconds")
SHOWN = ("time", "n_particles", "step", "x_q05", "x_q95", "peak_height", "at_rest")


class Sweep:
    """The table of a sweep: a row per point, {"point": its name, each parameter, "status", and the fields of State at its end}.

    status: "complete", "missing" or what went wrong. sweep[0] is a row, sweep["peak_height"] a column of shape (points).
    """

    def __init__(self, directory: str, parameters: list[str], rows: list[dict[str, Any]]):
        self.directory, self.parameters, self.rows = directory, parameters, rows
        self.names = ["point", *parameters, "status", *RESULTS]

    @property
    def failed(self) -> list[dict[str, Any]]:
        """The rows that have no result."""
        return [row for row in self.rows if row["status"] != "complete"]

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self):
        return iter(self.rows)

    def __getitem__(self, key: "int | str") -> Any:
        if isinstance(key, str):
            if key not in self.names:
                raise KeyError(f"'{key}' is not here: {', '.join(self.names)}")
            return np.array([row.get(key, np.nan) for row in self.rows])
        return self.rows[key]

    def to_csv(self, path: "str | os.PathLike[str]", overwrite: bool = False) -> None:
        """Writes the table as CSV.

        Args:
            path: of the file.
            overwrite: replaces a file that exists.

        Raises:
            FileError: the file exists, and overwrite is false; or it cannot be written.

        Example:
            table = granperi.sweep("collapse.toml", {"config.spacing": [0.02]}, workers=1)
            table.to_csv("table.csv", overwrite=True)
        """
        write_csv(path, self.names, ([row.get(name, "") for name in self.names] for row in self.rows), overwrite)

    def _shown(self) -> tuple[list[str], list[list[Any]]]:
        names = [*self.parameters, "status", *SHOWN]
        return names, [[row.get(name, "") for name in names] for row in self.rows]

    def __str__(self) -> str:
        names, rows = self._shown()
        return "\n".join("  ".join(f"{cell:>{max(12, len(name))}.60}" for name, cell in zip(names, line))
                         for line in [names, *(list(map(shown, row)) for row in rows)])

    def _repr_html_(self) -> str:
        return as_html(*self._shown(), f"{self.directory}: {len(self)} points")


def points_of_parameters(parameters: Any) -> list[dict[str, Any]]:
    """All combinations of {key: values}, or the points of a list of {key: value}."""
    if isinstance(parameters, Mapping):
        for key, values in parameters.items():
            if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
                raise ArgumentTypeError(f"parameters[{key!r}] = {values!r:.80}: expected a list of values")
        points = [dict(zip(parameters, values)) for values in itertools.product(*map(list, parameters.values()))]
    else:
        try:
            points = [dict(point) for point in parameters]
        except (TypeError, ValueError):
            raise ArgumentTypeError(f"parameters = {parameters!r:.80}: expected {{key: [value, ...]}}, of which all combinations "
                                    "are run, or a list of points {key: value}") from None
    if not points or not points[0]:
        raise ArgumentError("parameters: there is no point: expected at least one key with one value")
    if any(list(point) != list(points[0]) for point in points):
        raise ArgumentError("parameters: the points have different keys: expected the same in each, in the same order")
    return [{key: value.item() if isinstance(value, np.generic) else value for key, value in point.items()} for point in points]


def _name_of(point: dict[str, Any]) -> str:
    """Of the scene file and the result, readable where that is short."""
    last = [key.rpartition(".")[2] for key in point]
    short = last if len(set(last)) == len(last) else list(point)
    text = "_".join(f"{name}={value:g}" if isinstance(value, float) and float(f"{value:g}") == value else f"{name}={value}"
                    for name, value in zip(short, point.values()))
    name = re.sub(r"[^\w.=+-]", "-", text, flags=re.ASCII)
    if name == text and len(name) <= 100:
        return name
    return f"{name[:80]}_{hashlib.sha256(repr(sorted(point.items())).encode()).hexdigest()[:8]}"


def prepare(scene: Any, parameters: Any, directory: "str | os.PathLike[str]" = "sweep", overwrite: bool = False) -> list[str]:
    """Writes DIRECTORY/POINT.toml for each point, points.txt with their names and sweep.json with their values; runs nothing.

    Every scene is built once, so that all mistakes are found before the first run. Returns the names of the points.
    """
    scene, directory = scene_of(scene), os.fspath(directory)
    points = points_of_parameters(parameters)
    if strange := [key for key in points[0] if not isinstance(key, str)]:
        raise ArgumentTypeError(f"key {strange[0]!r:.80}: expected a text such as 'config.spacing'")
    if os.path.exists(directory) and not os.path.isdir(directory):
        raise FileError(f"{directory}: is a file: expected a directory for the scenes and results of the sweep")
    if own := [key for key in points[0] if key.rpartition(".")[2] == "output"]:
        raise ArgumentError(f"key {own[0]!r}: a sweep names the files of its points itself")
    names = [_name_of(point) for point in points]
    if len(set(names)) < len(names):
        raise ArgumentError("parameters: two points are the same")
    texts = []
    for name, point in zip(names, points):
        one: Scene = copy.deepcopy(scene)
        for key, value in point.items():
            one.set(key, value)
        one.write_into(name)
        one.name = f"{scene.name}, {name}"
        one.build().close()
        texts.append(one.text(os.path.abspath(directory)))
    taken = [name for name, text in zip(names, texts) if _holds_another(os.path.join(directory, name), text)]
    if taken and not overwrite:
        raise FileError(f"{directory}/{taken[0]}.toml is another scene: name another directory, or say overwrite=True (--overwrite) "
                        f"to delete the {len(taken)} results of such")
    os.makedirs(directory, exist_ok=True)
    for name in taken:
        _delete_results(os.path.join(directory, name))
    for name, text in zip(names, texts):
        write_text(os.path.join(directory, name + ".toml"), text)
    write_text(os.path.join(directory, "points.txt"), "".join(f"{name}.toml\n" for name in names))
    write_text(os.path.join(directory, "sweep.json"),
               json.dumps({"points": [{"point": name, "values": point} for name, point in zip(names, points)]}, indent=1) + "\n")
    return names


def _holds_another(stem: str, text: str) -> bool:
    try:
        with open(stem + ".toml", encoding="utf-8") as file:
            return file.read() != text
    except FileNotFoundError:
        return False


def _delete_results(stem: str) -> None:
    for extension in (".h5", ".xdmf", ".gpc"):
        if os.path.exists(stem + extension):
            os.remove(stem + extension)
    if os.path.isdir(stem + ".part"):
        for file in os.listdir(stem + ".part"):
            os.remove(os.path.join(stem + ".part", file))


def collect(directory: "str | os.PathLike[str]" = "sweep") -> Sweep:
    """The table of what is there by now, however it was run; writes it to DIRECTORY/sweep.csv."""
    directory = os.fspath(directory)
    try:
        with open(os.path.join(directory, "sweep.json"), encoding="utf-8") as file:
            points = json.load(file)["points"]
    except (OSError, ValueError, KeyError) as error:
        raise FileError(f"{directory}: is no directory of a sweep, its sweep.json cannot be read: {error}; granperi.sweep() or "
                        "python3 -m granperi sweep makes one") from None
    rows = []
    for point in points:
        row = {"point": point["point"], **point["values"], "status": "complete"}
        stem = os.path.join(directory, point["point"])
        if os.path.exists(stem + ".h5"):
            row.update(_results_in(stem + ".h5"))
        else:
            row["status"] = _failure(stem)
        rows.append(row)
    table = Sweep(directory, list(points[0]["values"]) if points else [], rows)
    table.to_csv(os.path.join(directory, "sweep.csv"), overwrite=True)
    return table


def _results_in(path: str) -> dict[str, Any]:
    """The fields of State at the end of a result, or the status of one that cannot be read."""
    try:
        with Result(path) as result:
            last = result[-1].state
    except (Error, OSError, KeyError) as error:  # the latter two: of h5py, where a file is damaged within
        return {"status": f"{error}; delete it to run the point anew"}
    return {name: getattr(last, name) for name in RESULTS}


def _failure(stem: str) -> str:
    """The last line that a run has said which left no result."""
    try:
        with open(stem + ".log", encoding="utf-8", errors="replace") as file:
            lines = [line.strip() for line in file if line.startswith("granperi: ")]
    except FileNotFoundError:
        return "missing"
    return lines[-1].removeprefix("granperi: ") if lines else "missing"


class _Runs:
    """Processes beside each other, which are asked to save and end if the sweep is interrupted."""

    def __init__(self, directory: str):
        self._directory, self._stopping = directory, False
        self._running: set[subprocess.Popen] = set()
        package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        self._environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, [package, os.environ.get("PYTHONPATH")]))}

    def run(self, name: str) -> None:
        if self._stopping:
            return
        with open(os.path.join(self._directory, name + ".log"), "w", encoding="utf-8") as log:
            process = subprocess.Popen([sys.executable, "-m", "granperi", "run", name + ".toml", "--resume", "--no-progress"],
                                       cwd=self._directory, env=self._environment, stdin=subprocess.DEVNULL, stdout=log,
                                       stderr=log, start_new_session=True)
        self._running.add(process)
        if self._stopping:
            process.terminate()
        process.wait()
        self._running.discard(process)

    def stop(self) -> None:
        self._stopping = True
        for process in list(self._running):
            process.terminate()


def sweep(scene: Any, parameters: Any, directory: "str | os.PathLike[str]" = "sweep", workers: int | None = None,
          progress: bool = False, overwrite: bool = False) -> Sweep:
    """Runs a scene once per point, several at a time, and returns the table of results.

    Each point has a scene file in the directory, a result, a checkpoint and a log of what it said; the table is in sweep.csv.
    Called once more, it continues what was interrupted and leaves what is complete. A point that fails does not stop the others:
    table.failed. On Ctrl-C all save a checkpoint and end.

    Args:
        scene: a Scene, or the path of a scene file.
        parameters: {key: values}, of which all combinations are run, or a list of points {key: value}; keys as in Scene.set().
        directory: where the files are; it is made if need be.
        workers: processes at a time, at least 1; not given: the processors available, divided by the scene's threads.
        progress: shows a bar (needs tqdm).
        overwrite: a point whose scene file exists with other content is run anew, and its old result deleted.

    Returns:
        The Sweep: a row per point.

    Raises:
        SceneError: a point that the library refuses; all are built before the first run.
        ArgumentError: a key that does not exist, the same point twice, workers below 1.
        FileError: a point whose scene file exists with other content, and overwrite is false.

    Example:
        table = granperi.sweep("collapse.toml", {"config.spacing": [0.02, 0.01]}, workers=1)
        print(table["peak_height"])
    """
    require_tqdm(progress)
    scene = scene_of(scene)
    free, threads = len(os.sched_getaffinity(0)), scene.config.threads
    count = max(free // threads, 1) if threads > 0 else 1
    if workers is not None and (count := whole("workers", workers)) < 1:
        raise ArgumentError(f"workers = {count}: expected a whole number >= 1")
    directory = os.fspath(directory)
    names = prepare(scene, parameters, directory, overwrite)
    missing = [name for name in names if not os.path.exists(os.path.join(directory, name + ".h5"))]
    runs = _Runs(directory)
    with concurrent.futures.ThreadPoolExecutor(count) as pool:
        waiting = [pool.submit(runs.run, name) for name in missing]
        try:
            for one in _with_bar(concurrent.futures.as_completed(waiting), len(missing), progress):
                one.result()
        except BaseException:
            runs.stop()
            pool.shutdown(wait=True, cancel_futures=True)
            collect(directory)
            raise
    return collect(directory)


def _with_bar(finished: Iterable[Any], count: int, progress: bool) -> Iterable[Any]:
    if not progress:
        return finished
    return new_bar(iterable=finished, total=count, unit="run", desc="sweep")
