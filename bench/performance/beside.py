"""Beside other codes: the first paragraph of docs/performance.md, where they are ahead and where this one is, and further down what the
machines may decide. From the results, aims.json and peers.py; nothing of it is typed in."""
from __future__ import annotations

import math
from dataclasses import dataclass

import measures
import runs
from markdown import fixed
from measures import Reference
from peers import ANOTHER_MACHINE, MEMORY, SAME, THROUGHPUT, matter, second_machine
from results import Collection
from sections import percent, seconds

ERRORS = (0.05, 0.02)  # of which the cost is compared
MILLION = 1265  # particles over the width, of a million
SIDES = ("theirs", "ours", "open")  # who is ahead


@dataclass(frozen=True)
class Claim:
    """least, most: what the other code takes, in what we take; timed: on another machine than ours."""

    text: str
    least: float
    most: float
    timed: bool = True

    @property
    def ahead(self) -> str:
        """Ours only beyond what machines differ by; of what lies between, the machines may decide."""
        if self.most < 1:
            return "theirs"
        return "ours" if self.least > (max(slower()) if self.timed else 1) else "open"


def slower() -> list[float]:
    """How much longer the same runs took on the second machine than on the first."""
    return [second_machine()[n] / cpu for n, cpu, *_ in matter()[SAME] if n in second_machine()]


def _same_spacing(results: Collection) -> list[Claim]:
    """Same law, spacing, sound speed; no setting is tuned on either side."""
    ratios = []
    for n, cpu, *_ in matter()[SAME]:
        own = results(runs.collapse("a1.25", n))
        if own:
            ratios += [measures.cost(own) / of_mpm for of_mpm in (cpu, second_machine().get(n)) if of_mpm]
    if not ratios:
        return []
    sizes = ", ".join(f"{n}" for n, *_ in matter()[SAME])
    return [Claim(f"at the same spacing (L/dl = {sizes}) and sound speed (10 m/s in both) our default scheme takes "
                  f"{fixed(min(ratios), 1)} to {fixed(max(ratios), 1)} times the CPU time of the explicit MPM code Matter, by which of "
                  "two machines that ran on", 1 / max(ratios), 1 / min(ratios))]  # fmt: skip


@dataclass(frozen=True)
class Match:
    """Settings in which both codes are alike."""

    mpm: str  # in aims.json
    own: tuple[str, ...]  # of ours: keys of settings, "" for the horizons
    quantities: tuple[str, ...]
    text: str


MATCHES = (
    Match(SAME, ("",), measures.AIMED_AT, "in peak and run-out, with a sound speed of 10 m/s,"),
    Match("tuned", ("cheap3",), ("bulk",), "in the run-out alone (no peak of Matter's was kept), with 7 m/s and a longer step,"),
)


def mpm_curve(match: Match) -> tuple[list[float], list[float]]:
    """CPU s and errors of single runs, the largest of the quantities, against its own finest run."""
    *coarser, finest = [(cpu, {"peak": peak, "bulk": bulk}) for _, cpu, peak, bulk in matter()[match.mpm]]
    errors = [max(abs(value[q] / finest[1][q] - 1) for q in match.quantities) for _, value in coarser]
    return [cpu for cpu, _ in coarser], errors


def _own_curves(results: Collection, ref: Reference, match: Match) -> dict[str, tuple[list[float], list[float]]]:
    """The same of ours, by setting."""
    curves: dict[str, tuple[list[float], list[float]]] = {}
    for p in measures.points(results, "a1.25"):
        if p.setting in match.own and p.resolution != ref.resolution:
            error = measures.largest(measures.error(p.result, ref, q).one_run for q in match.quantities)
            if not math.isnan(error):
                costs, errors = curves.setdefault(p.label, ([], []))
                costs.append(p.cost)
                errors.append(error)
    return curves


def _joined(claims: list[Claim], begin: str) -> list[Claim]:
    """One for each side."""
    sides = [[claim for claim in claims if claim.ahead == side] for side in SIDES]
    return [Claim(begin + ", ".join(claim.text for claim in of), min(claim.least for claim in of), max(claim.most for claim in of))
            for of in sides if of]  # fmt: skip


def _same_error(results: Collection) -> list[Claim]:
    """What an error costs, each code's counted from its own finest run, with settings that are alike."""
    ref = measures.reference(results, "a1.25")
    if not ref:
        return []
    found = []
    for match in MATCHES:
        costs, errors = mpm_curve(match)
        curves = _own_curves(results, ref, match)
        claims = []
        for aim in sorted({min(aim, errors[0]) for aim in ERRORS}, reverse=True):  # what its coarsest run does, if that is less
            theirs = measures.at_error(costs, errors, aim)
            own = {label: measures.at_error(*curve, aim) for label, curve in curves.items()}
            own = {label: cost for label, cost in own.items() if not math.isnan(cost)}
            if own and not math.isnan(theirs):
                label = min(own, key=lambda key: own[key])
                text = f"of {100 * aim:.2g} % takes Matter {seconds(theirs)} CPU s, us {seconds(own[label])} ({label})"
                claims.append(Claim(text, theirs / own[label], theirs / own[label] * max(slower())))
        found += _joined(claims, f"an error {match.text} ")
    return found


def caption(results: Collection) -> str:
    """Of the figure at the head of the page."""
    text = (
        "What CPU time buys, a = 1.25: error of one run at 1 s (peak or run-out of 90 % of the mass, whichever is larger) against its CPU "
        "time, of this library, of the explicit MPM code Matter with the same law, and of the recommended settings. Ours with sleep = 1, "
        "which leaves out what has come to rest; hollow stars: without it. The MPM computes all of the 1 s. The sound speed is 10 m/s in "
        "both; tuned: 7 m/s, a longer time step, and the error of the run-out alone, as no peak was kept. "
    )
    ref = measures.reference(results, "a1.25")
    if ref:
        (*_, peak, bulk), (*_, tuned) = matter()[SAME][-1], matter()["tuned"][-1]
        unit = runs.SCENES["a1.25"].length
        pairs = ((peak, ref.value["peak"] / unit), (bulk, ref.value["bulk"]), (tuned, ref.value["bulk"]))
        off = [percent(value / of - 1) for value, of in pairs]
        text += (
            f"All errors are against our converged solution, from which the finest run of the MPM is off by {off[0]} in the peak and by "
            f"{off[1]} in the run-out (tuned: {off[2]}): its curves hold this difference of the codes. "
        )
    return text + (
        "The grey band is from one machine to another on which the MPM code was timed: ours is a third one. From aims.json, by "
        "bench/performance/aims.py"
    )


def _memory(results: Collection) -> list[Claim]:
    large = results(runs.growth(MILLION))
    if not large:
        return []
    own = large.summary["peak_memory"] / large.summary["particles"]
    return [Claim(f"{code} held {bytes_each} bytes per particle at a million, we hold {own:.0f}", bytes_each / own, bytes_each / own, False)
            for code, bytes_each in MEMORY.items()]  # fmt: skip


def _rates(results: Collection) -> list[Claim]:
    flow = results(runs.flow(126))
    if not flow:
        return []
    own = 1e3 / flow.summary["cpu"]
    claims = [Claim(f"{code} {rates[1]:g}", own / rates[1], own / rates[1]) for code, _, _, rates, _ in THROUGHPUT]
    return _joined(claims, f"in a CPU second we move {own:.1f} million particles by a step (ten thousand in flow), ")


def _parts(results: Collection) -> dict[str, str]:
    """What is claimed, by who is ahead; nothing without results."""
    claims = [*_same_spacing(results), *_same_error(results), *_memory(results), *_rates(results)]
    return {side: "; ".join(claim.text for claim in claims if claim.ahead == side) for side in SIDES} if claims else {}


def lead(results: Collection) -> str:
    """The first paragraph."""
    parts = _parts(results)
    if not parts:
        return ""
    text = f"**Where other codes are ahead:** {parts['theirs'] or 'in nothing that is measured here'}."
    if parts["ours"]:
        text += f" **Where this one is:** {parts['ours']}."
    return f"{text} All else is within what machines differ by: [Other codes](#other-codes)." if parts["open"] else text


def machines(results: Collection) -> str:
    """What the machines may decide, and why."""
    parts = _parts(results)
    if not parts:
        return ""
    ratios, ref = slower(), measures.reference(results, "a1.25")
    text = (
        f"Other codes' CPU times are not of the machine that ours are of: Matter's are of two others, {matter()['machine']}, and "
        f"{ANOTHER_MACHINE}, on which the same runs took {fixed(min(ratios), 1)} to {fixed(max(ratios), 1)} times as long; all "
        f"others' are of the second one. So a factor of two between codes is within what the machines differ by, and we are said to be "
        f"ahead only beyond {fixed(max(ratios), 1)}."
    )
    if parts["open"]:
        text += f"\n\n**Where the machines may decide:** {parts['open']}."
        if ref:
            text += (
                f" Errors are counted from each code's own finest run (Matter: L/dl = {matter()[SAME][-1][0]}, ours: {ref.resolution}), "
                "and Matter's times to err by so much are of the first machine."
            )
    return text
