"""The reference of the Python package: a page per topic, per class and per call, from the docstrings."""
import enum
import inspect
import os
import re

import c_reference
import docstrings
import python_calls
import text

PAGES = {
    "running": ("Simulation", ["Simulation", "load", "has_feature"]),
    "scene": ("What a scene is made of", ["Config", "Material", "Column", "Plate", "Scene", "Run"]),
    "reading": ("What is read", ["State", "Clock", "History", "Load", "Plan", "PlanEntry", "Particles", "View", "FieldView", "Probe"]),
    "results": ("Result files, comparison, sweeps", ["Output", "Result", "Snapshot", "Difference", "compare", "Sweep", "sweep"]),
    "error_and_time": ("Error against run time", ["report", "Report", "Row", "Recommendation", "settings", "Settings"]),
    "names": ("Names of choices", ["Density", "Field", "Fluidity", "InitialPressure", "Preset", "StepLimit", "Stress", "Wall"]),
    "errors": ("Exceptions", ["Error", "ArgumentError", "ArgumentTypeError", "DivergedError", "FileError", "InternalError",
                              "OutOfMemoryError", "SceneError", "StateError", "UnsupportedError", "VersionError",
                              "GranperiWarning"]),
}
STRUCTS = {"Config": "gp_config", "Material": "gp_material", "Column": "gp_column", "Plate": "gp_plate", "State": "gp_state",
           "Load": "gp_load", "PlanEntry": "gp_plan_entry"}
CONSTANTS = {"Density": "GP_DENSITY_", "Fluidity": "GP_FLUIDITY_", "InitialPressure": "GP_INITIAL_", "Preset": "GP_PRESET_",
             "StepLimit": "GP_DT_", "Stress": "GP_STRESS_", "Wall": "GP_WALL_"}
MADE_BY_CALLS = {"Output", "Probe", "Report", "Sweep", "View", "FieldView", "Particles", "Row", "Recommendation", "Settings",
                 "Difference", "Snapshot", "State", "Clock", "Load", "Plan", "PlanEntry"}
PICTURES = ["field", "surface", "interface", "energy", "fronts", "compare", "animate"]
ERRORS = ("An error is an exception with the library's text, which names the argument, its value and what was expected. All are "
          ":py:exc:`granperi.Error`, and what Python itself would raise, too: :doc:`errors`. A wrong type or an unknown name is "
          "everywhere an :py:exc:`granperi.ArgumentTypeError`, which is an ArgumentError; a closed simulation, and one that another "
          "thread is using, a :py:exc:`granperi.StateError`.")

EXAMPLES = ("In the examples ``sim`` is a simulation of a small column on a floor, ``collapse.toml`` the scene file of "
            ":doc:`/guide/python`, ``collapse.h5`` its result, ``report`` what :py:func:`granperi.report` has given, and ``np`` is "
            "numpy. A test runs each of them.")


class PackageError(Exception):
    """The package has a name that no page of the reference has, or the other way round."""


def calls_of(kind):
    """[(name, function)] of a class, its own and inherited ones of the package, in the order of the sources."""
    found = {}
    for base in reversed(kind.__mro__):
        if base.__module__.startswith("granperi"):
            found.update({name: thing for name, thing in vars(base).items() if name[0] != "_" and
                          inspect.isroutine(python_calls.plain_function(thing))})
    return list(found.items())


def values_of(kind):
    """[(name, docstring)] of a class's properties."""
    found = {}
    for base in reversed(kind.__mro__):
        if base.__module__.startswith("granperi"):
            found.update({name: thing.__doc__ for name, thing in vars(base).items()
                          if name[0] != "_" and isinstance(thing, property)})
    for name, doc in found.items():
        if not doc:
            raise PackageError("%s.%s has no docstring" % (kind.__name__, name))
    return list(found.items())


def roles_of(granperi):
    known = {}
    for name in granperi.__all__:
        thing = getattr(granperi, name)
        if not isinstance(thing, type):
            continue
        known[name] = "exc" if issubclass(thing, Exception) else "class"
        if not issubclass(thing, (Exception, enum.Enum)):
            known.update({"%s.%s" % (name, call): "meth" for call, _ in calls_of(thing)})
            known.update({"%s.%s" % (name, value): "attr" for value, _ in values_of(thing)})
    return known


def head_of(name, kind):
    """The docstring without the list of parameters, which is a table here."""
    doc = inspect.cleandoc(kind.__doc__)
    if name in STRUCTS:
        doc = re.split(r"\n\n(?=\w+(?:, \w+)*: \w+\n    )", doc)[0].rstrip()
        doc = re.sub(r"\n\n(?:Each[^\n]*|[^\n]*):$", "", doc) if doc.endswith(":") and "\n\n" in doc else doc
    return doc


def papers_of(lines):
    """Where the papers are named that gp.h has by number."""
    return ["[1] to [4] are named in :doc:`/reference/c/index`.", ""] if any(re.search(r"\[\d\]", line) for line in lines) else []


def parameter_table(name, kind):
    from granperi._reference import MEANINGS

    signature = inspect.signature(kind).parameters if name in ("Config", "Material", "Column", "Plate") else {}
    head = ["name", "type", "unit", *(["default"] if signature else []), "what it is, and its range"]
    lines = [".. list-table:: %s" % ("Parameters" if signature else "Values"), "   :header-rows: 1",
             "   :widths: %s" % ("18 12 10 12 48" if signature else "20 12 12 56"), "", "   * - " + "\n     - ".join(head)]
    for field, (type_, meaning) in MEANINGS[STRUCTS[name]].items():
        words = " ".join(meaning.split())
        default, unit = c_reference.DEFAULT.search(words), c_reference.UNIT.match(words)
        words = c_reference.UNIT.sub("", words[:default.start()] if default else words)
        cells = ["``%s``" % field, "``%s``" % type_, unit.group(1) if unit else ""]
        if signature:
            cells.append(text.escape(default.group(1).strip('"')) if default else "")
        lines.append("   * - " + "\n     - ".join([*cells, text.escape(words)]))
    return [*lines, "", *papers_of(lines)]


def class_page(name, kind, known):
    """What it is, its parameters or values, and links to the pages of its calls."""
    directive = "py:class:: %s" % (name if name in MADE_BY_CALLS else python_calls.syntax_of(name, kind.__init__)
                                   if name not in STRUCTS else name + "(**parameters)")
    lines = [*text.titled(name), ".. py:currentmodule:: granperi", "", ".. " + directive, "",
             *text.indented(python_calls.prose(head_of(name, kind), known)), ""]
    if name in STRUCTS:
        lines += [*parameter_table(name, kind), "In C: :c:struct:`%s`." % STRUCTS[name], ""]
    values = values_of(kind)
    if values:
        lines += [*text.titled("Values", "-")]
        for value, doc in values:
            parts = docstrings.parts_of(doc)
            lines += [".. py:attribute:: %s.%s" % (name, value), "", *text.indented(python_calls.prose(parts.doc, known)), ""]
            if parts.example:
                lines += text.indented([".. code-block:: python", "", *text.indented(parts.example.split("\n")), ""])
    calls = calls_of(kind)
    if calls:
        lines += [*text.titled("Calls", "-"), ".. list-table::", "   :widths: 30 70", ""]
        for call, thing in calls:
            doc = docstrings.parts_of(python_calls.plain_function(thing).__doc__).doc
            if not doc:
                raise PackageError("%s.%s has no docstring" % (name, call))
            lines += ["   * - :doc:`%s.%s`" % (name, call),
                      "     - %s" % python_calls.linked(python_calls.first_sentence(doc), known)]
        lines += ["", ".. toctree::", "   :hidden:", "", *text.indented(["%s.%s" % (name, call) for call, _ in calls]), ""]
    return lines


def enumeration_page(name, kind, meanings, known):
    from granperi._enums import FIELD_MEANINGS

    lines = [*text.titled(name), ".. py:currentmodule:: granperi", "", ".. py:class:: " + name, "",
             *text.indented(python_calls.prose(inspect.cleandoc(kind.__doc__), known)), "",
             "Wherever one is asked for, its name in small letters does, too: ``\"%s\"``." % list(kind)[-1].name.lower(), "",
             ".. list-table::", "   :widths: 26 74", "   :header-rows: 1", "", "   * - name", "     - what it means"]
    for member in kind:
        said = FIELD_MEANINGS[member.name.lower()] if name == "Field" else meanings.get(CONSTANTS[name] + member.name, "")
        lines += ["   * - ``%s``" % member.name, "     - %s" % text.escape(" ".join(said.split()))]
    return [*lines, "", *papers_of(lines)]


def exceptions_page(names, granperi):
    lines = [*text.titled(PAGES["errors"][0]), ".. py:currentmodule:: granperi", ""]
    for name in names:
        thing = getattr(granperi, name)
        bases = ", ".join(base.__name__ for base in thing.__bases__)
        lines += [".. py:exception:: " + name, "", *text.indented([text.escape(" ".join(inspect.cleandoc(thing.__doc__).split())), "",
                                                                   "Is a %s." % bases, ""])]
    return lines


def page_name(name, thing):
    """A class has the page of its name, a function granperi.NAME: load and Load stay apart where capitals do not count."""
    return name if isinstance(thing, type) else "granperi." + name


def topic_page(title, names, module, known):
    lines, pages = [*text.titled(title), ".. list-table::", "   :widths: 30 70", ""], []
    for name in names:
        thing = getattr(module, name)
        pages.append(page_name(name if module.__name__ == "granperi" else "plot." + name, thing))
        doc = docstrings.parts_of(python_calls.plain_function(thing).__doc__).doc
        lines += ["   * - :doc:`%s`" % pages[-1], "     - " + python_calls.linked(python_calls.first_sentence(doc), known)]
    return [*lines, "", ".. toctree::", "   :hidden:", "", *text.indented(pages), ""]


def constants_of(header):
    return {name: doc for declaration in header.of(c_reference.Constants) for name, _, doc in declaration.values}


def write_python_reference(directory, header, of_fortran):
    """header: what gp.h declares; of_fortran: {C function: name of its page}. Returns the public names."""
    import granperi
    import granperi.plot

    names = [name for _, those in PAGES.values() for name in those]
    if sorted(names) != sorted(granperi.__all__):
        raise PackageError("PAGES in %s and granperi.__all__ differ in %s" % (
            __file__, ", ".join(sorted(set(names) ^ set(granperi.__all__)))))
    os.makedirs(directory)
    known, meanings = roles_of(granperi), constants_of(header)
    in_c = python_calls.of_c([function.name for function in header.of(c_reference.Function)], granperi)
    pages, described = {}, []

    def call(name, thing, directive):
        pages["granperi." + name if directive == "function" else name] = python_calls.page_of(name, thing, directive, known, python_calls.elsewhere(name, in_c, of_fortran))
        described.append("granperi." + name)

    for page, (title, those) in PAGES.items():
        pages[page] = exceptions_page(those, granperi) if page == "errors" else topic_page(title, those, granperi, known)
        for name in those:
            thing = getattr(granperi, name)
            if not isinstance(thing, type):
                call(name, thing, "function")
                continue
            described.append("granperi." + name)
            if issubclass(thing, enum.Enum):
                pages[name] = enumeration_page(name, thing, meanings, known)
            elif not issubclass(thing, Exception):
                pages[name] = class_page(name, thing, known)
                for short, member in calls_of(thing):
                    call("%s.%s" % (name, short), member, "classmethod" if isinstance(member, classmethod) else
                         "staticmethod" if isinstance(member, staticmethod) else "method")
    for name in PICTURES:
        call("plot." + name, getattr(granperi.plot, name), "function")
    pages["plot"] = topic_page("Pictures: granperi.plot", PICTURES, granperi.plot, known)
    pages["index"] = [*text.titled("Python: import granperi"), "The guide is :doc:`/guide/python`.", "", ERRORS, "", EXAMPLES, "",
                      ".. toctree::", "   :maxdepth: 1", "", *text.indented([*PAGES, "plot"]), ""]
    for name, lines in pages.items():
        with open(os.path.join(directory, name + ".rst"), "w", encoding="utf-8") as page:
            page.write("\n".join(lines))
    return described
