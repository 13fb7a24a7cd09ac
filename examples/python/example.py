"""What the examples share: options, a run with a progress bar, a summary."""
import argparse
import math
import sys
import time

import numpy as np

import granperi


def number(low, high, kind=float):
    """For argparse: a number from low to high."""

    def parse(text):
        value = kind(text)
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text}: expected a number from {low:g} to {high:g}")
        return value

    return parse


def parser(about, resolution, end, output, gates=True):
    """The options that every example takes; an end of None depends on the case; not all have gates."""
    options = argparse.ArgumentParser(description=about, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    add = options.add_argument
    add("--resolution", type=number(1, 1e5, int), default=resolution, help="particles over the reference length")
    add("--end", type=number(1e-9, 1e6), default=end, help="end of the run, s")
    add("--threads", type=number(0, 1024, int), default=1, help="0 for the OpenMP default")
    add("--output", default=output if granperi.has_feature("hdf5") else "none",
        help='file of frames every 0.01 s, "none" for no file')
    if gates:
        add("--lift-time", type=number(0, 1e6), default=0.1, help="s in which a gate clears its column; 0: no gates")
    add("--mu-s-degrees", type=number(0, 89), default=21, help="friction angle at rest")
    add("--mu-2-degrees", type=number(0, 89), default=32, help="friction angle of fast flow")
    return options


def create(options, spacing, grain_diameter):
    """A simulation whose material 1 is glass beads of this diameter (m) with the friction of the options."""
    sim = granperi.Simulation(spacing=spacing, threads=options.threads)
    sim.add_material(grain_diameter=grain_diameter, mu_s=math.tan(math.radians(options.mu_s_degrees)),
                     mu_2=math.tan(math.radians(options.mu_2_degrees)))
    return sim


def fill(sim, x_min, x_max, y_min, y_max, inside):
    """Particles of material 1 at rest on the lattice of the spacing, within the box and where inside(x, y) is true."""
    spacing = sim.config.spacing
    x = x_min + (np.arange(round((x_max - x_min) / spacing)) + 0.5) * spacing
    y = y_min + (np.arange(round((y_max - y_min) / spacing)) + 0.5) * spacing
    x, y = (values.ravel() for values in np.meshgrid(x, y))
    here = inside(x, y)
    sim.add_particles(x[here], y[here], material=1)


def add_gate(sim, x, material, height, options):
    """A gate at x, with the material on its "left" or "right", that is lifted off a column of this height."""
    if options.lift_time > 0:
        sim.add_plate(granperi.Plate.gate(x, height, options.lift_time, material, sim.config.spacing))


def run(sim, options):
    """Runs to options.end with a frame every 0.01 s and prints lines of "name value unit"."""
    begin = time.process_time()
    progress = sys.stderr.isatty()
    if options.output == "none":
        history = granperi.History(sim.frames(options.end, 0.01, progress))
    else:
        history = sim.record(options.output, options.end, 0.01, progress=progress)
    print_summary(history, time.process_time() - begin)


def print_summary(history, cpu_seconds):
    last = history[-1]
    energy = last.energy_initial
    print(f"time                {last.time:.6g} s")
    print(f"particles           {last.n_particles}")
    print(f"steps               {last.step}")
    for name in ("peak_height", "peak_x", "x_left", "x_right"):
        print(f"{name:<20}{getattr(last, name):.5f} m")
    print(f"at_rest             {last.at_rest:d}")
    if last.at_rest:
        moving = [state.time for state in history if not state.at_rest]
        since = next((state.time for state in history if not moving or state.time > moving[-1]), 0.0)
        print(f"at_rest_since       {since:.2f} s")
    print(f"energy_initial      {energy:.6g} J/m")
    for name in ("kinetic", "potential", "elastic", "dissipated", "plate_work", "energy_error"):
        print(f"{name:<20}{getattr(last, name):.6g} J/m")
    print(f"energy_error_share  {100 * last.energy_error / energy:.4f} % of energy_initial")
    print(f"cpu_seconds         {cpu_seconds:.2f} s")
    print(f"particle_steps_rate {last.n_particles * last.step / max(cpu_seconds, 1e-9):.4g} per CPU second")


def main(program):
    """Runs the program; a mistake in its options ends it with the library's text."""
    try:
        program()
    except granperi.Error as error:
        sys.exit(f"{sys.argv[0]}: {error}")
