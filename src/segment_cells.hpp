// Which segments are about a place: cells that name the segments within reach of any place in them. A line of many short plates
// costs a ghost or a particle only those about it.
#pragma once

#include <cstdint>

#include "neighbors.hpp"

namespace gp {

class SegmentCells {
public:
    // Sorts segments 0 .. count into cells. segment_of(k): a pointer, NULL for one to leave out. Places asked for lie within
    // `reach` of the box.
    template <class SegmentOf> void sort(int64_t count, const SegmentOf &segment_of, const Box &box, double reach) {
        lay_out(box, reach);
        const auto for_each_entry = [&](const auto &found) {
            for (int64_t k = 0; k < count; ++k)
                if (const Segment *segment = segment_of(k))
                    for_each_cell(*segment, reach, [&](int64_t cell) { found(cell, static_cast<int32_t>(k)); });
        };
        for_each_entry([&](int64_t cell, int32_t) { ++start_[cell + 1]; });
        make_room();
        for_each_entry([&](int64_t cell, int32_t k) { index_[start_[cell]++] = k; });
        close_rows();
    }

    // Segments, in order, among which are all within `reach` of a place.
    struct Run {
        const int32_t *first = nullptr, *last = nullptr;
        const int32_t *begin() const { return first; }
        const int32_t *end() const { return last; }
        bool empty() const { return first == last; }
    };
    Run about(double x, double y) const;
    int64_t longest() const { return longest_; } // of all runs

    int64_t bytes() const { return static_cast<int64_t>((start_.capacity() + index_.capacity()) * sizeof(int32_t)); }

private:
    void lay_out(const Box &box, double reach);
    void make_room();
    void close_rows();

    // The cells within reach of a segment, column by column: a long one that is not level is not in all cells of its box.
    template <class Body> void for_each_cell(const Segment &s, double reach, const Body &body) const {
        const double x_end = s.origin.x() + s.length * s.tangent.x();
        const double x_low = std::min(s.origin.x(), x_end) - reach, x_high = std::max(s.origin.x(), x_end) + reach;
        const int64_t right = std::min(columns_ - 1, clamped((x_high - x_) / size_, columns_));
        for (int64_t column = std::max<int64_t>(0, clamped((x_low - x_) / size_, columns_)); column <= right;
             ++column) {
            const double west = x_ + static_cast<double>(column) * size_ - reach, east = west + size_ + 2 * reach;
            double from = 0, to = s.length; // along, of the part between west and east
            if (std::abs(s.tangent.x()) * s.length > size_) {
                const double a = (west - s.origin.x()) / s.tangent.x(), b = (east - s.origin.x()) / s.tangent.x();
                from = std::clamp(std::min(a, b), 0.0, s.length);
                to = std::clamp(std::max(a, b), 0.0, s.length);
            }
            const double y_from = s.origin.y() + from * s.tangent.y(), y_to = s.origin.y() + to * s.tangent.y();
            const int64_t top = std::min(rows_ - 1, clamped((std::max(y_from, y_to) + reach - y_) / size_, rows_));
            const int64_t bottom = std::max<int64_t>(0, clamped((std::min(y_from, y_to) - reach - y_) / size_, rows_));
            for (int64_t row = bottom; row <= top; ++row)
                body(row * columns_ + column);
        }
    }
    static int64_t clamped(double cell, int64_t count) {
        return static_cast<int64_t>(std::clamp(std::floor(cell), -1.0, static_cast<double>(count)));
    }

    double x_ = 0, y_ = 0, size_ = 1; // m: corner of the first cell, edge
    int64_t columns_ = 0, rows_ = 0, longest_ = 0;
    Field<int32_t> start_, index_;
};

} // namespace gp
