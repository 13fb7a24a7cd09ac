"""Runs small cases through the runner and the report: what comes out is what a program may be judged by, and the report
holds it. Nothing here asserts a time."""
from __future__ import annotations

import math
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "common"))

from smoke import Workplace  # first: skips where NumPy is missing

import numpy as np

import aims
import aims_rows
import batch
import beside
import measures
import peers
import plots
import results
import runs
from run import cheapest_first

PLATE_BYTES = 512  # of the lists of walls: a plate's images, its chain, its places


def check_measures() -> None:
    places = [(1.0, 0.4), (2.0, 0.5), (2.0, 0.1), (3.0, 0.1), (4.0, math.nan), (5.0, 0.05)]
    assert measures.pareto(places, places) == [(1.0, 0.4), (2.0, 0.1), (5.0, 0.05)]
    rows = [{"scene": "a125", "horizon": horizon, "spacings": n, "cpu": cpu, "peak": [-error, 0.0, error], "runout": [0.0, 0.0, 0.01]}
            for horizon, n, cpu, error in ((4, 16, 1.0, 0.07), (4, 32, 4.0, 0.03), (3, 24, 2.0, 0.08), (3, 32, 4.2, 0.02))]
    assert aims.best_of(aims_rows.curves(rows)) == [(16, 1.0, 0.07), (32, 4.2, 0.02)], "what costs the same counts once"
    # Error = 1 / cost falls to 1/20 at 20; a curve that rises above the aim again has not got there.
    costs = [1.0, 8.0, 64.0]
    assert math.isclose(measures.at_error(costs, [1 / c for c in costs], 0.05), 20)
    assert math.isnan(measures.at_error(costs, [0.5, 0.01, 0.06], 0.05))


def check_collapse(coarse: results.Result, fine: results.Result, collection: results.Collection) -> None:
    """Columns that have collapsed; the finest that there is stands for the converged one."""
    ref = measures.reference(collection, "a1.25")
    assert ref and ref.resolution == 16 and ref.seeds == runs.SCENES["a1.25"].resolutions[16]
    own = measures.error(fine, ref, "peak")
    assert abs(own.bias) < 1e-12 and own.one_run > 0, "an ensemble has no bias against itself, but scatter"
    off = measures.error(coarse, ref, "bulk")
    assert math.isclose(
        off.one_run**2,
        off.bias**2 + np.var(coarse.tables["seeds"]["bulk"]) / ref.value["bulk"] ** 2,
        rel_tol=1e-9,
    )
    assert off.bias < 0, "a column of few particles runs out less far"
    # Four times the particles and twice the steps.
    assert (
        7
        < fine.summary["particles"] * fine.summary["steps"] / coarse.summary["particles"] / coarse.summary["steps"]
        < 9
    )


def check_lead(collection: results.Collection) -> None:
    """Where others are ahead comes first; what the machines may decide is nobody's, and stands further down."""
    assert set(peers.second_machine()) >= {32, 64, 128}
    for match in beside.MATCHES:
        costs, errors = beside.mpm_curve(match)
        assert costs == sorted(costs) and errors == sorted(errors, reverse=True) and errors[-1] > 0
    machines = max(beside.slower())
    assert 1.5 < machines < 3
    cases = [("theirs", 0.5, 0.9), ("open", 0.9, 1.1), ("open", 1.1, 0.99 * machines), ("ours", 1.01 * machines, 9.0)]
    assert all(beside.Claim("", least, most).ahead == side for side, least, most in cases)
    assert beside.Claim("", 1.1, 1.1, timed=False).ahead == "ours", "memory is the same on any machine"
    own = beside._rates
    beside._rates = lambda _: [beside.Claim(side, least, most) for side, least, most in cases]
    try:
        lead, (said, undecided) = beside.lead(collection), beside.machines(collection).split("\n\n")
    finally:
        beside._rates = own
    theirs, ours = lead.split("**Where this one is:**")
    assert theirs.startswith("**Where other codes are ahead:**") and "theirs" in theirs and "ours" in ours
    assert "\n" not in lead and "open" not in lead and "open" in undecided
    assert "times as long" in said
    told = beside.caption(collection)
    assert "sleep = 1" in told and "off by" in told


def check_idle(idle: results.Result) -> None:
    """A feature that is there with nothing to do holds and calls nothing, and leaves the same bits."""
    assert idle.summary["unused_bytes"] == 0 and idle.summary["unused_calls"] == 0
    assert idle.summary["bytes"] == idle.summary["bytes_minimal"] and idle.summary["same_bits"] == 1


def check_coulomb(idle: results.Result, used: results.Result) -> None:
    """Coulomb friction is a law at the plate, as a rough plate's traction is one: the stage is the smallest scene's own."""
    more = (idle.summary["bytes"] - idle.summary["bytes_minimal"]) * idle.summary["particles"]
    assert 0 < more < PLATE_BYTES, f"a plate more, out of reach: where it is and which line it is part of, not {more} bytes"
    assert idle.summary["unused_bytes"] == 0 and idle.summary["unused_calls"] == 0 and idle.summary["same_bits"] == 1
    assert used.summary["same_bits"] == 0, "a Coulomb floor lets the block slide"
    assert not any(name.startswith("stage_") for name in used.summary)


def check_commit(directory: Path) -> None:
    """Pages do not make the sources others, programs do."""
    def git(*arguments: str) -> None:
        subprocess.run(["git", "-c", "user.name=me", "-c", "user.email=me@here", *arguments], cwd=directory, check=True, capture_output=True)

    assert batch.commit_of(directory) == ""
    for name in ("docs/page.md", "bench/deep/program.py"):
        path = directory / name
        path.parent.mkdir(parents=True)
        path.write_text("old")
    git("init")
    git("add", ".")
    git("commit", "-m", "all")
    clean = batch.commit_of(directory)
    assert re.fullmatch("[0-9a-f]{7,}", clean), clean
    (directory / "docs/page.md").write_text("new")
    assert batch.commit_of(directory) == batch.commit_of(directory / "bench/deep") == clean
    path.write_text("new")
    assert batch.commit_of(directory) == batch.commit_of(directory / "bench/deep") == clean + "+"


def main() -> None:
    place = Workplace.asked_for(HERE, __doc__)
    check_measures()
    if shutil.which("git"):
        with tempfile.TemporaryDirectory() as directory:
            check_commit(Path(directory))

    coarse, fine = runs.collapse("a1.25", 8), runs.collapse("a1.25", 16)
    idle, used = runs.feature("coulomb", "idle"), runs.feature("coulomb")
    no_friction, side_walls = runs.feature("side_walls", "idle"), runs.feature("side_walls")
    small, machine = runs.growth(runs.GROWTH[0]), runs.machine()
    for run in (coarse, fine, idle, used, no_friction, side_walls, small, machine):
        if not results.load(run, place.found):
            place.run(run.name)
        assert results.load(run, place.found), f"{run.name} has no result"
    assert "0 to do" in place.run(run.name), "a run that has its result is not run again"
    collection = results.Collection(place.found)
    check_collapse(results.load(coarse, place.found), results.load(fine, place.found), collection)
    check_lead(collection)
    check_coulomb(results.load(idle, place.found), results.load(used, place.found))
    check_idle(results.load(no_friction, place.found))
    held = results.load(side_walls, place.found)
    assert held.summary["same_bits"] == 0 and held.summary["stage_side_wall_friction"] > 0, "they hold what they can"
    assert results.load(small, place.found).summary["particles"] == 13 * 8

    report, images = place.report("performance.md")
    peak = measures.reference(collection, "a1.25").value["peak"] / runs.SCENES["a1.25"].length
    assert f"{peak:.3f} ±" in report, "the table of converged solutions has the peak"
    assert f"performance.converged.a125_peak-->{peak:.3f}<" in report, "and so have the pages that are measured against it"
    assert "holds 0 bytes" in report and "runs are missing" in report and " nan" not in report.lower()
    assert images == ["performance_growth.png"], images
    assert plots.others(place.found / "column.png", collection, ("a1.25",)), "there are points to draw"
    names = [one.name for one in cheapest_first(runs.studies())]
    assert len(names) == len(set(names)) and all("/" not in name for name in names)


main()
