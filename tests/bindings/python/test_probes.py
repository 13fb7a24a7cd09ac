"""Probes: fields at points and loads on plates over time."""
import numpy as np
import pytest
from conftest import block

import granperi


def test_samples_are_of_the_first_steps_past_the_multiples_and_change_nothing():
    with block() as sim, block() as same:
        probe = sim.add_probe(points=[[0.0, 0.02]], fields="pressure", every=0.002)
        seen = []
        same.set_callback(lambda sim: seen.append(sim.time))
        sim.run(0.05)
        same.run(0.05)
        assert np.array_equal(sim.x, same.x)
        expected = [0.0] + [next(t for t in seen if t >= 0.002 * k) for k in range(1, 25)] + [0.05]
        assert list(probe.time) == expected and len(probe) == 26 and probe["pressure"].shape == (26, 1)


def test_pressure_at_depth_and_the_weight_on_the_floor():
    """A layer at rest between smooth walls: rho g depth, and all of its weight."""
    with granperi.Simulation(spacing=0.005) as sim:
        sim.add_column(width=0.1, height=0.05)
        sim.add_plate(granperi.Plate.floor(0, 0.1))
        for x, side in ((0, "right"), (0.1, "left")):
            sim.add_plate(granperi.Plate.wall(x, 0, 0.1, side, friction="free_slip"))
        probe = sim.add_probe(points=[[0.05, 0.02], [0.05, 0.03], [0.05, 0.2]], fields=["pressure", "speed"], plates=[0], every=0.01)
        sim.run(0.3)
        density = granperi.Material().grain_density * granperi.Material().volume_fraction
        pressure = probe["pressure"][-10:].mean(axis=0)
        assert pressure[0] == pytest.approx(density * 9.81 * 0.03, rel=0.1)
        assert pressure[0] - pressure[1] == pytest.approx(density * 9.81 * 0.01, rel=0.2)
        assert np.isnan(probe["speed"][:, 2]).all() and probe["speed"][-1, 0] < 0.01  # none in the air
        weight = density * 9.81 * 0.1 * 0.05
        # fx, fy are means over the intervals: their sum is the impulse
        assert np.sum(probe["fy"][1:, 0] * np.diff(probe.time)) == pytest.approx(sim.plate_load(0).impulse_y, rel=1e-12)
        assert -probe["fy"][-10:, 0].mean() == pytest.approx(weight, rel=0.03)
        assert np.isnan(probe["fy"][0, 0]) and probe["dx"][-1, 0] == 0


def test_a_uniform_field_is_met_exactly_also_across_a_period():
    x, y = (values.ravel() for values in np.meshgrid(0.005 + 0.01 * np.arange(20), 0.005 + 0.01 * np.arange(5)))
    with granperi.Simulation(spacing=0.01, periodic_x_min=0.0, periodic_x_max=0.2, gravity_y=0.0, sound_speed=10.0) as sim:
        sim.add_particles(x, y, 0 * x + 0.3, 0 * y)
        probe = sim.add_probe(points=[[0.0, 0.02], [0.1, 0.02], [0.2, 0.02]], fields=["vx", "x"], every=0.001)
        sim.step()
        assert probe["vx"][0] == pytest.approx(0.3, abs=1e-15)
        assert probe["x"][0, 1] == pytest.approx(0.1)


def test_table_and_remove(sim, tmp_path):
    probe = sim.add_probe(points=[[0, 0.01]], plates=[0], every=0.005)
    sim.run(0.02)
    probe.to_csv(tmp_path / "p.csv")
    table = np.genfromtxt(tmp_path / "p.csv", delimiter=",", names=True)
    assert table.dtype.names[:3] == ("time", "pressure_0", "speed_0") and "fx_0" in table.dtype.names
    assert np.array_equal(table["impulse_y_0"], probe["impulse_y"][:, 0]) and list(table["time"]) == list(probe.time)
    probe.remove()
    probe.remove()
    n = len(probe)
    sim.run(0.04)
    assert len(probe) == n == 5
    with pytest.raises(KeyError, match="did you mean 'pressure'"):
        probe["presure"]


@pytest.mark.parametrize("change, why", [
    (lambda text: text + "\n", "line 7 has 0 values: expected 10"),
    (lambda text: text.rstrip("\n").rpartition(",")[0] + "\n", "line 6 has 9 values: expected 10"),
    (lambda text: text.replace("0.005", "half", 1), "could not convert"),
    (lambda text: text.replace("fx_0", "fx_1"), "it has other columns"),
    (lambda text: "", "it has other columns"),
])
def test_a_table_that_is_damaged_is_not_taken_over(sim, tmp_path, change, why):
    probe = sim.add_probe(plates=[0], every=0.005)
    sim.run(0.02)
    probe.to_csv(tmp_path / "p.csv")
    before = probe["impulse_y"]
    probe.read_csv(tmp_path / "p.csv")
    assert np.array_equal(probe["impulse_y"], before) and len(probe) == 5
    (tmp_path / "p.csv").write_text(change((tmp_path / "p.csv").read_text()))
    with pytest.raises(granperi.FileError, match=f"p.csv: cannot be continued: .*{why}"):
        probe.read_csv(tmp_path / "p.csv")
    assert np.array_equal(probe["impulse_y"], before)


def test_a_probe_added_later_begins_there_and_an_error_in_it_comes_out(sim):
    sim.run(0.01)
    probe = sim.add_probe(points=[[0, 0.01]], every=0.01)
    sim.run(0.015)
    assert list(probe.time) == [0.01]
    sim.run(0.021)
    assert len(probe) == 2 and 0.02 <= probe.time[1] < 0.021
