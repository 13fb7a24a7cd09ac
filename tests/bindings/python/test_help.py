"""help() and type checkers say of each parameter what gp.h says: unit, meaning, range, default."""
import ast
import importlib.util
import pydoc
import re
import subprocess
import sys
from pathlib import Path

import pytest
from granperi._objects import Column, Config, Material
from granperi._plate import Plate
from granperi._reference import MEANINGS

import granperi

KINDS = [Config, Material, Column, Plate]
PACKAGE = Path(granperi.__file__).parent


def help_of(thing):
    """The text of help() in one line of single blanks."""
    return " ".join(re.sub(r"^ \| ?", " ", pydoc.render_doc(thing, renderer=pydoc.plaintext), flags=re.M).split())


@pytest.mark.parametrize("thing, struct", [*((kind, kind._struct) for kind in KINDS), (granperi.State, "gp_state"),
                                           (granperi.Load, "gp_load"), (granperi.PlanEntry, "gp_plan_entry")])
def test_help_has_each_parameter_with_its_meaning(thing, struct):
    said = help_of(thing)
    for name, (kind, meaning) in MEANINGS[struct].items():
        assert re.search(rf"\b{name}\b[\w, ]*: {re.escape(kind)} ", said), name
        assert meaning and " ".join(meaning.split()) in said, name
        assert "gp_config" not in meaning and "GP_E_" not in meaning, f"{name}: a name that Python has not"


@pytest.mark.parametrize("kind", KINDS)
def test_defaults_that_are_told_are_the_librarys(kind):
    told = 0
    for name, default in kind._defaults().items():
        number = re.search(r"\[(-?[\d.]+(?:e-?\d+)?)\]$", MEANINGS[kind._struct][name][1])
        if number:
            assert default == float(number[1]), name
            told += 1
    assert told >= 1


def stub_of(kind):
    tree = ast.parse((PACKAGE / (kind.__module__.split(".")[-1] + ".pyi")).read_text())
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    return classes[kind.__name__], classes[kind.__name__ + "Values"]


@pytest.mark.parametrize("kind", KINDS)
def test_the_stub_has_each_parameter_with_its_type_and_meaning(kind):
    of_class, of_values = stub_of(kind)
    init = next(item for item in of_class.body if isinstance(item, ast.FunctionDef) and item.name == "__init__")
    given = {argument.arg for argument in [*init.args.args[1:], *init.args.kwonlyargs]}
    assert given == {*kind.names(), *kind._also}
    assert {item.target.id for item in of_values.body} == given
    texts = {of_class.body[k].target.id: of_class.body[k + 1].value.value for k in range(len(of_class.body))
             if isinstance(of_class.body[k], ast.AnnAssign)}
    assert texts == {name: MEANINGS[kind._struct][name][1] for name in kind.names()}


MISTAKES = {
    'granperi.Config("paper", horizont=4)': 'Unexpected keyword argument "horizont" for "Config"; did you mean "horizon"?',
    'granperi.Material(mu_s="steep")': '"mu_s" to "Material" has incompatible type "str"; expected "float"',
    "granperi.Simulation(spacin=0.1)": 'Unexpected keyword argument "spacin" for "Simulation"; did you mean "spacing"?',
    "sim.add_column(widht=0.1)": 'Unexpected keyword argument "widht" for "add_column" of "SimulationScene"',
    'granperi.Plate.floor(0, 1, frction="coulomb")': 'Unexpected keyword argument "frction" for "floor" of "Plate"',
    'granperi.Plate(friction="rough")': '"friction" to "Plate" has incompatible type',
    "granperi.Config().replace(spacin=1.0)": 'Unexpected keyword argument "spacin" for "replace"',
    "granperi.Column().hight": '"Column" has no attribute "hight"',
}
GOOD = ["granperi.Config('paper', spacing=0.01, stress=granperi.Stress.ELASTIC)", "granperi.Plate(points=[[0, 0], [1, 0]])",
        "granperi.Plate.floor(0, 1, friction='coulomb', wall_mu=0.3)", "sim.add_column(width=0.1, height=1)"]


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")
def test_a_type_checker_sees_mistakes(tmp_path):
    program = tmp_path / "program.py"
    program.write_text("\n".join(["import granperi", "sim = granperi.Simulation()", *MISTAKES, *GOOD, ""]))
    said = subprocess.run([sys.executable, "-m", "mypy", "--enable-incomplete-feature=Unpack", "--follow-imports=silent",
                           "--ignore-missing-imports", f"--cache-dir={tmp_path}", str(program)], capture_output=True, text=True,
                          env={"MYPYPATH": str(PACKAGE.parent), "PATH": "/usr/bin:/bin"}).stdout
    errors = {int(line.split(":")[1]): line for line in said.splitlines() if line.startswith(str(program)) and ": error:" in line}
    for line, (mistake, text) in enumerate(MISTAKES.items(), 3):
        assert text in errors.get(line, ""), f"{mistake}\n{said}"
    assert set(errors) <= set(range(3, 3 + len(MISTAKES))), said
