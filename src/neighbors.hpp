// Cell sort, and the form of neighbour lists.
//
// Particles are sorted by cell, row by row, so that the candidates of one row of cells are one run of memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "particles.hpp"
#include "periodic.hpp"

namespace gp {

struct Box {
    double x_min = 0, x_max = 0, y_min = 0, y_max = 0;
    // Distance to another box; 0 where they overlap.
    double gap(const Box &other) const {
        const double x = std::max({0.0, x_min - other.x_max, other.x_min - x_max});
        const double y = std::max({0.0, y_min - other.y_max, other.y_min - y_max});
        return std::hypot(x, y);
    }
};

// A segment and what is within a margin of it, with some more at its ends.
inline Box box_around(const Segment &s, double margin) {
    const Vector end = s.origin + s.length * s.tangent;
    return {std::min(s.origin.x(), end.x()) - margin, std::max(s.origin.x(), end.x()) + margin,
            std::min(s.origin.y(), end.y()) - margin, std::max(s.origin.y(), end.y()) + margin};
}

// Cells over the particles. Where the particles are few for the space they span (fragments far away), a search over the
// sorted keys replaces the table of cells.
class CellGrid {
public:
    // Sorts the particles (their carried fields are reordered) into cells of the given size. The sort is stable. Accelerations
    // are over: their memory is what it works in.
    void sort(Particles &particles, double cell_width, double cell_height, int threads);

    const Box &box() const { return box_; }
    const Field<int32_t> &order() const { return order_; } // of the last sort: sorted position -> old position
    int64_t bytes() const;

    // Calls body(begin, end) for the run of particles in each row of cells that the box touches.
    template <class Body> void for_each_run(const Box &box, const Body &body) const {
        if (count_ == 0)
            return;
        const int64_t left = column_of(box.x_min), right = column_of(box.x_max);
        const int64_t bottom = row_of(box.y_min), top = row_of(box.y_max);
        if (right < 0 || left >= columns_ || top < 0 || bottom >= rows_)
            return;
        for (int64_t row = bottom < 0 ? 0 : bottom; row <= (top < rows_ ? top : rows_ - 1); ++row) {
            const int64_t first = row * columns_ + (left < 0 ? 0 : left);
            const int64_t last = row * columns_ + (right < columns_ ? right : columns_ - 1);
            body(run_begin(first), run_begin(last + 1));
        }
    }

    int64_t column_of(double x) const { return cell_number((x - box_.x_min) * inverse_width_); }
    int64_t row_of(double y) const { return cell_number((y - box_.y_min) * inverse_height_); }

private:
    // Far outside of the grid is outside: what does not fit into an integer must not be made one.
    static int64_t cell_number(double cells) {
        constexpr double far = 1e15;
        return static_cast<int64_t>(std::floor(cells > -far ? (cells < far ? cells : far) : -far));
    }
    int64_t run_begin(int64_t cell) const; // first particle whose cell is not before this one

    Box box_;
    double inverse_width_ = 0, inverse_height_ = 0;
    int64_t columns_ = 0, rows_ = 0, count_ = 0;
    Field<int32_t> start_;    // table of cells, when it is small enough
    Field<int64_t> key_;      // cell of each sorted particle, for the search otherwise
    Field<int32_t> order_;    // sorted position -> old position
    Field<int64_t> unsorted_; // cells of the particles in their old order, for the search
};

// Calls found(begin, end) for the runs of particles and images that may lie in the box, in a fixed order.
template <class Found>
void for_each_run_in(const CellGrid &grid, const Images &images, const Box &box, const Found &found) {
    grid.for_each_run(box, found);
    if (images.count == 0)
        return;
    for (int side = 0; side < 2; ++side) {
        const double shift = images.shift(side);
        grid.for_each_run({box.x_min - shift, box.x_max - shift, box.y_min, box.y_max},
                          [&](int64_t begin, int64_t end) {
                              for (int64_t j = begin; j < end; ++j)
                                  if (const int32_t image = images.image_of(j, side); image >= 0)
                                      found(image, image + 1);
                          });
    }
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

// Rows of neighbour indices: entries of row i are index[start[i]] .. index[start[i + 1]].
struct NeighborList {
    Field<int64_t> start;
    Field<int32_t> index;

    int64_t bytes() const {
        return static_cast<int64_t>(start.capacity() * sizeof(int64_t) + index.capacity() * sizeof(int32_t));
    }
};

} // namespace gp
