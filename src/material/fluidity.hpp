// Granular fluidity: the non-locality of the grains (Kamrin & Koval 2012; Henann & Kamrin 2013; in time Kamrin & Henann 2015).
// The flow rule is gamma = g mu, mu = tau / p, gamma the plastic shear rate 2 |D|, and the fluidity g (1/s) follows
//
//   t0 dg/dt = A^2 d^2 lap g - (mu_2 - mu_s) (mu_s - mu) / (mu_2 - mu) g - b d sqrt(rho_s / p) mu g^2,
//
// b = (mu_2 - mu_s) / I0, so that uniform steady flow is the mu(I) law of return_map.hpp. One step, implicit in all that is
// the particle's own: with K = t0 / dt + pace and c = t0 / dt g + pull (sums over neighbours, stages/fluidity.cpp), stress and
// fluidity at its end are the largest root of
//
//   K g - c + (mu_2 - mu_s) (mu_s - mu) / (mu_2 - mu) g + B mu g^2 = 0,  mu = mu_trial / (1 + a g),  a = G dt / p,
//   B = b d sqrt(rho_s / p).
//
// Multiplied by mu_2 (1 + a g) - mu_trial it is convex from its pole on: Newton's steps from above never pass the root, and
// no step is too long.
#pragma once

#include "material/return_map.hpp"

namespace gp {

struct Fluidity {
    // In rate_factor sqrt(p), the fluidity of I = I0 mu: what bears more than mu_s is kept from 0, which nothing would leave,
    // by the first; what bears no more comes to rest below the second.
    static constexpr double seed = 1e-6, arrest = 1e-8;
    static constexpr double converged = 1e-10; // of g, in a Newton step
    static constexpr int most_steps = 60;      // they halve the distance to the pole at least

    // The fluidity after the step. trial: equivalent stress, Pa; pressure > 0; inertia and carried: K, 1, and c, 1/s.
    static GP_INLINE Lanes after(const ReturnMapOf<Lanes> &map, const Lanes &trial, const Lanes &pressure, double dt,
                                 const Lanes &inertia, const Lanes &carried) {
        const Lanes one = Lanes{} + 1.0;
        const Lanes mu = trial / pressure, a = map.shear_modulus * dt / pressure;
        const Lanes unit = map.half_rate(pressure), span = map.mu_2 - map.mu_s, drag = span / unit;
        const auto above = mu > map.mu_s;
        const Lanes least = inertia * seed * unit;
        const Lanes c = choose(above & (carried < least), least, carried);
        // Bounds from above: where mu has come down to mu_s, and without growth; where it does not grow by itself, one more.
        const Lanes at_mu_s = where(above, (mu / map.mu_s - one) / a), free = c / inertia;
        Lanes g = choose(at_mu_s > free, at_mu_s, free);
        const Lanes left = inertia - span * (mu - map.mu_s) / (map.mu_2 - mu), slow = c / left;
        g = choose((mu < map.mu_2) & (left > 0.0) & (slow < g), slow, g);
        for (int k = 0; k < most_steps; ++k) {
            const Lanes q = one + a * g, m = mu / q;
            const Lanes pole = map.mu_2 * q - mu, below = map.mu_s * q - mu, balance = inertia * g - c;
            const Lanes value = balance * pole + span * g * below + drag * mu * g * g * (map.mu_2 - m);
            const Lanes slope = inertia * pole + balance * map.mu_2 * a + span * (below + g * map.mu_s * a) +
                                drag * mu * (2.0 * g * (map.mu_2 - m) + g * g * m * a / q);
            const Lanes step = value / slope;
            const auto moves = (step > converged * g) & (slope > 0.0);
            g -= where(moves, step);
            if (sum_of(where(moves, one)) == 0)
                break;
        }
        g = where((g >= arrest * unit) | above, g);
        return where(g > 0.0, g);
    }

    // The fluidity of what bears no pressure: that of its rate at the largest friction.
    static GP_INLINE Lanes without_pressure(const ReturnMapOf<Lanes> &map, const Lanes &rate) {
        return rate / map.mu_2;
    }
};

} // namespace gp
