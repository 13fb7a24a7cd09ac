"""The numbers of docs/validation.md that README and the guide repeat: (name, what it is, number)."""
from __future__ import annotations

import math

import fluid_runs
import physics_sections as physics
import references as ref
import runs
from markdown import NONE, fixed, percent, signed
from measures import peak
from results import Collection


def rows(results: Collection) -> list[tuple[str, str, str]]:
    found = [*_both_side(results), *_paper(results), *_others(results), *_inclines(results), *_fluidity(results)]
    minutes = sum(result.cpu for result in results.found.values()) / 60
    return [(f"validation.{name}", what, text) for name, what, text in found] + [
        ("validation.cpu_minutes", "CPU minutes of all runs", fixed(minutes, 0))
    ]


def _both_side(results: Collection) -> list[tuple[str, str, str]]:
    default, walls = (results(runs.resolution_run(scheme, 32)) for scheme in ("default", "walls"))
    top, beside, at_once = (peak(result) if result else None for result in (default, walls, results(runs.code_run(32))))
    error = 100 * abs(default.summary["energy_error_share"]) if default else None
    return [
        ("both_side.peak", "a = 1.25, L/dl = 32, default scheme: peak y/L at 0.42 s", fixed(top)),
        ("both_side.peak_side_walls", f"the same between walls {runs.CHANNEL_WIDTH:g} m apart", fixed(beside)),
        ("both_side.peak_at_once", "without walls, released at once as in other codes", fixed(at_once)),
        ("both_side.experiment", "the experiment", f"{ref.EXPERIMENT_PEAK}"),
        ("both_side.ledger_error", "error of the default's energy ledger, of E0", NONE if error is None else f"{error:.2g} %"),
    ]


def _paper(results: Collection) -> list[tuple[str, str, str]]:
    default, printed = (results(runs.resolution_run(scheme, 32)) for scheme in ("default", "nonlocal_2"))
    change = percent(peak(printed, 3.0), peak(printed), 0) if printed else NONE
    cost = printed.cpu_to(1.0) / default.cpu_to(1.0) if printed and default else None
    return [
        ("paper.peak_change", "the paper's scheme: change of its peak from 0.42 to 3 s", change),
        ("paper.cost", "its CPU time over the default's", fixed(cost, 0)),
    ]


def _others(results: Collection) -> list[tuple[str, str, str]]:
    low, high = ref.CODES_PEAK_BAND
    fronts = {}
    for name in ("front_02", "front_05"):
        offs = [
            abs(row[name] / row[f"discs_{name}"] - 1)
            for a in ref.CONTACT_DYNAMICS
            if (result := results(runs.contact_dynamics(a)))
            for row in physics.contact_rows(result, a)
            if not math.isnan(row[name])
        ]
        fronts[name] = f"{100 * max(offs):.0f} %" if offs else NONE
    run_outs = [
        100 * (result.summary["run_out_98"] / ref.lagree_run_out(a) - 1)
        for sides in (2, 1)
        for a in runs.ASPECTS
        if (result := results(runs.scaling(a, sides)))
    ]
    least, most = (f"{signed(one, 0)} %" for one in (min(run_outs), max(run_outs))) if run_outs else (NONE, NONE)
    return [
        ("codes.peak_least", "MPM and VOF codes, instant release: lowest peak y/L", fixed(low)),
        ("codes.peak_most", "highest", fixed(high)),
        ("codes.peak_discs", "discs", fixed(ref.DISCS_PEAK)),
        ("discs.front_02", "front (0.02 H0) beside contact dynamics: off by up to", fronts["front_02"]),
        ("discs.front_05", "front (0.05 H0)", fronts["front_05"]),
        ("scaling.run_out_least", "run-out against Lagrée et al. (2011), of all aspect ratios: least", least),
        ("scaling.run_out_most", "most", most),
    ]


def _inclines(results: Collection) -> list[tuple[str, str, str]]:
    found = []
    for name, rows, case in (
        ("fast_narrow", 20, "28°, c0 = 10 u, 12 dl wide"),
        ("fast_10", 10, "28°, c0 = 10 u"),
        ("fast_20", 20, "28°, c0 = 10 u"),
        ("fast_40", 40, "28°, c0 = 10 u"),
        ("slow", 20, "23°, c0 = 25 u"),
        ("slow_stiff", 20, "23°, c0 = 50 u"),
    ):
        result = results(runs.exact(f"Bagnold, {case}", rows))
        error = f"{100 * abs(result.summary['error']):.1f} %" if result else NONE
        found.append((f"incline.{name}", f"Bagnold flow, {case}, {rows} rows: error of the surface's speed", error))
    return found


def _fluidity(results: Collection) -> list[tuple[str, str, str]]:
    found = []
    for n, name, spacing in ((2, "half", "half a grain"), (4, "quarter", "a quarter")):
        lid = results(fluid_runs.couette(n))
        error = percent(lid.summary["stress"], lid.summary["stress_exact"]) if lid else NONE
        found.append((f"fluidity.stress_{name}", f"granular fluidity, spacing {spacing}: error of the stress of a lid", error))
    return found + _fluid_columns(results)


def _fluid_columns(results: Collection) -> list[tuple[str, str, str]]:
    """Collapses with fluidity beside those of the local law."""
    def beside(n: int, key: str) -> tuple[float, float] | None:
        fluid, local = (results(fluid_runs.collapse(n, amplitude)) for amplitude in (0.48, 0))
        return (fluid.summary[key], local.summary[key]) if fluid and local else None

    found = []
    for n in (32, 80):
        cost = beside(n, "cpu_seconds")
        text = fixed(cost[0] / cost[1] if cost else None, 1)
        found.append((f"fluidity.cost_{n}", f"collapse with fluidity, L/dl = {n}: CPU time over the local law's", text))
    for name, key, what in (("peak", "peak", "peak"), ("run_out", "run_out_90", "run-out of 90 % of the mass")):
        pair = beside(80, key)
        text = percent(*pair, 0) if pair else NONE
        found.append((f"fluidity.column_{name}", f"collapse with fluidity, L/dl = 80: {what} against the local law's", text))
    return found
