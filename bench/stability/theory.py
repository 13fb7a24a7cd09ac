"""Von Neumann's analysis of the schemes on the lattice, for the weight (1 - r/R)^3: the largest stable time step.

Units: spacing, sound speed and density are 1. Symplectic Euler, v' = v - dt (S x + B v), x' = x + dt v', is stable while
omega^2 dt^2 + 2 lambda dt <= 4, with omega^2 the largest eigenvalue of the stiffness S and lambda that of the damping B:
omega dt <= 2 without damping. Both matrices are built of the discrete operators, and the growth factor is computed.
"""
from __future__ import annotations

import functools
import math

import numpy as np

SHEAR_TO_BULK = 0.3  # shear modulus over bulk modulus of the elastic scheme; 0: shear is left to an implicit solve
ELASTIC_PENALTY = 0.2  # rho c0 / dl, the least zero-energy penalty of the elastic scheme inside the yield surface


def inside_yield(penalty: float) -> float:
    """What the elastic scheme makes of gp_config.zero_energy_penalty in material that does not flow."""
    return max(penalty, ELASTIC_PENALTY) if penalty > 0 else 0.0


def neighbours(radius: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Offsets of a particle's neighbours on the lattice, and their weights."""
    n = math.ceil(radius)
    x, y = (a.ravel().astype(float) for a in np.meshgrid(np.arange(-n, n + 1), np.arange(-n, n + 1)))
    r = np.hypot(x, y)
    inside = (r > 0) & (r < radius)
    return x[inside], y[inside], (1 - r[inside] / radius) ** 3


def _tensor(bulk: float, shear: float) -> np.ndarray:
    """Stress (xx, xy, yx, yy) of a velocity gradient in the same order: bulk div u 1 + 2 shear dev D."""
    result = np.zeros((4, 4))
    for column in range(4):
        gradient = np.zeros(4)
        gradient[column] = 1
        g = gradient.reshape(2, 2)
        d = (g + g.T) / 2
        stress = bulk * np.trace(g) * np.eye(2) + 2 * shear * (d - np.trace(d) / 2 * np.eye(2))
        result[:, column] = stress.ravel()
    return result


def _strip(
    radius: float, k: float, rows: int, bulk: float, penalty: float, shear: float
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and damping of the default scheme on a strip of the lattice between two free surfaces, for waves k along
    it. Where neighbours are missing the inverse shape tensor is larger: the surface, not the interior, sets the limit."""
    x, y, w = neighbours(radius)
    gradient = np.zeros((rows, 4, rows, 2), complex)
    unseen = np.zeros((2 * rows, 2 * rows), complex)
    for i in range(rows):
        there = (i + y >= 0) & (i + y < rows)
        dx, dy, weight, other = x[there], y[there], w[there], (i + y[there]).astype(int)
        r = np.stack([dx, dy], 1)
        slope = weight[:, None] * r @ np.linalg.inv((weight[:, None] * r).T @ r)
        phase = np.exp(1j * k * dx)
        for a in range(2):
            for b in range(2):
                np.add.at(gradient[i, 2 * a + b, :, a], other, slope[:, b] * phase)
                gradient[i, 2 * a + b, i, a] -= slope[:, b].sum()
        own = gradient[i].reshape(4, 2 * rows)
        for n, j in enumerate(other):
            z = -(np.kron(np.eye(2), r[n]) @ own)  # u_j - u_i - L_i r
            for a in range(2):
                z[a, 2 * j + a] += phase[n]
                z[a, 2 * i + a] -= 1
            unseen += weight[n] / 2 * z.conj().T @ z
    g = gradient.reshape(4 * rows, 2 * rows)
    adjoint = g.conj().T
    stiffness = adjoint @ np.kron(np.eye(rows), _tensor(1, shear)) @ g
    damping = adjoint @ np.kron(np.eye(rows), _tensor(bulk, bulk if shear else 0)) @ g
    return stiffness, damping + (inside_yield(penalty) if shear else penalty) / w.sum() * unseen


def _largest_step(stiffness: np.ndarray, damping: np.ndarray) -> float:
    one = np.eye(len(stiffness))

    def growth(dt: float) -> float:
        kick = one - dt * damping
        step = np.block([[kick, -dt * stiffness], [dt * kick, one - dt * dt * stiffness]])
        return float(np.abs(np.linalg.eigvals(step)).max())

    low, high = 0.05, 20.0
    while high / low > 1.003:
        middle = math.sqrt(low * high)
        if growth(middle) <= 1 + 1e-6:
            low = middle
        else:
            high = middle
    return low


@functools.lru_cache(maxsize=None)
def surface(horizon: float, bulk: float = 0.1, penalty: float = 0.02, shear: float = SHEAR_TO_BULK) -> float:
    """Largest dt x wave speed / dl of the default scheme with a free surface."""
    rows = 2 * math.ceil(horizon) + 2
    waves = math.pi * np.array([0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0])
    return math.sqrt(1 + shear) * min(_largest_step(*_strip(horizon, k, rows, bulk, penalty, shear)) for k in waves)


def _symbols(radius: float, factor: np.ndarray, odd: bool) -> tuple[np.ndarray, np.ndarray]:
    """Fourier transforms over the first zone: sums of factor x (sin k.r) r/|r|, or of factor x (1 - cos k.r)."""
    x, y, _ = neighbours(radius)
    k = np.linspace(0, math.pi, 129)
    kx, ky = (a.ravel() for a in np.meshgrid(k, k))
    phase = np.outer(kx, x) + np.outer(ky, y)
    r = np.hypot(x, y)
    if odd:
        return np.sin(phase) @ (factor * x / r), np.sin(phase) @ (factor * y / r)
    return (1 - np.cos(phase)) @ factor, np.zeros(0)


@functools.lru_cache(maxsize=None)
def interior(horizon: float, bulk: float = 0.1, penalty: float = 0.02, shear: float = SHEAR_TO_BULK) -> float:
    """The same inside: on the infinite lattice stiffness and damping are those of one wave."""
    x, y, w = neighbours(horizon)
    r = np.hypot(x, y)
    moment = float(w @ (x * x))
    dx, dy = _symbols(horizon, w * r, True)
    q2 = (dx**2 + dy**2) / moment**2
    pairs, _ = _symbols(horizon, w, False)
    unseen = pairs - moment * q2 / 2
    damping = (2 if shear else 1) * bulk * q2 + (inside_yield(penalty) if shear else penalty) / w.sum() * unseen
    stiffness = np.maximum((1 + shear) * q2, 1e-12)
    return math.sqrt(1 + shear) * float(np.min((np.sqrt(damping**2 + 4 * stiffness) - damping) / stiffness))


@functools.lru_cache(maxsize=None)
def number_density_interior(horizon: float, interaction: float, force_states: bool) -> float:
    """Largest dt c0 / dl of the schemes whose pressure follows from the number density, inside, without viscosity: the
    compression of a wave is the change of its number density, its force that of force states or of the MPS gradient."""
    x, y, w = neighbours(interaction)
    r = np.hypot(x, y)
    slope = 3 * (1 - r / interaction) ** 2 / interaction  # -dw/dr
    nx, ny = _symbols(interaction, slope / w.sum(), True)
    if force_states:
        hx, hy, hw = neighbours(horizon)
        fx, fy = _symbols(horizon, hw * np.hypot(hx, hy) / float(hw @ (hx * hx)), True)
    else:
        fx, fy = _symbols(interaction, 2 / w.sum() * w / r, True)
    return 2 / math.sqrt(float(np.max(nx * fx + ny * fy)))


def checkerboard_decay(horizon: float, penalty: float, pattern: str) -> float:
    """Rate of the kinetic energy of a pattern that the gradient does not see in the elastic scheme's layer at rest, which is
    inside its yield surface, in c0 / dl."""
    x, y, w = neighbours(horizon)
    sign = (-1.0) ** (x + y) if pattern == "checkerboard" else (-1.0) ** y
    return 2 * inside_yield(penalty) * float(w @ (1 - sign)) / w.sum()


def effective_delta(mu: float, gravity: float, depth: float, spacing: float, dt: float) -> float:
    """1/s: below it, eta = mu p / delta is beyond what an explicit step can carry, eta dt / (rho dl^2) = 1, and what the
    step allows stands in its place."""
    return dt * mu * gravity * depth / spacing**2
