"""What a spacing costs and errs, estimated from two coarser runs."""
from __future__ import annotations

import dataclasses
import math
import time
from typing import Any

from ._errors import ArgumentError, number
from ._scene import Scene, scene_of

QUANTITIES = ("peak_height", "x_left", "x_right")


@dataclasses.dataclass(frozen=True)
class Estimate:
    """At one spacing: CPU seconds, and the error [m] of peak and fronts at the end, as Richardson extrapolation has it.

    values: what the quantity will be there; errors: its distance from the limit of zero spacing. measured: it was run.
    """

    spacing: float
    cpu_seconds: float
    values: dict[str, float]
    errors: dict[str, float]
    measured: bool


class Report(list):
    """Estimates from the coarsest to the finest spacing; print() shows a table."""

    def __init__(self, rows: list[Estimate], end: float, cost_order: float, order: float):
        super().__init__(rows)
        self.end, self.cost_order, self.order = end, cost_order, order

    def __str__(self) -> str:
        lines = [f"at {self.end:g} s; errors for order {self.order:g}, "
                 f"cost grows as spacing^-{self.cost_order:.2f}",
                 f"{'spacing (m)':>12} {'CPU (s)':>9}" + "".join(f" {name + ' (m)':>17} {'error':>9}" for name in QUANTITIES)]
        for row in self:
            lines.append(f"{row.spacing:>12.5g} {row.cpu_seconds:>9.3g}" + "".join(
                f" {row.values[name]:>17.5f} {row.errors[name]:>9.1e}" for name in QUANTITIES)
                + ("  run" if row.measured else "  estimated"))
        return "\n".join(lines)


def _measure(scene: Scene, spacing: float, end: float) -> tuple[float, int, dict[str, float]]:
    begin = time.process_time()
    with scene.build(spacing) as sim:
        if not sim.n_particles:
            raise ArgumentError(f"{scene.name}: has no particles to estimate errors of")
        sim.run(end)
        state = sim.state
        cpu = time.process_time() - begin
        return cpu, state.step, {name: getattr(state, name) for name in QUANTITIES}


def estimate(scene: Any, end: float | None = None, order: float = 1.0) -> Report:
    """What the scene's spacing, and half of it, would cost and gain.

    Runs the scene (a Scene or the path of one) to `end` [s] at four times and at twice its spacing, which takes about a
    seventh of the time of the run itself. From the two it extrapolates each quantity as f0 + C spacing^order, and the CPU
    time by the particles and the steps. Two runs cannot tell whether the order is right: 1 is what the collapses have. The
    estimate is rough where grains of the coarse runs are few (a column of less than ten spacings).
    """
    scene = scene_of(scene)
    end = scene.run.end if end is None else number("end", end)
    order = number("order", order)
    if not 0.1 <= order <= 4:
        raise ArgumentError(f"order = {order:g}: expected a number from 0.1 to 4")
    h = scene.config.spacing
    (fine_cpu, fine_steps, fine), (coarse_cpu, coarse_steps, coarse) = (_measure(scene, k * h, end) for k in (2, 4))
    # Particles grow as spacing^-2, steps as measured; the work of a particle in a step is that of the finer run.
    cost_order = 2 + math.log2(max(fine_steps, 1) / max(coarse_steps, 1))
    slope = {name: (coarse[name] - fine[name]) / ((4 * h) ** order - (2 * h) ** order) for name in QUANTITIES}
    limit = {name: fine[name] - slope[name] * (2 * h) ** order for name in QUANTITIES}

    def row(spacing: float, measured: dict[str, float] | None, cpu: float) -> Estimate:
        errors = {name: abs(slope[name]) * spacing**order for name in QUANTITIES}
        values = measured or {name: limit[name] + slope[name] * spacing**order for name in QUANTITIES}
        return Estimate(spacing, cpu, values, errors, measured is not None)

    return Report([row(4 * h, coarse, coarse_cpu), row(2 * h, fine, fine_cpu), row(h, None, fine_cpu * 2**cost_order),
                   row(h / 2, None, fine_cpu * 4**cost_order)], end, cost_order, order)
