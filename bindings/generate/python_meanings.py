"""Writes granperi/_reference.py: type and meaning of each parameter and value, for the docstrings of the package."""

import keyword

from header import HeaderError
from python_words import ENUMS, Words

STRUCTS = ("gp_config", "gp_material", "gp_column", "gp_plate", "gp_output", "gp_state", "gp_load", "gp_plan_entry")
NUMBERS = {"double": "float", "int32_t": "int", "uint32_t": "int", "int64_t": "int", "uint64_t": "int", "char": "str"}
HEAD = '''"""What gp.h says of each parameter and value, in the names of this package: {struct: {name: (type, meaning)}}.

Written by bindings/generate from include/granperi/gp.h. Do not edit.
"""

MEANINGS: dict[str, dict[str, tuple[str, str]]] = {
'''


def type_of(struct, field):
    if "%s.%s" % (struct.name, field.name) in ENUMS:
        return ENUMS["%s.%s" % (struct.name, field.name)][0]
    if field.type.pointers and field.type.base == "double":
        return "np.ndarray | None"
    return NUMBERS[field.type.base]


def fields_of(struct, header):
    """[(Python's name, field, meaning)]; fields that share a comment have it each, an empty one is an error."""
    words, found = Words(header), []
    for field in struct.fields:
        if field.name in ("struct_size", "reserved"):
            continue
        found.append([field.name + "_" * keyword.iskeyword(field.name), field, words.of(field.doc)])
    for name, field, doc in found:
        if not doc:
            raise HeaderError("%s.%s has no comment" % (struct.name, name))
    return found


def write_reference(header):
    lines = [HEAD.rstrip("\n")]
    for name in STRUCTS:
        struct = header.struct(name)
        lines.append("    %s: {" % quoted(name))
        for own, field, doc in fields_of(struct, header):
            lines.append("        %s: (%s,%s)," % (quoted(own), quoted(type_of(struct, field)), pieces(doc)))
        lines.append("    },")
    return "\n".join([*lines, "}", ""])


def quoted(text):
    return '"%s"' % text.replace("\\", "\\\\").replace('"', '\\"')


def pieces(text, width=104, margin=12):
    """The text as literals that Python joins, each in a line of its own where it is long."""
    if len(text) < 60:
        return " " + quoted(text)
    lines, line = [], ""
    for word in text.split(" "):
        if line and len(line) + len(word) > width:
            lines.append(line)
            line = ""
        line += word + " "
    lines.append(line.rstrip())
    return "\n" + "\n".join(" " * margin + quoted(line) for line in lines)
