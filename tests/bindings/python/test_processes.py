"""fork and spawn, pickle and copy."""
import concurrent.futures
import copy
import multiprocessing
import os
import pickle

import numpy as np
import pytest
from conftest import block, needs_hdf5, needs_openmp

import granperi


def run_one(threads):
    with block(threads=threads) as sim:
        sim.step(20)
        return sim.x.tobytes()


def test_spawned_processes():
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        results = list(pool.map(run_one, [1, 1]))
    assert results == [run_one(1)] * 2


def test_forked_processes_with_one_thread():
    context = multiprocessing.get_context("fork")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        assert list(pool.map(run_one, [1, 1])) == [run_one(1)] * 2


@needs_openmp
def test_threads_after_a_fork_are_refused_and_do_not_hang(python):
    answer = python("""
import os, sys
sys.path.insert(0, %r)
import granperi
from test_processes import run_one
run_one(2)
child = os.fork()
if child == 0:
    run_one(1)
    try:
        run_one(2)
    except granperi.StateError as error:
        print(error, flush=True)
    os._exit(0)
print(os.waitpid(child, 0)[1])
""" % os.path.dirname(__file__))
    assert answer.returncode == 0, answer.stderr
    assert "use threads=1, or the start method 'spawn'" in answer.stdout and answer.stdout.endswith("0\n")


@needs_hdf5
def test_a_forked_child_leaves_the_parent_s_output_alone(python, tmp_path):
    answer = python("""
import os, sys
sys.path.insert(0, %r)
from conftest import block
import granperi
sim = block()
output = sim.output(%r)
output.write()
child = os.fork()
if child == 0:
    del output, sim
    sys.exit(0)
os.waitpid(child, 0)
sim.run(0.01)
output.write()
output.close()
print(granperi.Result(%r).times)
""" % (os.path.dirname(__file__), str(tmp_path / "a.h5"), str(tmp_path / "a.h5")))
    assert answer.returncode == 0, answer.stderr
    assert answer.stdout.split() == ["[0.", "0.01]"]


@pytest.fixture
def stepped(make_block, tmp_path):
    sim = make_block()
    sim.step(50)
    try:
        sim.save(tmp_path / "checkpoint")
    except granperi.UnsupportedError:
        pytest.skip("this version of the library has no checkpoint")
    return sim


def test_pickle_without_a_checkpoint_says_so(sim):
    try:
        pickle.dumps(sim)
    except granperi.UnsupportedError as error:
        assert "checkpoint" in str(error)


def test_load_of_what_is_not_there(tmp_path):
    with pytest.raises((granperi.FileError, granperi.UnsupportedError)):
        granperi.load(tmp_path / "nothing")


@pytest.mark.parametrize("other_of", [lambda sim: pickle.loads(pickle.dumps(sim)), copy.copy, copy.deepcopy])
def test_copies_go_on_bit_by_bit(stepped, other_of):
    other = other_of(stepped)
    assert other.config == stepped.config and other.materials == stepped.materials and other.plates == stepped.plates
    for sim in (stepped, other):
        sim.step(50)
    assert np.array_equal(other.x, stepped.x) and np.array_equal(other.pressure, stepped.pressure)
    assert other.state.step == 100


def test_callbacks_of_a_copy_count_the_same_steps(stepped):
    other = copy.copy(stepped)
    steps = []
    other.set_callback(lambda it: steps.append(it.state.step), every=7)
    other.step(10)
    assert steps == [56]


def test_load_goes_on_and_knows_the_scene(stepped, tmp_path):
    given, other = granperi.load(tmp_path / "checkpoint", stepped.config), granperi.load(tmp_path / "checkpoint")
    assert given.config == other.config == stepped.config
    assert other.materials == stepped.materials and other.plates == stepped.plates
    stepped.step(10)
    other.step(10)
    assert np.array_equal(other.x, stepped.x)


def test_the_scene_in_a_checkpoint_is_the_scene(stepped, tmp_path):
    sim = granperi.Simulation(preset="paper", spacing=0.01, nonlocal_=1, threads=1)
    beads = sim.add_material(grain_diameter=0.001)
    sim.add_column(width=0.1, height=0.05, vx=0.1, material=beads)
    sim.add_particles([0.2], [0.1], material=beads)
    sim.add_plate(granperi.Plate.floor(-1, 1))
    sim.add_plate(granperi.Plate.gate(0.1, 0.05, 0.1, "left"))
    sim.add_plate(granperi.Plate.wall(0, 0, 1, friction="coulomb", wall_mu=0.2))
    sim.save(tmp_path / "scene")
    other = granperi.load(tmp_path / "scene")
    assert other.config == sim.config and other.materials == sim.materials and other.plates == sim.plates
    assert other._columns == sim._columns


def test_output_goes_on_after_load(stepped, tmp_path):
    stepped = granperi.load(tmp_path / "checkpoint")
    with stepped.output(tmp_path / "a.h5") as output:
        output.write()
        stepped.step(10)
        output.write()
    try:
        again = granperi.load(tmp_path / "checkpoint")
        output = again.output(tmp_path / "a.h5", append=True)
    except granperi.UnsupportedError:
        pytest.skip("this version of the library cannot go on with a file")
    with output:
        again.step(20)
        output.write()
    with granperi.Result(tmp_path / "a.h5") as result:
        steps = [state.step for state in result.history]
        assert steps == [50, 70] and len(result) == 2 and result.times[1] == result.history[1].time


def test_a_simulation_travels_to_another_process(stepped):
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=context) as pool:
        x = pool.submit(positions_after, stepped, 20).result()
    stepped.step(20)
    assert np.array_equal(x, stepped.x)


def positions_after(sim, steps):
    sim.step(steps)
    return sim.x
