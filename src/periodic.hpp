// Periodicity in x: images of the particles near one end beyond the other.
//
// An image is an entry of the particles' arrays behind the real ones, at index count .. count + images. It is in the
// neighbour lists like any particle; stages that change a field which neighbours read copy it to the images.
#pragma once

#include <cstdint>
#include <initializer_list>

#include "geometry.hpp"
#include "particles.hpp"

namespace gp {

class Images {
public:
    int64_t count = 0;

    // Makes the images of all particles within `reach` of an end. The particles are inside the period.
    void make(Particles &particles, const Period &period, double reach);

    // Takes the values of the particles over to their images.
    template <class T> void copy(Field<T> &field) const {
        for (int64_t k = 0; k < count; ++k)
            field[first_ + k] = field[source_[k]];
    }
    void copy(std::initializer_list<Field<double> *> fields) const {
        for (Field<double> *field : fields)
            copy(*field);
    }
    void copy_positions(Particles &particles) const;

    // The particle that an index of the neighbour lists stands for.
    int64_t source(int64_t index) const { return index < first_ ? index : source_[index - first_]; }
    // The index of particle i's image a period up (side 0) or down (side 1); -1 if it has none there.
    int32_t image_of(int64_t i, int side) const { return image_[side][i]; }
    double shift(int side) const { return side == 0 ? length_ : -length_; }

    int64_t bytes() const;

private:
    double length_ = 0;
    int64_t first_ = INT64_MAX; // number of particles, once there are images
    Field<int32_t> source_;
    Field<double> shift_;
    Field<int32_t> image_[2];
};

} // namespace gp
