"""The reference of the Fortran module, from its sources: public procedures with the comments (!>) before them."""
import collections
import os
import re

import c_calls
import c_reference
import fortran_calls
import text

Procedure = collections.namedtuple("Procedure", "kind name arguments result declarations doc")

# What the C function of a procedure's name is called where it is not gp_NAME or gp_get_NAME.
SAME_AS = {"interface_between": "gp_get_interface", "copy": "gp_copy_field", "load": "gp_load_file",
           "remove_callback": "gp_set_callback", "remove_log": "gp_set_log"}
PROCEDURES = ("gp_on_step", "gp_on_log", "gp_log_to_stderr")


class FortranError(Exception):
    """The sources have something that the reference has no place for."""


def statements_of(path):
    """[(statement, comment lines before it)], continued lines joined, comments behind statements dropped."""
    found, doc, begun = [], [], ""
    with open(path, encoding="utf-8") as source:
        for line in source:
            words = line.strip()
            if words.startswith("!>") or (doc and words.startswith("!") and not words.startswith("!!")):
                doc.append(words[2:].strip())
                continue
            if words.startswith("!") or not words:
                continue
            words = re.sub(r"\s+!.*$", "", words)
            begun += words.rstrip("&").strip() if not begun else " " + words.lstrip("&").rstrip("&").strip()
            if words.endswith("&"):
                continue
            found.append((begun, doc))
            begun, doc = "", []
    return found


def procedures_of(statements):
    found, opened = [], None
    for statement, doc in statements:
        head = re.match(r"(?:module |impure |elemental |pure )*(subroutine|function) (\w+) ?\( ?([^)]*?) ?\)"
                        r"(?: result\((\w+)\))?", statement)
        if head:
            opened = Procedure(head.group(1), head.group(2), re.split(r",\s*", head.group(3)) if head.group(3) else [],
                               head.group(4), {}, doc)
            found.append(opened)
        elif statement.startswith(("end subroutine", "end function", "end procedure")):
            opened = None
        elif opened and "::" in statement:
            kind, names = statement.split("::")
            for name, shape in re.findall(r"(\w+)(\([^)]*\))?", names):
                opened.declarations[name] = kind.strip() + (", shape " + shape if shape else "")
    return {procedure.name: procedure for procedure in found}


def bound_to(statements, type_name):
    """{public name: [procedures]} of a type's procedures."""
    found, inside = collections.OrderedDict(), False
    for statement, _ in statements:
        if re.match(r"type :: %s$" % type_name, statement):
            inside = True
        elif statement == "end type":
            inside = False
        binding = re.match(r"(?:procedure|generic), public :: (.*)", statement)
        if not inside or not binding:
            continue
        generic = statement.startswith("generic")
        for name in [binding.group(1)] if generic else re.split(r",\s*", binding.group(1)):
            own, _, to = name.partition("=>")
            found[own.strip()] = re.split(r",\s*", to.strip()) if to else [own.strip()]
    return found


def described(signature, lines):
    return [".. fortran:: " + signature, "", *text.indented(lines), ""]


def same_in_c(name, functions):
    """The C function that a procedure stands for, or None."""
    return SAME_AS.get(name) or next((c for c in ("gp_" + name, "gp_get_" + name) if c in functions), None)


def arguments_of(procedure):
    lines = ["- ``%s``: ``%s``" % (argument, procedure.declarations[argument]) for argument in procedure.arguments
             if argument in procedure.declarations]
    return [*lines, ""] if lines else []


def page_of(name, procedure, header, roles):
    """The page of one procedure of a simulation."""
    functions = {function.name: function for function in header.of(c_reference.Function)}
    same = same_in_c(name, functions)
    if not same and not procedure.doc:
        raise FortranError("%s has no comment (!>)" % name)
    arguments = ", ".join(argument for argument in procedure.arguments if argument != "self")
    call = ("call sim%%%s(%s)" if procedure.kind == "subroutine" else "sim%%%s(%s)") % (name, arguments)
    lines = [*text.titled("sim%" + name), ".. fortran:: " + call, "",
             *text.indented(text.paragraphs("\n".join(procedure.doc), roles)), ""]
    lines += fortran_calls.argument_table(name, procedure, same, roles)
    comment = c_reference.comments_of(header).get(same, "")
    if same:
        lines += [".. rubric:: In C", "", ":c:func:`%s` does the same:" % same, "", *text.paragraphs(comment, roles), "",
                  *c_calls.errors_of(functions[same], comment, roles)]
    lines += fortran_calls.example_lines(name, procedure.kind == "function")
    return lines + ([*c_calls.restrictions_of(same, roles), *c_calls.in_python(same)] if same else [])


def simulation_pages(statements, header, roles):
    """{name: lines} of the page of the type, and of each of its procedures."""
    procedures, pages = procedures_of(statements), {}
    lines = [*text.titled("type(gp_simulation)"),
             "``sim`` is a ``type(gp_simulation)``. Every procedure ends with the optional ``status`` and ``message``; without "
             "both, an error ends the program with the message (:doc:`/guide/errors`).", "",
             ".. list-table::", "   :widths: 30 70", ""]
    functions = c_reference.comments_of(header)
    for name, made_of in bound_to(statements, "gp_simulation").items():
        if name.startswith("assignment"):
            continue
        procedure = procedures[made_of[0]]
        pages[name] = page_of(name, procedure, header, roles)
        words = " ".join(procedure.doc) or functions[same_in_c(name, functions)]
        lines += ["   * - :doc:`sim%%%s <%s>`" % (name, name), "     - " + text.linked(c_reference.first_sentence(words), roles)]
    lines += ["", ".. toctree::", "   :hidden:", "", *text.indented(list(pages)), ""]
    hosts = text.titled("Procedures of the host")
    for name in PROCEDURES:
        procedure = procedures[name]
        hosts += described("subroutine %s(%s)" % (name, ", ".join(procedure.arguments)),
                           [*text.paragraphs("\n".join(procedure.doc)), "", *arguments_of(procedure)])
    return {"simulation": lines, **pages, "procedures": hosts}


def objects_page(statements):
    procedures = procedures_of(statements)
    lines = [*text.titled("Objects and constants"),
             "Constructors take any field by its name; what is not given has the library's default. The fields are those of "
             "the C struct. The constants (``GP_...``) are those of C, too.", ""]
    for name in ("gp_config", "gp_material", "gp_column", "gp_plate", "gp_output"):
        lines += described("%s(%s)" % (name, ", ".join(procedures["new_" + name].arguments)),
                           ["The fields: :c:struct:`%s`." % name])
    for name in ("gp_state", "gp_load", "gp_particles", "gp_plan_entry"):
        lines += described("type(%s)" % name, ["What the library fills: :c:struct:`%s`." % name])
    lines += described("gp_real, gp_int64", ["Kinds of every real (``c_double``), and of the integers that have 64 bits in C "
                                             "(``c_int64_t``): ``0.08_gp_real``, ``7_gp_int64``."])
    return lines


def status_part(statements):
    procedures, lines = procedures_of(statements), []
    for name in ("version_string", "has_feature", "status_string"):
        procedure = procedures[name]
        lines += described("gp_%s(%s)" % (name, ", ".join(procedure.arguments)),
                           [*text.paragraphs("\n".join(procedure.doc)), "", *arguments_of(procedure)])
    return lines


def c_functions(sources, header):
    """{C function: name of the page of the procedure that does the same}"""
    functions = c_reference.comments_of(header)
    bound = bound_to(statements_of(os.path.join(sources, "granperi_simulation.f90")), "gp_simulation")
    found = {}
    for name in bound:
        same = same_in_c(name, functions)
        if same:
            found.setdefault(same, name)
    return found


def write_fortran_reference(sources, header, directory):
    """header: what gp.h declares. Returns the public names."""
    os.makedirs(directory)
    simulation = statements_of(os.path.join(sources, "granperi_simulation.f90"))
    types = statements_of(os.path.join(sources, "granperi_types.f90"))
    status = statements_of(os.path.join(sources, "granperi_status.f90"))
    pages = simulation_pages(simulation, header, c_reference.roles_of(header))
    pages["objects"] = objects_page(types) + status_part(status)
    pages["index"] = [*text.titled("Fortran: use granperi"), "The guide is :doc:`/guide/fortran`.", "",
                      ".. toctree::", "   :maxdepth: 1", "", *text.indented(["simulation", "procedures", "objects"]), ""]
    for name, lines in pages.items():
        with open(os.path.join(directory, name + ".rst"), "w", encoding="utf-8") as page:
            page.write("\n".join(lines))
    return ["sim%" + name for name in bound_to(simulation, "gp_simulation") if not name.startswith("assignment")]
