"""Debris on a hillside

Debris of 24 degrees of friction is released on a profile, from a file in examples/data, and runs out below.
"""
import numpy as np

import granperi
import granperi.plot

hill = np.loadtxt("examples/data/hillside.csv", delimiter=",", skiprows=2)
x, y = (grid.ravel() for grid in np.meshgrid(np.arange(4, 32, 0.4), np.arange(0, 100, 0.4)))
above = y - np.interp(x, *hill.T)
released = (above > 0.5) & (above < np.minimum(6, np.minimum(x - 4, 32 - x)))
with granperi.Simulation(spacing=0.4) as sim:
    debris = sim.add_material(grain_diameter=0.2, mu_s=np.tan(np.radians(24)), mu_2=np.tan(np.radians(34)))
    sim.add_particles(x[released], y[released], material=debris)
    sim.add_plate(granperi.Plate.line(hill, material="left"))
    sim.run(5.0)
    granperi.plot.field(sim, "speed").figure.savefig("hillside.png")
