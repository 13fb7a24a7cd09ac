"""All figures of docs/validation.md by name."""
from __future__ import annotations

import convergence_section
import every_case
import fluid_sections
import hopper_section
import paper_figures
import physics_figures
from plotting import Figures

FIGURES: Figures = {
    "every_case": every_case.figure,
    "convergence": convergence_section.figure,
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
    "hopper": hopper_section.figure,
    "fluidity": fluid_sections.figure,
}

