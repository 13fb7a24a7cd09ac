#!/usr/bin/python3
"""A hopper empties through its outlet onto a floor: examples/c/hopper.c in Python.

Beverloo's law: rho sqrt(g) D^1.5 per metre of depth, times a number that does not know how much is left above.
"""
import example
import numpy as np

import granperi

OUTLET, WIDTH = 0.05, 0.25  # m
DENSITY = 2500 * 0.62  # kg/m3, of the filling


def add_walls(sim, top):
    """Bin and funnel at 45 degrees: one line each side, with the material on the right of its way."""
    shoulder = (WIDTH - OUTLET) / 2
    side = np.array([[OUTLET / 2, 0], [WIDTH / 2, shoulder], [WIDTH / 2, top]])
    sim.add_plate(points=side * [-1, 1])  # upwards on the left,
    sim.add_plate(points=side[::-1])  # downwards on the right


def main():
    parser = example.parser("Glass beads flow out of a hopper, 0.25 m wide, with an outlet of 0.05 m. Reference length: the "
                            "outlet.", resolution=10, end=1.2, output="hopper.h5", gates=False)
    parser.add_argument("--height", type=example.number(0.12, 10), default=0.25, help="filling above the outlet, m")
    options = parser.parse_args()
    spacing = OUTLET / options.resolution
    looks = []

    def look(sim):
        """Between two steps, 100 times a second: what is still above the outlet?"""
        if not looks or sim.time >= looks[-1][0] + 0.01:
            looks.append((sim.time, np.count_nonzero(sim.y > 0) * (DENSITY * spacing * spacing)))

    with example.create(options, spacing, 0.002) as sim:
        add_walls(sim, options.height + 6 * spacing)
        sim.add_plate(granperi.Plate.floor(-1, 1, y=-0.3))
        example.fill(sim, -WIDTH / 2, WIDTH / 2, 0, options.height,
                     lambda x, y: (y - (abs(x) - OUTLET / 2)) / np.sqrt(2) > 0.49 * spacing)  # half a spacing off the walls
        sim.set_callback(look, 10)
        example.run(sim, options)

    time, mass = np.array(looks).T
    print("# time s, mass above the outlet kg/m")
    for at, left in looks[::5]:
        print(f"{at:.3f} {left:.4f}")
    steady = (time >= 0.2) & (mass > 0.2 * mass[0])
    rate = -np.polyfit(time[steady], mass[steady], 1)[0]
    print(f"flow_rate           {rate:.5g} kg/(m s), from 0.2 s on")
    print(f"flow_rate_scaled    {rate / (DENSITY * 9.81**0.5 * OUTLET**1.5):.4f} rho sqrt(g) D^1.5")


if __name__ == "__main__":
    example.main(main)
