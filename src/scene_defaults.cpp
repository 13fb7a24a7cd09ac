// Defaults of every struct that describes a scene.
#include <cmath>

#include "check.hpp"
#include "scene.hpp"

namespace gp {

namespace {
const double degree = std::acos(-1.0) / 180.0;
}

gp_config default_config(int32_t preset) {
    require_choice("preset", preset, 3);
    gp_config config{};
    config.struct_size = sizeof config;
    config.preset = preset;
    config.spacing = 0.0025;
    config.gravity_y = -9.81;
    config.interaction_radius = 4;
    config.horizon = 4;
    config.nonlocal = 1;
    config.stress = GP_STRESS_ELASTIC;
    config.density = GP_DENSITY_CONTINUITY;
    config.friction_factor = 1;
    config.delta = 1e-6;
    config.collision_distance = 0.9;
    config.zero_energy_penalty = 0.02;
    config.density_diffusion = 0.2;
    config.bulk_viscosity = 0.1;
    config.implicit_tolerance = 1e-5;
    config.implicit_iterations = 100;
    config.threads = 1;
    if (preset != GP_PRESET_DEFAULT) {
        config.density_diffusion = 0;
        config.bulk_viscosity = 0;
        config.density = GP_DENSITY_NUMBER;
        config.stress = GP_STRESS_REGULARIZED;
        config.zero_energy_penalty = 0;
        config.friction_factor = preset == GP_PRESET_PAPER ? 2 : 1;
        config.nonlocal = preset == GP_PRESET_PAPER ? 1 : 0;
    }
    return config;
}

gp_material default_material() {
    gp_material material{};
    material.struct_size = sizeof material;
    material.grain_density = 2500;
    material.volume_fraction = 0.62;
    material.grain_diameter = 0.002;
    material.mu_s = std::tan(21 * degree);
    material.mu_2 = std::tan(32 * degree);
    material.i0 = 0.3;
    material.fluidity_time = 1e-4;
    return material;
}

gp_column default_column() {
    gp_column column{};
    column.struct_size = sizeof column;
    return column;
}

gp_plate default_plate() {
    gp_plate plate{};
    plate.struct_size = sizeof plate;
    return plate;
}

} // namespace gp
