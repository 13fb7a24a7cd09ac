#!/usr/bin/env python3
"""No circle of imports in the Python package and in bench, nor of includes among bench's C files: read them and follow. Imports within
functions and for the type checker count.

usage: import_circles.py ROOT
"""
import ast
import pathlib
import re
import sys


def imported(path, names):
    """Those of names (modules beside this one, or in the folders that bench puts on its path) that the file imports."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = (node.module or "").removeprefix("granperi.")
            found.update([module] if module and module != "granperi" else [alias.name for alias in node.names])
    return {name.split(".")[0] for name in found} & names


def python_modules(folders):
    files = {path.stem: path for folder in folders for path in sorted(folder.glob("*.py")) if path.stem != "__init__"}
    return {name: imported(path, set(files)) - {name} for name, path in files.items()}


def c_modules(folder):
    """A header and the source of its name are one."""
    files = [*sorted(folder.glob("*.h")), *sorted(folder.glob("*.c"))]
    names = {path.stem for path in files}
    found = {name: set() for name in names}
    for path in files:
        found[path.stem] |= set(re.findall(r'^#include "(\w+)\.h"', path.read_text(encoding="utf-8"), re.M)) & names - {path.stem}
    return found


def circle_in(graph):
    """The names along one, or nothing."""
    done, way = set(), []

    def follow(name):
        if name in way:
            return [*way[way.index(name):], name]
        if name not in done:
            way.append(name)
            for other in sorted(graph[name]):
                if found := follow(other):
                    return found
            done.add(way.pop())
        return []

    for name in sorted(graph):
        if found := follow(name):
            return found
    return []


def main(root):
    assert circle_in({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": set()}) == ["a", "b", "c", "a"] and not circle_in({"a": {"b"}, "b": set()})
    bench = root / "bench"
    graphs = {"bindings/python/granperi": python_modules([root / "bindings" / "python" / "granperi"]), "bench, C": c_modules(bench)}
    for report in ("validation", "stability", "performance", "report"):
        # bench/performance takes references from bench/validation, whose other modules it does not see.
        graphs["bench/" + report] = python_modules([bench / "common", bench / report])
    circles = {place: circle for place, graph in graphs.items() if (circle := circle_in(graph))}
    for place, circle in circles.items():
        print(f"{place}: {' -> '.join(circle)}")
    print(sum(map(len, graphs.values())), "modules,", len(circles), "circles")
    return 1 if circles else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
