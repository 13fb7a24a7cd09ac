#include "neighbors.hpp"

#include <algorithm>
#include <numeric>

#include "error.hpp"

namespace gp {

CellFrame::CellFrame(const Box &box, const Period &period, double cell_width, double cell_height) {
    const double widest = std::max(box.x_max - box.x_min, box.y_max - box.y_min);
    const double width = std::max(cell_width, widest / 1e9), height = std::max(cell_height, widest / 1e9);
    inverse_width_ = 1.0 / width;
    inverse_height_ = 1.0 / height;
    if (period) {
        x_ = period.x_min;
        const double whole = std::max(1.0, std::floor(period.length * inverse_width_));
        columns_ = static_cast<int64_t>(whole);
        inverse_width_ = whole / period.length;
    }
    const double cells = widest * std::max(inverse_width_, inverse_height_);
    if (!(cells < 2e9 && inverse_width_ > 0 && inverse_height_ > 0))
        throw make_error(GP_E_DIVERGED,
                         "particles from (%g, %g) to (%g, %g) m cannot be sorted into cells of %g x %g m", box.x_min,
                         box.y_min, box.x_max, box.y_max, cell_width, cell_height);
}

Box box_of(const Particles &particles) {
    double x_min = INFINITY, x_max = -INFINITY, y_min = INFINITY, y_max = -INFINITY;
    const double *const x = particles.x.data(), *const y = particles.y.data();
    // Without the images of before, which are in the arrays behind.
#pragma omp simd reduction(min : x_min, y_min) reduction(max : x_max, y_max)
    for (int64_t i = 0; i < particles.count; ++i) {
        x_min = x[i] < x_min ? x[i] : x_min;
        x_max = x[i] > x_max ? x[i] : x_max;
        y_min = y[i] < y_min ? y[i] : y_min;
        y_max = y[i] > y_max ? y[i] : y_max;
    }
    return {x_min, x_max, y_min, y_max};
}

void CellGrid::sort(Particles &particles, const CellFrame &frame, int threads) {
    box_ = box_of(particles);
    number(
        frame, frame.cell_of(box_.x_min, box_.y_min), frame.cell_of(box_.x_max, box_.y_max), particles.count,
        particles.id.data(), [&](int64_t i) { return frame.cell_of(particles.x[i], particles.y[i]); }, particles.ay,
        threads);
    if (particles.count > 0)
        particles.reorder(order_, threads);
}

namespace {

// Of one cell, mostly some two, mostly in order already.
void sort_by_id(int32_t *begin, int32_t *end, const int64_t *id) {
    const auto before = [id](int32_t a, int32_t b) { return id[a] < id[b]; };
    if (end - begin > 16) {
        std::sort(begin, end, before);
        return;
    }
    for (int32_t *next = begin + 1; next < end; ++next)
        for (int32_t *at = next; at > begin && before(at[0], at[-1]); --at)
            std::swap(at[0], at[-1]);
}

} // namespace

void CellGrid::put_in_order(const int64_t *id, const Field<double> &cell, int threads) {
    const auto cell_of = [&](int64_t i) { return static_cast<int64_t>(cell[i]); };
    key_.clear();
    start_.assign(columns_ * rows_ + 1, 0);
    for (int64_t i = 0; i < count_; ++i)
        ++start_[cell_of(i) + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    for (int64_t i = 0; i < count_; ++i)
        order_[start_[cell_of(i)]++] = static_cast<int32_t>(i);
    // Filling moved each cell's start to its end, which is the next cell's start.
    std::copy_backward(start_.begin(), start_.end() - 1, start_.end());
    start_[0] = 0;
    for_each_block(threads, columns_ * rows_, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k)
            if (start_[k + 1] - start_[k] > 1)
                sort_by_id(order_.data() + start_[k], order_.data() + start_[k + 1], id);
    });
}

void CellGrid::put_in_order_by_search(const int64_t *id) {
    start_.clear();
    std::iota(order_.begin(), order_.end(), 0);
    std::sort(order_.begin(), order_.end(), [&](int32_t a, int32_t b) {
        return unsorted_[a] != unsorted_[b] ? unsorted_[a] < unsorted_[b] : id[a] < id[b];
    });
    key_.resize(count_);
    for (int64_t i = 0; i < count_; ++i)
        key_[i] = unsorted_[order_[i]];
}

int64_t CellGrid::run_begin(int64_t cell) const {
    if (!start_.empty())
        return start_[cell];
    return std::lower_bound(key_.begin(), key_.end(), cell) - key_.begin();
}

int64_t CellGrid::row_found_from(int64_t row) const {
    const int64_t next = run_begin((row - first_row_) * columns_);
    return next < count_ ? first_row_ + key_[next] / columns_ : last_row() + 1;
}

int64_t CellGrid::bytes() const {
    return static_cast<int64_t>((start_.capacity() + order_.capacity()) * sizeof(int32_t) +
                                (key_.capacity() + unsorted_.capacity()) * sizeof(int64_t));
}

} // namespace gp
