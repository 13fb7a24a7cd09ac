// The energy of compression under p = c0^2 (rho - rho0), without tension.
#pragma once

#include <cmath>

#include "parallel.hpp"

namespace gp {

// e - log(1 + e). Up to a quarter by the series of 2 artanh(s), s = e / (2 + e), of which e - 2 s = e s: that of the logarithm
// itself loses all digits but a few where the compression is a thousandth, and takes five times as long.
GP_INLINE double less_its_logarithm(double e) {
    if (e > 0.25)
        return e - std::log1p(e);
    const double s = e / (2 + e), z = s * s;
    const double series =
        1.0 / 3 + z * (1.0 / 5 + z * (1.0 / 7 + z * (1.0 / 9 + z * (1.0 / 11 + z * (1.0 / 13 + z * (1.0 / 15))))));
    return s * (e - 2 * z * series);
}

// J/m3: integral of p d rho / rho from rho0 on; ratio: rho / rho0, bulk modulus: rho0 c0^2.
GP_INLINE double compression_energy(double ratio, double bulk_modulus) {
    const double compression = ratio - 1;
    return compression > 0 ? bulk_modulus * less_its_logarithm(compression) : 0.0;
}

} // namespace gp
