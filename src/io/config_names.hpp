// The names of gp_config, for the files that keep it.
#pragma once

#include "granperi/gp.h"

namespace gp::io {

// A config that grows does not compile here: it needs the new names, and the checkpoint a new format.
template <class File, class Config> void exchange_config(File &file, Config &config) {
    auto &[struct_size, spacing, gravity_x, gravity_y, sound_speed, cfl, time_step, interaction_radius, horizon,
           horizon_length, nonlocal, stress, density, friction_factor, delta, collision_distance, zero_energy_penalty,
           density_diffusion, channel_width, channel_friction, periodic_x_min, periodic_x_max, threads, seed, jitter,
           preset, bulk_viscosity, implicit_tolerance, implicit_iterations, allow_unstable_step, retry_halvings,
           sleep] = config;
    (void)struct_size;
    file.value("spacing", spacing);
    file.value("gravity_x", gravity_x);
    file.value("gravity_y", gravity_y);
    file.value("sound_speed", sound_speed);
    file.value("cfl", cfl);
    file.value("time_step", time_step);
    file.value("interaction_radius", interaction_radius);
    file.value("horizon", horizon);
    file.value("horizon_length", horizon_length);
    file.value("nonlocal", nonlocal);
    file.value("stress", stress);
    file.value("density", density);
    file.value("friction_factor", friction_factor);
    file.value("delta", delta);
    file.value("collision_distance", collision_distance);
    file.value("zero_energy_penalty", zero_energy_penalty);
    file.value("density_diffusion", density_diffusion);
    file.value("channel_width", channel_width);
    file.value("channel_friction", channel_friction);
    file.value("periodic_x_min", periodic_x_min);
    file.value("periodic_x_max", periodic_x_max);
    file.value("threads", threads);
    file.value("seed", seed);
    file.value("jitter", jitter);
    file.value("preset", preset);
    file.value("bulk_viscosity", bulk_viscosity);
    file.value("implicit_tolerance", implicit_tolerance);
    file.value("implicit_iterations", implicit_iterations);
    file.value("allow_unstable_step", allow_unstable_step);
    file.value("retry_halvings", retry_halvings);
    file.value("sleep", sleep);
}

} // namespace gp::io
