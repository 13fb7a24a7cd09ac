"""Two columns collide

Two columns of different height run into each other; the colours are those of the columns they came from.
"""
import granperi
import granperi.plot

with granperi.Simulation(spacing=0.002) as sim:
    sim.add_column(x_min=0, width=0.08, height=0.1)
    sim.add_column(x_min=0.22, width=0.08, height=0.06)
    sim.add_plate(granperi.Plate.floor(-0.1, 0.5))
    sim.add_plate(granperi.Plate.wall(0, 0, 0.12))
    sim.add_plate(granperi.Plate.wall(0.3, 0, 0.12, material="left"))
    sim.run(0.4)
    granperi.plot.interface(sim, 0, 1).figure.savefig("colliding.png")
