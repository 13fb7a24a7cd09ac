"""Pictures, with matplotlib, of a live simulation or of a result file alike.

    granperi.plot.field("collapse.h5", "speed", time=0.2)
    granperi.plot.energy(sim)

A source is a Simulation, a Result or the path of one, or a Snapshot. Every function draws into `axes`, or makes a figure,
and returns the axes: axes.figure.savefig("picture.png") keeps it.
"""
from __future__ import annotations

from typing import Any, Sequence

import numpy as np

from ._errors import ArgumentError
from ._result import DERIVED, Snapshot, history, snapshot

try:
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes
    from matplotlib.collections import EllipseCollection
    from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, Normalize
except ImportError:
    raise ImportError("pictures are drawn with matplotlib (Debian: python3-matplotlib)") from None

from ._animation import animate  # noqa: E402

__all__ = ["animate", "compare", "energy", "field", "fronts", "interface", "surface"]

LABELS = {
    "speed": "speed (m/s)", "shear_stress": "shear stress (Pa)", "pressure": "pressure (Pa)", "density": "density (kg/m³)",
    "vx": "velocity in x (m/s)", "vy": "velocity in y (m/s)", "sxx": "deviatoric stress xx (Pa)",
    "sxy": "shear stress xy (Pa)", "syy": "deviatoric stress yy (Pa)", "shear_rate": "shear rate (1/s)",
    "inertial_number": "inertial number I (grey: 0)", "viscosity": "viscosity (Pa s)", "number_density": "number density",
    "fluidity": "fluidity g (1/s)",
    "column": "column", "id": "particle", "x": "x (m)", "y": "y (m)", "yielded": "state",
}
_LOGARITHMIC = {"inertial_number": (1e-4, 1.0), "viscosity": None, "shear_rate": None, "fluidity": None}
_CATEGORIES = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8c6d00", "#5b5b5b")
_MOST_ENTRIES = 8  # in a legend
_SIGNED = ("vx", "vy", "sxx", "sxy", "syy")
_WIDTH = 9.6  # inches
_SMALL, _LARGE = 14, 16  # points; readable at half size
_STYLE = {"font.size": _SMALL, "axes.labelsize": _LARGE, "lines.linewidth": 2.0}


def _bounds(shot: Snapshot) -> tuple[float, float, float, float]:
    """x and y limits [m] that have all particles, the plates where they are near, and all of a drum that holds particles."""
    x, y, margin = shot.x, shot.y, 2 * shot.spacing
    if not len(x):
        return -1.0, 1.0, 0.0, 1.0
    for line in shot.plate_lines():
        (left, bottom), (right, top) = line.min(axis=0), line.max(axis=0)
        closed = np.hypot(*(line[0] - line[-1])) < 0.01 * shot.spacing
        if closed and left - margin <= x.min() and x.max() <= right + margin and bottom - margin <= y.min() <= top:
            x, y = np.append(x, [left, right]), np.append(y, [bottom, top])
    wide = 0.03 * (np.ptp(x) + np.ptp(y)) + margin
    return x.min() - wide, x.max() + wide, y.min() - margin, y.max() + wide


def _scene_axes(axes: Axes | None, bounds, bar: bool, x_label: bool = True) -> Axes:
    """Axes in m with equal aspect; a new figure is as high as the scene needs."""
    left, right, bottom, top = bounds
    if axes is None:
        inner = (_WIDTH - (2.4 if bar else 1.3)) * (top - bottom) / (right - left)
        with plt.rc_context(_STYLE):
            axes = plt.figure(figsize=(_WIDTH, min(max(inner + 1.3, 2.6), 12)), layout="constrained").add_subplot()
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    axes.set_aspect("equal", adjustable="box")
    _few_ticks(axes)
    if x_label:
        axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    return axes


def _few_ticks(axes: Axes) -> None:
    """So few that their numbers do not touch: the axes may be narrow, to keep the aspect."""
    width, height = axes.get_position().size * axes.figure.get_size_inches()
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    narrow = min(1.0, (right - left) / (top - bottom) * height / width)
    axes.locator_params(axis="x", nbins=max(2, min(9, int(1.1 * width * narrow))))
    axes.locator_params(axis="y", nbins=6)


def _legend_above(axes: Axes) -> None:
    """Beside the title, where it hides nothing; each further row makes a figure of its own higher by as much."""
    rows = -(-len(axes.get_legend_handles_labels()[1]) // 4)
    before = axes.get_legend()
    more = rows - (-(-len(before.get_texts()) // 4) if before is not None else 1)
    if more > 0 and len(axes.figure.axes) == 1:
        axes.figure.set_size_inches(axes.figure.get_size_inches() + [0, 0.3 * more])
    axes.legend(frameon=False, fontsize=_SMALL, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=4, borderaxespad=0.1,
                columnspacing=1.2, handlelength=1.4)


def _curve_axes(axes: Axes | None, x_label: str, y_label: str) -> Axes:
    if axes is None:
        with plt.rc_context(_STYLE):
            axes = plt.figure(figsize=(_WIDTH, 5.6), layout="constrained").add_subplot()
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.spines[["top", "right"]].set_visible(False)
    return axes


def _plates(axes: Axes, shot: Snapshot, colour: str = "black", but: "list[np.ndarray] | None" = None) -> None:
    """Plates where they are at that time; but: without those that are where they are there."""
    for k, line in enumerate(shot.plate_lines()):
        if but is None or not np.allclose(line, but[k], rtol=0, atol=0.01 * shot.spacing):
            axes.plot(*line.T, color=colour, linewidth=2, zorder=3, solid_capstyle="butt", gid="plate")


def _surface_line(shot: Snapshot) -> tuple[np.ndarray, np.ndarray]:
    """Stations half a spacing apart between the fronts, and the heights there."""
    state = shot.state
    if not state.x_right > state.x_left:
        return np.empty(0), np.empty(0)
    x = np.arange(state.x_left, state.x_right, shot.spacing / 2)
    y = shot.surface(x)
    return x, np.where(y != 0, y, np.nan)


def _colours(name: str, values: np.ndarray) -> tuple[Any, Any, str]:
    """Colour map, scale, and the ends of the bar that go on."""
    finite = values[np.isfinite(values)]
    if name == "yielded":
        return ListedColormap(["#9db4c9", "#c8401f"]), BoundaryNorm([-0.5, 0.5, 1.5], 2), "neither"
    if name in _LOGARITHMIC:
        positive = finite[finite > 0]
        low, high = _LOGARITHMIC[name] or (np.percentile(positive, [5, 99.5]) if len(positive) else (0.1, 1.0))
        return plt.get_cmap("viridis").with_extremes(bad="0.85"), LogNorm(low, max(high, 1.001 * low)), "both"
    if name in _SIGNED:
        most = np.percentile(np.abs(finite), 99.5) if len(finite) else 1.0
        return plt.get_cmap("RdBu_r"), Normalize(-(most or 1.0), most or 1.0), "both"
    if name == "column":  # categories: the bar has one field for each
        last = max(int(finite.max(initial=0)), 0)
        colours = [_CATEGORIES[k % len(_CATEGORIES)] for k in range(last + 1)]
        return ListedColormap(colours), BoundaryNorm(np.arange(-0.5, last + 1), last + 1), "neither"
    if name == "id":
        return plt.get_cmap("viridis"), Normalize(finite.min(initial=0), finite.max(initial=1)), "neither"
    low = min(0.0, finite.min(initial=0.0)) if name not in ("density", "x", "y") else finite.min(initial=np.inf)
    high = np.percentile(finite, 99.5) if len(finite) else 1.0
    return plt.get_cmap("viridis"), Normalize(low, high if high > low else low + 1.0), "max"


def _draw_particles(axes: Axes, x, y, values, spacing: float, colours) -> EllipseCollection:
    """Discs of the diameter of the spacing, in the axes' own units."""
    cmap, norm, _ = colours
    size = np.full(len(x), spacing)
    discs = EllipseCollection(size, size, np.zeros(len(x)), units="xy", offsets=np.column_stack([x, y]),
                              transOffset=axes.transData, array=_drawable(values, norm), cmap=cmap, norm=norm, linewidths=0)
    axes.add_collection(discs)
    return discs


def _drawable(values: np.ndarray, norm) -> np.ndarray:
    values = np.asarray(values, dtype=float)
    return np.ma.masked_less_equal(values, 0) if isinstance(norm, LogNorm) else values  # 0, as I where p = 0: grey


def _colour_bar(axes: Axes, discs, name: str, extend: str) -> None:
    with plt.rc_context(_STYLE):
        bar = axes.figure.colorbar(discs, ax=axes, extend=extend, label=LABELS[name], fraction=0.05, pad=0.02, shrink=0.9)
    if name == "column":
        last = round(discs.norm.vmax - 0.5)
        bar.set_ticks(range(0, last + 1, 1 + last // _MOST_ENTRIES))
        bar.minorticks_off()
    if name == "yielded":
        bar.set_ticks([0, 1], labels=["below yield", "at yield"], rotation=90, va="center")
        bar.set_label("")


def _time_text(axes: Axes, time: float):
    axes.set_title(f"t = {time:.3f} s", loc="left", fontsize=_SMALL)
    return axes.title


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
        ArgumentError: a name that does not exist, a field that the file has not, a time without a frame.
        FileError: a file that is no result.

    Example:
        granperi.plot.field("collapse.h5", "pressure", time=0.02).figure.savefig("pressure.png")
    """
    shot = snapshot(source, time)
    values = shot.field(name)
    colours = _colours(name, values)
    axes = _scene_axes(axes, _bounds(shot), bar=True)
    discs = _draw_particles(axes, shot.x, shot.y, values, shot.spacing, colours)
    _plates(axes, shot)
    _colour_bar(axes, discs, name, colours[2])
    _time_text(axes, shot.time)
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
    bounds = np.array([_bounds(shot) for shot in shots])
    left, right, bottom, top = bounds[:, 0].min(), bounds[:, 1].max(), bounds[:, 2].min(), bounds[:, 3].max()
    if axes is None:
        axes = _scene_axes(None, (left, right, bottom, top), bar=False)
        axes.set_title("free surface", loc="left", fontsize=_SMALL)
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
    named = set(np.linspace(0, len(shots) - 1, min(len(shots), _MOST_ENTRIES)).round().astype(int))  # first and last among them
    last = shots[-1].plate_lines()
    for k, (shot, colour) in enumerate(zip(shots, colours)):
        text = labels[k] if labels else f"t = {shot.time:.3f} s"
        curve, = axes.plot(*_surface_line(shot), label=text if k in named else None, linewidth=2, color=colour)
        if k < len(shots) - 1:
            _plates(axes, shot, curve.get_color(), but=last)
    _plates(axes, shots[-1])
    _few_ticks(axes)
    _legend_above(axes)
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
    axes = _scene_axes(axes, _bounds(shot), bar=False)
    column = shot.field("column")
    colours = {left: "#e3b778", right: "#86aac8"}
    for one in np.unique(column):
        here = column == one
        _draw_particles(axes, shot.x[here], shot.y[here], np.zeros(here.sum()), shot.spacing,
                        (ListedColormap([colours.get(int(one), "0.8")]), Normalize(0, 1), ""))
    y = np.arange(shot.y.min(), shot.y.max() + shot.spacing, shot.spacing / 2)
    x = shot.interface(left, right, y)
    axes.plot(x, y, color="black", linewidth=2.5, label=f"interface of columns {left} and {right}")
    axes.plot(*_surface_line(shot), color="crimson", linewidth=1.5, label="surface")
    _plates(axes, shot)
    _legend_above(axes)
    _time_text(axes, shot.time)
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
    axes = _curve_axes(axes, "t (s)", "energy (J per metre of depth)")
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
    axes.set_title(f"largest error of the ledger {worst:.2g} J/m{share}", loc="left", fontsize=_SMALL)
    axes.legend(frameon=False, fontsize=_SMALL, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return axes


def fronts(source: Any, axes: Axes | None = None) -> Axes:
    """Time-distance diagram of where the mass lies: bands that hold its middle 98, 90 and 50 %, the middle and the peak.

    Unlike the outermost grains, which a single one sets, these converge with the spacing.

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
    axes = _curve_axes(axes, "x (m)", "t (s)")
    for low, high, share, colour in ((past.x_q01, past.x_q99, 98, "#d7e4f0"), (past.x_q05, past.x_q95, 90, "#a9c6e0"),
                                     (past.x_q25, past.x_q75, 50, "#6a9cc8")):
        axes.fill_betweenx(past.time, low, high, color=colour, linewidth=0, label=f"{share} % of the mass")
    axes.plot(past.x_q05, past.time, color="#0072b2", linewidth=2, label="5 and 95 %")
    axes.plot(past.x_q95, past.time, color="#0072b2", linewidth=2)
    axes.plot(past.x_q50, past.time, color="black", linewidth=1.5, label="half of it")
    axes.plot(past.peak_x, past.time, label="peak", linestyle=":", color="#d55e00")
    axes.set_ylim(past.time[0], past.time[-1])
    axes.legend(frameon=False, fontsize=_SMALL, loc="center left", bbox_to_anchor=(1.0, 0.5))
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
    bounds = np.array([_bounds(shot) for shot in shots])
    axes = _scene_axes(axes, (bounds[:, 0].min(), bounds[:, 1].max(), bounds[:, 2].min(), bounds[:, 3].max()), bar=False)
    for shot, label, style, colour in zip(shots, labels, ("-", "--"), ("#0072b2", "#d55e00")):
        axes.plot(*_surface_line(shot), linestyle=style, color=colour, label=f"{label}, t = {shot.time:.3f} s")
        _plates(axes, shot, colour)
    _legend_above(axes)
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
