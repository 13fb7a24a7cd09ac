"""Runs coarse trials through the runner and the report: what comes out is physics, and the report holds it."""
from __future__ import annotations

import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "common"))

from smoke import Workplace  # first: skips where NumPy is missing

import numpy as np

import measures
import results
import runs
import theory
from coefficients import COEFFICIENTS
from constants import CONSTANTS
from run import ROOT, cheapest_first


def check_theory() -> None:
    """Long waves travel at the wave speed, and a narrower horizon resolves shorter ones."""
    assert theory.surface(4.0) < theory.interior(4.0)
    steps = [theory.interior(h, 0.0, 0.0) for h in (2.2, 3.0, 4.0, 5.0)]
    assert all(a < b for a, b in zip(steps, steps[1:]))
    # The largest gradient of a wave of unit amplitude that a support of R spacings passes on is some 2/R.
    assert all(0.8 < step / h < 1.3 for step, h in zip(steps[1:], (3.0, 4.0, 5.0)))
    decay = [theory.checkerboard_decay(4.0, penalty, "checkerboard") for penalty in (0.0, 0.02, 0.1, 0.4)]
    assert decay[0] == 0 and decay[1] == decay[2] and math.isclose(decay[3], 2 * decay[2])


def check_constants() -> None:
    """Each is where it is said to be, with the value that is said, and another one can be put in its place."""
    own = {c.name: c.own for c in CONSTANTS}
    for c in CONSTANTS:
        for value in c.others:
            assert c.changed(ROOT, value) != (ROOT / c.file).read_bytes(), c.name
    assert float(own["shear_to_bulk"]) == theory.SHEAR_TO_BULK
    assert float(own["least_elastic_penalty"]) == theory.ELASTIC_PENALTY


def check_ensemble(result: results.Result) -> None:
    """Columns of 0.08 x 0.05 m, 8 spacings wide, that have collapsed and come to rest."""
    seeds = result.tables["seeds"]
    assert len(seeds["peak"]) == runs.RESOLUTIONS[8]
    assert len(np.unique(seeds["peak"])) > len(seeds["peak"]) / 2, "seeds are runs of their own"
    assert np.all((seeds["peak"] / runs.WIDTH > 0.3) & (seeds["peak"] / runs.WIDTH < 0.5))
    assert np.all(seeds["spread"] <= seeds["tip"] + 1), "the tips are outside of 98 % of the mass, but for single grains"
    assert np.all(seeds["error"] < 0.05) and np.all(seeds["gain"] <= 1e-3)
    peak = measures.mean(result, "peak")
    assert math.isclose(peak.error, peak.scatter / math.sqrt(len(seeds["peak"])))


def check_mode(result: results.Result, penalty: float) -> None:
    """The penalty takes what the gradient does not see, at least as fast as theory has it and not much faster. The layer is at
    rest, inside its yield surface: there the penalty is 0.2 at least (gp_config.zero_energy_penalty)."""
    series = result.tables["series"]
    assert 0.9 < series["unseen"][0] < 1.3, "a checkerboard is in no gradient"
    unit = result.summary["sound_speed"] * 32 / runs.WIDTH
    expected = theory.checkerboard_decay(4, penalty, "checkerboard") * unit
    assert 0.9 < measures.decay_rate(result) / expected < 1.5


def main() -> None:
    place = Workplace.asked_for(HERE, __doc__)
    check_theory()
    check_constants()

    penalties = (0.1, 0.5)  # below what is the least inside the yield surface, and above it
    ensemble, modes = runs.resolution_run(8), [runs.mode("checkerboard", penalty) for penalty in penalties]
    for run in (ensemble, *modes):
        place.run(run.name)
        assert "0 to do" in place.run(run.name), "a run that has its result is not run again"
    check_ensemble(results.load(ensemble, place.found))
    for mode, penalty in zip(modes, penalties):
        check_mode(results.load(mode, place.found), penalty)

    report, images = place.report("stability.md")
    peak = measures.mean(results.load(ensemble, place.found), "peak").value / runs.WIDTH
    assert f"{peak:.3f} ±" in report, "the resolution table has the peak"
    assert "runs are missing" in report and " nan" not in report.lower()
    assert images == ["stability_modes.png", "stability_resolution.png"], images
    names = [one.name for one in cheapest_first(runs.studies())]
    assert len(names) == len(set(names)) and all("/" not in name for name in names)
    for c in COEFFICIENTS:
        assert len({runs.varied(c, value).name for value in c.all_values}) == len(c.all_values)


main()
