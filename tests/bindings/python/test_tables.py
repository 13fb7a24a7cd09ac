"""Tables and shapes of other programs: CSV, HTML, NumPy's masks, MDAnalysis; fields that follow from others; plans."""
import html.parser
import math
import sys
import types
import warnings

import numpy as np
import pytest
from conftest import block, needs_hdf5

import granperi


def read(path):
    return np.genfromtxt(path, delimiter=",", names=True)


def test_history_to_csv(sim, tmp_path):
    for _ in sim.frames(0.03, 0.01):
        pass
    sim.history.to_csv(tmp_path / "h.csv")
    table = read(tmp_path / "h.csv")
    for name in granperi.State.__annotations__:
        assert np.array_equal(table[name], sim.history.__getattr__(name).astype(float), equal_nan=True), name
    with pytest.raises(granperi.FileError, match="h.csv exists"):
        sim.history.to_csv(tmp_path / "h.csv")
    sim.history.to_csv(tmp_path / "h.csv", overwrite=True)
    with pytest.raises(granperi.FileError, match="no/h.csv: cannot be written: No such file or directory"):
        sim.history.to_csv(tmp_path / "no" / "h.csv")


@needs_hdf5
def test_history_of_a_file_on_the_command_line(sim, tmp_path, capsys):
    from granperi import __main__

    sim.record(tmp_path / "r.h5", 0.02, 0.01)
    assert __main__.main(["history", str(tmp_path / "r.h5"), "--output", str(tmp_path / "h.csv")]) == 0
    table = read(tmp_path / "h.csv")
    assert list(table["time"]) == list(sim.history.time) and np.isnan(table["wall_seconds"]).all()


# -------------------------------------------------------------------------------------------------- fields


def test_speed_is_a_field(sim):
    sim.run(0.02)
    speed = np.hypot(sim.vx, sim.vy)
    assert speed.max() > 0
    particles = sim.particles("speed", "velocity")
    for values in (sim.speed, sim.field("speed"), particles.speed, particles["speed"]):
        assert np.array_equal(values, speed)
    assert particles.names == ("vx", "vy", "speed")
    tau = np.sqrt((sim.sxx**2 + sim.syy**2) / 2 + sim.sxy**2)
    assert np.array_equal(sim.field("shear_stress"), tau) and sim.field("yielded").dtype == bool


@needs_hdf5
def test_what_follows_from_fields_is_the_same_in_a_file(tmp_path):
    with block() as sim:
        rough = sim.add_material(mu_s=0.8, mu_2=0.9)
        sim.add_column(x_min=0.06, width=0.1, height=0.05, material=rough)
        sim.record(tmp_path / "r.h5", 0.05, 0.05)
        with granperi.Result(tmp_path / "r.h5") as result:
            for name in ("speed", "shear_stress", "yielded"):
                assert np.array_equal(result[-1].field(name), sim.field(name)), name
        assert 0 < sim.field("yielded").sum() < len(sim)


def test_masked_arrays_without_masked_values_are_arrays():
    with granperi.Simulation(spacing=0.01) as sim, granperi.Simulation(spacing=0.01) as same:
        x = np.array([0.005, 0.015])
        sim.add_particles(np.ma.masked_array(x, [False, False]), np.ma.masked_array(x))
        same.add_particles(x, x)
        assert np.array_equal(sim.x, same.x)


# --------------------------------------------------------------------------------------------------- tables


class _Table(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.open, self.rows = [], []
        self.feed(text)
        assert not self.open and self.rows

    def handle_starttag(self, tag, attributes):
        self.open.append(tag)
        if tag == "tr":
            self.rows.append([])

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1] in ("td", "th"):
            self.rows[-1].append(data)


@needs_hdf5
def test_tables_in_notebooks(sim, tmp_path):
    probe = sim.add_probe(points=[[0, 0.02]], plates=0)
    sim.record(tmp_path / "<r>.h5", 0.3, 0.01)
    with granperi.Result(tmp_path / "<r>.h5") as result:
        things = [sim.state, sim.history, sim.plan(), sim.config, granperi.Material(), sim.plates[0], sim.plate_load(0), probe,
                  sim.particles("position"), result]
        tables = {type(thing).__name__: _Table(thing._repr_html_()).rows for thing in things}
    assert ["spacing", "0.01", "0.0025"] in tables["Config"]
    assert any(row[0] == "at_rest" for row in tables["State"])
    assert len(tables["History"]) == 1 + 20 and tables["History"][0][0] == "time"  # the first and the last ten
    assert any(row[:2] == ["stage", "force"] for row in tables["Plan"])
    assert any(row[0] == "frames" and row[1] == "31" for row in tables["Result"])


def test_a_plan_is_a_list_that_prints_as_a_table(sim):
    sim.step()
    plan = sim.plan()
    lines = str(plan).splitlines()
    assert len(lines) == 1 + len(plan) and lines[0].split() == ["name", "bytes", "seconds", "calls", "why"]
    assert any(line.startswith("stage    force ") for line in lines)


def test_plan_with_costs_on_the_command_line(tmp_path, capsys):
    from granperi import __main__

    (tmp_path / "s.toml").write_text("[config]\nspacing = 0.01\n[[column]]\nwidth = 0.1\nheight = 0.05\n"
                                     "[[floor]]\nx_left = -1\nx_right = 1\n")
    assert __main__.main(["info", str(tmp_path / "s.toml"), "--plan", "7"]) == 0
    force = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("stage    force "))
    assert force.split()[2:4] != ["7"] and float(force.split()[2]) > 0 and force.split()[3] == "7"
    assert __main__.main(["info", "--plan", str(tmp_path / "s.toml")]) == 0
    assert "after 100 steps" in capsys.readouterr().out


def test_the_bar_of_a_notebook(sim, monkeypatch, capsys):
    """tqdm.auto takes the widget where a notebook has one; where these are of another version, text."""
    pytest.importorskip("tqdm")
    shown = []

    class Bar:
        def __init__(self, **options):
            self.n, self.total = options["initial"], options["total"]

        def refresh(self):
            shown.append(self.n)

        def close(self):
            shown.append("closed")

    monkeypatch.setitem(sys.modules, "tqdm.auto", types.SimpleNamespace(tqdm=Bar))
    for _ in sim.frames(0.02, 0.01, progress=True):
        pass
    assert shown[-2:] == [0.02, "closed"]

    monkeypatch.setitem(sys.modules, "ipywidgets", types.SimpleNamespace(version_info=(6, 0, 0, "final", 0)))  # Debian 12
    sim.run(0.03, progress=True)
    assert "0.030/0.03 s" in capsys.readouterr().err
    bar = granperi._report._Bar(20, True)
    bar.show("two runs")
    bar.close()
    assert "two runs" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["run", "sweep", "report"])
def test_a_bar_is_shown_on_a_terminal_that_has_tqdm(command, monkeypatch):
    """Unless it is asked for, or asked not to be."""
    from granperi import __main__, _cli

    asked = [__main__._parser().parse_args([command, "s.toml", *options]) for options in ([], ["--progress"], ["--no-progress"])]
    for terminal, tqdm, shown in ((True, True, True), (True, False, False), (False, True, False)):
        monkeypatch.setattr(sys, "stderr", types.SimpleNamespace(isatty=lambda: terminal))
        monkeypatch.setattr(_cli, "has_tqdm", lambda: tqdm)
        assert [_cli.bar_is_shown(options) for options in asked] == [shown, True, False]


# ----------------------------------------------------------------------------------------------- MDAnalysis


@needs_hdf5
def test_mdanalysis_reads_a_result(sim, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pytest.importorskip("MDAnalysis", reason="Debian: python3-mdanalysis")
        sim.record(tmp_path / "r.h5", 0.05, 0.01)
        with granperi.Result(tmp_path / "r.h5") as result:
            universe = result.universe()
            assert universe.atoms.n_atoms == len(sim) and len(universe.trajectory) == len(result) == 6
            for frame, at in zip(result, universe.trajectory):
                assert at.time == frame.time
                assert np.allclose(universe.atoms.positions[:, 0], frame.x, atol=1e-7)  # 32 bits
                assert np.allclose(universe.atoms.velocities[:, 1], frame.field("vy"), atol=1e-6)
            universe.trajectory[2]
            centre = universe.atoms.center_of_geometry()
            assert centre[0] == pytest.approx(result[2].x.mean(), abs=1e-7) and centre[2] == 0
            assert universe.select_atoms("prop y > 0.03").n_atoms == (result[2].y > 0.03).sum()
    assert math.isclose(sim.time, 0.05)
