"""A frame of a result file tells what the simulation told when it was written: shape beside plates, plates, state."""
import math
import warnings

import numpy as np
import pytest
from conftest import needs_hdf5

import granperi
from granperi import Plate

h5py = pytest.importorskip("h5py")
pytestmark = needs_hdf5

SPACING = 0.01
ROUNDING = 1e-9 * SPACING  # of the places of plates: the library measures both surfaces in the same way


def simulation(**config):
    return granperi.Simulation(**{"spacing": SPACING, "threads": 1, "sound_speed": 20.0, **config})


def column_at_a_wall(**config):
    sim = simulation(**config)
    sim.add_column(x_min=0.0, width=0.12, height=0.12)
    sim.add_plate(Plate.wall(0.0, 0.0, 0.3))
    sim.add_plate(Plate.floor(-0.1, 0.6))
    return sim


def filled(sim, is_inside):
    """With particles where is_inside(x, y) says, on a lattice about the origin."""
    x, y = (SPACING * (values.ravel() + 0.5) for values in np.meshgrid(np.arange(-20, 20), np.arange(-20, 20)))
    inside = is_inside(x, y)
    sim.add_particles(x[inside], y[inside])
    return sim


def bowl():
    """A line of nine segments, full to the height of 0.1 m."""
    sim = filled(simulation(), lambda x, y: (y > 8 * x**2 + SPACING) & (y < 0.1))
    x = np.linspace(-0.2, 0.2, 10)
    sim.add_plate(Plate.line(np.column_stack([x, 8 * x**2 - 0.01]), material="left"))
    return sim


def closed_drum(**motion):
    sim = filled(simulation(), lambda x, y: (np.hypot(x, y) < 0.132) & (y < 0.02))
    angle = np.linspace(0, 2 * np.pi, 25)[:-1]
    sim.add_plate(Plate.line(0.14 * np.column_stack([np.cos(angle), np.sin(angle)]), True, "inside", **motion))
    return sim


def thin_gate():
    """High on one side, low on the other: neither is seen through the gate, whose two plates rise."""
    sim = simulation()
    sim.add_column(x_min=-0.12, width=0.12, height=0.12)
    sim.add_column(x_min=0.0, width=0.12, height=0.05)
    for side in ("left", "right"):
        sim.add_plate(Plate.wall(0.0, 0.0, 0.3, side, vy=0.1))
    sim.add_plate(Plate.floor(-0.5, 0.5))
    return sim


def brink(**of_slope):
    """Two rows on a floor that rises and a slope that falls by 27 degrees: one wall as long as they move together."""
    def is_near(x, y):
        return (np.abs(x) < 0.1) & (np.abs(y + np.maximum(x, 0) / 2 - SPACING) < 0.7 * SPACING)

    sim = filled(simulation(), is_near)
    sim.add_plate(Plate.floor(-0.3, 0.0, vy=0.02))
    sim.add_plate(Plate.line([[0.0, 0.0], [0.3, -0.15]], material="left", **of_slope))
    return sim


def lid_under_load():
    """Loaded, driven by a table and far away."""
    sim = column_at_a_wall()
    sim.add_plate(x0=-0.1, y0=0.125, x1=0.3, y1=0.1251, normal_pressure=50, vx=0.0)
    sim.add_plate(Plate.gate(0.12, 0.12, 0.1, "left", spacing=SPACING))
    sim.add_plate(x0=1e6, x1=1e6 + 1, friction="coulomb", wall_mu=0.3)
    return sim


def square():
    sim = simulation(gravity_y=0.0)
    sim.add_column(x_min=-0.05, width=0.1, height=0.1)
    return sim


SCENES = {
    "wall": column_at_a_wall,
    "wall, wide horizon": lambda: column_at_a_wall(horizon=4.5),
    "wall, paper's scheme": lambda: column_at_a_wall(preset="paper"),
    "wall, implicit": lambda: column_at_a_wall(stress="implicit"),
    "bowl": bowl,
    "drum": closed_drum,
    "drum that turns": lambda: closed_drum(omega=3.0),
    "gate": thin_gate,
    "brink": lambda: brink(vy=0.02),
    "brink that parts": brink,
    "lid": lid_under_load,
    "no plates": square,
}


def written(sim, path, *times):
    """A file with a frame at each time, and what was live then: stations; surface, lines of plates, and how far these
    have moved in the last step."""
    stations = np.arange(-0.3, 0.5, 0.23 * SPACING)
    seen = []
    with sim.output(path) as output:
        for time in times:
            sim.run(time)
            before = granperi._result.snapshot(sim).plate_lines()
            sim.step(1 if time > 0 else 0)
            output.write()
            live = granperi._result.snapshot(sim)
            lines = live.plate_lines()
            moved = max((np.abs(after - line).max() for line, after in zip(before, lines)), default=0.0)
            seen.append((live.surface(stations), lines, moved))
    return stations, seen


def assert_same_shape(path, stations, seen):
    """Of what moves the library knows the place before the last step, and a mirror image moves by twice as much."""
    with granperi.Result(path) as result, warnings.catch_warnings():
        warnings.simplefilter("error")
        for kept, (surface, _, moved) in zip(result, seen, strict=True):
            assert np.any(surface)
            assert np.array_equal(kept.surface(stations) == 0, surface == 0)  # the fronts
            assert kept.surface(stations) == pytest.approx(surface, rel=0, abs=2 * moved + ROUNDING)


@pytest.mark.parametrize("name", SCENES)
def test_a_frame_has_the_surface_of_the_simulation(name, tmp_path):
    with SCENES[name]() as sim:
        assert_same_shape(tmp_path / "run.h5", *written(sim, tmp_path / "run.h5", 0.0, 0.03, 0.1))


def test_particles_behind_plates(tmp_path):
    """Of a scene that a run would warn of, a frame says nothing, and has the same surface."""
    with column_at_a_wall() as sim:
        sim.add_particles(np.full(5, -0.2 * SPACING), 0.13 + SPACING * np.arange(5))  # in the wall's surface
        sim.add_particles(np.full(12, -0.5 * SPACING), SPACING * (0.5 + np.arange(12)))  # behind it
        sim.add_plate(Plate.wall(0.055, 0.02, 0.2))  # through the column
        assert_same_shape(tmp_path / "run.h5", *written(sim, tmp_path / "run.h5", 0.0))


def test_the_walls_are_seen_in_files_that_only_have_the_scene(tmp_path):
    """As of 0.1, which wrote no places of plates."""
    with column_at_a_wall() as sim:
        stations, seen = written(sim, tmp_path / "run.h5", 0.0, 0.05)
    with h5py.File(tmp_path / "run.h5", "r+") as file:
        del file["walls"]
        for frame in range(2):
            del file[f"frames/000000/{frame:06d}/walls"]
    assert_same_shape(tmp_path / "run.h5", stations, seen)


# ------------------------------------------------------------------------------------------------------ periodic


def belt_of_material(**config):
    """A layer that slides through the ends of the period on a floor that has none."""
    sim = simulation(periodic_x_min=-0.1, periodic_x_max=0.2, gravity_x=3.0, **config)
    sim.add_column(x_min=-0.1, width=0.3, height=0.05, vx=1.0)
    sim.add_plate(Plate.floor(-0.1, 0.2, friction="free_slip"))
    return sim


def test_a_frame_of_a_periodic_scene_has_a_surface(tmp_path):
    """Also while particles are beyond an end."""
    path = tmp_path / "run.h5"
    with belt_of_material() as sim:
        stations, seen = written(sim, path, *np.arange(0.0, 0.1, 0.007))
    with granperi.Result(path) as result:
        assert any(shot.x.max() > 0.2 for shot in result)
    assert_same_shape(path, stations, seen)


@pytest.mark.parametrize("motion", [{"vx": 4.3}, {"vx": -4.3}, {"vx": 4.3, "omega": 20.0}],
                         ids=["right", "left", "turning"])
@pytest.mark.filterwarnings("ignore:the scene has no material")
@pytest.mark.parametrize("with_material", [True, False])
def test_lines_of_a_plate_that_has_gone_round(motion, with_material, tmp_path):
    """Far above the material, where nothing makes the library take the periods off, and through it."""
    path = tmp_path / "run.h5"
    with simulation(periodic_x_min=-0.1, periodic_x_max=0.2, gravity_y=0.0) as sim:
        if with_material:
            sim.add_column(x_min=-0.1, width=0.3, height=0.05)
        sim.add_plate(Plate.floor(-0.1, 0.2))
        sim.add_plate(Plate.wall(0.05, 0.5, 0.55, pivot_x=0.05, pivot_y=0.52, **motion))
        sim.add_plate(Plate.wall(0.2, 0.2, 0.3))  # at an end, which is the other one too
        _, seen = written(sim, path, *np.arange(0.0, 0.16, 0.004))
        assert abs(sim.plate_load(1).dx) > 2 * 0.3
    with granperi.Result(path) as result:
        for kept, (_, lines, _) in zip(result, seen, strict=True):
            for one, other in zip(kept.plate_lines(), lines, strict=True):
                assert one == pytest.approx(other, rel=0, abs=ROUNDING)
                assert -0.1 - ROUNDING <= 0.5 * (one[:, 0].min() + one[:, 0].max()) < 0.2
        places = [lines[1][0, 0] for _, lines, _ in seen]
        assert np.ptp(places) > 0.25  # it goes through all of the period


# --------------------------------------------------------------------------------------------------------- state


@pytest.mark.parametrize("lost, absent", [("kinetic", math.nan), ("x_q50", math.nan), ("collisions", math.nan),
                                          ("at_rest", None), ("dt_reason", None)])
def test_a_file_that_lacks_a_name_of_the_state(sim, lost, absent, tmp_path):
    path = tmp_path / "run.h5"
    history = sim.record(path, 0.01, 0.005)
    with h5py.File(path, "r+") as file:
        state = file["observables/state"]
        names, values = state["value"].attrs["names"], state["value"][()]
        column = [name.decode() for name in names].index(lost)
        del state["value"]
        state["value"] = np.delete(values, column, axis=1)
        state["value"].attrs["names"] = np.delete(names, column)
    with granperi.Result(path) as result:
        kept = getattr(result[-1].state, lost)
        assert kept is None if absent is None else math.isnan(kept)
        others = ("time", "step", "max_speed", "peak_height", "n_particles")
        assert all(getattr(result[-1].state, name) == getattr(history[-1], name) for name in others)
        assert len(getattr(result.history, lost)) == 3 and repr(result.history) == repr(history)
        if absent is not None:
            assert np.isnan(getattr(result.history, lost)).all()
        assert f"{lost}=" in repr(result[-1].state) and f"<td>{lost}</td>" in result[-1].state._repr_html_()
        result.history.to_csv(tmp_path / "states.csv")
    table = np.genfromtxt(tmp_path / "states.csv", delimiter=",", names=True)
    assert np.isnan(table[lost]).all() and table["time"][-1] == history[-1].time


def test_a_file_with_a_name_that_the_state_does_not_have(sim, tmp_path):
    """As of a later version."""
    path = tmp_path / "run.h5"
    history = sim.record(path, 0.01, 0.005)
    with h5py.File(path, "r+") as file:
        values = file["observables/state/value"]
        values.attrs["names"] = [b"of_later" if name == b"detached" else name for name in values.attrs["names"]]
    with granperi.Result(path) as result:
        assert math.isnan(result[-1].state.detached) and result[-1].state.x_q50 == history[-1].x_q50
