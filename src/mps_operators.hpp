// The operators of the moving particle semi-implicit method on one particle's neighbours, as far as the paper's schemes
// use them: the number density N_i = sum_j w (Jin et al. 2021, 2.4) and the gradient
// (2/N0) sum_j (phi_j - phi_i) r_ij w / r^2 (2.7), exact for linear fields on the full lattice alone. Neither volumes nor
// neighbours that are missing come into it.
#pragma once

#include <cstdint>

#include "kernel.hpp"

namespace gp {

// Added to r^2 where it divides: two particles in one place have no direction and then add nothing.
constexpr double nearest_square = 1e-18; // dl^2

GP_INLINE double number_density_sum(const int32_t *__restrict row, int64_t n, double xi, double yi,
                                    const double *__restrict x, const double *__restrict y, double inverse_radius) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int64_t k = 0; k < n; ++k) {
        const int32_t j = row[k];
        const double dx = x[j] - xi, dy = y[j] - yi;
        sum += weight(std::sqrt(dx * dx + dy * dy), inverse_radius);
    }
    return sum;
}

// sum_j (u_j - u_i) (x) r_ij w / r^2, 1/s.
struct MpsGradient {
    double xx = 0, xy = 0, yx = 0, yy = 0;

    GP_INLINE MpsGradient &operator+=(const MpsGradient &other) {
        xx += other.xx;
        xy += other.xy;
        yx += other.yx;
        yy += other.yy;
        return *this;
    }
};

GP_INLINE MpsGradient mps_gradient_sum(const int32_t *__restrict row, int64_t n, double xi, double yi, double ui,
                                       double vi, const double *__restrict x, const double *__restrict y,
                                       const double *__restrict vx, const double *__restrict vy, double inverse_radius,
                                       double floor) {
    double xx = 0, xy = 0, yx = 0, yy = 0;
#pragma omp simd reduction(+ : xx, xy, yx, yy)
    for (int64_t k = 0; k < n; ++k) {
        const int32_t j = row[k];
        const double dx = x[j] - xi, dy = y[j] - yi;
        const double r2 = dx * dx + dy * dy;
        const double w = weight(std::sqrt(r2), inverse_radius) / (r2 + floor);
        const double wx = w * dx, wy = w * dy;
        const double du = vx[j] - ui, dv = vy[j] - vi;
        xx += du * wx;
        xy += du * wy;
        yx += dv * wx;
        yy += dv * wy;
    }
    return {xx, xy, yx, yy};
}

} // namespace gp
