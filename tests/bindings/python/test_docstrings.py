"""Each public call says what it takes, gives back and refuses, and what it shows as an example runs."""
import builtins
import inspect
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import needs_hdf5

import granperi
import granperi.plot

ROOT = Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "docs" / "site"))
import docstrings  # noqa: E402
import python_calls  # noqa: E402
import python_reference  # noqa: E402

SCENE = """
[config]
spacing = 0.01

[run]
end = 0.04
every = 0.02
output = "collapse.h5"

[[material]]
name = "fine"

[[column]]
x_min = -0.04
width = 0.08
height = 0.05

[[floor]]
x_left = -0.3
x_right = 0.3
"""


def public_calls():
    for name in granperi.__all__:
        thing = getattr(granperi, name)
        if not isinstance(thing, type):
            yield name, thing
        elif name in python_reference.roles_of(granperi) and hasattr(thing, "__mro__"):
            for call, member in python_reference.calls_of(thing) if python_reference.roles_of(granperi)[name] == "class" else ():
                yield f"{name}.{call}", member
    for name in python_reference.PICTURES:
        yield "plot." + name, getattr(granperi.plot, name)


CALLS = {name: python_calls.plain_function(thing) for name, thing in public_calls()
         if not isinstance(thing, type) and not name.split(".")[0] in python_reference.CONSTANTS and not name.startswith("Field.")}
WITHOUT_EXAMPLE = {"Snapshot.interface"}  # as Simulation.interface


@pytest.mark.parametrize("name", CALLS)
def test_every_argument_is_said_to_be_what_it_is(name):
    parts = docstrings.parts_of(CALLS[name].__doc__)
    assert parts.doc
    assert [argument for argument, _ in parts.args] == [python_calls.starred(one) for one in python_calls.own_parameters(CALLS[name])]
    for error, when in parts.raises:
        assert issubclass(getattr(granperi, error, None) or getattr(builtins, error), BaseException) and when
    assert parts.example or name in WITHOUT_EXAMPLE


@pytest.fixture(scope="module")
def directory(tmp_path_factory):
    """With what the examples begin with: a scene, and its result."""
    place = tmp_path_factory.mktemp("examples")
    (place / "collapse.toml").write_text(SCENE)
    scene = granperi.Scene.read(place / "collapse.toml")
    scene.record(place / "collapse.h5")
    return place


@pytest.fixture(scope="module")
def report(directory):
    return granperi.report(directory / "collapse.toml", budget=20, accuracy=0.1, seeds=2, spacings=[0.02, 0.0125, 0.01])


def examples():
    for name, thing in CALLS.items():
        yield from ((name, text) for text in docstrings.examples_in(thing.__doc__))
    for name in granperi.__all__:
        thing = getattr(granperi, name)
        if isinstance(thing, type) and thing.__module__.startswith("granperi"):
            yield from ((name, text) for text in docstrings.examples_in(thing.__doc__))
            for value, doc in python_reference.values_of(thing):
                yield from ((f"{name}.{value}", text) for text in docstrings.examples_in(doc))


EXAMPLES = list(examples())


@needs_hdf5
@pytest.mark.parametrize("k", range(len(EXAMPLES)), ids=[name for name, _ in EXAMPLES])
def test_examples_run(k, directory, report, make_block, monkeypatch):
    name, text = EXAMPLES[k]
    if "universe()" in text:
        pytest.importorskip("MDAnalysis")
    monkeypatch.chdir(directory)
    with make_block() as sim, warnings.catch_warnings():
        warnings.simplefilter("ignore", granperi.GranperiWarning)
        exec(compile(text, name, "exec"), {"granperi": granperi, "np": np, "sim": sim, "report": report})


REFUSALS = [
    ('sim.add_material(mu_s=0.9, mu_2=0.5)', "ArgumentError"),
    ('sim.add_column(width=-1, height=1)', "ArgumentError"),
    ('sim.add_column(width=0.001, height=1)', "ArgumentError"),
    ('sim.add_column(width=0.1, height=.1, material=5)', "ArgumentError"),
    ('sim.add_column(width=1e6, height=1e6)', "ArgumentError"),
    ('sim.step(1); sim.add_column(x_min=1, width=0.1, height=.05)', "StateError"),
    ('sim.step(1); sim.add_plate(granperi.Plate.floor(2, 3))', "StateError"),
    ('sim.step(1); sim.add_material()', "StateError"),
    ('sim.step(1); sim.add_particles([5.], [1.])', "StateError"),
    ('sim.add_plate(x0=1, x1=1)', "ArgumentError"),
    ('sim.add_plate(x1=1, knot_t=[0, 0], knot_x=[0, 1], knot_y=[0, 0])', "ArgumentError"),
    ('sim.add_plate(x1=1, knot_t=[0, 1, 2], knot_x=[0, 1], knot_y=[0, 0])', "ArgumentError"),
    ('sim.add_particles([1.], [1., 2.])', "ArgumentTypeError"),
    ('sim.add_particles([[1.]], [1.])', "ArgumentTypeError"),
    ("sim.add_particles([1.], [float('nan')])", "ArgumentError"),
    ('sim.add_particles([1.], [1.], vx=[1.])', "ArgumentError"),
    ('sim.add_particles([1.], [1.], material=3)', "ArgumentError"),
    ('sim.add_particles([], [])', "ArgumentError"),
    ('sim.add_polygon([[0, 0], [1, 1]])', "ArgumentError"),
    ('sim.add_polygon([[0, 0], [1e-4, 0], [0, 1e-4]])', "ArgumentError"),
    ('sim.add_polygon([0, 1, 2])', "ArgumentTypeError"),
    ('sim.add_mask([1, 0], 0, 0, 1)', "ArgumentTypeError"),
    ('sim.add_mask([[2, 0]], 0, 0, 1)', "ArgumentTypeError"),
    ('sim.add_mask([[1, 0]], 0, 0, -1)', "ArgumentError"),
    ("sim.add_mask('text.h5', 0, 0, 1)", "FileError"),
    ('sim.add_probe()', "ArgumentError"),
    ('sim.add_probe(plates=[7])', "ArgumentError"),
    ("sim.add_probe(points=[[0, 0]], fields='x1')", "ArgumentError"),
    ('sim.add_probe(points=[0, 0])', "ArgumentTypeError"),
    ('sim.set_plate_velocity(7, 0, 0)', "ArgumentError"),
    ("sim.set_plate_velocity(0, float('inf'), 0)", "ArgumentError"),
    ('k=sim.add_plate(x0=-.1, y0=.06, x1=.1, y1=.06, normal_pressure=10); sim.set_plate_motion(k, 0, 0, 1)', "ArgumentError"),
    ("sim.set_gravity(float('nan'), 0)", "ArgumentError"),
    ('sim.step(-1)', "ArgumentError"),
    ('sim.run(0.01); sim.run(0.001)', "ArgumentError"),
    ("sim.run(float('inf'))", "ArgumentError"),
    ('s=granperi.Simulation(spacing=.01, sound_speed=1e-3); s.add_column(width=.1, height=.1, vy=-5); s.add_plate(granperi.Plate.floor(-1, 1)); s.step(1)', "ArgumentError"),
    ('sim.run_until_rest(-1)', "ArgumentError"),
    ('sim.frames(0.1, every=0)', "ArgumentError"),
    ('sim.frames(-1, every=.1)', "ArgumentError"),
    ("sim.record('x.h5', 0.1, every=0)", "ArgumentError"),
    ("sim.record('nowhere/x.h5', 0.01)", "FileError"),
    ("sim.record('x.h5', 0.01, fields='gone')", "ArgumentError"),
    ('sim.set_callback(print, every=0)', "ArgumentError"),
    ('sim.set_callback(3)', "ArgumentTypeError"),
    ('sim.set_callback(lambda s: s.set_callback(None)); sim.step(1)', "StateError"),
    ('sim.set_callback(lambda s: s.close()); sim.step(1)', "StateError"),
    ("sim.field('velocity')", "ArgumentError"),
    ("sim.field('gone')", "ArgumentError"),
    ("sim.particles('gone')", "ArgumentError"),
    ("sim.view('speed')", "ArgumentError"),
    ('sim.surface([[0.]])', "ArgumentTypeError"),
    ("sim.surface([float('nan')])", "ArgumentError"),
    ('sim.interface(0, 1, [0.])', "ArgumentError"),
    ('sim.interface(0, 0, [0.])', "ArgumentError"),
    ('sim.interface(0, 5, [0.])', "ArgumentError"),
    ('sim.plate_load(7)', "ArgumentError"),
    ("sim.output('o.h5', every=-1)", "ArgumentError"),
    ("sim.output('o.h5', compression=10)", "ArgumentError"),
    ("sim.output('o.h5', fields='gone')", "ArgumentError"),
    ("sim.output('nowhere/o.h5')", "FileError"),
    ("o=sim.output('o1.h5'); sim.output('o2.h5')", "StateError"),
    ("sim.output('text.h5', append=True)", "FileError"),
    ("sim.save('nowhere/a.gpc')", "FileError"),
    ("granperi.load('gone.gpc')", "FileError"),
    ("granperi.load('text.h5')", "FileError"),
    ('granperi.Plate().replace(gone=1)', "ArgumentTypeError"),
    ("granperi.Plate.wall(0, 0, 1, 'up')", "ArgumentTypeError"),
    ("granperi.Plate.floor('a', 1)", "ArgumentTypeError"),
    ('granperi.Plate.floor(0, 1, gone=1)', "ArgumentTypeError"),
    ('granperi.Plate.gate(0, -1, 1)', "ArgumentError"),
    ("granperi.Plate.gate(0, 1, 1, 'up')", "ArgumentTypeError"),
    ('granperi.Plate.line([0, 1])', "ArgumentTypeError"),
    ("granperi.Plate.line([[0, 1], [1, 1]], material='up')", "ArgumentTypeError"),
    ("granperi.Plate.line([[0, 1], [1, 1]], material='inside')", "ArgumentError"),
    ("granperi.Scene().add('gone')", "SceneError"),
    ("granperi.Scene().add('column', gone=1)", "SceneError"),
    ("granperi.Scene.read('gone.toml')", "SceneError"),
    ("granperi.Scene.parse('[gone]')", "SceneError"),
    ("s=granperi.Scene(); s.add('column', width=-1); s.build()", "SceneError"),
    ('granperi.Scene().smallest_side()', "ArgumentError"),
    ("s=granperi.Scene(); s.add('column', width=-1); s.column_sides()", "SceneError"),
    ("s=granperi.Scene(); s.add('probe', plates=[9]); s.add_probes(sim)", "SceneError"),
    ("s=granperi.Scene(); s.add('probe', output='a/b'); s.probe_files('x.h5')", "SceneError"),
    ("granperi.Scene.read('collapse.toml').record()", "FileError"),
    ("granperi.Scene.read('collapse.toml').record('nowhere/x.h5')", "FileError"),
    ("s=granperi.Scene.read('collapse.toml'); s.set('column.height', .08); s.record(resume=True)", "ArgumentError"),
    ("granperi.Scene.read('collapse.toml').record('y.h5', checkpoint=-1)", "ArgumentError"),
    ("granperi.Scene.read('collapse.toml').write('collapse.toml')", "FileError"),
    ("granperi.Scene.read('collapse.toml').set('gone.x', 1)", "ArgumentError"),
    ("sim.history.to_csv('text.h5')", "FileError"),
    ("v=sim.view('x'); sim.step(1); v.x.copy()", "StateError"),
    ("p=sim.add_probe(plates=[0]); p.read_csv('text.h5')", "FileError"),
    ("o=sim.output('o3.h5'); o.close(); o.write()", "StateError"),
    ("r=granperi.Result('collapse.h5'); r.at(7)", "ArgumentError"),
    ("r=granperi.Result('collapse.h5'); r[-1].field('viscosity')", "ArgumentError"),
    ("r=granperi.Result('collapse.h5'); r[-1].surface([[0.]])", "ArgumentTypeError"),
    ("r=granperi.Result('collapse.h5'); r[-1].interface(0, 1, [0.])", "ArgumentError"),
    ("r=granperi.Result('collapse.h5'); r.close(); r.universe()", "StateError"),
    ("granperi.settings('gone', 1)", "ArgumentError"),
    ("granperi.settings('fine', -1)", "ArgumentError"),
    ("granperi.sweep('collapse.toml', {'gone':[1]})", "ArgumentError"),
    ("granperi.sweep('collapse.toml', {'config.spacing':[.02]}, workers=0)", "ArgumentError"),
    ("granperi.sweep('collapse.toml', {'column.width':[-1.]})", "SceneError"),
    ("granperi.compare('collapse.h5', 'collapse.h5', times=9)", "ArgumentError"),
    ('granperi.compare(sim, sim, times=0)', "ArgumentError"),
    ("granperi.compare('text.h5', sim)", "FileError"),
    ("granperi.plot.field('collapse.h5', 'gone')", "ArgumentError"),
    ("granperi.plot.field('collapse.h5', 'viscosity')", "ArgumentError"),
    ("granperi.plot.field('text.h5')", "FileError"),
    ("granperi.plot.surface('collapse.h5', [])", "ArgumentError"),
    ("granperi.plot.surface('collapse.h5', 9)", "ArgumentError"),
    ("granperi.plot.interface('collapse.h5', 0, 5)", "ArgumentError"),
    ('granperi.plot.energy(sim)', "ArgumentError"),
    ('granperi.plot.fronts(sim)', "ArgumentError"),
    ("granperi.plot.animate('collapse.h5', 'a.png')", "ArgumentError"),
    ("granperi.plot.animate(sim, 'a.gif')", "ArgumentError"),
    ("granperi.report('collapse.toml', budget=1e-3)", "ArgumentError"),
    ("granperi.report('collapse.toml', accuracy=2)", "ArgumentError"),
]


@needs_hdf5
@pytest.mark.parametrize("code, error", REFUSALS)
def test_what_is_said_to_be_refused_is(code, error, directory, make_block, monkeypatch):
    monkeypatch.chdir(directory)
    (directory / "text.h5").write_text("no HDF5")
    with make_block() as sim, warnings.catch_warnings():
        warnings.simplefilter("ignore", granperi.GranperiWarning)
        with pytest.raises(getattr(granperi, error)):
            exec(code, {"granperi": granperi, "sim": sim})


def test_there_are_examples_of_most_calls():
    assert len(EXAMPLES) > 80
    assert inspect.getdoc(granperi.Simulation.add_particles).count("\n") > 10
