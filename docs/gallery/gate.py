"""A gate opens

A column against a wall, behind a smooth gate that is lifted within 0.08 s. Colour: where the shear stress is at yield.
"""
import granperi
import granperi.plot

with granperi.Simulation(spacing=0.002) as sim:
    sim.add_column(width=0.1, height=0.07)
    sim.add_plate(granperi.Plate.floor(0, 0.35))
    sim.add_plate(granperi.Plate.wall(0, 0, 0.1))
    sim.add_plate(granperi.Plate.gate(0.1, height=0.07, lift_time=0.08, material="left", spacing=0.002))
    sim.run(0.12)
    granperi.plot.field(sim, "yielded").figure.savefig("gate.png")
