// Means over runs that differ by a jitter of a hundredth of a spacing. A collapse multiplies small differences: such runs end
// in deposits that scatter, one run by 1 % in the peak and by 3 % in the run-out at L/dl = 16 (docs/stability.md, "the
// yardstick"). What is said of scenes that differ in more than rounding is said of means, and with so many runs that the
// tolerance is some four standard errors. (Rounding alone is not enough for that: see similarity_test.cpp.)
// GRANPERI_SEED=1, 2, ... in the environment takes other runs.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <numeric>

#include "scene.hpp"

namespace test {

constexpr double shake = 0.01; // dl, the jitter of an ensemble's runs

// The seed of run `k`, or 0, 1, ... of the ensemble.
inline uint64_t seed_of(int k) {
    const char *chosen = std::getenv("GRANPERI_SEED");
    return 1000 * (chosen ? std::strtoull(chosen, nullptr, 10) : 0) + static_cast<uint64_t>(k);
}

inline gp_config shaken(gp_config c, int k) {
    c.jitter = shake;
    c.seed = seed_of(k);
    return c;
}

// What the runs of an ensemble came to, one number of each.
class Sample {
public:
    void add(double value) { values_.push_back(value); }
    double mean() const { return std::accumulate(values_.begin(), values_.end(), 0.0) / count(); }
    // Standard error of the mean.
    double error() const {
        double square = 0;
        for (const double value : values_)
            square += (value - mean()) * (value - mean());
        return std::sqrt(square / (count() - 1) / count());
    }

private:
    double count() const { return static_cast<double>(values_.size()); }
    std::vector<double> values_;
};

// Standard error of the difference.
inline double error_of(const Sample &a, const Sample &b) {
    return std::hypot(a.error(), b.error());
}

// Each comparison prints its figures: what is left up to the bound in standard errors is how safe the statement is.
inline void print_comparison(const char *what, double value, double error, const char *relation, double bound,
                             double left) {
    std::printf("  %s: %.5g +- %.2g %s %.5g, %.1f standard errors left\n", what, value, error, relation, bound,
                left / error);
}

inline void expect_mean_above(const char *what, const Sample &a, double bound) {
    print_comparison(what, a.mean(), a.error(), ">", bound, a.mean() - bound);
    EXPECT_GT(a.mean(), bound) << what << " +- " << a.error();
}

inline void expect_mean_below(const char *what, const Sample &a, double bound) {
    print_comparison(what, a.mean(), a.error(), "<", bound, bound - a.mean());
    EXPECT_LT(a.mean(), bound) << what << " +- " << a.error();
}

// The mean of a is that of b within a tolerance, in the same unit.
inline void expect_means_near(const char *what, const Sample &a, const Sample &b, double tolerance) {
    const double difference = a.mean() - b.mean(), error = error_of(a, b);
    print_comparison(what, difference, error, "within", tolerance, tolerance - std::abs(difference));
    EXPECT_NEAR(a.mean(), b.mean(), tolerance) << what << ", the difference +- " << error;
}

// The mean, of differences within pairs of runs say, is within a tolerance of zero.
inline void expect_mean_near_zero(const char *what, const Sample &a, double tolerance) {
    print_comparison(what, a.mean(), a.error(), "within", tolerance, tolerance - std::abs(a.mean()));
    EXPECT_NEAR(a.mean(), 0, tolerance) << what << " +- " << a.error();
}

// The mean of a is larger than `factor` times that of b.
inline void expect_mean_larger(const char *what, const Sample &a, double factor, const Sample &b) {
    const double error = std::hypot(a.error(), factor * b.error());
    print_comparison(what, a.mean(), error, ">", factor * b.mean(), a.mean() - factor * b.mean());
    EXPECT_GT(a.mean(), factor * b.mean()) << what << ", the difference +- " << error;
}

} // namespace test
