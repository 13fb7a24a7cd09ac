"""Scenes: what a simulation is made of, from a TOML file or by keyword, to build at any spacing."""
from __future__ import annotations

import math
import os
import tomllib
from typing import Any, Callable

from . import _toml
from ._errors import ArgumentError, ArgumentTypeError, Error, near_match, number
from ._objects import Config
from ._probe import Probe
from ._record import CHECKPOINT_SECONDS, record_scene
from ._result import HDF5_SIGNATURE
from ._scene_file import Lines, Part, SceneError
from ._scene_tables import BUILDERS, CONFIG, LISTS, RUN, Run, make_config, make_run
from ._simulation import Simulation
from ._state import History
from ._tables import require_free, write_text


class Scene:
    """A scene, independent of its spacing.

        scene = granperi.Scene.read("collapse.toml")
        with scene.build() as sim:
            sim.run(scene.run.end)

    A scene file (TOML) has the sections [config], [run], [[material]], [[column]], [[particles]], [[polygon]], [[mask]],
    [[plate]], [[floor]], [[wall]], [[gate]], [[wall_line]] and [[probe]]. Points and masks may be in a file beside it.
    """

    def __init__(self, config: Config | None = None, run: Run | None = None, name: str = "scene"):
        self.config, self.run, self.name = config or Config(), run or Run(), name
        self._parts: list[Part] = []
        self._config_line = ""

    def add(self, kind: str, **values: Any) -> None:
        """Adds a table as in a scene file.

        Args:
            kind: "material", "column", "particles", "polygon", "mask", "plate", "floor", "wall", "gate", "wall_line" or
                "probe".
            **values: the keys of that table; units and ranges as in the call of that name.

        Raises:
            SceneError: a kind or a key that does not exist. Values are checked by build().

        Example:
            scene = granperi.Scene(granperi.Config(spacing=0.01))
            scene.add("column", width=0.1, height=0.05)
            scene.add("floor", x_left=-0.3, x_right=0.4)
        """
        number_of_kind = 1 + sum(part.kind == kind for part in self._parts)
        self._add(Part(kind, values, self.name, "", f"{kind} {number_of_kind}"), lambda key: "")

    def _add(self, part: Part, line_of: Callable[[str], str]) -> None:
        if part.kind not in LISTS:
            raise SceneError(f"{part.where()}: there is no table '{part.kind}': {near_match(part.kind, LISTS)}")
        for key in part.values:
            if key not in LISTS[part.kind]:
                raise SceneError(f"{part.where(line_of(key))}: unknown key '{key}': {near_match(key, LISTS[part.kind])}")
        self._parts.append(part)

    # ------------------------------------------------------------------------------------------------ reading

    @classmethod
    def read(cls, path: "str | os.PathLike[str]") -> "Scene":
        """Reads a scene file (TOML).

        Args:
            path: of the file.

        Returns:
            The Scene.

        Raises:
            SceneError: it cannot be read, or has something unknown or of the wrong type; the text names the line.

        Example:
            scene = granperi.Scene.read("collapse.toml")
            print(scene)
        """
        path = os.fspath(path)
        try:
            with open(path, "rb") as file:
                content = file.read()
            text = content.decode("utf-8")
        except OSError as error:
            raise SceneError(f"{path}: cannot be read: {error.strerror}") from None
        except UnicodeDecodeError as error:
            if HDF5_SIGNATURE in content:
                raise SceneError(f"{path}: is an HDF5 file, no scene: expected a scene file (TOML). granperi.Result reads a result; from a "
                                 "checkpoint granperi.load() and granperi-mpi go on, and the run of its scene with --resume") from None
            raise SceneError(f"{path}: is not UTF-8 text (byte {error.start})") from None
        return cls.parse(text, path)

    @classmethod
    def parse(cls, text: str, name: str = "scene") -> "Scene":
        r"""A scene from the text of a scene file.

        Args:
            text: TOML.
            name: for messages; files that the scene names are looked for beside this path.

        Returns:
            The Scene.

        Raises:
            SceneError: something unknown or of the wrong type; the text names the line.

        Example:
            scene = granperi.Scene.parse("[[column]]\nwidth = 0.1\nheight = 0.05\n")
        """
        try:
            tables = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise SceneError(f"{name}: is not TOML: {error}") from None
        lines = Lines(text)
        scene = cls(name=name)
        known = ["config", "run", *LISTS]
        for kind, content in tables.items():
            if kind not in known:
                raise SceneError(f"{name}{lines.where(kind)}: unknown table or key '{kind}': {near_match(kind, known)}")
        scene.config = scene._keywords(tables, lines, "config", CONFIG, make_config)
        scene.run = scene._keywords(tables, lines, "run", RUN, make_run)
        for kind in LISTS:
            several = tables.get(kind, [])
            if not isinstance(several, list) or not all(isinstance(one, dict) for one in several):
                raise SceneError(f"{name}{lines.where(kind)}: expected [[{kind}]] with two brackets, as there may be "
                                 "several")
            for k, values in enumerate(several):
                if isinstance(values.get("file"), str):
                    values = {**values, "file": os.path.join(os.path.dirname(name), values["file"])}
                part = Part(kind, values, name, lines.where(kind, k), f"[[{kind}]] number {k + 1}")
                scene._add(part, lambda key: lines.where(kind, k, key))
        # Columns and plates are numbered as they stand in the file, of whatever kind.
        scene._parts.sort(key=lambda part: int(part.line.rpartition(" ")[2] or 0))
        scene._config_line = lines.where("config")
        return scene

    def _keywords(self, tables: dict, lines: Lines, kind: str, valid: list[str], make: Callable) -> Any:
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
        """A simulation of the scene.

        Args:
            spacing: m; not given: the scene's own.

        Returns:
            A Simulation at its start.

        Raises:
            SceneError: what the library refuses, with file, line and table.

        Example:
            with granperi.Scene.read("collapse.toml").build(spacing=0.01) as coarse:
                print(coarse.n_particles, "particles")
        """
        config = self.config if spacing is None else self.config.replace(spacing=spacing)
        try:
            sim = Simulation(config)
        except Error as error:
            raise self._config_error(error) from None
        materials: dict[Any, int] = {0: 0}
        order = sorted(self._parts, key=lambda part: part.kind != "material")  # stable: materials first
        for part in order:
            try:
                BUILDERS[part.kind](sim, dict(part.values), materials)
            except (Error, TypeError) as error:
                sim.close()
                raise SceneError(f"{part.where()}: {error}") from None
        return sim

    def _config_error(self, error: object) -> SceneError:
        return SceneError(f"{self.name}{self._config_line}, [config]: {error}")

    @property
    def fixed_spacing(self) -> bool:
        """Whether it has particles given one by one, whose spacing is theirs."""
        return any(part.kind == "particles" for part in self._parts)

    def smallest_side(self) -> float:
        """The smallest width or height of the scene's columns.

        Returns:
            m.

        Raises:
            ArgumentError: it has no column, or particles given one by one, whose spacing is theirs.

        Example:
            print(granperi.Scene.read("collapse.toml").smallest_side(), "m")
        """
        if self.fixed_spacing:
            raise ArgumentError(f"{self.name}: has particles given one by one, whose spacing is theirs: expected a scene of "
                                "columns, or a length in m")
        sides = self.column_sides()
        if not sides:
            raise ArgumentError(f"{self.name}: has no column whose sides could be resolved: expected a scene of columns, or a "
                                "length in m")
        return min(sides)

    def column_sides(self) -> list[float]:
        """Width and height of each of the scene's columns.

        Returns:
            m, a list of twice as many lengths as there are columns.

        Raises:
            SceneError: a side that is no finite number above 0.

        Example:
            print(granperi.Scene.read("collapse.toml").column_sides())
        """
        return [self._side(part, key) for part in self._parts if part.kind == "column" for key in ("width", "height")]

    @staticmethod
    def _side(column: Part, key: str) -> float:
        try:
            side = number(f"gp_column.{key}", column.values.get(key, 0.0))
            if not (math.isfinite(side) and side > 0):
                raise ArgumentError(f"gp_column.{key} = {side:g}: expected a finite number above 0")
        except Error as error:
            raise SceneError(f"{column.where()}: {error}") from None
        return side

    # ---------------------------------------------------------------------------------------------- probes, runs

    def _probes(self) -> list[Part]:
        return [part for part in self._parts if part.kind == "probe"]

    def has_probes(self) -> bool:
        """Whether it has probes.

        Returns:
            True or False.

        Example:
            print(granperi.Scene.read("collapse.toml").has_probes())
        """
        return bool(self._probes())

    def add_probes(self, sim: Simulation) -> list[Probe]:
        """The probes of the scene, in a simulation of it; see Simulation.add_probe.

        Args:
            sim: a simulation that build() has made.

        Returns:
            A list of Probe, in the order of the file.

        Raises:
            SceneError: a plate, field or value that does not exist or is out of range, with file, line and table.

        Example:
            scene = granperi.Scene.read("collapse.toml")
            with scene.build(spacing=0.01) as sim:
                probes = scene.add_probes(sim)
        """
        probes = []
        for part in self._probes():
            values = {name: value for name, value in part.values.items() if name != "output"}
            try:
                probes.append(sim.add_probe(**values))
            except (Error, TypeError) as error:
                raise SceneError(f"{part.where()}: {error}") from None
        return probes

    def probe_files(self, result: str) -> list[str]:
        """Where the probes are written to (CSV) beside a result.

        Args:
            result: path of the result file.

        Returns:
            A list of paths: as the key output of each [[probe]] says, or RESULT_probe1.csv and so on.

        Raises:
            SceneError: an output that is not a file name, or the same one twice.

        Example:
            print(granperi.Scene.read("collapse.toml").probe_files("collapse.h5"))
        """
        files = []
        for k, part in enumerate(self._probes(), 1):
            name = part.values.get("output", f"{os.path.splitext(os.path.basename(result))[0]}_probe{k}.csv")
            if not isinstance(name, str) or not name or os.path.basename(name) != name or name in (".", ".."):
                raise SceneError(f"{part.where()}: output = {name!r}: expected the name of a file, which will be beside the result")
            files.append(os.path.join(os.path.dirname(result), name))
        if len(set(files)) < len(files):
            raise SceneError(f"{self.name}: two probes have the same output: expected another one for each")
        return files

    def write_into(self, name: str) -> None:
        """Makes the run write NAME.h5, and its probes files that begin with NAME.

        Args:
            name: without an extension.

        Example:
            scene = granperi.Scene.read("collapse.toml")
            scene.write_into("second")
            print(scene.run.output)
        """
        self.run.output = name + ".h5"
        for part in self._probes():
            if "output" in part.values:
                part.values["output"] = f"{name}_{part.values['output']}"

    def record(self, path: "str | os.PathLike[str] | None" = None, progress: bool = False, *, overwrite: bool = False,
               resume: bool = False, checkpoint: float = CHECKPOINT_SECONDS) -> History:
        """Builds the scene and runs it as its table [run] says, into a result file; an interruption loses nothing.

        The whole scene is checked before a file is touched, the run is written into a directory beside its place
        (collapse.part/ for collapse.h5), and moved there when it is complete. A checkpoint (collapse.gpc) is saved on the way,
        when the run is interrupted, and at its end; with resume the run goes on from it with the same bits as if it had not
        been interrupted.

        Args:
            path: of the result; not given: run.output; "": no files, also none of probes.
            progress: shows a bar (needs tqdm).
            overwrite: a result that exists is replaced by the complete new one.
            resume: goes on with an interrupted run, or makes a complete one longer (run.end); does nothing if all is
                done.
            checkpoint: s of wall-clock time between two checkpoints, above 0.

        Returns:
            The History of the states at the frames.

        Raises:
            FileError: a result that exists (unless overwrite or resume), a directory that does not, a full disk.
            StateError: another process runs into this place.
            ArgumentError: resume with another scene than the one that was begun; the text says what differs. Its threads, end,
                until and every may change.
            SceneError: what the library refuses, with file, line and table.

        Example:
            scene = granperi.Scene.read("collapse.toml")
            history = scene.record("recorded.h5", overwrite=True)
            print(history.time[-1], "s")
        """
        path = os.fspath(path) if path is not None else self.run.output
        if path:
            return record_scene(self, path, progress, overwrite, resume, checkpoint)
        if overwrite or resume:
            raise ArgumentError("overwrite and resume: there is no output, so nothing to replace or to go on with")
        with self.build() as sim:
            return History(sim.frames(self.run.end, self.run.every, progress, self.run.until == "rest"))

    def write(self, path: "str | os.PathLike[str]", overwrite: bool = False) -> None:
        """Writes a scene file (TOML), from which read() makes the same scene. Files of points and masks are named in it.

        Args:
            path: of the file.
            overwrite: replaces a file that exists.

        Raises:
            FileError: the file exists, and overwrite is false; or it cannot be written.

        Example:
            granperi.Scene.read("collapse.toml").write("copy.toml", overwrite=True)
        """
        path = os.fspath(path)
        require_free(path, overwrite)
        write_text(path, self.text(os.path.dirname(os.path.abspath(path))))

    def text(self, directory: str = ".") -> str:
        """What write() writes.

        Args:
            directory: in which the file is to be: points and masks are named from there.

        Returns:
            TOML.

        Example:
            print(granperi.Scene.read("collapse.toml").text())
        """
        tables = [(part.kind, {name: os.path.relpath(value, directory) if name == "file" else value
                               for name, value in part.values.items()}) for part in self._parts]
        return _toml.text_of_scene(self.config, self.run, tables)

    def set(self, key: str, value: Any) -> None:
        """Changes one value, named as in a sweep.

        Args:
            key: "config.spacing", "run.end", "column.height" where there is one column, "column.2.height" of the second one,
                "material.fine.mu_s" of the one with this name.
            value: in the unit of that key.

        Raises:
            ArgumentError: a key that does not exist, or that means several tables.

        Example:
            scene = granperi.Scene.read("collapse.toml")
            scene.set("column.height", 0.08)
        """
        names = key.split(".") if isinstance(key, str) else []
        if len(names) == 2 and names[0] == "config" and names[1] in CONFIG and names[1] != "preset":
            self.config = self.config.replace(**{"nonlocal_" if names[1] == "nonlocal" else names[1]: value})
        elif len(names) == 2 and names[0] == "run" and names[1] in RUN:
            self.run = make_run({**vars(self.run), names[1]: value})
        elif len(names) in (2, 3) and names[0] in LISTS and names[-1] in LISTS[names[0]]:
            self._one(key, names).values[names[-1]] = value
        else:
            raise ArgumentError(f"key {key!r:.80}: {_why_no_key(names)}")

    def _one(self, key: str, names: list[str]) -> Part:
        """The table that a key means."""
        several = [part for part in self._parts if part.kind == names[0]]
        if len(names) == 2 and len(several) == 1:
            return several[0]
        if len(names) == 3:
            for k, part in enumerate(several, 1):
                if names[1] in (str(k), part.values.get("name")):
                    return part
        which = ", ".join(f"{names[0]}.{k}.{names[-1]}" for k in range(1, len(several) + 1))
        raise ArgumentError(f"key {key!r:.80}: {self.name} has {len(several)} [[{names[0]}]]"
                            + (f"; expected {which}" if several else "; add one to the scene first"))

    def __repr__(self) -> str:
        counts = {kind: sum(part.kind == kind for part in self._parts) for kind in LISTS}
        return f"<granperi.Scene {self.name}: {', '.join(f'{n} {kind}' for kind, n in counts.items() if n)}>"


def _why_no_key(names: list[str]) -> str:
    if len(names) not in (2, 3) or names[0] not in ("config", "run", *LISTS):
        return ("expected config.NAME, run.NAME, TABLE.NAME, or TABLE.NUMBER.NAME where there are several; TABLE: "
                + near_match(names[0] if names else "", LISTS))
    valid = {"config": [name for name in CONFIG if name != "preset"], "run": RUN}.get(names[0]) or LISTS[names[0]]
    return near_match(names[-1], valid)


def scene_of(scene: Any) -> Scene:
    """A scene, or that of a path."""
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, (str, os.PathLike)):
        return Scene.read(scene)
    raise ArgumentTypeError(f"{scene!r:.80}: expected a Scene or the path of a scene file")
