#!/usr/bin/env python3
"""A step of the default scheme, programmed from docs/guide/equations.md alone, is a step of the library: so the page has all of it.

The scenes are two columns that collapse on a floor y = 0, and single grains. What they come by is counted: every term of the page has to
have acted in one of them.
"""
import collections
import dataclasses
import sys
import tempfile
import warnings

import granperi
import h5py
import numpy as np

SPACING = 0.005
ROUNDING = 3e-7  # of the largest change of a field in the step: what is crowded has single precision
SHEAR_TO_BULK, CONTACT = 0.3, 0.4


@dataclasses.dataclass
class Case:
    name: str
    time: float
    horizon: float = 4
    floor: dict = dataclasses.field(default_factory=dict)
    config: dict = dataclasses.field(default_factory=dict)
    heavy: float = 2500  # kg/m3, grains of the second column
    width: float = 0.08
    height: float = 0.08


CASES = [
    Case("rough", 0.12),
    Case("rough, horizon 2.5", 0.2, horizon=2.5),
    Case("rough, later", 0.5),
    Case("tall", 0.3, horizon=3, width=0.03, height=0.3),
    Case("Coulomb", 0.05, horizon=3, floor={"friction": "coulomb", "wall_mu": 0.25}),
    Case("free slip", 0.25, floor={"friction": "free_slip"}),
    Case("belt", 0.1, floor={"surface_velocity": 0.3}),
    Case("side walls", 0.12, config={"channel_width": 0.02, "channel_friction": 0.2}),
    Case("two densities", 0.12, heavy=7800),
    Case("tilted", 0.2, config={"gravity_x": 3.0}),
    Case("first step", 0.0, config={"gravity_x": 5.0}),
]


@dataclasses.dataclass
class Fields:
    """What a step begins and ends with."""

    x: np.ndarray
    u: np.ndarray
    rho: np.ndarray
    p: np.ndarray
    s: np.ndarray  # s_xx, s_xy
    mean_p: np.ndarray  # over time, of I

    @classmethod
    def of(cls, sim):
        with tempfile.TemporaryDirectory() as directory:
            sim.save(f"{directory}/state.gpc")
            with h5py.File(f"{directory}/state.gpc") as file:  # what no field shows
                mean_p = np.array(sim.pressure)  # before the first step
                if "particles" in file:
                    kept, of_id = file["particles"], np.argsort(file["particles/id"])  # by id, as fields are
                    assert np.array_equal(kept["x"][:][of_id], sim.x)
                    mean_p = kept["mean_pressure"][:][of_id]
        return cls(np.column_stack([sim.x, sim.y]), np.column_stack([sim.vx, sim.vy]), np.array(sim.density),
                   np.array(sim.pressure), np.column_stack([sim.sxx, sim.sxy]), mean_p)


def size(vectors):
    return np.sqrt((vectors ** 2).sum(-1))


def divided(a, b, otherwise=0.0):
    """a / b, where b is 0 something else."""
    return np.where(b != 0, a / np.where(b != 0, b, 1), otherwise)


class Weight:
    """w (2.3) and its sums on the lattice."""

    def __init__(self, horizon):
        self.radius = horizon * SPACING
        x, y = np.meshgrid(*2 * [SPACING * np.arange(-9, 10)])
        w = self(np.hypot(x, y)) * (np.hypot(x, y) > 0)
        self.n0, self.row, self.m2 = w.sum(), w[9].sum(), (w * x * x).sum()
        self.m1 = (w * y)[y > 0].sum()
        # S, by the moments of the disc in 256 slices along the plate.
        eta = (np.arange(256) + 0.5) / 128 - 1
        chord = np.sqrt(1 - eta ** 2)
        across = np.hypot(eta[:, None], chord[:, None] * (np.arange(128) + 0.5) / 128)
        m2, m3 = ((np.clip(1 - across, 0, None) ** 3).sum(1) * chord * eta ** k for k in (2, 3))
        self.places = np.arange(33) / 32
        inside = [eta > -y for y in self.places]
        self.shares = np.array([y / (y + m3[far].sum() / m2[far].sum()) for y, far in zip(self.places, inside)])

    def __call__(self, r):
        return np.clip(1 - r / self.radius, 0, None) ** 3

    def surface_share(self, y):
        """S of the friction law: a table in the library."""
        return np.interp(y / self.radius, self.places, self.shares)


def inverse(k, m2):
    value, vector = np.linalg.eigh(k)
    value = np.maximum(value, 0)
    kept = np.where(value >= 0.1 * m2, divided(1, value), value / (0.1 * m2) ** 2)
    few = np.minimum(1, value.sum(1) / (0.5 * m2)) ** 2
    return few[:, None, None] * np.einsum("iab,ib,icb->iac", vector, kept, vector)


def friction_of_rate(m, half, slope, slip, per_mu, inside):
    """mu of the rate that the friction leaves, the root of rate = slope (slip - per_mu mu(rate)) + inside."""
    free, held = slope * slip + inside, slope * per_mu
    c = half * (held * m.mu_s - free)
    if c >= 0:
        return m.mu_s
    b = half - free + held * m.mu_2
    rate = 0.5 * (-b + np.sqrt(b * b - 4 * c))
    return m.mu_s + (m.mu_2 - m.mu_s) * rate / (rate + half)


def step(case, sim, begin, dt, seen):
    """The fields after a step. seen counts what has acted."""
    m, c, w = sim.materials[0], sim.config, Weight(case.horizon)
    rough, smooth = "friction" not in case.floor, case.floor.get("friction") == "free_slip"
    own = np.where(np.array(sim.column) == 1, case.heavy, m.grain_density)
    rest, grains = m.volume_fraction * own, own
    c0, dl, g = sim.state.sound_speed, SPACING, np.array([c.gravity_x, c.gravity_y])
    shear = SHEAR_TO_BULK * rest * c0 ** 2
    plate = np.array([-case.floor.get("surface_velocity", 0.0), 0.0])  # the floor runs from right to left
    x, u, rho, p = begin.x, begin.u, begin.rho.copy(), begin.p
    flows = (size(begin.s) >= m.mu_s * p * (1 - 1e-12)).astype(float)

    # Pairs, and ghosts behind the floor.
    d = x[None] - x[:, None]
    wp = w(size(d))
    np.fill_diagonal(wp, 0)
    rows, places = np.arange(int(np.ceil(case.horizon)) + 1) + 0.5, np.arange(-150, 150) + 0.5
    ghosts = np.array([(dl * at, -dl * row) for row in rows for at in places])
    dg = ghosts[None] - x[:, None]
    wg = w(size(dg))
    ghosts, dg, wg = ghosts[wg.sum(0) > 0], dg[:, wg.sum(0) > 0], wg[:, wg.sum(0) > 0]
    total, depth = wg.sum(0), -ghosts[:, 1]
    mean_x, mean_u = (wg.T @ x) / total[:, None], (wg.T @ u) / total[:, None] - plate
    ratio = depth / np.maximum(mean_x[:, 1], CONTACT * dl)
    at_yield = ~((wg > 0) & ~((flows > 0) & (p > 0))[:, None]).any(0)
    h = np.where(at_yield, -ratio, -np.minimum(ratio, 0.5)) if rough else np.ones(len(ghosts))
    ug = plate + np.column_stack([h * mean_u[:, 0], -0.25 * mean_u[:, 1]])
    seen["ghosts at yield"] += rough and at_yield.sum()

    # Shape tensor and gradient.
    kp = np.einsum("ij,ija,ijb->iab", wp, d, d)
    k = kp + np.einsum("ij,ija,ijb->iab", wg, dg, dg)
    carried = np.minimum(1, np.trace(kp, axis1=1, axis2=2) / (0.15 * w.m2)) ** 2
    ki = carried[:, None, None] * inverse(k, w.m2)
    du = u[None] - u[:, None]
    mp = np.einsum("ij,ija,ijb->iab", wp, du, d)
    mg = np.einsum("ij,ija,ijb->iab", wg, ug[None] - u[:, None], dg)
    if not rough:
        mg[:, 0, 1] = 0
    grad = (mp + mg) @ ki
    beside = wg.sum(1) > 0
    inner = np.where(beside[:, None, None], mp @ inverse(kp, w.m2), grad)
    number = wp.sum(1) + wg.sum(1)
    dxx, dxy = 0.5 * (grad[:, 0, 0] - grad[:, 1, 1]), 0.5 * (grad[:, 0, 1] + grad[:, 1, 0])
    gamma, divergence = np.hypot(dxx, dxy), grad[:, 0, 0] + grad[:, 1, 1]
    seen["few neighbours"] += (np.trace(k, axis1=1, axis2=2) < 0.5 * w.m2).sum()

    # Density: diffusion, spacing, continuity.
    e, under = rho - rest, (rho > rest).astype(float)
    least, most = np.minimum(rest[:, None], rest), np.maximum(rest[:, None], rest)
    there = np.where(e[None] < 0, (e / rest)[None] * least, e[None])
    here = np.where(e[:, None] < 0, (e / rest)[:, None] * least, e[:, None])
    weight = under[:, None] * under[None] * (rho[:, None] + rho[None]) / 2 * (d @ g) / c0 ** 2
    pace = (rest[:, None] / most * wp * flows[None]).sum(1)
    exchanged = (rest[:, None] / most * wp * flows[None] * (there - here - weight)).sum(1)
    exchanged *= np.minimum(1, divided(1.5 * w.n0, pace, 1))
    rho += dt * c.density_diffusion * c0 * dl * 2 / w.m2 * flows * exchanged
    known = np.maximum(1, rho / rest)
    target = rest * np.minimum(number / w.n0, 1.05) * flows
    closer = target > rho
    target = np.where((rho < rest) & (target > rest), rest, target)
    q = 2 * gamma * dt / 3
    rho += np.where(closer, q / (1 + q) * (target - rho), 0)
    rho = np.where(dt * divergence > 0.5, divided(rho, 4 * dt * divergence), rho * (1 - dt * divergence))
    flight = (carried < 1) & (rho > rest)
    rho = np.where(flight, rest + divided(rho - rest, 1 + (divided(1, carried, np.inf) - 1) * c0 * dt / dl), rho)
    p = np.maximum(0, c0 ** 2 * (rho - rest))
    seen["spacing"] += closer.sum()
    seen["in flight"] += (carried < 1).sum()
    seen["stretched"] += (rho < rest).sum()

    # Stress.
    t = 0.5 * (grad[:, 0, 1] - grad[:, 1, 0]) * dt
    cosine, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
    trial = np.column_stack([cosine * begin.s[:, 0] + sine * begin.s[:, 1], cosine * begin.s[:, 1] - sine * begin.s[:, 0]])
    trial += 2 * dt * shear[:, None] * np.column_stack([dxx, dxy])
    tau = size(trial)
    alpha = m.i0 / (m.grain_diameter * np.sqrt(grains)) * shear * dt * np.sqrt(begin.mean_p)
    b, hh = m.mu_2 * p + tau + alpha, m.mu_2 * p * tau + m.mu_s * p * alpha
    returned = divided(2 * hh, b + np.sqrt(np.maximum(b * b - 4 * hh, 0)))
    shrink = np.where(p > 0, np.where(tau <= m.mu_s * p, 1, divided(returned, tau)), 0)
    s = shrink[:, None] * trial
    mean_p = begin.mean_p + dt / (dt + 100 * dl / c0) * (p - begin.mean_p)
    eta = c.bulk_viscosity * rest * c0 * dl
    bulk = np.where(p > 0, np.maximum(-eta * divergence, -p), 0)
    with_drag = s + 2 * eta[:, None] * np.column_stack([dxx, dxy])
    elastic = (shrink == 1) & (size(with_drag) <= m.mu_s * p)
    acting = np.where(elastic[:, None], with_drag, s)
    sigma = np.empty_like(grad)
    sigma[:, 0, 0], sigma[:, 1, 1] = acting[:, 0] - p - bulk, -acting[:, 0] - p - bulk
    sigma[:, 0, 1] = sigma[:, 1, 0] = acting[:, 1]
    seen["elastic"] += elastic.sum()
    seen["yields"] += ((p > 0) & (shrink < 1)).sum()

    # Stress of the ghosts: n = (0, 1), so s_nn = -s_xx.
    bearing = wg * (p > 0)[:, None]
    pg = np.maximum(0, (bearing * (p[:, None] + rho[:, None] * (dg @ g))).sum(0) / total)
    sn = pg * divided(-(bearing * s[:, :1]).sum(0), (bearing * p[:, None]).sum(0))
    sg = np.zeros((len(ghosts), 2, 2))
    sg[:, 0, 0], sg[:, 1, 1] = -sn - pg, sn - pg

    # Force and motion.
    a = sigma @ ki
    force = np.einsum("ij,iab,ijb->ia", wp, a, d) + np.einsum("ij,jab,ijb->ia", wp, a, d)
    kappa = c.zero_energy_penalty * rest.min() * c0 / (dl * w.n0)
    share = np.where(p > 0, np.where(elastic, max(1, 0.2 / c.zero_energy_penalty), 1.0), 0)
    z = du - np.einsum("iab,ijb->ija", inner, d)
    force += 0.5 * kappa * np.einsum("ij,ija->ia", wp, share[:, None, None] * z - share[None, :, None] * z.transpose(1, 0, 2))
    a[:, 0, 1] = 0
    of_plate = np.einsum("ij,iab,ijb->ia", wg, a, dg) + np.einsum("ij,jab,ijb->ia", wg, sg / w.m2, dg)
    normal = of_plate[:, 1] = np.maximum(of_plate[:, 1], 0)
    u = u + dt * ((force + of_plate) / rest[:, None] + g)
    x = x + dt * u

    def push(change):
        u[...] += change
        x[...] += dt * change

    # Friction of the floor.
    half = m.i0 / m.grain_diameter * np.sqrt(np.maximum(p, normal * dl) / grains)
    change = np.zeros_like(u)
    for i in np.flatnonzero((normal > 0) & (u[:, 0] != plate[0])) if not smooth else []:
        slip, y, once = u[i, 0] - plate[0], (x - dt * u)[i, 1], normal[i] * dt / rest[i]
        whole, across = max(size(s[i]), m.mu_s * p[i]), -s[i, 0]

        def along(mu):
            if not rough:
                return min(mu, case.floor["wall_mu"])
            left = whole - mu * across
            return mu * np.sqrt(max(whole ** 2 - across ** 2, 0)) / left if left > 0 else mu

        mu, part = m.mu_s, w.surface_share(y)
        for _ in range(2):
            mu = friction_of_rate(m, half[i], (1 + part) / max(y, CONTACT * dl), abs(slip), once * along(mu) / mu,
                                  -part * np.sign(slip) * inner[i, 0, 1])
        change[i, 0] = -np.sign(slip) * min(abs(slip), along(mu) * once)
        seen["held by the floor" if abs(slip) < along(mu) * once else "slips on the floor"] += 1
    push(change)
    if c.channel_width > 0:
        push(-u * np.minimum(1, divided(2 * c.channel_friction * p * dt, c.channel_width * rest * size(u), 1))[:, None])
        seen["side walls"] += len(u)

    # Collisions.
    d = x[None] - x[:, None]
    r, approach = size(d), ((u[:, None] - u[None]) * d).sum(-1)
    near = (approach > 0) & (r < c.collision_distance * dl)
    partners = np.where((flows > 0) & (number > 0), near.sum(1), 0)
    first = size(np.einsum("ij,ija->ia", wp, begin.x[None] - begin.x[:, None]) + np.einsum("ij,ija->ia", wg, dg)) / w.m1
    crowding = number / w.n0 + (w.n0 - w.row) / (2 * w.n0) * np.maximum(0, first ** 2 - 0.04) / 0.96 - known
    change, moves = np.zeros_like(u), np.zeros_like(u)
    for i, j in np.argwhere(near & (partners[:, None] > 0) & (partners[None] > 0)):
        way, speed = d[i, j] / r[i, j], approach[i, j] / r[i, j]
        mean, excess = -r[i, j] * way @ ((grad[i] + grad[j]) / 2) @ way, (crowding[i] + crowding[j]) / 0.2
        explained = min(1, excess) * min(speed, mean) if mean > 0 and excess > 0 and p[i] > 0 and p[j] > 0 else 0
        lighter = rest[j] / (rest[i] + rest[j])
        change[i] -= lighter * (speed - explained) / max(partners[i], partners[j]) * way
        moves[i] -= lighter * explained * way
        seen["collides"] += 1
        seen["moved apart"] += explained > 0
    push(change)
    x += dt * moves

    # Contact with the floor.
    change = np.zeros_like(u)
    for i in np.flatnonzero(beside & (x[:, 1] < CONTACT * dl) & (u[:, 1] < 0)):
        blow, slip = -u[i, 1], u[i, 0] - plate[0]
        mu = friction_of_rate(m, m.i0 / m.grain_diameter * np.sqrt(rest[i] * dl * blow / dt / grains[i]), 1 / (CONTACT * dl),
                              abs(slip), blow, 0)
        mu = mu if rough else 0 if smooth else min(mu, case.floor["wall_mu"])
        change[i] = -np.sign(slip) * min(abs(slip), mu * blow), blow
        seen["contact"] += 1
    push(change)
    return Fields(x, u, rho, p, s, mean_p)


def main():
    seen, faults = collections.Counter(), []
    for case in CASES:
        warnings.simplefilter("ignore", granperi.GranperiWarning)  # of the single grains
        with granperi.Simulation(spacing=SPACING, horizon=case.horizon, jitter=0.05, seed=3, **case.config) as sim:
            heavy = sim.add_material(grain_density=case.heavy)
            sim.add_column(width=case.width, height=case.height)
            sim.add_column(x_min=case.width, width=case.width / 2, height=case.height / 2, material=heavy)
            sim.add_particles([-0.5, -0.496, -0.6], [0.002, 0.002, 0.03], [0.1, -0.1, 0], [0, 0, 0])
            sim.add_plate(granperi.Plate.floor(-2, 2, **case.floor))
            sim.run(case.time)
            begin = Fields.of(sim)
            sim.step()
            end, dt = Fields.of(sim), sim.clock.dt
            told = step(case, sim, begin, dt, seen)
        off = {}
        for name in ("rho", "p", "s", "u", "x", "mean_p"):
            there, here, before = (getattr(fields, name) for fields in (end, told, begin))
            off[name] = abs(here - there).max() / abs(there - before).max()
            if not off[name] <= ROUNDING:
                faults.append(f"{case.name}: {name}")
        print(f"{case.name:20}", *(f"{name} {value:.1e}" for name, value in off.items()))
    print(dict(seen))
    terms = ("ghosts at yield", "few neighbours", "spacing", "in flight", "stretched", "elastic", "yields", "held by the floor",
             "slips on the floor", "side walls", "collides", "moved apart", "contact")
    faults += [f"never met: {term}" for term in terms if not seen[term]]
    if faults:
        sys.exit("not as docs/guide/equations.md says: " + "; ".join(faults))


if __name__ == "__main__":
    main()
