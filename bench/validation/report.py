#!/usr/bin/python3
"""Writes docs/validation.md and its figures from the results of the runs. No number is typed in here."""
from __future__ import annotations

import functools
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "common"))

import body_sections as bodies
import convergence_section as convergence
import document
import every_case
import figures
import fluid_sections as fluidity
import headlines
import hopper_section as hopper
import paper_sections as paper
import physics_sections as physics
import references as ref
import repeated
import runs
import verdicts
import wall_sections as walls
from document import bullets, tidy, write_report
from results import Collection

SCALING_SOURCES = (
    "Lube et al. (2005) and Lajeunesse et al. (2005) are experiments in channels, Staron & Hinch (2005) contact "
    "dynamics of discs, Lagrée et al. (2011) a μ(I) continuum, both in two dimensions without side walls."
)

RUN_TIME_CAPTION = (
    "Error against run time. Left: from the experiment, which says how good the model is. Right: from the finest grid "
    "of the same code, which says how good the numerics are (0.05 % and less drawn as 0.05 %)"
)
CASES_CAPTION = "Every case with a right answer: how far it is off, over how far it may be. The table below says what is asked"
CONVERGENCE_CAPTION = "Peak and run-out of 90 % of the mass against the spacing: off the finest run. Grey: what is asked"
PEAK_CAPTION = "Highest point against time. Above: the schemes; below: horizons, the paper's figure 4"

figure = functools.partial(document.figure, "validation")


def compose(collection: Collection, drawn: set[str]) -> str:
    disagreements = verdicts.disagreements(collection)
    body = f"""## Every case

{every_case.section(collection)}

## Every scene of the paper

Jin, Lu, Tai & Xu (2021) print few numbers; most of their comparisons are figures, so that only these can be set beside
ours. "As printed" is their scheme with the factor 2 of their equation 3.12, "factor 1" the same with μ(I) p as the
stress of simple shear. The default scheme has no side walls; "side walls" has the friction of a channel's walls
({runs.CHANNEL_WIDTH:g} m apart, coefficient {runs.CHANNEL_FRICTION:g}; for the one-sided column those of its own
channel, {runs.SIDE_CHANNEL[0]:g} m and {runs.SIDE_CHANNEL[1]:g}), "raised friction" has
{ref.RAISED_MU_S_DEGREES:g}° and {ref.RAISED_MU_2_DEGREES:g}° in place of 21° and 32°
({ref.IONESCU}).
The gates clear their columns in {runs.DEFAULT_LIFT_TIME:g} s: the paper gives their motion as a figure only. CPU s are
those of the whole run.

{paper.main_table(collection)}

## Both sides, a = 1.25

H = 0.05 m, L = 0.08 m, d = 2 mm, L/dl = 32; the {ref.XU2017}.

{figure("both_side", drawn, "Free surfaces; dotted: the column at the start. The paper's figures 3 and 8")}

{figure("peak_in_time", drawn, PEAK_CAPTION)}

{figure("velocity", drawn, "Horizontal velocity on two sections at two instants, the paper's figure 5")}

### Horizon

Peak y/L of a = 1.25, L/dl = 32:

{paper.horizon(collection)}

### Resolution

{paper.resolution(collection)}

{figure("resolution", drawn, "Peak and run-out at 0.42 s against the resolution")}

{figure("run_time", drawn, RUN_TIME_CAPTION)}

### Raised friction, gates gone at once

{paper.raised(collection)}

### Side walls

The friction of a channel's walls per volume is 2 mu_w p / W: what counts is mu_w / W. At 1.8 per metre, the channel of
Mangeney et al. (2010) with 0.1 m and 0.18, the walls do next to nothing to this low column: the layer that flows last is
thin, and its pressure on the walls low. The paper does not give the width of its channel. The experiment's peak asks for
about 12 per metre: a channel ten grains wide ({runs.CHANNEL_WIDTH:g} m) with the friction of glass on Plexiglas
({runs.CHANNEL_FRICTION:g}). That is a plausible channel, not a known one; "side walls" in this report stands for it.
Instant release.

{paper.side_walls(collection)}

### Lifting of the gates

The gates' measured motion is published as a figure only; here they rise with uniform acceleration.

{paper.lift(collection)}

{figure("lift", drawn, "Highest point against time for several times of lifting, default scheme")}

## Both sides, a = 5

{figure("tall", drawn, "Free surfaces; dotted: the column at the start. The paper's figure 9")}

{paper.solid_speed(collection)}

{figure("solid_speed", drawn, "Speed on y/L = 0.25 at 1 s, the paper's figure 10 (1e-7 and less drawn as 1e-7)")}

## One side

H = 0.14 m, L = 0.20 m (section 5.2 of the paper swaps them), d = 0.7 mm, dl = 2.5 mm, smooth wall on the left; the
{ref.MANGENEY}.

{figure("one_side", drawn, "Free surfaces; dotted: the column at the start. The paper's figure 13")}

## Colliding columns, case I

{paper.colliding(collection)}

{figure("colliding", drawn, "Free surfaces; dotted: the columns at the start. The paper's figures 16 and 17")}

## Colliding columns, case II

{paper.interface(collection)}

{figure("interface", drawn, "The interface between the columns, the paper's figure 19")}

## Plane Couette flow with gravity

The program is [examples/c/couette.c](../examples/c/couette.c); set-up of the
{ref.COUETTE_SOURCE}.
"Exact" is the profile of the local μ(I) law, whose band of shear is thinner than a grain, and than a spacing, in the
first two cells: a wider band there comes from the numerics. These two run with the smallest horizon, 2.2 spacings. With
the default's 4 the rows below the plate move against it, by up to 0.3 U: rigid rows have no mean gradient over their
horizon, and the plate's motion is in that mean. A band thinner than the horizon is beyond the method: the exponential
profile that the paper finds there, some five grains deep, is as wide as its operators, not as the law.

{physics.couette(collection)}

{figure("couette", drawn, "Mean velocity below the dragged plate")}

## Run-out and height against the aspect ratio

a = H0/L0, default scheme with tan 21° and tan 32°, instant release, at 6 √(H0/g). {SCALING_SOURCES}
Published fronts are those of deposits without single grains that roll ahead: beside them stands the run-out of 98 % of the mass.

{physics.scaling(collection)}

{figure("scaling", drawn, "Run-out and final height against the aspect ratio")}

## Contact dynamics of discs

The data: {ref.CONTACT_DYNAMICS_SOURCE}.
Ours has the friction that Lagrée et al. (2011) use for the same data (μ_s = {ref.LAGREE_MU_S:g}, μ_2 = {ref.LAGREE_MU_2:g},
I0 = {ref.LAGREE_I0:g}, the discs' diameter), fitted to neither case; {runs.CONTACT_SPACINGS} spacings in H0. The front is
the outermost point at which the surface is above 0.02 or 0.05 H0. Single discs that roll ahead of the deposit count at
0.02 H0, as single particles do in ours, whose spacing is {1 / runs.CONTACT_SPACINGS:.3f} H0.

{physics.contact_dynamics(collection)}

{figure("contact_dynamics", drawn, "Front and peak against time, with the discs")}

## Independent codes

The column of a = 1.25, gates gone at once, with public codes: MPM and VOF at the same μ(I), which agree with each other on a peak of
{ref.CODES_PEAK_BAND[0]:.3f} to {ref.CODES_PEAK_BAND[1]:.3f}, and discs, {ref.DISCS_PEAK:.3f}.

{physics.codes(collection)}

## Convergence of collapses

{convergence.section(collection, figure("convergence", drawn, CONVERGENCE_CAPTION))}

## Exact solutions

{physics.exact(collection)}

{figure("exact", drawn, "Error against resolution and against run time")}

## Walls and inclines

{walls.section(collection)}

## Walls of plates, walls that turn

{bodies.section(collection)}

## A hopper

{hopper.section(collection, figure("hopper", drawn, "Flow rate over what is left above the outlet"))}

## Granular fluidity

{fluidity.section(collection, lambda name, caption: figure(name, drawn, caption))}

## Verdict on the factor 2

{verdicts.factor_two(collection)}

## What the non-locality contributes once the friction is the same

{verdicts.non_locality(collection)}

## What disagrees

{bullets(disagreements) if disagreements else "Nothing beyond the deviations in the tables."}
"""
    head = f"""# Validation

{verdicts.in_short(collection)}

{figure("every_case", drawn, CASES_CAPTION)}

"""
    said = "Every number is measured by a run or cited from [references.py](../bench/validation/references.py)."
    end = document.footer(collection, "validation", "scripts/validate", said)
    return tidy(f"{head}{body}\n{headlines.section(repeated.rows(collection))}\n\n{end}")


if __name__ == "__main__":
    write_report("validation", __doc__.splitlines()[0], figures.FIGURES, runs.all_runs(), compose)
