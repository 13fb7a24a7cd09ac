#!/usr/bin/env python3
"""Instructions of short fixed runs, counted by callgrind, against the figures in instructions.txt: a guard against losses
of speed that does not depend on how fast or busy the machine is.

    instructions.py --step build/bench/step --compiler "GNU 12.2.0" [--update]

Exit status: 0 within the tolerance; 1 beyond it, in either direction; 77 (skipped) without valgrind or with a compiler or
processor other than the figures were made with. --update writes the figures that were counted.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

TOLERANCE = 0.03
SKIPPED = 77
FIGURES = pathlib.Path(__file__).with_name("instructions.txt")
# Options of bench/step. Instructions of the steps are those of the longer run less those of the shorter one. Runs begin in the
# midst of the collapse, FROM seconds after its begin, up to where nothing is counted: valgrind takes fifty times as long.
CASES = {
    "collapse": ["--resolution", "32"],
    "collapse_horizon_2.5": ["--resolution", "32", "--horizon", "2.5"],
    "collapse_without_diffusion": ["--resolution", "32", "--diffusion", "0"],
    "collapse_with_fluidity": ["--resolution", "32", "--amplitude", "0.48"],
}
FROM = "0.1"
STEPS = (10, 110)


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def processor_has_avx2():
    """Where the processor has AVX2, valgrind runs the engine for x86-64-v3, else that for x86-64."""
    try:
        return re.search(r"^flags\s*:.*\bavx2\b.*\bfma\b|^flags\s*:.*\bfma\b.*\bavx2\b",
                         pathlib.Path("/proc/cpuinfo").read_text(), re.M) is not None
    except OSError:
        return False


def run(command):
    """What a program says; ends the test where it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} ended with status {done.returncode}:\n{done.stderr}")
    return done.stdout


def count(step, options, steps, work):
    """Instructions of one run, and its number of particles."""
    said = run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={work}/out", step, *options, "--steps", str(steps)])
    summary = re.search(r"^(?:summary|totals): (\d+)", pathlib.Path(work, "out").read_text(), re.M)
    return int(summary.group(1)), int(re.search(r"^particles (\d+)", said, re.M).group(1))


def per_particle_step(step, options):
    with tempfile.TemporaryDirectory() as work:
        flowing = f"{work}/flowing"
        run([step, *options, "--from", FROM, "--write", flowing])
        options = [*options, "--from", "0", "--read", flowing]
        short, particles = count(step, options, STEPS[0], work)
        long, _ = count(step, options, STEPS[1], work)
    return (long - short) / particles / (STEPS[1] - STEPS[0])


def read_figures():
    lines = [line.split(maxsplit=1) for line in FIGURES.read_text().splitlines() if line and not line.startswith("#")]
    return {name: value for name, value in lines}


def write_figures(compiler, counted):
    text = "# Instructions per particle and step, by callgrind. Made by: cmake --build build --target update_instructions\n"
    text += f"compiler {compiler}\n" + "".join(f"{name} {value:.0f}\n" for name, value in counted.items())
    FIGURES.write_text(text)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--step", required=True)
    parser.add_argument("--compiler", required=True)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    if not shutil.which("valgrind"):
        skip("valgrind is not installed")
    if not processor_has_avx2():
        skip("the figures are of a processor with AVX2 and FMA")
    figures = {} if arguments.update else read_figures()
    if figures and figures["compiler"] != arguments.compiler:
        skip(f"the figures were made with {figures['compiler']}, this build with {arguments.compiler}")
    counted = {name: per_particle_step(arguments.step, options) for name, options in CASES.items()}
    if arguments.update:
        write_figures(arguments.compiler, counted)
    beyond = False
    for name, value in counted.items():
        expected = float(figures.get(name, value))
        beyond |= abs(value / expected - 1) > TOLERANCE
        print(f"{name}: {value:.0f} instructions per particle and step, checked in {expected:.0f} "
              f"({100 * (value / expected - 1):+.1f} %)")
    if beyond:
        print(f"beyond {100 * TOLERANCE:.0f} %: if it is meant, say why in docs/hot-path.md and update the figures: "
              "cmake --build build --target update_instructions")
    sys.exit(1 if beyond else 0)


if __name__ == "__main__":
    main()
