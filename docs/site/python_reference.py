"""The reference of the Python package: pages that have autodoc read the docstrings."""
import os

import text

PAGES = {
    "simulation": ("Simulation", ["Simulation"]),
    "scene": ("What a scene is made of", ["Config", "Material", "Column", "Plate", "Scene", "Run"]),
    "reading": ("What is read", ["State", "Clock", "History", "Load", "Plan", "PlanEntry", "Particles", "View", "FieldView", "Probe"]),
    "results": ("Result files, comparison, sweeps",
                ["Output", "Result", "Snapshot", "Difference", "compare", "Sweep", "sweep", "load", "has_feature"]),
    "report": ("Error against run time", ["report", "Report", "Row", "Recommendation", "settings", "Settings"]),
    "names": ("Names of choices", ["Density", "Field", "Fluidity", "InitialPressure", "Preset", "StepLimit", "Stress", "Wall"]),
    "errors": ("Exceptions", ["Error", "ArgumentError", "ArgumentTypeError", "DivergedError", "FileError", "InternalError",
                              "OutOfMemoryError", "SceneError", "StateError", "UnsupportedError", "VersionError",
                              "GranperiWarning"]),
}
OF_C = {"Config": "gp_config", "Material": "gp_material", "Column": "gp_column", "Plate": "gp_plate", "State": "gp_state",
        "Load": "gp_load", "PlanEntry": "gp_plan_entry", "Particles": "gp_particles"}
PICTURES = ["field", "surface", "interface", "energy", "fronts", "compare", "animate"]


class PackageError(Exception):
    """The package has a name that no page of the reference has, or the other way round."""


def of_name(name, thing):
    if not isinstance(thing, type):
        return [".. autofunction:: " + name, ""]
    short = issubclass(thing, BaseException)
    members = ["   :members:", "   :undoc-members:"] if not short else ["   :show-inheritance:"]
    lines = [(".. autoexception:: " if short else ".. autoclass:: ") + name, *members, ""]
    if name in OF_C:
        lines += ["   What each parameter or value means, its unit and its range: :c:struct:`%s`." % OF_C[name], ""]
    return lines


def write_python_reference(directory):
    """The public names."""
    import granperi
    import granperi.plot

    names = [name for _, those in PAGES.values() for name in those]
    if sorted(names) != sorted(granperi.__all__):
        raise PackageError("PAGES in %s and granperi.__all__ differ in %s" % (
            __file__, ", ".join(sorted(set(names) ^ set(granperi.__all__)))))
    os.makedirs(directory)
    pages = {}
    for page, (title, those) in PAGES.items():
        pages[page] = [*text.titled(title), ".. currentmodule:: granperi", ""]
        for name in those:
            pages[page] += of_name(name, getattr(granperi, name))
    pages["plot"] = [*text.titled("Pictures: granperi.plot"), ".. currentmodule:: granperi.plot", ""]
    for name in PICTURES:
        pages["plot"] += of_name(name, getattr(granperi.plot, name))
    pages["index"] = [*text.titled("Python: import granperi"), "The guide is :doc:`/guide/python`.", "",
                      ".. toctree::", "   :maxdepth: 1", "", *text.indented(list(pages)), ""]
    for name, lines in pages.items():
        with open(os.path.join(directory, name + ".rst"), "w", encoding="utf-8") as page:
            page.write("\n".join(lines))
    return ["granperi." + name for name in names] + ["granperi.plot." + name for name in PICTURES]
