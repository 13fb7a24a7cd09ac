"""One exception per status of the library, and checks of what only Python can get wrong."""
from __future__ import annotations

import difflib
import operator
from typing import Iterable

from ._library import ffi, lib, text_of


class Error(Exception):
    """Any error of the library. The text is the library's: it names the argument, its value and what was expected."""

    status: int = lib.GP_E_INTERNAL


class ArgumentError(Error, ValueError):
    """An argument is missing, not finite, out of range or inconsistent."""

    status = lib.GP_E_ARGUMENT


class ArgumentTypeError(ArgumentError, TypeError):
    """An argument is of the wrong type or shape, or has a name that does not exist."""


class StateError(Error, RuntimeError):
    """A call out of order, on something closed or out of date, from inside a callback, or from a second thread."""

    status = lib.GP_E_STATE


class OutOfMemoryError(Error, MemoryError):
    """The library is out of memory."""

    status = lib.GP_E_MEMORY


class FileError(Error, OSError):
    """A file could not be created, written or read."""

    status = lib.GP_E_IO


class DivergedError(Error, ArithmeticError):
    """A value became non-finite or unbounded; the simulation can be read and saved at its last good step, not stepped."""

    status = lib.GP_E_DIVERGED


class UnsupportedError(Error, NotImplementedError):
    """The option exists, but not in this build, in this scheme or on several processes."""

    status = lib.GP_E_UNSUPPORTED


class VersionError(Error, RuntimeError):
    """A struct or file comes from a newer version of the library, or a checkpoint is in another format."""

    status = lib.GP_E_VERSION


class InternalError(Error, RuntimeError):
    """A defect of the library: please report the text."""

    status = lib.GP_E_INTERNAL


class GranperiWarning(UserWarning):
    """Something doubtful that the library noticed, with a number and what to change."""


_by_status = {
    kind.status: kind
    for kind in (ArgumentError, StateError, OutOfMemoryError, FileError, DivergedError, UnsupportedError, VersionError,
                 InternalError)
}


def check(status: int) -> int:
    """Raises the exception of a status below 0, with the library's text; else returns the status."""
    if status >= 0:
        return status
    text = text_of(lib.gp_last_error()) or text_of(lib.gp_status_string(status))
    raise _by_status.get(status, Error)(text)


# ---------------------------------------------------------------------------- what only Python can get wrong


def near_match(name: str, valid: Iterable[str]) -> str:
    """For the end of a message on an unknown name: a name like it, and all that are valid."""
    valid = list(valid)
    near = difflib.get_close_matches(str(name), valid, n=1, cutoff=0.5)
    hint = f"did you mean '{near[0]}'? " if near else ""
    return f"{hint}Valid: {', '.join(valid)}"


def whole(name: str, value, bits: int = 64) -> int:
    """value as an int that fits; floats are refused, also whole ones."""
    try:
        number = operator.index(value)
    except TypeError:
        raise ArgumentTypeError(f"{name} = {value!r}: expected a whole number") from None
    if not -(1 << (bits - 1)) <= number < (1 << (bits - 1)):
        raise ArgumentError(f"{name} = {number}: expected a whole number of {bits} bits")
    return number


def number(name: str, value) -> float:
    """value as a float; text and arrays are refused, the range is the library's business."""
    if isinstance(value, (str, bytes)):
        raise ArgumentTypeError(f"{name} = {value!r}: expected a number")
    if type(value) not in (float, int):
        refuse_masked(name, value)
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ArgumentTypeError(f"{name} = {value!r}: expected a number") from None
    except OverflowError:
        raise ArgumentError(f"{name} = {value!r}: expected a finite number") from None


def refuse_masked(name: str, value) -> None:
    """The error on values that a mask says are none; what a mask leaves all of is an array like others."""
    import numpy as np

    masked = value is np.ma.masked or isinstance(value, np.ma.MaskedArray) and bool(np.ma.getmaskarray(value).any())
    if not masked and isinstance(value, (list, tuple)):
        masked = any(item is np.ma.masked for item in value)
    if masked:
        raise ArgumentError(f"{name}: has masked values, which the library has no place for: leave them out "
                            "(array[~array.mask]; of every array beside it the same ones), or fill them (array.filled(...))")


def doubles(name: str, value, length: int | None = None):
    """value as a contiguous array of float64 of shape (n)."""
    import numpy as np

    refuse_masked(name, value)
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "fiub" and array.size:
            raise TypeError
        array = np.ascontiguousarray(array, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentTypeError(f"{name}: expected numbers of shape (n), got {value!r:.80}") from None
    if np.ndim(value) != 1:
        raise ArgumentTypeError(f"{name} has the shape {np.shape(value)}: expected one dimension, (n)")
    if length is not None and len(array) != length:
        raise ArgumentTypeError(f"{name} has {len(array)} values: expected {length}, as many as the arrays beside it")
    return array


def pointer(array):
    """The memory of an array of float64; NULL for None. The array has to live as long as the pointer is used."""
    return ffi.NULL if array is None else ffi.from_buffer("double[]", array, require_writable=False)


def path_bytes(name: str, path) -> bytes:
    """A path as the bytes that the library takes."""
    import os

    try:
        encoded = os.fsencode(path)
    except TypeError:
        raise ArgumentTypeError(f"{name} = {path!r}: expected a path") from None
    except UnicodeEncodeError:
        raise ArgumentError(f"{name} = {path!r}: expected a path that the file system can spell") from None
    if b"\0" in encoded:
        raise ArgumentError(f"{name} = {path!r}: expected a path without the character 0")
    return encoded
