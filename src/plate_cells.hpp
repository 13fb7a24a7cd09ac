// Which plates are about a place: cells that name the plates within reach of any place in them. A line of many short plates
// costs a ghost only those about it.
#pragma once

#include <cstdint>
#include <vector>

#include "plate_chains.hpp"

namespace gp {

class PlateCells {
public:
    // Sorts the near images into cells. Places asked for lie within `reach` of the box.
    void sort(const std::vector<PlateImage> &images, const Box &box, double reach);

    // Images, in order, among which are all within `reach` of a place.
    struct Run {
        const int32_t *first, *last;
        const int32_t *begin() const { return first; }
        const int32_t *end() const { return last; }
    };
    Run about(double x, double y) const;
    int64_t longest() const { return longest_; } // of all runs

    int64_t bytes() const { return static_cast<int64_t>((start_.capacity() + image_.capacity()) * sizeof(int32_t)); }

private:
    template <class Body> void for_each_cell(const Segment &segment, double reach, const Body &body) const;

    double x_ = 0, y_ = 0, size_ = 1; // m: corner of the first cell, edge
    int64_t columns_ = 0, rows_ = 0, longest_ = 0;
    Field<int32_t> start_, image_;
};

} // namespace gp
