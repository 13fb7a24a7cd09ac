"""What the page of a Fortran call has: syntax, arguments with type, intent, unit and range, errors, an example, other languages."""
import c_calls
import text

# Where an argument is not what it is in C (c_calls.py), by name and by CALL.NAME.
ARGUMENTS = {
    "status": "GP_OK, GP_STOPPED, or the negative GP_E_... of an error. With it, or with message, an error does not end the program",
    "message": "blank, or what was wrong, cut to its length: 300 is enough",
    "id": "number of what was added", "fields": "GP_FIELD_... added up; not given: all", "parts": "GP_STATE_... added up, or 0; not "
    "given: all. Values of the others are NaN", "field": "one GP_FIELD_...", "path": "of the file; blanks at its end do not count",
    "context": "the host's own variable, with target; it has to outlive the procedure. Not given: the procedure gets a pointer that is "
    "not associated", "procedure": "of a module, with the interface said below", "config": "gp_config(...); not given: defaults",
    "output": "gp_output(...): what to write and when; not given: defaults", "every": "steps between two calls; at least 1",
    "time": "s, the clock", "dt": "s, the last time step; 0 before the first", "step": "number of steps taken",
    "knot_t": "s, shape (n), increasing: times of the table of the plate's motion", "knot_x": "m, shape (n): displacement then",
    "knot_y": "m, shape (n): displacement then", "knot_angle": "rad, shape (n), counter-clockwise: turn about the pivot then",
    "point_x": "m, shape (n), n at least 2: the line of the plate, its body on the left of the way", "point_y": "m, shape (n), with point_x",
    "material": "number of the material, 0 .. number of materials - 1; not given: 0", "view": "what sim%particles has given",
    "values": "one value per particle, shape (n), in the units of the field", "name": "e.g. \"hdf5\"",
}
OF_CALL = {
    "add_material.material": "gp_material(...)", "add_column.column": "gp_column(...)", "add_plate.plate": "gp_plate(...)",
    "add_material.id": "number of the new material, from 1 on", "add_column.id": "number of the column, from 0 on, counted together with "
    "sets of particles", "add_particles.id": "number of the set, from 0 on, counted together with columns",
    "add_plate.id": "number of the plate, from 0 on", "add_particles.vx": "m/s, shape (n), finite; not given, with vy: at rest",
    "add_particles.vy": "m/s, shape (n), finite", "step.n": "number of steps; at least 0; a default integer or one of the kind gp_int64",
}
RESULTS = {"is_created": "true after create or load, and before destroy", "state": "the state; its fields: gp_state",
           "particles": "pointers to the arrays; its fields: gp_particles", "is_current": "false once the simulation has changed",
           "copy": "shape (n), in the order of id and the units of the field; after an error of length 0",
           "surface": "m, shape (size(x)): heights; 0 outside the deposit",
           "interface_between": "m, shape (size(y)): positions; NaN where they do not touch", "plate_load": "the load; its fields: gp_load",
           "plan": "an entry per stage, field and table; its fields: gp_plan_entry", "version_string": "e.g. 0.1.0",
           "has_feature": "whether the build has it", "status_string": "the text"}
PROCEDURES = {"set_callback": "gp_on_step", "set_log": "gp_on_log"}


class CallError(Exception):
    """An argument that the reference does not know."""


def kinds_of(declaration):
    """(type, how it is passed) of a declaration: real(c_double), intent(in), optional, shape (:)."""
    parts = declaration.replace("c_double", "gp_real").replace("integer(c_int64_t)", "integer(gp_int64)").replace(
        "integer(c_int32_t)", "integer").split(", ")
    shape = [part.removeprefix("shape ") for part in parts if part.startswith("shape")]
    intent = next((part[7:-1] for part in parts if part.startswith("intent")), "in")
    passed = {"in": "given", "out": "received", "inout": "changed"}[intent] + (", may be left out" if "optional" in parts else "")
    return parts[0] + "".join(shape), passed


def meaning_of(call, argument, function):
    for key, table in (("%s.%s" % (call, argument), OF_CALL), (argument, ARGUMENTS), ("%s.%s" % (function, argument), c_calls.OF_CALL),
                       (argument, c_calls.ARGUMENTS)):
        if key in table:
            return table[key]
    raise CallError("docs/site/fortran_calls.py: nothing is said of %s of %s" % (argument, call))


def argument_table(call, procedure, function, roles):
    arguments = [argument for argument in procedure.arguments if argument != "self"]
    lines = [".. list-table:: Arguments", "   :widths: 16 24 18 42", "   :header-rows: 1", "",
             "   * - argument", "     - type", "     - ", "     - what it is: unit, shape, range"]
    for argument in arguments:
        kind, passed = kinds_of(procedure.declarations[argument])
        lines += ["   * - ``%s``" % argument, "     - ``%s``" % kind, "     - " + passed,
                  "     - " + text.linked(meaning_of(call, argument, function), roles)]
    lines = [*lines, ""] if arguments else []
    if procedure.result:
        if call not in RESULTS:
            raise CallError("docs/site/fortran_calls.py: nothing is said of the result of %s" % call)
        kind, _ = kinds_of(procedure.declarations[procedure.result])
        lines += ["Result: ``%s``, %s." % (kind.split("(size")[0], text.linked(RESULTS[call], roles)), ""]
    if call in PROCEDURES:
        lines += ["The interface of ``procedure`` is that of :doc:`%s <procedures>`." % PROCEDURES[call], ""]
    return lines


def example_lines(call, is_function):
    pattern = r"\bsim%%%s\(" % call if is_function else r"\bcall sim%%%s\(" % call
    example = c_calls.example_of(pattern, (("examples/fortran", ".f90"), ("docs/guide", ".md")), "fortran")
    if example is None:
        return []
    code, where = example
    return [".. rubric:: Example", "", "From :doc:`%s`:" % where, "", ".. code-block:: fortran", "", *text.indented(code.split("\n")), ""]
