"""The extension module granperi._granperi: CFFI, API mode, limited ABI.

setup.py builds it against the installed library. CMake asks for the C source only:

    python3 granperi_build.py SOURCE.c
"""
from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import cffi

HERE = Path(__file__).parent
MISSING = """\
granperi: {what}.
The Python package is built against the installed C library, which it looks for with pkg-config. Install the library
first (cmake --install build), and where it is not in a directory that pkg-config knows, name it:
    PKG_CONFIG_PATH=PREFIX/lib/pkgconfig pip install --no-build-isolation --no-index ."""


def make_ffi(**build) -> cffi.FFI:
    """The library's declarations and the watch of granperi_watch.c; build: keywords of setuptools.Extension."""
    ffi = cffi.FFI()
    ffi.cdef((HERE / "granperi" / "_cdef.h").read_text(encoding="utf-8"))
    ffi.cdef((HERE / "granperi_watch.h").read_text(encoding="utf-8"))
    source = "#include <granperi/gp.h>\n" + (HERE / "granperi_watch.c").read_text(encoding="utf-8")
    ffi.set_source("granperi._granperi", source, **build)
    return ffi


def pkg_config(option: str) -> str:
    """What pkg-config says of the installed library; ends the build with a text that says what to do if it cannot."""
    if shutil.which("pkg-config") is None:
        raise SystemExit(MISSING.format(what="the program pkg-config is not installed"))
    answer = subprocess.run(["pkg-config", option, "granperi"], capture_output=True, text=True)
    if answer.returncode != 0:
        raise SystemExit(MISSING.format(what="the library granperi was not found: " + answer.stderr.strip()))
    return answer.stdout.strip()


def installed_ffi() -> cffi.FFI:
    """For setup.py: compiled and linked against what pkg-config finds, also at run time."""
    flags = pkg_config("--libs").split()
    directories = [str(Path(flag[2:]).resolve()) for flag in flags if flag.startswith("-L")]
    return make_ffi(
        libraries=[flag[2:] for flag in flags if flag.startswith("-l")],
        library_dirs=directories,
        runtime_library_dirs=directories,
        include_dirs=[flag[2:] for flag in pkg_config("--cflags-only-I").split()],
        define_macros=[("_POSIX_C_SOURCE", "200809L")],
        extra_compile_args=["-O2"],
    )


def ffibuilder() -> cffi.FFI:
    return installed_ffi()


if __name__ == "__main__":
    make_ffi().emit_c_code(sys.argv[1])
