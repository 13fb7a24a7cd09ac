#!/usr/bin/python3
"""A column against a smooth wall collapses to one side when a gate is lifted.

Jin, Lu, Tai & Xu (2021), section 5: height 0.14 m, length 0.20 m, grains of 0.7 mm.
"""
import example
import granperi


def main():
    length, height = 0.20, 0.14  # m; the length is the reference length
    grain_diameter = 0.0007  # m
    options = example.parser("A column of glass beads, 0.20 m long and 0.14 m high, collapses to the right. "
                             "Reference length: 0.20 m.", resolution=80, end=1.02, output="one_side.h5").parse_args()
    spacing = length / options.resolution

    with example.create(options, spacing, grain_diameter) as sim:
        sim.add_column(width=length, height=height, material=1)
        sim.add_plate(granperi.Plate.wall(0, 0, height + 6 * spacing, "right", friction="free_slip"))
        # Run-outs reach about 2.5 heights beyond the foot of the column (Staron & Hinch 2005).
        sim.add_plate(granperi.Plate.floor(0, length + 4 * height + 20 * spacing))
        example.add_gate(sim, length, "left", height, options)
        example.run(sim, options)
        # Two spacings from it: nearer, the wall takes the place of material in the smoothed volume fraction.
        print(f"height_at_wall      {sim.surface([2 * spacing])[0]:.5f} m")


if __name__ == "__main__":
    example.main(main)
