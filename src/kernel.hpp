// The weight function of the method, w = (1 - r/R)^3 for r <= R, else 0 (Jin et al. 2021, 2.3), and its sums over the
// full square lattice of particles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "inline.hpp"

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
    double surface_lack = 0;   // what a particle in the row at a free surface lacks to N0
    double surface_moment = 0; // its first moment, |sum w r|; m
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
            sums.surface_moment += y > 0 ? w * y : 0.0;
        }
    sums.surface_lack = 0.5 * (sums.number_density - sums.row);
    return sums;
}

// Neighbours that fill a half plane up to the distance y on one side: their fitted slope is that of a curved profile not here but
// further inside, by m3 / (2 m2) with the moments m_k = sum w y_j^k of the ways to them. Over the radius, of y over the radius:
// y / (y + m3 / m2), 0 at the edge, 1 from a radius on.
class OneSidedSlope {
public:
    OneSidedSlope() {
        double second = 0, third = 0; // from the far side to -y
        int next = 0;
        for (int k = 2 * steps; k-- > 0;) {
            const double t = (k + 0.5) / steps - 1, chord = std::sqrt(1 - t * t);
            double across = 0;
            for (int i = 0; i < steps; ++i)
                across += weight(std::hypot(t, chord * (i + 0.5) / steps), 1.0) * chord;
            second += across * t * t;
            third += across * t * t * t;
            if (k == steps - next * (steps / samples)) { // t - half a step = -y
                const double y = static_cast<double>(next) / samples;
                share_[next++] = y / (y + third / second);
            }
        }
    }
    double share(double y) const {
        // 0 also of what is no number: such a step is refused later.
        const double at = y > 0 ? std::min(y, 1.0) * samples : 0.0;
        const int k = std::min(static_cast<int>(at), samples - 1);
        return share_[k] + (at - k) * (share_[k + 1] - share_[k]);
    }

private:
    static constexpr int samples = 32, steps = 128;
    std::array<double, samples + 1> share_{};
};

// The operators on a plane wave exp(i k.r) of the lattice, all without dimension (k0, N0 as above, sums over neighbours).
struct Wave {
    double
        gradient2; // dl^2 |G|^2, G = sum w r sin(k.r) / k0: what the gradient, and by its adjoint the force, makes of it
    double unseen;     // 1 - sum w cos(k.r) / N0 - k0 |G|^2 / (2 N0): what the zero-energy penalty acts on
    double difference; // 2 dl^2 sum w (1 - cos(k.r)) / k0: the density diffusion's Laplacian
};

// Calls visit(wave) for waves that sample the lattice's Brillouin zone, an eighth of it by its symmetry.
template <class Visit> void for_each_wave(double radius, double spacing, const Visit &visit) {
    constexpr int samples = 32; // per half period
    const double horizon = radius / spacing, pi = std::acos(-1.0);
    const LatticeSums sums = lattice_sums(horizon, 1);
    const int reach = static_cast<int>(std::ceil(horizon));
    for (int a = 0; a <= samples; ++a)
        for (int b = 0; b <= a; ++b) {
            const double kx = a * pi / samples, ky = b * pi / samples;
            double gx = 0, gy = 0, cosines = 0;
            for (int j = -reach; j <= reach; ++j)
                for (int i = -reach; i <= reach; ++i) {
                    if (i == 0 && j == 0)
                        continue;
                    const double w = weight(std::hypot(i, j), 1.0 / horizon), phase = kx * i + ky * j;
                    gx += w * i * std::sin(phase);
                    gy += w * j * std::sin(phase);
                    cosines += w * std::cos(phase);
                }
            const double k0 = sums.second_moment, n0 = sums.number_density;
            const double gradient2 = (gx * gx + gy * gy) / (k0 * k0);
            visit(Wave{gradient2, 1 - cosines / n0 - 0.5 * k0 * gradient2 / n0, 2 * (n0 - cosines) / k0});
        }
}

} // namespace gp
