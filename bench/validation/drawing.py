"""Colours, lines and markers of the schemes in the figures of docs/validation.md."""
from __future__ import annotations

from typing import Callable, Iterable

import runs
from results import Collection, Result
from run import Run

STYLES = {  # colour (readable with colour blindness), line
    "default": ("#0072B2", "-"),
    "raised": ("#56B4E9", "--"),
    "walls": ("#009E73", "-."),
    "nonlocal_1": ("#E69F00", "-"),
    "nonlocal_2": ("#D55E00", "-"),
    "local_1": ("#CC79A7", "--"),
    "local_2": ("#7A3B69", "--"),
}
MARKERS = {
    "default": "o",
    "raised": "s",
    "walls": "^",
    "nonlocal_1": "D",
    "nonlocal_2": "v",
    "local_1": "<",
    "local_2": ">",
}

Available = list[tuple[str, Result]]


def available(results: Collection, run_of: Callable[[str], Run], schemes: Iterable[str]) -> Available:
    """The schemes that have a result."""
    pairs = ((key, results(run_of(key))) for key in schemes)
    return [(key, result) for key, result in pairs if result is not None]


def label_of(scheme: str) -> str:
    return runs.SCHEMES[scheme].label
