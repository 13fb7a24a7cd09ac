// The granular fluidity in one dimension: steady layers by finite volumes. What the library's layers are compared with.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace test {

struct FluidLaw {
    double mu_s, mu_2, i0, d, amplitude, grain_density;
};

// A layer in steady flow, from its top down, in which the pressure and the shear stress are given.
class FluidityProfile {
public:
    // thickness: m. stress(z), pressure(z): Pa, at the depth z below the top. zero_top, zero_bottom: g = 0 there, else no flux.
    template <class Stress, class Pressure>
    FluidityProfile(const FluidLaw &law, double thickness, const Stress &stress, const Pressure &pressure,
                    bool zero_top, bool zero_bottom, int cells = 400)
        : width_(thickness / cells), rate_(static_cast<std::size_t>(cells), 0.0) {
        const std::size_t n = rate_.size();
        const double span = law.mu_2 - law.mu_s, k = std::pow(law.amplitude * law.d / width_, 2);
        std::vector<double> g(n, 1e3), growth(n), drag(n), mu(n), diagonal(n), right(n);
        for (std::size_t i = 0; i < n; ++i) {
            const double z = (static_cast<double>(i) + 0.5) * width_, p = pressure(z);
            mu[i] = stress(z) / p;
            growth[i] = span * (mu[i] - law.mu_s) / (law.mu_2 - mu[i]);
            drag[i] = span / law.i0 * law.d * std::sqrt(law.grain_density / p) * mu[i];
        }
        for (int pass = 0; pass < 500; ++pass) { // Newton, from above
            double change = 0, largest = 0;
            for (std::size_t i = 0; i < n; ++i) {
                double sum = 0, sides = 0;
                if (i > 0 || zero_top) {
                    const double weight = i > 0 ? 1 : 2;
                    sum += weight * ((i > 0 ? g[i - 1] : 0.0) - g[i]);
                    sides += weight;
                }
                if (i + 1 < n || zero_bottom) {
                    const double weight = i + 1 < n ? 1 : 2;
                    sum += weight * ((i + 1 < n ? g[i + 1] : 0.0) - g[i]);
                    sides += weight;
                }
                right[i] = -(k * sum + growth[i] * g[i] - drag[i] * g[i] * g[i]);
                diagonal[i] = -k * sides + growth[i] - 2 * drag[i] * g[i];
            }
            for (std::size_t i = 1; i < n; ++i) { // Thomas
                const double m = k / diagonal[i - 1];
                diagonal[i] -= m * k;
                right[i] -= m * right[i - 1];
            }
            for (std::size_t i = n; i-- > 0;) {
                right[i] = (right[i] - (i + 1 < n ? k * right[i + 1] : 0.0)) / diagonal[i];
                g[i] = std::max(0.0, g[i] + right[i]);
                change = std::max(change, std::abs(right[i]));
                largest = std::max(largest, g[i]);
            }
            if (change < 1e-10 * largest + 1e-14)
                break;
        }
        for (std::size_t i = 0; i < n; ++i)
            rate_[i] = g[i] * mu[i];
    }

    // m/s, against the bottom.
    double velocity(double z) const {
        double sum = 0;
        for (std::size_t i = rate_.size(); i-- > 0;) {
            const double top = static_cast<double>(i) * width_;
            sum += rate_[i] * std::clamp(top + width_ - z, 0.0, width_);
        }
        return sum;
    }

private:
    double width_;
    std::vector<double> rate_;
};

// The shear stress, Pa, with which a layer under a lid's pressure and its own weight gives the lid this speed, m/s.
template <class Pressure>
double stress_of_lid(const FluidLaw &law, double thickness, const Pressure &pressure, double speed) {
    double low = 0.5 * law.mu_s * pressure(0), high = (1 - 1e-5) * law.mu_2 * pressure(0);
    for (int k = 0; k < 60; ++k) {
        const double stress = 0.5 * (low + high);
        const FluidityProfile profile(
            law, thickness, [&](double) { return stress; }, pressure, false, false);
        (profile.velocity(0) < speed ? low : high) = stress;
    }
    return 0.5 * (low + high);
}

} // namespace test
