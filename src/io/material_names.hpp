// The numbers of a gp_material by their names, for the files that keep it.
#pragma once

#include "granperi/gp.h"

namespace gp::io {

// A material that grows does not compile here: it needs the new names, and the checkpoint a new format.
inline constexpr auto for_each_of_material = [](const auto &visit) {
    static_assert(sizeof(gp_material) == 80);
    visit("grain_density", &gp_material::grain_density);
    visit("volume_fraction", &gp_material::volume_fraction);
    visit("grain_diameter", &gp_material::grain_diameter);
    visit("mu_s", &gp_material::mu_s);
    visit("mu_2", &gp_material::mu_2);
    visit("i0", &gp_material::i0);
    visit("nonlocal_amplitude", &gp_material::nonlocal_amplitude);
    visit("fluidity_time", &gp_material::fluidity_time);
    visit("k0", &gp_material::k0);
};

} // namespace gp::io
