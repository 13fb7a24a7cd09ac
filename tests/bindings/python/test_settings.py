"""Recommended settings: what they choose, and that what they say of errors is so."""
import json
import math

import numpy as np
import pytest
from conftest import ROOT

import granperi

NAMES = ["draft", "standard", "fine"]
TEXT = """\
[config]
spacing = 0.01
horizon = 5
gravity_y = -1.6

[[column]]
width = 0.2
height = 0.08

[[column]]
x_min = 0.3
width = 0.04
height = 0.32

[[floor]]
x_left = -1
x_right = 1
"""


def test_the_smallest_side_of_the_columns_is_resolved():
    scene = granperi.Scene.parse(TEXT)
    for name in NAMES:
        chosen = granperi.settings(name, scene)
        assert chosen == granperi.settings(name, 0.04)
        assert chosen.name == name and chosen.length == 0.04 and chosen.sleep == 1
        across = chosen.length / chosen.spacing
        assert across == pytest.approx(round(across))  # a whole number: nothing is rounded
        assert f"{chosen.spacing:.4g} m" in str(chosen) and "another scene errs otherwise" in str(chosen)


def test_finer_settings_cost_more_and_err_less():
    levels = [granperi.settings(name, 1.0) for name in NAMES]
    for coarse, fine in zip(levels, levels[1:]):
        assert coarse.spacing > fine.spacing and coarse.cpu_seconds < fine.cpu_seconds
        assert coarse.aim > fine.aim and coarse.peak_error > fine.peak_error and coarse.runout_error > fine.runout_error
    # Of the column with a = 1.25, and of the worst of three columns.
    measured = json.loads((ROOT / "bench" / "performance" / "aims.json").read_text())["levels"]
    for name, level in zip(NAMES, levels):
        assert level.aim >= max(measured[name]["peak_error_a125"], measured[name]["runout_error_a125"])
        assert level.aim >= max(level.peak_error, level.runout_error)


def test_other_parameters_stay_what_they_are(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(TEXT)
    scene = granperi.Scene.read(path)
    chosen = granperi.settings("draft", str(path))
    assert chosen == granperi.settings("draft", path)
    scene.config = chosen.config(scene.config)
    assert scene.config.gravity_y == -1.6 and scene.config.horizon == chosen.horizon
    assert chosen.config() == granperi.Config(**chosen.values)
    with scene.build() as sim:
        assert sim.config.spacing == chosen.spacing and sim.config.sleep == 1


@pytest.mark.parametrize("name, of, message", [
    ("drafts", 0.1, "name = 'drafts': did you mean 'draft'. Valid: draft, standard, fine"),
    (3, 0.1, "name = 3: expected one of draft, standard, fine"),
    ("draft", 0.0, "of = 0: expected a finite length above 0 m, or a scene"),
    ("draft", -0.1, "of = -0.1: expected a finite length"),
    ("draft", math.nan, "of = nan: expected a finite length"),
    ("draft", math.inf, "of = inf: expected a finite length"),
    ("draft", None, "of = None: expected a Scene, the path of a scene file, or a length in m"),
    ("draft", "nothing.toml", "nothing.toml: cannot be read"),
    ("draft", granperi.Scene(name="empty"), "empty: has no column whose sides could be resolved"),
])
def test_mistakes_are_told(name, of, message):
    with pytest.raises(granperi.ArgumentError, match=message):
        granperi.settings(name, of)


def test_what_they_are_for_is_asked_for():
    with pytest.raises(granperi.ArgumentError, match="of = None: expected a Scene, the path of a scene file, or a length in m"):
        granperi.settings("draft")


def test_scenes_whose_spacing_is_not_free():
    scene = granperi.Scene.parse(TEXT)
    scene.add("particles", x=[0.0], y=[1.0])
    with pytest.raises(granperi.ArgumentError, match="particles given one by one, whose spacing is theirs"):
        granperi.settings("draft", scene)
    scene = granperi.Scene.parse(TEXT.replace("height = 0.32", "height = -0.3"))
    with pytest.raises(granperi.SceneError, match=r"line 10, \[\[column\]\] number 2: gp_column.height = -0.3: expected a finite"):
        granperi.settings("draft", scene)


def test_all_places_say_the_same(python):
    """The guide, docs/settings.md and granperi.settings have their figures from one file."""
    checked = python(str(ROOT / "bench" / "performance" / "aims.py"), "--check")
    assert checked.returncode == 0, checked.stdout + checked.stderr


@pytest.mark.parametrize("name, runs", [("draft", 8), ("fine", 6)])
def test_errors_are_below_the_aim(name, runs):
    """The column with a = 1.25 against the finest run, L/dl = 128: means of so many runs are some four standard errors below."""
    chosen = granperi.settings(name, 0.05)
    peaks, runouts = [], []
    for seed in range(1, runs + 1):
        with granperi.Simulation(chosen.config(), jitter=0.01, seed=seed) as sim:
            beads = sim.add_material(grain_diameter=0.002)
            sim.add_column(x_min=-0.04, width=0.08, height=0.05, material=beads)
            sim.add_plate(granperi.Plate.floor(-0.3, 0.3))
            sim.run(1)
            peaks.append(sim.state.peak_height / 0.08)
            runouts.append((sim.state.x_q95 - sim.state.x_q05) / 0.08 - 1)  # of 160 grains; .02 between one and the next
    assert abs(np.mean(peaks) / 0.4229 - 1) < chosen.aim
    assert abs(np.mean(runouts) / 1.085 - 1) < chosen.aim
