"""Whatever the arguments are: an exception of granperi or a result, never a crash, and nothing lost."""
import warnings

import numpy as np
import pytest
from conftest import block
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import granperi

settings.register_profile("granperi", max_examples=60, deadline=None, derandomize=True,
                          suppress_health_check=list(HealthCheck))
settings.load_profile("granperi")

anything = st.one_of(
    st.none(), st.booleans(), st.integers(), st.integers(-(2**70), 2**70), st.floats(), st.text(max_size=8),
    st.binary(max_size=8), st.complex_numbers(), st.lists(st.floats(), max_size=4), st.dictionaries(st.text(), st.none()),
    st.just(object()), st.just(np.float32(1)), st.just(np.int64(3)), st.just(np.array([1.0])), st.just(np.nan))
array = st.one_of(anything, arrays.arrays(st.sampled_from(["f8", "f4", "i4", "U3", "c16", "?"]),
                                          arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4)))
expected = (granperi.Error, granperi.GranperiWarning)


def tried(call):
    """True if the call has worked; False if it was refused as it should be."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            call()
        except expected as error:
            assert str(error)
            return False
    return True


@pytest.mark.parametrize("kind, add", [(granperi.Material, "add_material"), (granperi.Column, "add_column"),
                                       (granperi.Plate, "add_plate")])
@given(data=st.data())
def test_objects(kind, add, data):
    values = data.draw(st.dictionaries(st.sampled_from(kind.names()), array, max_size=4))
    # columns of a size that could be meant would be filled with particles
    values = {name: value for name, value in values.items() if name not in ("width", "height")}
    with block() as sim:
        before = sim.x
        if not tried(lambda: getattr(sim, add)(**values)):
            assert np.array_equal(sim.x, before)
        sim.step(1)


@given(values=st.dictionaries(st.sampled_from([name for name in granperi.Config.names() if name != "threads"]), anything,
                              max_size=3))
def test_config(values):
    def make():
        granperi.Simulation(**values).close()

    tried(make)


@given(x=array, y=array, vx=array, vy=array, material=anything)
def test_particles(x, y, vx, vy, material):
    with block() as sim:
        count = len(sim)
        if not tried(lambda: sim.add_particles(x, y, vx, vy, material)):
            assert len(sim) == count
        assert sim.state.n_particles == len(sim)


@given(x=array, left=anything, right=anything)
def test_reading(x, left, right):
    with block() as sim:
        epoch = sim.epoch
        tried(lambda: sim.surface(x))
        tried(lambda: sim.interface(left, right, x))
        tried(lambda: sim.plate_load(left))
        tried(lambda: sim.field(left))
        tried(lambda: sim.particles(left))
        tried(lambda: sim.view(left))
        assert sim.epoch == epoch


@given(value=anything)
def test_running(value):
    with block() as sim:
        if isinstance(value, (int, float, np.number)) and not isinstance(value, bool) and value > 20:
            value = 20 if isinstance(value, (int, np.integer)) else 0.1  # that would be a long run
        tried(lambda: sim.step(value))
        tried(lambda: sim.set_plate_velocity(0, value, 0))
        tried(lambda: sim.set_plate_velocity(value, 0, 0))
        tried(lambda: sim.set_gravity(value, -9.81))
        tried(lambda: sim.set_gravity(0, value))
        sim.set_gravity(0, -9.81)
        tried(lambda: sim.set_callback(value))
        tried(lambda: sim.set_callback(len, value))
        tried(lambda: sim.frames(value, value))
        sim.set_callback(None)
        tried(lambda: sim.step(1))


@given(value=anything)
def test_plates_of_the_usual_kinds(value):
    tried(lambda: granperi.Plate.floor(value, 1))
    tried(lambda: granperi.Plate.wall(value, 0, 1))
    tried(lambda: granperi.Plate.wall(0, value, 1, value))
    tried(lambda: granperi.Plate.gate(0, value, value))
    tried(lambda: granperi.Plate.gate(value, 1, 1, spacing=value))


@given(text=st.text(max_size=60))
def test_scene_texts(text):
    tried(lambda: granperi.Scene.parse(text))


keys = st.sampled_from(["config", "run", "material", "column", "plate", "floor", "wall", "gate", "particles", "name", "x",
                        "wall_line", "points", "file", "closed"])


@given(kind=keys, values=st.dictionaries(keys | st.sampled_from(granperi.Plate.names()), array, max_size=3))
def test_scenes(kind, values):
    scene = granperi.Scene(granperi.Config(spacing=0.01, threads=1))

    def build():
        scene.add(kind, **values)
        scene.build().close()

    tried(build)
