// Four numbers at a time, one for each particle of a cluster (clusters.hpp). The compiler's vector types: one register where
// the processor has AVX, two of SSE2 or NEON. Lane by lane the same operations in the same order on any of them.
#pragma once

#include <cmath>
#include <cstdint>

#include "inline.hpp"

namespace gp {

constexpr int lane_count = 4;
typedef double Lanes __attribute__((vector_size(lane_count * sizeof(double))));

GP_INLINE Lanes root(const Lanes &a) {
    return Lanes{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}

// The lanes for which the mask holds, else 0. `keep` is what a comparison of lanes gives.
template <class Mask> GP_INLINE Lanes where(const Mask &keep, const Lanes &a) {
    return keep ? a : Lanes{};
}

// The same for one number, so that a law can be written once for both.
GP_INLINE double root(double a) {
    return std::sqrt(a);
}
GP_INLINE double where(bool keep, double a) {
    return keep ? a : 0.0;
}
GP_INLINE double choose(bool first, double a, double b) {
    return first ? a : b;
}
template <class Mask> GP_INLINE Lanes choose(const Mask &first, const Lanes &a, const Lanes &b) {
    return first ? a : b;
}

GP_INLINE double sum_of(const Lanes &a) {
    return (a[0] + a[1]) + (a[2] + a[3]);
}

// a in the lanes whose bit is set, else 0. (The bits made into numbers here took a third of a loop over ghosts.)
GP_INLINE Lanes seen_by_lanes(const Lanes &a, unsigned bits) {
    static constexpr Lanes shares[1 << lane_count] = {
        {0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 0}, {1, 0, 1, 0}, {0, 1, 1, 0}, {1, 1, 1, 0},
        {0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 0, 1}, {0, 0, 1, 1}, {1, 0, 1, 1}, {0, 1, 1, 1}, {1, 1, 1, 1}};
    return a * shares[bits];
}

// As weight() in kernel.hpp.
GP_INLINE Lanes weight(const Lanes &r2, double inverse_radius) {
    const Lanes q = 1.0 - root(r2) * inverse_radius;
    const Lanes positive = where(q > 0.0, q);
    return positive * positive * positive;
}

// Where the lanes of a cluster are: those past its end read its first particle once more.
struct LanePlaces {
    int64_t at[lane_count];

    GP_INLINE LanePlaces(int64_t first, int64_t last) {
        for (int64_t l = 0; l < lane_count; ++l)
            at[l] = first + l < last ? first + l : first;
    }
    GP_INLINE Lanes load(const double *field) const {
        return Lanes{field[at[0]], field[at[1]], field[at[2]], field[at[3]]};
    }
    // The lanes before `last` go where they came from.
    GP_INLINE void store(double *field, int64_t last, const Lanes &a) const {
        double *to = field + at[0];
        if (last - at[0] == lane_count) {
            for (int l = 0; l < lane_count; ++l)
                to[l] = a[l];
            return;
        }
        for (int64_t l = 0; l < last - at[0]; ++l)
            to[l] = a[l];
    }
    // 1 for a lane that has a particle of its own, else 0.
    GP_INLINE Lanes own() const {
        const auto lane = [&](int l) { return l == 0 || at[l] != at[0] ? 1.0 : 0.0; };
        return Lanes{lane(0), lane(1), lane(2), lane(3)};
    }
};

} // namespace gp
