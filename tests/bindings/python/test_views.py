"""Views: no copies, alive as long as they are used, refused once they are out of date, never garbage."""
import gc
import weakref

import numpy as np
import pytest

import granperi


def test_a_view_shows_the_library_s_memory(sim):
    sim.step(5)
    view = sim.view("id", "position", "pressure", "shear_rate")
    assert view.names == ("id", "x", "y", "pressure", "shear_rate") and len(view) == 50
    assert np.array_equal(view.x[np.argsort(view.id)], sim.x)
    assert np.array_equal(view["pressure"][np.argsort(view.id)], sim.pressure)
    first, second = np.asarray(view.x), np.asarray(sim.view("x").x)
    assert first.__array_interface__["data"][0] == second.__array_interface__["data"][0]


def test_it_can_be_used_like_an_array(sim):
    view = sim.view("x", "y", "id")
    x = view.x.copy()
    assert np.array_equal(view.x + view.y, x + view.y.copy()) and np.array_equal(2 * view.x, 2 * x)
    assert np.array_equal(np.hypot(view.x, view.y), np.hypot(x, view.y.copy()))
    assert view.x.max() == np.max(view.x) == x.max() and view.x.mean() == pytest.approx(x.mean())
    assert view.x[3] == x[3] and np.array_equal(view.x[view.y > 0.02], x[view.y.copy() > 0.02])
    assert list(view.x) == list(x) and view.x.shape == (50,) and view.id.dtype == np.int64
    assert np.concatenate([view.x, view.y]).shape == (100,)


def test_it_refuses_once_the_epoch_has_passed(sim):
    view = sim.view("x")
    field = view.x
    epoch = sim.epoch
    sim.step()
    assert sim.epoch > epoch and not view.valid and "out of date" in repr(view) and "out of date" in repr(field)
    for use in (lambda: view.x, lambda: len(view), lambda: field[0], lambda: np.asarray(field), lambda: field + 1,
                lambda: field.copy(), lambda: field.sum(), lambda: list(field), lambda: np.sum(field),
                lambda: np.empty(50) + field):
        with pytest.raises(granperi.StateError, match="has changed since"):
            use()


def test_every_change_ends_it(make_block):
    changes = [lambda sim: sim.add_material(), lambda sim: sim.add_column(x_min=1, width=0.1, height=0.1),
               lambda sim: sim.add_particles([1], [1]), lambda sim: sim.add_plate(x0=1),
               lambda sim: sim.set_plate_velocity(0, 0, 0), lambda sim: sim.step(), lambda sim: sim.run(0.001)]
    for change in changes:
        with make_block() as sim:
            view = sim.view("x")
            change(sim)
            assert not view.valid


def test_it_is_read_only(sim):
    view = sim.view("x")
    with pytest.raises(ValueError):
        np.asarray(view.x)[0] = 1
    with pytest.raises(ValueError, match="read-only"):
        np.add(1, 2, out=view.x)
    with pytest.raises(TypeError):
        view.x[0] = 1
    with pytest.raises(ValueError):
        np.asarray(view.x).flags.writeable = True


def test_what_is_taken_from_it_stays(sim):
    view = sim.view("x")
    part, twice, whole = view.x[:5], view.x * 2, view.x.copy()
    before = sim.x
    order = np.argsort(sim.view("id").id)
    sim.run(0.05)
    assert np.array_equal(whole[order], before) and np.array_equal(part, whole[:5]) and np.array_equal(twice, 2 * whole)


def test_the_simulation_does_not_move_under_an_array(sim):
    view = sim.view("x")
    raw = np.asarray(view.x)[::2]
    kept = raw.copy()
    epoch = sim.epoch
    for change in (sim.step, lambda: sim.run(1), lambda: sim.add_column(width=1, height=1),
                   lambda: sim.set_plate_velocity(0, 1, 0)):
        with pytest.raises(granperi.StateError, match="1 array.* delete them first"):
            change()
    assert sim.epoch == epoch and np.array_equal(raw, kept)
    del raw
    assert sim.step()


def test_arrays_outlive_the_simulation(make_block):
    sim = make_block()
    raw = np.asarray(sim.view("x").x)
    kept, engine = raw.copy(), weakref.ref(sim._engine)
    sim.close()
    del sim
    gc.collect()
    assert np.array_equal(raw, kept) and engine() is not None
    del raw
    gc.collect()
    assert engine() is None


def test_a_view_keeps_the_simulation_alive(make_block):
    view = make_block().view("x", "y")
    gc.collect()
    assert view.y.max() == pytest.approx(0.045)


def test_close_ends_views(make_block):
    sim = make_block()
    view = sim.view("x")
    sim.close()
    with pytest.raises(granperi.StateError, match="closed"):
        view.x
    assert not view.valid


def test_a_field_that_was_not_asked_for(sim):
    view = sim.view("x")
    with pytest.raises(AttributeError, match="not asked for 'y'"):
        view.y
    with pytest.raises(AttributeError, match="did you mean 'pressure'"):
        view.presure


def test_no_particles():
    with granperi.Simulation() as sim:
        view = sim.view()
        assert len(view) == 0 and view.x.copy().shape == (0,) and np.asarray(view.id).dtype == np.int64


def test_views_in_a_callback_end_with_it(sim):
    views, raw = [], []

    def look(sim):
        views.append(sim.view("x"))
        assert views[-1].x.size == 50
        return False

    sim.set_callback(look)
    sim.step(3)
    assert [view.valid for view in views] == [False, False, True]

    sim.set_callback(lambda sim: raw.append(np.asarray(sim.view("x").x)))
    step = sim.state.step
    with pytest.raises(granperi.StateError, match="the callback has returned, but"):
        sim.step(10)
    assert sim.state.step == step + 1 and np.array_equal(np.sort(raw[0]), np.sort(sim.x))
