// The scene in a checkpoint: config, materials, bodies, plates as the host gave them. A loaded scene is made of them by the
// calls that the host makes, with their checks.
#pragma once

#include <functional>

#include "io/checkpoint_checks.hpp"
#include "sim.hpp"

namespace gp::io {

void write_scene(CheckpointWriter &file, const Scene &scene);

// create: as of load_checkpoint.
Sim &read_scene(CheckpointReader &file, const Checker &check, const std::function<Sim &(const gp_config &)> &create);

} // namespace gp::io
