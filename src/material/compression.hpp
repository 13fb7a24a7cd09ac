// The energy of compression under p = c0^2 (rho - rho0), without tension.
#pragma once

#include <cmath>

namespace gp {

// J/m3: integral of p d rho / rho from rho0 on; ratio: rho / rho0, bulk modulus: rho0 c0^2.
inline double compression_energy(double ratio, double bulk_modulus) {
    const double compression = ratio - 1;
    return compression > 0 ? bulk_modulus * (compression - std::log1p(compression)) : 0.0;
}

} // namespace gp
