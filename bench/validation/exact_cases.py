"""Cases with an exact solution, for the table of every case."""
from __future__ import annotations

import math

import runs
from case import Case, present, spent, worst
from results import Collection

LEDGER = 0.002  # of E0


def cases(results: Collection) -> list[Case]:
    return [
        _operators(results),
        *_hydrostatic(results),
        _at("shear box: τ = μ(I) p at the imposed rate", "± 0.1 %", results, ("shear box",), {10: 1e-3, 20: 1e-3, 40: 1e-3}),
        _at("Bagnold flow, 26°, c0 = 10 u", "1 % at h/dl = 20, 0.3 % at 40", results, ("Bagnold, c0 = 10 u",), {20: 0.01, 40: 0.003}),
        _at("Bagnold flow, 26°, c0 = 20 u", "1 % at h/dl = 20, 0.3 % at 40", results, ("Bagnold, c0 = 20 u",), {20: 0.01, 40: 0.003}),
        *(
            _at(f"Bagnold flow, {name}, after 4 s", "1 % at h/dl = 20, 0.3 % at 40", results, (f"Bagnold, {name}",), {20: 0.01, 40: 0.003})
            for name in ("23°, c0 = 25 u", "23°, c0 = 50 u", "24°, c0 = 15 u", "28°, c0 = 10 u", "28°, c0 = 10 u, 12 dl wide")
        ),
        _at(
            "start of Bagnold flow, t ≤ 0.15 s", "± 2 %", results,
            ("Bagnold start-up, c0 = 10 u", "Bagnold start-up, c0 = 40 u"), {20: 0.02, 40: 0.02},
        ),
        *(_chute(results, case) for case in ("chute", "chute, horizon 2.5")),
        _at("plane Couette with gravity", "Δu/U < 0.01", results, ("Couette, Cawthorn's cell",), {60: 0.01}, "error_max"),
        _at("static slope of 20°, 60 s", "< 0.1 dl", results, ("slope of 20 degrees, 60 s",), {16: 0.1}),
        _ledger(results),
    ]  # fmt: skip


def _at(
    name: str, asked: str, results: Collection, of: tuple[str, ...], allowed: dict[int, float], error: str = "error"
) -> Case:
    """The error farthest over what is allowed at its resolution."""
    tried = [(f"{case}, {r}", runs.exact(case, r)) for case in of for r in allowed]
    found = present(results, tried)
    limits = {label: allowed[int(label.rsplit(" ", 1)[1])] for label, _ in tried}
    known = [(label, result.summary[error], limits[label]) for label, result in found]
    if not known:
        return Case(name, asked, "", math.nan, None)
    label, value, limit = max(known, key=lambda one: abs(one[1]) / one[2])
    return Case(name, asked, f"{value:+.2g} at {label.rsplit(' ', 1)[1]}", abs(value) / limit, spent(found))


def _operators(results: Collection) -> Case:
    name, asked = "gradient and divergence on a jittered lattice", "order ≥ 1.9"
    case = "operators, jittered lattice"
    found = present(results, ((f"{r}", runs.exact(case, r)) for r in runs.EXACT_CASES[case][2]))
    if len(found) < 2:
        return Case(name, asked, "", math.nan, None)
    (r1, first), (r2, last) = found[0], found[-1]
    order = math.log(abs(first.summary["error"] / last.summary["error"])) / math.log(int(r2) / int(r1))
    return Case(name, asked, f"{order:.2f}, from {r1} to {r2} spacings", 1.9 / order, spent(found))


def _hydrostatic(results: Collection) -> list[Case]:
    found = present(results, ((f"H/dl = {r}", runs.exact("hydrostatic", r)) for r in (20, 40, 80)))
    return [
        worst(
            f"hydrostatic column: pressure, {what}", f"± {100 * limit:g} %", limit,
            [(label, result.summary[key]) for label, result in found], "{percent} at {label}", spent(found),
        )
        for what, key, limit in (("at the base", "error_base", 0.005), ("rms", "error", 0.01))
    ]  # fmt: skip


def _chute(results: Collection, case: str) -> Case:
    name, asked, finest = f"vertical {case}", "plug's edge ± dl, its speed ± 2 %", runs.EXACT_CASES[case][2][-1]
    found = present(results, [("", runs.exact(case, finest))])
    if not found:
        return Case(name, asked, "", math.nan, None)
    edge, speed = (found[0][1].summary[key] for key in ("error_plug_width", "error"))
    measured = f"edge {edge:+.2f} dl, speed {100 * speed:+.1f} % at Y/dl = {finest}"
    return Case(name, asked, measured, max(abs(edge), abs(speed) / 0.02), spent(found))


def _ledger(results: Collection) -> Case:
    found = present(results, ((scene, runs.main_run(scene, "default")) for scene in ("both_1.25", "both_5")))
    labels = {"both_1.25": "a = 1.25", "both_5": "a = 5"}
    offs = [(labels[scene], result.summary["energy_error_share"]) for scene, result in found]
    return worst("energy ledger of a collapse", "± 0.2 % of E0", LEDGER, offs, "{percent}, {label}", spent(found))
