#!/usr/bin/python3
"""Writes docs/performance.md and its figures from the results of the runs. No result is typed in here."""
from __future__ import annotations

import functools
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "common"))

import beside
import document
import headlines
import lean
import repeated
import runs
import sections
from document import bullets, tidy, write_report
from measures import AIM
from peers import ANOTHER_MACHINE
from plots import FIGURES
from results import Collection
from run import cheapest_first

figure = functools.partial(document.figure, "performance")

OTHERS_CAPTION = "Error of one run against CPU time: a = 5 (L/dl = 8 to 32) and one side (L/dl = 20 to 80). Bars: two standard errors"
EXACT_CAPTION = (
    "Exact solutions: error against CPU time; along a line the resolution doubles. Symbols without a line: resolution 20, "
    "horizon 4"
)
GROWTH_CAPTION = "CPU time of a step and memory against the number of particles"


def compose(collection: Collection, drawn: set[str]) -> str:
    body = f"""## Error against run time: collapses

Columns of glass beads on a rough floor, released at once: both sides, a = 1.25 (0.08 m wide, 0.05 m high), a = 5 (0.08 m,
0.20 m), and one side beside a smooth wall (0.20 m, 0.14 m, grains of 0.7 mm). Peak and run-out (x - L0)/L0 at 1 s. There
are several run-outs, since a film of single particles, thinner than 0.05 H, runs ahead of the deposit. If it is about a
spacing thick (not measured), it holds some 2 % of the mass on each side at L/dl = 32, 1 % at 64: so the run-out of *98 %* of
the mass ends inside it at coarse spacings and outside of it at fine ones. That of *90 %* ends behind it. That of the *front*
is where the deposit is 0.05 H thick, a spacing at L/dl = 32; that of the *tips*, the ends of the connected deposit, is the
film's. "The error" is that of the peak and the run-out of 90 % of the mass, whichever is larger.

The flow is chaotic: every setting is an ensemble of runs whose particles start up to {runs.JITTER:g} dl beside each
other's. *Bias* is the error of their mean, ± two standard errors (those of the converged solution included). *One run* is
the root mean square error of its runs: bias and scatter together, what somebody who runs the scene once has to reckon with.
CPU s are those of one run to 1 s, per simulated second, at rest or not.

### The converged solution

The default scheme at the finest spacing that was run. In the last column of each quantity the bias of the next coarser
ensemble against it: what is left to converge is of that order, and errors below it are not known.

{sections.convergence(collection)}

### a = 1.25

The figure is at the head of this page. \\*: no other setting that was run is both cheaper and better (the error of one run, peak
or run-out whichever is larger).

{sections.errors(collection, "a1.25")}

### Other codes

Runs of the same column with the same μ(I) law, instant release, with public codes
([references.py](../bench/validation/references.py)), one thread, peak and front at 3 s. CPU s: ours on the machine of [this
page](#how-these-numbers-were-made), others on {ANOTHER_MACHINE}. Matter's sound speed is
10 m/s, as ours by default, ten times the fastest flow; "E = 1e6 Pa" is a stiffer one. Their errors are against our converged solution,
so that they say how far the codes are apart, not who is right; their front is compared with our tips.

{sections.peers(collection)}

{beside.machines(collection)}

Throughput of public particle codes ([peers.py](../bench/performance/peers.py)), one thread, machines as above:

{sections.throughput(collection)}

### a = 5 and one side

{figure("others", drawn, OTHERS_CAPTION)}

a = 5:

{sections.errors(collection, "a5")}

One side:

{sections.errors(collection, "one_side")}

### Does a narrower horizon pay?

At the same spacing; in brackets horizon 4. Bias, but in the last column one run.

{sections.horizons(collection)}

### The cheapest settings

The cheapest setting of the default scheme with which one run of a = 1.25 errs by less than the aim, as
do all finer ones of the same setting; without the horizons with which the error of an exact solution grows on refinement to more
than {100 * sections.COUNTS:g} %. Options not named are the library's.

{sections.recommended(collection)}

The library's own `horizon` stays at 4 dl. 3 dl was tried as the default; what it loses is robustness, which counts for more
there. Deposits of few spacings come to rest less reliably ([stability.md](stability.md#coarse-deposits-and-the-horizon)). Of the tests
of extreme scenes nine failed with it (once, by hand): three rows of grains on a rough floor still moved by 0.04 dl from 1 to 2 s, and
two and two grains that met in free space left with up to 7 times their kinetic energy, where with 4 dl none gain any. With 24
neighbours that bear weight in place of 44, four grains are as much of a neighbourhood as a quarter plane is, and the operators cannot
tell them apart. {sections.orders(collection)}

## Error against run time: exact solutions

Error and, in brackets, CPU s. Scenes and exact solutions as in [validation.md](validation.md#exact-solutions). Free fall
and the power identity hold to 1e-12 at any setting and are tests.

{sections.exact(collection)}

{figure("exact", drawn, EXACT_CAPTION)}

{sections.exact_varied(collection)}

## What a scene does not need

The smallest scene: a block of 640 particles collapses on a floor, without penalty, diffusion, bulk viscosity and
collisions. One feature at a time is added; steps of both scenes run in turn, and the ratio of their CPU times is the median
of 41. *Idle*: it is there, with nothing to do. Instructions are callgrind's, of the steps alone, and do not depend on the
load of the machine. What is used changes the flow, too: a block between walls makes its lists less often.

{lean.unused(collection)}

{lean.features(collection)}

A plate out of reach of all material leaves the plan (`gp_get_plan`), and its ghosts with it.

### Builds

{lean.builds(collection)}

{lean.start(collection)}

## Memory and growth

{lean.memory(collection)}

{lean.linear(collection)}

{figure("growth", drawn, GROWTH_CAPTION)}

"At rest": a column between smooth walls, the same work per particle at every size; its lists are not made anew. "In flow":
the collapse from {runs.FLOW_FROM:g} s on. Measured {runs.REPEAT} times, one after the other: what other guests of the host take of
caches and memory changes these figures by a third within minutes, so the least says more of the library than the median.

{lean.growth(collection)}

## Threads

`bench/step` in the middle of the collapse: one thread, two, and two programs of one thread each side by side, in turn; wall-clock
times, medians of nine. Two programs share nothing but the machine: what they do together, in the work of one alone, is what
two threads could at most.

{lean.threads(collection)}

## Recommended settings, with sleep

[settings.md](settings.md): what a draft, a standard and a fine run cost and err with `sleep`, of settings that also hold where the cheapest do not;
`granperi.settings` in Python takes these.

## The hot path

[hot-path.md](hot-path.md): what a step costs and what was done about it, each change with prediction and measurement, written by
hand.
"""
    head = f"""# Performance

{beside.lead(collection)}

{figure("collapse", {"collapse"}, beside.caption(collection))}

## In short

Costs are CPU time, errors below {100 * AIM:g} % are the aim.

{bullets(sections.in_short(collection) + lean.in_short(collection))}

"""
    said = f"Every number is measured by a run or cited. {lean.machine(collection)}"
    end = document.footer(collection, "performance", "scripts/performance", said)
    return tidy(f"{head}{body}\n{headlines.section(repeated.rows(collection))}\n\n{end}")


if __name__ == "__main__":
    write_report("performance", __doc__.splitlines()[0], FIGURES, cheapest_first(runs.studies()), compose)
