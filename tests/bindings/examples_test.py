#!/usr/bin/env python3
"""The examples in C and in Fortran say the same, and the hosts that drive plates keep the balance of momentum.

usage: examples_test.py same C_PROGRAM FORTRAN_PROGRAM OPTION...
       examples_test.py hit_block PROGRAM
       examples_test.py pulled_gate PROGRAM
"""

import decimal
import math
import subprocess
import sys

failures = []


def expect(condition, *what):
    print("ok    " if condition else "FAILED", *what)
    if not condition:
        failures.append(what)


def run(program, *options):
    """Lines of "name value unit" as name -> text of the value; and the table, rows of numbers."""
    text = subprocess.run([program, *options], check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout
    values, table = {}, []
    for words in (line.split() for line in text.splitlines() if not line.startswith("#")):
        try:
            table.append([float(word) for word in words])
        except ValueError:
            values[words[0]] = words[1]
    return values, table


def unit_in_last_place(text):
    return 10.0 ** decimal.Decimal(text).as_tuple().exponent


def same(c_program, fortran_program, *options):
    in_c, in_fortran = run(c_program, *options)[0], run(fortran_program, *options)[0]
    for timing in ("cpu_seconds", "particle_steps_rate"):
        in_c.pop(timing, None)
        in_fortran.pop(timing, None)
    expect(len(in_c) > 10 and list(in_c) == list(in_fortran), "both print", *in_c)
    for name in in_c:
        a, b = in_c[name], in_fortran.get(name, "nan")
        # Each is rounded to the digits that it shows.
        expect(abs(float(a) - float(b)) <= 0.51 * (unit_in_last_place(a) + unit_in_last_place(b)), name, a, b)


def hit_block(program):
    options = ("--resolution", "20", "--threads", "1")
    values, table = run(program, *options)
    value = {name: float(text) for name, text in values.items()}
    # Sums over some 3000 steps and 500 particles in double precision.
    expect(value["momentum_error_share"] < 1e-11, "momentum of grains, block and ground closes:",
           values["momentum_error_share"])
    expect(value["block_moved"] > 0.005, "the flow moves the block:", values["block_moved"], "m")
    expect(value["block_stops_at"] > value["block_moves_from"] > 0, "and the floor stops it")
    # It stays within what an inelastic blow by all of the flow's momentum would give it.
    fastest = max(row[2] for row in table)
    expect(0 < fastest < value["momentum_largest"] / (1500 * 0.03 ** 2), "its speed:", fastest, "m/s")
    # While it stands still the static friction bears the thrust: |f_x| <= mu (m g - f_y).
    standing = [row for row in table if row[0] > value["block_stops_at"] + 0.02]
    expect(standing and all(abs(row[3]) <= 0.3 * (1500 * 0.03 ** 2 * 9.81 - row[4]) for row in standing),
           "at rest the floor can hold the thrust")
    small = float(run(program, *options, "--block", "0.02")[0]["block_moved"])
    expect(small > value["block_moved"], "a lighter block is pushed further:", small, "m")


def pulled_gate(program):
    options = ("--resolution", "20", "--threads", "1", "--end", "0.3")
    values, table = run(program, *options)
    value = {name: float(text) for name, text in values.items()}
    free = float(run(program, *options, "--wall-mu", "0")[0]["gate_clear_at"])
    held = run(program, *options, "--wall-mu", "5")[0]["gate_clear_at"]
    # Sums over some 1200 steps in double precision; the impulses are of the order of 10 N s/m.
    expect(value["momentum_error"] < 1e-10, "momentum of gate and weight closes:", values["momentum_error"], "N s/m")
    # The column begins in balance: its thrust on the gate is rho g h^2 / 2; 1550 kg/m3, 0.08 m.
    hydrostatic = 1550 * 9.81 * 0.08 ** 2 / 2
    expect(abs(table[0][5] / hydrostatic - 1) < 0.05, "the thrust begins as the hydrostatic one:", table[0][5], hydrostatic)
    expect(value["friction_excess"] < 0.02 * value["largest_thrust"], "the friction is Coulomb's:", values["friction_excess"],
           "N/m beyond")
    expect(value["without_grains"] < free < value["gate_clear_at"],
           "the grains slow the gate down, by friction more:", value["without_grains"], free, value["gate_clear_at"], "s")
    expect(held == "never:" or float(held) > value["gate_clear_at"], "a rougher gate opens later or never:", held)
    loose = [row for row in table if row[1] > 0.085 and row[2] > 0]
    atwood = (4 - 1) * 9.81 / (4 + 1)
    expect(loose and all(math.isclose(row[3], atwood, rel_tol=1e-3) for row in loose),
           "clear of the grains it moves as without them:", atwood, "m/s2")


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in ("same", "hit_block", "pulled_gate"):
        sys.exit(__doc__)
    globals()[sys.argv[1]](*sys.argv[2:])
    sys.exit(1 if failures else 0)
