"""The parts of docs/performance.md about what a scene does not need, memory and growth."""
from __future__ import annotations

import math
import re

import numpy as np

import runs
from markdown import NONE, fixed, significant, table
from results import Collection, Result
from sections import percent, seconds, share

MEMORY = 20 * 2**30  # bytes, of the largest scene
NOISE = 0.01  # what a feature that is not used may cost


def machine(results: Collection) -> str:
    found = results(runs.machine())
    if not found:
        return "The machine was not asked for its name."
    said = dict(re.findall(r"^(processor|compiler): (.*)$", found.output, re.M))
    caches = ", ".join(
        f"L{k} {found.summary[f'cache_{k}'] / 1024:.0f} KiB" for k in (1, 2, 3) if f"cache_{k}" in found.summary
    )
    return (
        f"Machine: {said.get('processor', 'unknown')}, {found.summary['cores']:.0f} cores ({caches or 'caches unknown'}); "
        f"{said.get('compiler', 'unknown')}; load {found.summary['load']:.1f} when the runs began."
    )


def _quartiles(r: Result) -> str:
    s = r.summary
    return f"{percent(s['ratio'] - 1)} ({percent(s['ratio_low'] - 1)} to {percent(s['ratio_high'] - 1)})"


def _adds(r: Result, kind: str) -> dict[str, float]:
    """Stages (with their calls) or fields (with their bytes per particle) that it brings into the plan."""
    return {name[len(kind) + 1 :]: value for name, value in r.summary.items() if name.startswith(f"{kind}_")}


def features(results: Collection) -> str:
    counted = results(runs.instructions())
    rows = []
    for key, (label, idle_label) in runs.FEATURES.items():
        used, idle = results(runs.feature(key)), results(runs.feature(key, "idle")) if idle_label else None
        if not used:
            continue
        fields = _adds(used, "field")
        named = ", ".join(f"{name} {bytes_each:.0f}" for name, bytes_each in fields.items())
        row = [label, ", ".join(_adds(used, "stage")) or NONE, named or NONE, _quartiles(used), idle_label or NONE]
        if idle:
            row += [
                f"{(idle.summary['bytes'] - idle.summary['bytes_minimal']) * idle.summary['particles']:.0f}",
                percent(counted.summary[key], 2) if counted and key in counted.summary else NONE,
                _quartiles(idle),
                "yes" if idle.summary["same_bits"] else "no",
            ]
        else:
            row += [NONE] * 4
        rows.append(row)
    header = ["feature", "stages added", "fields added (bytes per particle)", "CPU time: median (quartiles)", "idle", "bytes more",
              "instructions", "CPU time", "the same bits"]  # fmt: skip
    return table(header, rows) if rows else ""


def unused(results: Collection) -> str:
    """The smallest scene against what it leaves out."""
    found = [r for r in (results(runs.feature(key)) for key in runs.FEATURES) if r]
    if not found:
        return ""
    held = max(r.summary["unused_bytes"] for r in found)
    calls = max(r.summary["unused_calls"] for r in found)
    text = (
        f"Of the stages and fields that it leaves out the smallest scene holds {held:g} bytes and has made {calls:g} calls "
        f"({len(found)} features)."
    )
    counted = results(runs.instructions())
    if counted:
        largest = max(
            ((abs(counted.summary[key]), key) for key in runs.IDLE if key in counted.summary), default=(math.nan, "")
        )
        verdict = "within" if largest[0] <= NOISE else "**beyond**"
        text += (
            f" A feature that is there with nothing to do costs at most {100 * largest[0]:.2f} % of the instructions of the "
            f"step ({runs.FEATURES[largest[1]][0]}), {verdict} {100 * NOISE:g} %."
        )
    noise = results(runs.feature("none"))
    if noise:
        text += f" The noise of the CPU times: the smallest scene against itself {_quartiles(noise)}."
    return text


def _needed(r: Result) -> str:
    names = re.findall(r"^needs (\S+)$", r.output, re.M)
    return ", ".join(name for name in names if not name.startswith(("libc.", "ld-")))


def builds(results: Collection) -> str:
    rows = []
    for label in runs.BUILDS:
        r = results(runs.build(label))
        if r:
            s = r.summary
            times = [fixed(s["start_cpu"], 1), fixed(s["start_wall"], 1), fixed(s["build_cpu"], 0)]
            rows.append([label, f"{s['size_stripped'] / 1024:.0f} KiB", _needed(r), f"{s['loaded']:.0f}", *times])
    header = [
        "build",
        "stripped",
        "needs, beside libc",
        "libraries loaded",
        "start (CPU ms)",
        "start (ms)",
        "CPU s to build",
    ]
    return table(header, rows) if rows else ""


def start(results: Collection) -> str:
    r = results(runs.build("default"))
    return "" if not r else f"An empty program takes {r.summary['start_empty']:.1f} ms; the CPU ms are those beyond it."


# --------------------------------------------------------------------------------------------------- growth


def growth(results: Collection) -> str:
    rows = []
    for label, runs_of, sizes in (("at rest", runs.growth, runs.GROWTH), ("in flow", runs.flow, runs.FLOW)):
        for n in sizes:
            r = results(runs_of(n))
            if r:
                s = r.summary
                lists = share(s.get("stage_update_neighbors", 0.0) / s["wall"], 0)
                times = [fixed(s["cpu"], 0), fixed(s["cpu_least"], 0), lists, seconds(s["cpu"] * s["particles"] * 1e-9)]
                peak = [f"{s['peak_memory'] / 2**20:.0f} MiB", fixed(s["peak_memory"] / s["particles"], 0)]
                rows.append([label, f"{s['particles']:.0f}", *times, fixed(s["bytes"], 0), *peak])
    header = [
        "",
        "particles",
        f"CPU ns per particle and step, median of {runs.REPEAT}",
        "least",
        "of it lists",
        "CPU s per step",
        "bytes per particle, library",
        "peak of the program",
        "per particle",
    ]
    return table(header, rows) if rows else ""


def linear(results: Collection) -> str:
    """The power of the particles that the time of a step goes with, and the largest scene."""
    found = [r for r in (results(runs.growth(n)) for n in runs.GROWTH) if r and r.summary["particles"] > 5e3]
    if len(found) < 2:
        return ""
    size = np.array([r.summary["particles"] for r in found])
    step = np.array([r.summary["cpu"] for r in found]) * size
    power = np.polyfit(np.log(size), np.log(step), 1)[0]
    largest = found[-1].summary
    per_particle = largest["peak_memory"] / largest["particles"]
    text = (
        f"From {size[0]:.0f} to {size[-1]:.0f} particles the CPU time of a step goes with the power {power:.2f} of their "
        f"number. At the largest size the program held {largest['peak_memory'] / 2**30:.2f} GiB at its peak, {per_particle:.0f} "
        f"bytes per particle, of which the library's plan accounts for {largest['bytes']:.0f}. At that rate 20 GiB hold "
        f"{MEMORY / per_particle / 1e6:.0f} million particles (extrapolated; the largest that was run has "
        f"{largest['particles'] / 1e6:.2f} million)"
    )
    flows = [r for r in (results(runs.flow(n)) for n in runs.FLOW) if r]
    if flows:
        # Of the largest: in small scenes most of the bytes are of no particle.
        in_flow = flows[-1].summary["bytes"] - largest["bytes"] + per_particle
        text += (
            f"; in flow, where lists are longer, {in_flow:.0f} bytes per particle, {MEMORY / in_flow / 1e6:.0f} million (by the lists "
            f"of {flows[-1].summary['particles']:.0f} particles)"
        )
    return text + "."


def memory(results: Collection) -> str:
    rows = []
    for key, resolution, label in (
        ("default", 32, "default scheme"),
        ("all", 32, "all that one scene can have"),
        ("all", 126, "the same"),
    ):
        r = results(runs.feature(key, resolution=resolution))
        if r:
            s = r.summary
            rows.append([label, f"{s['particles']:.0f}", fixed(s["bytes_minimal"], 0), fixed(s["bytes"], 0)])
    return table(["scene", "particles", "bytes per particle: smallest scene", "this one"], rows) if rows else ""


def threads(results: Collection) -> str:
    rows = []
    for n in runs.THREADS:
        r = results(runs.threads(n))
        if r:
            s = r.summary
            rows.append([f"{s['particles']:.0f}", fixed(s["wall_one"], 0), fixed(s["wall_several"], 0), fixed(s["speed_up"], 2), fixed(s["best_speed_up"], 2), fixed(s["side_by_side"], 2),
                         f"{100 * s['more_cpu']:+.0f} %", significant(s["load"], 2)])  # fmt: skip
    header = [
        "particles",
        "one thread (ns per particle and step)",
        "two",
        "speed-up",
        "the best of nine",
        "two programs side by side",
        "CPU time",
        "load of the machine",
    ]
    return table(header, rows) if rows else ""


def in_short(results: Collection) -> list[str]:
    return [line for line in (unused(results), linear(results)) if line] + _threads(results)


def _threads(results: Collection) -> list[str]:
    found = [r for r in (results(runs.threads(n)) for n in runs.THREADS) if r]
    if not found:
        return []
    cells = ", ".join(
        f"{r.summary['speed_up']:.2f} ({r.summary['particles']:.0f} particles; two programs side by side: "
        f"{r.summary['side_by_side']:.2f})"
        for r in found
    )
    load = max(r.summary["load"] for r in found)  # before each; runs of two programs leave 2
    said = (
        ""
        if load < 3
        else f", on a machine with a load of up to {load:.0f}, which makes them worthless: to be measured on one at rest"
    )
    return [f"Speed-up on two threads: {cells}{said}."]
