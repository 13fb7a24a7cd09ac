"""What granperi.report makes of numbers whose law is known: no runs."""
import math
import sys

import numpy as np
import pytest
from conftest import ROOT

from granperi import _report_statistics as statistics

LADDER = (3.0, 2.0, 1.5, 1.0)


def draw(rng, law, scatter, ladder=LADDER, runs=4):
    return {h: [law(h) + scatter * rng.normal() for _ in range(runs)] for h in ladder}


@pytest.mark.parametrize("order", [1.0, 1.25, 1.5, 2.0])
@pytest.mark.parametrize("scatter", [0.002, 0.02])
def test_stated_errors_hold_the_truth(order, scatter):
    """The truth is 1. Of 50 reports 9 in 10 hold (fewer than 41 in one of 40 tests, were it no more than that), and half of them are
    not too wide. Orders from 0.9 to 2 are reckoned with: at 1 errors may be a fifth short, at 2, as less is not excluded, wider."""
    rng = np.random.default_rng(7)
    ratios, once = [], []
    for _ in range(50):
        def law(h, c=0.1 * rng.normal()):
            return 1 + c * h**order

        values = draw(rng, law, scatter)
        found = statistics.Convergence(values)
        ratios.append(found.error(1.0, 4) / abs(np.mean(values[1.0]) - 1))
        once.append(found.error(1.0) / abs(law(1.0) + scatter * rng.normal() - 1))
    enough = 0.8 if order == 1 else 1.0
    assert np.mean(np.array(ratios) >= enough) >= 0.82 and np.mean(np.array(once) >= enough) >= 0.82
    assert np.median(ratios) < (5 if order == 2 else 3)


def test_the_order_is_seen():
    for order in (0.5, 1.0, 2.0):
        found = statistics.Convergence(draw(np.random.default_rng(1), lambda h: 2 - 0.3 * h**order, 1e-4))
        assert found.verdict == statistics.CONVERGES
        assert found.order == pytest.approx(order, abs=0.35)  # means 3 % of their change beside a power are allowed for
        assert found.order_range[0] <= order <= found.order_range[1]


@pytest.mark.parametrize("law", [lambda h: h**-1.0, lambda h: 1 / (h - 0.6)])
def test_what_does_not_converge_is_told(law):
    found = statistics.Convergence(draw(np.random.default_rng(2), law, 1e-3))
    assert found.verdict == statistics.DIVERGES and found.order < 0


def test_chance_alone_is_told_from_a_trend():
    verdicts = [statistics.Convergence(draw(np.random.default_rng(seed), lambda h: 1.0, 0.05)).verdict for seed in range(30)]
    # Chi squared of three beyond 10.5, with a scatter that four runs each tell of: one in 20 to 40.
    assert verdicts.count(statistics.WITHIN_SCATTER) >= 25
    found = statistics.Convergence(draw(np.random.default_rng(0), lambda h: 1.0, 0.05))
    assert 0.05 < found.error(1.0) < 0.3  # of one run: chance, and what four means leave open


def test_up_and_down_is_told():
    values = {h: [v - 0.001, v + 0.001, v] for h, v in zip(LADDER, (1.0, 1.2, 1.0, 1.15))}
    found = statistics.Convergence(values)
    assert found.verdict == statistics.IRREGULAR
    assert found.error(1.0, 3) > 0.05  # no extrapolation makes it small


def test_units_and_zero_do_not_matter():
    values = draw(np.random.default_rng(3), lambda h: 0.2 - 0.05 * h, 0.003)
    one = statistics.Convergence(values)
    other = statistics.Convergence({1000 * h: [50 + 1e3 * v for v in some] for h, some in values.items()})
    assert other.limit == pytest.approx(50 + 1e3 * one.limit, rel=1e-9)
    assert other.error(1000.0) == pytest.approx(1e3 * one.error(1.0), rel=1e-6)
    mirrored = statistics.Convergence({h: [-v for v in some] for h, some in values.items()})
    assert mirrored.limit == pytest.approx(-one.limit) and mirrored.error(0.5) == pytest.approx(one.error(0.5))


def test_finer_spacings_and_more_runs_err_less():
    found = statistics.Convergence(draw(np.random.default_rng(4), lambda h: 1 + 0.1 * h**1.5, 0.005))
    errors = [found.error(h) for h in (3.0, 2.0, 1.0, 0.5, 0.25)]
    assert all(fine < coarse for coarse, fine in zip(errors, errors[1:]))
    assert found.error(0.25, 16) < found.error(0.25, 4) < found.error(0.25)
    assert found.bias(1.0) == pytest.approx(0.1, abs=found.error(1.0))


def test_few_runs_borrow_the_scatter_of_all():
    values = {3.0: [1.0, 1.2, 0.8, 1.1], 2.0: [1.1, 0.9, 1.0], 1.0: [1.0, 1.0]}
    levels = statistics.levels(values)
    assert [level.runs for level in levels] == [4, 3, 2]
    assert levels[-1].scatter > 0.05  # two runs that happen to agree are not without chance
    assert levels[-1].standard_error == pytest.approx(levels[-1].scatter / math.sqrt(2))


def test_equal_values_have_no_error():
    found = statistics.Convergence({h: [0.5, 0.5] for h in LADDER})
    assert found.limit == pytest.approx(0.5) and found.error(1.0) < 1e-9
    assert statistics.Convergence({h: [0.0, 0.0] for h in LADDER}).limit == 0


def test_errors_of_real_scenes_hold_as_often_as_is_said():
    """docs/report.md, by three reports of each of its 60 cases in place of 16: of 180, not independent, the shares vary by some
    2 %. 9 in 10 are to hold, half to be at most three times too wide; CPU times are forecast within 30 %, but for a = 0.5,
    whose runs of one spacing take times that differ by 1.7 themselves, as they fall asleep sooner or later."""
    sys.path.insert(0, str(ROOT / "bench" / "report"))
    import coverage
    import pool

    rows = pool.read(ROOT / "bench" / "report" / "pool.jsonl")
    drawn = coverage.draw_all(coverage.values_of(rows), 3)
    assert len(drawn) == 180
    held, narrow, _ = coverage.held(drawn, "mean")
    assert held >= 0.86 and narrow >= 0.46
    assert coverage.held(drawn, "one")[0] >= 0.86 and coverage.held(drawn, "finer")[0] >= 0.86
    forecasts = [(forecast / measured, scene) for scene, *_, forecast, measured in coverage.cost_forecasts(rows)]
    assert len(forecasts) > 60 and all(abs(ratio - 1) < 0.3 for ratio, scene in forecasts if scene != "low")
    assert all(1 / 1.7 < ratio < 1.7 for ratio, _ in forecasts)
