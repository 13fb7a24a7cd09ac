"""Sections of docs/validation.md on the scenes of Jin et al. (2021), in the order of the paper."""
from __future__ import annotations

import math

import references as ref
import runs
from markdown import NONE, cpu, fixed, percent, significant, table
from measures import interface_spread, peak, run_out_at, section_speed, surface_difference
from results import Collection, Result

# The interface is fitted between these fractions of its height: the foot is dragged by the floor, and the paper leaves
# out "the particles in the vicinity of the free surface" without saying how far down that is.
FIT = (0.1, 0.6)
OTHER_FITS = [(0.0, 1.0), (0.0, 0.8), (0.1, 0.6), (0.1, 0.8), (0.2, 0.5), (0.2, 0.8), (0.3, 0.7)]

# Local against non-local: as the paper may have had them, and with the same friction.
SPEED_RATIOS = (("local_1", "nonlocal_2"), ("local_1", "nonlocal_1"), ("local_2", "nonlocal_2"))


def label(scheme: str) -> str:
    return runs.SCHEMES[scheme].label


def rest_of(result: Result) -> str:
    s = result.summary
    return f"{s['at_rest_since']:.2f}" if s["at_rest"] else f"not by {s['time']:g}"


def main_value(scene: str, result: Result) -> float:
    """The number by which a scene is compared, in the unit of the main table."""
    if scene == "both_1.25":
        return peak(result)
    if scene == "both_5":
        return result.at("peak_height", 0.67) / ref.WIDTH
    if scene == "one_side":
        return result.summary["axis_height"]
    if scene == "colliding_1":
        return result.at("peak_height", 0.4)
    return abs(result.interface_angle(0.6, *FIT))


MAIN_ROWS = (  # scene, what is compared, digits, experiment, as the paper prints it by scheme
    (
        "both_1.25",
        "both sides, a = 1.25: peak y/L at 0.42 s",
        3,
        ref.EXPERIMENT_PEAK,
        {"nonlocal_2": ref.PAPER_PEAK[4.0]},
    ),
    ("both_5", "both sides, a = 5: peak y/L at 0.67 s", 3, None, {}),
    (
        "one_side",
        "one side: height beside the wall at 1.02 s (m)",
        4,
        ref.EXPERIMENT_WALL_HEIGHT,
        {"nonlocal_2": ref.PAPER_WALL_HEIGHT},
    ),
    ("colliding_1", "colliding, case I: peak at 0.40 s (m)", 4, None, {}),
    (
        "colliding_2",
        "colliding, case II: interface at 0.60 s (degrees to the vertical)",
        1,
        ref.EXPERIMENT_INTERFACE_ANGLE,
        ref.PAPER_INTERFACE_ANGLE,
    ),
)


def main_table(results: Collection) -> str:
    """All scenes and schemes: value, error against the experiment, CPU s."""
    parts = []
    for scene, title, digits, experiment, printed in MAIN_ROWS:
        rows = []
        for scheme in runs.MAIN_SCENES[scene]:
            result = results(runs.main_run(scene, scheme))
            value = main_value(scene, result) if result else None
            paper = printed.get(scheme)
            rows.append(
                [
                    label(scheme),
                    fixed(value, digits),
                    percent(value, experiment),
                    fixed(paper, digits),
                    percent(value, paper),
                    rest_of(result) if result else NONE,
                    cpu(result.cpu if result else None),
                    significant(result.summary["particle_steps_rate"], 2) if result else NONE,
                ]
            )
        rows.append(["experiment", fixed(experiment, digits) if experiment else "figure only", "", "", "", "", "", ""])
        parts.append(
            f"**{title}**\n\n"
            + table(
                [
                    "scheme",
                    "value",
                    "off the experiment",
                    "paper prints",
                    "off the paper",
                    "at rest since (s)",
                    "CPU s",
                    "particle-steps / CPU s",
                ],
                rows,
            )
        )
    return "\n\n".join(parts)


def horizon(results: Collection) -> str:
    rows = []
    times = (0.42, 1.0, 2.0, 3.0)
    for scheme, horizons in runs.HORIZON_STUDY.items():
        for h in horizons:
            result = results(runs.horizon_run(scheme, h))
            rows.append(
                [f"{label(scheme)}, {h:g} dl"]
                + [fixed(peak(result, t) if result else None) for t in times]
                + [percent(peak(result, 3.0), peak(result)) if result else NONE, cpu(result.cpu if result else None)]
            )
    for h, value in ref.PAPER_PEAK.items():
        creep = ref.PAPER_CREEP_2_2 if h == 2.2 else {}
        rows.append(
            [f"paper prints, {h:g} dl", fixed(value)]
            + [fixed(creep.get(t)) for t in times[1:]]
            + [percent(creep.get(3.0), value), ""]
        )
    rows.append([ref.XU2017, fixed(ref.EXPERIMENT_PEAK), "", "", "", "", ""])
    text = table(["scheme, horizon", "0.42 s", "1 s", "2 s", "3 s", "0.42 to 3 s", "CPU s"], rows)
    rows = []
    for scheme, resolutions in runs.HORIZON_LENGTH_STUDY.items():
        for r in resolutions:
            fixed_run, scaled_run = results(runs.horizon_length_run(scheme, r)), results(runs.resolution_run(scheme, r))
            rows.append(
                [
                    f"{label(scheme)}, L/dl = {r}",
                    f"{runs.HORIZON_LENGTH * r / ref.WIDTH:g} dl",
                    fixed(peak(fixed_run) if fixed_run else None),
                    fixed(peak(scaled_run) if scaled_run else None),
                    cpu(fixed_run.cpu_to(0.42) if fixed_run else None),
                    cpu(scaled_run.cpu_to(0.42) if scaled_run else None),
                ]
            )
    return (
        text
        + (
            "\n\nThe horizon is a number of spacings, so that it vanishes on refinement: it is numerical, not a length "
            f"of the material. With a fixed length of {1000 * runs.HORIZON_LENGTH:g} mm in its place, peak y/L at "
            "0.42 s:\n\n"
        )
        + table(
            [
                "scheme",
                "fixed length is",
                "fixed length",
                "horizon 4 dl",
                "CPU s to 0.42 s, fixed",
                "CPU s to 0.42 s, 4 dl",
            ],
            rows,
        )
    )


def resolution(results: Collection) -> str:
    rows = []
    for scheme, all_r in runs.RESOLUTION_STUDY.items():
        cells = []
        for r in runs.RESOLUTIONS:
            result = results(runs.resolution_run(scheme, r)) if r in all_r else None
            cells.append(f"{peak(result):.3f} ({cpu(result.cpu_to(ref.PEAK_TIME))})" if result else NONE)
        rows.append([label(scheme), *cells])
    rows.append(["paper prints", *[fixed(ref.PAPER_RESOLUTION.get(r)) for r in runs.RESOLUTIONS]])
    rows.append(["experiment", fixed(ref.EXPERIMENT_PEAK), "", "", ""])
    run_out = []
    for scheme, all_r in runs.RESOLUTION_STUDY.items():
        found = [results(runs.resolution_run(scheme, r)) if r in all_r else None for r in runs.RESOLUTIONS]
        run_out.append(
            [label(scheme), *[fixed(run_out_at(result, ref.PEAK_TIME) if result else None, 2) for result in found]]
        )
    header = ["scheme", *[f"L/dl = {r}" for r in runs.RESOLUTIONS]]
    return (
        "Peak y/L at 0.42 s, in brackets the CPU s to that instant:\n\n"
        + table(header, rows)
        + "\n\nRun-out (x - L0)/L0 of 90 % of the mass at 0.42 s, L0 = L/2:\n\n"
        + table(header, run_out)
    )


def side_walls(results: Collection) -> str:
    rows = []
    for ratio in runs.SIDE_WALLS:
        result = results(runs.side_walls(ratio))
        rows.append(
            [
                f"{ratio:g}",
                f"{ratio * runs.CHANNEL_WIDTH:.3g}",
                fixed(peak(result) if result else None),
                percent(peak(result) if result else None, ref.EXPERIMENT_PEAK),
                fixed(run_out_at(result, 0.42) if result else None, 2),
                cpu(result.cpu if result else None),
            ]
        )
    return table(
        [
            "friction / width, 1/m",
            f"coefficient, {runs.CHANNEL_WIDTH:g} m apart",
            "peak y/L at 0.42 s",
            "off the experiment",
            "run-out at 0.42 s",
            "CPU s",
        ],
        rows,
    )


def raised(results: Collection) -> str:
    """Raised friction, instant release, by resolution."""
    found = [(r, results(runs.raised_run(r))) for r in runs.RESOLUTIONS]
    rows = [
        [
            str(r),
            fixed(peak(result) if result else None),
            percent(peak(result) if result else None, ref.EXPERIMENT_PEAK),
            fixed(run_out_at(result, 0.42) if result else None, 2),
            cpu(result.cpu if result else None),
        ]
        for r, result in found
    ]
    return table(["L/dl", "peak y/L at 0.42 s", "off the experiment", "run-out at 0.42 s", "CPU s"], rows)


def lift(results: Collection) -> str:
    rows = []
    for t in runs.LIFT_TIMES:
        result = results(runs.lift_run(t))
        rows.append(
            [
                "instant" if t == 0 else f"{t:g} s",
                fixed(peak(result) if result else None),
                percent(peak(result) if result else None, ref.EXPERIMENT_PEAK),
                fixed(peak(result, 1.0) if result else None),
                fixed(run_out_at(result, 1.0) if result else None, 2),
                cpu(result.cpu if result else None),
            ]
        )
    return table(
        [
            "gates clear the column in",
            "peak y/L at 0.42 s",
            "off the experiment",
            "peak y/L at 1 s",
            "run-out at 1 s",
            "CPU s",
        ],
        rows,
    )


def solid_speed(results: Collection) -> str:
    rows = []
    values = {}
    for scheme in runs.MAIN_SCENES["both_5"]:
        result = results(runs.main_run("both_5", scheme))
        values[scheme] = section_speed(result, 1.0, 0.02) if result else math.nan
        scale = math.sqrt(runs.GRAVITY * 0.002)
        rows.append([label(scheme), significant(values[scheme] / scale, 2), cpu(result.cpu if result else None)])
    for local, other in SPEED_RATIOS:
        name = f"ratio of {label(local)} to {label(other)}"
        rows.append([name, significant(values[local] / values[other], 2), ""])
    rows.append(["local to non-local as the paper puts it", f"almost {ref.PAPER_LOCAL_SPEED_RATIO:g}", ""])
    return table(["a = 5, mean speed on y/L = 0.25 at 1 s", "\\|u\\| / √(g d)", "CPU s"], rows)


def interface(results: Collection) -> str:
    times = (0.15, 0.2, 0.4, 0.6)
    rows = []
    for scheme in runs.MAIN_SCENES["colliding_2"]:
        result = results(runs.main_run("colliding_2", scheme))
        if not result:
            rows.append([label(scheme)] + [NONE] * 6)
            continue
        low, high = interface_spread(result, 0.6, OTHER_FITS)
        rows.append(
            [
                label(scheme),
                *[fixed(abs(result.interface_angle(t, *FIT)), 1) for t in times],
                f"{fixed(low, 1)} to {fixed(high, 1)}",
                cpu(result.cpu),
            ]
        )
    for scheme, angle in ref.PAPER_INTERFACE_ANGLE.items():
        rows.append(
            [
                f"paper prints, {'local' if scheme.startswith('local') else 'non-local'}",
                "",
                "",
                "",
                fixed(angle, 1),
                "",
                "",
            ]
        )
    rows.append([ref.XU2019, "", "", "", fixed(ref.EXPERIMENT_INTERFACE_ANGLE, 1), "", ""])
    fits = ", ".join(f"{low:g}–{high:g}" for low, high in OTHER_FITS)
    return (
        f"Angle to the vertical in degrees, fitted between {FIT[0]:g} and {FIT[1]:g} of the height "
        "of the interface; the "
        "last column but one shows what the choice of these fractions is worth: the smallest and the largest of the "
        f"angles for {fits}.\n\n" + table(["scheme", *[f"{t:g} s" for t in times], "0.6 s, other fits", "CPU s"], rows)
    )


def colliding(results: Collection) -> str:
    """Case I: how far each scheme's surface is from the default's, there being no printed numbers."""
    times = (0.1, 0.2, 0.3, 0.4)
    base = results(runs.main_run("colliding_1", "default"))
    rows = []
    for scheme in runs.MAIN_SCENES["colliding_1"]:
        result = results(runs.main_run("colliding_1", scheme))
        if result and base and scheme != "default":
            cells = [fixed(1000 * surface_difference(base, result, t), 1) for t in times]
        else:
            cells = [NONE] * 4
        rows.append(
            [
                label(scheme),
                *cells,
                fixed(result.at("peak_height", 1.6) if result else None, 4),
                cpu(result.cpu if result else None),
                f"{result.summary['time']:g}" if result else NONE,
            ]
        )
    return (
        "The paper gives figures without numbers. Mean distance (mm) of each surface from that of "
        "the default scheme, and "
        "the peak of the deposit:\n\n"
        + table(["scheme", *[f"{t:g} s" for t in times], "peak at 1.6 s (m)", "CPU s", "run to (s)"], rows)
    )
