#include "neighbors.hpp"

#include <algorithm>
#include <numeric>

#include "error.hpp"
#include "parallel.hpp"

namespace gp {

void CellGrid::sort(Particles &particles, double cell_width, double cell_height, int threads) {
    const int64_t n = particles.count;
    count_ = n;
    if (n == 0)
        return;
    // Without the images of before, which are in the arrays behind.
    const auto [x_low, x_high] = std::minmax_element(particles.x.begin(), particles.x.begin() + n);
    const auto [y_low, y_high] = std::minmax_element(particles.y.begin(), particles.y.begin() + n);
    box_ = {*x_low, *x_high, *y_low, *y_high};
    // A box too wide to number its cells gets wider cells: still right, only slower.
    const double widest = std::max(box_.x_max - box_.x_min, box_.y_max - box_.y_min);
    inverse_width_ = 1.0 / std::max(cell_width, widest / 1e9);
    inverse_height_ = 1.0 / std::max(cell_height, widest / 1e9);
    const double cells = widest * std::max(inverse_width_, inverse_height_);
    if (!(cells < 2e9 && inverse_width_ > 0 && inverse_height_ > 0))
        throw make_error(GP_E_DIVERGED,
                         "particles from (%g, %g) to (%g, %g) m cannot be sorted into cells of %g x %g m", box_.x_min,
                         box_.y_min, box_.x_max, box_.y_max, cell_width, cell_height);
    columns_ = column_of(box_.x_max) + 1;
    rows_ = row_of(box_.y_max) + 1;

    order_.resize(n);
    const auto number_cells = [&](auto &cell) {
        for_each_block(threads, n, [&](int64_t, int64_t begin, int64_t end) {
            for (int64_t i = begin; i < end; ++i)
                cell[i] = static_cast<std::remove_reference_t<decltype(cell[i])>>(row_of(particles.y[i]) * columns_ +
                                                                                  column_of(particles.x[i]));
        });
    };
    const bool dense =
        static_cast<double>(columns_) * static_cast<double>(rows_) <= 4.0 * static_cast<double>(n) + 4096.0;
    if (dense) {
        key_.clear();
        Field<double> &cell = particles.ay; // exact: they are few
        number_cells(cell);
        const auto cell_of = [&](int64_t i) { return static_cast<int64_t>(cell[i]); };
        start_.assign(columns_ * rows_ + 1, 0);
        for (int64_t i = 0; i < n; ++i)
            ++start_[cell_of(i) + 1];
        std::partial_sum(start_.begin(), start_.end(), start_.begin());
        for (int64_t i = 0; i < n; ++i)
            order_[start_[cell_of(i)]++] = static_cast<int32_t>(i);
        // Filling moved each cell's start to its end, which is the next cell's start.
        std::copy_backward(start_.begin(), start_.end() - 1, start_.end());
        start_[0] = 0;
    } else {
        start_.clear();
        unsorted_.resize(n);
        number_cells(unsorted_);
        std::iota(order_.begin(), order_.end(), 0);
        std::sort(order_.begin(), order_.end(), [&](int32_t a, int32_t b) {
            return unsorted_[a] != unsorted_[b] ? unsorted_[a] < unsorted_[b] : a < b;
        });
        key_.resize(n);
        for (int64_t i = 0; i < n; ++i)
            key_[i] = unsorted_[order_[i]];
    }
    particles.reorder(order_, threads);
}

int64_t CellGrid::run_begin(int64_t cell) const {
    if (!start_.empty())
        return start_[cell];
    return std::lower_bound(key_.begin(), key_.end(), cell) - key_.begin();
}

int64_t CellGrid::bytes() const {
    return static_cast<int64_t>((start_.capacity() + order_.capacity()) * sizeof(int32_t) +
                                (key_.capacity() + unsorted_.capacity()) * sizeof(int64_t));
}

} // namespace gp
