#!/usr/bin/python3
"""Draws the collapse of a column to both sides and compares it with experiments and other codes.

Positions, speeds and the peak come from the HDF5 file of examples/c/both_side.c (H5MD layout), the energy ledger, the fronts and the
times of computation from the summary that the program prints.
"""
import argparse
import sys
from pathlib import Path

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import EllipseCollection
from matplotlib.patches import Rectangle

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "bench" / "performance"))

from peers import matter_run_outs
from references import CODES_PEAK_BAND, EXPERIMENT_PEAK  # y/L at PEAK_TIME

TIMES = (0.12, 0.22, 0.42, 1.0)  # s
PEAK_TIME = 0.42  # s


class Frames:
    """The frames of a result file."""

    def __init__(self, path):
        self.file = h5py.File(path, "r")
        self.particles = self.file["particles/all"]
        self.times = self.particles["position/time"][()]
        self.spacing = float(self.file["parameters"].attrs["spacing"])
        first = self.positions(0)
        self.width = float(np.ptp(first[:, 0])) + self.spacing
        self.height = float(np.ptp(first[:, 1])) + self.spacing

    def at(self, time):
        """Number of the frame nearest to this time."""
        frame = int(np.argmin(np.abs(self.times - time)))
        if abs(self.times[frame] - time) > 0.006:
            raise SystemExit(f"there is no frame near {time:g} s: the nearest is at {self.times[frame]:g} s")
        return frame

    def positions(self, frame):
        return self.particles["position/value"][frame, :, :2]

    def state(self, name, frame):
        """A number of gp_state."""
        values = self.file["observables/state/value"]
        return float(values[frame, [one.decode() for one in values.attrs["names"]].index(name)])

    def speeds(self, frame):
        velocity = self.particles["velocity/value"][frame]
        return np.hypot(velocity[:, 0], velocity[:, 1])


def largest_connected(points, spacing):
    """The largest set of points each within 1.6 spacings of another."""
    reach = 1.6 * spacing
    order = np.argsort(points[:, 0], kind="stable")
    sorted_x = points[order, 0]
    group = np.full(len(points), -1)
    groups = 0
    for seed in range(len(points)):
        if group[seed] >= 0:
            continue
        group[seed] = groups
        waiting = [seed]
        while waiting:
            here = points[waiting.pop()]
            low, high = np.searchsorted(sorted_x, (here[0] - reach, here[0] + reach))
            near = order[low:high]
            near = near[(group[near] < 0) & (np.hypot(*(points[near] - here).T) < reach)]
            group[near] = groups
            waiting.extend(near)
        groups += 1
    return points[group == np.argmax(np.bincount(group))]


def surface(points, spacing, x):
    """Heights at x where the volume fraction, smoothed over two spacings, is 1/2 (as gp_get_surface); NaN for none."""
    radius = 2 * spacing
    scale = 10 * spacing**2 / (np.pi * radius**2)  # the weight (1 - r/R)^3 has the integral pi R^2 / 10
    heights = np.full(len(x), np.nan)
    for k, here in enumerate(x):
        near = points[np.abs(points[:, 0] - here) < radius]
        if len(near) == 0:
            continue
        y = np.arange(near[:, 1].max() + radius, 0, -spacing / 16)
        distance = np.hypot(near[:, 0, None] - here, near[:, 1, None] - y)
        fraction = scale * (np.clip(1 - distance / radius, 0, None) ** 3).sum(axis=0)
        inside = np.flatnonzero(fraction >= 0.5)
        if len(inside):
            heights[k] = y[inside[0]]
    return heights


def draw(frames, path):
    """Four panels, one below the other, with common limits."""
    chosen = [frames.at(time) for time in TIMES]
    spacing = frames.spacing
    everything = [frames.positions(frame) for frame in chosen]
    deposits = [largest_connected(points, spacing) for points in everything]
    reach = 1.05 * max(np.abs(points[:, 0]).max() for points in everything)
    top = 1.12 * frames.height
    fastest = max(np.percentile(frames.speeds(frame), 99) for frame in chosen)

    plt.rcParams.update({"font.size": 15})
    panel_width = 9.6
    panel_height = panel_width * top / (2 * reach)
    left, right, lower, upper, gap = 1.0, 1.4, 0.85, 0.2, 0.32  # inches
    figure_width = left + panel_width + right
    figure_height = lower + upper + len(TIMES) * panel_height + (len(TIMES) - 1) * gap
    figure = plt.figure(figsize=(figure_width, figure_height))
    for row, (frame, points, deposit) in enumerate(zip(chosen, everything, deposits)):
        bottom = lower + (len(TIMES) - 1 - row) * (panel_height + gap)
        axes = figure.add_axes([left / figure_width, bottom / figure_height, panel_width / figure_width,
                                panel_height / figure_height])
        size = np.full(len(points), spacing)
        grains = EllipseCollection(size, size, 0, units="xy", offsets=points, transOffset=axes.transData,
                                   array=frames.speeds(frame), cmap="viridis", linewidths=0)
        grains.set_clim(0, fastest)
        axes.add_collection(grains)

        x = np.arange(deposit[:, 0].min(), deposit[:, 0].max(), spacing / 2)
        axes.plot(x, surface(deposit, spacing, x), color="crimson", linewidth=1.8, label="surface")
        axes.add_patch(Rectangle((-frames.width / 2, 0), frames.width, frames.height, fill=False, color="0.45",
                                 linestyle=(0, (5, 4)), linewidth=1.2, label="column at the start"))
        axes.axhline(0, color="black", linewidth=1.5)
        if TIMES[row] == PEAK_TIME:
            peak = EXPERIMENT_PEAK * frames.width
            axes.plot([-0.02, 0.02], [peak, peak], color="black", linewidth=2.2)
            axes.annotate("peak in the experiment", (0.0205, peak), (0.047, peak), va="center", fontsize=14,
                          arrowprops={"arrowstyle": "-", "color": "black", "linewidth": 0.8})
        axes.text(0.012, 0.93, f"t = {frames.times[frame]:.2f} s", transform=axes.transAxes, va="top", fontsize=16,
                  fontweight="bold")
        axes.set_xlim(-reach, reach)
        axes.set_ylim(-0.03 * top, top)
        axes.set_aspect("equal", adjustable="box")
        axes.set_yticks(np.arange(0, top, 0.02))
        axes.set_ylabel("y (m)")
        if row < len(TIMES) - 1:
            axes.tick_params(labelbottom=False)
        else:
            axes.set_xlabel("x (m)")
        if row == 0:
            axes.legend(loc="upper right", frameon=False, fontsize=14)
    bar_axes = figure.add_axes([(left + panel_width + 0.25) / figure_width, lower / figure_height, 0.25 / figure_width,
                                1 - (lower + upper) / figure_height])
    figure.colorbar(grains, cax=bar_axes, extend="max", label="speed (m/s)")
    figure.savefig(path, dpi=110)


def read_summary(path):
    """Lines of "name value unit"."""
    values = {}
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if len(words) >= 2:
                values[words[0]] = float(words[1])
    return values


def run_out(frames):
    """(x - L0)/L0, mean of both sides, of the points that have 5 % of the mass outside of them, at the end."""
    x = frames.positions(frames.at(frames.times[-1]))[:, 0]
    left, right = np.quantile(x, (0.05, 0.95), method="inverted_cdf")
    return float(right - left) / frames.width - 1


def span(values):
    return f"{min(values):.2f}-{max(values):.2f}"


def table(frames, summary):
    """Rows of quantity, value, what to compare it with."""
    peak = frames.state("peak_height", frames.at(PEAK_TIME)) / frames.width
    rows = [("peak y/L at 0.42 s", f"{peak:.3f}",
             f"experiment {EXPERIMENT_PEAK} ({100 * (peak / EXPERIMENT_PEAK - 1):+.1f} %; Xu et al. 2017 in Jin et al. 2021)"),
            ("", "", f"MPM and VOF codes with instant release {span(CODES_PEAK_BAND)}")]
    if not summary:
        return rows
    rows += [
        ("run-out, 90 % of the mass", f"{run_out(frames):.2f}", f"(x - L0)/L0 at {summary['time']:g} s, L0 = L/2"),
        ("", "", f"MPM code with the same law, instant release {span(matter_run_outs())}"),
        ("error of the energy ledger", f"{summary['energy_error_share']:.3f} %", "of the initial energy E0"),
        ("kinetic energy / E0", f"{summary['kinetic'] / summary['energy_initial']:.1e}", f"at {summary['time']:g} s"),
        ("at rest", "yes" if summary["at_rest"] else "no",
         f"since {summary['at_rest_since']:.2f} s" if summary["at_rest"] else f"at {summary['time']:g} s"),
        ("particle-steps / CPU s", f"{summary['particle_steps_rate']:.2e}",
         f"{summary['particles']:.0f} particles, {summary['steps']:.0f} steps"),
        ("CPU seconds", f"{summary['cpu_seconds']:.1f}", "files included"),
    ]
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("frames", help="HDF5 file written by both_side")
    parser.add_argument("--summary", help="what both_side printed; without it the table has the peak only")
    parser.add_argument("--picture", help="PNG file to write")
    parser.add_argument("--table", help="text file to write the table to; it is printed in any case")
    arguments = parser.parse_args()

    frames = Frames(arguments.frames)
    rows = table(frames, read_summary(arguments.summary) if arguments.summary else None)
    text = "\n".join(f"{name:<30} {value:>9}  {remark}".rstrip() for name, value, remark in rows) + "\n"
    print(text, end="")
    if arguments.table:
        with open(arguments.table, "w", encoding="utf-8") as out:
            out.write(text)
    if arguments.picture:
        draw(frames, arguments.picture)


if __name__ == "__main__":
    main()
