"""Writes the C source of the extension module granperi._granperi: CFFI, API mode, limited ABI. CMakeLists.txt compiles it.

usage: python3 granperi_build.py SOURCE.c
"""
from __future__ import annotations

import sys
from pathlib import Path

import cffi

HERE = Path(__file__).parent


def make_ffi() -> cffi.FFI:
    """The library's declarations and the watch of granperi_watch.c."""
    ffi = cffi.FFI()
    ffi.cdef((HERE / "granperi" / "_cdef.h").read_text(encoding="utf-8"))
    ffi.cdef((HERE / "granperi_watch.h").read_text(encoding="utf-8"))
    source = "#include <granperi/gp.h>\n" + (HERE / "granperi_watch.c").read_text(encoding="utf-8")
    ffi.set_source("granperi._granperi", source)
    return ffi


if __name__ == "__main__":
    make_ffi().emit_c_code(sys.argv[1])
