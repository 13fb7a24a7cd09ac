// The pressure that the yield stress of GP_STRESS_IMPLICIT goes by.
#pragma once

#include "world.hpp"

namespace gp::stages {

// Of each particle, where it and the plates are now, from its pressure as it is now: into world.viscous.pressure.
void find_yield_pressure(World &world);

} // namespace gp::stages
