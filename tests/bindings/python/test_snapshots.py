"""A frame of a result file tells what the simulation told when it was written: shape beside plates, plates, state."""
import math

import numpy as np
import pytest
from conftest import needs_hdf5

import granperi

h5py = pytest.importorskip("h5py")
pytestmark = needs_hdf5


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
