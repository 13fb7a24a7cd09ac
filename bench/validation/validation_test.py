"""Runs the coarsest scenes through the runner and the report: what comes out is physics, and the report holds it."""
from __future__ import annotations

import math
import re
import sys
import types
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "common"))

from smoke import Workplace  # first: skips where NumPy is missing

import numpy as np

import every_case
import measures
import results
import runs
import wall_runs
import wall_sections


def check_result(result: results.Result) -> None:
    """A column of 0.08 x 0.05 m that has collapsed and come to rest."""
    summary, series = result.summary, result.tables["series"]
    assert summary["particles"] == 160 and summary["steps"] > 1000
    assert 0.34 < measures.peak(result) < 0.51, "outside what an arrested deposit can be"
    assert summary["at_rest"] == 1 and summary["at_rest_since"] < 1
    assert abs(summary["energy_error_share"]) < 0.02
    assert summary["cpu_seconds"] > 0 and summary["particle_steps_rate"] > 0
    assert len(series["time"]) == 301 and series["time"][-1] == 3
    assert np.all(np.diff(series["time"]) > 0)
    for time in (0.12, 0.22, 0.42, 1, 2, 3):
        x, height = result.surface(time)
        area = float(np.sum((height[1:] + height[:-1]) / 2 * np.diff(x)))
        assert abs(area / (0.08 * 0.05) - 1) < 0.12, f"area below the surface at {time} s: {area}"
    assert abs(float(result.surface(0.42)[1].max()) - result.at("peak_height", 0.42)) < 0.001
    rows = result.select("section", 0.129, y=0.01)
    assert len(rows["x"]) > 10 and rows["vx"][0] < 0 < rows["vx"][-1], "both sides flow outwards"


def check_start_up() -> None:
    """Bagnold's speeds, and the times of a speed that nears its final one as an exponential does, as the law and 1 % later."""
    for angle, speed in ((23, 0.3836), (24, 0.6442), (26, 1.4167), (28, 2.9422)):
        assert abs(wall_sections.bagnold(angle, 0.04, 0) - speed) < 6e-5
    of_row = wall_sections.bagnold(26, 0.04, 0.002)  # that of 10 rows is half a spacing deep
    summary = {f"exact_{k}": 1.4167 * (1 - math.exp(-time / 2)) for k, time in enumerate(wall_runs.START_TIMES)}
    summary |= {f"surface_{k}": of_row * (1 - math.exp(-time / 2.02)) for k, time in enumerate(wall_runs.START_TIMES)}
    for share in (0.5, 0.9):
        law, ours = wall_sections.reached(types.SimpleNamespace(summary=summary), 10, 26, share)
        assert abs(law / (-2 * math.log(1 - share)) - 1) < 1e-3 and abs(ours / law - 1.01) < 1e-3, (share, law, ours)
    summary["surface_3"] = 1.01 * of_row  # faster than the final speed: no exponential
    assert math.isnan(wall_sections.reached(types.SimpleNamespace(summary=summary), 10, 26, 0.9)[1])


def main() -> None:
    check_start_up()
    two = every_case.speed_of_two()
    assert two.asked == "≥ 1.92" and 1 < float(two.measured) <= 2 and two.met == (float(two.measured) >= 1.92)
    place = Workplace.asked_for(HERE, __doc__)

    run = runs.resolution_run("default", 16)
    place.run(run.name)
    result = results.load(run, place.found)
    assert result is not None
    check_result(result)
    assert "0 to do" in place.run(run.name), "a run that has its result is not run again"

    slide = wall_runs.slide_coulomb(1, False)
    place.run(slide.name)
    traction = results.load(slide, place.found).summary["traction"]
    assert abs(traction - 1) < 0.01, "a row of particles is braked by friction times its weight"

    report, images = place.report("validation.md")
    assert f"| 1 row, rough floor | 1 | {traction:.4f} |" in report, "the section on walls has the traction"
    assert f"{measures.peak(result):.3f} (" in report, "the resolution table has the peak"
    assert "runs are missing" in report and not re.search(r"\bnan\b", report.lower())
    assert "validation_resolution.png" in images, images
    names = [one.name for one in runs.all_runs()]
    assert len(names) == len(set(names)) and all("/" not in name for name in names)


main()
