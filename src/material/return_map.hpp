// Elastic trial and return map of the mu(I) law (Dunatunga & Kamrin 2015): pure functions of one particle.
//
// The law is mu(I) = mu_s + (mu_2 - mu_s) / (I0/I + 1) with I = 2 d |gamma| / sqrt(p/rho_s), whose pressure may be a mean of p
// (stages/stress.cpp); the equivalent shear stress tau = sqrt(s:s/2) never exceeds mu(I) p. Inside the yield surface the material
// is elastic: it does not flow.
#pragma once

#include "lanes.hpp"

namespace gp {

// Deviatoric stress in two dimensions: sxx = -syy and sxy. Pa. Number: double, or Lanes for four particles at once.
template <class Number> struct DeviatorOf { Number xx, xy; };
using Deviator = DeviatorOf<double>;

GP_INLINE double equivalent_stress(const Deviator &s) {
    return root(s.xx * s.xx + s.xy * s.xy);
}
template <class Number>
GP_INLINE Number equivalent_stress(const DeviatorOf<Number> &s) { // of Lanes: {a, b} is the first
    return root(s.xx * s.xx + s.xy * s.xy);
}

// Rotation of the stress with the material (Jaumann rate over one step), by the Cayley form of the rotation, which keeps
// the magnitude exactly. spin = (du_x/dy - du_y/dx) / 2 in 1/s.
template <class Number>
GP_INLINE DeviatorOf<Number> rotate(const DeviatorOf<Number> &s, const Number &spin, double dt) {
    const Number t = spin * dt;
    const Number scale = 1.0 / (1.0 + t * t);
    const Number cosine = (1.0 - t * t) * scale, sine = 2.0 * t * scale;
    return {cosine * s.xx + sine * s.xy, cosine * s.xy - sine * s.xx};
}

// One material's constants for the map.
template <class Number> struct ReturnMapOf {
    Number mu_s, mu_2;    // already multiplied by friction_factor
    Number rate_factor;   // I0 / (d sqrt(rho_s)), so that I0/I = rate_factor sqrt(p of I) G dt / (tau_trial - tau)
    Number shear_modulus; // G, Pa

    // Equivalent stress after the step from its elastic trial value, the root of
    // (tau - mu_s p)(alpha + trial - tau) = (mu_2 - mu_s) p (trial - tau), alpha = rate_factor G dt sqrt(p of I).
    GP_INLINE Number yielded(const Number &trial, const Number &pressure, const Number &pressure_of_rate,
                             double dt) const {
        const Number s_s = mu_s * pressure, s_2 = mu_2 * pressure;
        const Number alpha = rate_factor * shear_modulus * dt * root(pressure_of_rate);
        const Number b = s_2 + trial + alpha;
        const Number h = s_2 * trial + s_s * alpha;
        const Number discriminant = b * b - 4.0 * h;
        return 2.0 * h / (b + root(where(discriminant > 0.0, discriminant)));
    }

    // 1/s, the shear rate 2 |gamma| half way from mu_s to mu_2; and mu(I) by that and a rate.
    GP_INLINE Number half_rate(const Number &pressure) const { return rate_factor * root(pressure); }
    GP_INLINE Number friction(const Number &rate, const Number &half) const {
        return rate > 0 ? mu_s + (mu_2 - mu_s) * rate / (rate + half) : mu_s;
    }

    // Is it yielding? What returned to mu_s p, as all that yields where mu_2 = mu_s, is there but for rounding.
    GP_INLINE auto at_yield(const Number &equivalent, const Number &pressure) const {
        return equivalent >= (1.0 - 1e-12) * mu_s * pressure;
    }

    // The factor by which the trial deviator shrinks; 1 inside the yield surface, 0 where there is no pressure.
    GP_INLINE Number shrink(const Number &trial, const Number &pressure, const Number &pressure_of_rate,
                            double dt) const {
        const Number one = Number{} + 1.0;
        const Number yields =
            choose(trial <= mu_s * pressure, one, yielded(trial, pressure, pressure_of_rate, dt) / trial);
        return where(pressure > 0.0, yields);
    }
};
using ReturnMap = ReturnMapOf<double>;

} // namespace gp
