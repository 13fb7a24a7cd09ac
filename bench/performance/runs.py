"""The runs that docs/performance.md is made of: which programs with which options, for which study."""
from __future__ import annotations

from dataclasses import dataclass

from run import Program, Run

# Particle-steps per CPU second of one core, for the estimates of the remaining time only.
TYPICAL_RATE = 2.0e6
DEFAULT_HORIZON = 4.0
HORIZONS = (2.2, 2.5, 3.0, 4.0)
JITTER = 0.01  # dl: enough for the runs of an ensemble to be independent, too little to matter itself
END = 1.0  # s

EXAMPLE = "examples/c/example.[ch]"
TRIAL = tuple(f"bench/{name}.[ch]" for name in ("stability", "limit", "follow", "marks", "roughness", "trial", "options"))
PROGRAMS = {
    "collapse": Program("bench/stability", (*TRIAL, EXAMPLE), records=True),
    "exact": Program("bench/exact", ("bench/exact*.[ch]", "bench/options.[ch]"), refuses=True),
    "step": Program("bench/step", ("bench/step.c", "bench/options.[ch]", EXAMPLE)),
    "features": Program("bench/features", ("bench/features.c", "bench/options.[ch]", EXAMPLE)),
    "instructions": Program(
        "bench/performance/instructions.py", ("bench/performance/instructions.py", "bench/features.c"), script=True
    ),
    "threads": Program("bench/performance/threads.py", ("bench/performance/threads.py", "bench/step.c"), script=True),
    "builds": Program(
        "bench/performance/builds.py",
        ("bench/performance/builds.py", "bench/smallest.c", "CMakeLists.txt"),
        script=True,
    ),
    "machine": Program("bench/performance/machine.py", ("bench/performance/machine.py", "bench/common/computer.py"), script=True),
}


def _options(**values: float | None) -> tuple[str, ...]:
    """--name value for what is given."""
    found: list[str] = []
    for name, value in values.items():
        if value is not None:
            found += [f"--{name.replace('_', '-')}", f"{value:.12g}"]
    return tuple(found)


def _name(*parts: str, options: tuple[str, ...] = ()) -> str:
    """The options are part of the name, so that it is the run's alone."""
    return "_".join((*parts, *(o.strip("-") for o in options)))


# ---------------------------------------------------------------------------------------------- collapses


@dataclass(frozen=True)
class Scene:
    key: str
    label: str
    length: float  # m, of the column
    aspect: float
    sides: int
    options: tuple[str, ...]
    resolutions: dict[int, int]  # spacings in the length: runs of the ensemble
    references: dict[
        int, int
    ]  # the same of the reference, which ends when it has come to rest; the finest that is there
    variants_at: tuple[int, ...]  # resolutions at which other settings than the horizon are tried
    horizons: tuple[float, ...] = HORIZONS

    @property
    def reference_length(self) -> float:
        """L0 (m)."""
        return self.length / self.sides

    @property
    def height(self) -> float:
        return self.aspect * self.reference_length


OF_A_1_25 = {8: 16, 16: 16, 24: 12, 32: 12, 48: 6, 64: 4, 80: 3, 96: 2, 128: 2}
OF_A_5 = {8: 12, 12: 12, 16: 12, 24: 6, 32: 4}
OF_ONE_SIDE = {20: 12, 30: 12, 40: 8, 56: 6, 80: 4}
WITH_WALL = ("--length", "0.2", "--aspect", "0.7", "--sides", "1", "--diameter", "0.0007")
FEWER = (2.5, 3.0, 4.0)
SCENES = {
    scene.key: scene
    for scene in (
        Scene("a1.25", "both sides, a = 1.25", 0.08, 1.25, 2, (), OF_A_1_25, {128: 4, 256: 2}, (16, 32)),
        Scene("a5", "both sides, a = 5", 0.08, 5.0, 2, ("--aspect", "5"), OF_A_5, {64: 3, 128: 1}, (16,), FEWER),
        Scene("one_side", "one side, a = 0.7", 0.20, 0.7, 1, WITH_WALL, OF_ONE_SIDE, {160: 3, 320: 1}, (40,), FEWER),
    )
}
LONG_REFERENCE = {"a1.25": 256, "a5": 128, "one_side": 320}


@dataclass(frozen=True)
class Setting:
    """What is varied beside spacing and horizon."""

    key: str
    label: str
    options: tuple[str, ...]
    work: float  # of a run, in that of the defaults
    scheme: str = "default"
    long: bool = False

    @property
    def horizon(self) -> float:
        given = dict(zip(self.options[::2], self.options[1::2]))
        return float(given.get("--horizon", DEFAULT_HORIZON))


FASTER = ("--cfl", "1", "--sound-factor")
SETTINGS = {
    setting.key: setting
    for setting in (
        Setting("cfl0.2", "cfl 0.2", ("--cfl", "0.2"), 4),
        Setting("cfl0.4", "cfl 0.4", ("--cfl", "0.4"), 2),
        Setting("cfl1", "cfl 1", ("--cfl", "1"), 0.8),
        Setting("sound0.5", "c0 = 5 u_max", ("--sound-factor", "0.5"), 0.5),
        Setting("sound0.7", "c0 = 7 u_max", ("--sound-factor", "0.7"), 0.7),
        Setting("sound2", "c0 = 20 u_max", ("--sound-factor", "2"), 2),
        Setting("cheap3", "horizon 3, cfl 1, c0 = 7 u_max", ("--horizon", "3", *FASTER, "0.7"), 0.35),
        Setting("cheap2.5", "horizon 2.5, cfl 1, c0 = 5 u_max", ("--horizon", "2.5", *FASTER, "0.5"), 0.25),
        Setting("cheap4", "cfl 1, c0 = 5 u_max", (*FASTER, "0.5"), 0.4),
        Setting("paper", "paper, non-local", (), 5, "paper"),
        Setting("local", "paper, local", (), 5, "local"),
        Setting("local_radius2.5", "paper, local, radius 2.5", ("--interaction-radius", "2.5"), 4, "local"),
        Setting("local_radius3", "paper, local, radius 3", ("--interaction-radius", "3"), 4, "local"),
        Setting("implicit", "implicit, delta 1e-2", ("--delta", "1e-2"), 12, "implicit"),
    )
}  # fmt: skip
CHEAP = ("cheap4", "cheap3", "cheap2.5")  # also along all resolutions of a = 1.25


def _cost(scene: Scene, resolution: int, horizon: float = DEFAULT_HORIZON, end: float = END) -> float:
    """CPU s of a run."""
    spacing = scene.length / resolution
    particles = scene.height * scene.length / spacing**2
    wave = 1.14 * 10 * (2 * 9.81 * scene.height) ** 0.5
    return particles * end * wave / (0.8 * spacing) / TYPICAL_RATE * max(0.5, (horizon / 4) ** 1.5)


def _ensemble(scene: Scene, resolution: int, seeds: int, scheme: str, options: tuple[str, ...], work: float,
              long: bool = False, rested: bool = False) -> Run:  # fmt: skip
    end = ("--interval", "0.005", "--rested", "0.05") if rested else ("--interval", f"{END:g}")
    arguments = (
        "collapse", "--scheme", scheme, "--resolution", str(resolution), "--end", f"{END:g}", *end,
        "--jitter", f"{JITTER:g}", "--seeds", str(seeds), *scene.options, *options,
    )  # fmt: skip
    name = _name(scene.key, scheme, f"r{resolution}", *(("rested",) if rested else ()), options=options)
    return Run(name, "collapse", arguments, seeds * work * _cost(scene, resolution), long)


def collapse(scene: str, resolution: int, horizon: float = DEFAULT_HORIZON) -> Run:
    """An ensemble of the default scheme to 1 s; nothing is looked at before its end, so that its CPU time is that of the
    steps."""
    s = SCENES[scene]
    seeds = s.resolutions.get(resolution, 1)
    options = () if horizon == DEFAULT_HORIZON else _options(horizon=horizon)
    return _ensemble(s, resolution, seeds, "default", options, _cost(s, 32, horizon) / _cost(s, 32))


def reference(scene: str, resolution: int) -> Run:
    """The converged solution."""
    s = SCENES[scene]
    long = resolution == LONG_REFERENCE[scene]
    return _ensemble(s, resolution, s.references[resolution], "default", (), 0.6, long, rested=True)


def varied(scene: str, resolution: int, setting: str) -> Run:
    s, one = SCENES[scene], SETTINGS[setting]
    seeds = max(2, s.resolutions.get(resolution, 1) // (1 if one.work < 3 else 3))
    return _ensemble(
        s, resolution, seeds, one.scheme, one.options, one.work, one.scheme == "implicit" and resolution > 16
    )


def settings_of(scene: str) -> list[tuple[str, int]]:
    """Settings and resolutions that are tried of a scene. The paper's schemes and the implicit one at a = 1.25 only."""
    s = SCENES[scene]
    found = []
    for setting in SETTINGS.values():
        if scene != "a1.25" and (setting.scheme != "default" or setting.key in CHEAP):
            continue
        along = s.resolutions if setting.key in CHEAP else s.variants_at
        found += [(setting.key, resolution) for resolution in along]
    return found


def collapses_of(scene: str) -> list[Run]:
    s = SCENES[scene]
    found = [reference(scene, r) for r in s.references]
    found += [collapse(scene, r, h) for r in s.resolutions for h in s.horizons]
    return found + [varied(scene, r, key) for key, r in settings_of(scene)]


# ------------------------------------------------------------------------------------------- exact solutions


@dataclass(frozen=True)
class Case:
    name: str
    label: str
    measure: str  # of the summary
    unit: str
    resolutions: tuple[int, ...]
    cost: float  # CPU s at 20
    varied_at: int = 20  # resolution at which time step and sound speed are tried; 0: they do not count
    cfls: tuple[float, ...] = (0.4, 1.0)  # of these; under a loaded plate at most 0.71 is stable


LOADED = {"cfls": (0.4,)}
CASES = {
    case.name: case
    for case in (
        Case("gradient", "operators, jittered lattice", "error", "norm L2", (20, 40, 80, 160), 0.02, 0),
        Case("hydrostatic", "hydrostatic column", "error", "base pressure", (10, 20, 40), 0.3),
        Case("bagnold", "Bagnold flow, 26°", "error_l2", "norm L2 of u", (10, 20, 40), 2.3),
        Case("bagnold_startup", "its start-up", "error", "acceleration", (10, 20, 40), 0.2),
        Case("chute", "vertical chute", "error_l2", "norm L2 of u", (10, 20, 40), 4.5, **LOADED),
        Case("couette_cell", "Couette with gravity", "error_l2", "norm L2 of u", (10, 20, 40), 4.0, **LOADED),
        Case("shear_box", "shear box", "error", "mu on the floor", (10, 20, 40), 2.0, **LOADED),
    )
}  # fmt: skip
SOUNDS = (5.0, 7.0, 20.0)
CFLS = (0.4, 1.0)


def exact(
    case: str, resolution: int, horizon: float = DEFAULT_HORIZON, sound: float | None = None, cfl: float | None = None
) -> Run:
    c = CASES[case]
    # Given, so that a run does not depend on what the library's default is.
    options = _options(resolution=resolution, horizon=horizon, sound_speed=sound, cfl=cfl)
    work = (sound or 10) / 10 * 0.8 / (cfl or 0.8) * max(0.5, (horizon / 4) ** 1.5)
    return Run(_name("exact", case, options=options), "exact", (case, *options), c.cost * (resolution / 20) ** 2 * work)


def exact_of(case: str) -> list[Run]:
    c = CASES[case]
    found = [exact(case, r, h) for r in c.resolutions for h in HORIZONS]
    if c.varied_at:
        found += [exact(case, c.varied_at, sound=s) for s in SOUNDS] + [exact(case, c.varied_at, cfl=f) for f in c.cfls]
    return found


# --------------------------------------------------------------------------------------------------- left out

# Feature: what it is called, and whether it can be there with nothing to do.
FEATURES = {
    "material": ("second material", "added, no particle has it"),
    "gate": ("gate beside the block, rising", "out of reach"),
    "gone_gate": ("gate that has gone", None),
    "walls": ("two smooth walls", "out of reach"),
    "side_walls": ("side walls (channel_width)", "channel_friction 0"),
    "periodic": ("periodic in x", None),
    "loaded_plate": ("loaded plate on the block", None),
    "coulomb": ("Coulomb floor", "such a plate out of reach"),
    "penalty": ("zero_energy_penalty", None),
    "diffusion": ("density_diffusion", None),
    "bulk_viscosity": ("bulk_viscosity", None),
    "collisions": ("collision_distance", None),
    "retries": ("retry_halvings", "no step diverges"),
    "output": ("output, a frame each 0.01 s", "open, no frame"),
    "callback": ("callback that reads, each step", "set and removed"),
    "log": ("log", "nothing to say"),
    "default": ("default scheme (the four coefficients)", None),
    "all": ("all that one scene can have", None),
}
IDLE = tuple(key for key, (_, idle) in FEATURES.items() if idle)
BUILDS = {
    "default": (),
    "without HDF5": ("HDF5=OFF",),
    "without OpenMP": ("OPENMP=OFF",),
    "for x86-64 alone": ("LEVEL=one",),
    "without all three": ("HDF5=OFF", "OPENMP=OFF", "LEVEL=one"),
}


def feature(key: str, state: str = "used", resolution: int = 32) -> Run:
    options = (*_options(resolution=resolution), *(() if state == "used" else ("--state", state)))
    return Run(_name("feature", key, options=options), "features", (key, *options), 2.0 * (resolution / 32) ** 2)


def instructions() -> Run:
    return Run("instructions", "instructions", ("--resolution", "32", *IDLE), 60)


def features() -> list[Run]:
    found = [feature("none"), *(feature(key) for key in FEATURES), *(feature(key, "idle") for key in IDLE)]
    return [*found, feature("all", resolution=126), instructions()]


def build(label: str) -> Run:
    options = BUILDS[label]
    return Run(_name("build", *(o.replace("=", "_") for o in options or ("default",))), "builds", options, 90)


# ------------------------------------------------------------------------------------------- memory and growth

GROWTH = (13, 40, 126, 400, 1265, 2530)  # particles over the width; N = 0.625 of its square
LARGE_STEPS = {1265: 5, 2530: 2}
REPEAT = 15  # measurements of as many steps each: another program's moment spoils few of them
FLOW = (32, 64, 126, 252)  # in the middle of the flow
FLOW_FROM = 0.15  # s
THREADS = (13, 40, 126)


def growth(resolution: int) -> Run:
    """A column at rest between walls: the same work per particle at every size and every step."""
    particles = 0.625 * resolution**2
    steps = LARGE_STEPS.get(resolution, int(min(1000, max(10, 5e5 / particles))))
    options = _options(resolution=resolution, walls=1, **{"from": 0}, steps=steps, repeat=REPEAT)
    return Run(_name("growth", options=options), "step", options, 1 + 1.5 * particles * steps * REPEAT / TYPICAL_RATE)


def flow(resolution: int) -> Run:
    steps = int(min(50, 0.6 * resolution))  # all together 0.04 to 0.05 s: it still flows
    options = _options(resolution=resolution, **{"from": FLOW_FROM}, steps=steps, repeat=REPEAT)
    cost = _cost(SCENES["a1.25"], resolution, end=FLOW_FROM) + REPEAT * steps * 0.625 * resolution**2 / TYPICAL_RATE
    return Run(_name("flow", options=options), "step", options, cost)


def threads(resolution: int) -> Run:
    steps = int(min(4000, max(40, 4e6 / (0.625 * resolution**2))))
    options = _options(resolution=resolution, steps=steps)
    return Run(
        _name("threads", options=options), "threads", options, 36 * 0.625 * resolution**2 * steps / TYPICAL_RATE
    )


def machine() -> Run:
    return Run("machine", "machine", (), 0)


def studies() -> dict[str, list[Run]]:
    """All runs by study."""
    return {
        "machine": [machine()],
        **{scene: collapses_of(scene) for scene in SCENES},
        "exact": [run for case in CASES for run in exact_of(case)],
        "features": features(),
        "builds": [build(label) for label in BUILDS],
        "growth": [growth(r) for r in GROWTH] + [flow(r) for r in FLOW] + [threads(r) for r in THREADS],
    }  # fmt: skip
