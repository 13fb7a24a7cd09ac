"""The runs that docs/validation.md is made of: which program with which options, for which study."""
from __future__ import annotations

import math
from dataclasses import dataclass

import references as ref
from convergence_runs import PROGRAM as COLLAPSE
from convergence_runs import convergence
from fluid_runs import PROGRAM as FLUIDITY
from fluid_runs import fluid
from run import Program, Run, cheapest_first
from wall_runs import PROGRAM as WALLS
from wall_runs import hoppers, walls

# Side walls. What counts is channel_friction / channel_width. The paper does not give the width of its channel, so the study
# SIDE_WALLS varies the ratio. "walls" is a channel ten grains wide whose walls have the friction of glass on Plexiglas,
# tan 13.5 degrees (Jop, Forterre & Pouliquen 2005 found tan 10.4 degrees for glass on glass).
CHANNEL_WIDTH = 0.02  # m
CHANNEL_FRICTION = 0.24
SIDE_CHANNEL = (0.10, 0.18)  # m, -: of the one-sided experiment (Mangeney et al. 2010, Ionescu et al. 2015)
SIDE_WALLS = (1.8, 4.0, 8.0, 12.0, 16.0)  # 1/m; 1.8: the channel of Mangeney et al. (2010), 0.1 m, and 0.18

GRAVITY = 9.81  # m/s2
# Particle-steps per CPU second of one core, for the estimates of the remaining time only.
TYPICAL_RATE = 2.3e6

PROGRAMS = {
    "scene": Program(
        "bench/scene",
        ("bench/scene.c", "bench/options.[ch]", "bench/record.[ch]", "bench/marks.[ch]", "bench/table.[ch]", "examples/c/example.[ch]"),
        records=True,
    ),
    "couette": Program("examples/c/couette", ("examples/c/couette.c", "examples/c/example.[ch]")),
    "exact": Program("bench/exact", ("bench/exact*.[ch]", "bench/options.[ch]"), refuses=True),
    "collapse": COLLAPSE,
    "walls": WALLS,
    "fluidity": FLUIDITY,
}


@dataclass(frozen=True)
class Scheme:
    """A scheme and its friction: what the columns of the tables are."""

    key: str
    label: str
    options: tuple[str, ...]
    steps: float = 1.0  # time steps relative to the default scheme
    paper: bool = False


SCHEMES = {
    scheme.key: scheme
    for scheme in (
        Scheme("default", "default", ()),
        Scheme(
            "raised",
            "default, raised friction",
            ("--mu-s-degrees", f"{ref.RAISED_MU_S_DEGREES}", "--mu-2-degrees", f"{ref.RAISED_MU_2_DEGREES}"),
        ),
        Scheme(
            "walls",
            "default, side walls",
            ("--channel-width", f"{CHANNEL_WIDTH}", "--channel-friction", f"{CHANNEL_FRICTION}"),
        ),
        Scheme("nonlocal_1", "paper, non-local, factor 1", ("--preset", "paper", "--friction-factor", "1"), 3.5, True),
        Scheme("nonlocal_2", "paper as printed, factor 2", ("--preset", "paper", "--friction-factor", "2"), 3.5, True),
        Scheme("local_1", "paper, local, factor 1", ("--preset", "local", "--friction-factor", "1"), 3.5, True),
        Scheme("local_2", "paper, local, factor 2", ("--preset", "local", "--friction-factor", "2"), 3.5, True),
    )
}

RESOLUTIONS = (16, 32, 64, 128)
HORIZONS = (2.2, 3.0, 4.0)
HORIZON_LENGTH = 0.01  # m: 4 dl at L/dl = 32
LIFT_TIMES = (0.0, 0.02, 0.05, 0.1, 0.2)  # s
DEFAULT_LIFT_TIME = 0.1
ASPECTS = (0.5, 1.0, 1.42, 2.0, 3.0, 5.0, 7.0, 10.0)
BOTH_SIDE_TIMES = "0.12,0.129,0.189,0.22,0.42,1,2,3"
CODE_RESOLUTIONS = (16, 32, 64, 128)
CONTACT_SPACINGS = 64  # spacings in the height of the contact-dynamics columns
# Case by its name in the report: what the program calls it, more options, resolutions, cost of the coarsest in CPU s.
EXACT_CASES: dict[str, tuple[str, tuple[str, ...], tuple[int, ...], float]] = {
    "operators, jittered lattice": ("gradient", (), (20, 40, 80, 160), 0.05),
    "hydrostatic": ("hydrostatic", (), (10, 20, 40, 80), 0.15),
    "shear box": ("shear_box", (), (10, 20, 40), 1.0),
    "Bagnold, c0 = 10 u": ("bagnold", ("--end", "1.5"), (10, 20, 40), 0.8),
    "Bagnold, c0 = 20 u": ("bagnold", ("--end", "1.5", "--sound-speed", "20"), (10, 20, 40), 1.6),
    # c0: 10 u, or what is 10 sqrt(2 g h) at least, for a layer that its own weight does not compress
    "Bagnold, 23°, c0 = 25 u": ("bagnold", ("--angle", "23", "--end", "4", "--sound-speed", "25"), (10, 20, 40), 0.5),
    "Bagnold, 23°, c0 = 50 u": ("bagnold", ("--angle", "23", "--end", "4", "--sound-speed", "50"), (10, 20, 40), 1.0),
    "Bagnold, 24°, c0 = 15 u": ("bagnold", ("--angle", "24", "--end", "4", "--sound-speed", "15"), (10, 20, 40), 0.5),
    "Bagnold, 28°, c0 = 10 u": ("bagnold", ("--angle", "28", "--end", "4", "--columns", "48"), (10, 20, 40), 8.5),
    "Bagnold, 28°, c0 = 10 u, 12 dl wide": ("bagnold", ("--angle", "28", "--end", "4"), (10, 20, 40), 2.1),
    "Bagnold start-up, c0 = 10 u": ("bagnold_startup", (), (20, 40), 0.3),
    "Bagnold start-up, c0 = 40 u": ("bagnold_startup", ("--sound-speed", "40"), (20, 40), 1.2),
    "chute": ("chute", (), (20, 40, 80), 1.4),
    "chute, horizon 2.5": ("chute", ("--horizon", "2.5"), (20, 40, 80), 0.7),
    "Couette, Cawthorn's cell": ("couette_cell", (), (15, 30, 60), 3.0),
    "slope of 20 degrees": ("slope", ("--end", "6"), (10, 20, 40), 1.5),
    "slope of 20 degrees, 60 s": ("slope", ("--end", "60"), (16,), 25.0),
}
COUETTE_CASES = (1, 2, 3)


def _number(value: float) -> str:
    return f"{value:g}"


def collapse_cost(
    area: float, height: float, spacing: float, end: float, steps: float = 1.0, reach: float = 4.0
) -> float:
    """CPU s of a collapse: particles x steps of 0.8 dl / (1.14 c0), c0 = 10 sqrt(2 g H), x neighbours."""
    particles = area / spacing**2
    sound_speed = 10 * math.sqrt(2 * GRAVITY * height)
    return particles * steps * end * sound_speed * 1.14 / (0.8 * spacing) / TYPICAL_RATE * max(0.5, (reach / 4.0) ** 2)


def both_side(
    scheme: str,
    aspect: float = 1.25,
    resolution: int = 32,
    end: float = 3.0,
    lift_time: float = DEFAULT_LIFT_TIME,
    horizon: float | None = None,
    horizon_length: float | None = None,
) -> Run:
    """A two-sided collapse of the paper: L = 0.08 m."""
    s = SCHEMES[scheme]
    spacing = ref.WIDTH / resolution
    name = f"both_side_a{aspect:g}_r{resolution}_{scheme}"
    more: list[str] = []
    reach = 4.0
    if horizon not in (None, 4.0):
        name += f"_horizon{horizon:g}"
        more += ["--horizon", _number(horizon)]
        reach = horizon
    if horizon_length is not None and not math.isclose(horizon_length, 4 * spacing):
        name += f"_horizon{1000 * horizon_length:g}mm"
        more += ["--horizon-length", _number(horizon_length)]
        reach = horizon_length / spacing
    if lift_time != DEFAULT_LIFT_TIME:
        name += f"_lift{lift_time:g}"
        more += ["--lift-time", _number(lift_time)]
    name += f"_t{end:g}"
    tall = aspect == 5
    times = "0.2,0.36,0.67,1" if tall else BOTH_SIDE_TIMES
    sections = "0.02" if tall else "0.01,0.03"
    height = aspect * ref.WIDTH / 2
    return Run(
        name,
        "scene",
        (
            "both_side",
            "--aspect",
            _number(aspect),
            "--resolution",
            str(resolution),
            "--end",
            _number(end),
            "--times",
            times,
            "--velocity-section",
            sections,
            *more,
            *s.options,
        ),
        collapse_cost(height * ref.WIDTH, height, spacing, end, s.steps, reach),
    )


def one_side(scheme: str) -> Run:
    """Section 5.2 of the paper, with height and length as its experiment had them. Its channel is known (SIDE_CHANNEL)."""
    s = SCHEMES[scheme]
    options, name = s.options, scheme
    if scheme == "walls":
        options = ("--channel-width", f"{SIDE_CHANNEL[0]}", "--channel-friction", f"{SIDE_CHANNEL[1]}")
        name = "own_walls"
    return Run(
        f"one_side_{name}",
        "scene",
        ("one_side", "--end", "1.02", "--times", "0.18,0.3,0.42,1.02", *options),
        collapse_cost(0.14 * 0.20, 0.14, 0.0025, 1.02, s.steps),
    )


def colliding(case: int, scheme: str) -> Run:
    """Section 6 of the paper. Where only the profiles to 0.4 s are compared, case I ends at 0.5 s."""
    s = SCHEMES[scheme]
    full = scheme in ("default", "nonlocal_2")
    end = 0.6 if case == 2 else 1.61 if full else 0.5
    times = "0.15,0.2,0.4,0.6" if case == 2 else "0.1,0.2,0.3,0.4,0.5,0.8,1.25,1.61"
    area = 0.152 * 0.12 if case == 2 else (0.156 + 0.054) * 0.08
    return Run(
        f"colliding{case}_{scheme}",
        "scene",
        ("colliding", "--case", str(case), "--end", _number(end), "--times", times, *s.options),
        collapse_cost(area, 0.155, 0.002, end, s.steps),
    )


def scaling(aspect: float, sides: int) -> Run:
    """Instant release, to six times sqrt(H0/g); L0 = 0.04 m: half the width (two sides) or the width (one side)."""
    per_reference = 32 if aspect <= 2 else 16
    reference = 0.04
    height = aspect * reference
    end = 6 * math.sqrt(height / GRAVITY)
    scene = (
        ("both_side", "--length", "0.08", "--resolution", str(2 * per_reference))
        if sides == 2
        else ("one_side", "--length", "0.04", "--resolution", str(per_reference), "--diameter", "0.002")
    )
    return Run(
        f"scaling{sides}_a{aspect:g}",
        "scene",
        (*scene, "--aspect", _number(aspect), "--lift-time", "0", "--end", f"{end:.4f}"),
        collapse_cost(sides * reference * height, height, reference / per_reference, end),
    )


def contact_dynamics(aspect: float) -> Run:
    """The columns of discs, with the friction that Lagree et al. (2011) use for them: fitted to neither.
    Their inertial number has the flow's density in it: the volume fraction is 1."""
    data = ref.CONTACT_DYNAMICS[aspect]
    height = data["height"]
    length = 2 * height / aspect
    resolution = round(length / height * CONTACT_SPACINGS)
    unit = math.sqrt(height / GRAVITY)
    times = ",".join(f"{k * unit:.6f}" for k in data["times"])
    end = max(data["times"]) * unit
    return Run(
        f"contact_dynamics_a{aspect:g}",
        "scene",
        (
            "both_side",
            "--length",
            f"{length:.6f}",
            "--aspect",
            _number(aspect),
            "--resolution",
            str(resolution),
            "--diameter",
            _number(data["diameter"]),
            "--lift-time",
            "0",
            "--mu-s",
            _number(ref.LAGREE_MU_S),
            "--mu-2",
            _number(ref.LAGREE_MU_2),
            "--i0",
            _number(ref.LAGREE_I0),
            "--volume-fraction",
            "1",
            "--end",
            f"{end:.6f}",
            "--interval",
            f"{unit / 10:.6f}",
            "--times",
            times,
        ),
        collapse_cost(length * height, height, height / CONTACT_SPACINGS, end),
    )


def couette(case: int) -> Run:
    return Run(f"couette_case{case}", "couette", ("--case", str(case), "--threads", "1"), 9.0)


def exact(case: str, resolution: int) -> Run:
    """Layers of a fixed number of columns: particles and steps both grow with the resolution."""
    name, more, resolutions, cost = EXACT_CASES[case]
    options = "".join(f"_{text.strip('-')}" for text in more)
    return Run(
        f"exact_{name}{options}_{resolution}",
        "exact",
        (name, "--resolution", str(resolution), *more),
        cost * (resolution / resolutions[0]) ** 2,
    )


def side_walls(ratio: float) -> Run:
    """Default scheme in a channel: a = 1.25, instant release, friction over width in 1/m."""
    spacing = ref.WIDTH / 32
    return Run(
        f"side_walls_{ratio:g}",
        "scene",
        (
            "both_side", "--resolution", "32", "--lift-time", "0", "--end", "0.5", "--times", "0.42",
            "--channel-width", f"{CHANNEL_WIDTH}", "--channel-friction", f"{ratio * CHANNEL_WIDTH:g}",
        ),
        collapse_cost(0.05 * ref.WIDTH, 0.05, spacing, 0.5),
    )


def resolution_end(scheme: str, resolution: int) -> float:
    """Fine runs end soon after the instant at which peaks are compared."""
    if SCHEMES[scheme].paper:
        return {16: 3.0, 32: 3.0}.get(resolution, 0.45)
    return {16: 3.0, 32: 3.0, 64: 1.0}.get(resolution, 0.6)


def resolution_run(scheme: str, resolution: int) -> Run:
    return both_side(scheme, resolution=resolution, end=resolution_end(scheme, resolution))


RESOLUTION_STUDY = {
    "default": RESOLUTIONS,
    "raised": RESOLUTIONS,
    "walls": RESOLUTIONS,
    "nonlocal_2": RESOLUTIONS,
    "nonlocal_1": (16, 32, 64),
    "local_1": (32,),
    "local_2": (32,),
}
HORIZON_STUDY = {"default": HORIZONS, "nonlocal_2": HORIZONS}
HORIZON_LENGTH_STUDY = {"default": (16, 32, 64), "nonlocal_2": (16, 32, 64)}
MAIN_SCENES = {  # of which schemes there are runs
    "both_1.25": tuple(SCHEMES),
    "both_5": tuple(SCHEMES),
    "one_side": tuple(key for key in SCHEMES if key != "local_2"),
    "colliding_1": tuple(key for key in SCHEMES if key != "local_2"),
    "colliding_2": tuple(SCHEMES),
}


def main_run(scene: str, scheme: str) -> Run:
    """The run of the main table for one of MAIN_SCENES."""
    if scene == "both_1.25":
        return resolution_run(scheme, 32)
    if scene == "both_5":
        return both_side(scheme, aspect=5, end=1.05)
    if scene == "one_side":
        return one_side(scheme)
    return colliding(int(scene[-1]), scheme)


def horizon_run(scheme: str, horizon: float) -> Run:
    return both_side(scheme, horizon=horizon)


def horizon_length_run(scheme: str, resolution: int) -> Run:
    if resolution == 32:
        return resolution_run(scheme, 32)
    return both_side(scheme, resolution=resolution, end=0.45, horizon_length=HORIZON_LENGTH)


def raised_run(resolution: int) -> Run:
    """Raised friction, gates gone at once."""
    return both_side("raised", resolution=resolution, end=0.6, lift_time=0.0)


def lift_run(lift_time: float) -> Run:
    return both_side("default", lift_time=lift_time)


def code_run(resolution: int) -> Run:
    """Instant release, as the independent codes have it."""
    return both_side("default", resolution=resolution, end=3.0 if resolution <= 64 else 0.6, lift_time=0.0)


def studies() -> dict[str, list[Run]]:
    """All runs by study."""
    return {
        "main": [main_run(scene, scheme) for scene, schemes in MAIN_SCENES.items() for scheme in schemes],
        "horizon": [horizon_run(scheme, h) for scheme, all_h in HORIZON_STUDY.items() for h in all_h],
        "horizon_length": [
            horizon_length_run(scheme, r) for scheme, all_r in HORIZON_LENGTH_STUDY.items() for r in all_r
        ],
        "resolution": [resolution_run(scheme, r) for scheme, all_r in RESOLUTION_STUDY.items() for r in all_r],
        "side_walls": [side_walls(ratio) for ratio in SIDE_WALLS],
        "lift": [lift_run(t) for t in LIFT_TIMES],
        "raised": [raised_run(r) for r in RESOLUTIONS],
        "codes": [code_run(r) for r in CODE_RESOLUTIONS],
        "scaling": [scaling(a, sides) for sides in (2, 1) for a in ASPECTS],
        "contact_dynamics": [contact_dynamics(a) for a in ref.CONTACT_DYNAMICS],
        "couette": [couette(case) for case in COUETTE_CASES],
        "exact": [exact(case, r) for case, (_, _, resolutions, _) in EXACT_CASES.items() for r in resolutions],
        "convergence": convergence(),
        "walls": walls(),
        "hopper": hoppers(),
        "fluidity": fluid(),
    }


def all_runs() -> list[Run]:
    """Every run once, cheapest first."""
    return cheapest_first(studies())
