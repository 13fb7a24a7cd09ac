"""What runs at several spacings tell of the error of each: order, limit, scatter, and how sure that is.

The mean at spacing h is taken as f0 + c h^p (1 + what no power describes), and a run as that mean and chance. Orders p from 0.9
to 2, a little below and at the orders that the scheme has in theory, are all tried and weighted by how well they fit, so that the
spread between the extrapolations is part of the error (Rider, Witkowski, Kamm & Wildey 2016, J. Comput. Phys. 307; bounded orders:
Eca & Hoekstra 2014, J. Comput. Phys. 262). What is stated is a multiple of its root mean square, as by the safety factor of the Grid
Convergence Index (Roache 1994, J. Fluids Eng. 116; Celik et al. 2008, J. Fluids Eng. 130). docs/report.md has how often it held, and
what other bounds and shares would have made of it.
"""
from __future__ import annotations

import dataclasses
import math
from typing import Sequence

import numpy as np

ORDERS = np.linspace(0.9, 2.0, 6)  # that an extrapolation may have
WIDE = np.arange(-0.5, 3.01, 0.25)  # that are tried to tell whether it converges
UNPOWERED = 0.3  # root mean square share of the error that no power of the spacing describes
LEAST = 0.2  # error at the finest spacing over what the means differ by, at least: they may agree by chance
UNFITTED = 0.03  # of the whole change of the means: what they may lie beside a power, where orders are told apart
SAFETY = 1.645  # stated error over root mean square: 9 of 10 of a normal distribution are below

CONVERGES, WITHIN_SCATTER = "converges", "the same within the scatter"
IRREGULAR, UNSURE, DIVERGES = "goes up and down", "may not converge", "does not converge"


@dataclasses.dataclass(frozen=True)
class Level:
    """The runs at one spacing: their mean, its standard error, and the scatter of one run, with few runs by those of all."""

    spacing: float
    runs: int
    mean: float
    scatter: float

    @property
    def standard_error(self) -> float:
        return self.scatter / math.sqrt(self.runs)


def levels(values: dict[float, Sequence[float]]) -> list[Level]:
    """From the coarsest to the finest. values: of the runs at each spacing."""
    spread = {h: np.asarray(v, dtype=float) for h, v in values.items()}
    freedom = sum(len(v) - 1 for v in spread.values())
    pooled = sum(((v - v.mean()) ** 2).sum() for v in spread.values()) / max(1, freedom)
    found = []
    for h in sorted(spread, reverse=True):
        v = spread[h]
        # Few runs tell little of their scatter: that of all counts as three more.
        scatter = math.sqrt((((v - v.mean()) ** 2).sum() + 3 * pooled) / (len(v) + 2))
        found.append(Level(h, len(v), float(v.mean()), scatter))
    return found


class _Component:
    """One order, one size of the error: Gaussian, so all is linear algebra. Spacings count in the finest one."""

    def __init__(self, ratio: np.ndarray, mean: np.ndarray, error: np.ndarray, order: float, size: float):
        self.size = size
        g = ratio**order
        self.order, self.g = order, g
        own = (UNPOWERED * size * g) ** 2
        self.prior = size**2 * np.outer(g, g) + np.diag(own)  # of the errors at the levels
        inverse = np.linalg.inv(self.prior + np.diag(error**2))
        ones = np.ones(len(g))
        weight = ones @ inverse @ ones
        self.limit, self.limit_variance = float(ones @ inverse @ mean / weight), float(1 / weight)
        away = mean - self.limit
        self.gain, self.inverse, self.away, self.ones, self.weight = inverse @ away, inverse, away, ones, weight
        _, log_det = np.linalg.slogdet(inverse)
        self.log_evidence = 0.5 * (log_det - math.log(weight) - away @ self.gain)

    def at(self, ratio: float, level: int | None) -> tuple[float, float]:
        """Mean and variance of the error (mean value there less the limit), at a level or at another spacing."""
        if level is not None:
            cross, own = self.prior[level], self.prior[level, level]
        else:
            g = ratio**self.order
            cross, own = self.size**2 * g * self.g, (self.size * g) ** 2 * (1 + UNPOWERED**2)
        seen = self.inverse @ cross
        slope = self.ones @ seen  # the limit is found from the same means
        return float(cross @ self.gain), float(own - cross @ seen + slope**2 / self.weight)


def _mixture(ratio, mean, error, orders) -> tuple[list[_Component], np.ndarray]:
    sizes = np.geomspace(LEAST, 10, 7)  # of the error at the finest spacing, of what the means differ by
    parts = [_Component(ratio, mean, error, order, size) for order in orders for size in sizes]
    logs = np.array([part.log_evidence for part in parts])
    weights = np.exp(logs - logs.max())
    return parts, weights / weights.sum()


def _orders_seen(ratio: np.ndarray, mean: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Of each of WIDE how well value = a + b (h^p - 1)/p, log h for p = 0, fits the means: weights with the sum 1."""
    noise = np.sqrt(error**2 + (UNFITTED * np.ptp(mean)) ** 2)
    misfit = []
    for order in WIDE:
        growth = np.log(ratio) if order == 0 else (ratio**order - 1) / order
        columns = np.column_stack([np.ones_like(ratio), growth]) / noise[:, None]
        coefficients = np.linalg.lstsq(columns, mean / noise, rcond=None)[0]
        misfit.append(((columns @ coefficients - mean / noise) ** 2).sum())
    weights = np.exp(-0.5 * (np.array(misfit) - min(misfit)))
    return weights / weights.sum()


class Convergence:
    """Of one quantity. levels: from the coarsest to the finest; values in its unit, errors against the limit of zero spacing."""

    def __init__(self, values: dict[float, Sequence[float]]):
        self.levels = levels(values)
        self._finest = self.levels[-1].spacing
        self._known: dict[float, tuple[float, float]] = {}
        ratio = np.array([level.spacing for level in self.levels]) / self._finest
        mean = np.array([level.mean for level in self.levels])
        error = np.array([level.standard_error for level in self.levels])
        # Counted in what they differ by, from their middle: units have no part in it, nor has a large constant.
        self._unit = max(np.ptp(mean), error.max(), 1e-9 * np.abs(mean).max()) or 1.0
        self._mean, self._error = (mean - mean.mean()) / self._unit, np.maximum(error / self._unit, 1e-9)
        self._parts, self._weights = _mixture(ratio, self._mean, self._error, ORDERS)
        limits = np.array([part.limit for part in self._parts])
        middle = float(self._weights @ limits)
        self.limit = float(mean.mean()) + self._unit * middle
        spread = self._weights @ (limits - middle) ** 2 + self._weights @ [part.limit_variance for part in self._parts]
        self.limit_error = SAFETY * self._unit * math.sqrt(spread)
        seen = _orders_seen(ratio, self._mean, self._error)
        below = np.cumsum(seen)
        #: Observed order, and the range that has two thirds of the weight; between -0.5 and 3.
        self.order = float(seen @ WIDE)
        self.order_range = tuple(float(WIDE[np.searchsorted(below, share)]) for share in (1 / 6, 5 / 6))
        self.verdict = self._judge(float(seen[WIDE < 0.3].sum()))

    def _judge(self, not_shrinking: float) -> str:
        steps = np.diff(self._mean) / np.hypot(self._error[1:], self._error[:-1])  # in standard errors
        center = np.average(self._mean, weights=self._error**-2)
        chance = (((self._mean - center) / self._error) ** 2).sum()
        if chance < 2.5 * len(steps) + 3:  # few runs: somewhat more than the 5 % of chi squared
            return WITHIN_SCATTER
        if steps.max() > 2.5 and steps.min() < -2.5:
            return IRREGULAR
        if not_shrinking > 0.9 and abs(steps[-1]) > 2.5:
            return DIVERGES
        return UNSURE if not_shrinking > 0.5 else CONVERGES

    def _moments(self, spacing: float) -> tuple[float, float]:
        """Mean and mean square of the error of the mean at a spacing."""
        if spacing not in self._known:
            level = next((k for k, one in enumerate(self.levels) if math.isclose(one.spacing, spacing, rel_tol=1e-9)), None)
            at = np.array([part.at(spacing / self._finest, level) for part in self._parts])
            self._known[spacing] = (self._unit * float(self._weights @ at[:, 0]),
                                    self._unit**2 * float(self._weights @ (at[:, 0] ** 2 + at[:, 1])))
        return self._known[spacing]

    def bias(self, spacing: float) -> float:
        """The most likely error of the mean of many runs at this spacing."""
        return self._moments(spacing)[0]

    def error(self, spacing: float, runs: int = 1) -> float:
        """What the mean of so many runs at this spacing errs by at most, 9 times in 10."""
        return SAFETY * math.sqrt(self._moments(spacing)[1] + self.scatter(spacing) ** 2 / runs)

    def scatter(self, spacing: float) -> float:
        """Standard deviation of one run, at the nearest level."""
        return min(self.levels, key=lambda level: abs(math.log(level.spacing / spacing))).scatter
