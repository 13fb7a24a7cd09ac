"""The reference of the C interface from the header's own comments: one page per section, and one per call."""
import os
import re
import sys

import c_calls
import text

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "bindings", "generate"))
from header import Alias, Callback, Constants, Function, Opaque, Struct, read_header  # noqa: E402

TITLES = {"status": "Status and errors", "version": "Version and features", "parameters": "Parameters", "scene": "Scene",
          "running": "Running", "reading": "Reading", "files": "Files"}


class ReferenceError_(Exception):
    """The header has something that the reference has no place for."""


def sections_of(source):
    """[(name, begin, end)] of the header's sections, by the lines that part them."""
    marks = [(mark.group(1), mark.start()) for mark in re.finditer(r"^/\* -+ (\w+) \*/$", source, re.M)]
    ends = [begin for _, begin in marks[1:]] + [len(source)]
    return [(name, begin, end) for (name, begin), end in zip(marks, ends)]


def name_of(declaration):
    return declaration.values[0][0] if isinstance(declaration, Constants) else declaration.name


def roles_of(header):
    roles = {}
    for declaration in header.declarations:
        if isinstance(declaration, Constants):
            roles.update({name: "c:enumerator" if declaration.is_enum else "c:macro" for name, _, _ in declaration.values})
        elif isinstance(declaration, Function):
            roles[declaration.name] = "c:func"
        elif isinstance(declaration, (Struct, Opaque)):
            roles[declaration.name] = "c:struct"
            fields = declaration.fields if isinstance(declaration, Struct) else []
            roles.update({"%s.%s" % (declaration.name, field.name): "c:member" for field in fields})
        else:
            roles[declaration.name] = "c:type"
    return roles


def c_type(kind):
    return "%s%s %s" % ("const " if kind.const else "", kind.base, "*" * kind.pointers)


def declared(kind, name):
    return (c_type(kind) + name).replace("  ", " ")


def parameters_of(declaration):
    return ", ".join(declared(parameter.type, parameter.name) for parameter in declaration.parameters) or "void"


UNIT = re.compile(r"^(m/s2|m/s|m|s|Pa s|Pa|kg/m3|kg/m2|kg/s|rad/s|rad|J/m|N/m|N s/m|N s|N|1/s|dl)(?=[,; ]|$)[,;]? ?")
DEFAULT = re.compile(r" ?\[((?:[^][]|\[[^][]*\])*)\]$")


def member_lines(doc, roles):
    """What a member means, and below it its unit and default where the comment has them."""
    words = " ".join(doc.split())
    default, unit = DEFAULT.search(words), UNIT.match(words)
    facts = ["*Unit:* %s." % unit.group(1)] if unit else []
    if default:
        words = words[:default.start()]
        facts.append("*Default:* %s." % text.linked(default.group(1), roles))
    words = UNIT.sub("", words) if unit else words
    return [*([text.linked(words, roles), ""] if words else []), *([" ".join(facts), ""] if facts else [])]


def of_struct(struct, roles):
    lines = [".. c:struct:: " + struct.name, "", *text.indented(text.paragraphs(struct.doc, roles)), ""]
    k = 0
    while k < len(struct.fields):
        # Fields that share a comment stand together.
        same = [field for field in struct.fields[k:] if field.doc == struct.fields[k].doc and field.doc] or [struct.fields[k]]
        same = struct.fields[k:k + len(same)] if struct.fields[k:k + len(same)] == same else [struct.fields[k]]
        signatures = [declared(field.type, field.name) + ("[%d]" % field.length if field.length else "") for field in same]
        member = [".. c:member:: " + signatures[0], *text.indented(signatures[1:], 14), ""]
        member += text.indented(member_lines(same[0].doc, roles)) + [""]
        lines += text.indented(member)
        k += len(same)
    return lines


def of_constants(constants, roles):
    lines = [*text.paragraphs(constants.doc, roles), ""]
    for name, value, doc in constants.values:
        if constants.is_enum:
            lines += [".. c:enumerator:: %s = %d" % (name, value), ""]
        else:
            lines += [".. c:macro:: " + name, "", "   %d" % value, ""]
        lines += text.indented([text.linked(" ".join(doc.split()), roles)]) + [""]
    return lines


def of_function(function, roles, shared, callbacks, of_fortran):
    """The page of a call. shared: the function whose comment it shares; callbacks: the types of functions that it may take;
    of_fortran: {C function: name of a page}."""
    doc = text.paragraphs(shared.doc, roles)
    for callback in callbacks:
        if any(parameter.type.base == callback.name for parameter in function.parameters):
            doc += ["", ":c:type:`%s`: %s" % (callback.name, text.linked(" ".join(callback.doc.split()), roles))]
    signature = "%s%s(%s)" % (c_type(function.result), function.name, parameters_of(function))
    return [*text.titled(function.name), ".. c:function:: " + signature.replace("  ", " "), "", *text.indented(doc), "",
            *c_calls.argument_table(function, roles), *c_calls.errors_of(function, shared.doc, roles),
            *c_calls.example_lines(function), *c_calls.restrictions_of(function.name, roles),
            *c_calls.elsewhere(function, of_fortran)]


def comments_of(header):
    """{function: its comment, or that of the function before it, which it shares}."""
    found, doc = {}, ""
    for function in header.of(Function):
        doc = function.doc or doc
        found[function.name] = doc
    return found


def first_sentence(doc):
    """Of a comment, for the list of calls."""
    words = " ".join(doc.split("\n\n")[0].split())
    return re.split(r"(?<=[a-z0-9)*\]])[.;:] ", words)[0].rstrip(".") + "."


def of_declaration(declaration, roles):
    if isinstance(declaration, Struct):
        return of_struct(declaration, roles)
    if isinstance(declaration, Constants):
        return of_constants(declaration, roles)
    doc = text.indented(text.paragraphs(declaration.doc, roles))
    if isinstance(declaration, Callback):
        signature = "%s(*%s)(%s)" % (c_type(declaration.result), declaration.name, parameters_of(declaration))
        return [".. c:type:: " + signature, "", *doc, ""]
    if isinstance(declaration, Opaque):
        return [".. c:struct:: " + declaration.name, "", *doc, ""]
    if isinstance(declaration, Alias):
        return [".. c:type:: " + declared(declaration.type, declaration.name), "", *doc, ""]
    raise ReferenceError_("nothing is known of %r" % (declaration,))


def write_c_reference(header_path, cc, directory, of_fortran=(), more=()):
    """The names of all public functions. of_fortran: {C function: name of its page in the Fortran reference}; more: pages that
    others write beside these."""
    with open(header_path, encoding="utf-8") as source:
        source = source.read()
    header = read_header(header_path, cc, text.lines_of)
    code = re.sub(r"/\*.*?\*/", lambda comment: re.sub(r"[^\n]", " ", comment.group(0)), source, flags=re.S)
    place = {id(declaration): re.search(r"\b%s\b" % name_of(declaration), code).start() for declaration in header.declarations}
    roles = roles_of(header)
    os.makedirs(directory)
    pages, functions = [], []
    for section, begin, end in [("version_numbers", 0, sections_of(source)[0][1]), *sections_of(source)]:
        of_it = [declaration for declaration in header.declarations if begin <= place[id(declaration)] < end]
        if section == "version_numbers":
            numbers = of_it
            continue
        if section == "version":
            of_it = numbers + of_it
        lines, shared, last, calls = [], None, 0, []
        # A macro that stands for a function may have the name of a type.
        macros = re.findall(r"#define (gp_\w+)\(", code[begin:end])
        known = {name: role for name, role in roles.items() if name not in macros}
        for declaration in of_it:
            if isinstance(declaration, Function):
                alone = "\n\n" in code[last:place[id(declaration)]]
                if not declaration.doc and (alone or shared is None):
                    raise ReferenceError_("%s has no comment in %s" % (declaration.name, header_path))
                shared = declaration if declaration.doc else shared
                calls += ["   * - :doc:`%s`" % declaration.name, "     - " + text.linked(first_sentence(shared.doc), known)]
                with open(os.path.join(directory, declaration.name + ".rst"), "w", encoding="utf-8") as page:
                    page.write("\n".join(of_function(declaration, known, shared, header.of(Callback), of_fortran)))
                functions.append(declaration.name)
            else:
                lines += of_declaration(declaration, known)
            last = place[id(declaration)]
        if calls:
            names = [name for name in functions if "   * - :doc:`%s`" % name in calls]
            lines = [".. list-table::", "   :widths: 30 70", "", *calls, "", ".. toctree::", "   :hidden:", "",
                     *text.indented(names), "", *lines]
        lines = text.titled(TITLES[section]) + lines
        pages.append(section)
        with open(os.path.join(directory, section + ".rst"), "w", encoding="utf-8") as page:
            page.write("\n".join(lines))
    conventions = text.lines_of(re.search(r"/\*.*?\*/", source, re.S).group(0))
    conventions = conventions.split("\n\n", 1)[1]  # the first line is the project's name
    with open(os.path.join(directory, "index.rst"), "w", encoding="utf-8") as page:
        page.write("\n".join([*text.titled("C: granperi/gp.h"), *text.paragraphs(conventions, roles), "",
                              ".. toctree::", "   :maxdepth: 2", "", *text.indented([*pages, *more]), ""]))
    return [function.name for function in header.of(Function)]
