"""Config, Material, Column, Plate: defaults of the library, near matches, checks."""
import copy
import math
import pickle

import numpy as np
import pytest
from granperi._library import ffi, lib

import granperi


def test_defaults_are_read_from_the_library():
    struct = ffi.new("gp_config *")
    assert lib.gp_config_init(struct, ffi.sizeof("gp_config"), 0) == 0
    for name, value in granperi.Config():
        assert value == getattr(struct, name.rstrip("_")), name
    assert granperi.Material().mu_s == pytest.approx(math.tan(math.radians(21)))


def test_defaults_follow_the_preset():
    paper = granperi.Config("paper")
    assert paper.stress is granperi.Stress.REGULARIZED and paper.friction_factor == 2
    assert granperi.Config(preset=granperi.Preset.PAPER_LOCAL).nonlocal_ == 0
    assert granperi.Config().stress is granperi.Stress.ELASTIC


@pytest.mark.parametrize("kind, wrong, near", [
    (granperi.Config, "spcing", "spacing"), (granperi.Material, "mu_S", "mu_s"),
    (granperi.Column, "witdh", "width"), (granperi.Plate, "frition", "friction")])
def test_an_unknown_keyword_lists_the_valid_ones(kind, wrong, near):
    with pytest.raises(granperi.ArgumentError) as caught:
        kind(**{wrong: 1})
    assert isinstance(caught.value, TypeError)
    assert f"'{wrong}'" in str(caught.value) and f"did you mean '{near}'?" in str(caught.value)
    assert all(name in str(caught.value) for name in kind.names())


def test_an_unknown_attribute_is_refused_too():
    column = granperi.Column()
    with pytest.raises(AttributeError, match="did you mean 'width'"):
        column.widht = 1
    with pytest.raises(AttributeError, match="did you mean 'height'"):
        column.heigth


def test_enumerations_by_member_name_or_number():
    for given in (granperi.Wall.COULOMB, "coulomb", "COULOMB", 2):
        assert granperi.Plate(friction=given).friction is granperi.Wall.COULOMB
    with pytest.raises(granperi.ArgumentError, match="did you mean 'coulomb'.*no_slip, free_slip, coulomb"):
        granperi.Plate(friction="colomb")


def test_wrong_types_name_the_argument():
    for values in ({"spacing": "thin"}, {"spacing": None}, {"threads": 1.5}, {"threads": 2**40}, {"seed": -1}):
        with pytest.raises(granperi.ArgumentError, match=f"gp_config.{next(iter(values))} = "):
            granperi.Simulation(**values)


def test_ranges_are_the_library_s():
    with pytest.raises(granperi.ArgumentError, match=r"gp_config.spacing = -1: expected a number from 1e-09 to 1e\+09"):
        granperi.Simulation(spacing=-1)


def test_tables_have_one_length():
    with pytest.raises(granperi.ArgumentError, match="knot_t of 2, knot_x of 3, knot_y of 2"):
        granperi.Simulation().add_plate(x1=1, knot_t=[0, 1], knot_x=[0, 0, 0], knot_y=[0, 1])
    with pytest.raises(granperi.ArgumentError, match="no knot_x, no knot_y"):
        granperi.Simulation().add_plate(x1=1, knot_t=[0, 1])


def test_tables_are_copied():
    times = np.array([0.0, 1.0])
    plate = granperi.Plate(knot_t=times)
    times[1] = 5
    assert plate.knot_t[1] == 1


def test_copies_and_equality():
    plate = granperi.Plate.gate(0.1, 0.05, 0.1)
    for other in (copy.deepcopy(plate), pickle.loads(pickle.dumps(plate)), plate.replace()):
        assert other == plate and other is not plate
    assert plate.replace(wall_mu=0.5) != plate
    assert eval(repr(granperi.Column(width=2)), vars(granperi)) == granperi.Column(width=2)


def test_plates_turn_their_wetted_side_the_right_way():
    """A particle on the named side is held by the plate; the plate does nothing to one on the other side."""
    def speed_after(plate, x, y, gx, gy):
        with granperi.Simulation(spacing=0.01, threads=1, gravity_x=gx, gravity_y=gy, sound_speed=10) as sim:
            sim.add_particles([x], [y])
            sim.add_plate(plate)
            sim.run(0.2)
            return math.hypot(sim.vx[0], sim.vy[0])

    free = 0.2 * 9.81
    assert speed_after(granperi.Plate.floor(-1, 1), 0, 0.005, 0, -9.81) < 0.1 * free
    assert speed_after(granperi.Plate.floor(-1, 1), 0, -0.005, 0, -9.81) == pytest.approx(free)
    for side, direction in (("right", 1), ("left", -1)):
        wall = granperi.Plate.wall(0, -1, 1, side)
        assert speed_after(wall, 0.005 * direction, 0, -9.81 * direction, 0) < 0.1 * free
        assert speed_after(wall, -0.005 * direction, 0, -9.81 * direction, 0) == pytest.approx(free)


def test_a_gate_clears_its_column_in_the_lift_time():
    gate = granperi.Plate.gate(0.1, height=0.05, lift_time=0.1, spacing=0.002)
    assert np.interp(0.1, gate.knot_t, gate.knot_y) == pytest.approx(0.05, rel=1e-3)
    assert gate.knot_y[-1] == pytest.approx(0.05 + 6 * 0.002)
