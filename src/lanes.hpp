// Four numbers at a time, one for each particle of a cluster (clusters.hpp). The compiler's vector types: one register where
// the processor has AVX, two of SSE2 or NEON. Lane by lane the same operations in the same order on any of them.
#pragma once

#include <cmath>
#include <cstdint>

#include "parallel.hpp"

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
};

} // namespace gp
