#!/usr/bin/env python3
"""The table "aim: spacing, settings, seconds", in all places that have it, from one file: bench/performance/aims.json.

    /usr/bin/python3 bench/performance/aims.py            # writes it into the guide, docs/settings.md and granperi.settings
    /usr/bin/python3 bench/performance/aims.py --check    # 1 if one of them says something else
    PYTHONPATH=build/python /usr/bin/python3 bench/performance/aims.py --measure    # some 5 CPU minutes: errors and CPU times anew
    /usr/bin/python3 bench/performance/aims.py --figure   # docs/images/performance_collapse.png

In aims.json "rows" are the runs (aims_rows.py), "levels" the settings and what the rows say of them ("cpu_seconds_awake": with
sleep = 0), "mpm" the column with a = 1.25 by an
explicit MPM code with the same law, [L/dl, CPU s, peak y/L, run-out of 90 % of the mass], single runs: not measured here.

Between two marks such as <!-- aims --> and <!-- /aims -->, in Python # aims and # /aims, a page is not written by hand.
"""
from __future__ import annotations

import argparse
import datetime
import json
import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "common"))

import aims_rows  # noqa: E402
from converged import converged  # noqa: E402
from headlines import headline  # noqa: E402

ROOT = HERE.parents[1]
DATA = HERE / "aims.json"
Levels = dict[str, dict[str, Any]]


def percent(share: float, digits: int = 1) -> str:
    return f"{100 * share:.{digits}f} %"


def markdown(levels: Levels) -> str:
    lines = ["| aim | spacing | horizon | `sleep` | peak | run-out | CPU s | with `sleep` 0 |", "|---|---|---:|---:|---:|---:|---:|---:|"]
    lines += [f"| {name}: below {percent(of['aim'], 0)} | smaller side / {of['spacings']} | {of['horizon']} | {of['sleep']} | "
              f"{percent(of['peak_error'])} ({percent(of['peak_error_a125'])}) | "
              f"{percent(of['runout_error'])} ({percent(of['runout_error_a125'])}) | {of['cpu_seconds']:.2f} | {of['cpu_seconds_awake']:.2f} |"
              for name, of in levels.items()]
    return "\n".join(lines)


def marked(levels: Levels) -> str:
    """For the page that the others take these numbers from."""
    text = markdown(levels)
    for name in ("standard", "fine"):
        seconds = f"{levels[name]['cpu_seconds']:.2f}"
        told = headline(f"settings.{name}.cpu", seconds)
        text = re.sub(rf"(?<=\| )({name}:.*\| ){re.escape(seconds)}(?= \|)", rf"\g<1>{told}", text)
    return text


def python(levels: Levels) -> str:
    lines = ["_LEVELS = {"]
    lines += [f'    "{name}": _Level({of["spacings"]}, {of["horizon"]:.1f}, {of["sleep"]}, {of["aim"]:.2f}, {of["peak_error"]:.4f}, '
              f'{of["runout_error"]:.4f}, {of["cpu_seconds"]:.2f}),' for name, of in levels.items()]
    return "\n".join([*lines, "}"])


PLACES = [("docs/settings.md", "<!-- aims -->", "<!-- /aims -->", lambda data: marked(data["levels"])),
          ("docs/settings.md", "<!-- rows -->", "<!-- /rows -->", lambda data: aims_rows.table(data["levels"], data["rows"])),
          ("docs/settings.md", "<!-- runs -->", "<!-- /runs -->", lambda data: aims_rows.single_runs(data["levels"], data["rows"])),
          ("docs/settings.md", "<!-- made -->", "<!-- /made -->", lambda data: made(data["made"], data["rows"])),
          ("docs/guide/resolution.md", "<!-- aims -->", "<!-- /aims -->", lambda data: markdown(data["levels"])),
          ("bindings/python/granperi/_settings.py", "# aims: written by bench/performance/aims.py", "# /aims",
           lambda data: python(data["levels"]))]


def made(of: dict[str, str], rows: list[aims_rows.Row]) -> str:
    runs = sum(row["runs"] for row in rows)
    return f"{runs} runs, commit {of['commit']}, {of['machine']}, nothing else running, {of['date']}."


def replaced(text: str, begin: str, end: str, content: str) -> str:
    found = re.findall(re.escape(begin) + r"\n.*?" + re.escape(end), text, flags=re.S)
    if len(found) != 1:
        raise ValueError(f"{len(found)} places between {begin} and {end}")
    return text.replace(found[0], f"{begin}\n{content}\n{end}")


def best_of(curves: dict[str, list[tuple[int, float, float]]]) -> list[tuple[int, float, float]]:
    """Of all points those that no other one beats in cost and error, of two that cost the same within 8 % the better one: L/dl, CPU s,
    error."""
    found: list[tuple[int, float, float]] = []
    for n, cpu, error in sorted((tuple(point) for points in curves.values() for point in points), key=lambda point: point[1:]):
        if found and error < found[-1][2] and cpu < 1.08 * found[-1][1]:
            found.pop()
        if not found or error < found[-1][2]:
            found.append((n, cpu, error))
    return found


def figure(data: dict[str, Any], path: Path) -> None:
    """Error of one run, peak or run-out whichever is larger, against CPU time: ours, the MPM's, and the recommended settings, these
    without sleep, too."""
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FuncFormatter, NullLocator
    from peers import SAME, second_machine
    from plotting import finish, legend_above

    fig, axes = plt.subplots(figsize=(9.2, 6.2), layout="constrained")
    best, ours, theirs, star = best_of(aims_rows.curves(data["rows"])), "#0072B2", "0.35", "#D55E00"
    axes.plot([cpu for _, cpu, _ in best], [100 * error for *_, error in best], color=ours, marker="o", ms=7, lw=3,
              label="granperi, sleep = 1, best of horizons 2.5 to 4")
    peak, runout = converged("a125")
    for name, style in ((SAME, "-"), ("tuned", "--")):
        points = data["mpm"][name]
        errors = [100 * max(abs(r / runout - 1), abs(p / peak - 1) if p is not None else 0) for _, _, p, r in points]
        alone = "" if all(p is not None for _, _, p, _ in points) else " (run-out alone)"
        axes.plot([cpu for _, cpu, _, _ in points], errors, color=theirs, marker="^", ms=8, ls=style,
                  label=f"MPM ({data['mpm']['code'].split()[0]}), same law, {name}{alone}")
        for (n, cpu, _, _), error in zip(points, errors):
            axes.annotate(f"L/{n}", (cpu, error), textcoords="offset points", color=theirs, fontsize=13, xytext=(5, 8))
        if name == SAME:  # as long as it takes on the slower of two machines
            slower = [second_machine().get(n, cpu) for n, cpu, *_ in points]
            axes.fill_betweenx(errors, [cpu for _, cpu, *_ in points], slower, color="0.88", zorder=0,
                               label="the same on a slower machine")
    for name, of in data["levels"].items():
        error = 100 * max(of["peak_error_a125"], of["runout_error_a125"])
        axes.plot([of["cpu_seconds"], of["cpu_seconds_awake"]], [error, error], ":", color=star, lw=1.5, zorder=3)
        axes.plot(of["cpu_seconds_awake"], error, "*", color="white", ms=18, mec=star, mew=1.6, zorder=4)
        axes.plot(of["cpu_seconds"], error, "*", color=star, ms=24, mec="white", zorder=4)
        axes.annotate(f"{name}\n{of['cpu_seconds']:.2g} s, {error:.1f} %", (of["cpu_seconds"], error), textcoords="offset points",
                      xytext=(-14, -34), ha="right", color="#B04A00", weight="bold")
    axes.set(xscale="log", yscale="log", xlabel="CPU seconds of one run to 1 s", ylabel="error of one run, %", xlim=(0.012, 120),
             ylim=(0.5, 14))
    for axis, ticks in ((axes.xaxis, (0.03, 0.1, 0.3, 1, 3, 10, 30, 100)), (axes.yaxis, (0.5, 1, 2, 5, 10))):
        axis.set_ticks(ticks)
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_locator(NullLocator())
    axes.grid(color="0.92")
    axes.set_axisbelow(True)
    axes.plot([], [], "*", color=star, ms=18, ls="none", label="recommended settings")
    axes.plot([], [], "*", color="white", ms=15, mec=star, mew=1.6, ls="none", label="the same without sleep")
    legend_above(fig, axes, 2)
    finish(fig, path)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="writes nothing; 1 if a place differs")
    parser.add_argument("--measure", action="store_true", help="runs the three columns first and writes the data")
    parser.add_argument("--figure", action="store_true", help="draws docs/images/performance_collapse.png, too (matplotlib)")
    options = parser.parse_args()
    data = json.loads(DATA.read_text())
    if options.measure:
        from batch import commit_of
        from computer import processor

        data["rows"] = aims_rows.measure(data["levels"])
        data["made"] = {"commit": commit_of(ROOT), "machine": processor(), "date": datetime.date.today().isoformat()}
        aims_rows.summed_up(data["levels"], data["rows"])
        for name, of in data["levels"].items():
            if max(of["peak_error_a125"], of["runout_error_a125"]) > of["aim"]:
                print(f"{name} misses its aim", flush=True)
        DATA.write_text(re.sub(r"\[\s+([^][{}]*?)\s+\]", lambda found: "[" + re.sub(r"\s+", " ", found[1]) + "]",
                               json.dumps(data, indent=1)) + "\n")  # one point in a line
    if options.figure:
        figure(data, ROOT / "docs" / "images" / "performance_collapse.png")
    differs = 0
    for place, begin, end, write in PLACES:
        path = ROOT / place
        text = path.read_text()
        new = replaced(text, begin, end, write(data))
        if new != text:
            differs = 1
            print(f"{place}: {'differs' if options.check else 'written'}")
            if not options.check:
                path.write_text(new)
    return differs if options.check else 0


if __name__ == "__main__":
    sys.exit(main())
