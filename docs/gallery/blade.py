"""A blade pushes a bed

A smooth wall at constant velocity shears a wedge out of a bed of beads. Colour: shear rate, that is, the shear band.
"""
import granperi
import granperi.plot

with granperi.Simulation(spacing=0.002) as sim:
    sim.add_column(width=0.25, height=0.04)
    sim.add_plate(granperi.Plate.floor(-0.05, 0.4))
    sim.add_plate(granperi.Plate.wall(0, 0, 0.15, friction="free_slip", vx=0.1))
    sim.run(0.4)
    granperi.plot.field(sim, "shear_rate").figure.savefig("blade.png")
