"""The runs that docs/stability.md is made of: which trials with which options, for which study."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable

from coefficients import COEFFICIENTS, FINE, NUMERICAL, Coefficient
from constants import CONSTANTS, Constant
from long_shear import PROGRAM as WALLS
from long_shear import long_shear
from run import Program, Run
from schemes import SCHEMES, Scheme

GRAVITY, HEIGHT, WIDTH = 9.81, 0.05, 0.08  # m/s2, m, m: of every trial
# Particle-steps per CPU second of one core, of many particles; half of it with the coarse L/dl. For the estimates of the remaining time
# only.
TYPICAL_RATE, COARSE = 3e6, 16
SOUND_SPEED = 10 * math.sqrt(2 * GRAVITY * HEIGHT)  # m/s, automatic
ARREST = 0.42  # s, by when the default scheme's collapse has come to rest

SOURCES = (
    *(f"bench/{name}.[ch]" for name in ("stability", "limit", "follow", "marks", "roughness", "trial", "table", "options")),
    "examples/c/example.[ch]",
)
PROGRAMS = {
    "stability": Program("bench/stability", SOURCES, records=True),
    "constant": Program(
        "bench/stability/changed_constant.py",
        (*SOURCES, "bench/stability/changed_constant.py", "bench/stability/constants.py"),
        records=True, script=True,
    ),
    "walls": WALLS,
}  # fmt: skip


def cost_of(
    scheme: Scheme, resolution: float, end: float, cfl: float | None = None, sound: float = 1, reach: float = 4
) -> float:
    """CPU s of a collapse."""
    particles = resolution**2 * HEIGHT / WIDTH
    steps = end * sound * SOUND_SPEED * scheme.wave_factor * resolution / WIDTH / (cfl or scheme.own_cfl)
    return scheme.cost * particles * steps / TYPICAL_RATE * (1 + COARSE / resolution) * max(0.5, (reach / 4) ** 2)


def _options(**values: float | str | None) -> tuple[str, ...]:
    """--name value for what is given."""
    found: list[str] = []
    for name, value in values.items():
        if value is not None:
            found += [f"--{name.replace('_', '-')}", value if isinstance(value, str) else f"{value:.12g}"]
    return tuple(found)


def _name(*parts: str, options: tuple[str, ...] = ()) -> str:
    """The options are part of the name, so that it is the run's alone."""
    return "_".join((*parts, *(o.strip("-") for o in options)))


def collapse(scheme: str, resolution: int, end: float, long: bool = False, **more: float | None) -> Run:
    """One collapse, instant release."""
    s = SCHEMES[scheme]
    options = _options(resolution=resolution, end=end, **more)
    reach = more.get("horizon") or more.get("interaction_radius") or 4
    cost = cost_of(s, resolution, end, more.get("cfl"), more.get("sound_factor") or 1, reach)
    return Run(
        _name("collapse", scheme, options=options), "stability", ("collapse", "--scheme", scheme, *options), cost, long
    )


# ---------------------------------------------------------------------------------------- largest time step

LIMIT_END, LAYER_END = 0.6, 0.3  # s: a collapse has come to rest by then, and the jitter of a layer died down
# Of the default scheme's layer beside the horizons: bulk_viscosity and zero_energy_penalty, which count in the theory.
LIMIT_DAMPING = ((0.0, 0.02), (1.0, 0.02), (0.1, 0.0), (0.1, 0.5))


def limit(
    scheme: str,
    scene: str,
    resolution: int | None = None,
    sound: float = 1,
    horizon: float = 4,
    delta: float | None = None,
    damping: tuple[float, float] | None = None,
) -> Run:
    """The search for the largest stable time step. The collapse's particles are jittered as little as an ensemble's."""
    s = SCHEMES[scheme]
    resolution = resolution or s.limit_resolution
    layer = scene == "layer"
    seeds = 2 if not layer and s.key == "default" else 1
    options = _options(
        resolution=resolution,
        sound_factor=None if sound == 1 else sound,
        **{s.reach_option: None if horizon == 4 else horizon},
        delta=s.delta_option if delta in (None, s.deltas[0]) else delta,
        bulk_viscosity=damping[0] if damping else None,
        penalty=damping[1] if damping else None,
        seeds=None if seeds == 1 else seeds,
    )
    end = LAYER_END if layer else LIMIT_END
    arguments = (
        f"limit_{scene}", "--scheme", scheme, "--end", f"{end:g}", "--jitter", "0.05" if layer else "0.01",
        "--smallest", f"{s.smallest:g}", *options,
    )  # fmt: skip
    # Reference, ladder and bisections: as much as some runs with the smallest step.
    width = 20 / resolution if layer else 1
    cost = (9 if layer else 4) * seeds * width * cost_of(s, resolution, end, s.smallest, sound, horizon)
    return Run(_name("limit", scene, scheme, options=options), "stability", arguments, cost)


@dataclass(frozen=True)
class Axis:
    """Of the map of largest time steps. Coarse where only the axis counts and fine would be dear."""

    name: str
    values: tuple[float, ...]
    of: Callable[[Scheme], tuple[float, ...]]  # the values of a scheme
    run: Callable[[str, float], Run]


AXES = (
    Axis("L/dl", (16, 32), lambda s: s.limit_resolutions, lambda s, v: limit(s, "collapse", resolution=int(v))),
    Axis("c0 / automatic (L/dl = 16)", (0.5, 1, 2), lambda s: s.limit_sounds, lambda s, v: limit(s, "collapse", resolution=16, sound=v)),
    Axis("horizon / dl", (2.2, 3, 4, 5), lambda s: s.limit_horizons, lambda s, v: limit(s, "collapse", horizon=v)),
    Axis("delta (1/s; L/dl = 16)", (1e-6, 1e-4, 1e-2), lambda s: s.limit_deltas, lambda s, v: limit(s, "collapse", resolution=16, delta=v)),
)


def limits_of(scheme: str) -> list[Run]:
    """Along each axis through the scheme's own values."""
    s = SCHEMES[scheme]
    found = [limit(scheme, scene) for scene in ("collapse", "layer")]
    for axis in AXES:
        found += [axis.run(scheme, value) for value in axis.of(s)]
    found += [limit(scheme, "layer", horizon=h) for h in s.limit_horizons]
    if scheme == "default":
        found += [limit(scheme, "layer", damping=d) for d in LIMIT_DAMPING]
    return found


# --------------------------------------------------------------------------------------------- creep, drift

CREEP_END = 3.0  # s
DRIFT_FROM = 3.0  # s


def creep(scheme: str, cfl: float | None = None, delta: float | None = None) -> Run:
    """To 3 s, with the roughness of pressure and velocity: every study of the motion as such reads these."""
    s = SCHEMES[scheme]
    return collapse(
        scheme,
        s.resolution,
        CREEP_END,
        cfl=None if cfl == s.own_cfl else cfl,
        delta=s.delta_option if delta in (None, s.deltas[0]) else delta,
        rough=1,
    )


def drift(scheme: str, cfl: float, resolution: int = 16, delta: float | None = None) -> Run:
    s = SCHEMES[scheme]
    return collapse(
        scheme,
        resolution,
        s.drift_end,
        cfl=None if cfl == s.own_cfl else cfl,
        delta=delta or s.delta_option,
        drift_from=DRIFT_FROM,
        interval=0.1,
    )


@dataclass(frozen=True)
class Rest:
    """A deposit that is looked at while it should rest."""

    scheme: Scheme
    resolution: int
    cfl: float
    delta: float | None
    run: Run

    @property
    def end(self) -> float:
        return self.scheme.drift_end

    @property
    def label(self) -> str:
        parts = [self.scheme.label, f"cfl {self.cfl:g}"]
        parts += [f"delta {self.delta:g}"] if self.scheme.drift_deltas else []
        return ", ".join(parts)


def rests_of(s: Scheme) -> list[Rest]:
    found = [Rest(s, 16, cfl, s.delta_option, drift(s.key, cfl)) for cfl in s.drift_cfls]
    found += [Rest(s, 16, s.own_cfl, delta, drift(s.key, s.own_cfl, delta=delta)) for delta in s.drift_deltas]
    if s.key == "default":
        found.append(Rest(s, 32, s.own_cfl, None, drift_fine()))
    return found


def motion_of(scheme: str) -> list[Run]:
    s = SCHEMES[scheme]
    return [creep(scheme, cfl=c) for c in s.cfls] + [creep(scheme, delta=d) for d in s.deltas]


# ---------------------------------------------------------------------------------- pressure, zero-energy modes

ROUGH_HORIZONS = (2.2, 2.6, 3.0)
UNDAMPED = {"zero-energy penalty": "penalty", "density diffusion": "diffusion", "bulk viscosity": "bulk_viscosity"}
PENALTIES = (0.0, 0.005, 0.01, 0.02, 0.04, 0.1)
MODE_PENALTIES = (0.0, 0.02, 0.1, 0.3, 0.5)  # inside the yield surface the least is 0.2
MODES = ("checkerboard", "stripes")


def rough_horizon(horizon: float) -> Run:
    return collapse("default", 32, 1.0, horizon=horizon, rough=1)


def undamped(name: str) -> Run:
    """Without one of the coefficients that smooth."""
    return collapse("default", 32, 1.0, rough=1, **{UNDAMPED[name]: 0.0})


def mode(pattern: str, penalty: float) -> Run:
    options = _options(penalty=penalty)
    arguments = ("layer", "--mode", pattern, "--end", "0.02", "--interval", "0.0002", "--rough", "1", *options)
    return Run(_name("mode", pattern, options=options), "stability", arguments, 0.3)


# --------------------------------------------------------------------------------------------- sensitivity

SEEDS = {8: 24, 16: 24, 32: 12, 64: 6}  # runs of an ensemble by resolution
MORE_SEEDS = 24  # of the defaults and of the values that the criterion is about, L/dl = 32
FEW_SEEDS = 3  # where the bits should be the same, and where more would be too dear
JITTER = 0.01  # dl: enough for the runs of an ensemble to be independent, too little to matter itself
RESTED = 0.05  # s at rest after which nothing moves any more


def ensemble(options: tuple[str, ...] = (), resolution: int = 32, seeds: int | None = None, scale: float = 1) -> Run:
    """Collapses that differ by their jitter alone, to their rest or 1 s. scale: of the cost."""
    seeds = seeds or SEEDS[resolution]
    jitter = () if "--jitter" in options else ("--jitter", f"{JITTER:g}")
    arguments = (
        "collapse", "--resolution", str(resolution), "--end", "1", "--interval", "0.005", "--rested", f"{RESTED:g}",
        "--seeds", str(seeds), *jitter, *options,
    )  # fmt: skip
    cost = seeds * scale * cost_of(SCHEMES["default"], resolution, 0.45)
    return Run(_name(f"ensemble_r{resolution}", options=options), "stability", arguments, cost)


def base_ensemble(resolution: int = 32) -> Run:
    return ensemble(resolution=resolution, seeds=MORE_SEEDS if resolution == 32 else None)


def _scale(c: Coefficient, value: float) -> float:
    if c.option == "--cfl":
        return c.default / value
    if c.option == "--sound-factor":
        return value
    return max(0.5, (value / 4) ** 2) if c.option == "--horizon" else 1.0


def varied(c: Coefficient, value: float, resolution: int = 32) -> Run:
    if value == c.default:
        return base_ensemble(resolution)
    scale = _scale(c, value)
    seeds = MORE_SEEDS if resolution == 32 and value in (c.half, c.twice) else None
    if c.inert or resolution * scale > 128:
        seeds = FEW_SEEDS
    return ensemble((c.option, f"{value:g}"), resolution, seeds, scale)


CONSTANT_SEEDS = MORE_SEEDS
COMPILE_SECONDS = 5.0  # CPU s, of what a constant is in; all of the library, before the first, takes some 150


def by_constant(constant: Constant, value: str) -> Run:
    """The ensemble of the defaults with the library changed."""
    usual = ensemble(seeds=CONSTANT_SEEDS)
    cost = usual.cost + COMPILE_SECONDS
    return Run(
        _name("constant", constant.name, value), "constant", (constant.name, value, "stability", *usual.arguments), cost
    )


def by_constants() -> list[Run]:
    return [by_constant(c, value) for c in CONSTANTS for value in c.others]


# Whether a narrower horizon, which costs less, is as sure: by resolution, against the finest.
HORIZONS = (2.5, 3.0, 4.0, 6.0)
HORIZON_RESOLUTIONS = (16, 32, 64)


def by_horizon(resolution: int, horizon: float) -> Run:
    return varied(next(c for c in NUMERICAL if c.name == "horizon"), horizon, resolution)


def threads_run(threads: int) -> Run:
    """A single run, for the comparison bit by bit."""
    return collapse("default", 32, ARREST, threads=threads)


# Coarse deposits of beads and of grains so large that their friction is mu_2 at any rate: whether they come to rest.
COARSE_HORIZONS = (2.2, 3.0, 4.0, 6.0)
COARSE_DIAMETERS = (0.002, 0.1, 1.0, 100.0)  # m
COARSE_RESOLUTIONS = (8, 16)


def coarse(resolution: int, diameter: float, horizon: float) -> Run:
    options = ("--horizon", f"{horizon:g}", "--diameter", f"{diameter:g}")
    return ensemble(options, resolution, MORE_SEEDS, 2)


def sensitivity() -> list[Run]:
    found = [base_ensemble()] + [varied(c, value) for c in COEFFICIENTS for value in c.values]
    return found + [threads_run(n) for n in (1, 2)]


def sensitivity_fine() -> list[Run]:
    chosen = [c for c in NUMERICAL if c.name in FINE]
    return [base_ensemble(64)] + [varied(c, value, 64) for c in chosen for value in (c.half, c.twice)]


# --------------------------------------------------------------------------------------------------- large

RESOLUTIONS = {8: 24, 16: 24, 32: MORE_SEEDS, 64: 6, 128: 1, 256: 1, 512: 1}  # seeds
LONG_RESOLUTIONS = (256, 512)
FINEST = 128  # what others are compared with: the finest that is not a matter of hours
MILLION = 1264  # spacings in the width: 998,560 particles
MILLION_STEPS = 300


def resolution_run(resolution: int) -> Run:
    run = ensemble(resolution=resolution, seeds=RESOLUTIONS[resolution])
    return Run(run.name, run.program, run.arguments, run.cost, resolution in LONG_RESOLUTIONS)


def million() -> Run:
    return Run(
        "million",
        "stability",
        ("collapse", "--resolution", str(MILLION), "--steps", str(MILLION_STEPS)),
        MILLION_STEPS,
        True,
    )


def drift_fine() -> Run:
    return drift("default", SCHEMES["default"].own_cfl, 32)


def studies() -> dict[str, list[Run]]:
    """All runs by study."""
    return {
        "limits": [run for scheme in SCHEMES for run in limits_of(scheme)],
        "creep": [run for scheme in SCHEMES for run in motion_of(scheme)],
        "drift": [rest.run for s in SCHEMES.values() for rest in rests_of(s)],
        "roughness": [rough_horizon(h) for h in ROUGH_HORIZONS] + [undamped(name) for name in UNDAMPED],
        "modes": [mode(pattern, penalty) for pattern in MODES for penalty in MODE_PENALTIES],
        "sensitivity": sensitivity(),
        "sensitivity_fine": sensitivity_fine(),
        "constants": by_constants(),
        "horizons": [by_horizon(r, h) for r in HORIZON_RESOLUTIONS for h in HORIZONS] + [resolution_run(FINEST)],
        "coarse": [
            coarse(r, d, h) for r in COARSE_RESOLUTIONS for d in COARSE_DIAMETERS for h in COARSE_HORIZONS
        ],
        "resolution": [resolution_run(r) for r in RESOLUTIONS],
        "long_shear": long_shear(),
        "million": [million()],
    }
