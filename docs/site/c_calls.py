"""What a call's page has beside the header's comment: its arguments with units, what it returns, an example, other languages."""
import os
import re
import textwrap

import text

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
# Arguments by name, and where a name means different things by call.
ARGUMENTS = {
    "sim": "the simulation; NULL is GP_E_ARGUMENT", "size": "sizeof the struct, in bytes", "status": "any status",
    "name": "a name", "preset": "one of GP_PRESET_DEFAULT, GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL",
    "id": "receives the number of what was added; may be NULL", "n": "length of the arrays",
    "x": "m, shape (n), finite", "y": "m, shape (n), finite", "vx": "m/s, finite", "vy": "m/s, finite",
    "omega": "rad/s, counter-clockwise, finite", "gx": "m/s2, to the right, finite", "gy": "m/s2, upwards, finite",
    "t_end": "s, where the clock is to stop; finite, not before what it shows", "plate": "number of the plate, 0 .. number of plates - 1",
    "material": "number of the material, 0 .. number of materials - 1; 0 is always there", "every": "steps between two calls; >= 1",
    "callback": "the function; NULL: no longer", "user": "handed on to the function as it is", "log": "the function; NULL: silent",
    "fields": "GP_FIELD_... bits, or-ed", "field": "one GP_FIELD_... bit", "particles": "receives the views",
    "dst": "receives n values, in the units of the field", "state": "receives the state", "parts": "GP_STATE_... bits, or 0",
    "time": "s; receives the clock; may be NULL", "dt": "s; receives the last time step; may be NULL",
    "step": "receives the number of steps; may be NULL", "height": "m, shape (n); receives the heights",
    "left": "number of a column or set of particles, counted from 0", "right": "number of another one", "load": "receives the load",
    "entries": "receives up to n entries; NULL with n = 0", "n_out": "receives how many there are in all",
    "path": "of the file, as the system's calls take it", "output": "what to write and when; NULL: the defaults",
    "config": "the parameters", "column": "the rectangle", "comm": "the processes that take part",
}
OF_CALL = {"gp_add_plate.plate": "the plate", "gp_plate_init.plate": "receives the defaults", "gp_material_init.material":
           "receives the defaults", "gp_column_init.column": "receives the defaults", "gp_config_init.config":
           "receives the defaults", "gp_output_init.output": "receives the defaults", "gp_create.sim":
           "receives the simulation; NULL after an error", "gp_load_file.sim": "receives the simulation; NULL after an error",
           "gp_create_mpi.sim": "receives the simulation; NULL after an error",
           "gp_load_mpi.sim": "receives the simulation; NULL after an error",
           "gp_destroy.sim": "the simulation, or NULL", "gp_add_material.material": "the material",
           "gp_add_particles.vx": "m/s, shape (n), finite, or NULL with vy: at rest", "gp_add_particles.vy": "m/s, shape (n), finite",
           "gp_step.n": "number of steps; >= 0", "gp_add_particles.n": "length of the arrays; >= 1", "gp_get_interface.x": "m, shape (n); receives the positions",
           "gp_has_feature.name": "e.g. \"hdf5\"", "gp_add_material.id": "receives its number; may be NULL"}
PYTHON = {"gp_create": "Simulation", "gp_destroy": "Simulation.close", "gp_load_file": "Simulation.load", "gp_copy_field":
          "Simulation.field", "gp_get_particles": "Simulation.view", "gp_get_plate_load": "Simulation.plate_load",
          "gp_output_open": "Simulation.output", "gp_output_write": "Output.write", "gp_output_close": "Output.close",
          "gp_has_feature": "has_feature", "gp_config_init": "Config", "gp_material_init": "Material", "gp_column_init": "Column",
          "gp_plate_init": "Plate"}
BEFORE = "Before the first step; after it GP_E_STATE."
HDF5 = "Of a build with HDF5 (gp_has_feature); without it GP_E_UNSUPPORTED."
RESTRICTIONS = {"gp_add_material": BEFORE, "gp_add_column": BEFORE, "gp_add_particles": BEFORE, "gp_add_plate": BEFORE,
                "gp_save": HDF5, "gp_load_file": HDF5, "gp_output_open": HDF5,
                "gp_set_plate_motion": "A plate under a normal_pressure does not turn.",
                "gp_run": "Each end is another run, since the last steps are shortened for it: look on the way by an output or a callback."}
# Any status but these needs a reason of the call's own.
GENERAL = {"GP_E_ARGUMENT": "an argument is missing, not finite, out of range or inconsistent",
           "GP_E_STATE": "from inside a callback, but for calls that read, save, write to the open output or drive plates and gravity",
           "GP_E_MEMORY": "out of memory"}


class ArgumentError_(Exception):
    """An argument that the reference does not know."""


def argument_table(function, roles):
    if not function.parameters:
        return []
    lines = [".. list-table:: Arguments", "   :widths: 20 26 54", "   :header-rows: 1", "",
             "   * - argument", "     - type", "     - what it is"]
    for parameter in function.parameters:
        meaning = OF_CALL.get("%s.%s" % (function.name, parameter.name), ARGUMENTS.get(parameter.name))
        if meaning is None:
            raise ArgumentError_("docs/site/c_calls.py: nothing is said of %s of %s" % (parameter.name, function.name))
        kind = "%s%s %s" % ("const " if parameter.type.const else "", parameter.type.base, "*" * parameter.type.pointers)
        more = ": units, ranges and defaults are with its members" if roles.get(parameter.type.base) == "c:struct" and \
            parameter.type.base != "gp_sim" else ""
        lines += ["   * - ``%s``" % parameter.name, "     - %s" % text.linked(kind.strip(), roles),
                  "     - %s%s" % (text.linked(meaning, roles), more)]
    return [*lines, ""]


def errors_of(function, doc, roles):
    """What it returns: the statuses that hold for all calls, and the sentences of its comment that name others."""
    if function.result.base != "gp_status":
        return []
    lines = [".. rubric:: Returns", "", "- %s;" % text.linked("GP_OK: done", roles)]
    named = [name for name in re.findall(r"\bGP_(?:E_[A-Z]+|STOPPED)\b", doc)]
    takes_sim = any(parameter.type.base == "gp_sim" for parameter in function.parameters)
    for name, meaning in GENERAL.items():
        if name != "GP_E_STATE" or takes_sim:
            lines.append("- %s;" % text.linked("%s: %s" % (name, meaning), roles))
    others = [name for name in dict.fromkeys(named) if name not in GENERAL]
    if others:
        lines.append("- %s, as said above;" % text.linked(", ".join(others), roles))
    lines.append("- %s" % text.linked("after an error, gp_last_error says which argument had which value and what was expected.", roles))
    return [*lines, ""]


def restrictions_of(name, roles):
    words = RESTRICTIONS.get(name)
    return [".. rubric:: Restrictions", "", text.linked(words, roles), ""] if words else []


def example_of(pattern, places, language):
    """(code, where it is from): the lines around the first use of a pattern, of the shortest example or page of the guide that has it
    and is more than some lines."""
    found = []
    for directory, end in places:
        for file in sorted(os.listdir(os.path.join(ROOT, directory))):
            if not file.endswith(end):
                continue
            with open(os.path.join(ROOT, directory, file), encoding="utf-8") as source:
                content = source.read()
            if end == ".md":
                pieces = [piece for fails, piece in re.findall(r"^(<!-- block: fails.*?-->\n)?```%s\n(.*?)^```" % language, content,
                                                               re.S | re.M) if not fails]
            else:
                pieces = [content]
            for piece in pieces:
                lines = piece.split("\n")
                use = next((k for k, line in enumerate(lines) if re.search(pattern, line)), None)
                if use is not None:
                    found.append((file.startswith("example."), len(lines) < 8, len(lines), lines, use, directory, file))
    if not found:
        return None
    *_, lines, use, directory, file = min(found, key=lambda one: one[:3])
    return excerpt(lines, use), "/%s" % directory + "/" + file if directory.startswith("examples") else \
        "/index" if file == "README.md" else "/guide/" + file[:-3]


def excerpt(lines, use):
    """The lines around one of them, whole statements as far as brackets and & tell."""
    first, last = max(0, use - 3), min(use + 4, len(lines))
    while last < len(lines) and (lines[last - 1].rstrip().endswith(("&", ",")) or
                                 sum(map("\n".join(lines[use:last]).count, "([{")) > sum(map("\n".join(lines[use:last]).count, ")]}"))):
        last += 1
    return textwrap.dedent("\n".join(lines[first:last])).strip("\n")


def example_lines(function):
    name = "gp_load" if function.name == "gp_load_file" else function.name
    example = example_of(r"\b%s\(" % name, (("examples/c", ".c"), ("docs/guide", ".md")), "c")
    if example is None:
        return []
    code, where = example
    return [".. rubric:: Example", "", "From :doc:`%s`:" % where, "", ".. code-block:: c", "", *text.indented(code.split("\n")), ""]


def python_name(function, granperi):
    """The name in the package that does what a C function does, or None."""
    short = re.sub(r"^gp_(get_)?", "", function)
    return PYTHON.get(function) or ("Simulation." + short if hasattr(granperi.Simulation, short) else None)


def in_python(function):
    """The same in Python, if the package is there to ask."""
    try:
        import granperi
    except ImportError:
        return []
    name = python_name(function, granperi)
    if name is None:
        return []
    thing = granperi
    for part in name.split("."):
        thing = getattr(thing, part)
    role = "class" if isinstance(thing, type) else "attr" if isinstance(thing, property) else \
        "func" if "." not in name else "meth"
    return ["In Python: :py:%s:`granperi.%s`." % (role, name), ""]


def elsewhere(function, of_fortran):
    """The same in Python and in Fortran. of_fortran: {C function: name of a page}."""
    lines = in_python(function.name)
    if function.name in of_fortran:
        name = of_fortran[function.name]
        lines += ["In Fortran: :doc:`sim%%%s </reference/fortran/%s>`." % (name, name), ""]
    return lines
