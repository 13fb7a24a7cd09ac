// The energy of compression under p = c0^2 (rho - rho0), without tension.
#pragma once

#include <cmath>

namespace gp {

// Pa, by the density and the material's own, with c0^2.
inline double pressure_of(double density, double own, double c2) {
    const double pressure = c2 * (density - own);
    return pressure > 0 ? pressure : 0.0;
}

// J/m3: integral of p d rho / rho from rho0 on; ratio: rho / rho0, bulk modulus: rho0 c0^2.
inline double compression_energy(double ratio, double bulk_modulus) {
    const double compression = ratio - 1;
    return compression > 0 ? bulk_modulus * (compression - std::log1p(compression)) : 0.0;
}

} // namespace gp
