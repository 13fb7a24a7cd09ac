"""The parts of docs/performance.md about error against run time, from the results. A number that is not there is a dash."""
from __future__ import annotations

import math
from statistics import median
from typing import Callable

import measures
import runs
from markdown import NONE, cpu, fixed, signed, significant, table
from measures import QUANTITIES, SHORT, Error, Point, Reference
from peers import OUR_NEIGHBOURS, THROUGHPUT
from results import Collection, Result

GROWS = 1.3  # the error at the finest resolution over the smallest one: beyond, it does not converge,
COUNTS = 0.01  # if it is above this: below, what is left is not of the spacing
AIMS = (("draft", 0.10), ("standard", 0.05), ("fine", 0.02))  # of one run, peak and run-out


def percent(value: float, digits: int = 1) -> str:
    return NONE if math.isnan(value) else f"{signed(100 * value, digits)} %"


def share(value: float, digits: int = 1) -> str:
    return NONE if math.isnan(value) else f"{100 * value:.{digits}f} %"


def with_doubt(one: Error) -> str:
    doubt = NONE if math.isnan(one.bias_doubt) else f"{100 * one.bias_doubt:.1f}"
    return NONE if math.isnan(one.bias) else f"{signed(100 * one.bias, 1)} ± {doubt} %"


def seconds(value: float) -> str:
    return significant(value, 2) if value < 1 else cpu(value)


def front_of(points: list[Point], ref: Reference) -> list[Point]:
    fair = [p for p in points if p.resolution != ref.resolution]
    return measures.pareto(fair, [(p.cost, measures.worst(p.result, ref)) for p in fair])


def convergence(results: Collection) -> str:
    """What errors are counted from, and how far the finest run may itself be off."""
    rows = []
    for key, s in runs.SCENES.items():
        ref = measures.reference(results, key)
        if not ref:
            continue
        coarser = results(runs.collapse(key, max(r for r in s.resolutions if r < ref.resolution)))
        one = measures.scatter(results, key)
        row = [s.label, f"{ref.resolution}", f"{ref.seeds}"]
        for q in QUANTITIES:
            unit = s.length if q == "peak" else 1.0
            doubt = fixed(measures.SURE * ref.error[q] / unit, 3)
            row.append(f"{fixed(ref.value[q] / unit, 3)} ± {doubt}")
            row.append(share(one[q] / ref.value[q]) if q in one else NONE)
            row.append(percent(measures.error(coarser, ref, q).bias) if coarser else NONE)
        rows.append(row)
    header = ["scene", "L/dl", "runs"]
    for q in QUANTITIES:
        header += ["peak y/L" if q == "peak" else SHORT[q], "scatter of one run", "next coarser"]
    return table(header, rows) if rows else ""


def _row(p: Point, ref: Reference, front: list[Point]) -> list[str]:
    own = p.resolution == ref.resolution
    cells = [f"{p.label}{' *' if p in front else ''}".replace("*", "\\*"), f"{p.resolution}", seconds(p.cost)]
    for q in QUANTITIES:
        e = measures.error(p.result, ref, q)
        cells += [NONE if own else with_doubt(e)]
        if q in measures.AIMED_AT:
            cells += [NONE if own else share(e.one_run)]
    return cells


def errors(results: Collection, scene: str) -> str:
    """Every setting of a scene."""
    ref, points = measures.reference(results, scene), measures.points(results, scene)
    if not ref or not points:
        return ""
    front = front_of(points, ref)
    header = ["setting", "L/dl", "CPU s"]
    for q in QUANTITIES:
        header += [SHORT[q], "one run"] if q in measures.AIMED_AT else [SHORT[q]]
    return table(header, [_row(p, ref, front) for p in points])


def _growing(results: Collection) -> dict[float, list[str]]:
    """Horizons with which the error of an exact solution grows on refinement, and of which."""
    growing: dict[float, list[str]] = {}
    for case in runs.CASES.values():
        for h in runs.HORIZONS:
            found = [results(runs.exact(case.name, n, h)) for n in case.resolutions]
            off = [abs(r.summary[case.measure]) for r in found if r]
            if len(off) == len(found) and off[-1] > max(GROWS * min(off), COUNTS):
                growing.setdefault(h, []).append(case.label)
    return growing


def orders(results: Collection) -> str:
    """Of the gradient, from the coarsest to the finest lattice."""
    case, found = runs.CASES["gradient"], []
    ends = case.resolutions[0], case.resolutions[-1]
    for h in (3.0, 4.0):
        coarse, fine = (results(runs.exact(case.name, n, h)) for n in ends)
        if coarse and fine:
            found.append(math.log(coarse.summary[case.measure] / fine.summary[case.measure]) / math.log(ends[1] / ends[0]))
    if len(found) < 2:
        return ""
    return f"On the jittered lattice the gradient is of order {found[0]:.1f} (4 dl: {found[1]:.1f}; from {ends[0]} to {ends[1]} spacings)."


def _candidates(points: list[Point], ref: Reference, results: Collection) -> list[Point]:
    """Settings of the default scheme, but for horizons that do not converge in the exact solutions."""
    growing = _growing(results)
    fair = [p for p in points if p.resolution != ref.resolution and p.horizon not in growing]
    return [p for p in fair if not p.setting or runs.SETTINGS[p.setting].scheme == "default"]


def recommended(results: Collection) -> str:
    """The cheapest setting of the default scheme with which one run of a = 1.25 is within each aim, and what it does in the
    other scenes."""
    ref, points = measures.reference(results, "a1.25"), measures.points(results, "a1.25")
    if not ref:
        return ""
    rows = []
    for name, aim in AIMS:
        p = measures.cheapest(_candidates(points, ref, results), lambda one: measures.worst(one.result, ref), aim)
        if p:
            cells = [share(measures.error(p.result, ref, q).one_run) for q in QUANTITIES]
            rows.append([f"{name}: below {100 * aim:g} %", p.label, f"{p.resolution}", seconds(p.cost), *cells])
        else:
            rows.append([f"{name}: below {100 * aim:g} %", "none", *[NONE] * 7])
    return table(["", "setting", "L/dl", "CPU s", *(f"{label}, one run" for label in SHORT.values())], rows)


def horizons(results: Collection) -> str:
    """What the narrower horizons save and lose at the same spacing."""
    rows = []
    for key, s in runs.SCENES.items():
        ref = measures.reference(results, key)
        for r in s.resolutions:
            base = results(runs.collapse(key, r))
            for h in s.horizons:
                result = results(runs.collapse(key, r, h))
                if not ref or not base or not result or h == runs.DEFAULT_HORIZON or r == ref.resolution:
                    continue
                cells = [
                    f"{percent(measures.error(result, ref, q).bias)} ({percent(measures.error(base, ref, q).bias)})"
                    for q in measures.AIMED_AT
                ]
                worst = [measures.worst(result, ref), measures.worst(base, ref)]
                time = fixed(measures.cost(result) / measures.cost(base), 2)
                rows.append([s.label, f"{r}", f"{h:g}", time, *cells, f"{share(worst[0])} ({share(worst[1])})"])
    header = [
        "scene",
        "L/dl",
        "horizon",
        "CPU time / that of horizon 4",
        "peak (horizon 4)",
        "run-out, 90 % (horizon 4)",
        "one run, the larger of both (horizon 4)",
    ]
    return table(header, rows) if rows else ""


def peers(results: Collection) -> str:
    ref = measures.reference(results, "a1.25")
    if not ref:
        return ""
    rows = []
    for h in (4.0, 3.0):
        for r in (16, 32, 64, 128):
            result = results(runs.collapse("a1.25", r, h))
            if result:
                off = [
                    NONE if r == ref.resolution else with_doubt(measures.error(result, ref, q)) for q in ("peak", "tip")
                ]
                rows.append(
                    [
                        f"**ours, horizon {h:g}**",
                        "peridynamics, return map",
                        f"{r}",
                        seconds(measures.cost(result)),
                        *off,
                    ]
                )
    for p in measures.peers(ref):
        busy = " (busy machine)" if p.inflated else ""
        rows.append(
            [p.label, p.method, f"{p.resolution or NONE}", f"{cpu(p.cost)}{busy}", percent(p.peak), percent(p.tip)]
        )
    return table(["code", "method", "L/dl", "CPU s per simulated s", "peak", "run-out (tips, front)"], rows)


def throughput(results: Collection) -> str:
    rows = []
    for label, runs_of, sizes in (("in flow", runs.flow, runs.FLOW), ("at rest", runs.growth, runs.GROWTH)):
        for n in sizes:
            result = results(runs_of(n))
            if result and 100 < result.summary["particles"] < 2e5:
                per_step = result.summary["cpu"]
                rows.append(
                    [f"**ours, {label}, {result.summary['particles']:.0f} particles**", "double", f"{OUR_NEIGHBOURS}",
                     fixed(1e3 / per_step, 2), fixed(per_step / OUR_NEIGHBOURS, 1)]
                )  # fmt: skip
    for code, precision, neighbours, rates, per_neighbour in THROUGHPUT:
        cells = [" / ".join(f"{rate:g}" for rate in rates), NONE if per_neighbour is None else f"{per_neighbour:g}"]
        rows.append([code, precision, neighbours, *cells])
    return table(
        [
            "code",
            "precision",
            "neighbours",
            "1e6 particle-steps per CPU s (peers: at 1e3 / 1e4 / 1e5)",
            "ns per neighbour",
        ],
        rows,
    )


def exact(results: Collection) -> str:
    rows = []
    for case in runs.CASES.values():
        for n in case.resolutions:
            cells = [_exact_cell(results(runs.exact(case.name, n, h)), case) for h in runs.HORIZONS]
            if any(cell != NONE for cell in cells):
                rows.append([case.label, f"{n}", *cells, case.unit])
    header = ["case", "resolution", *(f"horizon {h:g}" for h in runs.HORIZONS), "error of"]
    return table(header, rows) if rows else ""


def exact_varied(results: Collection) -> str:
    rows = []
    for case in runs.CASES.values():
        if not case.varied_at:
            continue
        tried = [results(runs.exact(case.name, case.varied_at))]
        tried += [results(runs.exact(case.name, case.varied_at, cfl=c)) if c in case.cfls else None for c in runs.CFLS]
        tried += [results(runs.exact(case.name, case.varied_at, sound=s)) for s in runs.SOUNDS]
        if any(tried):
            rows.append([case.label, *(_exact_cell(r, case) for r in tried)])
    header = [
        "case, resolution 20",
        "defaults",
        *(f"cfl {c:g}" for c in runs.CFLS),
        *(f"c0 = {s:g} u" for s in runs.SOUNDS),
    ]
    return table(header, rows) if rows else ""


def _exact_cell(result: Result | None, case: runs.Case) -> str:
    if not result:
        return NONE
    return f"{share(abs(result.summary[case.measure]), 2)} ({seconds(max(result.cpu, 0.001))})"


Lines = Callable[[Collection], list[str]]


def in_short(results: Collection) -> list[str]:
    return [line for part in (_aim, _tips, _horizon, _exact_horizons, _neighbours) for line in part(results)]


def _aim(results: Collection) -> list[str]:
    """The cheapest settings within the aim, by the mean of the runs and by a single one."""
    ref, points = measures.reference(results, "a1.25"), measures.points(results, "a1.25")
    if not ref:
        return []

    def worst_bias(p: Point) -> float:
        return measures.largest(abs(measures.error(p.result, ref, q).bias) for q in measures.AIMED_AT)

    own = _candidates(points, ref, results)
    found = {
        "on the mean of several runs": measures.cheapest(own, worst_bias, measures.AIM),
        "in a single run": measures.cheapest(own, lambda p: measures.worst(p.result, ref), measures.AIM),
    }
    if len(set(map(id, found.values()))) == 1:
        found = {"on the mean of several runs and in a single one": found["in a single run"]}
    return [_reached(p, text, ref) for text, p in found.items()] if own else []


def _reached(p: Point | None, how: str, ref: Reference) -> str:
    if not p:
        return f"No setting that was run has peak and run-out within {100 * measures.AIM:g} % {how}."
    offs = ", ".join(f"{label} {with_doubt(measures.error(p.result, ref, q))}" for q, label in SHORT.items())
    return (
        f"a = 1.25 to 1 s with peak and run-out of 90 % of the mass within {100 * measures.AIM:g} % of our converged solution "
        f"(L/dl = {ref.resolution}) {how}: {seconds(p.cost)} CPU s with {p.label}, L/dl = {p.resolution} ({offs}; one run "
        f"{share(measures.worst(p.result, ref))})."
    )


def _tips(results: Collection) -> list[str]:
    """How the run-outs go on refinement."""
    ref = measures.reference(results, "a1.25")
    own = [(r, results(runs.collapse("a1.25", r))) for r in runs.SCENES["a1.25"].resolutions]
    means = {r: {q: measures.mean(result, q) for q in QUANTITIES} for r, result in own if result}
    if not ref or len(means) < 2:
        return []
    means[ref.resolution] = ref.value
    rows = "; ".join(
        f"{r}: {', '.join(fixed(m[q], 2) for q in ('bulk', 'spread', 'front', 'tip'))}"
        for r, m in sorted(means.items())
    )
    return [
        "The run-out of the tips has not converged: the finer the run, the farther single particles get. Run-outs of 90 % and "
        f"98 % of the mass, of the front and of the tips by L/dl: {rows}. Errors of the tips are against the finest run all the same."
    ]


def _horizon(results: Collection) -> list[str]:
    ref = measures.reference(results, "a1.25")
    if not ref:
        return []
    found = []
    for r in runs.SCENES["a1.25"].resolutions:
        three, four = results(runs.collapse("a1.25", r, 3.0)), results(runs.collapse("a1.25", r))
        if three and four and r != ref.resolution:
            found.append((r, measures.cost(three) / measures.cost(four), three, four))
    if not found:
        return []
    ratios = [ratio for _, ratio, _, _ in found]
    better = sum(measures.worst(three, ref) < measures.worst(four, ref) for _, _, three, four in found)
    text = (
        f"Horizon 3 takes {min(ratios):.2f} to {max(ratios):.2f} of the CPU time of horizon 4 at the same spacing, and one run "
        f"errs less in {better} of {len(found)} spacings"
    )
    for aim in (0.05, 0.02):
        costs = []
        for k in (2, 3):
            line = [(measures.cost(one[k]), measures.worst(one[k], ref)) for one in found]
            costs.append(measures.at_error([c for c, _ in line], [e for _, e in line], aim))
        if not any(math.isnan(c) for c in costs):
            text += f"; to err by {100 * aim:g} % takes {seconds(costs[0])} CPU s with horizon 3 and {seconds(costs[1])} with 4"
    return [text + "."]


def _exact_horizons(results: Collection) -> list[str]:
    """Horizon 3 against 4 in the exact solutions, and horizons with which an error grows on refinement."""
    errors, times = [], []
    for case in runs.CASES.values():
        for n in case.resolutions:
            three, four = results(runs.exact(case.name, n, 3.0)), results(runs.exact(case.name, n, 4.0))
            if three and four and four.cpu > 0.05:
                errors.append(abs(three.summary[case.measure] / four.summary[case.measure]))
                times.append(three.cpu / four.cpu)
    if not errors:
        return []
    text = (
        f"Exact solutions: with horizon 3 the error is {median(errors):.2f} of that with horizon 4 at the same resolution (median of "
        f"{len(errors)}; {min(errors):.2f} to {max(errors):.2f}), the CPU time {median(times):.2f}"
    )
    worse = "; ".join(f"{h:g} ({', '.join(labels)})" for h, labels in sorted(_growing(results).items()))
    return [text + (f". Horizons with which an error grows on refinement: {worse}." if worse else ".")]


def _neighbours(results: Collection) -> list[str]:
    result = results(runs.flow(126))
    if not result:
        return []
    per, least = (result.summary[name] / OUR_NEIGHBOURS for name in ("cpu", "cpu_least"))
    others = [p for code, _, _, _, p in THROUGHPUT if p and not code.endswith(("(MPM)", "(DEM)"))]
    low, high = min(others), max(others)
    return [
        f"{per:.1f} ns per neighbour and step ({result.summary['particles']:.0f} particles in flow, horizon 4; median of "
        f"{runs.REPEAT} measurements, the least {least:.1f}); SPH and peridynamic codes took {low:g} to {high:g} on another "
        f"machine ([other codes](#other-codes)): {low / per:.1f} to {high / per:.1f} times as much."
    ]
