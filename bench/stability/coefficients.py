"""What a result could depend on: every coefficient of the scheme in gp_config, with the values that are tried."""
from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Coefficient:
    name: str  # in gp_config, or what it is
    option: str  # of the program
    default: float
    values: tuple[float, ...]  # others that are tried
    unit: str = ""
    half: float | None = None  # what half and twice the default stand for in the criterion, if it is one of its
    twice: float | None = None  # coefficients: the nearest that the library takes
    advice: str = ""
    inert: bool = False  # must leave the bits of the default scheme as they are

    @property
    def in_criterion(self) -> bool:
        return self.half is not None

    @property
    def all_values(self) -> tuple[float, ...]:
        return tuple(sorted((*self.values, self.default)))


NUMERICAL = (
    Coefficient(
        "sound_speed", "--sound-factor", 1, (0.5, 0.7, 1.4, 2), "x automatic", 0.5, 2,
        "0 (automatic); the time of a run is proportional to it",
    ),
    # The scheme's own is 0.95 where little moves, 0.8 where much does.
    Coefficient("cfl", "--cfl", 0.95, (0.475, 1.4, 1.9), "", 0.475, 1.9, "0 (the scheme's own)"),
    Coefficient(
        "horizon", "--horizon", 4, (2, 2.5, 3, 5, 6), "dl", 2.5, 6, "4; 3 for peaks, where more than some 8 spacings lie over the width",
    ),
    Coefficient("collision_distance", "--collision-distance", 0.9, (0, 0.45, 0.7, 0.8, 1), "dl", 0.45, 1, "0.9"),
    Coefficient("zero_energy_penalty", "--penalty", 0.02, (0, 0.005, 0.01, 0.04, 0.1), "rho c0 / dl", 0.01, 0.04, "0.02"),
    Coefficient("density_diffusion", "--diffusion", 0.2, (0, 0.1, 0.4, 1), "c0 dl", 0.1, 0.4, "0.2"),
    Coefficient("bulk_viscosity", "--bulk-viscosity", 0.1, (0, 0.05, 0.2, 0.4, 1), "rho c0 dl", 0.05, 0.2, "0.1"),
    Coefficient("interaction_radius", "--interaction-radius", 4, (2, 8), "dl", advice="no matter in the default scheme", inert=True),
    Coefficient("delta", "--delta", 1e-6, (1e-2,), "1/s", advice="no matter in the default scheme", inert=True),
)
SCENE = (
    Coefficient("jitter", "--jitter", 0.01, (0.1, 0.3), "dl", advice="0, or 0.01 for an ensemble"),
    Coefficient("time to lift the gates", "--lift-time", 0, (0.05, 0.1), "s"),
)
PHYSICAL = (
    Coefficient("friction angle at rest", "--mu-s-degrees", 21, (20, 22), "degrees"),
    Coefficient("grain diameter", "--diameter", 0.002, (0.001, 0.004), "m"),
)
COEFFICIENTS = NUMERICAL + SCENE + PHYSICAL

CRITERION = 0.02  # largest change of the deposit over a factor two
# Judged with L/dl = 64, too: its runs are those of the table of horizons.
FINE = ("horizon",)
