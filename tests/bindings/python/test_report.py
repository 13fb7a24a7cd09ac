"""granperi.report: what is run, what is said, and how it is written."""
import json
import math
import re
import types

import numpy as np
import pytest

import granperi
from granperi import _report, _report_ladder, _report_runs

COLLAPSE = """\
[config]
spacing = 0.0025
[run]
end = 0.4
[[column]]
x_min = -0.04
width = 0.08
height = 0.05
[[floor]]
x_left = -0.3
x_right = 0.3
"""
LIMIT = {"peak_height": 0.033, "width_50": 0.07, "width_90": 0.17, "width_98": 0.21}


class Machine:
    """A clock and runs on paper: the error goes as the spacing to the power of 1.5, the time with its cube.

    error: relative, of what is `fine` times as fine as 2.5 mm; chance: of one run.
    """

    def __init__(self, monkeypatch, pace=1.0, seconds=0.4, error=lambda fine: -2e-2 * fine**-1.5, chance=1e-3):
        self.now, self.pace, self.seconds, self.asked, self.error, self.chance = 1000.0, pace, seconds, [], error, chance
        self.rng = np.random.default_rng(1)
        monkeypatch.setattr(_report, "time", types.SimpleNamespace(monotonic=lambda: self.now))
        monkeypatch.setattr(_report, "measure", self.measure)

    def measure(self, scene, spacing, seed, end, quantities, deadline):
        fine = 0.0025 / spacing
        particles, steps = round(640 * fine**2), round(5000 * fine)
        cpu = self.seconds * fine**3
        self.asked.append((spacing, seed))
        self.now += cpu * self.pace
        if self.now > deadline():
            self.now = deadline()
            raise _report_runs.OutOfTime
        values = {name: value * (1 + self.error(fine) + self.chance * self.rng.normal()) for name, value in LIMIT.items()}
        values |= {"rest_time": 0.3 + 0.001 * self.rng.normal(), **dict.fromkeys(granperi._state.MARKS.values(), 0.01)}
        values |= dict.fromkeys(quantities, 1 / fine)
        plan = [granperi.PlanEntry("force", "always", 0, True, 0, cpu, steps),
                granperi.PlanEntry("fluidity", "no amplitude", 0, False, 0, 0, 0)]
        return _report_runs.Measured(spacing, seed, particles, steps, cpu, 0.6 * cpu, values), plan


@pytest.fixture
def scene():
    return granperi.Scene.parse(COLLAPSE, "collapse.toml")


@pytest.fixture
def made(monkeypatch, scene):
    Machine(monkeypatch)
    return granperi.report(scene, budget=20, accuracy=0.03)


@pytest.mark.parametrize("budget", [2, 5, 20, 300])
@pytest.mark.parametrize("pace", [1.0, 5.0])
def test_the_budget_is_kept_and_used(monkeypatch, scene, budget, pace):
    machine = Machine(monkeypatch, pace)
    begin = machine.now
    found = granperi.report(scene, budget=budget * pace)
    assert machine.now - begin <= budget * pace
    # What four runs at four spacings leave is less than what a finer ladder would take.
    assert machine.now - begin > 0.35 * budget * pace or "the accuracy is reached" in found.ended
    assert all(sum(run.spacing == h for run in found.runs) >= 2 for h in found.spacings)
    across = [0.05 / h for h in found.spacings]
    assert across == pytest.approx([round(n) for n in across])  # the columns' smallest side is a whole number of each


@pytest.mark.parametrize("accuracy", [0.03, 0.01, 0.003])
@pytest.mark.parametrize("budget", [5, 20, 60])
def test_finer_spacings_follow_until_the_accuracy_is_reached(monkeypatch, scene, budget, accuracy):
    """The scene's own spacing is coarse, and half of it is not enough."""
    scene.config = scene.config.replace(spacing=0.005)
    machine = Machine(monkeypatch, seconds=0.2)
    begin = machine.now
    found = granperi.report(scene, budget, accuracy)
    used, chosen = machine.now - begin, found.recommendation
    assert used <= budget
    if "the accuracy is reached" in found.ended:
        assert chosen.runs and chosen.spacing >= 0.999 * found.spacings[-1]
    else:
        assert 0.5 * budget < used and "a finer spacing is not sure to fit into what is left" in found.ended
        assert not chosen.runs or "extrapolated" in chosen.reason
    assert found.spacings[-1] < 0.0025 or found.error("width_90", found.spacings[-1], 16) <= accuracy
    assert found.ended in str(found) and found.ended in found.html()
    ratios = [a / b for a, b in zip(found.spacings, found.spacings[1:])]
    assert min(ratios) >= 1.2 - 1e-9 and max(ratios) < 1.7


def test_the_budget_that_is_named_has_room_for_a_finer_spacing(monkeypatch, scene):
    scene.config = scene.config.replace(spacing=0.005)
    Machine(monkeypatch, seconds=0.2)
    short = granperi.report(scene, 10, 1e-3)
    named = re.search(r"two runs at (\S+) m take some \S+ s, for which a budget of (\S+) s has room", short.ended)
    Machine(monkeypatch, seconds=0.2)
    assert granperi.report(scene, float(named[2]), 1e-3).spacings[-1] <= 1.01 * float(named[1]) < short.spacings[-1]


def test_forecasts_that_are_too_low_do_not_exceed_the_budget(monkeypatch, scene):
    """Beyond the first spacings a run takes twice what theirs let expect: what is not done in time is no part of the report."""
    scene.config = scene.config.replace(spacing=0.005)
    machine = Machine(monkeypatch, seconds=0.2)
    begin, seconds = machine.now, machine.seconds

    def slower(one, spacing, *more):
        machine.seconds = seconds * (2 if spacing < 0.0024 else 1)
        return machine.measure(one, spacing, *more)

    monkeypatch.setattr(_report, "measure", slower)
    found = granperi.report(scene, 12, 1e-3)
    assert 6 < machine.now - begin <= 12 and found.spacings[-1] < 0.0024
    assert all(len([run for run in found.runs if run.spacing == h]) >= 2 for h in found.spacings)


def test_more_runs_where_chance_is_most_of_the_error(monkeypatch, scene):
    machine = Machine(monkeypatch, error=lambda fine: 0.0, chance=0.02)
    begin = machine.now
    found = granperi.report(scene, 60, 0.012)
    runs = [sum(run.spacing == h for run in found.runs) for h in found.spacings]
    assert machine.now - begin <= 60 and max(runs) > 4
    Machine(monkeypatch, error=lambda fine: -0.1 / fine)
    found = granperi.report(scene, 60, 0.001)  # hardly any chance
    assert max(sum(run.spacing == h for run in found.runs) for h in found.spacings) == 4


def test_what_does_not_converge_is_made_finer_and_not_forecast(monkeypatch, scene):
    machine = Machine(monkeypatch, error=lambda fine: 0.1 * math.log(fine))
    begin = machine.now
    found = granperi.report(scene, 60, 0.2, of=["peak_height"])
    assert 30 < machine.now - begin <= 60 and found.spacings[-1] < 0.00125
    assert found.convergence["peak_height"].verdict == granperi._report_statistics.DIVERGES
    span = f"{found.spacings[0]:.3g} to {found.spacings[-1]:.3g} m"
    assert f"does not converge at the spacings that were run, {span}, so nothing is forecast" in found.recommendation.reason
    assert math.isfinite(found.error("peak_height", found.spacings[-1])) and math.isnan(found.error("peak_height", 0.0005))
    for row in found.rows:
        assert math.isfinite(row.errors["peak_height"]) == (row.runs > 0)
    assert found.data()["rows"][-1]["errors"]["peak_height"] is None
    assert str(found).splitlines()[2 + len(found.rows)].split()[4] == "-" and "nan" not in str(found) + found.html().lower()


def test_why_it_ended(monkeypatch, scene):
    Machine(monkeypatch)
    given = granperi.report(scene, 600, 0.001, spacings=[0.01, 0.007, 0.005], seeds=2)
    assert len(given.runs) == 6 and given.ended.endswith("of 600 s: the spacings were given, so no others were run.")
    reached = granperi.report(scene, 600, 0.9, spacings=[0.01, 0.007, 0.005], seeds=2)
    assert reached.ended.endswith("of 600 s: the accuracy is reached at a spacing no finer than what was run.")
    machine = Machine(monkeypatch)

    def never_at_rest(*arguments):
        one, plan = machine.measure(*arguments)
        one.values["rest_time"] = math.nan
        return one, plan

    monkeypatch.setattr(_report, "measure", never_at_rest)
    moving = granperi.report(scene, 600, 0.001, of=["rest_time"])
    assert moving.ended.endswith("rest_time is not in every run, which only a later end would change.")
    assert moving.spacings[-1] == 0.00125 and len(moving.runs) == 4 * 4 + 2  # and two that told the cost


def test_the_bar_moves_while_a_run_goes_on(monkeypatch, scene):
    """And not only between runs, of which there are few: here each asks for its deadline once, at its end."""
    pytest.importorskip("tqdm")
    machine, shown = Machine(monkeypatch), []
    monkeypatch.setattr(_report._Bar, "close", lambda bar: shown.append((bar._bar.n, bar._bar.total, bar._bar.desc)))
    monkeypatch.setattr(_report._Bar, "move", lambda bar, move=_report._Bar.move: (move(bar), shown.append(bar._bar.n)))
    begin = machine.now
    found = granperi.report(scene, budget=20, progress=True)
    *during, (spent, whole, said) = shown
    assert during == sorted(during) and len(set(during)) >= len(found.runs) - 3  # the shortest take less than half a second
    assert spent == pytest.approx(machine.now - begin) and whole == 20 and said.startswith(f"{len(found.runs)} runs")


def test_a_budget_that_is_too_small_says_what_it_takes(monkeypatch, scene):
    machine = Machine(monkeypatch)
    with pytest.raises(granperi.ArgumentError, match=r"budget = 0.1 s: two runs at each of three spacings do not fit in: expected "
                                                     r"some (\S+) s at least") as error:
        granperi.report(scene, budget=0.1)
    enough = float(re.search(r"some (\S+) s", str(error.value)).group(1))
    machine.now += 1
    assert len(granperi.report(scene, budget=1.1 * enough).spacings) >= 3
    with pytest.raises(granperi.ArgumentError, match="not one run at a spacing of .* was done"):
        granperi.report(scene, budget=1e-6)


def test_a_run_ends_when_the_time_is_up(scene):
    with pytest.raises(_report_runs.OutOfTime):
        _report_runs.measure(scene, 0.01, 1, 0.4, deadline=lambda: -math.inf)


def test_what_is_recommended_reaches_the_accuracy(made):
    chosen = made.recommendation
    assert chosen.runs >= 1 and chosen.of == ("peak_height", "width_90")
    assert all(error <= 0.03 for error in chosen.errors.values())
    assert chosen.cpu_seconds == pytest.approx(chosen.runs * made.cost.seconds(chosen.spacing))
    # The law on paper: 2 % at 2.5 mm of the value, of the width's change since the start nearly twice that.
    share = 0.17 / made.scale["width_90"]
    assert 0.02 * share * (chosen.spacing / 0.0025) ** 1.5 <= 0.03
    fine = made.recommend(0.01)
    assert fine.spacing < chosen.spacing and fine.cpu_seconds > chosen.cpu_seconds
    assert f"spacing of {chosen.spacing:.4g} m" in str(made)
    assert chosen.config(granperi.Config(horizon=3)) == granperi.Config(horizon=3, spacing=chosen.spacing)
    hopeless = made.recommend(1e-6)
    assert hopeless.runs == 0 and "not even a spacing of" in hopeless.reason
    with pytest.raises(granperi.StateError, match="nothing is recommended: not even a spacing"):
        hopeless.config(granperi.Config())


def test_the_forecast_of_the_cost_is_that_of_its_law(made):
    for spacing in (0.0025, 0.001, 0.0005):
        assert made.cost.seconds(spacing) == pytest.approx(0.4 * (0.0025 / spacing) ** 3, rel=0.05)


def test_cost_knows_what_surface_and_volume_take():
    def run(n):  # 100 ns by the volume, and as much again by the surface at 100 particles
        return _report_runs.Measured(1 / n, 1, n * n, 50 * n, 1e-9 * (100 + 1000 / n) * n * n * 50 * n, math.nan, {})

    cost = _report_ladder.Cost([run(n) for n in (10, 14, 20)])
    for n in (20, 40, 80):
        assert cost.seconds(1 / n) == pytest.approx(run(n).cpu_seconds, rel=0.05)
        assert cost.steps(1 / n) == pytest.approx(50 * n) and cost.particles(1 / n) == pytest.approx(n * n)


def test_what_does_not_converge_is_not_recommended(monkeypatch, scene):
    Machine(monkeypatch)
    found = granperi.report(scene, budget=20, quantities={"grows": lambda sim: 0.0}, of=["grows"])
    found.convergence["grows"].verdict = granperi._report_statistics.DIVERGES
    assert "does not converge" in found.recommend(0.1, ["grows"]).reason
    assert "grows" in str(found) and "grows" in found.html()


def test_json_has_all_numbers(made, tmp_path):
    made.write(tmp_path / "report.json")
    data = json.loads((tmp_path / "report.json").read_text())
    assert data["format"] == 1 and data["granperi"] == granperi.__version__ and data["end"] == 0.4
    assert set(data) == {"format", "granperi", "scene", "end", "budget", "seconds", "spacings", "rows", "quantities",
                         "recommendation", "ended", "advice", "warnings", "stages", "left_out", "runs"}
    assert set(data["quantities"]) == {"peak_height", "width_50", "width_90", "width_98", "rest_time", "x_q01", "x_q05", "x_q25",
                                       "x_q50", "x_q75", "x_q95", "x_q99"}
    peak = data["quantities"]["peak_height"]
    assert set(peak) == {"unit", "meaning", "verdict", "limit", "limit_error", "scale", "order", "order_range", "levels"}
    assert [level["spacing"] for level in peak["levels"]] == data["spacings"] == sorted(data["spacings"], reverse=True)
    assert abs(peak["limit"] - LIMIT["peak_height"]) <= peak["limit_error"]
    assert len(data["runs"]) == len(made.runs) and data["runs"][0]["values"]["width_90"] > 0
    assert data["left_out"] == [{"name": "fluidity", "kind": "stage", "reason": "no amplitude"}]
    assert sum(row["runs"] > 0 for row in data["rows"]) == len(made.spacings) and len(data["rows"]) == len(made.spacings) + 3


def test_the_page_needs_nothing_beside_it(made, tmp_path):
    made.write(tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text()
    assert page.startswith("<!DOCTYPE html>") and "nan" not in page.lower().replace("finance", "")
    assert not re.search(r"(src|href)\s*=|url\(|<script|@import", page)
    assert {address for address in re.findall(r"https?://[^\"'<> ]+", page)} == {"http://www.w3.org/2000/svg"}
    assert page.count("<svg") == 7 and "no amplitude" in page and "within 3 %" in page
    assert made._repr_html_() in page
    limit = made.convergence["peak_height"]
    shown = re.search(r"<td>peak</td><td>([\d.]+) ± ([\d.]+) m</td>", page)  # the last digit of both is in the same place
    assert len(shown[1].partition(".")[2]) == len(shown[2].partition(".")[2])
    assert float(shown[1]) == pytest.approx(limit.limit, abs=0.06 * limit.limit_error)
    with pytest.raises(granperi.ArgumentError, match=r"expected a name that ends in .html or .json"):
        made.write(tmp_path / "report.pdf")
    with pytest.raises(granperi.FileError, match="report.html: exists: expected another name, or overwrite=True"):
        made.write(tmp_path / "report.html")
    made.write(tmp_path / "report.html", overwrite=True)
    with pytest.raises(granperi.FileError, match="cannot be written"):
        made.write(tmp_path / "nowhere" / "report.html")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["report.html"]


def test_a_scene_for_real(scene):
    found = granperi.report(scene, 600, 0.2, end=0.3, spacings=[0.01, 0.005, 0.00714], seeds=2, workers=2,
                            quantities={"mean_y": lambda sim: sim.y.mean()}, of=["mean_y"])
    assert found.spacings == (0.01, 0.00714, 0.005) and len(found.runs) == 6
    assert {run.seed for run in found.runs} == {1, 2} and len({run.values["peak_height"] for run in found.runs}) == 6
    first = next(run for run in found.runs if (run.spacing, run.seed) == (0.01, 1))
    with granperi.Simulation(spacing=0.01, jitter=0.01, seed=1) as sim:
        sim.add_column(x_min=-0.04, width=0.08, height=0.05)
        sim.add_plate(granperi.Plate.floor(-0.3, 0.3))
        sim.run(0.3)
        assert first.values["peak_height"] == sim.state.peak_height and first.values["mean_y"] == sim.y.mean()
        assert first.values["width_90"] == sim.state.x_q95 - sim.state.x_q05 and first.steps == sim.clock.step
    assert found.recommendation.of == ("mean_y",) and "mean_y" in str(found)
    assert any("rounded to" in text for text in found.warnings)  # 0.08 and 0.05 m in 7.14 mm
    names = [entry.name for entry in found.plan if entry.active and entry.kind == 0]
    assert "force" in names and all(entry.seconds >= 0 for entry in found.plan)


@pytest.mark.parametrize("arguments, message", [
    ({"budget": 0}, "budget = 0: expected a number above 0"),
    ({"budget": math.inf}, "budget = inf"),
    ({"accuracy": 1}, "accuracy = 1: expected a number above 0 and below 1"),
    ({"end": -1}, "end = -1"),
    ({"seeds": 1}, "seeds = 1, workers = 1: expected 2 to 100 and 1 to 64"),
    ({"workers": 0}, "workers = 0"),
    ({"spacings": [0.01, 0.005]}, "expected at least three different numbers above 0 m"),
    ({"spacings": 0.01}, "spacings = 0.01: expected several numbers in m"),
    ({"spacings": [0.01, 0.0099, 0.005]}, "spacings = 0.01 and 0.0099 m: expected spacings at least a tenth apart"),
    ({"quantities": [1]}, "expected a dict of names and functions"),
    ({"quantities": {"peak_height": len}}, "the report has a quantity of this name"),
    ({"quantities": {"n": 3}}, r"quantities\['n'\] = 3: expected a name and a function"),
    ({"of": ["peak"]}, "of: 'peak': did you mean 'peak_height'"),
    ({"of": "peak_height"}, "of = 'peak_height': expected a list of names"),
])
def test_mistakes_are_told_before_anything_runs(monkeypatch, scene, arguments, message):
    machine = Machine(monkeypatch)
    with pytest.raises(granperi.ArgumentError, match=message):
        granperi.report(scene, **arguments)
    assert not machine.asked


def test_scenes_that_cannot_be_refined(scene):
    scene.add("particles", x=[0.0], y=[1.0])
    with pytest.raises(granperi.ArgumentError, match="particles given one by one, whose spacing is theirs"):
        granperi.report(scene)
    with pytest.raises(granperi.ArgumentError, match="nothing: has no particles to report on"):
        granperi.report(granperi.Scene(name="nothing"))


def test_a_quantity_that_is_no_number(scene):
    with pytest.raises(granperi.ArgumentTypeError, match=r"quantities\['n'\]: returned None: expected a number"):
        _report_runs.measure(scene, 0.01, 1, 0.01, {"n": lambda sim: None})


def test_from_the_command_line(python, tmp_path):
    (tmp_path / "collapse.toml").write_text(COLLAPSE)
    result = python("-m", "granperi", "report", "collapse.toml", "--budget", "600", "--end", "0.1", "--seeds", "2", "--spacings",
                    "0.01", "0.007", "0.005", "--accuracy", "0.2", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "relative error of one run" in result.stdout and "within 20 %" in result.stdout
    assert json.loads((tmp_path / "collapse_report.json").read_text())["seconds"] < 600
    assert (tmp_path / "collapse_report.html").stat().st_size > 10000
    again = python("-m", "granperi", "report", "collapse.toml", cwd=tmp_path)  # before anything is run
    assert again.returncode == 1 and "collapse_report.html: exists: name another one with --output, or replace it" in again.stderr
    wrong = python("-m", "granperi", "report", "collapse.toml", "--output", "report.pdf", cwd=tmp_path)
    assert wrong.returncode == 2 and "expected a name that ends in .html or .json" in wrong.stderr
