#!/usr/bin/env python3
"""Errors and costs of granperi.settings (docs/settings.md): collapses at several spacings and horizons, as rows of Markdown.

    PYTHONPATH=build/python /usr/bin/python3 bench/performance/settings.py --only a125 --horizons 3 --resolutions 16 24

Glass beads on a rough floor, released at once, to 1 s with sleep: both sides, a = 1.25 (0.08 m wide, 0.05 m high) and a = 5
(0.20 m high), and one side beside a smooth wall (0.20 m, 0.14 m, grains of 0.7 mm). Peak y/L, and the run-out x/L0 - 1 behind
which 90 % of the mass lie, against the finest of docs/performance.md. Runs of an ensemble begin with particles up to 0.01 dl beside each other's; "one
run" is the root mean square error of its runs, bias and scatter together. CPU s are the median run's, to 1 s and until it
rests (looked at each 0.05 s).
"""
from __future__ import annotations

import argparse
import dataclasses
import math
import sys
import time
from pathlib import Path

import numpy as np

import granperi

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "common"))

from converged import converged  # noqa: E402

END, LOOK = 1.0, 0.05  # s


@dataclasses.dataclass(frozen=True)
class Scene:
    label: str
    length: float  # m
    height: float  # m
    sides: int
    diameter: float  # m
    resolutions: tuple[int, ...]  # spacings in the length


SCENES = {
    "a125": Scene("both sides, a = 1.25", 0.08, 0.05, 2, 0.002, (16, 24, 32, 48, 64)),
    "a5": Scene("both sides, a = 5", 0.08, 0.20, 2, 0.002, (10, 15, 20, 25)),
    "one": Scene("one side, a = 0.7", 0.20, 0.14, 1, 0.0007, (20, 30, 40)),
}


@dataclasses.dataclass(frozen=True)
class Run:
    peak: float
    runout: float
    cpu: float
    cpu_to_rest: float


def run(scene: Scene, resolution: int, seed: int, **config: float) -> Run:
    begin = time.process_time()
    sim = granperi.Simulation(spacing=scene.length / resolution, jitter=0.01, seed=seed, threads=1, **config)
    with sim:
        beads = sim.add_material(grain_diameter=scene.diameter)
        left = -scene.length / 2 if scene.sides == 2 else 0.0
        sim.add_column(x_min=left, width=scene.length, height=scene.height, material=beads)
        sim.add_plate(granperi.Plate.floor(-3 if scene.sides == 2 else 0, 3))
        if scene.sides == 1:
            sim.add_plate(granperi.Plate.wall(0, 0, 1.5 * scene.height, material="right", friction="free_slip"))
        rest = math.nan
        for k in range(1, round(END / LOOK) + 1):
            sim.run(k * LOOK)
            if math.isnan(rest) and sim.state.at_rest:
                rest = time.process_time() - begin
        peak, cpu = sim.state.peak_height, time.process_time() - begin
        marks = (0.05, 0.95) if scene.sides == 2 else (0, 0.9)
        left, right = np.quantile(sim.x, marks, method="hazen")  # as x_q05, x_q95 of gp_state are
    reach = right - left if scene.sides == 2 else right
    return Run(peak / scene.length, reach / scene.length - 1, cpu, rest)


def errors(values: list[float], reference: float) -> tuple[float, float, float]:
    """Bias, its two standard errors, and the error of one run, relative."""
    relative = np.array(values) / reference - 1
    return (relative.mean(), 2 * relative.std(ddof=1) / math.sqrt(len(relative)) if len(relative) > 1 else math.nan,
            math.sqrt((relative**2).mean()))


def row(name: str, resolution: int, horizon: float, runs: list[Run]) -> str:
    scene = SCENES[name]
    cells = [f"{horizon:g}", str(resolution), f"{resolution * min(1, scene.height / scene.length):.0f}",
             f"{np.median([r.cpu for r in runs]):.2f}", f"{np.median([r.cpu_to_rest for r in runs]):.2f}"]
    for what, reference in zip(("peak", "runout"), converged(name)):
        bias, spread, one = errors([getattr(r, what) for r in runs], reference)
        cells += [f"{100 * bias:+.1f} ± {100 * spread:.1f} %", f"{100 * one:.1f} %"]
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=8, help="runs of each ensemble [8]")
    parser.add_argument("--only", choices=SCENES, nargs="+", default=list(SCENES), help="scenes [all]")
    parser.add_argument("--horizons", type=float, nargs="+", default=[2.5, 3, 4], help="spacings [2.5 3 4]")
    parser.add_argument("--resolutions", type=int, nargs="+", help="spacings in the length [those of the scene]")
    parser.add_argument("--cfl", type=float, default=0, help="0: the scheme's own [0]")
    options = parser.parse_args()
    for name in options.only:
        scene = SCENES[name]
        print(f"\n{scene.label}\n", flush=True)
        print("| horizon | L/dl | over the smaller side | CPU s to 1 s | to rest | peak | one run | run-out, 90 % | one run |")
        print("|" + "---:|" * 9)
        for horizon in options.horizons:
            for resolution in options.resolutions or scene.resolutions:
                runs = [run(scene, resolution, seed, horizon=horizon, cfl=options.cfl, sleep=1)
                        for seed in range(1, options.runs + 1)]
                print(row(name, resolution, horizon, runs), flush=True)


if __name__ == "__main__":
    main()
