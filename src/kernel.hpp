// The weight function of the method, w = (1 - r/R)^3 for r <= R, else 0 (Jin et al. 2021, 2.3), and its sums over the
// full square lattice of particles.
#pragma once

#include <cmath>

#include "parallel.hpp"

namespace gp {

// Branch-free, so that pair loops vectorise. inverse_radius = 1/R.
GP_INLINE double weight(double r, double inverse_radius) {
    const double q = 1.0 - r * inverse_radius;
    const double positive = q > 0.0 ? q : 0.0;
    return positive * positive * positive;
}

struct LatticeSums {
    double number_density = 0; // N0 = sum of w ([1] 2.4)
    double row = 0;            // the part of N0 of one's own row
    double second_moment = 0;  // k0: the full-lattice shape tensor is k0 times the unit tensor; m^2
};

// Sums over the neighbours of one particle of an infinite lattice with the given spacing.
inline LatticeSums lattice_sums(double radius, double spacing) {
    LatticeSums sums;
    const int reach = static_cast<int>(std::ceil(radius / spacing));
    for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i) {
            if (i == 0 && j == 0)
                continue;
            const double x = i * spacing, y = j * spacing;
            const double w = weight(std::sqrt(x * x + y * y), 1.0 / radius);
            sums.number_density += w;
            sums.row += j == 0 ? w : 0.0;
            sums.second_moment += w * x * x;
        }
    return sums;
}

} // namespace gp
