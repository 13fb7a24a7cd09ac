"""Writes the list of the interface's functions for src/levels: result, name, parameters and arguments of each."""

from cdef import declare, parameters
from header import Function

LINE = 120


def write_call(function):
    names = ", ".join(parameter.name for parameter in function.parameters)
    pieces = [declare(function.result, "").rstrip() + ",", function.name + ",", "(%s)," % parameters(function), "(%s))" % names]
    text = "GP_CALL("
    column = len(text)
    for piece in pieces:  # gp.h's lines are as long, so a piece alone fits
        if column + len(piece) > LINE:
            text = text.rstrip() + "\n        "
            column = 8
        text += piece + " "
        column += len(piece) + 1
    return text.rstrip()


def write_calls(header):
    return "\n".join(["// Written by bindings/generate from include/granperi/gp.h. Do not edit.",
                      *map(write_call, header.of(Function))]) + "\n"
