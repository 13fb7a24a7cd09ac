#!/usr/bin/python3
"""A drum turns and its filling flows: examples/c/drum.c in Python.

The surface comes to a slope between the yield angle and that of fast flow; the moment that keeps the drum turning does the
work that the flow dissipates.
"""
import math

import example
import numpy as np

import granperi

CORNERS, RADIUS, FILLING = 48, 0.1, 0.35  # m; share of the drum


def level_of(share):
    """The height below which a circle has this share of its area."""
    low, high = -1.0, 1.0
    while high - low > 1e-9:
        y = (low + high) / 2
        if (math.asin(y) + y * math.sqrt(1 - y * y)) / math.pi + 0.5 < share:
            low = y
        else:
            high = y
    return low * RADIUS


def main():
    parser = example.parser("Glass beads in a drum that turns, 0.2 m wide. Reference length: its radius.", resolution=40,
                            end=4.0, output="drum.h5", gates=False)
    parser.add_argument("--omega", type=example.number(0.01, 5), default=1.0, help="of turning, rad/s")
    options = parser.parse_args()
    spacing = RADIUS / options.resolution
    looks = []

    def look(sim):
        """Under a plane surface the centre of mass lies perpendicularly below the axis. From 1 rad on the slope is steady."""
        load = sim.plate_load(0)
        if load.angle >= 1:
            state = sim.state
            looks.append((math.atan2(state.centre_x, -state.centre_y), load.angle, -options.omega * load.impulse_torque,
                          state.dissipated))

    with example.create(options, spacing, 0.002) as sim:
        angle = -2 * math.pi * np.arange(CORNERS) / CORNERS
        corners = RADIUS * np.column_stack([np.cos(angle), np.sin(angle)])
        sim.add_plate(granperi.Plate.line(corners, closed=True, material="inside", omega=options.omega))
        level, inner = level_of(FILLING), RADIUS * math.cos(math.pi / CORNERS) - spacing / 2
        example.fill(sim, -RADIUS, RADIUS, -RADIUS, RADIUS, lambda x, y: (y < level) & (np.hypot(x, y) < inner))
        sim.set_callback(look, 100)
        example.run(sim, options)
        load, dissipated = sim.plate_load(0), sim.state.dissipated

    turned, work = load.angle, -options.omega * load.impulse_torque
    print(f"turned              {turned:.4f} rad")
    if len(looks) > 1:
        _, angle, first_work, first_dissipated = looks[0]
        print(f"surface_slope       {math.degrees(np.mean([slope for slope, *_ in looks])):.2f} degrees, mean from 1 rad on")
        print(f"moment              {(work - first_work) / (turned - angle):.4f} N, that keeps it turning")
        print(f"work_per_dissipated {(work - first_work) / (dissipated - first_dissipated):.4f} from 1 rad on")


if __name__ == "__main__":
    example.main(main)
