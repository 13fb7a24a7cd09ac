// The regularised mu(I) law (Jin et al. 2021, 3.6, after Chauchat & Medale 2014): pure functions of one particle.
//
// eta_r = (mu_s + 2 (mu_2 - mu_s) |gamma| / (I0 sqrt(p / (rho_s d^2)) + 2 |gamma|)) p / sqrt(|gamma|^2 + delta^2), with
// |gamma| = sqrt(D:D/2) (3.3). In print the root covers p alone, which is no rate. The stress is tau = eta_r D, so that
// |tau| -> mu(I) p; the 2 eta_r D that is printed (3.12) is the friction factor 2.
#pragma once

#include <cmath>

#include "inline.hpp"

namespace gp {

// A symmetric rate or stress in two dimensions, with its trace.
struct Symmetric {
    double xx, xy, yy;
};

// |gamma| of D in 1/s (3.3).
GP_INLINE double shear_rate(const Symmetric &d) {
    return std::sqrt(0.5 * (d.xx * d.xx + d.yy * d.yy) + d.xy * d.xy);
}

// a : b of two symmetric tensors.
GP_INLINE double contract(const Symmetric &a, const Symmetric &b) {
    return a.xx * b.xx + 2.0 * a.xy * b.xy + a.yy * b.yy;
}

// One material's constants for the law.
struct Regularized {
    double mu_s, mu_2;  // already multiplied by friction_factor
    double rate_factor; // I0 / (d sqrt(rho_s)), so that I0 sqrt(p / (rho_s d^2)) = rate_factor sqrt(p)
    double delta;       // 1/s

    // mu(|gamma|) p in Pa, and its derivative by |gamma| in Pa s.
    struct Yield {
        double stress, slope;
    };
    GP_INLINE Yield yield(double rate, double pressure) const {
        if (pressure <= 0.0)
            return {0.0, 0.0};
        const double a = rate_factor * std::sqrt(pressure), sum = a + 2.0 * rate, range = 2.0 * (mu_2 - mu_s);
        return {(mu_s + range * rate / sum) * pressure, pressure * range * a / (sum * sum)};
    }

    // eta_r in Pa s; 0 where there is no pressure.
    GP_INLINE double viscosity(double rate, double pressure) const {
        return yield(rate, pressure).stress / std::hypot(rate, delta);
    }

    // tau = eta_r D in Pa. Its trace stays: the printed D is the whole one, and so resists changes of volume as well.
    GP_INLINE Symmetric stress(const Symmetric &d, double pressure) const {
        const double eta = viscosity(shear_rate(d), pressure);
        return {eta * d.xx, eta * d.xy, eta * d.yy};
    }
};

} // namespace gp
