// gp_state as a row of numbers: what a result file keeps of each frame beside the particles.
#pragma once

#include <vector>

#include "granperi/gp.h"
#include "io/frame_file.hpp"

namespace gp::io {

// All of gp_state but struct_size and wall_seconds, which is not the same in two runs.
template <class Visit> void for_each_observable(const gp_state &s, const Visit &visit) {
    static_assert(sizeof(gp_state) == 424); // a state that grows does not compile here: it needs the new names
    visit("time", "s", s.time);
    visit("step", "", static_cast<double>(s.step));
    visit("dt", "s", s.dt);
    visit("n_particles", "", static_cast<double>(s.n_particles));
    visit("n_awake", "", static_cast<double>(s.n_awake));
    visit("kinetic", "J m-1", s.kinetic);
    visit("potential", "J m-1", s.potential);
    visit("elastic", "J m-1", s.elastic);
    visit("dissipated", "J m-1", s.dissipated);
    visit("plate_work", "J m-1", s.plate_work);
    visit("energy_error", "J m-1", s.energy_error);
    visit("momentum_x", "kg s-1", s.momentum_x);
    visit("momentum_y", "kg s-1", s.momentum_y);
    visit("max_speed", "m s-1", s.max_speed);
    visit("rms_speed", "m s-1", s.rms_speed);
    visit("x_left", "m", s.x_left);
    visit("x_right", "m", s.x_right);
    visit("peak_x", "m", s.peak_x);
    visit("peak_height", "m", s.peak_height);
    visit("max_pressure", "Pa", s.max_pressure);
    visit("at_rest", "", s.at_rest);
    visit("collisions", "", static_cast<double>(s.collisions));
    visit("sound_speed", "m s-1", s.sound_speed);
    visit("penalty_dissipated", "J m-1", s.penalty_dissipated);
    visit("wall_dissipated", "J m-1", s.wall_dissipated);
    visit("diffusion_dissipated", "J m-1", s.diffusion_dissipated);
    visit("spacing_dissipated", "J m-1", s.spacing_dissipated);
    visit("bulk_dissipated", "J m-1", s.bulk_dissipated);
    visit("collision_dissipated", "J m-1", s.collision_dissipated);
    visit("channel_dissipated", "J m-1", s.channel_dissipated);
    visit("dt_reason", "", s.dt_reason);
    visit("implicit_last", "", s.implicit_last);
    visit("implicit_newton", "", static_cast<double>(s.implicit_newton));
    visit("implicit_linear", "", static_cast<double>(s.implicit_linear));
    visit("implicit_failures", "", static_cast<double>(s.implicit_failures));
    visit("implicit_residual", "", s.implicit_residual);
    visit("retries", "", static_cast<double>(s.retries));
    visit("dt_limit", "s", s.dt_limit);
    visit("max_compression", "", s.max_compression);
    visit("x_q01", "m", s.x_q01);
    visit("x_q05", "m", s.x_q05);
    visit("x_q25", "m", s.x_q25);
    visit("x_q50", "m", s.x_q50);
    visit("x_q75", "m", s.x_q75);
    visit("x_q95", "m", s.x_q95);
    visit("x_q99", "m", s.x_q99);
    visit("centre_x", "m", s.centre_x);
    visit("centre_y", "m", s.centre_y);
    visit("detached", "", s.detached);
    visit("volume_drift", "", s.volume_drift);
    visit("gravity_x", "m s-2", s.gravity_x);
    visit("gravity_y", "m s-2", s.gravity_y);
}

inline std::vector<Observable> state_observables() {
    std::vector<Observable> found;
    for_each_observable({}, [&](const char *name, const char *unit, double) { found.push_back({name, unit}); });
    return found;
}

inline std::vector<double> state_row(const gp_state &state) {
    std::vector<double> row;
    for_each_observable(state, [&](const char *, const char *, double value) { row.push_back(value); });
    return row;
}

} // namespace gp::io
