// Sums that do not depend on the order of what is added, nor on who adds which part: of whole numbers of a unit.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "lanes.hpp"

namespace gp {

// 128 bits: numbers of up to 2^86 units, 2^27 of them.
__extension__ typedef __int128 Whole;

class ExactSum {
public:
    // scale: one over the unit, a power of two.
    void add(double value, double scale) {
        const double units = value * scale;
        if (std::abs(units) < 0x1p62) { // nearly always
            whole_ += static_cast<int64_t>(std::rint(units));
            return;
        }
        if (!(std::abs(units) < 0x1p86)) { // or not a number
            beyond_ += value;
            return;
        }
        const double high = std::rint(units * 0x1p-40), low = std::rint(units - high * 0x1p40);
        whole_ +=
            static_cast<Whole>(static_cast<int64_t>(high)) * (static_cast<Whole>(1) << 40) + static_cast<int64_t>(low);
    }
    void operator+=(const ExactSum &other) {
        whole_ += other.whole_;
        beyond_ += other.beyond_;
    }
    void add_whole(Whole units) { whole_ += units; }
    double value(double scale) const { return static_cast<double>(whole_) / scale + beyond_; }

    Whole whole() const { return beyond_ == 0 ? whole_ : lost; }
    // The sum over all processes of whole(). Where one of them had more than it can hold, nobody knows it.
    void set_whole(Whole whole) {
        const bool known = whole < lost / 2 && whole > -(lost / 2);
        whole_ = known ? whole : 0;
        beyond_ = known ? 0 : NAN;
    }

private:
    static constexpr Whole lost = static_cast<Whole>(1) << 116; // of at most 2^10 processes

    Whole whole_ = 0;
    double beyond_ = 0; // what no whole number can hold: a simulation in which that is much has diverged
};

// On a plate in one step.
class ExactLoad {
public:
    // One more of each, in this order: what ExactSum::add adds to each, all at once. (One after the other they were two fifths of
    // what the contacts of a floor took in stages that one thread does.)
    GP_INLINE void add(const Lanes &values, const Lanes &scales) {
        const Lanes units = values * scales;
        if (!(sum_of(choose(units < 0.0, -units, units)) < 0x1p72)) { // hardly ever, or not numbers
            add_one_by_one(values, scales);
            return;
        }
        // What is added to 3/2 2^52 of something is rounded to wholes of it. A multiple of 2^32 is even: so what is left of the
        // units is rounded as all of them are.
        const Lanes high = (units + 0x1.8p84) - 0x1.8p84;
        high_ += high;
        low_ += ((units - high) + 0x1.8p52) - 0x1.8p52;
        if (++in_lanes_ == most_in_lanes)
            settle();
    }
    // Of the last one alone.
    void add_couple(double couple, double scale) { sums_[3].add(couple, scale); }

    // Forces in x and y, N/m; torques about its first point and about its pivot, N.
    std::array<ExactSum, lane_count> &all() {
        settle();
        return sums_;
    }
    void operator+=(ExactLoad other) {
        settle();
        other.settle();
        for (int l = 0; l < lane_count; ++l)
            sums_[l] += other.sums_[l];
    }

private:
    void add_one_by_one(const Lanes &values, const Lanes &scales) {
        for (int l = 0; l < lane_count; ++l)
            sums_[l].add(values[l], scales[l]);
    }
    void settle() {
        if (in_lanes_ == 0)
            return;
        in_lanes_ = 0;
        for (int l = 0; l < lane_count; ++l)
            sums_[l].add_whole(static_cast<Whole>(static_cast<int64_t>(high_[l] * 0x1p-32)) *
                                   (static_cast<Whole>(1) << 32) +
                               static_cast<int64_t>(low_[l]));
        high_ = low_ = Lanes{};
    }

    // Of so many both sums are exact: below 2^84 in multiples of 2^32, and below 2^43.
    static constexpr int32_t most_in_lanes = 1 << 12;
    std::array<ExactSum, lane_count> sums_; // but for what is in lanes
    Lanes high_{}, low_{};
    int32_t in_lanes_ = 0;
};

} // namespace gp
