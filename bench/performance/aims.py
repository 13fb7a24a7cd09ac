#!/usr/bin/env python3
"""The table "aim: spacing, settings, seconds", in all places that have it, from one file: bench/performance/aims.json.

    /usr/bin/python3 bench/performance/aims.py            # writes it into the guide, docs/settings.md and granperi.settings
    /usr/bin/python3 bench/performance/aims.py --check    # 1 if one of them says something else
    PYTHONPATH=build/python /usr/bin/python3 bench/performance/aims.py --measure    # some 60 CPU s: the errors and CPU times anew

Between two marks, <!-- aims --> and <!-- /aims -->, in Python # aims and # /aims, a page is not written by hand.
"""
from __future__ import annotations

import argparse
import json
import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
DATA = HERE / "aims.json"
# Of each scene the spacings over its width that make those of the level over its smaller side, and the number of runs. One side: those
# that divide both sides (21 in place of 20 rounds the height by 2 %, and its run-out errs by 5.9 %).
RESOLUTIONS = {"draft": {"a125": (16, 24), "a5": (10, 4), "one": (20, 4)},
               "standard": {"a125": (24, 16), "a5": (15, 4), "one": (20, 4)},
               "fine": {"a125": (40, 12), "a5": (25, 4), "one": (30, 4)}}

Levels = dict[str, dict[str, Any]]


def percent(share: float, digits: int = 1) -> str:
    return f"{100 * share:.{digits}f} %"


def markdown(levels: Levels) -> str:
    lines = ["| aim | spacing | horizon | `sleep` | peak | run-out | CPU s |", "|---|---|---:|---:|---:|---:|---:|"]
    lines += [f"| {name}: below {percent(of['aim'], 0)} | smaller side / {of['spacings']} | {of['horizon']} | {of['sleep']} | "
              f"{percent(of['peak_error'])} ({percent(of['peak_error_a125'])}) | "
              f"{percent(of['runout_error'])} ({percent(of['runout_error_a125'])}) | {of['cpu_seconds']:.2f} |"
              for name, of in levels.items()]
    return "\n".join(lines)


def python(levels: Levels) -> str:
    lines = ["_LEVELS = {"]
    lines += [f'    "{name}": _Level({of["spacings"]}, {of["horizon"]:.1f}, {of["sleep"]}, {of["aim"]:.2f}, {of["peak_error"]:.3f}, '
              f'{of["runout_error"]:.3f}, {of["cpu_seconds"]:.2f}),' for name, of in levels.items()]
    return "\n".join([*lines, "}"])


PLACES = {"docs/settings.md": ("<!-- aims -->", "<!-- /aims -->", markdown),
          "docs/guide/resolution.md": ("<!-- aims -->", "<!-- /aims -->", markdown),
          "bindings/python/granperi/_settings.py": ("# aims: written by bench/performance/aims.py", "# /aims", python)}


def replaced(text: str, begin: str, end: str, content: str) -> str:
    found = re.findall(re.escape(begin) + r"\n.*?\n" + re.escape(end), text, flags=re.S)
    if len(found) != 1:
        raise ValueError(f"{len(found)} places between {begin} and {end}")
    return text.replace(found[0], f"{begin}\n{content}\n{end}")


def measure(levels: Levels) -> None:
    import numpy as np

    import settings

    for name, of in levels.items():
        worst: dict[str, float] = {"peak": 0.0, "runout": 0.0}
        for label, (resolution, runs) in RESOLUTIONS[name].items():
            scene = settings.SCENES[label]
            done = [settings.run(scene, resolution, seed, horizon=of["horizon"], sleep=of["sleep"]) for seed in range(1, runs + 1)]
            for what, reference in zip(worst, scene.reference):
                one = settings.errors([getattr(run, what) for run in done], reference)[2]
                worst[what] = max(worst[what], one)
                if label == "a125":
                    of[f"{what}_error_a125"] = round(one, 3)
            if label == "a125":
                of["cpu_seconds"] = round(float(np.median([run.cpu for run in done])), 2)
            print(f"{name} {label}: done", flush=True)
        of["peak_error"], of["runout_error"] = round(worst["peak"], 3), round(worst["runout"], 3)
        print(f"{name}: {of}", flush=True)
        if max(of["peak_error_a125"], of["runout_error_a125"]) > of["aim"]:
            print(f"{name} misses its aim", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="writes nothing; 1 if a place differs")
    parser.add_argument("--measure", action="store_true", help="runs the three columns first and writes the data")
    options = parser.parse_args()
    data = json.loads(DATA.read_text())
    if options.measure:
        measure(data["levels"])
        DATA.write_text(json.dumps(data, indent=1) + "\n")
    differs = 0
    for place, (begin, end, write) in PLACES.items():
        path = ROOT / place
        text = path.read_text()
        new = replaced(text, begin, end, write(data["levels"]))
        if new != text:
            differs = 1
            print(f"{place}: {'differs' if options.check else 'written'}")
            if not options.check:
                path.write_text(new)
    return differs if options.check else 0


if __name__ == "__main__":
    sys.exit(main())
