"""Writes stubs of the package's keyword objects (.pyi): the modules as they are, with each parameter, its type, default and
meaning where the modules have **values."""

import ast
import os
import re

from python_meanings import fields_of, type_of
from python_words import ENUMS, OBJECTS, Words

PACKAGE = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "python", "granperi")
HEAD = "# Written by bindings/generate from include/granperi/gp.h and %s.py. Do not edit.\n"
KEYWORDS = "Values"  # Config -> ConfigValues: what Simulation and Plate.floor and the like take by keyword
WIDTH = 110


def write_objects(header):
    return write_stub(header, "_objects")


def write_plate(header):
    return write_stub(header, "_plate")


def write_stub(header, module):
    with open(os.path.join(PACKAGE, module + ".py"), encoding="utf-8") as source:
        tree = ast.parse(source.read())
    lines = [HEAD % module]
    for node in tree.body:
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            lines.append(ast.unparse(node))
        elif isinstance(node, ast.ClassDef):
            struct = struct_of(node)
            lines += ["", ""] + (keywords(header, struct) + ["", ""] if struct else [])
            lines += class_lines(header, node, struct)
        elif isinstance(node, ast.FunctionDef):
            lines += ["", *function_lines(node, "")]
    imports = "from typing import Any, Iterator, Literal, TypedDict, Unpack"
    text = "\n".join(lines)
    text = re.sub(r"^from typing import .*$", imports, text, count=1, flags=re.M)
    return text + "\n"


def struct_of(node):
    for item in node.body:
        if isinstance(item, ast.Assign) and item.targets[0].id == "_struct":
            return item.value.value
    return None


def positional_of(node):
    """Parameters that may be given without their names."""
    for item in node.body:
        if isinstance(item, ast.FunctionDef) and item.name == "__init__":
            return [argument.arg for argument in item.args.args[1:]]
    return []


def extra_of(node):
    """Keywords that stand for several parameters: (points) of Plate."""
    for item in node.body:
        if isinstance(item, ast.Assign) and getattr(item.targets[0], "id", "") == "_also":
            return [name.value for name in item.value.elts]
    return []


def parameters(header, name):
    """[(name, type that is given, type that is read, default, meaning)]; lengths of tables are no parameters."""
    struct = header.struct(name)
    found = []
    for own, field, doc in fields_of(struct, header):
        if own in ("n_knots", "n_points"):
            continue
        read = type_of(struct, field)
        given = read
        if "%s.%s" % (name, field.name) in ENUMS:
            prefix = ENUMS["%s.%s" % (name, field.name)][1]
            names = ", ".join('"%s"' % constant[len(prefix):].lower() for constant in Words(header).constants
                              if constant.startswith(prefix))
            given = "%s | int | Literal[%s]" % (read, names)
        elif read.startswith("np.ndarray"):
            given = "Any"
        default = re.search(r"\[(-?\d+(?:\.\d+)?(?:e-?\d+)?)\]$", doc)
        found.append((own, given, read, default.group(1) if default and read in ("int", "float") else "...", doc))
    return found


def keywords(header, name):
    lines = ["class %s%s(TypedDict, total=False):" % (OBJECTS[name], KEYWORDS)]
    return lines + ["    %s: %s" % (own, given) for own, given, _, _, _ in parameters(header, name)] + \
        (["    points: Any"] if name == "gp_plate" else [])


def class_lines(header, node, struct):
    bases = ", ".join(ast.unparse(base) for base in node.bases)
    lines = ["class %s%s:" % (node.name, "(%s)" % bases if bases else ""), *docstring(node, "    ")]
    if struct:
        for own, _, read, _, doc in parameters(header, struct):
            lines += ["    %s: %s" % (own, read), '    """%s"""' % doc.replace("\\", "\\\\").replace('"""', "'''")]
        first = positional_of(node)
        signature = {own: "        %s: %s = %s," % (own, given, default) for own, given, _, default, _ in parameters(header, struct)}
        lines += ["", "    def __init__(", "        self,", *(signature.pop(own) for own in first), "        *,", *signature.values()]
        lines += ["        %s: Any = ...," % own for own in extra_of(node)] + ["    ) -> None: ..."]
        lines += ["", "    def replace(self, **values: Unpack[%s]) -> %s: ..." % (node.name + KEYWORDS, node.name)]
    for item in node.body:
        if isinstance(item, ast.FunctionDef) and not (struct and item.name == "__init__") and not hidden(item):
            if struct and item.args.kwarg:  # further parameters of the object
                item.args.kwarg.annotation = ast.parse("Unpack[%s]" % (node.name + KEYWORDS)).body[0].value
            lines += ["", *function_lines(item, "    ")]
    if len(lines) == 1:
        lines.append("    ...")
    return lines


def hidden(item):
    """What would say that every name exists."""
    return item.name in ("__getattr__", "__setattr__", "__init_subclass__")


def docstring(node, indent):
    text = ast.get_docstring(node)
    if not text:
        return []
    lines = text.replace("\\", "\\\\").split("\n")
    if len(lines) == 1:
        return ['%s"""%s"""' % (indent, lines[0])]
    return ['%s"""%s' % (indent, lines[0]), *(indent + line if line else "" for line in lines[1:]), indent + '"""']


def function_lines(node, indent):
    decorators = ["%s@%s" % (indent, ast.unparse(decorator)) for decorator in node.decorator_list]
    head = "%sdef %s(%s)%s:" % (indent, node.name, ast.unparse(node.args), " -> " + ast.unparse(node.returns) if node.returns else "")
    doc = docstring(node, indent + "    ")
    return [*decorators, head, *doc, indent + "    ..."] if doc else [*decorators, head + " ..."]
