// Checkpoints: all of a simulation in one file, from which it goes on bit for bit.
#pragma once

#include <functional>
#include <string>

#include "io/output.hpp"
#include "sim.hpp"

namespace gp::io {

// The new file, or the old one of that name; never a part of it. position: of the open output, if any. Throws gp::Error;
// GP_E_UNSUPPORTED in a build without HDF5. The simulation is only read. world: NULL before the first step. Of several processes
// each has its part, and position is that of the first; collective.
void save_checkpoint(const std::string &path, const Sim &sim, const World *world, const OutputPosition &position);

// create: makes the simulation of a config that has been read, before the rest is put into it. All numbers are checked as
// those of a host; throws gp::Error, GP_E_IO or GP_E_VERSION for a file that is no good. crossing: of the simulation; NULL for a
// process alone.
void load_checkpoint(const std::string &path, Crossing *crossing, const std::function<Sim &(const gp_config &)> &create,
                     OutputPosition &position);

} // namespace gp::io
