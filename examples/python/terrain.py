#!/usr/bin/python3
"""A mass of debris is released on a hillside: the scene is terrain.toml, the profile of the hill a file of two columns."""
import argparse
import math
import pathlib

import example
import numpy as np

import granperi

FROM, TO, DEPTH = 4.0, 32.0, 6.0  # m: the release area in x, and how deep it is


def release(sim):
    """Particles between the ground, half a spacing off it, and the depth above it; thinner towards both ends."""
    ground_x, ground_y = sim.plates[0].points[::-1].T  # the plate's own way has the material on its right: from right to left
    spacing = sim.config.spacing

    def inside(x, y):
        at, before, after = (np.interp(where, ground_x, ground_y) for where in (x, x - spacing, x + spacing))
        above = (y - at) / np.hypot(1, (after - before) / (2 * spacing))  # about the distance to the ground
        return (above > 0.49 * spacing) & (above < np.minimum(DEPTH, np.minimum(x - FROM, TO - x)))

    bottom, top = np.interp([TO, FROM], ground_x, ground_y)
    example.fill(sim, FROM, TO, bottom, top + DEPTH, inside)
    return lambda x: np.interp(x, ground_x, ground_y)


def main():
    scene = granperi.Scene.read(pathlib.Path(__file__).with_name("terrain.toml"))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--spacing", type=example.number(0.01, 2), default=scene.config.spacing, help="m")
    parser.add_argument("--end", type=example.number(1e-9, 1e6), default=scene.run.end, help="end of the run, s")
    parser.add_argument("--output", default=scene.run.output, help='file of frames, "none" for no file')
    options = parser.parse_args()

    with scene.build(options.spacing) as sim:
        height = release(sim)
        begin = sim.state
        if options.output == "none":
            sim.run(options.end)
        else:
            sim.record(options.output, options.end, scene.run.every)
        state = sim.state
    reach = state.x_q95
    print(f"particles           {state.n_particles}")
    print(f"released            {state.n_particles * options.spacing**2:.4g} m2")
    print(f"centre_moves_by     {state.centre_x - begin.centre_x:.2f} m in x")
    print(f"reach_95            {reach:.2f} m: 95 % of the mass lie to the left")
    angle = math.degrees(math.atan2(height(FROM) - height(reach), reach - FROM))
    print(f"travel_angle        {angle:.2f} degrees from the top of the release to there")


if __name__ == "__main__":
    example.main(main)
