"""The enumerations of the library, with its values."""
from __future__ import annotations

import enum

from ._errors import ArgumentError, ArgumentTypeError, near_match, whole
from ._library import lib


class Preset(enum.IntEnum):
    """Which scheme Config describes."""

    DEFAULT = lib.GP_PRESET_DEFAULT
    PAPER = lib.GP_PRESET_PAPER
    PAPER_LOCAL = lib.GP_PRESET_PAPER_LOCAL


class Stress(enum.IntEnum):
    """How the deviatoric stress follows from the motion."""

    ELASTIC = lib.GP_STRESS_ELASTIC
    REGULARIZED = lib.GP_STRESS_REGULARIZED
    IMPLICIT = lib.GP_STRESS_IMPLICIT


class Density(enum.IntEnum):
    """How the density is found."""

    CONTINUITY = lib.GP_DENSITY_CONTINUITY
    NUMBER = lib.GP_DENSITY_NUMBER


class InitialPressure(enum.IntEnum):
    """The pressure with which a column begins."""

    HYDROSTATIC = lib.GP_INITIAL_HYDROSTATIC
    NONE = lib.GP_INITIAL_NONE


class Wall(enum.IntEnum):
    """What a plate does to the tangential velocity."""

    NO_SLIP = lib.GP_WALL_NO_SLIP
    FREE_SLIP = lib.GP_WALL_FREE_SLIP
    COULOMB = lib.GP_WALL_COULOMB


class Fluidity(enum.IntEnum):
    """What a plate does to the granular fluidity of the material in front of it."""

    FREE = lib.GP_FLUIDITY_FREE
    ZERO = lib.GP_FLUIDITY_ZERO


class StepLimit(enum.IntEnum):
    """What set the time step."""

    NONE = lib.GP_DT_NONE
    SOUND = lib.GP_DT_SOUND
    FLOW = lib.GP_DT_FLOW
    PLATE = lib.GP_DT_PLATE
    VISCOSITY = lib.GP_DT_VISCOSITY
    DEMANDED = lib.GP_DT_DEMANDED
    END = lib.GP_DT_END
    RETRY = lib.GP_DT_RETRY


class Field(enum.IntFlag):
    """The particle fields."""

    ID = lib.GP_FIELD_ID
    COLUMN = lib.GP_FIELD_COLUMN
    X = lib.GP_FIELD_X
    Y = lib.GP_FIELD_Y
    VX = lib.GP_FIELD_VX
    VY = lib.GP_FIELD_VY
    PRESSURE = lib.GP_FIELD_PRESSURE
    DENSITY = lib.GP_FIELD_DENSITY
    SXX = lib.GP_FIELD_SXX
    SXY = lib.GP_FIELD_SXY
    SYY = lib.GP_FIELD_SYY
    SHEAR_RATE = lib.GP_FIELD_SHEAR_RATE
    INERTIAL_NUMBER = lib.GP_FIELD_INERTIAL_NUMBER
    VISCOSITY = lib.GP_FIELD_VISCOSITY
    NUMBER_DENSITY = lib.GP_FIELD_NUMBER_DENSITY
    FLUIDITY = lib.GP_FIELD_FLUIDITY


FIELD_NAMES = tuple(name.lower() for name in Field.__members__)

# What each is, with its unit: gp_particles in gp.h.
FIELD_MEANINGS = {
    "id": "counted from 0 in the order in which particles were added",
    "column": "id of the column or set of particles that it came with",
    "x": "position along x, m",
    "y": "position along y, m",
    "vx": "velocity along x, m/s",
    "vy": "velocity along y, m/s",
    "pressure": "Pa, at least 0",
    "density": "kg/m3; with Density.NUMBER rho0 N / N0",
    "sxx": "deviatoric stress, Pa: the Cauchy stress is s - p 1",
    "sxy": "deviatoric stress, Pa",
    "syy": "deviatoric stress, Pa: -sxx, but for Stress.REGULARIZED, whose eta_r D has a trace",
    "shear_rate": "|gamma| = sqrt(D:D / 2), D = (L + L^T) / 2, 1/s (Jin et al. 2021, 3.3)",
    "inertial_number": "I = 2 d |gamma| / sqrt(p / rho_s) by the pressure of this moment, 0 where p = 0 (Jin et al. 2021, 3.4)",
    "viscosity": "tau / sqrt(|gamma|^2 + delta^2), tau = sqrt(s:s / 2), or eta_r, Pa s (Jin et al. 2021, 3.6)",
    "number_density": "N, the sum of the weights of the neighbours within interaction_radius (Jin et al. 2021, 2.4)",
    "fluidity": "g, the plastic shear rate 2 |gamma| over tau / p, 1/s; 0 without Material.nonlocal_amplitude",
}
#: Groups of fields by one name.
FIELD_GROUPS = {"position": ("x", "y"), "velocity": ("vx", "vy"), "stress": ("sxx", "sxy", "syy"), "all": FIELD_NAMES}


def field_names(fields) -> tuple[str, ...]:
    """Names of single fields, in the library's order, of names, groups ("velocity", "all") or Field values."""
    if isinstance(fields, (str, int)):
        fields = (fields,)
    chosen: set[str] = set()
    try:
        items = list(fields)
    except TypeError:
        raise ArgumentTypeError(f"fields = {fields!r}: expected names of fields") from None
    for item in items:
        if isinstance(item, Field):
            chosen.update(name.lower() for name, field in Field.__members__.items() if field in item)
        elif isinstance(item, str) and item in FIELD_GROUPS:
            chosen.update(FIELD_GROUPS[item])
        elif isinstance(item, str) and item in FIELD_NAMES:
            chosen.add(item)
        else:
            raise ArgumentError(f"field {item!r} does not exist: {near_match(item, [*FIELD_NAMES, *FIELD_GROUPS])}")
    return tuple(name for name in FIELD_NAMES if name in chosen)


def field_bits(names) -> int:
    """The bits of single fields."""
    return sum(Field[name.upper()].value for name in names)


def choice(kind: type[enum.IntEnum], name: str, value) -> int:
    """A member of the enumeration, its name in any case, or a number (which the library checks)."""
    if isinstance(value, str):
        try:
            return kind[value.upper()].value
        except KeyError:
            names = [member.name.lower() for member in kind]
            raise ArgumentError(f"{name} = {value!r}: {near_match(value.lower(), names)}") from None
    return whole(name, value, 32)
