"""Runs of scenes into files: frames do not change them, nothing is lost, an interruption leaves no trace."""
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import frames_in, needs_hdf5

import granperi

TEXT = """\
[config]
spacing = 0.005
[run]
end = 0.2
every = 0.0123
output = "run.h5"
[[column]]
x_min = -0.04
width = 0.08
height = 0.05
[[floor]]
x_left = -0.3
x_right = 0.3
[[probe]]
points = [[0.0, 0.01], [0.0, 0.2]]
plates = [0]
every = 0.003
output = "probe.csv"
"""


def collapse():
    return granperi.Scene.parse(TEXT).build()


@pytest.fixture
def scene(tmp_path):
    """Its run takes a fifth of a second; run.output is in tmp_path."""
    scene = granperi.Scene.parse(TEXT)
    scene.run.output = str(tmp_path / "run.h5")
    return scene


def everything(directory):
    """All files, by name."""
    return {path.name: path.read_bytes() for path in directory.iterdir()}


def same_frames(one, other):
    with granperi.Result(one) as first, granperi.Result(other) as second:
        return np.array_equal(first.times, second.times) and all(
            np.array_equal(a.field(name), b.field(name)) for a, b in zip(first, second) for name in first.fields)


# -------------------------------------------------------------------------------------------------- frames


@needs_hdf5
def test_frames_do_not_change_the_run(tmp_path):
    """Python's frames and records, the library's own output, and no frames at all: the same bits, and the same frame times."""
    with collapse() as plain, collapse() as looked_at, collapse() as recorded, collapse() as by_the_library:
        plain.run(0.15)
        times = [state.time for state in looked_at.frames(0.15, 0.0123)]
        recorded.add_probe(points=[[0, 0.01]], every=0.0007)
        recorded.record(tmp_path / "a.h5", 0.15, 0.0123)
        with by_the_library.output(tmp_path / "b.h5", every=0.0123):
            by_the_library.run(0.15)
        for sim in (looked_at, recorded, by_the_library):
            assert sim.clock == plain.clock and np.array_equal(sim.x, plain.x) and np.array_equal(sim.sxy, plain.sxy)
    with granperi.Result(tmp_path / "a.h5") as a, granperi.Result(tmp_path / "b.h5") as b:
        assert list(a.times) == times and list(a.times[:-1]) == list(b.times)  # and one at the end, which is no multiple


def test_a_callback_that_stops_the_run_at_a_frame_ends_the_frames(make_block):
    with make_block() as sim:
        sim.set_callback(lambda sim: sim.clock.step == 25)
        times = [state.step for state in sim.frames(1.0, 0.001)]
        assert times[-1] == 25 and sim.clock.step == 25


def test_until_rest(make_block):
    with collapse() as sim, collapse() as same:
        assert sim.run_until_rest(2.0) and sim.state.at_rest and 0.2 < sim.time < 1
        assert list(same.frames(2.0, 0.1, until_rest=True))[-1].time == sim.time
        assert np.array_equal(same.x, sim.x)
    with collapse() as sim:
        assert not sim.run_until_rest(0.1) and sim.time == 0.1
        sim.set_callback(lambda sim: True)
        assert not sim.run_until_rest(0.2) and sim.time < 0.11
        with pytest.raises(granperi.ArgumentError, match="t_max = 0.05: expected a finite time not before the clock's"):
            sim.run_until_rest(0.05)


# ------------------------------------------------------------------------------------------------ nothing lost


@needs_hdf5
def test_a_run_leaves_result_checkpoint_and_probes(scene, tmp_path):
    history = scene.record()
    assert sorted(everything(tmp_path)) == ["probe.csv", "run.gpc", "run.h5", "run.xdmf"]
    with granperi.Result(tmp_path / "run.h5") as result, granperi.load(tmp_path / "run.gpc") as sim:
        assert len(result) == len(history) == 18 and sim.time == history[-1].time == 0.2
        assert np.array_equal(result[-1].x, sim.x)


@needs_hdf5
@pytest.mark.parametrize("how", ["again", "without a checkpoint", "a part"])
def test_what_exists_is_not_touched_unless_one_says_so(scene, tmp_path, how):
    if how == "a part":
        (tmp_path / "run.part").mkdir()
        (tmp_path / "run.part" / "run.gpc").write_bytes(b"precious")
        with pytest.raises(granperi.FileError, match=r"run.part has a run that was interrupted: .*--resume.*--overwrite"):
            scene.record()
        assert (tmp_path / "run.part" / "run.gpc").read_bytes() == b"precious"
    else:
        (tmp_path / "run.h5").write_bytes(b"precious")
        before = everything(tmp_path)
        if how == "again":
            with pytest.raises(granperi.FileError, match=r"run.h5 exists: name another output; .*--resume.*--overwrite"):
                scene.record()
        else:
            with pytest.raises(granperi.FileError, match="run.gpc is not there"):
                scene.record(resume=True)
        assert everything(tmp_path) == before
    scene.record(overwrite=True)
    assert sorted(everything(tmp_path)) == ["probe.csv", "run.gpc", "run.h5", "run.xdmf"]


@needs_hdf5
@pytest.mark.parametrize("wrong", [("config.spacing", -1), ("column.width", 0), ("run.fields", ["colour"]), ("probe.plates", [7]),
                                   ("probe.output", "a/b.csv"), ("floor.x_left", "far")])
def test_a_mistake_in_the_scene_is_found_before_a_file_is_touched(scene, tmp_path, wrong):
    scene.record()
    before = everything(tmp_path)
    with pytest.raises(granperi.ArgumentError):
        scene.set(*wrong)
        scene.record(overwrite=True)
    assert everything(tmp_path) == before


@needs_hdf5
def test_a_run_that_fails_leaves_the_result_that_was_there(scene, tmp_path):
    scene.record()
    before = everything(tmp_path)
    with granperi.Scene.parse(TEXT).build() as sim:
        sim.run(0.03)
        dt = sim.clock.dt
    for key, value in (("time_step", 20 * dt), ("sound_speed", 10), ("allow_unstable_step", 1)):
        scene.set("config." + key, value)
    with pytest.raises(granperi.Error), pytest.warns(granperi.GranperiWarning):
        scene.record(overwrite=True)
    after = {name: content for name, content in ((p.name, p.read_bytes()) for p in tmp_path.iterdir() if p.is_file())}
    assert after == before


@needs_hdf5
def test_one_process_at_a_time_runs_into_a_place(scene):
    def second(sim):
        other = granperi.Scene.parse(TEXT)
        other.run.output = scene.run.output
        with pytest.raises(granperi.StateError, match="another process runs into"):
            other.record(overwrite=True)
        seen.append(sim.clock.step)

    seen = []
    build = scene.build

    def built():
        sim = build()
        sim.set_callback(second, every=100)
        return sim

    scene.build = built
    scene.record()
    assert seen


# ---------------------------------------------------------------------------------------------------- resume


@needs_hdf5
def test_a_run_that_was_interrupted_anywhere_goes_on_with_the_same_bits(tmp_path):
    whole = granperi.Scene.parse(TEXT)
    whole.record(tmp_path / "whole.h5")
    probe = (tmp_path / "probe.csv").read_bytes()

    class Stop(Exception):
        pass

    scene = granperi.Scene.parse(TEXT)
    build = scene.build
    for stop in (1, 37, 200, 201, 400):  # steps, of some 600

        def built():
            sim = build()

            def interrupt(sim):
                raise Stop

            sim.set_callback(interrupt, every=stop)
            return sim

        directory = tmp_path / str(stop)
        directory.mkdir()
        scene.build = built
        with pytest.raises(Stop):
            scene.record(directory / "run.h5")
        assert not (directory / "run.h5").exists()
        scene.build = build
        history = scene.record(directory / "run.h5", resume=True)
        assert same_frames(tmp_path / "whole.h5", directory / "run.h5") and (directory / "probe.csv").read_bytes() == probe
        assert len(history) == 18 and not (directory / "run.part").exists()


@needs_hdf5
def test_killed_processes_lose_no_more_than_since_the_last_checkpoint(tmp_path):
    text = TEXT.replace("end = 0.2", "end = 0.5")
    granperi.Scene.parse(text).record(tmp_path / "whole.h5")
    program = """
import granperi, sys
scene = granperi.Scene.parse(sys.stdin.read())
scene.record("run.h5", resume=True, checkpoint=0.02)
"""
    for k in range(40):
        process = subprocess.Popen([sys.executable, "-c", program], cwd=tmp_path, stdin=subprocess.PIPE, text=True)
        process.stdin.write(text)
        process.stdin.close()
        part = tmp_path / "run.part"
        before = (part / "run.gpc").read_bytes() if (part / "run.gpc").exists() else b""
        while process.poll() is None:  # until it has come further
            if (part / "run.gpc").exists() and (part / "run.gpc").read_bytes() != before and k < 5:
                process.kill()
            time.sleep(0.005)
        if process.returncode == 0:
            break
        assert process.returncode == -signal.SIGKILL
    assert k > 0 and same_frames(tmp_path / "whole.h5", tmp_path / "run.h5")


@needs_hdf5
@pytest.mark.parametrize("number, status", [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_signals_save_and_end(tmp_path, number, status):
    (tmp_path / "s.toml").write_text(TEXT.replace("end = 0.2", "end = 100"))
    command = [sys.executable, "-m", "granperi", "run", "s.toml"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    while process.poll() is None and frames_in(tmp_path / "run.part" / "run.h5") < 2:
        time.sleep(0.01)
    process.send_signal(number)
    told = process.communicate(timeout=60)[1]
    assert process.returncode == status and "with --resume goes on" in told and "Traceback" not in told
    assert not (tmp_path / "run.h5").exists() and (tmp_path / "run.part" / "run.gpc").exists()
    with granperi.load(tmp_path / "run.part" / "run.gpc") as sim:
        end = sim.time + 0.01
    answer = subprocess.run([*command, "--resume", "--end", str(end)], cwd=tmp_path, capture_output=True, text=True)
    assert answer.returncode == 0, answer.stderr
    with granperi.Result(tmp_path / "run.h5") as result:
        assert result.times[-1] == end


@needs_hdf5
def test_resume_of_what_is_complete(scene, tmp_path):
    scene.record()
    before = everything(tmp_path)
    assert len(scene.record(resume=True)) == 18 and everything(tmp_path) == before
    scene.run.end = 0.25
    history = scene.record(resume=True)
    assert history[-1].time == 0.25 and np.all(np.diff(history.time) > 0)
    series = np.genfromtxt(tmp_path / "probe.csv", delimiter=",", names=True)
    assert np.all(np.diff(series["time"]) > 0) and series["time"][-1] == pytest.approx(0.25, abs=0.003)


@needs_hdf5
@pytest.mark.parametrize("moved", [1, 2, 3])
def test_an_interruption_while_the_files_are_put_in_their_place(scene, tmp_path, moved):
    scene.record()
    before = everything(tmp_path)
    part = tmp_path / "run.part"
    part.mkdir()
    for name in ("run.h5", "run.xdmf", "run.gpc", "probe.csv")[moved:]:
        os.replace(tmp_path / name, part / name)
    scene.record(resume=True)
    assert everything(tmp_path) == before
    part.mkdir()
    os.replace(tmp_path / "run.gpc", part / "run.gpc")
    scene.run.end = 0.21
    assert scene.record(resume=True)[-1].time == 0.21 and not part.exists()


@needs_hdf5
def test_an_interrupted_copy_of_a_complete_run_is_none(scene, tmp_path):
    scene.record()
    (tmp_path / "run.part").mkdir()
    for name in ("run.gpc.new", "run.h5.new"):
        (tmp_path / "run.part" / name).write_bytes(b"half of it")
    scene.run.end = 0.22
    assert scene.record(resume=True)[-1].time == 0.22


@needs_hdf5
@pytest.mark.parametrize("key, value, message", [
    ("config.spacing", 0.004, "config differs; spacing = 0.005 there, 0.004 here"),
    ("column.height", 0.06, "columns differ"), ("floor.friction", "free_slip", "plates differ")])
def test_another_scene_is_not_gone_on_with(scene, tmp_path, key, value, message):
    scene.record()
    before = everything(tmp_path)
    scene.set(key, value)
    with pytest.raises(granperi.ArgumentError, match="run.h5 cannot be resumed: it is of another scene, whose " + message):
        scene.record(resume=True)
    assert everything(tmp_path) == before
    scene.set("config.threads", 2)  # which changes no result


@needs_hdf5
def test_until_rest_from_a_scene_file(tmp_path):
    (tmp_path / "s.toml").write_text(TEXT.replace("end = 0.2", 'end = 2\nuntil = "rest"'))
    command = [sys.executable, "-m", "granperi", "run", "s.toml"]
    answer = subprocess.run([*command, "--csv", "states.csv"], cwd=tmp_path, capture_output=True, text=True)
    assert answer.returncode == 0, answer.stderr
    states = np.genfromtxt(tmp_path / "states.csv", delimiter=",", names=True)
    assert states["at_rest"][-1] == 1 and states["time"][-1] < 1
    before = everything(tmp_path)
    answer = subprocess.run([*command, "--resume"], cwd=tmp_path, capture_output=True, text=True)
    assert answer.returncode == 0 and everything(tmp_path) == before
    answer = subprocess.run([*command, "--overwrite", "--end", "0.05"], cwd=tmp_path, capture_output=True, text=True)
    assert "still moves at the end, 0.05 s" in answer.stderr
