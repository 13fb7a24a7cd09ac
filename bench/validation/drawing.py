"""How the figures of docs/validation.md look: colours, lines, sizes, legends."""
from __future__ import annotations

from pathlib import Path
from typing import Callable, Iterable

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

import runs
from results import Collection, Result

STYLES = {  # colour (readable with colour blindness), line
    "default": ("#0072B2", "-"),
    "raised": ("#56B4E9", "--"),
    "walls": ("#009E73", "-."),
    "nonlocal_1": ("#E69F00", "-"),
    "nonlocal_2": ("#D55E00", "-"),
    "local_1": ("#CC79A7", "--"),
    "local_2": ("#7A3B69", "--"),
}
MARKERS = {
    "default": "o",
    "raised": "s",
    "walls": "^",
    "nonlocal_1": "D",
    "nonlocal_2": "v",
    "local_1": "<",
    "local_2": ">",
}

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


Available = list[tuple[str, Result]]


def available(results: Collection, run_of: Callable[[str], runs.Run], schemes: Iterable[str]) -> Available:
    """The schemes that have a result."""
    pairs = ((key, results(run_of(key))) for key in schemes)
    return [(key, result) for key, result in pairs if result is not None]


def finish(figure: plt.Figure, path: Path) -> bool:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, bbox_inches="tight", pad_inches=0.12)
    plt.close(figure)
    return True


def legend_above(figure: plt.Figure, axes: Axes, columns: int) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=columns)


def label_of(scheme: str) -> str:
    return runs.SCHEMES[scheme].label
