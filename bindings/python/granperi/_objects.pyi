# Written by bindings/generate from include/granperi/gp.h and _objects.py. Do not edit.

from __future__ import annotations
import copy
import enum
import inspect
import itertools
import keyword
import textwrap
from typing import Any, Iterator, Literal, TypedDict, Unpack
import numpy as np
from ._enums import Density, InitialPressure, Preset, Stress, choice
from ._errors import ArgumentTypeError, check, doubles, near_match, number, pointer, whole
from ._library import ffi, lib
from ._reference import MEANINGS
from ._tables import as_html


class Parameters:
    """What the keyword objects share: one attribute per field of the library's struct.

    An unknown name is an error that lists the valid ones; numbers are checked by the library when the object is used.
    """

    def __init__(self, **values: Any): ...

    @classmethod
    def _defaults(cls) -> dict[str, Any]: ...

    def _own_defaults(self) -> dict[str, Any]: ...

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """The names of all parameters, in the library's order.

        Returns:
            A tuple of names.

        Example:
            print(granperi.Material.names())
        """
        ...

    def _set(self, name: str, value: Any) -> None: ...

    @classmethod
    def _unknown(cls, name: str) -> str: ...

    def __dir__(self) -> list[str]: ...

    def __iter__(self) -> Iterator[tuple[str, Any]]: ...

    def __eq__(self, other: object) -> bool: ...

    def __repr__(self) -> str: ...

    def _repr_html_(self) -> str: ...

    def __getstate__(self) -> dict[str, Any]: ...

    def __setstate__(self, state: dict[str, Any]) -> None: ...

    def replace(self, **values: Any):
        """A copy with some values changed.

        Args:
            **values: parameters by keyword.

        Returns:
            The copy.

        Raises:
            ArgumentTypeError: a name that does not exist, or a value of the wrong type.

        Example:
            smooth = granperi.Plate.floor(-0.3, 0.3).replace(friction="free_slip")
        """
        ...

    def _fill(self):
        """The struct, and what has to live as long as it."""
        ...

    def _length_of(self, names: tuple[str, ...], lengths: dict[str, int]) -> int: ...

    def _is_needed(self, name: str, given: dict[str, int]) -> bool:
        """Whether this array has to be there if those are."""
        ...

    def _init_arguments(self) -> tuple: ...

def _shown(value: Any) -> str: ...

def _plain(value: Any) -> Any:
    """For tables: numbers as they are, the rest as its repr has it."""
    ...

def _types(struct: str) -> dict: ...

def _initialised(name: str, *more): ...

def _defaults_of(cls, *more) -> dict[str, Any]:
    """Every parameter with the library's default; arrays are None, their length is no parameter of its own."""
    ...

def described(struct: str, head: str) -> str:
    """A docstring: its head, and each parameter or value of the struct with type and meaning."""
    ...

def _signed(cls):
    """Shows the parameters, their defaults and meanings in help() and in the hints of editors."""
    ...


class MaterialValues(TypedDict, total=False):
    grain_density: float
    volume_fraction: float
    grain_diameter: float
    mu_s: float
    mu_2: float
    i0: float
    nonlocal_amplitude: float
    fluidity_time: float
    k0: float


class Material(Parameters):
    """A granular material; the default is glass beads."""
    grain_density: float
    """kg/m3, rho_s; > 0 [2500]"""
    volume_fraction: float
    """phi, so rho = phi rho_s; > 0, <= 1 [0.62]"""
    grain_diameter: float
    """m, d; > 0 [0.002]"""
    mu_s: float
    """friction at I = 0; >= 0 [tan 21 deg]"""
    mu_2: float
    """friction at large I; >= mu_s [tan 32 deg]"""
    i0: float
    """I at which mu is half way between; > 0 [0.3]"""
    nonlocal_amplitude: float
    """A of the granular fluidity [4], its length over grain_diameter; 0: the local mu(I) law; 0 .. 10; glass beads 0.48, discs 0.9. Needs mu_2 > mu_s > 0 and friction_factor > 0, and spacings of half a grain to resolve it; only with the default scheme, else UnsupportedError. Uniform steady flow is mu(I) as well [0]"""
    fluidity_time: float
    """s, t0 in which the fluidity follows; > 0; only with nonlocal_amplitude [1e-4]"""
    k0: float
    """sigma_h / sigma_v with which columns begin (InitialPressure.HYDROSTATIC), the stress across over that along the direction in which a column presses; 0: isotropic, or none across as Column.initial_pressure says. Within yield: (1 - m) / (1 + m) .. (1 + m) / (1 - m) with m = friction_factor mu_s, any above 0 where m >= 1. Else than 0 only with Stress.ELASTIC. Walls' friction begins unmobilised: side walls bear k0 sigma_v, the base all of the weight. Below 1 it is also the ratio in which the stresses change where the material cannot spread, by its shear modulus, (1 - k0) / (1 + k0) of the bulk modulus, at least .1 (without k0 .3): it stays while walls take weight over, until the material yields; beside walls as rough as itself it then tends to 1. Columns side by side are in balance if they have the same one [0]"""

    def __init__(
        self,
        *,
        grain_density: float = 2500,
        volume_fraction: float = 0.62,
        grain_diameter: float = 0.002,
        mu_s: float = ...,
        mu_2: float = ...,
        i0: float = 0.3,
        nonlocal_amplitude: float = 0,
        fluidity_time: float = 1e-4,
        k0: float = 0,
    ) -> None: ...

    def replace(self, **values: Unpack[MaterialValues]) -> Material: ...


class ColumnValues(TypedDict, total=False):
    x_min: float
    y_min: float
    width: float
    height: float
    material: int
    vx: float
    vy: float
    initial_pressure: InitialPressure | int | Literal["hydrostatic", "none"]


class Column(Parameters):
    """A rectangle of particles."""
    x_min: float
    """m, lower left corner"""
    y_min: float
    """m, lower left corner"""
    width: float
    """m; > 0, rounded to whole spacings (the log says so), at least one"""
    height: float
    """m; > 0, rounded to whole spacings (the log says so), at least one"""
    material: int
    """id of Simulation.add_material; 0 is always there [0]"""
    vx: float
    """m/s, initial velocity [0, 0]"""
    vy: float
    """m/s, initial velocity [0, 0]"""
    initial_pressure: InitialPressure
    """one of "hydrostatic", "none" ["hydrostatic"]. Hydrostatic: p = rho |g.n| depth below the opposite face, for each face of normal n into which gravity presses and at least half of which rests on plates or on other hydrostatic columns so borne; to it is added what rests on the opposite face: such columns, and the normal_pressure of plates. 0 where nothing bears. With Stress.ELASTIC, where one such face alone bears and no plate loads the other: the shear stress rho g.t depth along that face too, as far as the friction of the material and of the plates under it bears it; and where a side is free and mu_s >= 1, so that the friction holds it, no stress across: half the pressure, the other half as deviator. No effect with Density.NUMBER"""

    def __init__(
        self,
        *,
        x_min: float = ...,
        y_min: float = ...,
        width: float = ...,
        height: float = ...,
        material: int = 0,
        vx: float = ...,
        vy: float = ...,
        initial_pressure: InitialPressure | int | Literal["hydrostatic", "none"] = ...,
    ) -> None: ...

    def replace(self, **values: Unpack[ColumnValues]) -> Column: ...


class ConfigValues(TypedDict, total=False):
    spacing: float
    gravity_x: float
    gravity_y: float
    sound_speed: float
    cfl: float
    time_step: float
    interaction_radius: float
    horizon: float
    horizon_length: float
    nonlocal_: int
    stress: Stress | int | Literal["elastic", "regularized", "implicit"]
    density: Density | int | Literal["continuity", "number"]
    friction_factor: float
    delta: float
    collision_distance: float
    zero_energy_penalty: float
    density_diffusion: float
    channel_width: float
    channel_friction: float
    periodic_x_min: float
    periodic_x_max: float
    threads: int
    seed: int
    jitter: float
    preset: Preset | int | Literal["default", "paper", "paper_local"]
    bulk_viscosity: float
    implicit_tolerance: float
    implicit_iterations: int
    allow_unstable_step: int
    retry_halvings: int
    sleep: int


class Config(Parameters):
    """The parameters of a simulation, in SI units; lengths in dl are in spacings. The defaults follow from the preset.

    Each with its unit, meaning, range and [default]:
    """
    spacing: float
    """m, particle distance dl; 1e-9 .. 1e9 [0.0025]"""
    gravity_x: float
    """m/s2 [0]"""
    gravity_y: float
    """m/s2 [-9.81]"""
    sound_speed: float
    """m/s, artificial; 0: 10 x the largest speed that the scene can reach by falling from its highest to its lowest point, by its initial and plate velocities; or, if that is more, 60 x the speed of the hardest blow that it begins with: of a column that falls freely, through an opening too, or is thrown, against a plate or another column (not with Density.NUMBER, nor with a time_step). The log says so and what it costs. Else at least 1e-9 [0]"""
    cfl: float
    """time step over dl / (elastic wave speed), with Stress.REGULARIZED dl / c0; 0: the scheme's own (horizon 2.5: 0.59, 3: 0.71, 4: 0.95, 6: 1.42), by the default coefficients half of State.dt_limit, down to 0.42 of it where the material moves by more than 0.06 dl in a step and where a blow is foreseen; of the schemes of [1] 0.2. Else 1e-6 .. 8; beyond State.dt_limit (for these horizons 1.18, 1.44, 1.93, 2.88, in the schemes of [1] 1.0) it is refused at the first step, but see allow_unstable_step [0]"""
    time_step: float
    """s, fixed; 0: adaptive, by the smallest of the limits StepLimit.SOUND to StepLimit.VISCOSITY. Beyond State.dt_limit: refused at the first step, but see allow_unstable_step [0]"""
    interaction_radius: float
    """dl, support of the number density and of the paper's MPS operators; 1.5 .. 8 [4]"""
    horizon: float
    """dl, radius of the peridynamic operators; 1.8 .. 8: below, neighbours are too few [4]"""
    horizon_length: float
    """m, the horizon as a fixed length; 0: use horizon [0]"""
    nonlocal_: int
    """1: peridynamic force states; 0: local model [1]"""
    stress: Stress
    """one of "elastic", "regularized", "implicit" ["elastic"]"""
    density: Density
    """one of "continuity", "number" ["continuity"]"""
    friction_factor: float
    """multiplies mu(I): [1] equation 3.12 as printed amounts to 2; 0 .. 10 [1]"""
    delta: float
    """1/s, regularisation of the viscosity ([1] 3.6); with Stress.ELASTIC only of the reported one; with Stress.IMPLICIT 1e-4 and below leave the same deposit; > 0 [1e-6]"""
    collision_distance: float
    """dl, closer approaching pairs of which both flow collide (in the schemes by number density all; [1] 2.9); 0: off; 0 .. 1 [0.9]"""
    zero_energy_penalty: float
    """of the velocity that the gradient does not see, in rho c0 / dl; inside the yield surface at least 0.2 with Stress.ELASTIC; 0: off; 0 .. 0.5 [the scheme's own: 0.02]"""
    density_diffusion: float
    """smoothing of the density where the material flows, in c0 dl; 0: off; 0 .. 1 [the scheme's own: 0.2]"""
    channel_width: float
    """m, W between the side walls; 0: none. Their friction, averaged over the width, is 2 channel_friction p / W per volume against the velocity, and holds what it can [0]"""
    channel_friction: float
    """Coulomb coefficient of the side walls; needs channel_width [0]"""
    periodic_x_min: float
    """m; with periodic_x_max > periodic_x_min the scene is periodic in x: columns and particles begin within, positions return into the period now and then (they may be beyond its ends by less than a spacing), and a plate reaches over the period at most: one that just spans it has no ends"""
    periodic_x_max: float
    """m; the period is at least twice the horizon and the interaction radius and two spacings more; best a whole number of spacings [0, 0]"""
    threads: int
    """threads that work on this simulation, the calling one among them; 0: OpenMP's default (all processors, or OMP_NUM_THREADS); 0 .. 1024 [1]. The results are the same bits for any number"""
    seed: int
    """of the jitter [0]"""
    jitter: float
    """dl, columns' particles are displaced at random by up to this much in x and y; 0 .. 0.5 (exclusive) [0]"""
    preset: Preset
    """one of "default", "paper", "paper_local", set by Config(preset)"""
    bulk_viscosity: float
    """of volume changes under pressure and, inside the yield surface, of shear, in rho c0 dl: it damps elastic waves and does not act at rest; 0: off; 0 .. 1 [the scheme's own: 0.1]"""
    implicit_tolerance: float
    """with Stress.IMPLICIT: the solve of a step has converged when what is left of the momentum balance is below this share of the forces in it (root mean squares), and the rates fit the stress to its root; 1e-12 .. 1e-2 [1e-5]"""
    implicit_iterations: int
    """with Stress.IMPLICIT: Newton steps that one solve may take; a solve that needs more is DivergedError; 1 .. 10000 [100]"""
    allow_unstable_step: int
    """1: a demanded time_step or cfl beyond the stable limit is taken, with a warning; 0: it is refused [0]"""
    retry_halvings: int
    """a step that diverges is taken anew from where it began in two halves, these in halves again and so on, up to this many times; 0: it is DivergedError at once; 0 .. 20 [0]"""
    sleep: int
    """1: what rests is left out of the work (gp_step, "Sleep"); 0: all material is computed in every step. Only with the default scheme, else UnsupportedError; 0 .. 1 [0]"""

    def __init__(
        self,
        preset: Preset | int | Literal["default", "paper", "paper_local"] = ...,
        *,
        spacing: float = 0.0025,
        gravity_x: float = 0,
        gravity_y: float = -9.81,
        sound_speed: float = 0,
        cfl: float = 0,
        time_step: float = 0,
        interaction_radius: float = 4,
        horizon: float = 4,
        horizon_length: float = 0,
        nonlocal_: int = 1,
        stress: Stress | int | Literal["elastic", "regularized", "implicit"] = ...,
        density: Density | int | Literal["continuity", "number"] = ...,
        friction_factor: float = 1,
        delta: float = 1e-6,
        collision_distance: float = 0.9,
        zero_energy_penalty: float = ...,
        density_diffusion: float = ...,
        channel_width: float = 0,
        channel_friction: float = 0,
        periodic_x_min: float = ...,
        periodic_x_max: float = ...,
        threads: int = ...,
        seed: int = 0,
        jitter: float = 0,
        bulk_viscosity: float = ...,
        implicit_tolerance: float = 1e-5,
        implicit_iterations: int = 100,
        allow_unstable_step: int = 0,
        retry_halvings: int = 0,
        sleep: int = 0,
    ) -> None: ...

    def replace(self, **values: Unpack[ConfigValues]) -> Config: ...

    @classmethod
    def _defaults(cls) -> dict[str, Any]: ...

    def _own_defaults(self) -> dict[str, Any]: ...

    def _init_arguments(self) -> tuple: ...
