"""What follows from the fields of the particles, by the same names for simulations and result files."""
from __future__ import annotations

from typing import Any, Callable, Iterable

import numpy as np

from ._enums import FIELD_GROUPS, FIELD_NAMES, field_names
from ._errors import ArgumentError, near_match

DERIVED = {
    "speed": "|v|, m/s",
    "shear_stress": "tau = sqrt(s:s / 2), Pa",
    "yielded": "bool: the shear stress is at the yield stress mu_s p or above",
}


def derived(name: str, read: Callable[[str], np.ndarray], friction_of_columns: Callable[[], np.ndarray]) -> np.ndarray:
    """read: gives a field by name; friction_of_columns: mu_s of the material of each column, times friction_factor."""
    if name == "speed":
        return np.hypot(read("vx"), read("vy"))
    shear_stress = np.sqrt((read("sxx") ** 2 + read("syy") ** 2) / 2 + read("sxy") ** 2)
    if name == "shear_stress":
        return shear_stress
    return shear_stress >= 0.999 * friction_of_columns()[read("column")] * read("pressure")


def names_with_derived(fields: Any) -> tuple[str, ...]:
    """Names of fields and of what follows from them, of names, groups or Field values; the fields first."""
    items = [fields] if isinstance(fields, (str, int)) or not isinstance(fields, Iterable) else list(fields)
    more = {name for name in items if isinstance(name, str) and name in DERIVED}
    others = [name for name in items if not (isinstance(name, str) and name in DERIVED)]
    for name in others:
        if isinstance(name, str) and name not in FIELD_NAMES and name not in FIELD_GROUPS:
            raise ArgumentError(f"field {name!r} does not exist: {near_match(name, [*DERIVED, *FIELD_NAMES, *FIELD_GROUPS])}")
    return (*(field_names(others) if others else ()), *(name for name in DERIVED if name in more))
