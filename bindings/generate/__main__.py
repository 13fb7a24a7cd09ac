"""Writes what repeats the public C header: the low-level layers of the bindings, and the library's list of its functions.

usage: python3 bindings/generate [--check] [--cc CC] [--header GP_H]

Writes bindings/python/granperi/_cdef.h (for CFFI), _reference.py (the header's comments, for docstrings), _objects.pyi and
_plate.pyi (for type checkers and editors) there, bindings/fortran/granperi_raw.f90 (the C interface in Fortran),
bindings/fortran/granperi_types.f90 (constructors and views over it) and src/levels/calls.inc (for libraries that have the
engine more than once). --check writes nothing and exits with 1, and a
message, where a file is not what would be written.
"""

import argparse
import difflib
import os
import shlex
import sys

from calls import write_calls
from cdef import write_cdef
from fortran_raw import write_raw
from fortran_types import write_types
from header import HeaderError, read_header
from python_meanings import write_reference
from python_stubs import write_objects, write_plate

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TARGETS = {
    "bindings/python/granperi/_cdef.h": write_cdef,
    "bindings/python/granperi/_reference.py": write_reference,
    "bindings/python/granperi/_objects.pyi": write_objects,
    "bindings/python/granperi/_plate.pyi": write_plate,
    "src/levels/calls.inc": write_calls,
    "bindings/fortran/granperi_raw.f90": write_raw,
    "bindings/fortran/granperi_types.f90": write_types,
}


def differs(path, text):
    """Prints how the file differs from text; whether it does."""
    old = ""
    if os.path.exists(path):
        with open(path, encoding="utf-8") as source:
            old = source.read()
    lines = list(difflib.unified_diff(old.splitlines(), text.splitlines(), path, "as generated", lineterm="", n=1))
    print("\n".join(lines[:60]), end="\n" if lines else "")
    return bool(lines)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--cc", default=os.environ.get("CC", "cc"), type=shlex.split)
    parser.add_argument("--header", default=os.path.join(ROOT, "include/granperi/gp.h"))
    arguments = parser.parse_args()
    try:
        header = read_header(arguments.header, arguments.cc)
        texts = {os.path.join(ROOT, path): write(header) for path, write in TARGETS.items()}
    except HeaderError as error:
        sys.exit("bindings/generate: %s" % error)
    if arguments.check:
        stale = [path for path, text in texts.items() if differs(path, text)]
        if stale:
            sys.exit("not what the header says: run python3 bindings/generate")
        return
    for path, text in texts.items():
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as target:
            target.write(text)


if __name__ == "__main__":
    main()
