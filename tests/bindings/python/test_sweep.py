"""Sweeps: a scene per point, runs beside each other, what is missing, one table; and scenes that are written."""
import json
import os
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import frames_in, needs_hdf5
from test_scene import TEXT

import granperi

pytestmark = needs_hdf5

SCENE = """\
[config]
spacing = 0.01
[run]
end = 0.05
[[material]]
name = "beads"
[[column]]
width = 0.1
height = 0.05
material = "beads"
[[floor]]
x_left = -0.5
x_right = 0.5
"""


@pytest.fixture
def scene():
    return granperi.Scene.parse(SCENE)


def test_a_written_scene_is_the_same_scene(tmp_path):
    scene = granperi.Scene.parse(TEXT)
    scene.run.until, scene.run.fields = "rest", ["velocity", "pressure"]
    scene.write(tmp_path / "s.toml")
    again = granperi.Scene.read(tmp_path / "s.toml")
    assert again.config == scene.config and again.run == scene.run and again.text() == scene.text()
    with scene.build() as one, again.build() as other:
        assert one.plates == other.plates and one.materials == other.materials
        one.run(0.02)
        other.run(0.02)
        assert np.array_equal(one.x, other.x)


def test_what_a_scene_by_keyword_writes(tmp_path):
    scene = granperi.Scene(granperi.Config("paper", spacing=0.01, nonlocal_=1))
    scene.add("particles", x=np.array([0.1, 0.2]), y=[0.1, np.float64(0.2)], material=np.int64(0))
    scene.add("plate", x0=-1, friction=granperi.Wall.COULOMB, wall_mu=0.25)
    scene.add("wall_line", points=np.array([[0, 0], [1, 0.5]]), closed=False)
    scene.add("material", name='a "name"\n\u00e9')
    scene.write(tmp_path / "s.toml")
    again = granperi.Scene.read(tmp_path / "s.toml")
    assert again.config == scene.config
    with scene.build() as one, again.build() as other:
        assert one.plates == other.plates and np.array_equal(one.x, other.x)
    scene.add("probe", points=object())
    with pytest.raises(granperi.ArgumentTypeError, match="cannot be written to a scene file"):
        scene.write(tmp_path / "t.toml")
    assert not (tmp_path / "t.toml").exists()


def test_values_by_key(scene):
    scene.set("config.nonlocal", 1)
    scene.set("config.stress", "implicit")
    scene.set("run.until", "rest")
    scene.set("column.height", 0.06)
    scene.set("material.beads.mu_s", 0.5)
    assert scene.config.nonlocal_ == 1 and scene.run.until == "rest"
    with scene.build() as sim:
        assert len(sim) == 60 and sim.materials[1].mu_s == 0.5


def test_a_sweep_is_the_runs_one_by_one(scene, tmp_path):
    table = granperi.sweep(scene, {"config.spacing": [0.01, 0.005], "material.beads.mu_s": [0.3, 0.6]}, tmp_path / "s", workers=2)
    assert len(table) == 4 and not table.failed and table.parameters == ["config.spacing", "material.beads.mu_s"]
    for row in table:
        one = granperi.Scene.parse(SCENE)
        one.set("config.spacing", row["config.spacing"])
        one.set("material.beads.mu_s", row["material.beads.mu_s"])
        last = one.record()[-1]
        assert all(row[name] == getattr(last, name) for name in ("time", "kinetic", "x_q95", "peak_height"))
    csv = np.genfromtxt(tmp_path / "s" / "sweep.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    assert list(csv["x_q95"]) == list(table["x_q95"]) and list(csv["status"]) == ["complete"] * 4
    assert "<td>complete</td>" in table._repr_html_() and "spacing=0.005_mu_s=0.3" in csv["point"]


def test_what_is_complete_stays_and_what_is_missing_is_run(scene, tmp_path):
    directory = tmp_path / "s"
    granperi.sweep(scene, {"config.seed": [1]}, directory)
    first = (directory / "seed=1.h5").stat().st_mtime_ns
    table = granperi.sweep(scene, [{"config.seed": 1}, {"config.seed": 2}], directory)
    assert (directory / "seed=1.h5").stat().st_mtime_ns == first and table["status"].tolist() == ["complete"] * 2
    scene.run.end = 0.06
    with pytest.raises(granperi.FileError, match=r"seed=1.toml is another scene: name another directory, or say overwrite=True"):
        granperi.sweep(scene, {"config.seed": [1, 2]}, directory)
    assert (directory / "seed=1.h5").stat().st_mtime_ns == first
    table = granperi.sweep(scene, {"config.seed": [1, 2]}, directory, overwrite=True)
    assert table["time"].tolist() == [0.06, 0.06]


def test_a_run_that_fails_is_told_and_the_others_go_on(scene, tmp_path):
    scene.config = scene.config.replace(sound_speed=10.0, allow_unstable_step=1)
    table = granperi.sweep(scene, {"config.time_step": [1e-4, 0.02]}, tmp_path / "s")
    assert table["status"][0] == "complete" and len(table.failed) == 1 and np.isnan(table["peak_height"][1])
    assert "step" in table["status"][1] and (tmp_path / "s" / "time_step=0.02.log").read_text()


def test_a_result_that_cannot_be_read_does_not_hide_the_others(scene, tmp_path):
    """As a full disk or a copy that broke off leaves it; or a run that ended before its first frame."""
    table = granperi.sweep(scene, {"config.seed": [1, 2, 3]}, tmp_path / "s")
    cut, no_frames = tmp_path / "s" / "seed=1.h5", tmp_path / "s" / "seed=3.h5"
    cut.write_bytes(cut.read_bytes()[:5000])
    with scene.build() as sim, sim.output(tmp_path / "none.h5"):
        shutil.copy(tmp_path / "none.h5", no_frames)
    again = granperi.sweep(scene, {"config.seed": [1, 2, 3]}, tmp_path / "s")
    assert again.rows[1] == table.rows[1] and np.isnan(again["peak_height"][[0, 2]]).all()
    assert "seed=1.h5: cannot be read" in again["status"][0] and "seed=3.h5 has no frames" in again["status"][2]
    for row in again.failed:
        assert row["status"].endswith("delete it to run the point anew")
    cut.unlink()
    assert granperi.sweep(scene, {"config.seed": [1, 2, 3]}, tmp_path / "s").rows[0] == table.rows[0]


def test_points_that_another_program_runs(scene, tmp_path):
    """As GNU parallel and arrays of jobs do it: one line of points.txt each."""
    scene.write(tmp_path / "s.toml")
    command = [sys.executable, "-m", "granperi"]
    options = dict(cwd=tmp_path, check=True, capture_output=True, text=True)
    subprocess.run([*command, "sweep", "s.toml", "--set", "config.seed=1,2", "--set", "run.end=0.02", "--prepare"], **options)
    lines = (tmp_path / "sweep" / "points.txt").read_text().split()
    assert lines == ["seed=1_end=0.02.toml", "seed=2_end=0.02.toml"]
    subprocess.run([*command, "run", lines[1], "--resume"], **{**options, "cwd": tmp_path / "sweep"})
    told = subprocess.run([*command, "sweep", "--collect"], **options).stdout
    assert "missing" in told and "complete" in told
    with open(tmp_path / "sweep" / "sweep.json") as file:
        assert json.load(file)["points"][0] == {"point": "seed=1_end=0.02", "values": {"config.seed": 1, "run.end": 0.02}}


def test_an_interrupted_sweep_goes_on(scene, tmp_path):
    scene.run.end = 30.0
    scene.write(tmp_path / "s.toml")
    command = [sys.executable, "-m", "granperi", "sweep", "s.toml", "--set", "config.seed=1,2,3", "--workers", "2"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    parts = [tmp_path / "sweep" / f"seed={k}.part" / f"seed={k}.h5" for k in (1, 2)]
    while process.poll() is None and not all(frames_in(part) > 1 for part in parts):
        time.sleep(0.01)
    process.send_signal(signal.SIGTERM)
    told = process.communicate(timeout=60)[1]
    assert process.returncode == 143 and "the same command goes on" in told, told
    assert all(part.with_suffix(".gpc").exists() for part in parts) and not (tmp_path / "sweep" / "seed=3.part").exists()
    assert not [line for line in os.popen("ps -e -o args") if str(tmp_path) in line]


def test_probes_of_points_have_files_of_their_own(scene, tmp_path):
    scene.add("probe", plates=[0], every=0.01, output="load.csv")
    scene.add("probe", plates=[0], every=0.02)
    granperi.sweep(scene, {"config.seed": [1, 2]}, tmp_path / "s")
    files = sorted(path.name for path in (tmp_path / "s").glob("*.csv"))
    assert files == ["seed=1_load.csv", "seed=1_probe2.csv", "seed=2_load.csv", "seed=2_probe2.csv", "sweep.csv"]
    with pytest.raises(granperi.ArgumentError, match="'run.output': a sweep names the files of its points itself"):
        granperi.sweep(scene, {"run.output": ["a.h5"]}, tmp_path / "t")


def test_names_of_points_are_names_of_files(scene, tmp_path):
    names = granperi._sweep.prepare(scene, {"floor.friction": ["no_slip", "free_slip"], "config.spacing": [0.01, 1 / 300]},
                                    tmp_path / "s")
    assert len(set(names)) == 4 and names[0] == "friction=no_slip_spacing=0.01"
    points = [{"run.fields": ["velocity", name]} for name in ("pressure", "stress")]
    names = granperi._sweep.prepare(scene, points, tmp_path / "t")
    assert len(set(names)) == 2 and all(set(name) <= set("abcdefghijklmnopqrstuvwxyz0123456789=-_.") for name in names)
