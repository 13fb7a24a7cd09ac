"""A hopper empties

Each side of bin and funnel is one line of three points. docs/validation.md sets the flow out of the outlet beside Beverloo's scale.
"""
import numpy as np

import granperi
import granperi.plot

spacing, side = 0.005, np.array([[0.025, 0], [0.125, 0.1], [0.125, 0.3]])  # m: outlet, shoulder, top
x, y = (grid.ravel() for grid in np.meshgrid(np.arange(-0.1225, 0.125, spacing), np.arange(0.0025, 0.25, spacing)))
inside = y > np.abs(x) - 0.025 + 0.7 * spacing
with granperi.Simulation(spacing=spacing) as sim:
    sim.add_particles(x[inside], y[inside])
    sim.add_plate(points=side * [-1, 1])  # upwards on the left, so that the material is on its right
    sim.add_plate(points=side[::-1])  # downwards on the right
    sim.add_plate(granperi.Plate.floor(-0.5, 0.5, y=-0.2))
    sim.run(0.5)
    granperi.plot.field(sim, "speed").figure.savefig("hopper.png")
