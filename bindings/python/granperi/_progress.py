"""The progress bar of a run."""
from __future__ import annotations

import importlib.util
import sys
from typing import Any

from ._engine import Engine
from ._library import ffi, lib


def has_tqdm() -> bool:
    """Whether a bar can be shown."""
    return importlib.util.find_spec("tqdm") is not None


def require_tqdm(shown: bool) -> None:
    """The error of a bar that cannot be shown, before anything is begun."""
    if shown and not has_tqdm():
        raise ImportError("a progress bar needs tqdm (pip install tqdm, or Debian's python3-tqdm); or run with progress=False")


def new_bar(**options: Any) -> Any:
    """A bar of tqdm: in a notebook its widget, else text."""
    require_tqdm(True)
    from tqdm.auto import tqdm

    widgets = sys.modules.get("ipywidgets")
    if widgets is not None and widgets.version_info[0] < 7:  # Debian 12 has 6, of which tqdm 4.64 makes an AttributeError
        from tqdm.std import tqdm
    return tqdm(**options)


class Progress:
    """with Progress(engine, t_end): a bar over simulated time while the block runs; nothing if not shown."""

    def __init__(self, engine: Engine, t_end: float, shown: bool = True):
        self._engine, self._t_end, self._shown = engine, t_end, shown
        self._bar: Any = None

    def __enter__(self) -> "Progress":
        if not self._shown:
            return self
        self._bar = new_bar(total=self._t_end, initial=self._time(), unit="s", desc="simulated",
                         bar_format="{desc} {n:.3f}/{total:g} s |{bar}| {percentage:3.0f} % [{elapsed}<{remaining}]")
        self._before = self._engine.on_look
        self._engine.on_look = self._look
        return self

    def _time(self) -> float:
        time = ffi.new("double *")
        lib.gp_get_clock(self._engine.sim, time, ffi.NULL, ffi.NULL)
        return time[0]

    def _look(self) -> None:
        if self._before is not None:
            self._before()
        self._update()

    def _update(self) -> None:
        self._bar.n = min(self._time(), self._t_end)
        self._bar.refresh()

    def __exit__(self, *error: object) -> None:
        if self._bar is not None:
            self._engine.on_look = self._before
            if not self._engine.closed:
                self._update()
            self._bar.close()
