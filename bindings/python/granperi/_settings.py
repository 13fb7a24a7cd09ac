"""Recommended settings, with the errors and costs that were measured with them."""
from __future__ import annotations

import dataclasses
import math
import os
from typing import Any

from ._errors import ArgumentError, ArgumentTypeError, near_match, number
from ._objects import Config
from ._scene import Scene, scene_of


@dataclasses.dataclass(frozen=True)
class Settings:
    """Settings for bodies whose smallest side is `length`, with their errors and cost in three collapses.

    name: "draft", "standard" or "fine". length [m]: the smallest side of a column. spacing [m], horizon [spacings], sleep: the
    parameters of Config; all others stay what they are. aim: the error of one run of the column with a = 1.25 is below this: 0.1,
    0.05 or 0.02. peak_error, runout_error: measured relative error of one run (bias and scatter, root mean square) in the
    peak, and in the run-out of 90 % of the mass, in the worst of the three. cpu_seconds: of one run with a = 1.25 to 1 s, one
    thread, with this sleep.
    """

    name: str
    length: float
    spacing: float
    horizon: float
    sleep: int
    aim: float
    peak_error: float
    runout_error: float
    cpu_seconds: float

    @property
    def values(self) -> dict[str, Any]:
        """The parameters of Config that the settings choose, by name."""
        return {"spacing": self.spacing, "horizon": self.horizon, "sleep": self.sleep}

    def config(self, config: Config | None = None) -> Config:
        """A configuration with these settings; its other values stay.

        Args:
            config: the one to change; not given: the library's defaults.

        Returns:
            A Config.

        Example:
            config = granperi.settings("draft", 0.05).config(granperi.Config(sound_speed=10))
            print(config.spacing, config.sound_speed)
        """
        if config is not None and not isinstance(config, Config):
            raise ArgumentTypeError(f"config = {config!r:.80}: expected a Config, such as scene.config")
        return (config or Config()).replace(**self.values)

    def __str__(self) -> str:
        return (f"{self.name}: spacing {self.spacing:.4g} m ({self.length / self.spacing:.0f} over {self.length:.4g} m), "
                f"horizon {self.horizon:g} spacings, sleep {self.sleep}\n"
                f"measured: one run erred by {100 * self.peak_error:.1f} % in the peak, {100 * self.runout_error:.1f} % in the "
                f"run-out of 90 % of the mass, in the worst of three collapses; {self.cpu_seconds:.2g} CPU s to 1 s with a = 1.25\n"
                "another scene errs otherwise: granperi.report tells what")


@dataclasses.dataclass(frozen=True)
class _Level:
    """Spacings over the smallest side and horizon [spacings]; aim, errors and cost as in docs/settings.md."""

    spacings: int
    horizon: float
    sleep: int
    aim: float
    peak_error: float
    runout_error: float
    cpu_seconds: float


# aims: written by bench/performance/aims.py
_LEVELS = {
    "draft": _Level(10, 4.0, 1, 0.10, 0.0647, 0.0875, 0.10),
    "standard": _Level(15, 4.0, 1, 0.05, 0.0376, 0.0354, 0.26),
    "fine": _Level(25, 3.5, 1, 0.02, 0.0156, 0.0146, 1.04),
}
# /aims


def settings(name: str, of: "Scene | str | os.PathLike[str] | float | None" = None) -> Settings:
    """Recommended settings of the default scheme for a scene, or for bodies of a length.

    Errors and cost are those of three collapses of glass beads (docs/settings.md). The errors of another scene show only in runs
    at several spacings, as granperi.report makes them; its cost grows with its particles and its steps.

    Args:
        name: "draft" to see that a scene is right, "standard" for results, "fine" to see whether these still change.
        of: a Scene, the path of a scene file, or the smallest side (m) of the bodies that are to be resolved, finite and above
            0. A scene's is the smallest width or height of its columns. Where something smaller decides (an opening, an
            obstacle, a thin layer), give its length.

    Returns:
        Settings.

    Raises:
        ArgumentError: another name; a length that is not finite or not above 0; a scene without columns, or with particles
            given one by one, which have a spacing of their own.

    Example:
        scene = granperi.Scene.read("collapse.toml")
        scene.config = granperi.settings("standard", scene).config(scene.config)

    Restrictions:
        With granular fluidity take the smaller of this spacing and half a grain. sleep = 1 ends creep slower than 0.006 sqrt(g
        spacing): set 0 where creep is the question, and with the implicit scheme, which refuses it.
    """
    if not isinstance(name, str):
        raise ArgumentTypeError(f"name = {name!r:.80}: expected one of {', '.join(_LEVELS)}")
    if name not in _LEVELS:
        raise ArgumentError(f"name = {name!r:.80}: {near_match(name, _LEVELS)}")
    if isinstance(of, Config) or of is None:
        raise ArgumentTypeError(f"of = {of!r:.80}: expected a Scene, the path of a scene file, or a length in m")
    length = scene_of(of).smallest_side() if isinstance(of, (Scene, str, os.PathLike)) else number("of", of)
    if not (math.isfinite(length) and length > 0):
        raise ArgumentError(f"of = {length:g}: expected a finite length above 0 m, or a scene")
    level = _LEVELS[name]
    return Settings(name, length, length / level.spacings, level.horizon, level.sleep, level.aim, level.peak_error,
                    level.runout_error, level.cpu_seconds)
