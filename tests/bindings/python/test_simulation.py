"""Life, scene, reading, errors."""
import gc
import weakref

import numpy as np
import pytest
from conftest import assert_same_state, needs_hdf5

import granperi


def test_a_scene_from_start_to_end(sim):
    assert len(sim) == 50 and sim.state.step == 0
    assert sim.run(0.05) is True
    assert sim.time == 0.05 and sim.state.step > 0
    state = sim.state
    assert state.energy_initial == pytest.approx(9.81 * 1550 * 0.1 * 0.05 * 0.025, rel=0.01)
    assert isinstance(state.dt_reason, granperi.StepLimit) and isinstance(state.at_rest, bool)


def test_the_clock_is_that_of_the_state(sim):
    assert sim.clock == granperi.Clock(time=0, dt=0, step=0)
    sim.step(3)
    time, dt, step = sim.clock
    state = sim.state
    assert (time, dt, step) == (state.time, state.dt, state.step) and step == 3 and dt > 0 and sim.time == time


def test_marks_of_the_mass(sim):
    width = 10 * sim.config.spacing
    left = sim.state.x_left
    assert list(sim.quantiles) == [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99]
    for share, x in sim.quantiles.items():
        assert x == pytest.approx(left + share * width, abs=1e-9)
    state = sim.state
    assert sim.quantiles == state.quantiles and state.quantiles[0.05] == state.x_q05
    assert state.centre_x == pytest.approx(np.mean(sim.x)) and state.centre_y == pytest.approx(np.mean(sim.y))
    assert state.detached == 0 and state.volume_drift == 0


def test_with_closes(make_block):
    with make_block() as sim:
        pass
    assert sim.closed
    sim.close()
    for call in (lambda: sim.step(), lambda: sim.run(1), lambda: sim.state, lambda: sim.clock, lambda: sim.x, lambda: sim.view(),
                 lambda: sim.add_column(width=1, height=1), lambda: sim.plan(), lambda: len(sim), lambda: sim.save("x")):
        with pytest.raises(granperi.StateError, match="closed, .*: do it before, or make a new Simulation"):
            call()
    assert "closed" in repr(sim)


def test_it_is_freed_without_close(make_block):
    sim = make_block()
    sim.step()
    gone = weakref.ref(sim._engine)
    del sim
    assert gone() is None


def test_fields_are_copies_in_the_order_of_id(sim):
    x = sim.x
    assert x.shape == (50,) and x.dtype == np.float64
    sim.run(0.05)
    assert not np.array_equal(x, sim.x)
    assert np.array_equal(sim.id, np.arange(50)) and sim.id.dtype == np.int64 and sim.column.dtype == np.int32
    fields = sim.particles("velocity", "pressure")
    assert fields.names == ("vx", "vy", "pressure") and np.array_equal(fields["vx"], sim.vx)
    assert np.array_equal(fields.pressure, sim.pressure) and len(fields) == 50
    assert len(sim.particles().names) == 16
    with pytest.raises(AttributeError, match="'x' is not here"):
        fields.x
    with pytest.raises(granperi.ArgumentError, match="did you mean 'pressure'"):
        sim.particles("presure")


def test_surface_and_interface_are_the_library_s(make_block):
    with make_block() as sim:
        other = sim.add_column(x_min=0.05, width=0.1, height=0.05)
        assert sim.surface([0.0, 0.05, 5.0]) == pytest.approx([0.05, 0.05, 0], abs=0.002)
        crossing = sim.interface(0, other, np.array([0.02, 0.03, 1.0]))
        assert crossing[:2] == pytest.approx([0.05, 0.05], abs=0.006) and np.isnan(crossing[2])
        assert sim.surface([]).shape == (0,)


def test_wrong_shapes_say_what_is_expected(sim):
    with pytest.raises(granperi.ArgumentError, match=r"x has the shape \(1, 2\): expected one dimension"):
        sim.surface([[1, 2]])
    with pytest.raises(granperi.ArgumentError, match="y has 1 values: expected 2"):
        sim.add_particles([0, 1], [0])
    with pytest.raises(granperi.ArgumentError, match="x: expected numbers"):
        sim.surface(["a"])
    with pytest.raises(granperi.ArgumentError, match="x: expected numbers"):
        sim.surface([1 + 2j])
    with pytest.raises(granperi.ArgumentError, match=r"x\[1\] = nan"):
        sim.surface([0, np.nan])


def test_strided_and_single_precision_arrays_are_taken(make_block):
    with make_block() as sim:
        grid = np.arange(8, dtype=np.float32).reshape(4, 2)
        sim.add_particles(grid[:, 0], grid[:, 1], vx=[1, 2, 3, 4], vy=np.zeros(8)[::2])
        assert np.array_equal(sim.x[-4:], [0, 2, 4, 6]) and np.array_equal(sim.vx[-4:], [1, 2, 3, 4])


def test_a_second_column_after_the_first_step_is_refused(sim):
    sim.step()
    with pytest.raises(granperi.StateError, match="the scene is fixed once the first step is taken"):
        sim.add_column(width=0.1, height=0.1)


def test_load_of_the_floor_is_the_weight(sim):
    sim.run(0.3)
    mean = (sim.plate_load(0).impulse_y) / 0.3
    assert mean == pytest.approx(-9.81 * 1550 * 0.1 * 0.05, rel=0.1)
    with pytest.raises(granperi.ArgumentError, match="plate = 1"):
        sim.plate_load(1)


def test_plan_says_what_is_left_out(sim):
    plan = {entry.name: entry for entry in sim.plan()}
    assert plan["update_neighbors"].active and not plan["side_wall_friction"].active
    assert all(entry.reason for entry in plan.values())


def test_divergence_is_its_own_error():
    with granperi.Simulation(spacing=0.01, threads=1, sound_speed=10, time_step=0.01, allow_unstable_step=1) as sim:
        sim.add_column(width=0.2, height=0.2)
        sim.add_plate(granperi.Plate.floor(-1, 1))
        with pytest.warns(granperi.GranperiWarning), pytest.raises(granperi.DivergedError, match="step"):
            sim.step(1000)
        assert np.isfinite(sim.x).all()
        with pytest.raises(granperi.StateError, match="diverged"):
            sim.step()


def test_frames_are_the_first_states_past_the_multiples(sim):
    states = list(sim.frames(0.035, 0.01))
    times = [state.time for state in states]
    assert len(times) == 5 and len(sim.history) == 5 and times[0] == 0 and times[-1] == 0.035
    for state, due in zip(states[1:4], (0.01, 0.02, 0.03)):
        assert due <= state.time + 1e-9 * state.dt < due + state.dt
    assert sim.history.time == pytest.approx(times) and sim.history.kinetic.shape == (5,)
    with pytest.raises(granperi.ArgumentError, match="every = 0"):
        sim.frames(1, 0)
    with pytest.raises(granperi.ArgumentError, match="t_end = 0"):
        list(sim.frames(0, 0.1))


def test_warnings_point_to_the_caller():
    with granperi.Simulation(spacing=0.01, threads=1) as sim:
        with pytest.warns(granperi.GranperiWarning, match="rounded to") as caught:
            sim.add_column(width=0.1049, height=0.05)
        assert caught[0].filename == __file__


@pytest.mark.filterwarnings("error")
def test_a_warning_can_be_made_an_error_and_the_run_goes_on_after_it():
    with granperi.Simulation(spacing=0.01, threads=1, gravity_y=0) as sim:
        sim.add_column(width=0.1, height=0.1)
        with pytest.raises(granperi.GranperiWarning, match="sound_speed"):
            sim.step(10)
        step = sim.state.step
        sim.step(10)
        assert sim.state.step == step + 10


def test_has_feature():
    assert granperi.has_feature("nothing") is False and granperi.has_feature(None) is False
    assert isinstance(granperi.has_feature("hdf5"), bool)


@needs_hdf5
def test_output(sim, tmp_path):
    path = tmp_path / "frames.h5"
    with sim.output(path, fields=["velocity"]) as output:
        with pytest.raises(granperi.StateError):
            sim.output(tmp_path / "other.h5")
        output.write()
        sim.run(0.02)
        output.write()
    with pytest.raises(granperi.StateError, match="closed"):
        output.write()
    output.close()
    with granperi.Result(path) as result:
        assert list(result.times) == [0, 0.02] and result.fields == ("id", "x", "y", "vx", "vy")
        assert np.array_equal(result[-1].x, sim.x)
        assert_same_state(result.history[1], sim.state)
    assert sim.step()


@needs_hdf5
def test_output_that_writes_by_itself_and_closes_with_the_simulation(make_block, tmp_path):
    with make_block() as sim:
        output = sim.output(tmp_path / "frames.h5", every=0.01, single_precision=True)
        sim.run(0.05)
    assert output.closed
    with granperi.Result(tmp_path / "frames.h5") as result:
        assert len(result) == 6 and np.array_equal(result.history.time, result.times)


@needs_hdf5
def test_output_errors_name_the_path(sim, tmp_path):
    with pytest.raises(granperi.FileError, match="nowhere"):
        sim.output(tmp_path / "nowhere" / "frames.h5")
    with pytest.raises(OSError):
        sim.output(tmp_path)
    with pytest.raises(granperi.ArgumentError, match="compression = 10"):
        sim.output(tmp_path / "frames.h5", compression=10)
    with pytest.raises(granperi.ArgumentError, match="without the character 0"):
        sim.output("a\0b")


def test_a_reference_cycle_does_not_keep_it(make_block):
    sim = make_block()
    sim.myself = sim
    gone = weakref.ref(sim._engine)
    del sim
    gc.collect()
    assert gone() is None


def test_parts_of_the_state_are_those_of_the_state(make_block):
    with make_block() as sim:
        sim.step(20)
        some, whole = sim.state_parts(marks=True), sim.state
        assert some.quantiles == whole.quantiles == sim.quantiles
        assert some.kinetic == whole.kinetic and some.at_rest == whole.at_rest
        assert np.isnan([some.x_left, some.peak_height, some.detached, some.volume_drift]).all()
        assert sim.state_parts(deposit=True).x_left == whole.x_left
        assert sim.state_parts(drift=True).volume_drift == whole.volume_drift


@needs_hdf5
def test_single_precision_keeps_positions_in_the_coordinates_of_a_map(tmp_path):
    east, north = 5e5, 4.2e6
    with granperi.Simulation(spacing=0.005) as sim:
        sim.add_column(x_min=east, y_min=north, width=0.08, height=0.05)
        sim.add_plate(granperi.Plate(x0=east + 1, y0=north, x1=east - 1, y1=north))
        sim.step(10)
        with sim.output(tmp_path / "map.h5", single_precision=True) as output:
            output.write()
        x, y = np.array(sim.x), np.array(sim.y)
    with granperi.Result(tmp_path / "map.h5") as result:
        assert np.abs(result[0].x - x).max() < 1e-3 * 0.005 and np.abs(result[0].y - y).max() < 1e-3 * 0.005
