"""The header's comments in the words of the Python package: keyword objects for structs, names for constants, exceptions
for statuses."""

import re

from header import Constants

OBJECTS = {"gp_config": "Config", "gp_material": "Material", "gp_column": "Column", "gp_plate": "Plate", "gp_state": "State",
           "gp_load": "Load", "gp_plan_entry": "PlanEntry", "gp_particles": "Particles", "gp_output": "Output"}
EXCEPTIONS = {"GP_E_ARGUMENT": "ArgumentError", "GP_E_STATE": "StateError", "GP_E_MEMORY": "OutOfMemoryError",
              "GP_E_IO": "FileError", "GP_E_DIVERGED": "DivergedError", "GP_E_UNSUPPORTED": "UnsupportedError",
              "GP_E_VERSION": "VersionError", "GP_E_INTERNAL": "InternalError"}
# Fields that are one of an enumeration of the package, and what its constants begin with in C.
ENUMS = {"gp_config.stress": ("Stress", "GP_STRESS_"), "gp_config.density": ("Density", "GP_DENSITY_"),
         "gp_config.preset": ("Preset", "GP_PRESET_"), "gp_column.initial_pressure": ("InitialPressure", "GP_INITIAL_"),
         "gp_plate.friction": ("Wall", "GP_WALL_"), "gp_plate.fluidity": ("Fluidity", "GP_FLUIDITY_"),
         "gp_state.dt_reason": ("StepLimit", "GP_DT_")}
CALLS = {"gp_set_gravity": "Simulation.set_gravity", "gp_set_plate_motion": "Simulation.set_plate_motion",
         "gp_get_plan": "Simulation.plan", "gp_get_surface": "Simulation.surface", "gp_add_material": "Simulation.add_material",
         "gp_run": "Simulation.run", "gp_output_open": "Simulation.output", "gp_output_write": "Output.write",
         "gp_create": "Simulation", "gp_config_init": "Config(preset)"}


class Words:
    def __init__(self, header):
        self.constants = {name: (value, doc) for group in header.of(Constants) for name, value, doc in group.values}

    def of(self, doc):
        """A comment in Python's names."""
        doc = re.sub(r"(GP_[A-Z]+_)\.\.\.", lambda m: self.choices(m.group(1)) or m.group(0), doc)
        doc = re.sub(r"\[(GP_[A-Z0-9_]*[A-Z0-9])\]", lambda m: "[%s]" % self.constant(m.group(1), True), doc)
        doc = re.sub(r"\bGP_[A-Z0-9_]*[A-Z0-9]\b", lambda m: self.constant(m.group(0)), doc)
        doc = re.sub(r"\b(gp_\w+)\.(\w+)", lambda m: "%s.%s" % (OBJECTS.get(m.group(1), m.group(1)), m.group(2)), doc)
        doc = re.sub(r"\bgp_\w+", lambda m: CALLS.get(m.group(0), OBJECTS.get(m.group(0), m.group(0))), doc)
        return doc.replace("NULL", "None")

    def choices(self, prefix):
        if not any(prefix == of for _, of in ENUMS.values()):
            return None
        return "one of " + ", ".join('"%s"' % name[len(prefix):].lower() for name in self.constants if name.startswith(prefix))

    def constant(self, name, alone=False):
        """alone: as a value of its own field."""
        if name in EXCEPTIONS:
            return EXCEPTIONS[name]
        for enumeration, prefix in ENUMS.values():
            if name.startswith(prefix):
                return '"%s"' % name[len(prefix):].lower() if alone else "%s.%s" % (enumeration, name[len(prefix):])
        return name
