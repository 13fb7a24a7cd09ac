"""What the page of a Python call has: syntax, arguments with type, default, unit and range, errors, an example, other languages."""
import inspect
import re
import textwrap

import c_calls
import docstrings
import text

DOTTED = re.compile(r"\b(?:granperi\.)?([A-Z]\w+\.\w+|[A-Z][a-z]+[A-Z]\w+)\b(\(\))?")


class CallError(Exception):
    """A public call whose docstring does not say what it has to."""


def plain_function(thing):
    return thing.__func__ if isinstance(thing, (classmethod, staticmethod)) else thing


def own_parameters(thing):
    """Of a function or a member of a class, without self and cls."""
    found = inspect.signature(plain_function(thing)).parameters.values()
    return [parameter for parameter in found if parameter.name not in ("self", "cls")]


def starred(parameter):
    return {parameter.VAR_POSITIONAL: "*", parameter.VAR_KEYWORD: "**"}.get(parameter.kind, "") + parameter.name


def linked(words, known):
    """Escaped, with names of the package as links: known maps Simulation.run and the like to a role."""
    pieces, end = [], 0
    for name in DOTTED.finditer(words):
        role = known.get(name.group(1))
        if role:
            pieces += [text.escape(words[end:name.start()]), "\\ :py:%s:`%s <granperi.%s>`\\ " % (role, name.group(1), name.group(1))]
            end = name.end()
    return "".join(pieces) + text.escape(words[end:])


def prose(words, known):
    """Paragraphs of a docstring; indented ones are code."""
    lines = []
    for paragraph in words.split("\n\n"):
        if paragraph.startswith("    "):
            lines += [".. code-block:: python", "", *text.indented(textwrap.dedent(paragraph).split("\n")), ""]
        else:
            lines += [linked(" ".join(paragraph.split()), known), ""]
    return lines


def kind_of(parameter):
    """The type in words that the source has, without marks of the type checker."""
    kind = parameter.annotation
    if kind is inspect.Parameter.empty:
        return "array" if parameter.kind is parameter.POSITIONAL_OR_KEYWORD else ""
    kind = kind if isinstance(kind, str) else getattr(kind, "__name__", str(kind))
    kind = re.sub(r"\bos\.PathLike\[str\]", "PathLike", kind.replace('"', "").replace("'", ""))
    return "" if kind == "Any" or "Unpack" in kind else kind


def default_of(parameter):
    if parameter.default is inspect.Parameter.empty:
        return "" if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD) else "needed"
    return "``%r``" % (parameter.default,)


def argument_table(name, thing, parts, known):
    said = dict(parts.args)
    parameters = own_parameters(thing)
    if {starred(one) for one in parameters} != set(said):
        raise CallError("%s: Args: of its docstring names %s, it takes %s" % (
            name, ", ".join(said) or "nothing", ", ".join(map(starred, parameters)) or "nothing"))
    if not parameters:
        return []
    lines = [".. list-table:: Arguments", "   :widths: 16 20 14 50", "   :header-rows: 1", "",
             "   * - argument", "     - type", "     - default", "     - what it is: unit, shape, range"]
    for one in parameters:
        kind = kind_of(one)
        lines += ["   * - ``%s``" % starred(one), "     - %s" % ("``%s``" % kind if kind else ""),
                  "     - %s" % default_of(one), "     - %s" % linked(said[starred(one)], known)]
    return [*lines, ""]


def syntax_of(name, thing):
    """name(a, b=1, *, c=None), without types: they are in the table."""
    signature = inspect.signature(plain_function(thing))
    short = [one.replace(annotation=inspect.Parameter.empty) for one in signature.parameters.values()
             if one.name not in ("self", "cls")]
    return name + str(inspect.Signature(short))


def elsewhere(name, of_c, of_fortran):
    """The same in C and Fortran. of_c: {name in Python: C function}, of_fortran: {C function: name of a page}."""
    function = of_c.get(name)
    if function is None:
        return []
    words = "In C: :c:func:`%s`." % function
    if function in of_fortran:
        words += " In Fortran: :doc:`sim%%%s </reference/fortran/%s>`." % (of_fortran[function], of_fortran[function])
    return [words, ""]


def of_c(functions, granperi):
    """{name in Python: C function}"""
    found = {}
    for function in functions:
        name = c_calls.python_name(function, granperi)
        if name:
            found.setdefault(name, function)
    return found


def page_of(name, thing, directive, known, others):
    """The page of one call; others: lines about other languages."""
    parts = docstrings.parts_of(plain_function(thing).__doc__)
    if not parts.doc:
        raise CallError("%s has no docstring" % name)
    title = "granperi." + name if directive == "function" else name
    lines = [*text.titled(title), ".. py:currentmodule:: granperi" + (".plot" if name.startswith("plot.") else ""), "",
             ".. py:%s:: %s" % (directive, syntax_of(name.removeprefix("plot."), thing)), "",
             *text.indented(prose(parts.doc, known)), "", *argument_table(name, thing, parts, known)]
    if parts.returns:
        lines += [".. rubric:: Returns", "", linked(parts.returns, known), ""]
    if parts.raises:
        lines += [".. rubric:: Errors", "", *["- %s: %s" % (linked(error, known), linked(when, known)) for error, when in parts.raises], ""]
    if parts.example:
        lines += [".. rubric:: Example", "", ".. code-block:: python", "", *text.indented(parts.example.split("\n")), ""]
    if parts.restrictions:
        lines += [".. rubric:: Restrictions", "", linked(" ".join(parts.restrictions.split()), known), ""]
    return lines + others


def first_sentence(doc):
    words = " ".join(doc.split("\n\n")[0].split())
    return re.split(r"(?<=[a-z0-9)*\]\"])[.;:] ", words)[0].rstrip(".:") + "."
