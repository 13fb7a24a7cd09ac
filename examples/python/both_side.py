#!/usr/bin/python3
"""A column on a rough floor collapses to both sides when two gates are lifted.

Jin, Lu, Tai & Xu (2021), section 4; the aspect ratio is H over half the width, 1.25 and 5 in the paper.
"""
import example
import granperi


def main():
    width, grain_diameter = 0.08, 0.002  # m; the width is the reference length L
    parser = example.parser("A column of glass beads, 0.08 m wide, collapses to both sides. Reference length: its width.",
                            resolution=32, end=1.0, output="both_side.h5")
    parser.add_argument("--aspect", type=example.number(0.01, 1000), default=1.25, help="height over half the width")
    options = parser.parse_args()
    height = options.aspect * width / 2
    spacing = width / options.resolution

    with example.create(options, spacing, grain_diameter) as sim:
        sim.add_column(x_min=-width / 2, y_min=0, width=width, height=height, material=1)
        # Run-outs reach about 2.5 heights beyond the foot of the column (Staron & Hinch 2005).
        reach = width / 2 + 4 * height + 20 * spacing
        sim.add_plate(granperi.Plate.floor(-reach, reach))
        example.add_gate(sim, -width / 2, "right", height, options)
        example.add_gate(sim, width / 2, "left", height, options)
        example.run(sim, options)


if __name__ == "__main__":
    example.main(main)
