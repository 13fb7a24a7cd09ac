"""All figures of docs/validation.md by name."""
from __future__ import annotations

from pathlib import Path
from typing import Callable

import paper_figures
import physics_figures
from results import Collection

FIGURES: dict[str, Callable[[Path, Collection], bool]] = {
    "both_side": paper_figures.both_side,
    "peak_in_time": paper_figures.peak_in_time,
    "resolution": paper_figures.resolution,
    "velocity": paper_figures.velocity,
    "tall": paper_figures.tall,
    "solid_speed": paper_figures.solid_speed,
    "one_side": paper_figures.one_side,
    "colliding": paper_figures.colliding,
    "interface": paper_figures.interface,
    "lift": physics_figures.lift,
    "scaling": physics_figures.scaling,
    "contact_dynamics": physics_figures.contact_dynamics,
    "couette": physics_figures.couette,
    "run_time": physics_figures.run_time,
    "exact": physics_figures.exact,
}


def draw_all(directory: Path, results: Collection) -> set[str]:
    """Names of the figures that were drawn; files of those that were not are removed."""
    drawn = set()
    for name, draw in FIGURES.items():
        path = directory / f"validation_{name}.png"
        if draw(path, results):
            drawn.add(name)
        else:
            path.unlink(missing_ok=True)
    return drawn
