#!/usr/bin/python3
"""Two columns with a gap between them collapse and collide.

Jin, Lu, Tai & Xu (2021), section 6: case 1 with columns of different heights, case 2 of different widths.
"""
import example
import numpy as np

import granperi

# Left height and width, right height and width (m), end (s)
CASES = {1: (0.156, 0.08, 0.054, 0.08, 1.61), 2: (0.152, 0.04, 0.152, 0.08, 0.60)}


def print_interface(sim, left, right, highest):
    """Fits x = x0 + m y to the interface between 10 % and 60 % of its height: its foot is dragged by the floor and its
    top by the surface flow. The angle to the vertical is atan m, positive if the interface leans to the right."""
    y = (np.arange(400) + 0.5) * highest / 400
    x = sim.interface(left, right, y)
    top = y[~np.isnan(x)].max(initial=0)
    if top < 4 * sim.config.spacing:
        print("interface_top       0 m (the columns do not touch over a height of four spacings)")
        return
    used = ~np.isnan(x) & (y >= 0.1 * top) & (y <= 0.6 * top)
    slope, foot = np.polyfit(y[used], x[used], 1)
    print(f"interface_top       {top:.5f} m")
    print(f"interface_foot_x    {foot:.5f} m")
    print(f"interface_angle     {np.degrees(np.arctan(slope)):.2f} degrees to the vertical, fitted from 10 % to 60 % of "
          "interface_top")


def main():
    gap, reference, grain_diameter = 0.04, 0.08, 0.002  # m
    parser = example.parser("Two columns of glass beads, 0.04 m apart, collapse and collide. Reference length: 0.08 m.",
                            resolution=40, end=None, output="colliding.h5")
    parser.add_argument("--case", type=int, choices=(1, 2), default=1,
                        help="1: heights 0.156/0.054 m, widths 0.08/0.08 m, end 1.61 s; "
                             "2: heights 0.152/0.152 m, widths 0.04/0.08 m, end 0.6 s")
    options = parser.parse_args()
    left_height, left_width, right_height, right_width, end = CASES[options.case]
    options.end = options.end or end
    spacing = reference / options.resolution

    with example.create(options, spacing, grain_diameter) as sim:
        # The library rounds columns to whole spacings; the gates have to follow.
        left_width, right_width = (spacing * max(1, round(width / spacing)) for width in (left_width, right_width))
        # The middle of the gap is at x = 0.
        left = sim.add_column(x_min=-gap / 2 - left_width, width=left_width, height=left_height, material=1)
        right = sim.add_column(x_min=gap / 2, width=right_width, height=right_height, material=1)
        highest = max(left_height, right_height)
        reach = gap / 2 + 0.08 + 4 * highest + 20 * spacing
        sim.add_plate(granperi.Plate.floor(-reach, reach))
        example.add_gate(sim, -gap / 2 - left_width, "right", left_height, options)
        example.add_gate(sim, -gap / 2, "left", left_height, options)
        example.add_gate(sim, gap / 2, "right", right_height, options)
        example.add_gate(sim, gap / 2 + right_width, "left", right_height, options)
        example.run(sim, options)
        print_interface(sim, left, right, highest)


if __name__ == "__main__":
    example.main(main)
