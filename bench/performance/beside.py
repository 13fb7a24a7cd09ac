"""The first paragraphs of docs/performance.md: where other codes are ahead, and where this one is. From the results, aims.json and
peers.py; nothing of it is typed in."""
from __future__ import annotations

import functools
import json
import math
from dataclasses import dataclass

import aims
import measures
import runs
from markdown import fixed
from measures import Reference
from peers import ANOTHER_MACHINE, MEMORY, SAME, THROUGHPUT, second_machine
from results import Collection
from sections import seconds

ERRORS = (0.05, 0.02)  # of which the cost is compared
MILLION = 1265  # particles over the width, of a million


@dataclass(frozen=True)
class Claim:
    """ahead: the other code is."""

    ahead: bool
    text: str


@functools.lru_cache(maxsize=1)
def _mpm() -> dict:
    return json.loads(aims.DATA.read_text(encoding="utf-8"))["mpm"]


def _same_spacing(results: Collection) -> list[Claim]:
    """Same law, spacing, sound speed; no setting is tuned on either side."""
    ratios = []
    for n, cpu, *_ in _mpm()[SAME]:
        own = results(runs.collapse("a1.25", n))
        if own:
            ratios += [measures.cost(own) / of_mpm for of_mpm in (cpu, second_machine().get(n)) if of_mpm]
    if not ratios:
        return []
    sizes = ", ".join(f"{n}" for n, *_ in _mpm()[SAME])
    return [Claim(max(ratios) > 1, f"at the same spacing (L/dl = {sizes}) and sound speed (10 m/s in both) our default scheme takes "
                  f"{fixed(min(ratios), 1)} to {fixed(max(ratios), 1)} times the CPU time of the explicit MPM code Matter, by which of "
                  "two machines that ran on")]  # fmt: skip


def mpm_curve(name: str, ref: Reference) -> tuple[list[float], list[float]]:
    """CPU s and errors of single runs, peak or run-out of 90 % of the mass whichever is larger, against our converged solution."""
    peak, bulk = ref.value["peak"] / runs.SCENES["a1.25"].length, ref.value["bulk"]
    points = _mpm()[name]
    errors = [max(abs(r / bulk - 1), abs(p / peak - 1) if p is not None else 0) for _, _, p, r in points]
    return [cpu for _, cpu, *_ in points], errors


def _same_error(results: Collection) -> list[Claim]:
    """What an error costs, each side with its best settings."""
    ref = measures.reference(results, "a1.25")
    if not ref:
        return []
    own = [p for p in measures.points(results, "a1.25") if p.resolution != ref.resolution and
           (not p.setting or runs.SETTINGS[p.setting].scheme == "default")]  # fmt: skip
    found = []
    for aim in ERRORS:
        best = measures.cheapest(own, lambda p: measures.worst(p.result, ref), aim)
        of_mpm = {name: measures.at_error(*mpm_curve(name, ref), aim) for name in (SAME, "tuned")}
        reached = {name: cost for name, cost in of_mpm.items() if not math.isnan(cost)}
        if best and reached:
            name = min(reached, key=lambda key: reached[key])
            found.append(Claim(reached[name] < best.cost, f"to err by {100 * aim:g} % in peak and run-out takes Matter "
                               f"{seconds(reached[name])} CPU s ({name}), us {seconds(best.cost)} ({best.label}, L/dl = "
                               f"{best.resolution})"))  # fmt: skip
        elif best:
            found.append(Claim(False, f"an error of {100 * aim:g} % takes us {seconds(best.cost)} CPU s ({best.label}, L/dl = "
                               f"{best.resolution}); Matter does not reach it against our converged solution up to L/dl = "
                               f"{_mpm()[SAME][-1][0]}"))  # fmt: skip
    return found


def _memory(results: Collection) -> list[Claim]:
    large = results(runs.growth(MILLION))
    if not large:
        return []
    own = large.summary["peak_memory"] / large.summary["particles"]
    return [Claim(per_particle < own, f"{code} held {per_particle} bytes per particle at a million, we hold {own:.0f}")
            for code, per_particle in MEMORY.items()]  # fmt: skip


def _rates(results: Collection) -> list[Claim]:
    flow = results(runs.flow(126))
    if not flow:
        return []
    own = 1e3 / flow.summary["cpu"]
    text = "{} moves {:.1f} million of its particles by a step in a CPU second, we {:.1f} (ten thousand in flow)"
    found = [(code, rates[1]) for code, _, _, rates, _ in THROUGHPUT]
    ahead = [Claim(True, text.format(code, rate, own)) for code, rate in found if rate > own]
    behind = [code for code, rate in found if rate <= own]
    if behind:
        ahead.append(Claim(False, f"in a CPU second we move {own:.1f} million particles by a step (ten thousand in flow), more than "
                           f"{', '.join(behind)}"))  # fmt: skip
    return ahead


def lead(results: Collection) -> str:
    """Two paragraphs, and one on the machines; nothing without results."""
    claims = [*_same_spacing(results), *_same_error(results), *_memory(results), *_rates(results)]
    if not claims:
        return ""
    parts = {ahead: [claim.text for claim in claims if claim.ahead == ahead] for ahead in (True, False)}
    said = "; ".join(parts[True]) or "in nothing that is measured here"
    lines = [f"**Where other codes are ahead:** {said}."]
    if parts[False]:
        lines.append(f"**Where this one is:** {'; '.join(parts[False])}.")
    ratios = [second_machine()[n] / cpu for n, cpu, *_ in _mpm()[SAME] if n in second_machine()]
    lines.append(
        f"Other codes' CPU times are not of the machine that ours are of: Matter's are of two others, {_mpm()['machine']}, and "
        f"{ANOTHER_MACHINE}, on which the same runs took {fixed(min(ratios), 1)} to {fixed(max(ratios), 1)} times as long; all "
        "others' are of the second one. So a factor of two between codes is within what the machines differ by."
    )  # fmt: skip
    return "\n\n".join(lines)
