#!/usr/bin/env python3
"""The generator reads what a header may hold, and refuses what it does not understand instead of leaving it out.

usage: generator_test.py [--cc CC]
"""

import argparse
import os
import shlex
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "bindings", "generate"))

from cdef import write_cdef  # noqa: E402
from fortran_raw import write_raw  # noqa: E402
from header import HeaderError, read_header  # noqa: E402

WHOLE = """
#ifndef GUARD_H
#define GUARD_H
#include <stdint.h>
#define GP_API
#define GP_BIT (1u << 3) /* a bit */
#define GP_BITS (GP_BIT | 0x10u)
typedef int32_t gp_status;
/* A kind. */
enum { GP_A, GP_B = 5, GP_C, GP_D = GP_B - 7 };
typedef struct gp_thing {
    uint32_t struct_size;
    double x, *y; /* both */
    /* above its field */
    double above;
    double beside; /* in its line */
    /* not of the field before */
    double last;
    const double *a, b[3];
} gp_thing;
typedef struct gp_sim gp_sim;
typedef void (*gp_told)(void *user, const char *text);
GP_API gp_status gp_make(const gp_thing *thing, gp_sim **sim);
GP_API void gp_end(gp_sim *sim);
GP_API const char *gp_text(void);
#endif
"""


def read(text, cc):
    with tempfile.TemporaryDirectory() as work:
        path = os.path.join(work, "whole.h")
        with open(path, "w") as target:
            target.write(text)
        return read_header(path, cc)


def expect(condition, *what):
    if not condition:
        print("FAILED:", *what)
        sys.exit(1)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--cc", default="cc", type=shlex.split)
    cc = parser.parse_args().cc
    header = read(WHOLE.replace("#define GP_API\n", ""), cc)
    cdef, raw = write_cdef(header), write_raw(header)
    said = {field.name: field.doc for field in header.struct("gp_thing").fields}
    expect(said["above"] == "above its field" and said["beside"] == "in its line" and said["last"] == "not of the field before",
           "comments of fields:", said)
    for line in ("#define GP_BIT 8", "#define GP_BITS 24", "GP_A = 0", "GP_C = 6", "GP_D = -2", "double *y;",
                 "const double *a;", "const double b[3];", "typedef struct gp_sim gp_sim;",
                 "typedef void (*gp_told)(void *user, const char *text);", "const char *gp_text(void);",
                 "gp_status gp_make(const gp_thing *thing, gp_sim **sim);"):
        expect(line in cdef, "not in the cdef:", line, "\n" + cdef)
    for line in ("integer(c_int32_t), parameter :: GP_BITS = 24", "!> A kind.", "real(c_double) :: x !! both",
                 "type(c_ptr) :: y !! both", "real(c_double) :: b(3)", "subroutine gp_end(sim) bind(c, name=\"gp_end\")",
                 "type(gp_thing), intent(in), optional :: thing", "type(c_ptr), intent(out) :: sim"):
        expect(line in raw, "not in the Fortran module:", line, "\n" + raw)
    end = "#endif\n"
    for strange in ("extern int gp_number;\n", "typedef union gp_u { int a; } gp_u;\n",
                    "GP_API float gp_f(void);\n", "typedef struct gp_w { long double v; } gp_w;\n",
                    "enum { GP_S = sizeof(int) };\n", "#define GP_TEXT \"text\"\n",
                    "GP_API gp_status gp_p(gp_thing ***things);\n"):
        try:
            write_raw(read(WHOLE.replace("#define GP_API\n", "").replace(end, strange + end), cc))
        except HeaderError:
            continue
        expect(False, "was taken without a word:", strange)
    print("passed")


if __name__ == "__main__":
    main()
