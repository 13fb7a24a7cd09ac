"""The scenario of tests/bindings/scenario.c in Python: the same particles to the last bit."""
import numpy as np

import granperi

N_STEPS, EVERY = 100, 7


def add_to_hash(value: int, values: np.ndarray) -> int:
    """FNV-1a, 64 bits, over the bytes."""
    for byte in values.astype("<f8").tobytes():
        value = (value ^ byte) * 1099511628211 & 0xFFFFFFFFFFFFFFFF
    return value


def hash_of(sim: granperi.Simulation, lid: int, wheel: int) -> int:
    value = 14695981039346656037
    for name in ("x", "y", "vx", "vy", "pressure"):
        value = add_to_hash(value, sim.field(name))
    for plate in (lid, wheel):
        load = sim.plate_load(plate)
        value = add_to_hash(value, np.array([load.fx, load.fy, load.torque, load.dx, load.dy, load.impulse_x, load.impulse_y,
                                             load.torque_pivot, load.angle, load.impulse_torque]))
    return value


def main() -> None:
    with granperi.Simulation(spacing=0.004, sound_speed=20, threads=1, seed=7, jitter=0.05) as sim:
        beads = sim.add_material(grain_diameter=0.001, mu_s=0.4)
        sim.add_column(width=0.08, height=0.064, material=beads)
        k = np.arange(1, 7)
        sim.add_particles(np.full(6, 0.12), k * 0.004, vx=np.full(6, -0.5), vy=k * 0.0625)

        sim.add_plate(x0=0.3, x1=0, surface_velocity=0.25)
        sim.add_plate(y1=0.1, friction="free_slip")
        lid = sim.add_plate(x0=0, y0=0.066, x1=0.06, y1=0.066, friction="coulomb")
        sim.add_plate(x0=0.08, x1=0.08, y0=0.1, friction="free_slip", knot_t=[0, 0.005, 0.01, 0.015, 0.02],
                      knot_x=[0] * 5, knot_y=[0, 0.001, 0.004, 0.009, 0.016], knot_angle=[0, 0, 0, 0.03125, 0.0625],
                      pivot_x=0.08, pivot_y=0.1)
        wheel = sim.add_plate(points=[[0.17, 0.03], [0.15, 0.05], [0.13, 0.03], [0.15, 0.01], [0.17, 0.03]], pivot_x=0.15,
                              pivot_y=0.03)

        # The lid sinks faster and faster: 4 m/s2; the wheel turns faster and faster; and the scene is tilted.
        def drive(sim: granperi.Simulation) -> None:
            sim.set_plate_velocity(lid, 0, -4 * sim.time)
            sim.set_plate_motion(wheel, -0.25, 0, 512 * sim.time)
            sim.set_gravity(50 * sim.time, -9.5)

        sim.set_callback(drive, EVERY)
        for _ in range(3):
            sim.step(N_STEPS)
            state = sim.state
            print(f"step {state.step} particles {state.n_particles} hash {hash_of(sim, lid, wheel):016x}")


if __name__ == "__main__":
    main()
