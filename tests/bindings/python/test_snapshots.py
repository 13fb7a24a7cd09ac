"""A frame of a result file tells what the simulation told when it was written: shape beside plates, plates, state."""
import math

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


def written(sim, path, *times):
    """A file with a frame at each time, and what was live then: stations; surface, lines of plates, and how far these have moved
    in the last step."""
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


@pytest.mark.parametrize("motion", [{"vx": 4.3}, {"vx": -4.3}, {"vx": 4.3, "omega": 20.0}], ids=["right", "left", "turning"])
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
