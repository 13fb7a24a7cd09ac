"""What pictures and animations are drawn with: axes, discs, colours, plates and surfaces."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._snapshot import Snapshot

try:
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes
    from matplotlib.collections import EllipseCollection
    from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, Normalize
except ImportError:
    raise ImportError("pictures are drawn with matplotlib (pip install matplotlib, or Debian's python3-matplotlib)") from None

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
MOST_ENTRIES = 8  # in a legend
_SIGNED = ("vx", "vy", "sxx", "sxy", "syy")
_WIDTH = 9.6  # inches
SMALL, LARGE = 14, 16  # points; readable at half size
STYLE = {"font.size": SMALL, "axes.labelsize": LARGE, "lines.linewidth": 2.0}


def bounds_of(shot: Snapshot) -> tuple[float, float, float, float]:
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


def scene_axes(axes: Axes | None, bounds, bar: bool, x_label: bool = True) -> Axes:
    """Axes in m with equal aspect; a new figure is as high as the scene needs."""
    left, right, bottom, top = bounds
    if axes is None:
        inner = (_WIDTH - (2.4 if bar else 1.3)) * (top - bottom) / (right - left)
        with plt.rc_context(STYLE):
            axes = plt.figure(figsize=(_WIDTH, min(max(inner + 1.3, 2.6), 12)), layout="constrained").add_subplot()
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    axes.set_aspect("equal", adjustable="box")
    few_ticks(axes)
    if x_label:
        axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    return axes


def few_ticks(axes: Axes) -> None:
    """So few that their numbers do not touch: the axes may be narrow, to keep the aspect."""
    width, height = axes.get_position().size * axes.figure.get_size_inches()
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    narrow = min(1.0, (right - left) / (top - bottom) * height / width)
    axes.locator_params(axis="x", nbins=max(2, min(9, int(1.1 * width * narrow))))
    axes.locator_params(axis="y", nbins=6)


def legend_above(axes: Axes) -> None:
    """Beside the title, where it hides nothing; each further row makes a figure of its own higher by as much."""
    rows = -(-len(axes.get_legend_handles_labels()[1]) // 4)
    before = axes.get_legend()
    more = rows - (-(-len(before.get_texts()) // 4) if before is not None else 1)
    if more > 0 and len(axes.figure.axes) == 1:
        axes.figure.set_size_inches(axes.figure.get_size_inches() + [0, 0.3 * more])
    axes.legend(frameon=False, fontsize=SMALL, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=4, borderaxespad=0.1,
                columnspacing=1.2, handlelength=1.4)


def curve_axes(axes: Axes | None, x_label: str, y_label: str) -> Axes:
    if axes is None:
        with plt.rc_context(STYLE):
            axes = plt.figure(figsize=(_WIDTH, 5.6), layout="constrained").add_subplot()
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.spines[["top", "right"]].set_visible(False)
    return axes


def draw_plates(axes: Axes, shot: Snapshot, colour: str = "black", but: "list[np.ndarray] | None" = None) -> None:
    """Plates where they are at that time; but: without those that are where they are there."""
    for k, line in enumerate(shot.plate_lines()):
        if but is None or not np.allclose(line, but[k], rtol=0, atol=0.01 * shot.spacing):
            axes.plot(*line.T, color=colour, linewidth=2, zorder=3, solid_capstyle="butt", gid="plate")


def surface_line(shot: Snapshot) -> tuple[np.ndarray, np.ndarray]:
    """Stations half a spacing apart between the fronts, and the heights there."""
    state = shot.state
    if not state.x_right > state.x_left:
        return np.empty(0), np.empty(0)
    x = np.arange(state.x_left, state.x_right, shot.spacing / 2)
    y = shot.surface(x)
    return x, np.where(y != 0, y, np.nan)


def colours_of(name: str, values: np.ndarray) -> tuple[Any, Any, str]:
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


def draw_particles(axes: Axes, x, y, values, spacing: float, colours) -> EllipseCollection:
    """Discs of the diameter of the spacing, in the axes' own units."""
    cmap, norm, _ = colours
    size = np.full(len(x), spacing)
    discs = EllipseCollection(size, size, np.zeros(len(x)), units="xy", offsets=np.column_stack([x, y]),
                              transOffset=axes.transData, array=drawable(values, norm), cmap=cmap, norm=norm, linewidths=0)
    axes.add_collection(discs)
    return discs


def drawable(values: np.ndarray, norm) -> np.ndarray:
    values = np.asarray(values, dtype=float)
    return np.ma.masked_less_equal(values, 0) if isinstance(norm, LogNorm) else values  # 0, as I where p = 0: grey


def colour_bar(axes: Axes, discs, name: str, extend: str) -> None:
    with plt.rc_context(STYLE):
        bar = axes.figure.colorbar(discs, ax=axes, extend=extend, label=LABELS[name], fraction=0.05, pad=0.02, shrink=0.9)
    if name == "column":
        last = round(discs.norm.vmax - 0.5)
        bar.set_ticks(range(0, last + 1, 1 + last // MOST_ENTRIES))
        bar.minorticks_off()
    if name == "yielded":
        bar.set_ticks([0, 1], labels=["below yield", "at yield"], rotation=90, va="center")
        bar.set_label("")


def time_text(axes: Axes, time: float):
    axes.set_title(f"t = {time:.3f} s", loc="left", fontsize=SMALL)
    return axes.title
