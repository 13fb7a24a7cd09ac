// Sums that do not depend on the order of what is added, nor on who adds which part: of whole numbers of a unit.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

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
struct ExactLoad {
    ExactSum fx, fy, torque, torque_pivot; // N/m; N, about its first point and about its pivot

    std::array<ExactSum *, 4> all() { return {&fx, &fy, &torque, &torque_pivot}; }
    void operator+=(const ExactLoad &other) {
        fx += other.fx;
        fy += other.fy;
        torque += other.torque;
        torque_pivot += other.torque_pivot;
    }
};

} // namespace gp
