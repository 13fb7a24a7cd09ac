"""Numbers and tables in Markdown."""
from __future__ import annotations

import math
from typing import Iterable, Sequence

NONE = "–"


def fixed(value: float | None, digits: int = 3) -> str:
    """With so many digits after the point; a dash for what is not there."""
    return NONE if value is None or math.isnan(value) else f"{value:.{digits}f}"


def significant(value: float | None, digits: int = 3) -> str:
    """With so many significant digits; very large and very small ones with an exponent."""
    if value is None or math.isnan(value):
        return NONE
    mantissa, *exponent = f"{value:.{digits}g}".split("e")
    return f"{mantissa}e{int(exponent[0])}" if exponent else mantissa


def signed(value: float, digits: int) -> str:
    """With its sign; what is rounded to nothing has none."""
    text = f"{value:+.{digits}f}"
    return text if float(text) != 0 else text[1:]


def percent(value: float | None, reference: float | None, digits: int = 1) -> str:
    """Deviation from a reference with its sign."""
    if value is None or reference is None or math.isnan(value) or reference == 0:
        return NONE
    return f"{signed(100 * (value / reference - 1), digits)} %"


def cpu(value: float | None) -> str:
    """CPU seconds, to what is worth reading."""
    if value is None or math.isnan(value):
        return NONE
    return f"{value:.1f}" if value < 100 else f"{value:.0f}"


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """The first column to the left, the others to the right."""
    lines = ["| " + " | ".join(header) + " |", "|" + "|".join(["---"] + ["---:"] * (len(header) - 1)) + "|"]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines)
