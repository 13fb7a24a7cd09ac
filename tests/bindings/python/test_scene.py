"""Scene files: what they build, and what is said of mistakes."""
import numpy as np
import pytest
from conftest import needs_hdf5

import granperi

TEXT = """\
[config]
spacing = 0.01
threads = 1
stress = "elastic"
nonlocal = 1

[run]
end = 0.03
every = 0.01

[[material]]
name = "fine"
grain_diameter = 0.001

[[column]]
width = 0.1
height = 0.05
material = "fine"

[[column]]
x_min = 0.2
width = 0.1
height = 0.05

[[particles]]
x = [0.15]
y = [0.005]

[[floor]]
x_left = -0.5
x_right = 0.5
friction = "coulomb"
wall_mu = 0.3

[[wall]]
x = 0
y_bottom = 0
y_top = 0.1

[[gate]]
x = 0.1
height = 0.05
lift_time = 0.1
material = "left"

[[plate]]
x0 = -0.2
y1 = 0.1
"""


def test_a_scene_is_what_the_same_calls_make():
    scene = granperi.Scene.parse(TEXT)
    with scene.build() as sim, granperi.Simulation(spacing=0.01, threads=1) as same:
        fine = same.add_material(grain_diameter=0.001)
        same.add_column(width=0.1, height=0.05, material=fine)
        same.add_column(x_min=0.2, width=0.1, height=0.05)
        same.add_particles([0.15], [0.005])
        same.add_plate(granperi.Plate.floor(-0.5, 0.5, friction="coulomb", wall_mu=0.3))
        same.add_plate(granperi.Plate.wall(0, 0, 0.1))
        same.add_plate(granperi.Plate.gate(0.1, 0.05, 0.1, "left", spacing=0.01))
        same.add_plate(x0=-0.2, y1=0.1)
        assert sim.plates == same.plates and len(sim.plates) == 4 and sim.materials == same.materials
        sim.run(0.03)
        same.run(0.03)
        assert np.array_equal(sim.x, same.x) and np.array_equal(sim.pressure, same.pressure)


def test_the_same_scene_at_another_spacing():
    scene = granperi.Scene.parse(TEXT)
    with scene.build() as coarse, scene.build(spacing=0.005) as fine:
        assert len(fine) == 4 * (len(coarse) - 1) + 1
        assert fine.plates[2].knot_y[-1] == pytest.approx(0.05 + 6 * 0.005)


def test_a_scene_by_keyword():
    scene = granperi.Scene(granperi.Config(spacing=0.01, threads=1))
    scene.add("column", width=0.1, height=0.05)
    scene.add("floor", x_left=-1, x_right=1)
    with scene.build() as sim:
        assert len(sim) == 50
    with pytest.raises(granperi.SceneError, match="unknown key 'heigth': did you mean 'height'"):
        scene.add("column", heigth=1)
    with pytest.raises(granperi.SceneError, match="did you mean 'column'"):
        scene.add("colum")


@pytest.mark.parametrize("right, wrong, message", [
    ("width = 0.1", "widht = 0.1", r"line 16, \[\[column\]\] number 1: unknown key 'widht': did you mean 'width'"),
    ("x_min = 0.2", "xmin = 0.2", r"line 21, \[\[column\]\] number 2: unknown key 'xmin': did you mean 'x_min'"),
    ("[[floor]]", "[[flor]]", r"line 29: unknown table or key 'flor': did you mean 'floor'"),
    ("spacing = 0.01", "spaceing = 0.01", r"line 2, \[config\]: unknown key 'spaceing': did you mean 'spacing'"),
    ("spacing = 0.01", 'spacing = "a"', r"\[config\]: gp_config.spacing = 'a': expected a number"),
    ("spacing = 0.01", "spacing = -1", r"gp_config.spacing = -1: expected a number from"),
    ('stress = "elastic"', 'stress = "elastc"', r"gp_config.stress = 'elastc': did you mean 'elastic'"),
    ("end = 0.03", "ends = 0.03", r"line 8, \[run\]: unknown key 'ends': did you mean 'end'"),
    ("end = 0.03", "end = -1", r"\[run\]: end = -1"),
    ("end = 0.03", "end = inf", r"\[run\]: end = inf, every = 0.01: expected finite numbers above 0"),
    ("every = 0.01", "every = inf", r"\[run\]: end = 0.03, every = inf: expected finite numbers above 0"),
    ("height = 0.05\nmaterial", "height = -0.05\nmaterial", r"line 15, \[\[column\]\] number 1: gp_column.height = -0.05"),
    ('material = "fine"', 'material = "fnie"', r"\[\[column\]\] number 1: material = 'fnie': did you mean 'fine'"),
    ("y = [0.005]", "y = [0.005, 1]", r"\[\[particles\]\] number 1: y has 2 values: expected 1"),
    ("[[wall]]\nx = 0", "[[wall]]", r"\[\[wall\]\] number 1: .*missing 1 required positional argument: 'x'"),
    ("[[wall]]", "[wall]", r"line 35: expected \[\[wall\]\] with two brackets"),
    ("[config]", "[[config]]", r"line 1: expected a table \[config\]"),
    ('material = "left"', 'material = "up"', r"\[\[gate\]\] number 1: material = 'up': expected 'left' or 'right'"),
    ("end = 0.03", "end = ", r"is not TOML: .*line 8"),
    ("[run]", "colour = 1\n[run]", r"line 7, \[config\]: unknown key 'colour'"),
])
def test_mistakes_are_told_with_line_table_and_nearest_key(right, wrong, message):
    assert right in TEXT
    with pytest.raises(granperi.SceneError, match=message) as caught:
        granperi.Scene.parse(TEXT.replace(right, wrong, 1), "s.toml").build()
    assert str(caught.value).startswith("s.toml") and isinstance(caught.value, ValueError)


def test_files_that_are_none(tmp_path):
    with pytest.raises(granperi.SceneError, match="nothing.toml: cannot be read: No such file"):
        granperi.Scene.read(tmp_path / "nothing.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(granperi.SceneError, match="is not UTF-8"):
        granperi.Scene.read(tmp_path / "bytes.toml")


# ------------------------------------------------------------------------------------------ the command line


@pytest.fixture
def scene_file(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(TEXT)
    return path


def test_info(python, scene_file, tmp_path):
    answer = python("-m", "granperi", "info")
    assert answer.returncode == 0 and f"granperi {granperi.__version__}" in answer.stdout and "hdf5" in answer.stdout
    answer = python("-m", "granperi", "info", str(scene_file))
    assert answer.returncode == 0 and "101 particles" in answer.stdout
    assert "update_neighbors" in answer.stdout and "side_wall_friction" in answer.stdout


@needs_hdf5
def test_run_plot_animate_compare(python, scene_file, tmp_path):
    def granperi_command(*arguments):
        answer = python("-m", "granperi", *arguments, cwd=tmp_path)
        assert answer.returncode == 0, answer.stderr
        return answer.stdout

    assert "time                      0.03 s" in granperi_command("run", "scene.toml", "--no-progress")
    granperi_command("run", "scene.toml", "--output", "finer.h5", "--spacing", "0.008", "--end", "0.02")
    granperi_command("plot", "scene.h5", "yielded", "--time", "0.01", "--output", "picture.png")
    assert (tmp_path / "picture.png").read_bytes()[:4] == b"\x89PNG"
    assert granperi_command("plot", "scene.h5").strip() == "scene_speed.png"
    granperi_command("animate", "scene.h5", "--output", "a.gif")
    assert (tmp_path / "a.gif").read_bytes()[:3] == b"GIF"
    assert "to the last bit" in granperi_command("compare", "scene.h5", "scene.h5")
    told = granperi_command("compare", "scene.h5", "finer.h5", "--time", "0.01", "0.02", "--picture", "c.png")
    assert "the files differ" in told and told.count("peak_height") == 2 and (tmp_path / "c.png").stat().st_size > 1000
    assert "4 frames from 0 to 0.03 s" in granperi_command("info", "scene.h5")
    assert "frames in" not in granperi_command("run", "scene.toml", "--output", "none")


@pytest.mark.parametrize("arguments, status, message", [
    (("run", "nothing.toml"), 2, "nothing.toml: cannot be read"),
    (("plot", "nothing.h5"), 1, "nothing.h5: there is no such file"),
    (("plot", "scene.toml"), 1, "scene.toml: is no HDF5 file"),
    (("run", "scene.toml", "--spacing", "-1"), 2, "--spacing -1: expected a number from 1e-09 to 1e+09"),
    (("run",), 2, "the following arguments are required: scene"),
    (("walk",), 2, "invalid choice: 'walk'"),
])
def test_mistakes_on_the_command_line(python, scene_file, tmp_path, arguments, status, message):
    answer = python("-m", "granperi", *arguments, cwd=tmp_path)
    assert answer.returncode == status and message in answer.stderr and "Traceback" not in answer.stderr


def test_help_of_every_command(python):
    for command in ([], ["run"], ["sweep"], ["plot"], ["animate"], ["history"], ["compare"], ["info"]):
        answer = python("-m", "granperi", *command, "--help")
        assert answer.returncode == 0 and "usage: python3 -m granperi" in answer.stdout
    assert "[[column]]" in python("-m", "granperi", "run", "--help").stdout
