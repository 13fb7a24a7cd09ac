#!/usr/bin/env python3
"""Files of src/ may include those of earlier layers and their own, never a later one: read the includes and check."""
import pathlib
import re
import sys

LAYERS = [
    ["granperi/gp", "error", "check", "entry", "float_environment", "inline", "level", "parallel"],
    ["geometry", "kernel", "lanes", "material/number_density_state", "material/regularized", "material/return_map", "material/compression", "material/fluidity", "material/linearized"],
    ["scene", "scene_constants", "scene_defaults", "scene_falls", "scene_plates", "scene_stress"],
    ["exact_sum", "binned_sum", "crossing", "particles"],
    ["sleep"],
    ["viscous_system"],
    ["neighbors"],
    ["halo", "shift_tiles"],
    ["periodic"],
    ["segment_cells"],
    ["clusters", "cluster_rows"],
    ["plate"],
    ["facet_chains"],
    ["sight"],
    ["mps_operators", "operators", "walls", "wall_lanes"],
    ["mirrors"],
    ["world", "awake", "ledger", "undo", "volume_drift", "parts", "stretches"],
    ["stages/*"],
    ["plan", "plan_implicit", "plan_paper", "stage_rows", "mistakes", "warnings"],
    ["sim", "sim_scene"],
    ["sort_by_x", "fields", "diagnostics", "diagnostics_mass", "diagnostics_rest", "diagnostics_shape", "diagnostics_surface", "io/*"],
    ["handle"],
    ["api", "api_read", "load_symbol", "without_mpi", "granperi/gp_mpi", "mpi/*"],
    ["levels/*"],
]


def layer_of(name):
    for number, names in enumerate(LAYERS):
        if name in names or (name.rpartition("/")[0] + "/*") in names:
            return number
    sys.exit(f"{name}: in no layer; add it to LAYERS in {__file__}")


def main(source):
    wrong = 0
    for path in sorted([*source.rglob("*.hpp"), *source.rglob("*.cpp")]):
        own = str(path.relative_to(source).with_suffix(""))
        for included in re.findall(r'^#include "([^"]+)\.(?:hpp|h)"', path.read_text(), re.M):
            if layer_of(included) > layer_of(own):
                print(f"{own} includes {included}, of a later layer")
                wrong += 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
