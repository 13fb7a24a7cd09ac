// Cell sort, and the form of neighbour lists.
//
// Particles are sorted by cell, row by row, so that the candidates of one row of cells are one run of memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry.hpp"
#include "parallel.hpp"
#include "particles.hpp"

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

Box box_of(const Particles &particles); // that of none is empty: from infinity to minus infinity

// A segment and what is within a margin of it, with some more at its ends.
inline Box box_around(const Segment &s, double margin) {
    const Vector end = s.origin + s.length * s.tangent;
    return {std::min(s.origin.x(), end.x()) - margin, std::max(s.origin.x(), end.x()) + margin,
            std::min(s.origin.y(), end.y()) - margin, std::max(s.origin.y(), end.y()) + margin};
}

// A cell by its numbers, counted from the origin.
struct Cell {
    int64_t column, row;
};

// The cells of the plane. In a periodic scene a whole number of columns makes a period, from its beginning on.
class CellFrame {
public:
    CellFrame() = default;
    // For material within a box: one too wide to number its cells gets wider cells, which is still right, only slower.
    CellFrame(const Box &box, const Period &period, double cell_width, double cell_height);

    int64_t column_of(double x) const { return number((x - x_) * inverse_width_); }
    int64_t row_of(double y) const { return number(y * inverse_height_); }
    // Of a particle, which is inside the period but for rounding.
    Cell cell_of(double x, double y) const {
        const int64_t column = column_of(x);
        return {columns_ > 0 ? std::clamp<int64_t>(column, 0, columns_ - 1) : column, row_of(y)};
    }
    int64_t columns() const { return columns_; } // of a period; 0: the scene is not periodic
    // The middle of a cell.
    Vector middle_of(const Cell &cell) const {
        return {x_ + (static_cast<double>(cell.column) + 0.5) / inverse_width_,
                (static_cast<double>(cell.row) + 0.5) / inverse_height_};
    }
    // m, edges.
    double width() const { return 1 / inverse_width_; }
    double height() const { return 1 / inverse_height_; }

private:
    // Far outside is outside: what does not fit into an integer must not be made one.
    static int64_t number(double cells) {
        constexpr double far = 1e15;
        return static_cast<int64_t>(std::floor(cells > -far ? (cells < far ? cells : far) : -far));
    }

    double x_ = 0, inverse_width_ = 1, inverse_height_ = 1;
    int64_t columns_ = 0;
};

// Cells over particles, in the order of which their neighbours are gone through: row by row, then column by column, then by id.
// So sums over neighbours do not depend on who else there is, nor on who works on them. Where the particles are few for the
// space they span (fragments far away), a search over the sorted keys replaces the table of cells.
class CellGrid {
public:
    // Sorts the particles (their carried fields are reordered) into cells. Accelerations are over: their memory is what it
    // works in.
    void sort(Particles &particles, const CellFrame &frame, int threads);

    // The same for particles that stay where they are: order() alone. cell_of(i): from low to high; room for a number each.
    template <class CellOf>
    void number(const CellFrame &frame, const Cell &low, const Cell &high, int64_t n, const int64_t *id,
                const CellOf &cell_of, Field<double> &room, int threads);

    const Box &box() const { return box_; }
    int64_t count() const { return count_; }
    const Field<int32_t> &order() const { return order_; } // of the last sort: sorted position -> old position
    int64_t bytes() const;

    int64_t column_of(double x) const { return frame_.column_of(x); }
    int64_t row_of(double y) const { return frame_.row_of(y); }
    const CellFrame &frame() const { return frame_; }
    int64_t first_column() const { return first_column_; }
    int64_t first_row() const { return first_row_; }
    int64_t last_row() const { return first_row_ + rows_ - 1; }
    // The first row from this one on that may have particles; beyond the last one where none has. In a search empty ones are left
    // out: a grain that has flown a million metres leaves ten million of them.
    int64_t row_from(int64_t row) const {
        return start_.empty() && row > first_row_ && row <= last_row() ? row_found_from(row) : row;
    }

    // Calls body(begin, end) for the run of particles in a row's columns left .. right.
    template <class Body> void run(int64_t row, int64_t left, int64_t right, const Body &body) const {
        const int64_t from = std::max<int64_t>(left - first_column_, 0),
                      to = std::min(right - first_column_, columns_ - 1);
        row -= first_row_;
        if (from <= to && row >= 0 && row < rows_)
            body(run_begin(row * columns_ + from), run_begin(row * columns_ + to + 1));
    }

    // Calls body(begin, end) for the run of particles in each row of cells that the box touches.
    template <class Body> void for_each_run(const Box &box, const Body &body) const {
        if (count_ == 0)
            return;
        const int64_t left = column_of(box.x_min) - first_column_, right = column_of(box.x_max) - first_column_;
        const int64_t bottom = row_of(box.y_min) - first_row_, top = row_of(box.y_max) - first_row_;
        if (right < 0 || left >= columns_ || top < 0 || bottom >= rows_)
            return;
        for (int64_t row = bottom < 0 ? 0 : bottom; row <= (top < rows_ ? top : rows_ - 1); ++row) {
            const int64_t first = row * columns_ + (left < 0 ? 0 : left);
            const int64_t last = row * columns_ + (right < columns_ ? right : columns_ - 1);
            body(run_begin(first), run_begin(last + 1));
        }
    }

private:
    int64_t run_begin(int64_t cell) const; // first particle whose cell is not before this one
    int64_t row_found_from(int64_t row) const;
    void put_in_order(const int64_t *id, const Field<double> &cell_of, int threads);
    void put_in_order_by_search(const int64_t *id);
    bool is_dense(int64_t n) const {
        return static_cast<double>(columns_) * static_cast<double>(rows_) <= 4.0 * static_cast<double>(n) + 4096.0;
    }

    CellFrame frame_;
    Box box_;
    int64_t first_column_ = 0, first_row_ = 0, columns_ = 0, rows_ = 0, count_ = 0;
    Field<int32_t> start_;    // table of cells, when it is small enough
    Field<int64_t> key_;      // cell of each sorted particle, for the search otherwise
    Field<int32_t> order_;    // sorted position -> old position
    Field<int64_t> unsorted_; // cells of the particles in their old order, for the search
};

template <class CellOf>
void CellGrid::number(const CellFrame &frame, const Cell &low, const Cell &high, int64_t n, const int64_t *id,
                      const CellOf &cell_of, Field<double> &room, int threads) {
    frame_ = frame;
    count_ = n;
    if (n == 0)
        return;
    first_column_ = low.column;
    first_row_ = low.row;
    columns_ = high.column - low.column + 1;
    rows_ = high.row - low.row + 1;
    order_.resize(n);
    const auto number_all = [&](auto &number) {
        for_each_block(threads, n, [&](int64_t, int64_t begin, int64_t end) {
            for (int64_t i = begin; i < end; ++i) {
                const Cell at = cell_of(i);
                number[i] = static_cast<std::remove_reference_t<decltype(number[i])>>((at.row - first_row_) * columns_ +
                                                                                      (at.column - first_column_));
            }
        });
    };
    if (is_dense(n)) {
        number_all(room); // exact: they are few
        put_in_order(id, room, threads);
    } else {
        unsorted_.resize(n);
        number_all(unsorted_);
        put_in_order_by_search(id);
    }
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
