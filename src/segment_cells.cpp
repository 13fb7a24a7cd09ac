#include "segment_cells.hpp"

#include <numeric>

namespace gp {

namespace {

// Where fragments far away would make the table long, its cells are larger.
constexpr double most_cells = 1 << 16;

} // namespace

void SegmentCells::lay_out(const Box &box, double reach) {
    if (!(box.x_min <= box.x_max)) { // without particles nobody looks
        columns_ = rows_ = 0;
        start_.assign(1, 0);
        return;
    }
    const double width = box.x_max - box.x_min + 2 * reach, height = box.y_max - box.y_min + 2 * reach;
    size_ = std::max({reach, (width + height) / most_cells, std::sqrt(width / most_cells) * std::sqrt(height)});
    x_ = box.x_min - reach;
    y_ = box.y_min - reach;
    columns_ = static_cast<int64_t>(width / size_) + 1;
    rows_ = static_cast<int64_t>(height / size_) + 1;
    start_.assign(columns_ * rows_ + 1, 0);
}

void SegmentCells::make_room() {
    longest_ = *std::max_element(start_.begin(), start_.end());
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    index_.resize(start_.back());
}

// The beginning of each cell has become its end.
void SegmentCells::close_rows() {
    for (int64_t cell = columns_ * rows_; cell > 0; --cell)
        start_[cell] = start_[cell - 1];
    start_[0] = 0;
}

SegmentCells::Run SegmentCells::about(double x, double y) const {
    const double column = std::floor((x - x_) / size_), row = std::floor((y - y_) / size_);
    if (!(column >= 0 && column < static_cast<double>(columns_) && row >= 0 && row < static_cast<double>(rows_)))
        return {};
    const int64_t cell = static_cast<int64_t>(row) * columns_ + static_cast<int64_t>(column);
    return {index_.data() + start_[cell], index_.data() + start_[cell + 1]};
}

} // namespace gp
