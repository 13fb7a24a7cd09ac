"""What is due at multiples of a time, without an effect on the steps: the rule of gp_output.every_seconds."""
from __future__ import annotations

import math
from typing import Any, Callable

from ._errors import ArgumentError, number


def interval(value: Any, name: str = "every") -> float:
    """An interval [s] as a number, or the error on it."""
    every = number(name, value)
    if not 0 < every < math.inf:
        raise ArgumentError(f"{name} = {every:g}: expected a finite number above 0, in s")
    return every


class Timer:
    """Calls `function` after the first step at or past each multiple of `every` [s].

    Several multiples within one step are one call. What `function` returns stops the run if it is true. `after` [s]: the
    multiples up to it are past.
    """

    def __init__(self, every: float, function: Callable[[], Any], after: float = -math.inf):
        self._every, self._function = every, function
        self._k = 0
        if after >= 0:
            self.skip(after)

    def skip(self, reached: float) -> None:
        """The multiples up to this time [s] are past."""
        self._k = math.floor(min(reached / self._every, 2.0**62)) + 1  # of a tiny interval every step passes some

    @property
    def due(self) -> float:
        """s"""
        return self._k * self._every

    def ring(self, reached: float) -> bool:
        """Calls it if it is due at the time that is reached [s]."""
        if reached < self.due:
            return False
        self.skip(reached)
        return bool(self._function())
