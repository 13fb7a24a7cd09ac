// The sums of the density diffusion (density_diffusion.cpp) over pairs, lane by lane: added up in the pair loop of the
// gradient, whose weights they share.
#pragma once

#include "lanes.hpp"
#include "world.hpp"

namespace gp::stages {

// Of the granular fluidity (fluidity_exchange.hpp); empty without.
struct FluidityView {
    const double *seen = nullptr, *bears = nullptr; // 1/s, 0 without pressure; 1 under pressure, else 0
    double *pull = nullptr, *pace = nullptr;
};

struct ExchangeView {
    const double *density, *excess;    // excess over the material's own density
    const double *flowing, *bears;     // 1 or 0: at yield or stress-free; under pressure
    const double *rest, *inverse_rest; // the material's own density; only where there are several
    double rate;
    double hydrostatic_x, hydrostatic_y; // g / c0^2, 1/m
    double largest_pace;                 // sum of w
    bool one_density;
    double *change;
    FluidityView fluidity = {};
};

// Fills what neighbours are read of.
ExchangeView prepare_exchange(World &world);

struct NoExchange {
    GP_INLINE NoExchange(const ExchangeView &, const LanePlaces &) {}
    GP_INLINE void add(int32_t, const Lanes &, const Lanes &, const Lanes &) {}
    GP_INLINE void finish(const ExchangeView &v, int64_t i, int) const {
        if (v.change)
            v.change[i] = 0;
    }
};

template <bool OneDensity> struct Exchange {
    const double *__restrict density, *__restrict excess, *__restrict flowing, *__restrict bears;
    const double *__restrict rest, *__restrict inverse_rest;
    Lanes own, own_density, own_rest{}, own_inverse{}, stretched{};
    Lanes half_x, half_y; // weight counts between particles that both bear some
    Lanes sum{}, pace{};

    GP_INLINE Exchange(const ExchangeView &v, const LanePlaces &places)
        : density(v.density), excess(v.excess), flowing(v.flowing), bears(v.bears), rest(v.rest),
          inverse_rest(v.inverse_rest), own(places.load(v.excess)), own_density(places.load(v.density)) {
        const Lanes zero{};
        half_x = where(own > 0.0, zero + 0.5 * v.hydrostatic_x);
        half_y = where(own > 0.0, zero + 0.5 * v.hydrostatic_y);
        if (!OneDensity) {
            own_rest = places.load(rest);
            own_inverse = places.load(inverse_rest);
            stretched = own * own_inverse;
        }
    }

    GP_INLINE void add(int32_t j, const Lanes &weight, const Lanes &dx, const Lanes &dy) {
        const Lanes w = weight * flowing[j];
        const double other = excess[j];
        const Lanes borne = (own_density + density[j]) * bears[j] * (half_x * dx + half_y * dy);
        if (OneDensity) {
            pace += w;
            sum += w * (other - own - borne);
            return;
        }
        // The denser one's pace is stable. Stretched material counts in the lighter one's measure.
        const double other_rest = rest[j], other_inverse = inverse_rest[j];
        const Lanes lighter = own_rest < other_rest ? own_rest : Lanes{} + other_rest;
        const Lanes share = own_rest * (own_rest > other_rest ? own_inverse : Lanes{} + other_inverse);
        const Lanes there = other < 0 ? other * other_inverse * lighter : Lanes{} + other;
        const Lanes here = own < 0.0 ? stretched * lighter : own;
        pace += share * w;
        sum += share * w * (there - here - borne);
    }

    GP_INLINE void finish(const ExchangeView &v, int64_t i, int lane) const {
        // Beyond this particles are on top of each other: more neighbours than the time step counts on. One's own part of
        // the pace, that of distance 0, does not count.
        const double others = pace[lane] - 1;
        const double exchanged = others > v.largest_pace ? v.largest_pace / others * sum[lane] : sum[lane];
        v.change[i] = v.rate * flowing[i] * exchanged;
    }
};

} // namespace gp::stages
