#include "plate_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gp {

namespace {

// Where fragments far away would make the table long, its cells are larger.
constexpr double most_cells = 1 << 16;

} // namespace

// The cells within reach of a segment, column by column: a long one that is not level is not in all cells of its box.
template <class Body> void PlateCells::for_each_cell(const Segment &s, double reach, const Body &body) const {
    const auto clamped = [](double cell, int64_t count) {
        return static_cast<int64_t>(std::clamp(std::floor(cell), -1.0, static_cast<double>(count)));
    };
    const double x_end = s.origin.x() + s.length * s.tangent.x();
    const double x_low = std::min(s.origin.x(), x_end) - reach, x_high = std::max(s.origin.x(), x_end) + reach;
    const int64_t left = std::max<int64_t>(0, clamped((x_low - x_) / size_, columns_));
    const int64_t right = std::min(columns_ - 1, clamped((x_high - x_) / size_, columns_));
    for (int64_t column = left; column <= right; ++column) {
        const double west = x_ + static_cast<double>(column) * size_ - reach, east = west + size_ + 2 * reach;
        double from = 0, to = s.length; // along, of the part between west and east
        if (std::abs(s.tangent.x()) * s.length > size_) {
            const double a = (west - s.origin.x()) / s.tangent.x(), b = (east - s.origin.x()) / s.tangent.x();
            from = std::clamp(std::min(a, b), 0.0, s.length);
            to = std::clamp(std::max(a, b), 0.0, s.length);
        }
        const double y_from = s.origin.y() + from * s.tangent.y(), y_to = s.origin.y() + to * s.tangent.y();
        const int64_t bottom = std::max<int64_t>(0, clamped((std::min(y_from, y_to) - reach - y_) / size_, rows_));
        const int64_t top = std::min(rows_ - 1, clamped((std::max(y_from, y_to) + reach - y_) / size_, rows_));
        for (int64_t row = bottom; row <= top; ++row)
            body(row * columns_ + column);
    }
}

void PlateCells::sort(const std::vector<PlateImage> &images, const Box &box, double reach) {
    const double width = box.x_max - box.x_min + 2 * reach, height = box.y_max - box.y_min + 2 * reach;
    size_ = std::max(reach, (width + height) / most_cells);
    size_ = std::max(size_, std::sqrt(width / most_cells) * std::sqrt(height));
    x_ = box.x_min - reach;
    y_ = box.y_min - reach;
    columns_ = static_cast<int64_t>(width / size_) + 1;
    rows_ = static_cast<int64_t>(height / size_) + 1;
    start_.assign(columns_ * rows_ + 1, 0);
    for (const PlateImage &image : images)
        if (image.near)
            for_each_cell(image.segment, reach, [&](int64_t cell) { ++start_[cell + 1]; });
    longest_ = *std::max_element(start_.begin(), start_.end());
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    image_.resize(start_[columns_ * rows_]);
    for (std::size_t k = 0; k < images.size(); ++k)
        if (images[k].near)
            for_each_cell(images[k].segment, reach,
                          [&](int64_t cell) { image_[start_[cell]++] = static_cast<int32_t>(k); });
    // start_[cell] has become the end of the cell.
    for (int64_t cell = columns_ * rows_; cell > 0; --cell)
        start_[cell] = start_[cell - 1];
    start_[0] = 0;
}

PlateCells::Run PlateCells::about(double x, double y) const {
    const double column = std::floor((x - x_) / size_), row = std::floor((y - y_) / size_);
    if (!(column >= 0 && column < static_cast<double>(columns_) && row >= 0 && row < static_cast<double>(rows_)))
        return {image_.data(), image_.data()};
    const int64_t cell = static_cast<int64_t>(row) * columns_ + static_cast<int64_t>(column);
    return {image_.data() + start_[cell], image_.data() + start_[cell + 1]};
}

} // namespace gp
