"""The numbers of docs/stability.md that README and the guide repeat: (name, what it is, number)."""
from __future__ import annotations

import runs
import verdicts
from coefficients import CRITERION
from markdown import NONE, fixed, percent
from measures import mean
from results import Collection
from sections import coarse_at_rest

NAMED = {"peak": "peak", "bulk": "run-out of 90 % of the mass", "spread": "run-out of 98 % of the mass"}

LARGEST_DELTA = 1e-2  # 1/s, with which the implicit scheme is a check: with more it creeps within seconds


def rows(results: Collection) -> list[tuple[str, str, str]]:
    found = [*_collapse(results), *_implicit(results), *_coarse(results)]
    found.append(("criterion.beyond", "half or twice of it changes the peak or the run-out of 90 % of the mass by more than "
                  f"{100 * CRITERION:g} %", verdicts.beyond(results) or NONE))  # fmt: skip
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
    """CPU time of a collapse to 3 s, over that of the default in as much of its run to a minute, whose steps cost the same throughout."""
    scheme, implicit = runs.SCHEMES["default"], runs.SCHEMES["implicit"]
    default = [rest for rest in runs.rests_of(scheme) if rest.resolution == implicit.resolution and rest.cfl == scheme.own_cfl]
    base = [result.cpu_to(runs.CREEP_END) for rest in default if (result := results(rest.run))]
    deltas = [delta for delta in implicit.deltas if delta <= LARGEST_DELTA]
    costs = {delta: result.cpu / base[0] for delta in deltas if base and (result := results(runs.creep("implicit", delta=delta)))}
    of = ((max(deltas), "least"), (min(deltas), "most"))
    return [
        (f"implicit.cost_{name}", f"implicit scheme, L/dl = {implicit.resolution}, to {runs.CREEP_END:g} s, delta {delta:g}: CPU time over "
         "the default's", fixed(costs.get(delta), 0))
        for delta, name in of
    ]  # fmt: skip


def _coarse(results: Collection) -> list[tuple[str, str, str]]:
    """Whether coarse heaps come to rest, by the horizon."""
    found = []
    for resolution in runs.COARSE_RESOLUTIONS:
        for horizon in (3, 4):
            known = coarse_at_rest(results, resolution, horizon)
            what = f"coarse deposits at rest, L/dl = {resolution}, horizon {horizon}, of {known[1] if known else NONE}"
            found.append((f"coarse.width_{resolution}_horizon_{horizon}", what, f"{known[0]}" if known else NONE))
    return found
