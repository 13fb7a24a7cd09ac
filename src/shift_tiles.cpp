#include "shift_tiles.hpp"

#include <cmath>

namespace gp {

namespace {

// Larger scenes have wider tiles: what is made by one thread, and told to other processes, stays small. So have those with
// less than a particle in a tile, where single grains have flown far: material has some twenty or more.
constexpr int64_t few_tiles = 64, most_tiles = 4096;

} // namespace

void ShiftTiles::cut(const CellGrid &grid, const Box &box, int64_t particles, double least) {
    const CellFrame &frame = grid.frame();
    closed_ = frame.columns() > 0;
    first_column_ = closed_ ? 0 : frame.column_of(box.x_min);
    last_column_ = closed_ ? frame.columns() - 1 : frame.column_of(box.x_max);
    first_row_ = frame.row_of(box.y_min);
    last_row_ = frame.row_of(box.y_max);
    const int64_t across = last_column_ - first_column_ + 1, upward = last_row_ - first_row_ + 1;
    wide_ = static_cast<int64_t>(std::ceil(least / frame.width()));
    high_ = static_cast<int64_t>(std::ceil(least / frame.height()));
    // The last ones take what is left over, so that none is narrower.
    const auto count = [](int64_t cells, int64_t of_tile) { return std::max<int64_t>(1, cells / of_tile); };
    const int64_t most = std::clamp(particles, few_tiles, most_tiles);
    for (;; wide_ *= 2, high_ *= 2) {
        columns_ = count(across, wide_);
        rows_ = count(upward, high_);
        if (static_cast<double>(columns_) * static_cast<double>(rows_) <= static_cast<double>(most))
            break;
    }
    width_ = std::min(static_cast<double>(wide_) * frame.width(), static_cast<double>(high_) * frame.height());
    const auto needed = static_cast<std::size_t>(4 * columns_ * rows_);
    if (extremes_.capacity() < needed) // room, so that later ones of about this size fit
        extremes_.reserve(needed + needed / 4);
    extremes_.resize(needed);
}

void ShiftTiles::measure(const Particles &p, const CellGrid &grid, const Field<double> &x, const Field<double> &y,
                         int threads) {
    for_each_block<8>(threads, columns_ * rows_, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t tile = begin; tile < end; ++tile) {
            const int64_t column = tile % columns_, row = tile / columns_;
            const int64_t left = first_column_ + column * wide_, bottom = first_row_ + row * high_;
            const int64_t right = column + 1 < columns_ ? left + wide_ - 1 : last_column_;
            const int64_t top = row + 1 < rows_ ? bottom + high_ - 1 : last_row_;
            Range range;
            if (grid.count() > 0)
                for (int64_t k = grid.row_from(std::max(bottom, grid.first_row())); k <= std::min(top, grid.last_row());
                     k = grid.row_from(k + 1))
                    grid.run(k, left, right, [&](int64_t from, int64_t to) {
                        for (int64_t i = from; i < to; ++i) {
                            const double dx = p.x[i] - x[i], dy = p.y[i] - y[i];
                            range.add({-dx, dx, -dy, dy});
                        }
                    });
            double *e = extremes_.data() + 4 * tile;
            e[0] = range.left;
            e[1] = range.right;
            e[2] = range.down;
            e[3] = range.up;
        }
    });
}

ShiftTiles::Shifts ShiftTiles::shifts() const {
    double near2 = 0;
    Range all;
    const auto look_at = [&](const Range &range, int64_t column, int64_t row) {
        if (closed_)
            column = (column + columns_) % columns_;
        if (column >= 0 && column < columns_ && row < rows_)
            near2 = std::max(near2, range.shift2(range_of(row * columns_ + column)));
    };
    for (int64_t row = 0; row < rows_; ++row)
        for (int64_t column = 0; column < columns_; ++column) {
            const Range range = range_of(row * columns_ + column);
            all.add(range);
            look_at(range, column, row);
            look_at(range, column + 1, row);
            for (int64_t k = -1; k <= 1; ++k)
                look_at(range, column + k, row + 1);
        }
    Range still{0, 0, 0, 0};
    const double any = std::sqrt(all.shift2(all)), own = std::sqrt(all.shift2(still));
    return {std::sqrt(near2), any, own};
}

} // namespace gp
