#include "periodic.hpp"

namespace gp {

void Images::make(Particles &particles, const Period &period, double reach) {
    const int64_t n = particles.count;
    length_ = period.length;
    first_ = n;
    source_.clear();
    shift_.clear();
    for (int side = 0; side < 2; ++side) {
        image_[side].assign(n, -1);
        for (int64_t i = 0; i < n; ++i) {
            const double from_end =
                side == 0 ? particles.x[i] - period.x_min : period.x_min + period.length - particles.x[i];
            if (from_end > reach)
                continue;
            image_[side][i] = static_cast<int32_t>(n + static_cast<int64_t>(source_.size()));
            source_.push_back(static_cast<int32_t>(i));
            shift_.push_back(shift(side));
        }
    }
    count = static_cast<int64_t>(source_.size());
    particles.make_room(count);
    copy(particles.column);
    copy({&particles.vx, &particles.vy, &particles.density, &particles.pressure, &particles.sxx, &particles.sxy});
    if (!particles.fluidity.empty())
        copy(particles.fluidity);
    copy_positions(particles);
}

void Images::copy_positions(Particles &particles) const {
    for (int64_t k = 0; k < count; ++k) {
        particles.x[first_ + k] = particles.x[source_[k]] + shift_[k];
        particles.y[first_ + k] = particles.y[source_[k]];
    }
}

int64_t Images::bytes() const {
    return static_cast<int64_t>((source_.capacity() + image_[0].capacity() + image_[1].capacity()) * sizeof(int32_t) +
                                shift_.capacity() * sizeof(double));
}

} // namespace gp
