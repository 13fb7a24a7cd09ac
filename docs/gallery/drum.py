"""A drum turns

A closed line, filled to a third, turns by 2 rad within 2 s: the surface comes to a slope between the angles of yield and of fast flow.
"""
import numpy as np

import granperi
import granperi.plot

angle = 2 * np.pi * np.arange(48) / 48
circle = 0.1 * np.column_stack([np.cos(angle), np.sin(angle)])
x, y = (grid.ravel() for grid in np.meshgrid(*[np.arange(-0.098, 0.1, 0.004)] * 2))
filled = (y < -0.025) & (np.hypot(x, y) < 0.097)
with granperi.Simulation(spacing=0.004) as sim:
    sim.add_particles(x[filled], y[filled])
    sim.add_plate(granperi.Plate.line(circle, closed=True, material="inside", omega=1.0))
    sim.run(2.0)
    granperi.plot.field(sim, "speed").figure.savefig("drum.png")
