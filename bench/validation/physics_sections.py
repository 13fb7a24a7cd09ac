"""Sections of docs/validation.md beyond the collapses of the paper: scaling, discs, other codes, Couette, theory."""
from __future__ import annotations

import math

import references as ref
import runs
from markdown import NONE, cpu, fixed, percent, significant, table
from measures import contact_front, couette_profile, exact_error, peak
from results import Collection, Result

AGREEMENT = 0.10  # of the reference: what counts as agreement with contact dynamics


def scaling(results: Collection) -> str:
    parts = []
    for sides, name in ((2, "Two sides, L0 = half the width"), (1, "One side, L0 = the width")):
        rows = []
        for a in runs.ASPECTS:
            result = results(runs.scaling(a, sides))
            run_out, tip = (result.summary[name] if result else None for name in ("run_out_98", "tip"))
            height = result.summary["peak_height"] / result.summary["reference_length"] if result else None
            rows.append(
                [
                    f"{a:g}",
                    fixed(run_out, 2),
                    fixed(tip, 2),
                    fixed(ref.lube_run_out(a), 2),
                    fixed(ref.lajeunesse_run_out(a), 2),
                    fixed(ref.staron_run_out(a), 2),
                    fixed(ref.lagree_run_out(a), 2),
                    percent(run_out, ref.lagree_run_out(a), 0),
                    fixed(height, 2),
                    fixed(ref.lube_height(a), 2),
                    fixed(ref.staron_height(a), 2),
                    cpu(result.cpu if result else None),
                ]
            )
        parts.append(
            f"**{name}**\n\n"
            + table(
                [
                    "a",
                    "run-out, 98 %",
                    "tips",
                    "Lube",
                    "Lajeunesse",
                    "Staron & Hinch",
                    "Lagrée",
                    "off Lagrée",
                    "height/L0",
                    "Lube",
                    "Staron & Hinch",
                    "CPU s",
                ],
                rows,
            )
        )
    return "\n\n".join(parts)


def contact_rows(result: Result, a: float) -> list[dict[str, float]]:
    """Fronts and peaks of ours and of the discs by t / sqrt(H0/g)."""
    data = ref.CONTACT_DYNAMICS[a]
    unit = math.sqrt(data["height"] / runs.GRAVITY)
    rows = []
    for k, t in enumerate(data["times"]):
        rows.append(
            {
                "time": t,
                "front_02": contact_front(result, t * unit, data["height"], 0.02),
                "front_05": contact_front(result, t * unit, data["height"], 0.05),
                "peak": result.at("peak_height", t * unit) / data["height"],
                "discs_front_02": data["front_02"][k],
                "discs_front_05": data["front_05"][k],
                "discs_peak": data["peak"][k],
            }
        )
    return rows


def agrees(row: dict[str, float], name: str) -> bool:
    return abs(row[name] / row[f"discs_{name}"] - 1) <= AGREEMENT


def contact_dynamics(results: Collection) -> str:
    parts = []
    for a in ref.CONTACT_DYNAMICS:
        result = results(runs.contact_dynamics(a))
        if not result:
            parts.append(f"**a = {a:g}**: {results.absent[runs.contact_dynamics(a).name]}.")
            continue
        rows = []
        for row in contact_rows(result, a):
            cells = [f"{row['time']:g}"]
            for name, digits in (("front_02", 2), ("front_05", 2), ("peak", 3)):
                cells += [
                    fixed(row[name], digits),
                    fixed(row[f"discs_{name}"], digits),
                    ("yes" if agrees(row, name) else "**no**") + f" ({percent(row[name], row[f'discs_{name}'], 0)})",
                ]
            rows.append(cells)
        parts.append(
            f"**a = {a:g}**, {result.summary['particles']:.0f} particles, {cpu(result.cpu)} CPU s\n\n"
            + table(
                [
                    "t / √(H0/g)",
                    "front, h > 0.02 H0",
                    "discs",
                    "within 10 %",
                    "front, h > 0.05 H0",
                    "discs",
                    "within 10 %",
                    "peak",
                    "discs",
                    "within 10 %",
                ],
                rows,
            )
        )
    return "\n\n".join(parts)


def codes(results: Collection) -> str:
    rows = []
    for r in runs.CODE_RESOLUTIONS:
        result = results(runs.code_run(r))
        if not result:
            rows.append(["granperi, default", "peridynamic particles", str(r)] + [NONE] * 6)
            continue
        long = result.summary["time"] >= 3
        rows.append(
            [
                "granperi, default",
                "peridynamic particles",
                str(r),
                cpu(result.cpu / result.summary["time"]),
                fixed(peak(result)),
                fixed(peak(result, 3.0)) if long else NONE,
                *(
                    fixed(result.summary[name], 2) + ("" if long else f" at {result.summary['time']:g} s")
                    for name in ("run_out_90", "run_out_98", "tip")
                ),
            ]
        )
    for code, method, r, seconds, early, late, run_out, inflated in ref.INDEPENDENT_CODES:
        rows.append(
            [
                code,
                method,
                NONE if r is None else str(r),
                NONE if seconds is None else f"{seconds:g}{' *' if inflated else ''}",
                fixed(early),
                fixed(late),
                NONE,
                NONE,
                fixed(run_out, 2),
            ]
        )
    return (
        table(
            ["code", "method", "L/dl", "CPU s per simulated s", "peak y/L at 0.42 s", "at 3 s", "run-out of 90 % at 3 s",
             "98 %", "tips"],
            rows,
        )
        + "\n\n\\* while the machine had other work: inflated by some 10 to 30 %."
    )


def couette(results: Collection) -> str:
    names = {
        1: "d = 1 mm, P = 102.3 Pa, U = 0.0003 m/s",
        2: "the same, U = 0.0013 m/s",
        3: "Cawthorn's cell: d = 2.5 mm, P = 1600 Pa, U = 2.5 m/s",
    }
    rows = []
    for case in runs.COUETTE_CASES:
        result = results(runs.couette(case))
        if not result:
            rows.append([names[case]] + [NONE] * 4)
            continue
        depth, ours, theory = couette_profile(result)
        deep = depth > 5
        rows.append(
            [
                names[case],
                significant(result.summary.get("error"), 2),
                significant(float(abs(ours[deep]).max()) if deep.any() else None, 2),
                significant(float(abs(theory[deep]).max()) if deep.any() else None, 2),
                cpu(result.cpu),
            ]
        )
    return table(["cell", "largest error of u/U", "largest u/U below 5 d", "exact, below 5 d", "CPU s"], rows)


def exact(results: Collection) -> str:
    """Error, order and cost by resolution, and what the names do not say."""
    rows = []
    for case, (_, _, all_r, _) in runs.EXACT_CASES.items():
        before: tuple[int, float] | None = None
        for r in all_r:
            run = runs.exact(case, r)
            result = results(run)
            error, meaning = exact_error(result) if result else (math.nan, "")
            order = None
            if error > 0 and before and before[1] > 0:
                order = math.log(before[1] / error) / math.log(r / before[0])
            rows.append(
                [
                    case,
                    str(r),
                    significant(error),
                    meaning,
                    fixed(order, 2),
                    f"{result.summary.get('particles', math.nan):.0f}" if result else NONE,
                    significant(result.cpu, 2) if result else results.absent[run.name],
                ]
            )
            before = (r, error) if error > 0 else None
    return table(["case", "resolution", "error", "of", "order", "particles", "CPU s"], rows) + """

Bagnold's flow begins with the exact solution, h = 4 cm = 20 d, and departs from it as slowly as it would start up, within one to three
seconds. Without an angle it is that at 26°, after 1.5 s; at the other angles it is looked at after 4 s. Boxes are 12 dl wide, at 28°
also 48 dl: a narrow layer jumps as a whole there. u is the speed of its surface;
at 23 and 24° c0 is more than 10 u, so that the weight of the layer compresses it by 0.4 % at most. What is left there is the elastic
stress, which lags behind the turning of the material and bears some of the weight: it goes with 1/c0², as twice that c0 shows. The start-up is from rest, to
0.15 s; what follows is [below](#from-rest-on-an-incline)."""
