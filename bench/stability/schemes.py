"""The schemes that the studies of docs/stability.md compare, and what is tried of each."""
from __future__ import annotations

import math
from dataclasses import dataclass

from theory import SHEAR_TO_BULK


@dataclass(frozen=True)
class Scheme:
    """One line here is all that a scheme needs to take part in the studies."""

    key: str  # what --scheme calls it
    label: str
    wave_factor: float  # elastic wave speed over c0: what the time step is counted in
    own_cfl: float  # where little moves; 0.84 of it where much does
    smallest: float  # dl / wave speed, of the reference in the search for the largest time step
    cfls: tuple[float, ...]  # tried for creep,
    drift_cfls: tuple[float, ...]  # and for drift at rest
    deltas: tuple[float, ...]  # 1/s, tried for creep; the first is that of all other runs
    limit_deltas: tuple[float, ...]
    limit_resolutions: tuple[int, ...] = (16, 32)
    limit_resolution: int = 16  # of the axis of horizons and of the layer
    limit_sounds: tuple[float, ...] = (0.5, 1, 2)
    limit_horizons: tuple[float, ...] = (2.2, 3, 4, 5)  # dl
    drift_end: float = 15.0  # s
    drift_deltas: tuple[float, ...] = ()  # 1/s, beside its own
    preset_delta: float = 1e-6  # 1/s
    resolution: int = 32  # L/dl, of creep
    cost: float = 1.0  # of a particle-step, in that of the default scheme
    force_states: bool = True  # the horizon is that of its operators; else the interaction radius
    explicit_viscosity: bool = False  # the regularised one of the paper
    shear_to_bulk: float = 0.0  # elastic moduli

    @property
    def reach_option(self) -> str:
        return "horizon" if self.force_states else "interaction_radius"

    @property
    def delta_option(self) -> float | None:
        return None if self.deltas[0] == self.preset_delta else self.deltas[0]


PAPER_CFLS = {"cfls": (0.2, 0.8), "drift_cfls": (0.2, 0.8), "explicit_viscosity": True, "cost": 0.5}
PAPER_DELTAS = {"deltas": (1e-6, 1.0, 10.0), "limit_deltas": (1e-6, 1e-4, 1e-2)}
SCHEMES = {
    scheme.key: scheme
    for scheme in (
        Scheme(
            "default", "default", math.sqrt(1 + SHEAR_TO_BULK), 0.95, 0.4, (0.2, 0.4, 0.95), (0.95, 1.4), (1e-6, 1e-2),
            (1e-6, 1e-2), limit_resolution=32, drift_end=60.0,
            shear_to_bulk=SHEAR_TO_BULK,
        ),
        Scheme("paper", "paper, non-local", 1.0, 0.2, 0.2, **PAPER_CFLS, **PAPER_DELTAS),
        Scheme("local", "paper, local", 1.0, 0.2, 0.2, **PAPER_CFLS, **PAPER_DELTAS, force_states=False),
        # A step costs the more the smaller delta: coarse, and with a delta at which creep is small already.
        Scheme(
            "implicit", "implicit", 1.0, 0.95, 0.4, (0.4, 0.95), (0.95,), (1e-2, 1.0, 1e-4, 1e-6),
            (1e-2,), limit_resolutions=(16,), limit_sounds=(0.5, 1), limit_horizons=(2.2, 3, 4), drift_end=9.0, resolution=16, cost=29.0,
            drift_deltas=(1e-5,),
        ),
    )
}  # fmt: skip
