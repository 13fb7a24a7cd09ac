// The point update of the granular fluidity.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "material/fluidity.hpp"

using namespace gp;

namespace {

// One lane's update.
struct Case {
    double mu_s, mu_2, rate_factor, shear_modulus, pressure, trial, dt, inertia, carried;

    double unit() const { return rate_factor * std::sqrt(pressure); }

    // The largest root, by bisection between the pole or 0 and a bound from above.
    double by_bisection() const {
        const long double mu = trial / pressure, a = shear_modulus * dt / pressure, span = mu_2 - mu_s;
        const long double drag = span / unit();
        long double c = carried;
        if (mu > mu_s)
            c = std::max(c, static_cast<long double>(inertia * Fluidity::seed * unit()));
        const auto balance = [&](long double g) {
            const long double m = mu / (1 + a * g);
            return inertia * g - c + span * (mu_s - m) / (mu_2 - m) * g + drag * m * g * g;
        };
        long double low = std::max(0.0L, (mu / mu_2 - 1) / a), high = std::max(c / inertia, (mu / mu_s - 1) / a);
        for (int k = 0; k < 300; ++k) {
            const long double g = 0.5L * (low + high);
            (mu / (1 + a * g) >= mu_2 || balance(g) < 0 ? low : high) = g;
        }
        return mu <= mu_s && high < Fluidity::arrest * unit() ? 0.0 : static_cast<double>(high);
    }
};

Lanes lanes(const Case (&all)[lane_count], double Case::*value) {
    return Lanes{all[0].*value, all[1].*value, all[2].*value, all[3].*value};
}

Lanes after(const Case (&all)[lane_count]) {
    const ReturnMapOf<Lanes> map{lanes(all, &Case::mu_s), lanes(all, &Case::mu_2), lanes(all, &Case::rate_factor),
                                 lanes(all, &Case::shear_modulus)};
    return Fluidity::after(map, lanes(all, &Case::trial), lanes(all, &Case::pressure), all[0].dt,
                           lanes(all, &Case::inertia), lanes(all, &Case::carried));
}

} // namespace

// Of any material and state, at rest, just above yield and far beyond mu_2.
TEST(Fluidity, IsTheRootThatBisectionFinds) {
    std::mt19937_64 random(1);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    const auto power = [&](double low, double high) { return std::pow(10, uniform(low, high)); };
    for (int k = 0; k < 20000; ++k) {
        Case all[lane_count];
        const double dt = power(-6, -3);
        for (Case &c : all) {
            c.mu_s = uniform(0.05, 0.8);
            c.mu_2 = c.mu_s + power(-3, 0);
            c.rate_factor = power(-2, 2);
            c.shear_modulus = power(3, 7);
            c.pressure = power(-6, 5);
            const double kind = uniform(0, 1);
            c.trial = c.pressure * (kind < 0.3   ? uniform(0, c.mu_s)
                                    : kind < 0.6 ? uniform(c.mu_s, c.mu_2)
                                                 : power(-1, 3));
            c.dt = dt;
            c.inertia = power(-2, 4);
            c.carried = uniform(0, 1) < 0.2 ? 0.0 : c.inertia * power(-12, 4);
        }
        const Lanes g = after(all);
        for (int l = 0; l < lane_count; ++l) {
            const double root = all[l].by_bisection();
            ASSERT_NEAR(g[l], root, 1e-6 * root) << "mu " << all[l].trial / all[l].pressure << " mu_s " << all[l].mu_s
                                                 << " mu_2 " << all[l].mu_2 << " case " << k;
        }
    }
}

// Sheared uniformly at a constant rate its stress becomes that of mu(I).
TEST(Fluidity, InUniformSteadyShearIsTheFrictionLaw) {
    const double d = 0.002, rho_s = 2500, i0 = 0.3, dt = 2e-5, time = 1e-4, pressure = 300;
    for (const double rate : {0.01, 1.0, 30.0, 1000.0}) {
        Case all[lane_count];
        for (Case &c : all)
            c = {0.384, 0.625, i0 / (d * std::sqrt(rho_s)), 5e4, pressure, 0.384 * pressure, dt, time / dt, 0};
        double tau = 0.384 * pressure, g = 0;
        for (int k = 0; k < 400000; ++k) {
            for (Case &c : all) {
                c.trial = tau + c.shear_modulus * dt * rate;
                c.carried = time / dt * g;
            }
            g = after(all)[0];
            tau = all[0].trial / (1 + all[0].shear_modulus * dt / pressure * g);
        }
        const double inertial = rate * d / std::sqrt(pressure / rho_s);
        const double mu = 0.384 + (0.625 - 0.384) * inertial / (i0 + inertial);
        EXPECT_NEAR(tau / pressure, mu, 1e-6 * mu) << "rate " << rate;
        EXPECT_NEAR(g, rate / mu, 1e-5 * g) << "rate " << rate;
    }
}

// Without neighbours to keep it up it dies where the stress is below mu_s, to 0, and grows from 0 above.
TEST(Fluidity, ArrestsBelowTheYieldStressAndNucleatesAboveIt) {
    Case all[lane_count];
    for (Case &c : all)
        c = {0.384, 0.625, 3, 5e4, 300, 0.38 * 300, 2e-5, 5, 0};
    double g = 1e-3 * all[0].unit();
    for (int k = 0; k < 100000 && g > 0; ++k) {
        for (Case &c : all)
            c.carried = c.inertia * g;
        g = after(all)[0];
    }
    EXPECT_EQ(g, 0);
    for (Case &c : all) {
        c.trial = 0.39 * 300;
        c.carried = 0;
    }
    EXPECT_GT(after(all)[0], 0);
}
