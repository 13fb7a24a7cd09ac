#!/usr/bin/env python3
"""What the Fortran layer says of the C interface is what C has: sizes, offsets, constants, and every function is there.

usage: fortran_abi_test.py --header GP_H --pinned LAYOUT --library LIBRARY --modules DIRECTORY --work DIRECTORY
                           [--fc FC] [--flags FLAGS]

LAYOUT is tests/abi/layout.txt, which a test in C holds to the header: "gp_config.spacing at 8 size 8", "GP_OK = 0". A Fortran
program over the module granperi_raw has to print the same. Exits with 77 where the layout is not pinned for this system.
"""

import argparse
import os
import re
import shlex
import struct
import subprocess
import sys


def layout_program(pinned):
    """A Fortran program that prints the pinned lines, from what the module says."""
    structs = [line.split()[0] for line in pinned if re.match(r"\w+ size", line) and not line.startswith("gp_status ")]
    lines = ["program layout", "    use granperi_raw", "    implicit none"]
    lines += ["    type(%s), target :: of_%s" % (name, name) for name in structs]
    for line in pinned:
        name = line.split()[0]
        if "=" in line:
            lines.append("    print \"('%s = ', i0)\", %s" % (name, name))
        elif name == "gp_status":
            lines.append("    print \"('gp_status size ', i0)\", storage_size(0_gp_status)/8")
        elif "." not in name:
            lines.append("    print \"('%s size ', i0)\", c_sizeof(of_%s)" % (name, name))
        else:
            struct_name, field = name.split(".")
            variable = "of_%s%%%s" % (struct_name, field)
            lines += ["    print \"('%s at ', i0, ' size ', i0)\", &" % name,
                      "        address(c_loc(%s)) - address(c_loc(of_%s)), &" % (variable, struct_name),
                      "        storage_size(%s)/8 * count_of(shape(%s))" % (variable, variable)]
    lines += ["contains", "    function address(pointer) result(number)", "        type(c_ptr), value :: pointer",
              "        integer(c_intptr_t) :: number", "        number = transfer(pointer, number)",
              "    end function", "    function count_of(extents) result(n)", "        integer, intent(in) :: extents(:)",
              "        integer :: n", "        n = product(extents)", "    end function", "end program"]
    return "\n".join(lines) + "\n"


def symbol_program(header):
    """A Fortran program that takes the address of every function of the header."""
    with open(header) as source:
        text = re.sub(r"/\*.*?\*/", " ", source.read(), flags=re.S)
    names = re.findall(r"^GP_API\s[^;(]*?\b(gp_\w+)\s*\(", text, re.M)
    assert len(names) == len(re.findall(r"^GP_API\b", text, re.M)), "this script does not understand the header"
    lines = ["program symbols", "    use granperi_raw", "    implicit none", "    type(c_funptr) :: there(%d)" % len(names)]
    lines += ["    there(%d) = c_funloc(%s)" % (k + 1, name) for k, name in enumerate(names)]
    lines += ["    if (.not. c_associated(there(%d))) error stop '%s'" % (k + 1, name) for k, name in enumerate(names)]
    return "\n".join(lines + ["    print '(i0, a)', %d, ' functions'" % len(names), "end program"]) + "\n"


def build_and_run(arguments, name, text):
    source = os.path.join(arguments.work, name + ".f90")
    with open(source, "w") as target:
        target.write(text)
    program = os.path.join(arguments.work, name)
    subprocess.run([*arguments.fc, *arguments.flags, "-I" + arguments.modules, source, "-o", program, arguments.library,
                    "-Wl,-rpath," + os.path.dirname(arguments.library)], check=True)
    return subprocess.run([program], check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    for name in ("header", "pinned", "library", "modules", "work"):
        parser.add_argument("--" + name, required=True, type=os.path.abspath)
    parser.add_argument("--fc", default="gfortran", type=shlex.split)
    parser.add_argument("--flags", default="", type=shlex.split)
    arguments = parser.parse_args()
    if struct.calcsize("P") != 8:
        print("skipped: the layout is pinned for 64-bit systems")
        return 77
    os.makedirs(arguments.work, exist_ok=True)
    with open(arguments.pinned) as source:
        pinned = source.read().splitlines()
    found = build_and_run(arguments, "layout", layout_program(pinned)).splitlines()
    wrong = [(a, b) for a, b in zip(pinned, found) if a != b]
    for in_c, in_fortran in wrong:
        print("FAILED: C: %s, Fortran: %s" % (in_c, in_fortran))
    print(len(found), "sizes, offsets and constants of", len(pinned))
    print(build_and_run(arguments, "symbols", symbol_program(arguments.header)), end="")
    return 1 if wrong or len(found) != len(pinned) else 0


if __name__ == "__main__":
    sys.exit(main())
