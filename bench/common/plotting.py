"""How the figures of all reports look: sizes, lines, legends."""
from __future__ import annotations

from pathlib import Path
from typing import Callable

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from results import Collection

plt.rcParams.update(
    {
        "font.size": 14,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "lines.linewidth": 2.0,
        "axes.labelsize": 15,
        "legend.fontsize": 12.5,
        "figure.dpi": 100,
    }
)


def finish(figure: plt.Figure, path: Path) -> bool:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, bbox_inches="tight", pad_inches=0.12)
    plt.close(figure)
    return True


def legend_above(figure: plt.Figure, axes: Axes, columns: int) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=columns)


Figures = dict[str, Callable[[Path, Collection], bool]]


def draw_all(figures: Figures, directory: Path, prefix: str, results: Collection) -> set[str]:
    """Names of the figures that were drawn, as prefix_name.png; files of those that were not are removed."""
    drawn = set()
    for name, draw in figures.items():
        path = directory / f"{prefix}_{name}.png"
        if draw(path, results):
            drawn.add(name)
        else:
            path.unlink(missing_ok=True)
    return drawn
