"""Writes the Fortran module of what grows with the header: constructors with keywords, and views of the library's arrays.

  a struct with an _init function   gp_column(width=..., height=...): the library's defaults, then what was given. Arrays
                                    within a struct (a plate's table) are no keywords: they go to the call that takes it
  a struct of const pointers with   a type with array pointers of shape (count) in place of C pointers
  a count
Public are these, the other structs as they are, and every constant. Not public are functions, and structs that point to
text: the module on top has its own.
"""

from fortran_raw import Names, argument_list, comment, with_doc
from header import Alias, Constants, HeaderError, Struct

COMMON = {"status": "integer(c_int32_t), intent(out), optional :: status",
          "message": "character(*), intent(out), optional :: message"}


def is_view(struct):
    return any(field.name == "count" for field in struct.fields) and any(
        field.type.pointers == 1 and field.type.const and field.type.base != "char" for field in struct.fields)


def has_text(struct):
    return any(field.type.base == "char" for field in struct.fields)


def write_constructor(names, struct, init):
    """init: S_init(S *, size_t, further): the further ones come first, and are 0 if they are not given."""
    further = [(parameter.name, names.value(parameter.type)) for parameter in init.parameters[2:]]
    given = [name for name, _ in further]
    fields = [field for field in struct.fields
              if field.name not in ("struct_size", *given) and field.type.pointers == 0 and
              not is_length(field, struct)]
    keywords = given + [field.name for field in fields]
    if {"status", "message", "made", "answer"} & set(keywords):
        raise HeaderError("%s has a field whose name the constructor needs" % struct.name)
    pad = " " * 8
    lines = comment("The library's defaults, but for what is given, by keyword: the order may change.", 4, "!>")
    lines += argument_list([*keywords, *COMMON], "    function new_%s" % struct.name, " result(made)")
    lines += ["%s%s, intent(in), optional :: %s" % (pad, kind, name) for name, kind in further]
    for field in fields:
        lines += with_doc("%s%s, intent(in), optional :: %s" % (pad, names.value(field.type), field.name), field.doc)
    lines += [pad + line for line in COMMON.values()]
    lines += ["%stype(%s) :: made" % (pad, struct.name), pad + "integer(c_int32_t) :: answer"]
    lines += ["%s%s :: init_%s" % (pad, kind, name) for name, kind in further]
    for name in given:
        lines += ["%sinit_%s = 0" % (pad, name), "%sif (present(%s)) init_%s = %s" % (pad, name, name, name)]
    arguments = ["made", "c_sizeof(made)"] + ["init_" + name for name in given]
    lines += ["%sanswer = %s(%s)" % (pad, init.name, ", ".join(arguments)),
              '%scall report("%s", answer, status, message)' % (pad, struct.name), pad + "if (answer < 0) return"]
    lines += ["{0}if (present({1})) made%{1} = {1}".format(pad, field.name) for field in fields]
    return lines + ["    end function", ""]


def is_length(field, struct):
    """n_knots, which belongs to knot_t: n_ and the name of arrays."""
    stem = field.name[2:].rstrip("s")
    return field.name.startswith("n_") and any(
        other.type.pointers and other.name.startswith(stem + "_") for other in struct.fields)


def write_view_type(names, struct):
    lines = comment("What the library holds, not copied: read it, do not write it. " + struct.doc, 4, "!>")
    lines += ["    type :: " + struct.name]
    for field in struct.fields:
        if field.name == "struct_size":
            continue
        if field.type.pointers:
            number = names.number(field.type._replace(pointers=0))
            line = "        %s, pointer, contiguous :: %s(:) => null()" % (number, field.name)
        else:
            line = "        %s :: %s = 0" % (names.value(field.type), field.name)
        lines += with_doc(line, field.doc)
    return lines + ["    end type", ""]


def write_view(struct):
    pad = " " * 8
    lines = ["    subroutine view_%s(raw, view)" % struct.name, "%stype(raw_%s), intent(in) :: raw" % (pad, struct.name),
             "%stype(%s), intent(out) :: view" % (pad, struct.name)]
    for field in struct.fields:
        if field.name == "struct_size":
            continue
        if field.type.pointers:
            lines.append("{0}if (c_associated(raw%{1})) call c_f_pointer(raw%{1}, view%{1}, [raw%count])"
                         .format(pad, field.name))
        else:
            lines.append("{0}view%{1} = raw%{1}".format(pad, field.name))
    return lines + ["    end subroutine", ""]


def write_types(header):
    names = Names(header)
    structs = header.of(Struct)
    views = [struct for struct in structs if is_view(struct)]
    constructors = [(struct, header.function(struct.name + "_init")) for struct in structs
                    if header.function(struct.name + "_init")]
    lines = ["! Written by bindings/generate from include/granperi/gp.h. Do not edit.", "",
             "!> Constructors of the structs that the library takes, views of those that it fills, and the constants.",
             "module granperi_types",
             "    use granperi_raw, %s" % ", ".join("raw_{0} => {0}".format(view.name) for view in views),
             "    use granperi_status, only: report", "    implicit none", "    private"]
    public = [struct.name for struct in structs if not has_text(struct)] + ["raw_" + view.name for view in views]
    public += ["view_" + view.name for view in views]
    lines += ["    public :: " + name for name in public]
    lines += ["    public :: " + item.name for item in header.of(Alias)]
    for item in header.of(Constants):
        lines += ["    public :: " + name for name, _, _ in item.values]
    lines += [""]
    for view in views:
        lines += write_view_type(names, view)
    for struct, _ in constructors:
        lines += ["    interface " + struct.name, "        module procedure new_" + struct.name, "    end interface", ""]
    lines += ["contains", ""]
    for struct, init in constructors:
        lines += write_constructor(names, struct, init)
    for view in views:
        lines += write_view(view)
    lines[-1] = "end module"
    return "\n".join(lines) + "\n"
