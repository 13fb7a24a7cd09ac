"""A column collapses

A column of glass beads, 8 cm wide and 5 cm high, spreads to both sides and comes to rest: the scene of the first page, 640 particles.
"""
import granperi
import granperi.plot

with granperi.Simulation(spacing=0.0025) as sim:
    sim.add_column(x_min=-0.04, width=0.08, height=0.05)
    sim.add_plate(granperi.Plate.floor(-0.2, 0.2))
    sim.run(0.15)
    granperi.plot.field(sim, "speed").figure.savefig("collapse.png")
