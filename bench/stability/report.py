#!/usr/bin/python3
"""Writes docs/stability.md and its figures from the results of the runs. No result is typed in here."""
from __future__ import annotations

import functools
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "common"))

import deposit
import document
import headlines
import long_shear
import repeated
import runs
import sections
import theory
import verdicts
from coefficients import CRITERION, SCENE
from document import bullets, tidy, write_report
from plots import FIGURES
from results import Collection
from run import cheapest_first

figure = functools.partial(document.figure, "stability")

SENSITIVITY_CAPTION = (
    f"Change of the deposit against the defaults, in per cent, with two standard errors. Grey: {100 * CRITERION:g} %; yellow: "
    "half to twice the default, of the horizon 2.5 to 6"
)
LIMITS_CAPTION = (
    "Largest time steps of the collapse. Full: calm, hollow: makes no energy. Grey line: what the library allows in the "
    "paper's schemes; in the others it is 0.6 of the dotted one"
)
CREEP_CAPTION = "Peak and rms speed against time, by time step (full) and by delta (dashed); 1e-9 and less drawn as 1e-9"
DRIFT_CAPTION = (
    "Left: largest displacement since 3 s. Right: kinetic energy. The lines of a scheme are from light to dark in the order of the table above"
)


def compose(collection: Collection, drawn: set[str]) -> str:
    body = f"""## Which settings change my result

The scene of this report: a column of glass beads, {runs.WIDTH:g} m wide and {runs.HEIGHT:g} m high (a = 1.25), released at
once; L/dl = 32 unless a table says otherwise. "Run-out" is (x - L0)/L0 with L0 = L/2, mean of both sides, of the points between
which 90 and 98 % of the mass lie.

The criterion: no coefficient of the scheme changes the deposit by more than {100 * CRITERION:g} % when it is set to half or twice its
default (`collision_distance` up to 1, the largest that the library takes; `horizon` from 2.5 to 6).

{bullets(verdicts.criterion(collection))}

The figure is at the head of this page.

The sound speed is the measure of the penalty, of bulk viscosity and of density diffusion, and sets the number of steps:
most of what it changes is what twice or half of these four do by themselves. Collisions take what particles of a row that is
sheared approach each other by, in every step in which they do: with a smaller distance the deposit runs farther, but particles
of flowing layers pair.

### The criterion

"Within doubt": the scatter left is larger than the distance to {100 * CRITERION:g} %; ± is two standard errors of the difference of two
ensembles' means.

{deposit.criterion(collection)}

### Every coefficient

Bold: the default. "At rest" is the time from which `gp_state.at_rest` stays 1; in brackets the share of the runs for which
it does so before 1 s, if not all. The ledger error is the largest of all runs at any time. The last coefficients, from
{SCENE[0].name} on, are of the scene or of the material and stand for comparison.

{deposit.sensitivity(collection)}

{deposit.threads(collection)}

### Constants that are no settings

Each with a library in which it alone has half or twice its value ([constants.py](../bench/stability/constants.py)), against the
defaults; {runs.CONSTANT_SEEDS} runs, ± is two standard errors.

{verdicts.constants(collection)}

{deposit.constants(collection)}

### The horizon

Against the finest, L/dl = {runs.FINEST}, with the default of 4.

{deposit.horizons(collection)}

A horizon of 3, which costs as much at the same spacing, is not the default. By the sources of commit 6fbe2c5 (November 2026; not measured by this report) with it a
drum and bowls of 24 and 96 plates did not come to rest, few grains that met or fell on a floor gained energy, a layer of ten rows on
26° was 3 % slow, and more than twice as much of a front on 16° came off.

### The yardstick: the scatter of a run

The flow is chaotic. Runs whose particles start {runs.JITTER:g} dl at most beside each other's end in deposits that differ by

{deposit.scatter(collection)}

Scatter is the standard deviation of one run.

### What to set

{deposit.recommended()}

{deposit.dissipation(collection)}

## Largest time step

Counted in dl / wave speed; the wave speed is c0 √1.3 in the default scheme, whose shear modulus is 0.3 of the bulk modulus,
else c0. `gp_config.allow_unstable_step` lets the library go beyond its limit. Found by bisection. A step

- *makes no energy* while kinetic + potential + elastic energy stay below 1.001 E0;
- is *calm* if besides the ledger's error stays below 0.02 E0 (or twice that of the smallest step, where the scheme loses
  count at any step), the kinetic energy in the last tenth of the run below 1e-5 E0 in the collapse and 1e-7 E0 in the layer
  (or three times that of the smallest step), and the highest pressure below three times that of the smallest step;
- leaves *the same deposit* if besides the peak is within 2 % of the smallest step's. A single run with L/dl = 16 scatters by
  nearly as much: the column says less there.

### Against theory

A layer at rest, jittered by 0.05 dl, on its rough floor. Symplectic Euler is stable while ω² dt² + 2 λ dt ≤ 4, ω the
highest frequency of the discrete operators and λ the damping of bulk viscosity and penalty
([theory.py](../bench/stability/theory.py)). Beside a free surface a particle has neighbours on one side only, its inverse
shape tensor is larger, and so is ω: there the noise begins. It stays bounded, since the yield stress takes what it makes;
energy is made where the interior is unstable, too. Of the implicit scheme the waves of pressure are explicit, and theory has
these alone: no shear modulus, no viscosity of shear.

{sections.theory_of_layer(collection)}

{verdicts.against_theory(collection)}

The paper's schemes are far beyond the limit of their viscosity, λ dt ≤ 2 with λ of the order of μ p / (ρ δ dl²), at any
step: |τ| ≤ μ p alone bounds what it does. They tremble the more the longer the step, and no step is calm in the sense of the
default scheme: "calm" here is no more restless than three times the smallest step.

{sections.theory_of_paper(collection)}

### The map

The same deposit / calm / makes no energy, collapse:

{sections.limits(collection)}

{figure("limits", drawn, LIMITS_CAPTION)}

## Creep

Without a true yield the material creeps: the regularised viscosity is at most μ p / δ, and stepped explicitly no more than
about ρ dl² / dt of it acts, as if δ were dt μ p / (ρ dl²) (the column below, at a quarter of H).

{sections.creep(collection)}

{figure("creep", drawn, CREEP_CAPTION)}

## At rest for a minute

Displacements of the particles of the deposit from {runs.DRIFT_FROM:g} s on.
The regularised law has no yield: under GP_STRESS_IMPLICIT all of the deposit creeps, the slower the smaller delta is.

{sections.drift(collection)}

{figure("drift", drawn, DRIFT_CAPTION)}

### Coarse deposits and the horizon

Of {runs.MORE_SEEDS} collapses of 40 (L/dl = 8) and 160 (16) particles those that `gp_state.at_rest` sees at rest before 1 s and for
{runs.RESTED:g} s. Large grains have the friction mu_2 at any rate: steep heaps, with single grains on their flanks.

{sections.coarse(collection)}

{sections.coarse_in_words(collection)}

## Forty seconds of shear

A layer of 20 d on an incline of {long_shear.ANGLE}°, its particles on the lattice or jittered, over {long_shear.END:g} s: mean height over
that of the start; velocity of the uppermost row over Bagnold's at its height, of 12 particles at one instant, and the mean
of the four. In 0.1.0 density did not follow the spacing of the particles, and layers sank without end: with h/dl = 10 by 28 % within
12 s.

{long_shear.section(collection)}

## Pressure noise

Noise: rms departure of a particle's pressure from the plane fitted to its neighbours' within 4 dl, over ρ g H.

{sections.pressure(collection)}

{figure("pressure", drawn, "Highest pressure and noise of the pressure during and after the collapse")}

## Zero-energy modes

A layer at rest on the lattice is given velocities of alternating sign, ±1e-4 c0, by particles (checkerboard) or by rows
(stripes). The gradient sees nothing of them; the penalty damps them at a rate that follows from the lattice. A layer at rest
is inside its yield surface: there the penalty is at least {theory.ELASTIC_PENALTY:g}, whatever the coefficient, unless that is 0. Without it
they still lose energy to floor, free surface and collisions.

{figure("modes", drawn, "Decay of velocities that the gradient does not see; dotted: theory of the penalty alone")}

Decay rates of the kinetic energy in c0/dl:

{sections.modes(collection)}

Change of the deposit of the collapse, most of which flows, against the default 0.02, and the penalty's share of what it
dissipates:

{sections.penalties(collection)}

## Resolution and size

Ensembles to their rest; ± is two standard errors. `scripts/stability --long` adds L/dl = 256 and 512, hours of one core, and the
run with a million particles.

{sections.resolution(collection)}

{figure("resolution", drawn, "Peak, run-out and run time against the resolution")}

{sections.million(collection)}

## What each preset cannot do

{bullets(verdicts.cannot(collection))}

[validation.md](validation.md) has what the schemes make of the paper's scenes, experiments and exact solutions.
"""
    head = f"""# Stability and sensitivity

{verdicts.in_short(collection)}

{figure("sensitivity", drawn, SENSITIVITY_CAPTION)}

"""
    said = "Every number is measured by a run or computed from the theory that is named."
    end = document.footer(collection, "stability", "scripts/stability", said)
    return tidy(f"{head}{body}\n{headlines.section(repeated.rows(collection))}\n\n{end}")


if __name__ == "__main__":
    write_report("stability", __doc__.splitlines()[0], FIGURES, cheapest_first(runs.studies()), compose)
