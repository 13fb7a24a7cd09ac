"""Animations as MP4 (ffmpeg) or GIF (Pillow)."""
from __future__ import annotations

import importlib.util
import os
import shutil
from typing import Any, Callable

import numpy as np

from ._drawing import STYLE, bounds_of, colour_bar, colours_of, draw_particles, drawable, plt, scene_axes, surface_line, time_text
from ._errors import ArgumentError, ArgumentTypeError
from ._result import Result
from ._simulation import Simulation
from ._snapshot import LiveSnapshot, Snapshot


def _writer(path: str, fps: int):
    """The writer for this file name, or an error that says what is missing."""
    from matplotlib.animation import FFMpegWriter, PillowWriter

    extension = os.path.splitext(path)[1].lower()
    if extension in (".mp4", ".mkv", ".webm"):
        if shutil.which("ffmpeg") is None:
            raise ArgumentError(f"{path}: {extension} files are written with ffmpeg, which is not installed (Debian: "
                                "ffmpeg); a name that ends in .gif needs Pillow only")
        return FFMpegWriter(fps=fps, extra_args=["-pix_fmt", "yuv420p"] if extension == ".mp4" else None)
    if extension == ".gif":
        if importlib.util.find_spec("PIL") is None:
            raise ArgumentError(f"{path}: .gif files are written with Pillow, which is not installed (pip install pillow, or Debian's python3-pil)")
        return PillowWriter(fps=fps)
    raise ArgumentError(f"{path}: expected a name that ends in .mp4 (needs ffmpeg) or .gif (needs Pillow)")


class _Drawn:
    """What one picture of the animation needs, copied."""

    def __init__(self, shot: Snapshot, name: str):
        self.time, self.x, self.y, self.values = shot.time, shot.x, shot.y, np.asarray(shot.field(name), dtype=float)
        self.bounds, self.line, self.plates = bounds_of(shot), surface_line(shot), shot.plate_lines()
        self.spacing = shot.spacing


def _shots(source: Any, name: str, t_end: float | None, every: float, progress: bool) -> list[_Drawn]:
    if isinstance(source, (str, os.PathLike)):
        with Result(source) as result:
            return [_Drawn(shot, name) for shot in result]
    if isinstance(source, Result):
        return [_Drawn(shot, name) for shot in source]
    if isinstance(source, Simulation):
        if t_end is None:
            raise ArgumentError("t_end: expected the end [s] of the run that is to be shown")
        return [_Drawn(LiveSnapshot(source), name) for _ in source.frames(t_end, every, progress)]
    raise ArgumentTypeError(f"{source!r:.80}: expected a Simulation, a Result or the path of a result file")


def animate(source: Any, path: "str | os.PathLike[str]", name: str = "speed", t_end: float | None = None,
            every: float = 0.01, fps: int = 20, progress: bool = False) -> None:
    """Writes an animation of a field: all frames of a result file, or of a simulation, which is run for it.

    Args:
        source: a Result or its path, or a simulation.
        path: a name that ends in .mp4, .mkv or .webm (needs ffmpeg), or .gif (needs Pillow).
        name: of a field of Field, in small letters, or "speed", "shear_stress", "yielded".
        t_end: s, of a simulation: the end of its run.
        every: s, of a simulation: between two frames.
        fps: pictures per second, at least 1.
        progress: of a simulation: shows a bar (needs tqdm).

    Raises:
        ArgumentError: another ending of the name, a program that is not installed, no t_end.
        FileError: a file that is no result.

    Example:
        granperi.plot.animate("collapse.h5", "collapse.gif", "speed")
    """
    path = os.fspath(path)
    if not (isinstance(fps, int) and 1 <= fps <= 120):
        raise ArgumentError(f"fps = {fps!r}: expected a whole number from 1 to 120")
    writer = _writer(path, fps)
    drawn = _shots(source, name, t_end, every, progress)
    if not drawn:
        raise ArgumentError("there are no frames to show")
    bounds = np.array([one.bounds for one in drawn])
    limits = bounds[:, 0].min(), bounds[:, 1].max(), bounds[:, 2].min(), bounds[:, 3].max()
    colours = colours_of(name, np.concatenate([one.values for one in drawn]))
    with plt.rc_context(STYLE):
        axes = scene_axes(None, limits, bar=True)
    figure = axes.figure
    first = drawn[0]
    discs = draw_particles(axes, first.x, first.y, first.values, first.spacing, colours)
    colour_bar(axes, discs, name, colours[2])
    line, = axes.plot([], [], color="crimson", linewidth=1.5)
    plates = [axes.plot([], [], color="black", linewidth=2)[0] for _ in first.plates]
    show = _updater(axes, discs, line, plates, colours)
    show(first)
    figure.canvas.draw()
    figure.set_layout_engine("none")  # the axes must not move from frame to frame
    width, height = (2 * round(figure.dpi * inches / 2) / figure.dpi for inches in figure.get_size_inches())
    figure.set_size_inches(width, height)  # video needs even numbers of pixels
    with writer.saving(figure, path, dpi=figure.dpi):
        for one in drawn:
            show(one)
            writer.grab_frame()
    plt.close(figure)


def _updater(axes, discs, line, plates, colours) -> Callable[[_Drawn], None]:
    def show(one: _Drawn) -> None:
        discs.set_offsets(np.column_stack([one.x, one.y]))
        discs.set_array(drawable(one.values, colours[1]))
        line.set_data(*one.line)
        for plate, points in zip(plates, one.plates):
            plate.set_data(*points.T)
        time_text(axes, one.time)

    return show
