// The equation of state of the number density (Jin et al. 2021, 2.8): pure functions of one particle.
#pragma once

#include <cmath>

#include "inline.hpp"

namespace gp {

constexpr double state_exponent = 7.0; // lambda

// p = rho0 c0^2 / lambda ((N/N0)^lambda - 1), and 0 below N0: there begins the free surface. ratio = N/N0,
// bulk_modulus = rho0 c0^2 in Pa.
GP_INLINE double state_pressure(double ratio, double bulk_modulus) {
    if (ratio <= 1.0)
        return 0.0;
    const double cube = ratio * ratio * ratio;
    return bulk_modulus / state_exponent * (cube * cube * ratio - 1.0);
}

// Integral of p d rho / rho from rho0 on, J/m3.
inline double state_energy(double ratio, double bulk_modulus) {
    if (ratio <= 1.0)
        return 0.0;
    return bulk_modulus / state_exponent * ((std::pow(ratio, state_exponent) - 1.0) / state_exponent - std::log(ratio));
}

} // namespace gp
