// The sums of the granular fluidity (fluidity.cpp) over pairs, lane by lane, in the pair loop of the gradient, beside those of
// the density diffusion.
#pragma once

#include "stages/density_exchange.hpp"

namespace gp::stages {

// Fills what neighbours are read of.
FluidityView prepare_fluidity(World &world);

template <class Densities> struct AndFluidity : Densities {
    const double *__restrict seen, *__restrict bears_pressure;
    Lanes fluid_pull{}, fluid_pace{};

    GP_INLINE AndFluidity(const ExchangeView &v, const LanePlaces &places)
        : Densities(v, places), seen(v.fluidity.seen), bears_pressure(v.fluidity.bears) {}
    GP_INLINE void add(int32_t j, const LanePair &pair) {
        Densities::add(j, pair);
        fluid_pull += pair.weight * seen[j];
        fluid_pace += pair.weight * bears_pressure[j];
    }
    GP_INLINE void finish(const ExchangeView &v, int64_t i, int lane) const {
        Densities::finish(v, i, lane);
        v.fluidity.pull[i] = fluid_pull[lane] - seen[i]; // less one's own
        v.fluidity.pace[i] = fluid_pace[lane] - bears_pressure[i];
    }
};

// What is summed up for a cluster in which no density is exchanged.
template <class Exchange> struct Idle { using Sums = NoExchange; };
template <class Densities> struct Idle<AndFluidity<Densities>> { using Sums = AndFluidity<NoExchange>; };

} // namespace gp::stages
