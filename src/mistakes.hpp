// What a scene has most likely got wrong, in words that say what to change: plates turned over, material where no plate acts on
// it, nothing to fall on. Told through the log (warnings.hpp).
#pragma once

#include <string>
#include <vector>

#include "world.hpp"

namespace gp {

// Before the first step; the lists are made.
std::vector<std::string> scene_mistakes(const World &world);

// Particles within `margin` (m) of a plate's wetted line, on either side.
int64_t count_on_lines(const World &world, double margin);

// Particles that fall below all plates, once there are any; else an empty text.
std::string lost_particles(const World &world);

} // namespace gp
