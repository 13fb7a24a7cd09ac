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

// A pair in the gradient's loop.
struct LanePair {
    Lanes weight, dx, dy; // ways from the lanes' particles to neighbour j
    Lanes wdx, wdy;       // weight times way
};

struct ExchangeView {
    const double *density;
    const double *flowing; // 1 or 0, or between them with the granular fluidity: at yield or stress-free
    // Of particles of one density: `flowing` times the excess over it; under pressure `flowing`, else 0.
    const double *excess_there, *bears_there;
    // Of several: the excess, 1 under pressure or 0, the material's own density.
    const double *excess, *bears, *rest, *inverse_rest;
    double rest_of_all; // that one density
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
    GP_INLINE void add(int32_t, const LanePair &) {}
    GP_INLINE void finish(const ExchangeView &v, int64_t i, int) const {
        if (v.change)
            v.change[i] = 0;
    }
};

// Beyond the largest pace particles are on top of each other: more neighbours than the time step counts on. One's own part of
// the pace, that of distance 0, does not count.
GP_INLINE double exchanged(const ExchangeView &v, int64_t i, double sum, double pace) {
    const double others = pace - 1;
    return v.rate * v.flowing[i] * (others > v.largest_pace ? v.largest_pace / others * sum : sum);
}

template <bool OneDensity> struct Exchange;

// Sum of w f_j (excess_j - excess_i - (rho_i + rho_j) b_j g.r / 2 c0^2), f whether j flows, b whether it bears pressure, with
// what does not depend on i taken together beforehand: six operations for a pair in place of nine.
template <> struct Exchange<true> {
    const double *__restrict densities, *__restrict flowing, *__restrict excess_there, *__restrict bears_there;
    Lanes density;
    Lanes pace{}, excesses{}, borne_x{}, borne_y{};

    GP_INLINE Exchange(const ExchangeView &v, const LanePlaces &places)
        : densities(v.density), flowing(v.flowing), excess_there(v.excess_there), bears_there(v.bears_there),
          density(places.load(v.density)) {}

    GP_INLINE void add(int32_t j, const LanePair &pair) {
        pace += pair.weight * flowing[j];
        excesses += pair.weight * excess_there[j];
        const Lanes borne = (density + densities[j]) * bears_there[j];
        borne_x += borne * pair.wdx;
        borne_y += borne * pair.wdy;
    }

    GP_INLINE void finish(const ExchangeView &v, int64_t i, int lane) const {
        const double excess = density[lane] - v.rest_of_all;
        // Weight counts between particles that both bear some.
        const double borne =
            excess > 0 ? 0.5 * (v.hydrostatic_x * borne_x[lane] + v.hydrostatic_y * borne_y[lane]) : 0.0;
        v.change[i] = exchanged(v, i, excesses[lane] - excess * pace[lane] - borne, pace[lane]);
    }
};

template <> struct Exchange<false> {
    const double *__restrict density, *__restrict excess, *__restrict flowing, *__restrict bears;
    const double *__restrict rest, *__restrict inverse_rest;
    Lanes own, own_density, own_rest, own_inverse, stretched;
    Lanes half_x, half_y;
    Lanes sum{}, pace{};

    GP_INLINE Exchange(const ExchangeView &v, const LanePlaces &places)
        : density(v.density), excess(v.excess), flowing(v.flowing), bears(v.bears), rest(v.rest),
          inverse_rest(v.inverse_rest), own(places.load(v.excess)), own_density(places.load(v.density)),
          own_rest(places.load(v.rest)), own_inverse(places.load(v.inverse_rest)), stretched(own * own_inverse) {
        const Lanes zero{};
        half_x = where(own > 0.0, zero + 0.5 * v.hydrostatic_x);
        half_y = where(own > 0.0, zero + 0.5 * v.hydrostatic_y);
    }

    GP_INLINE void add(int32_t j, const LanePair &pair) {
        const double other = excess[j];
        const Lanes borne = (own_density + density[j]) * bears[j] * (half_x * pair.dx + half_y * pair.dy);
        // The denser one's pace is stable. Stretched material counts in the lighter one's measure.
        const double other_rest = rest[j], other_inverse = inverse_rest[j];
        const Lanes lighter = own_rest < other_rest ? own_rest : Lanes{} + other_rest;
        const Lanes share = own_rest * (own_rest > other_rest ? own_inverse : Lanes{} + other_inverse);
        const Lanes there = other < 0 ? other * other_inverse * lighter : Lanes{} + other;
        const Lanes here = own < 0.0 ? stretched * lighter : own;
        const Lanes w = share * (pair.weight * flowing[j]);
        pace += w;
        sum += w * (there - here - borne);
    }

    GP_INLINE void finish(const ExchangeView &v, int64_t i, int lane) const {
        v.change[i] = exchanged(v, i, sum[lane], pace[lane]);
    }
};

} // namespace gp::stages
