"""An obstacle in the way

A column runs against a bent line, which takes the thrust: plate_load tells force and moment. Colour: pressure.
"""
import granperi
import granperi.plot

with granperi.Simulation(spacing=0.002) as sim:
    sim.add_column(width=0.1, height=0.1)
    sim.add_plate(granperi.Plate.floor(0, 0.5))
    sim.add_plate(granperi.Plate.wall(0, 0, 0.12))
    block = [[0.18, 0], [0.21, 0.03], [0.24, 0]]
    block = sim.add_plate(granperi.Plate.line(block, material="left"))
    sim.run(0.25)
    print(f"thrust {sim.plate_load(block).fx:.1f} N/m")
    granperi.plot.field(sim, "pressure").figure.savefig("obstacle.png")
