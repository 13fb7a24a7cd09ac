"""Writes the header as a Fortran module: bind(c) types, parameters, and an interface for each function.

A pointer becomes an optional argument where Fortran can check what it points to; an absent one is passed as NULL, and the
library says whether it takes that:
  gp_sim **        type(c_ptr), intent(out)
  struct *         type(...), intent(in) if const, else intent(inout), for the library reads struct_size; a struct
                   without struct_size is the element of an array
  double *         an array of assumed size
  int32_t *, ...   a scalar that is filled
  const char *     an array of characters that ends with c_null_char, so a string can be passed
and by value, as type(c_ptr) or type(c_funptr), the handle, a callback's own data, callbacks, and text that is returned.
"""

import textwrap

from header import Alias, Callback, Constants, Function, HeaderError, Opaque, Struct

NUMBERS = {
    "int32_t": "integer(c_int32_t)",
    "uint32_t": "integer(c_int32_t)",  # Fortran has no unsigned integers: the same bits
    "int64_t": "integer(c_int64_t)",
    "uint64_t": "integer(c_int64_t)",
    "size_t": "integer(c_size_t)",
    "double": "real(c_double)",
}
WIDTH = 120


class Names:
    """What the header's names stand for."""

    def __init__(self, header):
        self.opaque = {item.name for item in header.of(Opaque)}
        self.structs = {item.name: item for item in header.of(Struct)}
        self.callbacks = {item.name for item in header.of(Callback)}
        self.aliases = {item.name: item.type.base for item in header.of(Alias)}

    def number(self, kind):
        """The Fortran type of a number, None if it is none."""
        return NUMBERS.get(self.aliases.get(kind.base, kind.base))

    def value(self, kind):
        """The Fortran type of a field, or of an argument or result passed by value."""
        if kind.pointers:
            return "type(c_ptr)"
        if kind.base in self.callbacks:
            return "type(c_funptr)"
        number = self.number(kind)
        if number is None:
            raise HeaderError("no Fortran type for %s" % kind.base)
        return number

    def argument(self, parameter):
        """The Fortran declaration of an argument."""
        kind, name = parameter.type, parameter.name
        if kind.pointers == 2 and kind.base in self.opaque:
            return "type(c_ptr), intent(out) :: " + name
        if kind.pointers == 0 or kind.base == "void" or kind.base in self.opaque:
            return "%s, value :: %s" % (self.value(kind), name)
        if kind.pointers > 1:
            raise HeaderError("no Fortran type for %s %s%s" % (kind.base, "*" * kind.pointers, name))
        intent = "in" if kind.const else "inout"
        if kind.base in self.structs:
            one = any(field.name == "struct_size" for field in self.structs[kind.base].fields)
            return "type(%s), intent(%s), optional :: %s%s" % (kind.base, intent, name, "" if one else "(*)")
        if kind.base == "char":
            return "character(kind=c_char), intent(%s), optional :: %s(*)" % (intent, name)
        array = "(*)" if kind.base == "double" else ""
        return "%s, intent(%s), optional :: %s%s" % (self.number(kind), intent, name, array)


def comment(doc, indent, sign):
    lines = textwrap.wrap(doc, WIDTH - indent - 3, break_long_words=False, break_on_hyphens=False)
    return [" " * indent + sign + " " + line for line in lines]


def with_doc(line, doc):
    """A declaration with its documentation behind it, or below it where the line would become too long."""
    if not doc:
        return [line]
    if len(line) + len(doc) + 4 <= WIDTH:
        return ["%s !! %s" % (line, doc)]
    return [line, *comment(doc, len(line) - len(line.lstrip()) + 4, "!!")]


def argument_list(names, head, tail):
    """head(names) tail, continued over lines where it is too long."""
    whole = "%s(%s)%s" % (head, ", ".join(names), tail)
    if len(whole) <= WIDTH:
        return [whole]
    indent = len(head) - len(head.lstrip()) + 8
    wrapped = textwrap.wrap(", ".join(names), WIDTH - indent - 2)
    lines = ["%s( &" % head, *(" " * indent + line + " &" for line in wrapped)]
    return [*lines[:-1], "%s)%s" % (lines[-1][:-2], tail)] if len(lines[-1] + tail) <= WIDTH else \
        [*lines, " " * indent + ")" + tail]


def write_procedure(names, item, indent, bind):
    pad = " " * indent
    is_subroutine = item.result.base == "void" and item.result.pointers == 0
    arguments = [parameter.name for parameter in item.parameters]
    result = "answer"
    tail = " " + bind + ("" if is_subroutine else " result(%s)" % result)
    head = "%s%s %s" % (pad, "subroutine" if is_subroutine else "function", item.name)
    lines = comment(item.doc, indent, "!>") + argument_list(arguments, head, tail) + [pad + "    import"]
    lines += ["%s    %s" % (pad, names.argument(parameter)) for parameter in item.parameters]
    if not is_subroutine:
        lines.append("%s    %s :: %s" % (pad, names.value(item.result), result))
    return lines + ["%send %s" % (pad, "subroutine" if is_subroutine else "function"), ""]


def write_constants(item):
    lines = comment(item.doc, 4, "!>")
    for name, value, doc in item.values:
        if not -2**31 <= value < 2**31:
            raise HeaderError("%s = %d does not fit in 32 bits" % (name, value))
        lines += with_doc("    integer(c_int32_t), parameter :: %s = %d" % (name, value), doc)
    return lines + [""]


def write_struct(names, item):
    lines = comment(item.doc, 4, "!>") + ["    type, bind(c) :: " + item.name]
    for field in item.fields:
        length = "" if field.length is None else "(%d)" % field.length
        # So that one that was never filled can be told.
        begin = " = 0" if field.name == "struct_size" else ""
        lines += with_doc("        %s :: %s%s%s" % (names.value(field.type), field.name, length, begin), field.doc)
    return lines + ["    end type", ""]


def write_raw(header):
    names = Names(header)
    lines = ["! Written by bindings/generate from include/granperi/gp.h. Do not edit.", "",
             "!> The C interface of granperi as it is. Programs use the module granperi, which is built on it.",
             "module granperi_raw", "    use, intrinsic :: iso_c_binding", "    implicit none", "    public", ""]
    for item in header.declarations:
        if isinstance(item, Constants):
            lines += write_constants(item)
        elif isinstance(item, Alias):
            kind = names.number(item.type).split("(")[1][:-1]
            lines += comment(item.doc, 4, "!>") + ["    integer, parameter :: %s = %s" % (item.name, kind), ""]
        elif isinstance(item, Struct):
            lines += write_struct(names, item)
    lines += ["    abstract interface"]
    for item in header.of(Callback):
        lines += write_procedure(names, item, 8, "bind(c)")
    lines += ["    end interface", "", "    interface"]
    for item in header.of(Function):
        lines += write_procedure(names, item, 8, 'bind(c, name="%s")' % item.name)
    lines += ["    end interface", "end module"]
    return "\n".join(lines) + "\n"
