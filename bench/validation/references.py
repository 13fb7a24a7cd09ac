"""Published numbers that docs/validation.md stands beside ours. Every one names its source; none of them is ours."""
import math

# Jin et al. (2021): Jin, Lu, Tai & Xu, J. Fluid Mech. 917.
XU2017 = "experiment of Xu et al. (2017), as quoted by Jin et al. (2021)"
XU2019 = "experiment of Xu et al. (2019), as quoted by Jin et al. (2021)"
MANGENEY = "experiment of Mangeney et al. (2010), as described by Jin et al. (2021)"
IONESCU = "Ionescu, Mangeney, Bouchut & Roche (2015), J. Non-Newtonian Fluid Mech. 219"

# ---------------------------------------------------------------- both sides, a = 1.25: section 4 of Jin et al.
WIDTH = 0.08  # m, L of all two-sided scenes
PEAK_TIME = 0.42  # s
EXPERIMENT_PEAK = 0.467  # y/L at 0.42 s. Follows from both 0.508 (8.8 % off) and 0.474 (1.5 % off)
PAPER_PEAK = {4.0: 0.508, 2.2: 0.474}  # y/L at 0.42 s by horizon / dl
PAPER_CREEP_2_2 = {1.0: 0.429, 2.0: 0.391, 3.0: 0.380}  # y/L by time (s) for the horizon 2.2 dl
# y/L at 0.42 s by L/dl; the paper gives 0.508 without its L/dl in section 4.2 and runs L/dl = 32 in section 5.1
PAPER_RESOLUTION = {32: 0.508, 64: 0.558, 128: 0.577}

# ------------------------------------------------------------------------------------------- other scenes of it
PAPER_LOCAL_SPEED_RATIO = 4.0  # |u| local / non-local on y/L = 0.25 at 1 s, a = 5: "generally almost 4 times"
PAPER_WALL_HEIGHT = 0.138  # m beside the wall at 1.02 s, one side, non-local
EXPERIMENT_WALL_HEIGHT = 0.14  # m: "almost constant at the initial height"
EXPERIMENT_INTERFACE_ANGLE = 5.3  # degrees to the vertical at 0.60 s, case II
# By our scheme that comes next to it. The paper does not say how its local model has the stress, which is that of earlier
# work: it is taken with the factor 1, and shown with 2 beside.
PAPER_INTERFACE_ANGLE = {"nonlocal_2": 9.06, "local_1": 27.7}

# ------------------------------------------------------------------------------------------------------ scaling
# Run-out (x - L0)/L0 and final height / L0 against a = H0/L0; L0 is half the width (two sides) or the width (one side).


def lube_run_out(a: float) -> float:
    """Lube, Huppert, Sparks & Freundt (2005), Phys. Rev. E 72: channel, experiment."""
    return 1.2 * a if a < 2.0 else 1.9 * a ** (2 / 3)


def lube_height(a: float) -> float:
    """The same: 1.1 a^(2/5) above a = 1.15, where the top begins to sink."""
    return a if a < 1.15 else 1.1 * a**0.4


def lajeunesse_run_out(a: float) -> float:
    """Lajeunesse, Monnier & Homsy (2005), Phys. Fluids 17: channel, experiment; prefactors from a secondary source."""
    return 1.8 * a if a < 3.0 else 2.3 * a ** (2 / 3)


def staron_run_out(a: float) -> float:
    """Staron & Hinch (2005), J. Fluid Mech. 545: contact dynamics of discs, two dimensions."""
    return 2.5 * a if a < 2.0 else 3.25 * a**0.7


def staron_height(a: float) -> float:
    """The same; not more than the column itself."""
    return min(a, 0.65 * a**0.35)


def lagree_run_out(a: float) -> float:
    """Lagrée, Staron & Popinet (2011), J. Fluid Mech. 686: mu(I) continuum, two dimensions."""
    return 2.2 * a if a < 7.0 else 3.9 * a**0.7


# ---------------------------------------------------------------------------------------------- contact dynamics
# Columns of discs collapsing to both sides: data of Staron & Hinch (2005) with which Lagrée, Staron & Popinet (2011)
# compare their continuum, published with M1EMN/Exemples/granular_column.c of the Basilisk wiki (ShapeTime.A-01, A-04).
# Measured from those profiles: by t / sqrt(H0/g), the front (mean of both sides, outermost x/H0 with h/H0 above the
# threshold) and the highest h/H0. Discs are H0/29.8 (a = 0.5) and H0/64.8 (a = 1.42) across, so that 0.02 H0 is less
# than a disc or little more: single discs that roll on count there, while 0.05 H0 leaves them out.
CONTACT_DYNAMICS = {
    0.5: {
        "height": 0.149,
        "diameter": 0.005,
        "times": [0, 1, 2, 3, 4, 5, 6, 7, 8],
        "front_02": [1.99, 2.27, 2.89, 3.27, 3.72, 3.88, 3.9, 3.9, 3.9],
        "front_05": [1.99, 2.27, 2.89, 3.27, 3.72, 3.8, 3.83, 3.83, 3.83],
        "peak": [1.023, 1.004, 1.003, 1.0, 1.0, 0.999, 0.998, 0.998, 0.998],
    },
    1.42: {
        "height": 0.324,
        "diameter": 0.005,
        "times": [0, 1, 2, 3, 4, 5, 6],
        "front_02": [0.69, 1.11, 1.98, 2.48, 2.8, 3.07, 3.07],
        "front_05": [0.69, 1.11, 1.98, 2.48, 2.66, 2.74, 2.74],
        "peak": [1.012, 0.816, 0.651, 0.576, 0.536, 0.527, 0.527],
    },
}
# The friction with which Lagrée et al. compare: mu = 0.32 + 0.28 / (1 + 0.40 / I), with the flow's density in I.
LAGREE_MU_S, LAGREE_MU_2, LAGREE_I0 = 0.32, 0.60, 0.40
CONTACT_DYNAMICS_SOURCE = (
    "Staron & Hinch (2005), data in Lagrée, Staron & Popinet (2011) and the Basilisk wiki, "
    "M1EMN/Exemples/granular_column.c"
)

# ----------------------------------------------------------------------------------------------- friction, walls
# Ionescu et al. (2015) account for the side walls of the channel by a raised friction.
RAISED_MU_S_DEGREES, RAISED_MU_2_DEGREES = 25.5, 36.5


def highest_deposit(area: float, mu_s: float) -> float:
    """Height (m) that an arrested two-sided deposit of this area (m2) can have at most: a triangle at the steepest
    static slope, sin(slope) = mu_s."""
    return math.sqrt(area * math.tan(math.asin(mu_s)))


# ---------------------------------------------------------------------------------------- independent public codes
# The a = 1.25 column with the same mu(I) and instant release, run with public codes on a machine with two cores of
# x86-64, one thread: code, method, L/dl (None: discs of the grain diameter), CPU s per simulated s, peak y/L at 0.42 s
# and at 3 s, run-out (x - L0)/L0 at 3 s, whether the times of run were inflated (by some 10-30 %) by other work.
INDEPENDENT_CODES = [
    ("Matter bf948b6, c = 10 m/s", "MPM, return map", 32, 1.60, 0.424, 0.420, 1.91, False),
    ("Matter bf948b6, c = 10 m/s", "MPM, return map", 64, 11.3, 0.417, 0.416, 1.96, False),
    ("Matter bf948b6, c = 10 m/s", "MPM, return map", 128, 92.0, 0.417, 0.414, 2.07, True),
    ("Matter bf948b6, E = 1e6 Pa", "MPM, return map", 64, 30.0, 0.416, 0.416, 2.08, True),
    ("Basilisk c7be0ad, half column", "VOF Navier-Stokes", 26, 8.9, 0.421, 0.422, 1.89, True),
    ("Basilisk c7be0ad, half column", "VOF Navier-Stokes", 51, 34.0, 0.418, 0.417, 2.28, True),
    ("Basilisk c7be0ad, half column", "VOF Navier-Stokes", 102, 480.0, 0.409, 0.409, 2.46, True),
    ("LAMMPS granular", "DEM, 1073 discs", None, 21.0, 0.427, 0.427, 2.30, True),
    ("Matter, friction doubled", "MPM, return map", 32, None, 0.545, 0.545, 0.96, False),
]
CODES_RUN_OUT = (1.9, 2.5)  # of the same
CODES_PEAK_BAND = (0.409, 0.424)  # of the MPM and VOF codes with the friction as given
DISCS_PEAK = 0.427  # of the DEM code

# -------------------------------------------------------------------------------------------------------- Couette
COUETTE_SOURCE = (
    "appendix of Jin et al. (2021); experiment of Siavoshi, Orpe & Kudrolli (2006), a figure without numbers"
)

# ----------------------------------------------------------------------------------------------------------- hopper
STARON_SILO = "Staron, Lagrée & Popinet (2012), Phys. Fluids 24, and (2014), Eur. Phys. J. E 37,"
SILO_MU_S, SILO_MU_2, SILO_I0 = 0.32, 0.60, 0.4
BASILISK_SILO_SOURCE = (
    "P.-Y. Lagrée's public code with Basilisk (sandbox/M1EMN/Exemples/granular_sandglass.c),\nthe μ(I) law of the same friction in a "
    "Navier-Stokes solver, a silo 5 wide filled to 4.5, outlets of 2 W = 0.31 to 1.1,\ngrains of 1/30. To the largest rate in "
    "any 0.05 of its time it draws the line 4.254 W^1.5, which is 1.50 D^1.5: a line in its\nplot, where ours is a mean, on a "
    "grid of 4 to 14 cells in the outlet"
)
BASILISK_SILO_RATE = 4.254 / 2**1.5  # rho sqrt(g) D^1.5, D = 2 W
