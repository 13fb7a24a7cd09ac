"""Pictures, with matplotlib, of a live simulation or of a result file alike.

    granperi.plot.field("collapse.h5", "speed", time=0.2)
    granperi.plot.energy(sim)

A source is a Simulation, a Result or the path of one, or a Snapshot. Every function draws into `axes`, or makes a figure,
and returns the axes: axes.figure.savefig("picture.png") keeps it.
"""
from __future__ import annotations

from typing import Any, Sequence

import numpy as np

from ._animation import animate
from ._drawing import (LABELS, MOST_ENTRIES, SMALL, Axes, ListedColormap, Normalize, bounds_of, colour_bar, colours_of, curve_axes,
                       draw_particles, draw_plates, few_ticks, legend_above, plt, scene_axes, surface_line, time_text)
from ._derived import DERIVED
from ._errors import ArgumentError
from ._result import history, snapshot
from ._snapshot import Snapshot

__all__ = ["animate", "compare", "energy", "field", "fronts", "interface", "surface"]


def field(source: Any, name: str = "speed", time: float | None = None, axes: Axes | None = None) -> Axes:
    """Map of a field.

    Args:
        source: a simulation (as it is now), a Result or its path, or a Snapshot.
        name: of a field of Field, in small letters, or "speed", "shear_stress", "yielded".
        time: s, of a result; not given: the last frame.
        axes: of matplotlib, to draw into; not given: a figure of its own.

    Returns:
        matplotlib's axes.

    Raises:
        ArgumentError: a name that does not exist, a field that the file does not have, a time without a frame.
        FileError: a file that is no result.

    Example:
        granperi.plot.field("collapse.h5", "pressure", time=0.02).figure.savefig("pressure.png")
    """
    shot = snapshot(source, time)
    values = shot.field(name)
    colours = colours_of(name, values)
    axes = scene_axes(axes, bounds_of(shot), bar=True)
    discs = draw_particles(axes, shot.x, shot.y, values, shot.spacing, colours)
    draw_plates(axes, shot)
    colour_bar(axes, discs, name, colours[2])
    time_text(axes, shot.time)
    return axes


def surface(source: Any, time: "float | Sequence[float] | None" = None, axes: Axes | None = None,
            label: str | None = None) -> Axes:
    """The free surface of the deposit, and the plates, where they are at that time.

    Draw into the same axes for several sources.

    Args:
        source: a simulation (as it is now), a Result or its path, or a Snapshot.
        time: s, of a result, one or several, from light to dark; not given: the last frame.
        axes: of matplotlib, to draw into; not given: a figure of its own.
        label: in the legend; not given: the time.

    Returns:
        matplotlib's axes.

    Raises:
        ArgumentError: a time without a frame, no time at all.
        FileError: a file that is no result.

    Example:
        granperi.plot.surface("collapse.h5", [0, 0.02, 0.04]).figure.savefig("surface.png")
    """
    if time is None or np.ndim(time) == 0:
        return _surfaces([snapshot(source, time)], axes, None if label is None else [label], [None])
    times = [float(one) for one in time]
    if not times:
        raise ArgumentError("time: expected one time or several")
    shots = [snapshot(source, one) for one in times]
    labels = [f"t = {shot.time:.3g} s" if label is None else f"{label}, t = {shot.time:.3g} s" for shot in shots]
    return _surfaces(shots, axes, labels, list(plt.get_cmap("viridis_r")(np.linspace(0.15, 1.0, len(shots)))))


def _surfaces(shots: Sequence[Snapshot], axes: Axes | None, labels: "list[str] | None", colours: list) -> Axes:
    bounds = np.array([bounds_of(shot) for shot in shots])
    left, right, bottom, top = bounds[:, 0].min(), bounds[:, 1].max(), bounds[:, 2].min(), bounds[:, 3].max()
    if axes is None:
        axes = scene_axes(None, (left, right, bottom, top), bar=False)
        axes.set_title("free surface", loc="left", fontsize=SMALL)
    else:  # room for all that is drawn, at the size that it has
        (left_before, right_before), (bottom_before, top_before) = axes.get_xlim(), axes.get_ylim()
        left, right = min(left, left_before), max(right, right_before)
        bottom, top = min(bottom, bottom_before), max(top, top_before)
        figure, inches = axes.figure, axes.figure.get_size_inches()
        grown = (top - bottom) / (top_before - bottom_before) * (right_before - left_before) / (right - left)
        if len(figure.axes) == 1 and grown > 1:  # a figure of our own kind: higher, not narrower
            figure.set_size_inches(inches[0], min(inches[1] + (inches[1] - 1.3) * (grown - 1), 12))
        axes.set_xlim(left, right)
        axes.set_ylim(bottom, top)
    named = set(np.linspace(0, len(shots) - 1, min(len(shots), MOST_ENTRIES)).round().astype(int))  # first and last among them
    last = shots[-1].plate_lines()
    for k, (shot, colour) in enumerate(zip(shots, colours)):
        text = labels[k] if labels else f"t = {shot.time:.3f} s"
        curve, = axes.plot(*surface_line(shot), label=text if k in named else None, linewidth=2, color=colour)
        if k < len(shots) - 1:
            draw_plates(axes, shot, curve.get_color(), but=last)
    draw_plates(axes, shots[-1])
    few_ticks(axes)
    legend_above(axes)
    return axes


def interface(source: Any, left: int = 0, right: int = 1, time: float | None = None, axes: Axes | None = None) -> Axes:
    """The particles by column, and the interface of two columns.

    Args:
        source: a simulation (as it is now), a Result or its path, or a Snapshot.
        left, right: numbers of two columns or sets of particles.
        time: s, of a result; not given: the last frame.
        axes: of matplotlib, to draw into; not given: a figure of its own.

    Returns:
        matplotlib's axes.

    Raises:
        ArgumentError: a column that does not exist, a time without a frame.
        FileError: a file that is no result.

    Example:
        sim.add_column(x_min=0.05, width=0.05, height=0.05)
        sim.run(0.02)
        granperi.plot.interface(sim, 0, 1).figure.savefig("interface.png")
    """
    shot = snapshot(source, time)
    axes = scene_axes(axes, bounds_of(shot), bar=False)
    column = shot.field("column")
    colours = {left: "#e3b778", right: "#86aac8"}
    for one in np.unique(column):
        here = column == one
        draw_particles(axes, shot.x[here], shot.y[here], np.zeros(here.sum()), shot.spacing,
                        (ListedColormap([colours.get(int(one), "0.8")]), Normalize(0, 1), ""))
    y = np.arange(shot.y.min(), shot.y.max() + shot.spacing, shot.spacing / 2)
    x = shot.interface(left, right, y)
    axes.plot(x, y, color="black", linewidth=2.5, label=f"interface of columns {left} and {right}")
    axes.plot(*surface_line(shot), color="crimson", linewidth=1.5, label="surface")
    draw_plates(axes, shot)
    legend_above(axes)
    time_text(axes, shot.time)
    return axes


def energy(source: Any, axes: Axes | None = None) -> Axes:
    """The energy ledger over time.

    Args:
        source: a History, a simulation that has kept one (frames, record), a Result or its path.
        axes: of matplotlib, to draw into; not given: a figure of its own.

    Returns:
        matplotlib's axes.

    Raises:
        ArgumentError: a source without frames.
        FileError: a file that is no result.

    Example:
        granperi.plot.energy("collapse.h5").figure.savefig("energy.png")
    """
    past = history(source)
    axes = curve_axes(axes, "t (s)", "energy (J per metre of depth)")
    parts = {"potential": "#4c78a8", "kinetic": "#f58518", "elastic": "#72b7b2", "dissipated": "#b279a2",
             "plate_work": "#9d755d"}
    for name, colour in parts.items():
        axes.plot(past.time, getattr(past, name), color=colour, label=name.replace("_", " ") if name != "plate_work"
                  else "work on plates")
    initial = past.energy_initial[0]
    axes.plot(past.time, past.energy_initial - past.energy_error, color="black", linestyle=(0, (5, 3)), linewidth=1.5,
              label="sum")
    worst = np.abs(past.energy_error).max()
    share = f" = {100 * worst / initial:.2g} % of the initial energy" if initial > 0 else ""
    axes.set_title(f"largest error of the ledger {worst:.2g} J/m{share}", loc="left", fontsize=SMALL)
    axes.legend(frameon=False, fontsize=SMALL, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return axes


def fronts(source: Any, axes: Axes | None = None) -> Axes:
    """Time-distance diagram of where the mass lies: bands that hold its middle 98, 90 and 50 %, the middle and the peak.

    Unlike the ends of the deposit, which single grains set, these converge with the spacing.

    Args:
        source: a History, a simulation that has kept one (frames, record), a Result or its path.
        axes: of matplotlib, to draw into; not given: a figure of its own.

    Returns:
        matplotlib's axes.

    Raises:
        ArgumentError: a source without frames.
        FileError: a file that is no result.

    Example:
        granperi.plot.fronts("collapse.h5").figure.savefig("fronts.png")
    """
    past = history(source)
    axes = curve_axes(axes, "x (m)", "t (s)")
    for low, high, share, colour in ((past.x_q01, past.x_q99, 98, "#d7e4f0"), (past.x_q05, past.x_q95, 90, "#a9c6e0"),
                                     (past.x_q25, past.x_q75, 50, "#6a9cc8")):
        axes.fill_betweenx(past.time, low, high, color=colour, linewidth=0, label=f"{share} % of the mass")
    axes.plot(past.x_q05, past.time, color="#0072b2", linewidth=2, label="5 and 95 %")
    axes.plot(past.x_q95, past.time, color="#0072b2", linewidth=2)
    axes.plot(past.x_q50, past.time, color="black", linewidth=1.5, label="half of it")
    axes.plot(past.peak_x, past.time, label="peak", linestyle=":", color="#d55e00")
    axes.set_ylim(past.time[0], past.time[-1])
    axes.legend(frameon=False, fontsize=SMALL, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return axes


def compare(one: Any, other: Any, time: float | None = None, labels: tuple[str, str] = ("first", "second"),
            axes: Axes | None = None) -> Axes:
    """The free surfaces of two sources over each other.

    Args:
        one, other: simulations (as they are now), results, their paths, or snapshots.
        time: s, of results; not given: the last frame.
        labels: two texts for the legend.
        axes: of matplotlib, to draw into; not given: a figure of its own.

    Returns:
        matplotlib's axes.

    Raises:
        ArgumentError: a time without a frame.
        FileError: a file that is no result.

    Example:
        granperi.plot.compare("collapse.h5", sim).figure.savefig("both.png")
    """
    shots = [snapshot(source, time) for source in (one, other)]
    bounds = np.array([bounds_of(shot) for shot in shots])
    axes = scene_axes(axes, (bounds[:, 0].min(), bounds[:, 1].max(), bounds[:, 2].min(), bounds[:, 3].max()), bar=False)
    for shot, label, style, colour in zip(shots, labels, ("-", "--"), ("#0072b2", "#d55e00")):
        axes.plot(*surface_line(shot), linestyle=style, color=colour, label=f"{label}, t = {shot.time:.3f} s")
        draw_plates(axes, shot, colour)
    legend_above(axes)
    return axes


def known_pictures() -> dict[str, Any]:
    """What the command line can draw: name, and the function of source and time."""
    pictures: dict[str, Any] = {name: (lambda source, time, name=name: field(source, name, time))
                                for name in (*DERIVED, *LABELS) if name not in ("x", "y")}
    pictures.update(surface=lambda source, time: surface(source, time),
                    interface=lambda source, time: interface(source, time=time))
    for name, draw in (("energy", energy), ("fronts", fronts)):
        pictures[name] = lambda source, time, name=name, draw=draw: draw(_whole_run(source, time, name))
    return pictures


def _whole_run(source: Any, time: float | None, name: str) -> Any:
    if time is not None:
        raise ArgumentError(f"time = {time:g} s: the picture '{name}' is of the whole run")
    return source
