"""What people get wrong, each with the text that they read: it names what is wrong, and what to do."""
import functools
import os
import re
import threading
import warnings

import numpy as np
import pytest
from conftest import block, needs_hdf5

import granperi
from granperi import Column, Config, Plate, Result, Scene, Simulation

h5py = pytest.importorskip("h5py")
pytestmark = needs_hdf5


@pytest.fixture(scope="module")
def directory(tmp_path_factory):
    """A directory with files of all kinds, in which the mistakes are made."""
    before, directory = os.getcwd(), tmp_path_factory.mktemp("mistakes")
    os.chdir(directory)
    scene = Scene(Config(spacing=0.01), granperi.Run(end=0.01), "scene")
    scene.add("column", width=0.1, height=0.05)
    scene.add("floor", x_left=-0.5, x_right=0.5)
    scene.write("scene.toml")
    scene.record("result.h5")
    with block() as sim:
        sim.output("no_frames.h5").close()
    (directory / "empty.h5").touch()
    (directory / "empty.gpc").touch()
    (directory / "text.h5").write_text("no numbers\n")
    (directory / "noise.toml").write_bytes(b"[run\xff]\n")
    (directory / "cut.h5").write_bytes((directory / "result.h5").read_bytes()[:5000])
    (directory / "cut.gpc").write_bytes((directory / "result.gpc").read_bytes()[:-100])
    (directory / "interrupted.part").mkdir()
    with h5py.File("foreign.h5", "w") as file:
        file["temperature"] = 300.0
    with h5py.File("h5md.h5", "w") as file:
        file.create_group("h5md")
        file.create_group("particles/trajectory")
    yield directory
    os.chdir(before)


def closed():
    with block() as sim:
        pass
    return sim


def stepped():
    sim = block()
    sim.step()
    return sim


def in_another_thread(work):
    """The exception of `work` in a second thread, while the first one steps."""
    sim, caught = block(), []

    def second():
        try:
            work(sim)
        except granperi.Error as error:
            caught.append(error)

    def callback(sim):
        thread = threading.Thread(target=second)
        thread.start()
        thread.join()
        return True

    sim.set_callback(callback)
    sim.step()
    raise caught[0]


def parsed(text):
    return Scene.parse(text, "s.toml").build()


def scene():
    return Scene.read("scene.toml")


def swept(parameters, **more):
    return granperi.sweep("scene.toml", parameters, "sweep", **more)


def reported(**more):
    return granperi.report("scene.toml", **more)


@functools.cache
def small_report():
    return reported(budget=600, spacings=[0.025, 0.0166, 0.0125], seeds=2)


MASKED = np.ma.masked_array([0.1, 0.2], [False, True])

MISTAKES = [
    # names and types
    (lambda: Config(spaceing=0.01), "Config has no 'spaceing': did you mean 'spacing'? Valid: "),
    (lambda: Simulation(0.01), "expected a Config or its parameters by keyword, got 0.01"),
    (lambda: Config(spacing="fine"), "gp_config.spacing = 'fine': expected a number"),
    (lambda: Config(threads=1.5), "gp_config.threads = 1.5: expected a whole number"),
    (lambda: Config(stress="elastc"), "gp_config.stress = 'elastc': did you mean 'elastic'?"),
    (lambda: setattr(Column(), "heigth", 1), "Column has no 'heigth': did you mean 'height'?"),
    (lambda: block().presure, "a Simulation has no 'presure': did you mean 'pressure'?"),
    (lambda: block().field("presure"), "field 'presure' does not exist: did you mean 'pressure'?"),
    (lambda: block().particles("sped"), "field 'sped' does not exist: did you mean 'speed'?"),
    (lambda: Plate.wall(0, 0, 1, "up"), "material = 'up': expected 'left' or 'right'"),
    (lambda: granperi.settings("medium", 0.05), "name = 'medium': Valid: draft, standard, fine"),
    # numbers
    (lambda: Simulation(spacing=-0.01), "gp_config.spacing = -0.01: expected a number from"),
    (lambda: Simulation(spacing=2.5).add_column(width=0.08, height=0.05),  # in mm
     "gp_column.width = 0.08: expected at least half of the spacing 2.5"),
    (lambda: block().add_column(width=0.1, height=0.1, material=3), "gp_column.material = 3: expected a whole number from 0 to 0"),
    (lambda: block().add_particles([0.1, 0.2], [0.1]), "y has 1 values: expected 2, as many as the arrays beside it"),
    (lambda: block().add_particles([np.nan], [0.1]), "x[0] = nan: expected a finite number"),
    (lambda: block().frames(1, 0), "every = 0: expected a finite number above 0"),
    (lambda: block().run(-1), "t_end = -1: expected a finite time not before the clock's 0 s"),
    (lambda: block().plate_load(3), "plate = 3: expected a whole number from 0 to 0"),
    # masks
    (lambda: block().add_particles(MASKED, [0.1, 0.2]), "x: has masked values, which the library has no place for: leave them out"),
    (lambda: Plate.line(np.ma.masked_array([[0, 0], [1, 1]], [[0, 0], [1, 0]])), "points: has masked values"),
    (lambda: Config(spacing=np.ma.masked), "gp_config.spacing: has masked values"),
    (lambda: block().surface([0.0, np.ma.masked]), "x: has masked values"),
    # order
    (lambda: closed().step(), "step: the simulation is closed, by close() or the end of its with block: do it before, or make a new"),
    (lambda: closed().x, "x: the simulation is closed"),
    (lambda: stepped().add_column(width=0.1, height=0.1), "the scene is fixed once the first step is taken (step 1): add to it before"),
    (lambda: in_another_thread(lambda sim: sim.step()), "step: the simulation is in use by another thread"),
    (lambda: [sim := block(), view := sim.view("x"), sim.step(), view.x], "take a new view, or a copy before the step"),
    # files
    (lambda: Result("nothing.h5"), "nothing.h5: there is no such file: name the result file that a run has written"),
    (lambda: Result("empty.h5"), "empty.h5: is empty: the run that made it was stopped before its first frame, or the disk was full; run"),
    (lambda: Result("text.h5"), "text.h5: is no HDF5 file: expected a result file (.h5)"),
    (lambda: Result("cut.h5"), "cut.h5: cannot be read as an HDF5 file, it may be cut off"),
    (lambda: Result("foreign.h5"), "foreign.h5: is no result file of granperi but another HDF5 file: expected a file that"),
    (lambda: Result("h5md.h5"), "h5md.h5: is no result file of granperi but an H5MD file of another program"),
    (lambda: Result("result.gpc"), "is no result file of granperi but a checkpoint, from which granperi.load() goes on"),
    (lambda: Result("result.xdmf"), "result.xdmf: is no HDF5 file: ParaView opens this one; here name the .h5 beside it"),
    (lambda: Result("scene.toml"), "scene.toml: is no HDF5 file: expected a result file (.h5), not a scene; python3 -m granperi run makes"),
    (lambda: Result("interrupted.part"), "is a directory: expected a result file in it, of a run that is going on or was interrupted"),
    (lambda: Result("no_frames.h5")[-1], "no_frames.h5 has no frames: the run that wrote it has ended before the first one; run it anew"),
    (lambda: Result("result.h5")[99], "frame 99: result.h5 has 2 frames"),
    (lambda: Result("result.h5").at(5), "time = 5 s: result.h5 has frames from 0 to 0.01 s"),
    (lambda: Result("result.h5")[0].field("viscosity"), "result.h5 has no field 'viscosity': it has id, column, x, y"),
    (lambda: [result := Result("result.h5"), result.close(), result[0].x], "result.h5 is closed: read within its with block, or open it"),
    (lambda: granperi.load("nothing.gpc"), "nothing.gpc: cannot open the file: No such file or directory; sim.save() writes checkpoints"),
    (lambda: granperi.load("empty.gpc"), "empty.gpc: not a checkpoint of granperi (gp_save); it is empty: take an earlier checkpoint"),
    (lambda: granperi.load("cut.gpc"), "cut.gpc: "),
    (lambda: granperi.load("result.h5"), "not a checkpoint of granperi (gp_save); frames of a result file are read by granperi.Result"),
    (lambda: block().output("nowhere/a.h5"), "nowhere/a.h5: cannot create the file: No such file or directory"),
    (lambda: scene().record("result.h5"), "result.h5 exists: name another output; go on with it by resume=True (--resume); run it anew by"),
    (lambda: scene().record("nowhere/a.h5"), "the directory nowhere does not exist: make it, or name another output"),
    (lambda: scene().record("a.xdmf"), "output = 'a.xdmf': expected the name of a file for the result, such as collapse.h5"),
    (lambda: scene().record("a.h5", resume=True, overwrite=True), "expected one of them: the first begins anew, the second goes on"),
    (lambda: scene().record("", resume=True), "there is no output, so nothing to replace or to go on with"),
    (lambda: scene().write("scene.toml"), "scene.toml exists: name another file, or say overwrite=True to replace it"),
    # scene files
    (lambda: Scene.read("nothing.toml"), "nothing.toml: cannot be read: No such file or directory"),
    (lambda: Scene.read("result.h5"), "result.h5: is an HDF5 file, no scene: expected a scene file (TOML). granperi.Result reads a result"),
    (lambda: Scene.read("result.gpc"), "from a checkpoint granperi.load() and granperi-mpi go on, and the run of its scene with --resume"),
    (lambda: Scene.read("noise.toml"), "noise.toml: is not UTF-8 text (byte 4)"),
    (lambda: parsed("[[colum]]"), "s.toml, line 1: unknown table or key 'colum': did you mean 'column'?"),
    (lambda: parsed("[column]\nwidth = 1"), "s.toml, line 1: expected [[column]] with two brackets, as there may be several"),
    (lambda: parsed("[config]\nspacing = "), "s.toml: is not TOML: "),
    (lambda: parsed("[[column]]\nwidth = 0.1\nheight = 0.1\nmaterial = \"sand\""), "s.toml, line 1, [[column]] number 1: material = 'sand'"),
    (lambda: parsed("[run]\nuntil = \"reset\""), "s.toml, line 1, [run]: until = 'reset': expected 'end' or 'rest'"),
    (lambda: parsed("[[wall_line]]\nfile = \"no.csv\""), "s.toml, line 1, [[wall_line]] number 1: no.csv: cannot be read: No such file"),
    (lambda: parsed("[[wall_line]]\nclosed = true"), "expected either points = [[x, y], ...] or file = the name of a file"),
    (lambda: parsed("[[mask]]\nfile = \"no.png\"\nx_min = 0\ny_min = 0\nwidth = 1"), "'no.png': cannot be read as an image: No such file or directory"),
    # shapes, probes, sweeps
    (lambda: block().add_polygon([[0, 0], [1, 1]]), "points: expected three or more finite corners, got 2"),
    (lambda: block().add_mask([[0, 0.5]], 0, 0, 1), "mask: expected true and false (or 1 and 0) of the shape (rows, columns)"),
    (lambda: block().add_mask([[0, 0]], 0, 0, 1), "the mask holds no particle at the spacing 0.01 m"),
    (lambda: block().add_probe(), "a probe of nothing: expected points = [[x, y], ...], or the numbers of plates, or both"),
    (lambda: block().add_probe(plates=[5]), "plates: there is no plate 5: the simulation has 1, counted from 0"),
    (lambda: swept({"config.spacin": [1]}), "key 'config.spacin': did you mean 'spacing'?"),
    (lambda: swept({"spacing": [1]}), "key 'spacing': expected config.NAME, run.NAME, TABLE.NAME"),
    (lambda: swept({"column.2.height": [1]}), "key 'column.2.height': scene.toml has 1 [[column]]; expected column.1.height"),
    (lambda: swept({"config.spacing": 0.01}), "parameters['config.spacing'] = 0.01: expected a list of values"),
    (lambda: swept({"config.spacing": [0.01, -1]}), "gp_config.spacing = -1: expected a number from"),
    (lambda: swept({}), "parameters: there is no point: expected at least one key with one value"),
    (lambda: swept({3: [1]}), "key 3: expected a text such as 'config.spacing'"),
    (lambda: swept({"config.spacing": [0.01, 0.01]}), "parameters: two points are the same"),
    (lambda: swept([{"config.spacing": 0.01}, {"run.end": 1}]), "the points have different keys: expected the same in each"),
    (lambda: swept({"wall.x": [0.1]}), "key 'wall.x': scene.toml has 0 [[wall]]; add one to the scene first"),
    (lambda: swept({"config.spacing": MASKED}), "gp_config.spacing: has masked values"),
    (lambda: swept({"config.spacing": [0.01]}, workers=0), "workers = 0: expected a whole number >= 1"),
    (lambda: swept({"run.output": ["a.h5"]}), "key 'run.output': a sweep names the files of its points itself"),
    (lambda: granperi.sweep("scene.toml", {"run.end": [1]}, "result.h5"), "result.h5: is a file: expected a directory for the scenes"),
    (lambda: block().add_polygon([[0, 0], [np.nan, 0], [1, 1]]), "points: expected three or more finite corners, got 3, of which some"),
    (lambda: block().add_polygon([0, 1, 2]), "points: expected numbers of the shape (n, 2), one x and one y per point"),
    (lambda: block().add_polygon([[0, 0], [1e-3, 0], [0, 1e-3]]), "the polygon holds no particle at the spacing 0.01 m"),
    (lambda: block().add_mask([[1, 1]], 0, 0, -1), "x_min = 0, y_min = 0, width = -1: expected finite lengths in m, width above 0"),
    (lambda: block().add_mask([[1, 1]], 0, 0, 80000), "more than 50000000 places at the spacing 0.01 m: expected a larger spacing"),
    (lambda: block().add_mask("scene.toml", 0, 0, 1), "'scene.toml': cannot be read as an image: "),
    (lambda: block().add_probe([0.1, 0.2]), "points: expected numbers of the shape (n, 2), one x and one y per point, got the shape (2,)"),
    (lambda: block().add_probe([[np.nan, 0]]), "points: expected finite numbers, x and y in m"),
    (lambda: block().add_probe([[0, 0]], fields=["presure"]), "field 'presure' does not exist: did you mean 'pressure'?"),
    (lambda: block().add_probe([[0, 0]], every=-1), "every = -1: expected a finite number above 0, in s"),
    (lambda: block().add_probe(plates=[0.5]), "plates = [0.5]: expected numbers of plates"),
    # reports and settings
    (lambda: granperi.report(block()), "expected a Scene or the path of a scene file"),
    (lambda: granperi.report("nothing.toml"), "nothing.toml: cannot be read: No such file or directory"),
    (lambda: reported(budget=1e-3, end=1.0), "budget = 0.001 s: "),
    (lambda: reported(budget="60"), "budget = '60': expected a number"),
    (lambda: reported(accuracy=5), "accuracy = 5: expected a number above 0 and below 1"),  # in %
    (lambda: reported(seeds=1), "seeds = 1, workers = 1: expected 2 to 100 and 1 to 64"),
    (lambda: reported(spacings=[0.01, 0.005]), "expected at least three different numbers above 0 m"),
    (lambda: reported(spacings=[10, 5, 2.5]), "gp_column.width = 0.1: expected at least half of the spacing 2.5"),  # in mm
    (lambda: reported(of="width_90"), "of = 'width_90': expected a list of names of quantities"),
    (lambda: reported(of=["width"]), "of: 'width': did you mean 'width_98'? Valid: peak_height, "),
    (lambda: reported(quantities=[len]), "expected a dict of names and functions of the simulation"),
    (lambda: small_report().error("peak", 0.01), "name = 'peak': did you mean 'peak_height'?"),
    (lambda: small_report().error("peak_height", 0), "spacing = 0, runs = 1: expected a finite number above 0 (m), and a whole one"),
    (lambda: small_report().recommend(0.1, ["peak"]), "of: 'peak': did you mean 'peak_height'?"),
    (lambda: small_report().recommend(0.1, "peak_height"), "of = 'peak_height': expected a list of names of quantities"),
    (lambda: small_report().cost.seconds(-1), "spacing = -1: expected a number above 0, in m"),
    (lambda: small_report().write("report.pdf"), "path = 'report.pdf': expected a name that ends in .html or .json"),
    (lambda: granperi.settings("draft", 0), "of = 0: expected a finite length above 0 m, or a scene"),
    (lambda: granperi.settings("draft", Config()), "expected a Scene, the path of a scene file, or a length in m"),
    (lambda: granperi.settings("draft", Scene()), "has no column whose sides could be resolved: expected a scene of columns, or a length"),
    (lambda: granperi.settings("draft", 0.05).config(scene()), "expected a Config, such as scene.config"),
]


@pytest.mark.parametrize("mistake, text", MISTAKES, ids=[re.sub(r"\W+", "-", text)[:40] for _, text in MISTAKES])
def test_the_text_of_an_error_says_what_to_do(directory, mistake, text):
    before = sorted(path.name for path in directory.iterdir())
    with warnings.catch_warnings(), pytest.raises((granperi.Error, AttributeError)) as caught:
        warnings.simplefilter("ignore", granperi.GranperiWarning)
        mistake()
    assert text in str(caught.value)
    assert sorted(path.name for path in directory.iterdir()) == before


def floor_of_wrong_way(sim):
    sim.add_plate(x0=-0.5, x1=0.5)


def gate_of_wrong_side(sim):
    sim.add_plate(Plate.floor(-0.5, 0.5))
    sim.add_plate(Plate.wall(0, 0, 0.1, "left"))


def wall_through(sim):
    sim.add_plate(Plate.floor(-0.5, 0.5))
    sim.add_plate(Plate.wall(0.05, 0, 0.1))


def twice(sim):
    sim.add_plate(Plate.floor(-0.5, 0.5))
    sim.add_column(x_min=0.05, width=0.1, height=0.05)


@pytest.mark.parametrize("scene, text", [
    (floor_of_wrong_way, "plate 0 has material only on the side of its body, .* Swap its ends"),
    (lambda sim: None, "column 0 has nothing below it .* it falls for ever. Add a floor"),
    (gate_of_wrong_side, "plate 1 has material only on the side of its body, .* Swap its ends"),
    (wall_through, "column 0 lies across the line of plate 1, .* Move the plate or the column"),
    (twice, "pairs of particles that begin closer than half a spacing.* they drive each other apart")])
def test_a_doubtful_scene_is_warned_of(scene, text):
    with Simulation(spacing=0.01) as sim:
        sim.add_column(width=0.1, height=0.05)
        scene(sim)
        with pytest.warns(granperi.GranperiWarning, match=text):
            sim.step()


@pytest.mark.parametrize("arguments, status, text", [
    (("plot", "empty.h5"), 1, "empty.h5: is empty"),
    (("plot", "no_frames.h5"), 2, "no_frames.h5 has no frames"),
    (("plot", "no_frames.h5", "fronts"), 2, "no_frames.h5 has no frames"),
    (("plot", "result.h5", "colour"), 2, "picture 'colour': did you mean 'column'? Valid: speed, "),
    (("compare", "result.h5", "empty.h5"), 1, "empty.h5: is empty"),
    (("compare", "foreign.h5", "result.h5"), 1, "foreign.h5: is no result file of granperi"),
    (("animate", "no_frames.h5"), 2, "there are no frames"),
    (("history", "no_such.h5"), 1, "there is no such file"),
    (("history", "result.h5", "--output", "scene.toml"), 1, "scene.toml exists"),
    (("info", "empty.h5"), 1, "empty.h5: is empty"),
    (("info", "--plan"), 2, "--plan: expected a scene file"),
    (("info", "--plan", "5"), 2, "--plan: expected a scene file"),
    (("info", "--plan", "nothing.toml"), 2, "nothing.toml: cannot be read"),
    (("info", "scene.toml", "--plan", "x"), 2, "--plan x: expected a whole number >= 1"),
    (("info", "scene.toml", "--plan", "0"), 2, "--plan 0: expected a whole number >= 1"),
    (("sweep", "scene.toml", "--workers", "x"), 2, "argument --workers: x: expected a whole number >= 1"),
    (("run", "scene.toml", "--output", "result.h5"), 1, "result.h5 exists: "),
    (("run", "scene.toml", "--end", "-1"), 2, "end = -1"),
    (("run", "scene.toml", "--end", "inf"), 2, "end = inf, every = 0.01: expected finite numbers above 0"),
    (("run", "scene.toml", "--output", "new.h5", "--spacing", "0"), 2, "granperi: --spacing 0: expected a number from"),
    (("run", "scene.toml", "--output", "new.h5", "--threads", "-1"), 2, "granperi: --threads -1: expected a whole number from 0 to"),
    (("run", "scene.toml", "--output", "new.h5", "--mpi", "0"), 2, "--mpi 0: expected a number of processes, 1 or more"),
    (("run", "scene.toml", "--resume", "--overwrite"), 2, "not allowed with argument"),
    (("sweep",), 2, "expected a scene file and at least one --set KEY=VALUE,VALUE"),
    (("sweep", "scene.toml", "--set", "config.spacing"), 2, "expected KEY=VALUE,VALUE"),
    (("sweep", "--collect"), 1, "is no directory of a sweep"),
    (("sweep", "scene.toml", "--set", "run.end=1", "--set", "run.end=2"), 2, "--set: a key stands twice"),
    (("sweep", "scene.toml", "--set", "config.spacing=0.01", "--directory", "result.h5"), 1, "result.h5: is a file"),
    (("report", "scene.toml", "--accuracy", "5"), 2, "accuracy = 5: expected a number above 0 and below 1"),
    (("report", "scene.toml", "--of", "peak"), 2, "of: 'peak': did you mean 'peak_height'?"),
    (("report", "scene.toml", "--output", "scene.toml"), 2, "--output scene.toml: expected a name that ends in .html or .json"),
    (("report", "scene.toml", "--spacings", "0.01", "0.02"), 2, "expected at least three different numbers above 0 m"),
    (("report", "nothing.toml"), 2, "nothing.toml: cannot be read"),
])
def test_mistakes_on_the_command_line(directory, capsys, arguments, status, text):
    from granperi import __main__

    before = {path.name: path.stat().st_mtime_ns for path in directory.iterdir()}
    try:
        answer = __main__.main(arguments)
    except SystemExit as error:  # argparse
        answer = error.code
    assert answer == status and text in capsys.readouterr().err
    assert {path.name: path.stat().st_mtime_ns for path in directory.iterdir()} == before
