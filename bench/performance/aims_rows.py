"""The runs behind the aims: which collapses at which spacings and horizons, what came out, and their tables in docs/settings.md.

A row of bench/performance/aims.json: scene, horizon, spacings over its width, runs; CPU s to 1 s and to rest, of the median run
("cpu_awake": to 1 s with sleep = 0); "peak" and "runout": bias, its two standard errors, the error of one run, the largest one. Of the
errors, relative, all but the first are above 0.
"""
from __future__ import annotations

from typing import Any

from converged import converged
from headlines import headline

Row = dict[str, Any]

# (scene, horizon): spacings over the width, and runs. More runs where a row stands for an aim. One side: spacings that divide
# both sides (21 in place of 20 rounds the height by 2 %, and its run-out errs by 5.9 %).
RUNS = {("a125", 4): {16: 24, 24: 16, 32: 8, 40: 8, 48: 6}, ("a125", 3): {16: 8, 24: 8, 32: 8, 40: 12, 48: 8, 64: 4},
        ("a125", 3.5): {24: 8, 32: 8, 40: 12, 48: 8}, ("a125", 2.5): {16: 8, 24: 8, 32: 8}, ("a5", 4): {10: 6, 15: 6, 20: 4}, ("a5", 3): {10: 6, 15: 6, 20: 4, 25: 6, 30: 4},
        ("a5", 3.5): {20: 4, 25: 6, 30: 4},
        ("one", 4): {20: 4, 30: 4, 40: 4}, ("one", 3): {20: 4, 30: 4, 40: 4}, ("one", 3.5): {20: 4, 30: 4, 40: 4}}
# Of each aim the row of each scene.
CHOSEN = {"draft": {"a125": 16, "a5": 10, "one": 20}, "standard": {"a125": 24, "a5": 15, "one": 20},
          "fine": {"a125": 40, "a5": 25, "one": 30}}
NAMES = {"a125": "a = 1.25", "a5": "a = 5", "one": "one side"}
SIDE = {"a125": 5 / 8, "a5": 1.0, "one": 0.7}  # the smaller side over the width
WHAT = ("peak", "runout")
# What other pages repeat of the rows of a = 1.25: (horizon, spacings): name, and which cells have one.
REPEATED = {(4, 16): ("width_16", ("cpu", "peak")), (4, 24): ("width_24", ("cpu", "peak", "one")),
            (4, 32): ("width_32", ("cpu", "peak", "one", "run_out")), (4, 40): ("width_40", ("cpu", "peak")),
            (3, 32): ("horizon_3", ("peak", "run_out"))}
TOLD = ("standard", "fine")  # aims whose single runs other pages repeat


def taken(levels: dict[str, dict[str, Any]]) -> set[tuple[str, float, int]]:
    """Scene, horizon and spacings of the rows that stand for an aim."""
    return {(scene, levels[name]["horizon"], n) for name, of in CHOSEN.items() for scene, n in of.items()}


def measure(levels: dict[str, dict[str, Any]]) -> list[Row]:
    import numpy as np

    import settings

    rows = []
    for (name, horizon), resolutions in RUNS.items():
        scene = settings.SCENES[name]
        for n, runs in resolutions.items():
            done = [settings.run(scene, n, seed, horizon=horizon, sleep=1) for seed in range(1, runs + 1)]
            row: Row = {"scene": name, "horizon": horizon, "spacings": n, "runs": runs}
            for key in ("cpu", "cpu_to_rest"):
                row[key] = round(float(np.median([getattr(run, key) for run in done])), 2)
            if name == "a125" and (name, horizon, n) in taken(levels):
                awake = [settings.run(scene, n, seed, horizon=horizon, sleep=0) for seed in range(1, runs + 1)]
                row["cpu_awake"] = round(float(np.median([run.cpu for run in awake])), 2)
            for what, reference in zip(WHAT, converged(name), strict=True):
                values = [getattr(run, what) for run in done]
                row[what] = [round(float(error), 4) for error in (*settings.errors(values, reference),
                                                                  max(abs(value / reference - 1) for value in values))]
                row[f"{what}_above"] = {f"{aim:g}": sum(1 for value in values if abs(value / reference - 1) > aim)
                                        for aim in (0.02, 0.05, 0.1)}
            rows.append(row)
            print(row, flush=True)
    return rows


def chosen(rows: list[Row], level: dict[str, Any], name: str, scene: str) -> Row:
    return next(row for row in rows if (row["scene"], row["spacings"], row["horizon"])
                == (scene, CHOSEN[name][scene], level["horizon"]))


def summed_up(levels: dict[str, dict[str, Any]], rows: list[Row]) -> None:
    """Writes into each level what its rows say."""
    for name, level in levels.items():
        of = {scene: chosen(rows, level, name, scene) for scene in NAMES}
        level["cpu_seconds"], level["cpu_seconds_awake"] = of["a125"]["cpu"], of["a125"]["cpu_awake"]
        for what in WHAT:
            level[f"{what}_error"] = max(row[what][2] for row in of.values())
            level[f"{what}_error_a125"] = of["a125"][what][2]


def curves(rows: list[Row]) -> dict[str, list[tuple[int, float, float]]]:
    """Of a = 1.25, by horizon: spacings, CPU s, and the error of one run in peak or run-out, whichever is larger."""
    found: dict[str, list[tuple[int, float, float]]] = {}
    for row in rows:
        if row["scene"] == "a125":
            found.setdefault(f"horizon {row['horizon']}", []).append(
                (row["spacings"], row["cpu"], max(row[what][2] for what in WHAT)))
    return found


def _percent(share: float) -> str:
    return f"{100 * share:.1f} %"


def _bias(row: Row, what: str, name: str = "") -> str:
    bias = f"{100 * row[what][0]:+.1f}"
    return f"{headline(name, bias) if name else bias} ± {_percent(row[what][1])}"


def table(levels: dict[str, dict[str, Any]], rows: list[Row]) -> str:
    """All rows; \\*: that of an aim."""
    stars = taken(levels)
    lines = ["| column | horizon | L/dl | over the smaller side | runs | CPU s to 1 s | to rest | peak | one run | run-out | one run |",
             "|---|" + "---:|" * 10]
    for row in sorted(rows, key=lambda row: (list(NAMES).index(row["scene"]), -row["horizon"], row["spacings"])):
        n, horizon = row["spacings"], row["horizon"]
        name, cells = REPEATED.get((horizon, n), ("", ())) if row["scene"] == "a125" else ("", ())
        names = {cell: f"settings.{name}.{cell}" for cell in cells}

        def told(cell: str, text: str) -> str:
            return headline(names[cell], text) if cell in names else text

        star = " \\*" if (row["scene"], horizon, n) in stars else ""
        cells = [NAMES[row["scene"]], f"{horizon}{star}", str(n), f"{n * SIDE[row['scene']]:.0f}", str(row["runs"]),
                 told("cpu", f"{row['cpu']:.2f}"), f"{row['cpu_to_rest']:.2f}", _bias(row, "peak", names.get("peak", "")),
                 told("one", _percent(row["peak"][2])), _bias(row, "runout", names.get("run_out", "")), _percent(row["runout"][2])]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def single_runs(levels: dict[str, dict[str, Any]], rows: list[Row]) -> str:
    """Of the three rows of a = 1.25 that stand for an aim: how many runs err by more than it, and the worst."""
    lines = ["| aim | horizon | L/dl | runs | peak, one run | the worst | beyond the aim | run-out, one run | the worst | beyond the aim |",
             "|---|" + "---:|" * 9]
    for name, level in levels.items():
        row = chosen(rows, level, name, "a125")

        def told(what: str, text: str) -> str:
            return headline(f"settings.{name}.{what}", text) if name in TOLD else text

        cells = [told("runs", str(row["runs"]))]
        for what in WHAT:
            cells += [told(what, _percent(row[what][2])), _percent(row[what][3]),
                      told(f"{what}_beyond", str(row[f"{what}_above"][f"{level['aim']:g}"]))]
        lines.append(f"| {name}: {100 * level['aim']:.0f} % | {level['horizon']} | {row['spacings']} | " + " | ".join(cells) + " |")
    return "\n".join(lines)
