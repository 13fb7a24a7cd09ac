// Sums of numbers of any size that do not depend on the order of what is added, nor on who adds which part (exact_sum.hpp has
// those of a known size).
//
// Numbers are cut up at powers of 2^45, the units of bins. A block of numbers is cut by the bin of its largest and by the one
// below; the sum of all keeps the highest bin that any block has, and the one below. In both each number's slice is the same
// whole number of units whatever block it was in: what is beyond the slices of a block with a lower bin is below the last unit.
// So the sum is of the numbers rounded to 2^-45 to 2^-90 of the largest.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "exact_sum.hpp"

namespace gp {

namespace bins {

constexpr int width = 45, count = 42, middle = 21; // bits; bins; the one whose unit is 1

// The unit of a bin.
inline double unit(int bin) {
    const auto bits = static_cast<uint64_t>(1023 + width * (bin - middle)) << 52;
    double unit;
    std::memcpy(&unit, &bits, sizeof unit);
    return unit;
}

// Where numbers of this size begin: half the next unit is no less, so that it has nothing of them.
inline int first_of(double size) {
    uint64_t bits;
    std::memcpy(&bits, &size, sizeof bits);
    const int exponent = static_cast<int>(bits >> 52) - 1023; // size < 2^(exponent + 1)
    return std::max(1, (exponent + 2 + width * middle + width - 1) / width - 1);
}

} // namespace bins

// Of up to 64 numbers: their slices in a bin and in the one below, each added up without rounding.
struct BinnedBlock {
    static constexpr int64_t most = 64;

    double high, low;
    int bin;

    explicit BinnedBlock(const double *numbers) { // 64 of them
        double largest = 0;
#pragma omp simd reduction(max : largest)
        for (int64_t k = 0; k < most; ++k)
            largest = std::max(largest, std::abs(numbers[k]));
        bin = bins::first_of(largest);
        high = low = NAN;
        if (bin >= bins::count)
            return;
        // What is added to 3/2 2^52 units is rounded to whole ones.
        const double above = 0x1.8p52 * bins::unit(bin), below = 0x1.8p52 * bins::unit(bin - 1);
        double first = 0, second = 0;
#pragma omp simd reduction(+ : first, second)
        for (int64_t k = 0; k < most; ++k) {
            const double slice = (numbers[k] + above) - above;
            first += slice;
            second += ((numbers[k] - slice) + below) - below;
        }
        high = first;
        low = second;
    }
    BinnedBlock() : high(0), low(0), bin(1) {}
};

class BinnedSum {
public:
    // Of bins, and how they are combined over processes: by their sums; the tops by the largest.
    std::array<Whole, bins::count> wholes{};
    double top = 1; // infinite: not all were finite

    void add(const BinnedBlock &block) {
        if (!std::isfinite(block.high + block.low)) {
            top = INFINITY;
            return;
        }
        top = std::max(top, static_cast<double>(block.bin));
        wholes[block.bin] += static_cast<int64_t>(block.high / bins::unit(block.bin));
        wholes[block.bin - 1] += static_cast<int64_t>(block.low / bins::unit(block.bin - 1));
    }
    // The numbers term(0) .. term(count - 1).
    template <class Term> void add(int64_t count, const Term &term) {
        for (int64_t begin = 0; begin < count; begin += BinnedBlock::most)
            add(block_of(begin, std::min(count, begin + BinnedBlock::most), term));
    }
    template <class Term> static BinnedBlock block_of(int64_t begin, int64_t end, const Term &term) {
        double numbers[BinnedBlock::most];
        for (int64_t i = begin; i < end; ++i)
            numbers[i - begin] = term(i);
        std::fill(numbers + (end - begin), numbers + BinnedBlock::most, 0.0);
        return BinnedBlock(numbers);
    }

    double value() const {
        if (!std::isfinite(top))
            return NAN;
        const int bin = static_cast<int>(top);
        const Whole units = wholes[bin] * (static_cast<Whole>(1) << bins::width) + wholes[bin - 1];
        return static_cast<double>(units) * bins::unit(bin - 1);
    }
};

} // namespace gp
