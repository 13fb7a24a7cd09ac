// The granular fluidity in one dimension: steady layers by finite volumes. What the library's layers are compared with.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace test {

struct FluidLaw {
    double mu_s, mu_2, i0, d, amplitude, grain_density;
};

// Steady fluidity, 1/s, of cells in a row: towards the cell before and after conductances (of a difference of fluidities, -), each
// one's growth (by its stress ratio, -) and drag (s). Newton from above, each step by Thomas. before[0] and after[last] lead to a
// fluidity of 0; with 0 there is no flux.
inline std::vector<double> steady_fluidity(const std::vector<double> &before, const std::vector<double> &after,
                                           const std::vector<double> &growth, const std::vector<double> &drag) {
    const std::size_t n = growth.size();
    std::vector<double> g(n, 1e3), diagonal(n), right(n);
    for (int pass = 0; pass < 500; ++pass) {
        double change = 0, largest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double there = i > 0 ? g[i - 1] : 0.0, beyond = i + 1 < n ? g[i + 1] : 0.0;
            right[i] =
                -(before[i] * (there - g[i]) + after[i] * (beyond - g[i]) + growth[i] * g[i] - drag[i] * g[i] * g[i]);
            diagonal[i] = -before[i] - after[i] + growth[i] - 2 * drag[i] * g[i];
        }
        for (std::size_t i = 1; i < n; ++i) {
            const double m = before[i] / diagonal[i - 1];
            diagonal[i] -= m * after[i - 1];
            right[i] -= m * right[i - 1];
        }
        for (std::size_t i = n; i-- > 0;) {
            right[i] = (right[i] - (i + 1 < n ? after[i] * right[i + 1] : 0.0)) / diagonal[i];
            g[i] = std::max(0.0, g[i] + right[i]);
            change = std::max(change, std::abs(right[i]));
            largest = std::max(largest, g[i]);
        }
        if (change < 1e-10 * largest + 1e-14)
            break;
    }
    return g;
}

inline double growth_of(const FluidLaw &law, double mu) {
    return (law.mu_2 - law.mu_s) * (mu - law.mu_s) / (law.mu_2 - mu);
}
inline double drag_of(const FluidLaw &law, double mu, double pressure) {
    return (law.mu_2 - law.mu_s) / law.i0 * law.d * std::sqrt(law.grain_density / pressure) * mu;
}

// A layer in steady flow, from its top down, in which the pressure and the shear stress are given.
class FluidityProfile {
public:
    // thickness: m. stress(z), pressure(z): Pa, at the depth z below the top. zero_top, zero_bottom: g = 0 there, else no flux.
    template <class Stress, class Pressure>
    FluidityProfile(const FluidLaw &law, double thickness, const Stress &stress, const Pressure &pressure,
                    bool zero_top, bool zero_bottom, int cells = 400)
        : width_(thickness / cells) {
        const auto n = static_cast<std::size_t>(cells);
        const double k = std::pow(law.amplitude * law.d / width_, 2);
        std::vector<double> before(n, k), after(n, k), growth(n), drag(n), mu(n);
        before[0] = zero_top ? 2 * k : 0.0; // half a cell away
        after[n - 1] = zero_bottom ? 2 * k : 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            const double z = (static_cast<double>(i) + 0.5) * width_, p = pressure(z);
            mu[i] = stress(z) / p;
            growth[i] = growth_of(law, mu[i]);
            drag[i] = drag_of(law, mu[i], p);
        }
        rate_ = steady_fluidity(before, after, growth, drag);
        for (std::size_t i = 0; i < n; ++i)
            rate_[i] *= mu[i];
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
    std::vector<double> rate_; // 1/s
};

// An annular cell in steady flow under one pressure, whose inner wall turns with a moment (N) and whose outer one holds; neither
// passes a flux of fluidity. The shear stress is moment / (2 pi r^2).
class FluidityAnnulus {
public:
    FluidityAnnulus(const FluidLaw &law, double inner, double outer, double pressure, double moment, int cells = 400)
        : inner_(inner), width_((outer - inner) / cells) {
        const auto n = static_cast<std::size_t>(cells);
        const double k = std::pow(law.amplitude * law.d / width_, 2), turn = 2 * std::acos(-1.0);
        std::vector<double> before(n), after(n), growth(n), drag(n), mu(n);
        for (std::size_t i = 0; i < n; ++i) {
            const double r = radius(i);
            before[i] = i > 0 ? k * (r - 0.5 * width_) / r : 0.0;
            after[i] = i + 1 < n ? k * (r + 0.5 * width_) / r : 0.0;
            mu[i] = moment / (turn * r * r * pressure);
            growth[i] = growth_of(law, mu[i]);
            drag[i] = drag_of(law, mu[i], pressure);
        }
        turning_ = steady_fluidity(before, after, growth, drag);
        for (std::size_t i = 0; i < n; ++i)
            turning_[i] *= mu[i] / radius(i);
    }

    // m/s, along the walls.
    double velocity(double r) const {
        double sum = 0; // d(u/r)/dr = -rate / r
        for (std::size_t i = 0; i < turning_.size(); ++i)
            sum += turning_[i] * std::clamp(inner_ + static_cast<double>(i + 1) * width_ - r, 0.0, width_);
        return sum * r;
    }

private:
    double radius(std::size_t i) const { return inner_ + (static_cast<double>(i) + 0.5) * width_; }
    double inner_, width_;
    std::vector<double> turning_; // 1/s, of the rate over the radius
};

// The moment, N, with which the inner wall of an annular cell turns at this rate, rad/s.
inline double moment_of_turning(const FluidLaw &law, double inner, double outer, double pressure, double omega) {
    const double at_yield = 2 * std::acos(-1.0) * inner * inner * pressure;
    double low = 0.5 * law.mu_s * at_yield, high = (1 - 1e-5) * law.mu_2 * at_yield;
    for (int k = 0; k < 60; ++k) {
        const double moment = 0.5 * (low + high);
        (FluidityAnnulus(law, inner, outer, pressure, moment).velocity(inner) < omega * inner ? low : high) = moment;
    }
    return 0.5 * (low + high);
}

// The shear stress, Pa, with which a layer under a lid's pressure and its own weight gives the lid this speed, m/s.
template <class Pressure>
double stress_of_lid(const FluidLaw &law, double thickness, const Pressure &pressure, double speed,
                     bool zero_top = false) {
    double low = 0.5 * law.mu_s * pressure(0), high = (1 - 1e-5) * law.mu_2 * pressure(0);
    for (int k = 0; k < 60; ++k) {
        const double stress = 0.5 * (low + high);
        const FluidityProfile profile(
            law, thickness, [&](double) { return stress; }, pressure, zero_top, false);
        (profile.velocity(0) < speed ? low : high) = stress;
    }
    return 0.5 * (low + high);
}

} // namespace test
