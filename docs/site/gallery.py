#!/usr/bin/env python3
"""Runs the programs of docs/gallery and writes the page of the guide about them: scripts/gallery.

usage: gallery.py [--check] [NAME...]

--check runs nothing and exits with 1 where docs/guide/gallery.md is not what programs and pictures say.
"""
import argparse
import ast
import json
import os
import resource
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
ORDER = ["collapse", "gate", "colliding", "hopper", "drum", "obstacle", "blade", "hillside"]
PROGRAMS = os.path.join(ROOT, "docs", "gallery")
PICTURES = os.path.join(ROOT, "docs", "images", "gallery")
PAGE = os.path.join(ROOT, "docs", "guide", "gallery.md")
TIMES = os.path.join(PICTURES, "times.json")
COLOURS = 96  # of a picture: a third of the size, and nothing that is seen
HEAD = """# Gallery

Scenes to begin with: each program is all of it, and the picture is what it leaves. The seconds are CPU time of one thread, imports
and the picture included. `scripts/gallery` makes the pictures and this page; the programs are in docs/gallery.
"""
# Simulations tell what they held when they are closed.
WATCHED = """
import atexit, runpy, sys
import matplotlib
matplotlib.use("Agg")
matplotlib.rcParams["savefig.dpi"] = 75
import granperi
close, counts = granperi.Simulation.close, []
granperi.Simulation.close = lambda sim: (sim.closed or counts.append(sim.n_particles), close(sim))[1]
runpy.run_path(sys.argv[1], run_name="__main__")
print(max(counts))
"""


def run(name):
    """Runs a program in the root, with its picture in PICTURES; (particles, CPU seconds)."""
    program = os.path.join(PROGRAMS, name + ".py")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as work:
        os.symlink(os.path.join(ROOT, "examples"), os.path.join(work, "examples"))
        said = subprocess.run([sys.executable, "-c", WATCHED, program], cwd=work, check=True, stdout=subprocess.PIPE, text=True,
                              env=dict(os.environ, PYTHONPATH=os.path.abspath(os.environ.get("PYTHONPATH", ".")))).stdout
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        shrink(os.path.join(work, name + ".png"), os.path.join(PICTURES, name + ".png"))
    return int(said.split()[-1]), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def shrink(source, target):
    from PIL import Image
    with Image.open(source) as picture:
        picture.convert("RGB").quantize(COLOURS).save(target, optimize=True)


def page_of(times):
    lines = [HEAD]
    for name in ORDER:
        with open(os.path.join(PROGRAMS, name + ".py"), encoding="utf-8") as source:
            text = source.read()
        title, _, words = ast.get_docstring(ast.parse(text)).partition("\n\n")
        code = text.split('"""\n', 1)[1].lstrip("\n")
        particles, seconds = times[name]
        lines += ["## " + title, "", " ".join(words.split()), "",
                  "![%s](../images/gallery/%s.png)" % (title, name), "",
                  "*%d particles, %.2g CPU s.*" % (particles, seconds), "",
                  "<!-- block: skip scripts/gallery runs it -->", "```python", code.rstrip("\n"), "```", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    unknown = set(arguments.names) - set(ORDER)
    there = {name[:-3] for name in os.listdir(PROGRAMS) if name.endswith(".py")}
    if unknown or there != set(ORDER):
        sys.exit("docs/site/gallery.py: ORDER is not what docs/gallery has, or there is no %s" % ", ".join(sorted(unknown)))
    times = {}
    if os.path.exists(TIMES):
        with open(TIMES, encoding="utf-8") as source:
            times = json.load(source)
    if arguments.check:
        with open(PAGE, encoding="utf-8") as source:
            if source.read() != page_of(times):
                sys.exit("docs/guide/gallery.md is not what docs/gallery says: run scripts/gallery")
        return
    os.makedirs(PICTURES, exist_ok=True)
    for name in arguments.names or ORDER:
        times[name] = run(name)
        print("%-12s %6d particles %6.2f CPU s" % (name, *times[name]), flush=True)
    with open(TIMES, "w", encoding="utf-8") as target:
        json.dump({name: times[name] for name in ORDER}, target, indent=1)
        target.write("\n")
    with open(PAGE, "w", encoding="utf-8") as target:
        target.write(page_of(times))


if __name__ == "__main__":
    main()
