// Sums of numbers of any size in any order and in any parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "binned_sum.hpp"

using namespace gp;

namespace {

BinnedSum sum_of(const std::vector<double> &numbers, std::size_t begin, std::size_t end) {
    BinnedSum sum;
    sum.add(static_cast<int64_t>(end - begin), [&](int64_t k) { return numbers[begin + static_cast<std::size_t>(k)]; });
    return sum;
}

double sum_of_parts(const std::vector<double> &numbers, std::size_t cut) {
    BinnedSum sum = sum_of(numbers, 0, cut);
    const BinnedSum rest = sum_of(numbers, cut, numbers.size());
    for (std::size_t bin = 0; bin < sum.wholes.size(); ++bin)
        sum.wholes[bin] += rest.wholes[bin];
    sum.top = std::max(sum.top, rest.top);
    return sum.value();
}

} // namespace

// Sizes alike, over 2^60, over 2^600; and powers of two, which are on the edges of bins and halfway between their units.
TEST(BinnedSum, IsTheSameInAnyOrderAndParts) {
    std::mt19937_64 generator(1);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int turn = 0; turn < 400; ++turn) {
        const double octaves[] = {0, 30, 300, 50};
        std::vector<double> numbers(1 + generator() % 1000);
        for (double &x : numbers) {
            const double size = octaves[turn % 4] * uniform(generator);
            x = turn % 4 == 3 ? std::copysign(std::exp2(std::rint(size)), uniform(generator))
                              : normal(generator) * std::exp2(size);
        }
        const double whole = sum_of(numbers, 0, numbers.size()).value();
        long double reference = 0;
        double largest = 0;
        for (const double x : numbers) {
            reference += x;
            largest = std::max(largest, std::abs(x));
        }
        // Each is rounded to at worst 2^-45 of the largest.
        EXPECT_NEAR(whole, static_cast<double>(reference), 0x1p-45 * largest * static_cast<double>(numbers.size()));
        for (int again = 0; again < 4; ++again) {
            std::shuffle(numbers.begin(), numbers.end(), generator);
            ASSERT_EQ(sum_of_parts(numbers, generator() % (numbers.size() + 1)), whole) << turn;
        }
    }
}

TEST(BinnedSum, OfNothingIsZeroAndOfWhatIsNotFiniteIsNotANumber) {
    EXPECT_EQ(BinnedSum().value(), 0);
    EXPECT_EQ(sum_of({0, 0}, 0, 2).value(), 0);
    EXPECT_EQ(sum_of({0x1p-1000, 1}, 0, 2).value(), 1);
    EXPECT_TRUE(std::isnan(sum_of({1, NAN, 1}, 0, 3).value()));
    EXPECT_TRUE(std::isnan(sum_of({1, INFINITY}, 0, 2).value()));
}
