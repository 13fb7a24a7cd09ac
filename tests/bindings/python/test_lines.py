"""Plates of any shape that turn: what Python hands over, reads back, takes from scene files and draws."""
import math
import pickle

import numpy as np
import pytest
from conftest import needs_hdf5

import granperi

SQUARE = [[0, 0], [0, 0.1], [0.1, 0.1], [0.1, 0]]  # clockwise: material inside when closed


def polygon(radius, n, clockwise=True):
    angle = 2 * np.pi * np.arange(n) / n * (-1 if clockwise else 1)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def drum(**more):
    sim = granperi.Simulation(spacing=0.01, threads=1, sound_speed=30)
    inside = np.arange(-9, 9) * 0.01 + 0.005
    x, y = (values.ravel() for values in np.meshgrid(inside, inside[:7]))
    near = np.hypot(x, y) < 0.092
    sim.add_particles(x[near], y[near])
    sim.add_plate(granperi.Plate.line(polygon(0.1, 16), closed=True, **more))
    return sim


# ------------------------------------------------------------------------------------------------ the objects


def test_points_are_both_coordinates_at_once():
    plate = granperi.Plate(points=SQUARE)
    assert np.array_equal(plate.point_x, [0, 0, 0.1, 0.1]) and np.array_equal(plate.points, SQUARE)
    assert plate == granperi.Plate(point_x=[0, 0, 0.1, 0.1], point_y=[0, 0.1, 0.1, 0])
    assert pickle.loads(pickle.dumps(plate)) == plate == plate.replace() != plate.replace(points=SQUARE[:3])
    plate.points = None
    assert plate == granperi.Plate() and np.array_equal(granperi.Plate(x1=2).points, [[0, 0], [2, 0]])
    assert "points" in str(granperi.Plate.__signature__)


def test_a_closed_line_and_its_side():
    """The way has the material on its right: clockwise around what is inside."""
    closed = granperi.Plate.line(SQUARE, closed=True)
    assert np.array_equal(closed.points, [*SQUARE, SQUARE[0]])
    assert closed == granperi.Plate.line(closed.points, closed=True)
    assert closed == granperi.Plate.line(SQUARE, True, material="inside")
    assert np.array_equal(granperi.Plate.line(SQUARE, True, material="outside").points, closed.points[::-1])
    assert closed == granperi.Plate.line(SQUARE[::-1], True, material="inside").replace(points=closed.points)
    assert np.array_equal(granperi.Plate.line(SQUARE, material="left").points, SQUARE[::-1])
    with pytest.raises(granperi.ArgumentError, match="material = 'inside': expected 'right' or 'left'"):
        granperi.Plate.line(SQUARE, material="inside")
    with pytest.raises(granperi.ArgumentError, match="material = 'above'"):
        granperi.Plate.line(SQUARE, material="above")


@pytest.mark.parametrize("points, message", [
    ([0, 1, 2], r"gp_plate.points: expected numbers of the shape \(n, 2\).*got the shape \(3,\)"),
    ([[0, 1, 2]], r"got the shape \(1, 3\)"),
    ([[0, 1], [2]], r"expected numbers of the shape \(n, 2\)"),
    ([["a", "b"], ["c", "d"]], r"gp_plate.points\[:, 0\]: expected numbers"),
])
def test_points_of_another_shape(points, message):
    with pytest.raises(granperi.ArgumentError, match=message):
        granperi.Plate(points=points)


@pytest.mark.parametrize("values, message", [
    ({"point_x": [0, 1]}, "point_x, point_y of one length, got point_x of 2, no point_y"),
    ({"point_x": [0, 1], "point_y": [0, 1, 2]}, "got point_x of 2, point_y of 3"),
    ({"points": np.empty((0, 2))}, "gp_plate.point_x has no values"),
    ({"points": [[0, 0]]}, "gp_plate.n_points = 1: expected 0 or a whole number from 2"),
    ({"points": [[0, 0], [1, 0], [1, 1e-4]]}, r"gp_plate.point_x\[2\], point_y\[2\] = \(1, 0.0001\)"),
    ({"points": [[0, 0], [1, 0], [1, 1], [0.5, -1]]}, "the segment from point 0 meets that from point 2"),
    ({"points": [[0, 0], [1, math.nan]]}, r"gp_plate.point_y\[1\] = nan"),
    ({"points": SQUARE, "x1": 1}, "gp_plate.x1 = 1: expected 0 for a plate with n_points"),
    ({"x1": 1, "omega": math.inf}, "gp_plate.omega = inf"),
    ({"x1": 1, "pivot_x": math.nan}, "gp_plate.pivot_x = nan"),
    ({"x1": 1, "omega": 1, "normal_pressure": 10}, "omega = 1: expected 0 for a plate with normal_pressure"),
    ({"x1": 1, "friction": "free_slip", "surface_velocity": 1}, "gp_plate.surface_velocity = 1: expected 0"),
    ({"x1": 1, "knot_angle": [0, 1]}, "expected knot_t, knot_angle of one length, got knot_angle of 2, no knot_t"),
    ({"x1": 1, "knot_t": [0, 1], "knot_x": [0, 1], "knot_angle": [0, 1]}, "no knot_y"),
    ({"x1": 1, "knot_t": [0, 1], "knot_angle": [0, 1, 2]}, "knot_t of 2, knot_angle of 3"),
])
def test_mistakes_name_the_parameter(values, message):
    with granperi.Simulation(spacing=0.01) as sim:
        with pytest.raises(granperi.ArgumentError, match=message):
            sim.add_plate(**values)
        assert not sim.plates


# ------------------------------------------------------------------------------------------------- the motion


@pytest.mark.parametrize("motion", [
    {"omega": 0.5}, {"omega": 0.5, "vx": 0.01, "pivot_x": 0.2}, {"vy": 0.01},
    {"knot_t": [0, 0.1, 0.3], "knot_angle": [0, 0.1, 0]},
    {"knot_t": [0, 0.1, 0.3], "knot_x": [0, 0.01, 0], "knot_y": [0, 0, 0.02], "knot_angle": [0, -0.1, 0.1], "pivot_y": 0.1},
])
def test_python_knows_where_a_plate_is(motion):
    """What Plate.at says is what the engine has done."""
    with granperi.Simulation(spacing=0.01, threads=1) as sim:
        sim.add_plate(points=SQUARE, **motion)
        sim.run(0.25)
        load = sim.plate_load(0)
        assert sim.plates[0].at(0.25) == pytest.approx(sim.plates[0].placed(load.dx, load.dy, load.angle), abs=1e-12)
        assert not np.allclose(sim.plates[0].at(0.25), SQUARE, atol=1e-4)


def test_a_turn_is_about_the_pivot():
    quarter = granperi.Plate(x0=1, x1=2, pivot_x=1, pivot_y=1).placed(10, 0, math.pi / 2)
    assert quarter == pytest.approx(np.array([[12, 1], [12, 2]]))


def test_the_host_turns_a_drum():
    with drum() as sim, drum(omega=2) as same:
        sim.set_plate_motion(0, 0, 0, 2)
        sim.run(0.1)
        same.run(0.1)
        load = sim.plate_load(0)
        assert np.array_equal(sim.x, same.x) and load == same.plate_load(0)
        assert load.angle == pytest.approx(0.2) and load.dx == load.dy == 0
        # What turns the material is the opposite of its moment on the drum.
        assert load.impulse_torque < 0 and load.torque_pivot != load.torque
        sim.set_plate_velocity(0, 0.01, 0)
        sim.run(0.2)
        assert sim.plate_load(0).angle == load.angle and sim.plate_load(0).dx == pytest.approx(0.001)
        with pytest.raises(granperi.ArgumentError, match="plate = 1"):
            sim.set_plate_motion(1, 0, 0, 0)
        with pytest.raises(granperi.ArgumentError, match="omega"):
            sim.set_plate_motion(0, 0, 0, math.nan)
        with pytest.raises(granperi.ArgumentError, match="omega = 'fast': expected a number"):
            sim.set_plate_motion(0, 0, 0, "fast")


def test_a_belt_drives_what_lies_on_it():
    """Friction mu g for 0.05 s, less than it takes to come up to the belt."""
    with granperi.Simulation(spacing=0.01, threads=1) as sim:
        sim.add_column(x_min=-0.1, width=0.2, height=0.04)
        sim.add_plate(granperi.Plate.floor(-1, 1, friction="coulomb", wall_mu=0.2, surface_velocity=-1))
        sim.run(0.05)
        mass = len(sim) * 0.01**2 * 2500 * 0.62
        assert sim.state.momentum_x == pytest.approx(0.2 * 9.81 * 0.05 * mass, rel=0.1)  # a floor runs from right to left
        assert sim.plate_load(0).dx == 0


@needs_hdf5
def test_a_checkpoint_brings_lines_back(tmp_path):
    with drum(omega=2) as sim:
        sim.add_plate(points=SQUARE, knot_t=[0, 1], knot_x=[0, 1], knot_y=[0, 0], knot_angle=[0, 3])
        sim.add_plate(x0=1, x1=2, y1=1, knot_t=[0, 1, 2], knot_x=[0, 1, 1], knot_y=[0, 0, 0])
        sim.add_plate(x0=1, x1=3, y1=1, pivot_x=3, surface_velocity=0.5)
        sim.run(0.02)
        sim.save(tmp_path / "drum.gpc")
        with granperi.load(tmp_path / "drum.gpc") as other:
            assert other.plates == sim.plates
            other.run(0.05)
            sim.run(0.05)
            assert np.array_equal(other.x, sim.x) and other.plate_load(0) == sim.plate_load(0)


@needs_hdf5
def test_pictures_show_where_a_line_is(tmp_path):
    import granperi.plot

    with drum(omega=2) as sim:
        sim.add_plate(x0=0.3, x1=0.2, normal_pressure=10)  # rises by its load
        with sim.output(tmp_path / "drum.h5") as output:
            output.write()
            sim.run(0.05)
            sim.set_plate_motion(0, 0.1, 0, -2)  # as no scene has it
            sim.run(0.1)
            output.write()
        with granperi.Result(tmp_path / "drum.h5") as result:
            assert result[-1].plate_lines()[0] == pytest.approx(sim.plates[0].placed(0.005, 0, 0), abs=1e-12)
            assert np.array_equal(result[0].plate_lines()[0], sim.plates[0].points)
            load = sim.plate_load(1)
            assert load.dy > 0.001 and result[-1].plate_lines()[1] == pytest.approx(sim.plates[1].placed(load.dx, load.dy))
            axes = granperi.plot.field(result)
            drawn, _ = (line for line in axes.lines if line.get_gid() == "plate")
            assert np.array_equal(np.column_stack(drawn.get_data()), result[-1].plate_lines()[0])
            # All of the drum is to be seen, not only its filled part.
            assert axes.get_ylim()[1] > 0.1 and axes.get_xlim()[0] < -0.1


# -------------------------------------------------------------------------------------------------- scene files

SCENE = """\
[config]
spacing = 0.01
threads = 1

[[wall_line]]
points = [[0.1, 0.0], [0.0, -0.1], [-0.1, 0.0], [0.0, 0.1]]
closed = true
omega = 2
friction = "coulomb"
wall_mu = 0.4

[[wall_line]]
file = "profile.csv"
material = "left"
"""
PROFILE = "x, y\n-1.0, 0.5  # crest\n\n0.0, 0.0\n1;0.25\n2 0.5\n"


@pytest.fixture
def scene_file(tmp_path):
    (tmp_path / "profile.csv").write_text(PROFILE)
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def test_a_scene_file_has_lines(scene_file):
    with granperi.Scene.read(scene_file).build() as sim:
        turning, ground = sim.plates
        assert turning == granperi.Plate.line([[0.1, 0], [0, -0.1], [-0.1, 0], [0, 0.1]], True, omega=2, friction="coulomb",
                                              wall_mu=0.4)
        assert np.array_equal(ground.points, [[2, 0.5], [1, 0.25], [0, 0], [-1, 0.5]])


@pytest.mark.parametrize("right, wrong, message", [
    ("closed = true", "closd = true", r"line 7, \[\[wall_line\]\] number 1: unknown key 'closd': did you mean 'closed'"),
    ("closed = true", "closed = 1", r"line 5, \[\[wall_line\]\] number 1: closed = 1: expected true or false"),
    ("omega = 2", 'omega = "fast"', r"line 5, \[\[wall_line\]\] number 1: gp_plate.omega = 'fast': expected a number"),
    ("points = ", "point_x = ", "unknown key 'point_x'"),
    ("[[0.1, 0.0], ", "[[0.1], ", r"line 5, \[\[wall_line\]\] number 1: points: expected numbers of the shape \(n, 2\)"),
    ("[0.0, -0.1], ", "", r"\[\[wall_line\]\] number 1: gp_plate.point_x, point_y: the segment from point . meets"),
    ('file = "profile.csv"', 'file = "profil.csv"', r"line 12, \[\[wall_line\]\] number 2: .*profil.csv: cannot be read: No such"),
    ('file = "profile.csv"', "file = 3", r"file = 3: expected the name of a file"),
    ('file = "profile.csv"', "", "expected either points = .* or file = "),
    ('file = "profile.csv"', 'file = "profile.csv"\npoints = [[0, 0], [1, 1]]', "expected either points = .*, not both"),
    ('material = "left"', 'material = "above"', r"number 2: material = 'above': expected 'right' or 'left'"),
])
def test_mistakes_in_a_scene_file(scene_file, right, wrong, message):
    assert right in SCENE
    scene_file.write_text(SCENE.replace(right, wrong, 1).replace("0.1, 0.0], [-0.1", "0.1, 0.0], [-0.1"))
    if "meets" in message:  # a bow tie
        scene_file.write_text(SCENE.replace("[0.0, -0.1], [-0.1, 0.0], [0.0, 0.1]", "[-0.1, 0.0], [0.0, 0.1], [0.0, -0.1]"))
    with pytest.raises(granperi.SceneError, match=message) as caught:
        granperi.Scene.read(scene_file).build()
    assert str(scene_file) in str(caught.value)


@pytest.mark.parametrize("text, message", [
    ("0, 0\n1, a\n", "profile.csv, line 2: expected two numbers, x and y in m, got '1, a'"),
    ("x y\nx y\n0 0\n1 1\n", "line 2: expected two numbers"),
    ("0, 0\n1, 1, 1\n", "line 2: expected two numbers.*got '1, 1, 1'"),
    ("1\n2\n", "line 1: expected two numbers.*got '1'"),
    ("x,y\n0,0\n", "has 1 points, expected two or more"),
    ("", "has 0 points"),
    ("0,0\n1,inf\n", r"gp_plate.point_x\[0\] = 1|gp_plate.point_y\[0\] = inf"),
])
def test_mistakes_in_a_profile(scene_file, text, message):
    (scene_file.parent / "profile.csv").write_text(text)
    with pytest.raises(granperi.SceneError, match=r"\[\[wall_line\]\] number 2: .*") as caught:
        granperi.Scene.read(scene_file).build()
    caught.match(message)


def test_a_profile_that_is_no_text(scene_file):
    (scene_file.parent / "profile.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(granperi.SceneError, match="profile.csv': cannot be read as text"):
        granperi.Scene.read(scene_file).build()
