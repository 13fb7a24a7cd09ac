"""The numbers of docs/stability.md that README and the guide repeat: (name, what it is, number)."""
from __future__ import annotations

import runs
from markdown import NONE, fixed, percent
from measures import mean
from results import Collection

NAMED = {"peak": "peak", "bulk": "run-out of 90 % of the mass", "spread": "run-out of 98 % of the mass"}


def rows(results: Collection) -> list[tuple[str, str, str]]:
    found = [*_collapse(results), *_implicit(results)]
    minutes = sum(result.cpu for result in results.found.values()) / 60
    return [(f"stability.{name}", what, text) for name, what, text in found] + [
        ("stability.cpu_minutes", "CPU minutes of all runs", fixed(minutes, 0))
    ]


def _collapse(results: Collection) -> list[tuple[str, str, str]]:
    """a = 1.25 at 32 spacings over the width, against the finest."""
    here, finest = results(runs.resolution_run(32)), results(runs.resolution_run(runs.FINEST))
    found = []
    for column, what in NAMED.items():
        one = mean(here, column) if here else None
        scatter = f"{100 * one.scatter / one.value:.1f} %" if one else NONE
        off = percent(one.value, mean(finest, column).value, 0) if one and finest else NONE
        found.append((f"scatter.{column}", f"a = 1.25, L/dl = 32: scatter of one run, {what}", scatter))
        if column != "peak":
            found.append((f"resolution.{column}_off", f"{what}: mean against L/dl = {runs.FINEST}", off))
    for name, result, n in (("here", here, 32), ("finest", finest, runs.FINEST)):
        text = fixed(mean(result, "bulk").value, 2) if result else NONE
        found.append((f"resolution.bulk_{name}", f"run-out of 90 % of the mass, L/dl = {n}", text))
    return found


def _implicit(results: Collection) -> list[tuple[str, str, str]]:
    """CPU time per simulated second, of the deposits that are looked at while they rest."""
    scheme = runs.SCHEMES["default"]
    default = [rest for rest in runs.rests_of(scheme) if rest.resolution == 16 and rest.cfl == scheme.own_cfl]
    base = [result.cpu / rest.end for rest in default if (result := results(rest.run))]
    costs = [
        result.cpu / rest.end / base[0]
        for rest in runs.rests_of(runs.SCHEMES["implicit"])
        if base and rest.resolution == 16 and (result := results(rest.run))
    ]
    least, most = (f"{one:.0f}" for one in (min(costs), max(costs))) if costs else (NONE, NONE)
    return [
        ("implicit.cost_least", "implicit scheme, L/dl = 16: CPU time over the default's, by delta: least", least),
        ("implicit.cost_most", "most", most),
    ]
