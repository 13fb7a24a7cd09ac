"""Pictures and animations, of a live simulation and of a result file alike."""
import sys

import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import assert_same_state, needs_hdf5

import granperi
import granperi.plot as plot

pytestmark = needs_hdf5


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A collapse of two columns, in memory and in a file."""
    path = tmp_path_factory.mktemp("pictures") / "run.h5"
    with granperi.Simulation(spacing=0.008, threads=1) as sim:
        sim.add_column(x_min=-0.08, width=0.08, height=0.08)
        sim.add_column(x_min=0, width=0.08, height=0.08)
        sim.add_plate(granperi.Plate.floor(-0.6, 0.6))
        sim.add_plate(granperi.Plate.gate(0.08, 0.08, 0.1, "left", spacing=0.008))
        sim.record(path, 0.1, 0.02)
        yield sim, path
    plt.close("all")


@pytest.fixture(params=["simulation", "file"])
def source(run, request):
    return run[0] if request.param == "simulation" else run[1]


def saved(axes, tmp_path):
    path = tmp_path / "picture.png"
    axes.figure.savefig(path)
    plt.close(axes.figure)
    assert path.stat().st_size > 5000
    pixels = plt.imread(path)
    assert pixels[..., :3].std() > 0.02  # something is drawn
    return axes


@pytest.mark.parametrize("name", ["speed", "pressure", "inertial_number", "yielded", "sxy", "shear_rate", "column"])
def test_field_maps_have_real_units_and_a_bar(source, name, tmp_path):
    axes = saved(plot.field(source, name), tmp_path)
    assert axes.get_xlabel() == "x (m)" and axes.get_ylabel() == "y (m)" and axes.get_aspect() == 1
    discs, = axes.collections
    assert len(discs.get_offsets()) == 200 and np.allclose(discs._widths * 2, 0.008)
    labels = [other.get_ylabel() for other in axes.figure.axes if other is not axes]
    assert labels == ["" if name == "yielded" else plot.LABELS[name]]
    assert axes.get_title("left") == "t = 0.100 s"


def test_the_file_gives_what_the_simulation_gives(run):
    sim, path = run
    with granperi.Result(path) as result:
        live, kept = granperi._result.snapshot(sim), result[-1]
        for name in ("x", "speed", "yielded", "shear_stress", "inertial_number"):
            assert np.array_equal(live.field(name), kept.field(name)), name
        x = np.linspace(-0.2, 0.2, 41)
        assert kept.surface(x) == pytest.approx(live.surface(x), abs=1e-12)
        y = np.linspace(0, 0.08, 9)
        assert kept.interface(0, 1, y) == pytest.approx(live.interface(0, 1, y), abs=1e-12, nan_ok=True)
        assert kept.state.x_right == pytest.approx(live.state.x_right)
        assert kept.state.peak_height == pytest.approx(live.state.peak_height)
        for drawn, moved in zip(kept.plate_lines(), live.plate_lines(), strict=True):
            assert drawn == pytest.approx(moved)
        assert_same_state(result.history[-1], sim.history[-1])
        assert result.scene["materials"] == [dict(material) for material in sim.materials]
        assert result.scene["config"] == {name.rstrip("_"): value for name, value in sim.config}


def test_what_yields(run):
    """At rest far below the slope nothing yields; the moving surface does."""
    sim, _ = run
    yielded = granperi._result.snapshot(sim).field("yielded")
    speed = np.hypot(sim.vx, sim.vy)
    assert yielded.dtype == bool and yielded[speed > 0.2].mean() > 0.9 and not yielded.all()


def test_surface(source, tmp_path):
    axes = plot.surface(source)
    plot.surface(source, axes=axes, label="again")
    curves = [line for line in axes.lines if line.get_gid() != "plate"]
    assert len(curves) == 2 and np.nanmax(curves[0].get_ydata()) == pytest.approx(0.08, rel=0.1)
    saved(axes, tmp_path)


def test_surfaces_at_several_times_keep_their_size_and_have_plates_where_they_are(run, tmp_path):
    axes = plot.surface(run[1], time=[0, 0.02, 0.04, 0.06, 0.08, 0.1])
    alone = plot.surface(run[1], time=0.1)
    curves = [line for line in axes.lines if line.get_gid() != "plate"]
    assert len(curves) == 6 and [text.get_text() for text in axes.get_legend().get_texts()][::5] == ["t = 0 s", "t = 0.1 s"]
    plates = [line for line in axes.lines if line.get_gid() == "plate"]
    assert len(plates) == 2 + 5  # floor and gate at the end, the gate at each time before
    feet = sorted(line.get_ydata().min() for line in plates)
    assert feet[0] == 0 and feet[-1] > 0.05 and len(set(np.round(feet, 6))) == 6
    saved(alone, tmp_path)
    saved(axes, tmp_path)
    # Into the same axes: what grows makes the figure higher, and a metre stays as long.
    axes = plot.surface(run[1], time=0.1)
    axes.figure.canvas.draw()
    metre = np.diff(axes.transData.transform([(0, 0), (1, 0)])[:, 0])
    with granperi.Simulation(spacing=0.008) as tall:
        tall.add_column(x_min=-0.08, width=0.16, height=0.16)
        plot.surface(tall, axes=axes)
    axes.figure.canvas.draw()
    assert np.diff(axes.transData.transform([(0, 0), (1, 0)])[:, 0]) > 0.9 * metre
    saved(axes, tmp_path)


def test_legends_have_at_most_eight_entries(run):
    axes = plot.surface(run[1], time=np.repeat([0, 0.02, 0.04, 0.06, 0.08, 0.1], 3))
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert len(texts) == 8 and (texts[0], texts[-1]) == ("t = 0 s", "t = 0.1 s")
    with pytest.raises(granperi.ArgumentError, match="time: expected one time or several"):
        plot.surface(run[1], time=[])


def test_columns_are_categories(source):
    axes = plot.field(source, "column")
    bar = next(other for other in axes.figure.axes if other is not axes)
    assert list(bar.get_yticks()) == [0, 1]
    discs, = axes.collections
    assert len({tuple(colour) for colour in discs.to_rgba(discs.get_array())}) == 2


def test_a_closed_drum_is_seen_as_a_whole(tmp_path):
    angle = np.linspace(0, 2 * np.pi, 25)  # closed but for rounding
    with granperi.Simulation(spacing=0.01) as sim:
        sim.add_plate(points=0.1 * np.column_stack([np.cos(angle), np.sin(angle)])[::-1], omega=1.0)
        sim.add_column(x_min=-0.05, width=0.1, y_min=-0.08, height=0.04)
        axes = saved(plot.field(sim), tmp_path)
    assert axes.get_xlim()[0] < -0.1 and axes.get_xlim()[1] > 0.1 and axes.get_ylim()[1] > 0.1


def test_interface(source, tmp_path):
    axes = saved(plot.interface(source, 0, 1), tmp_path)
    drawn = next(line for line in axes.lines if str(line.get_label()).startswith("interface"))
    assert np.nanmin(np.abs(drawn.get_xdata())) < 0.01


def test_energy_adds_up(source, tmp_path):
    axes = saved(plot.energy(source), tmp_path)
    lines = {line.get_label(): line.get_ydata() for line in axes.lines}
    total = sum(values for name, values in lines.items() if name != "sum")
    assert total == pytest.approx(lines["sum"]) and "J" in axes.get_ylabel() and axes.get_xlabel() == "t (s)"


def test_fronts_are_a_time_distance_diagram(source, tmp_path):
    axes = saved(plot.fronts(source), tmp_path)
    assert axes.get_xlabel() == "x (m)" and axes.get_ylabel() == "t (s)"
    left, right = (line for line in axes.lines if line.get_color() == "#0072b2")
    assert right.get_xdata()[-1] > right.get_xdata()[0] == pytest.approx(0.072)
    assert right.get_ydata() == pytest.approx([0, 0.02, 0.04, 0.06, 0.08, 0.1], abs=5e-4)
    past = granperi._result.history(source)
    assert np.array_equal(left.get_xdata(), past.x_q05) and np.array_equal(right.get_xdata(), past.x_q95)


def test_compare(run, tmp_path):
    saved(plot.compare(run[0], run[1]), tmp_path)
    rows = {row.name: row for row in granperi.compare(run[0], run[1])}
    assert rows["particles_apart_max"].second == 0 and rows["peak_height"].difference == pytest.approx(0, abs=1e-12)
    early, late = granperi.compare(run[1], run[1], [0.02])[0], granperi.compare(run[0], run[1])[0]
    assert early.time == pytest.approx(0.02, abs=5e-4) and late.time == 0.1


def test_compare_tells_the_centre_of_mass(tmp_path):
    """Of a light and a heavy half beside each other, of which the middle of the particles knows nothing."""
    with granperi.Simulation(spacing=0.01, threads=1) as sim:
        heavy = sim.add_material(grain_density=10000.0)
        sim.add_plate(granperi.Plate.floor(-0.5, 0.5))
        sim.add_column(x_min=0, width=0.05, height=0.05)
        sim.add_column(x_min=0.05, width=0.05, height=0.05, material=heavy)
        sim.record(tmp_path / "halves.h5", 0.002, 0.001)
        rows = {row.name: row for row in granperi.compare(tmp_path / "halves.h5", sim)}
        assert rows["centre_x"].first == pytest.approx((0.025 * 2500 + 0.075 * 10000) / 12500, abs=1e-4)
        assert rows["centre_x"].second == sim.state.centre_x and rows["centre_y"].second == sim.state.centre_y


def test_a_result_without_particles_has_a_surface(tmp_path):
    """As the simulation that wrote it: nothing lies there."""
    with granperi.Simulation(spacing=0.01, threads=1) as sim, pytest.warns(granperi.GranperiWarning, match="no material"):
        sim.add_plate(granperi.Plate.floor(-0.5, 0.5))
        sim.record(tmp_path / "empty.h5", 0.002, 0.001)
        with granperi.Result(tmp_path / "empty.h5") as result:
            for source in (granperi._result.snapshot(sim), result[-1]):
                assert list(source.surface([0.0, 0.1])) == [0, 0]
                with pytest.raises(granperi.ArgumentError, match="left = 0"):
                    source.interface(0, 1, [0.0])


def test_gif(source, tmp_path):
    if isinstance(source, granperi.Simulation):
        with granperi.Simulation(spacing=0.02, threads=1) as sim:
            sim.add_column(width=0.1, height=0.1)
            plot.animate(sim, tmp_path / "a.gif", "pressure", t_end=0.03)
    else:
        plot.animate(source, tmp_path / "a.gif", fps=10)
    from PIL import Image

    with Image.open(tmp_path / "a.gif") as picture:
        assert picture.n_frames >= 4 and picture.size[0] > 500


def test_without_ffmpeg_it_says_so(run, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(granperi.ArgumentError, match="ffmpeg, which is not installed.*gif"):
        plot.animate(run[1], tmp_path / "a.mp4")
    with pytest.raises(granperi.ArgumentError, match="ends in .mp4 .* or .gif"):
        plot.animate(run[1], tmp_path / "a.avi")


def test_mp4(run, tmp_path):
    import shutil

    if shutil.which("ffmpeg") is None:
        pytest.skip("ffmpeg is not installed")
    plot.animate(run[1], tmp_path / "a.mp4")
    assert b"ftyp" in (tmp_path / "a.mp4").read_bytes()[:16]


def test_mistakes(run, make_block, tmp_path):
    sim, path = run
    with pytest.raises(granperi.ArgumentError, match="did you mean 'speed'"):
        plot.field(path, "sped")
    with pytest.raises(granperi.ArgumentError, match="has frames from 0 to 0.1 s"):
        plot.field(path, "speed", time=3)
    with pytest.raises(granperi.ArgumentError, match="only a result file"):
        plot.field(sim, "speed", time=0.01)
    with pytest.raises(granperi.ArgumentError, match="expected a Simulation, a Result"):
        plot.field(3)
    with make_block() as other, pytest.raises(granperi.ArgumentError, match="sim.frames"):
        plot.energy(other)
    with granperi.Result(path) as result:
        with pytest.raises(granperi.ArgumentError, match="no field 'viscosity'"):
            result[0].field("viscosity")
        with pytest.raises(IndexError, match="has 6 frames"):
            result[6]
        assert len(list(result)) == 6 and result.at(0.05).time == pytest.approx(0.05, abs=0.011)
    with pytest.raises(granperi.StateError, match="closed"):
        result[0].x


def test_without_matplotlib_the_package_works_and_pictures_say_what_is_missing(python):
    answer = python("""
import sys
sys.modules["matplotlib"] = None
import granperi
granperi.Simulation().close()
try:
    import granperi.plot
except ImportError as error:
    print(error)
""")
    assert answer.returncode == 0 and "python3-matplotlib" in answer.stdout, answer.stderr


def test_without_h5py_files_are_written_and_reading_says_what_is_missing(python, tmp_path):
    answer = python("""
import sys
sys.modules["h5py"] = None
import granperi
with granperi.Simulation() as sim:
    sim.add_column(width=0.1, height=0.1)
    with sim.output(sys.argv[1] if len(sys.argv) > 1 else "a.h5") as output:
        output.write()
try:
    granperi.Result("a.h5")
except ImportError as error:
    print(error)
""", cwd=tmp_path)
    assert answer.returncode == 0 and "python3-h5py" in answer.stdout, answer.stderr
    assert (tmp_path / "a.h5").exists()


def test_progress_bar(sim, capsys):
    pytest.importorskip("tqdm")
    sim.run(0.02, progress=True)
    assert "0.020/0.02 s" in capsys.readouterr().err
    for _ in sim.frames(0.03, 0.005, progress=True):
        pass
    assert "100 %" in capsys.readouterr().err


def test_without_tqdm_the_bar_says_what_is_missing(sim, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ImportError, match="python3-tqdm"):
        sim.run(0.01, progress=True)
    assert sim.run(0.01)
