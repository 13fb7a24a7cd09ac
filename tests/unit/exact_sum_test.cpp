// Loads on plates: sums without rounding, added up four at a time.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "exact_sum.hpp"

using namespace gp;

namespace {

void expect_same(ExactLoad &load, const std::array<ExactSum, lane_count> &one_by_one, const char *what) {
    const std::array<ExactSum, lane_count> &sums = load.all();
    for (int l = 0; l < lane_count; ++l) {
        EXPECT_TRUE(sums[l].whole() == one_by_one[l].whole()) << what << " " << l;
        EXPECT_EQ(sums[l].value(0.5), one_by_one[l].value(0.5)) << what << " " << l;
    }
}

} // namespace

// Numbers of all sizes, halves of units and of 2^32 units among them, more than lanes hold before they are settled.
TEST(ExactLoad, IsTheSameFourAtATime) {
    std::mt19937_64 generator(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const double octaves : {4.0, 34.0, 56.0, 63.0, 71.0, 74.0, 80.0}) {
        ExactLoad load, other;
        std::array<ExactSum, lane_count> one_by_one{};
        const Lanes scales{0.5, 0.5, 4, 4};
        for (int k = 0; k < 10000; ++k) {
            Lanes values{};
            for (int l = 0; l < lane_count; ++l) {
                const double number = std::exp2(octaves * std::abs(uniform(generator))) * uniform(generator);
                const double half = std::exp2(std::rint(octaves * std::abs(uniform(generator)))) *
                                    (0.5 + std::rint(8 * uniform(generator)));
                values[l] = (k % 2 == 0 ? number : half) / scales[l];
                one_by_one[l].add(values[l], scales[l]);
            }
            (k % 3 == 0 ? other : load).add(values, scales);
        }
        load += other;
        expect_same(load, one_by_one, "load");
    }
}

// What all lanes hold at most, and what none may: the others are added up all the same.
TEST(ExactLoad, KnowsItsBounds) {
    for (const double size : {0x1p72, 0x1.fffffffffffffp69, 0x1p31, 0x1.8p32, 0.5, 1.5, 0x1p-1074, 0x1p86, 0x1p1000}) {
        ExactLoad load;
        std::array<ExactSum, lane_count> one_by_one{};
        for (int k = 0; k < 5000; ++k) {
            const double sign = k % 5 == 4 ? -1 : 1;
            const Lanes values{sign * size, 3, -sign * size, 0.25 * sign * size};
            load.add(values, Lanes{} + 1.0);
            for (int l = 0; l < lane_count; ++l)
                one_by_one[l].add(values[l], 1);
        }
        expect_same(load, one_by_one, "bound");
    }
    ExactLoad load;
    load.add(Lanes{NAN, 1, INFINITY, 2}, Lanes{} + 1.0);
    EXPECT_TRUE(std::isnan(load.all()[0].value(1)));
    EXPECT_EQ(load.all()[1].value(1), 1);
    EXPECT_EQ(load.all()[2].value(1), INFINITY);
    EXPECT_EQ(load.all()[3].value(1), 2);
}
