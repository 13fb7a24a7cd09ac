// The energy of compression under p = c0^2 (rho - rho0), without tension.
#pragma once

#include <cmath>

#include "lanes.hpp"

namespace gp {

// Pa, by the density and the material's own, with c0^2.
inline double pressure_of(double density, double own, double c2) {
    const double pressure = c2 * (density - own);
    return pressure > 0 ? pressure : 0.0;
}

// e - log(1 + e) for e up to a quarter, by the series of 2 artanh(s), s = e / (2 + e), of which e - 2 s = e s: that of the
// logarithm itself loses all digits but a few where the compression is a thousandth, and takes five times as long.
constexpr double moderate_compression = 0.25;
template <class Number> GP_INLINE Number less_its_logarithm(const Number &e) {
    const Number s = e / (2.0 + e), z = s * s;
    const Number series =
        1.0 / 3 + z * (1.0 / 5 + z * (1.0 / 7 + z * (1.0 / 9 + z * (1.0 / 11 + z * (1.0 / 13 + z * (1.0 / 15))))));
    return s * (e - 2.0 * z * series);
}

// J/m3: integral of p d rho / rho from rho0 on; ratio: rho / rho0, bulk modulus: rho0 c0^2.
GP_INLINE double compression_energy(double ratio, double bulk_modulus) {
    const double e = ratio - 1;
    if (e > moderate_compression)
        return bulk_modulus * (e - std::log1p(e));
    return e > 0 ? bulk_modulus * less_its_logarithm(e) : 0.0;
}
GP_INLINE Lanes compression_energy(const Lanes &ratio, const Lanes &bulk_modulus) {
    const Lanes e = ratio - 1.0;
    Lanes energy = where(e > 0.0, bulk_modulus * less_its_logarithm(e));
    for (int l = 0; l < lane_count; ++l)
        if (e[l] > moderate_compression)
            energy[l] = compression_energy(ratio[l], bulk_modulus[l]);
    return energy;
}

} // namespace gp
