"""The compiled layer: ffi, lib, and a text that says what to do where they cannot be loaded."""
from __future__ import annotations

try:
    from granperi._granperi import ffi, lib
except ImportError as error:
    if "libgranperi" in str(error):
        what = ("the C library granperi was not found. Install it (cmake --install build, then sudo ldconfig), or name the "
                "directory of libgranperi.so.0 in LD_LIBRARY_PATH")
    elif "_cffi_backend" in str(error):
        what = "cffi was not found. Install it: pip install cffi, on Debian python3-cffi"
    else:
        what = ("the extension module granperi._granperi is missing. Build it: pip install . in the root of the sources, or "
                "cmake -DGRANPERI_BUILD_PYTHON=ON and PYTHONPATH=build/python")
    raise ImportError(f"granperi: {what} ({error})", name=error.name, path=error.path) from error

__all__ = ["ffi", "has_feature", "lib", "text_of"]


def text_of(pointer) -> str:
    """A C string as str; the library's texts are UTF-8 (paths in them may not be)."""
    return ffi.string(pointer).decode("utf-8", "replace")


def has_feature(name: str) -> bool:
    """Whether the library has a feature.

    Args:
        name: "hdf5", "openmp", "mpi", or an instruction set: "x86-64-v3".

    Returns:
        True or False; False for an unknown name.

    Example:
        print(granperi.has_feature("hdf5"))
    """
    return isinstance(name, str) and bool(lib.gp_has_feature(name.encode("utf-8", "replace").replace(b"\0", b"?")))
