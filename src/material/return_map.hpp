// Elastic trial and return map of the mu(I) law (Dunatunga & Kamrin 2015): pure functions of one particle.
//
// The law is mu(I) = mu_s + (mu_2 - mu_s) / (I0/I + 1) with I = 2 d |gamma| / sqrt(p/rho_s); the equivalent shear stress
// tau = sqrt(s:s/2) never exceeds mu(I) p. Inside the yield surface the material is elastic: it does not flow.
#pragma once

#include <cmath>

#include "parallel.hpp"

namespace gp {

// Deviatoric stress in two dimensions: sxx = -syy and sxy. Pa.
struct Deviator {
    double xx, xy;
};

GP_INLINE double equivalent_stress(const Deviator &s) {
    return std::sqrt(s.xx * s.xx + s.xy * s.xy);
}

// Rotation of the stress with the material (Jaumann rate over one step), by the Cayley form of the rotation, which keeps
// the magnitude exactly. spin = (du_x/dy - du_y/dx) / 2 in 1/s.
GP_INLINE Deviator rotate(const Deviator &s, double spin, double dt) {
    const double t = spin * dt;
    const double scale = 1.0 / (1.0 + t * t);
    const double cosine = (1.0 - t * t) * scale, sine = 2.0 * t * scale;
    return {cosine * s.xx + sine * s.xy, cosine * s.xy - sine * s.xx};
}

// One material's constants for the map.
struct ReturnMap {
    double mu_s, mu_2;    // already multiplied by friction_factor
    double rate_factor;   // I0 / (d sqrt(rho_s)), so that I0/I = rate_factor sqrt(p) G dt / (tau_trial - tau)
    double shear_modulus; // G, Pa

    // Equivalent stress after the step from its elastic trial value, the root of
    // (tau - mu_s p)(alpha + trial - tau) = (mu_2 - mu_s) p (trial - tau), alpha = rate_factor G dt sqrt(p).
    GP_INLINE double yielded(double trial, double pressure, double dt) const {
        const double s_s = mu_s * pressure, s_2 = mu_2 * pressure;
        const double alpha = rate_factor * shear_modulus * dt * std::sqrt(pressure);
        const double b = s_2 + trial + alpha;
        const double h = s_2 * trial + s_s * alpha;
        const double discriminant = b * b - 4.0 * h;
        return 2.0 * h / (b + std::sqrt(discriminant > 0.0 ? discriminant : 0.0));
    }

    // Is it yielding? What returned to mu_s p, as all that yields where mu_2 = mu_s, is there but for rounding.
    GP_INLINE bool at_yield(double equivalent, double pressure) const {
        return equivalent >= (1.0 - 1e-12) * mu_s * pressure;
    }

    // The factor by which the trial deviator shrinks; 1 inside the yield surface, 0 where there is no pressure.
    GP_INLINE double shrink(double trial, double pressure, double dt) const {
        if (pressure <= 0.0)
            return 0.0;
        if (trial <= mu_s * pressure)
            return 1.0;
        return yielded(trial, pressure, dt) / trial;
    }
};

} // namespace gp
