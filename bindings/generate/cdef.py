"""Writes the header for CFFI: the same declarations without comments, macros and includes."""

from header import Alias, Callback, Constants, Function, Opaque, Struct


def declare(kind, name):
    return "%s%s %s%s" % ("const " if kind.const else "", kind.base, "*" * kind.pointers, name)


def parameters(of):
    return ", ".join(declare(parameter.type, parameter.name) for parameter in of.parameters) or "void"


def write_declaration(declaration):
    if isinstance(declaration, Constants) and declaration.is_enum:
        return "enum {\n%s\n};" % ",\n".join("    %s = %d" % (name, value) for name, value, _ in declaration.values)
    if isinstance(declaration, Constants):
        return "\n".join("#define %s %d" % (name, value) for name, value, _ in declaration.values)
    if isinstance(declaration, Alias):
        return "typedef %s;" % declare(declaration.type, declaration.name)
    if isinstance(declaration, Opaque):
        return "typedef struct {0} {0};".format(declaration.name)
    if isinstance(declaration, Struct):
        fields = "".join("    %s%s;\n" % (declare(field.type, field.name),
                                          "" if field.length is None else "[%d]" % field.length)
                         for field in declaration.fields)
        return "typedef struct {0} {{\n{1}}} {0};".format(declaration.name, fields)
    if isinstance(declaration, Callback):
        return "typedef %s)(%s);" % (declare(declaration.result, "(*" + declaration.name), parameters(declaration))
    assert isinstance(declaration, Function)
    return "%s(%s);" % (declare(declaration.result, declaration.name), parameters(declaration))


def write_cdef(header):
    return "\n\n".join(["/* Written by bindings/generate from include/granperi/gp.h. Do not edit. */",
                        *map(write_declaration, header.declarations)]) + "\n"
