// Images: entries of the particles' arrays behind the real ones, at index count .. count + images, for particles that are
// elsewhere. In a periodic scene they stand for those near one end, beyond the other; in a part of a world (halo.hpp) for
// those that another process works on. An image is in the neighbour lists like any particle; stages that change a field which
// neighbours read copy it to the images.
//
// They are in the order of their cells, as particles are: that of who looks through both is one order.
#pragma once

#include <cstdint>
#include <initializer_list>

#include "geometry.hpp"
#include "halo.hpp"
#include "neighbors.hpp"
#include "particles.hpp"

namespace gp {

class Images {
public:
    int64_t count = 0;

    bool in_use() const { return count > 0 || halo_; } // others may have some of what is here
    // Makes the images of all particles within `reach` of an end. The particles are inside the period, and in order.
    void make(Particles &particles, const CellGrid &grid, const Period &period, double reach);
    // Those of the particles of other processes, which the halo has found.
    void make(Particles &particles, const CellGrid &grid, Halo &halo);

    // Takes the values of the particles over to their images.
    void copy(std::initializer_list<Field<double> *> fields) const;
    void copy(Field<double> &field) const { copy({&field}); }
    void copy(Field<uint8_t> &field) const; // where no others have any: of several processes, see copy_collisions
    // All of them in one message.
    void copy_collisions(std::initializer_list<Field<double> *> fields, Field<uint8_t> &partners,
                         Field<float> &crowded) const;
    void copy_motion(Particles &particles) const; // positions and velocities
    void copy_all(Particles &particles) const;    // all that a step begins with

    // The cell of the k-th image, of a part of a world.
    const Cell &cell(int64_t k) const { return halo_->cell(cells_.order()[k]); }
    // The particle that an index of the neighbour lists stands for; not of a part of a world.
    int64_t source(int64_t index) const { return index < first_ ? index : source_[index - first_]; }

    // Its number in the scene; also in a part of a world.
    int64_t id_of(const Particles &particles, int64_t index) const {
        if (index < first_)
            return particles.id[index];
        const int32_t found = cells_.order()[index - first_];
        return halo_ ? halo_->ids()[found] : ids_[found];
    }

    // Calls found(begin, end) for the runs of particles and images that may lie in the box, row by row.
    template <class Found> void for_each_run_in(const CellGrid &grid, const Box &box, const Found &found) const;

    int64_t bytes() const;

private:
    template <class CellOf>
    void put_in_order_of_cells(const CellGrid &grid, const std::vector<int64_t> &id, const CellOf &cell_of);

    int64_t first_ = INT64_MAX; // number of particles, once there are images
    CellGrid cells_;
    // The first column of the particles: in their rows, images are either before all of them or behind. (Whole cells are one
    // process's, and a box of them.)
    int64_t split_ = 0;
    Halo *halo_ = nullptr;
    Field<int32_t> source_;
    Field<double> shift_;

    // As they are found, before they are in order.
    struct Image {
        int32_t source;
        double shift;
        Cell cell; // by its source's, so that rounding never puts it among the particles
    };
    std::vector<Image> found_;
    std::vector<int64_t> ids_;
    Field<double> room_;
};

template <class Found> void Images::for_each_run_in(const CellGrid &grid, const Box &box, const Found &found) const {
    const int64_t left = grid.column_of(box.x_min), right = grid.column_of(box.x_max);
    int64_t bottom = cells_.first_row(), top = cells_.last_row();
    if (grid.count() > 0) {
        bottom = std::min(bottom, grid.first_row());
        top = std::max(top, grid.last_row());
    }
    bottom = std::max(bottom, grid.row_of(box.y_min));
    top = std::min(top, grid.row_of(box.y_max));
    const auto beyond = [&](int64_t begin, int64_t end) { found(first_ + begin, first_ + end); };
    for (int64_t row = bottom; row <= top; ++row) {
        cells_.run(row, left, std::min(right, split_ - 1), beyond);
        if (grid.count() > 0)
            grid.run(row, left, right, found);
        cells_.run(row, std::max(left, split_), right, beyond);
    }
}

// Calls found(begin, end) for the runs of particles and images that may lie in the box, in the order of their cells.
template <class Found>
void for_each_run_in(const CellGrid &grid, const Images &images, const Box &box, const Found &found) {
    if (images.count == 0)
        grid.for_each_run(box, found);
    else
        images.for_each_run_in(grid, box, found);
}

// Calls found(j) for the particles and images that may lie within `radius` of (x, y), in a fixed order.
template <class Found>
void for_each_candidate(const CellGrid &grid, const Images &images, double x, double y, double radius,
                        const Found &found) {
    for_each_run_in(grid, images, {x - radius, x + radius, y - radius, y + radius}, [&](int64_t begin, int64_t end) {
        for (int64_t j = begin; j < end; ++j)
            found(j);
    });
}

} // namespace gp
