#include "periodic.hpp"

namespace gp {

void Images::make(Particles &p, const CellGrid &grid, const Period &period, double reach) {
    const int64_t n = p.count;
    const CellFrame &frame = grid.frame();
    halo_ = nullptr;
    found_.clear();
    ids_.clear();
    for (const bool up : {true, false})
        for (int64_t i = 0; i < n; ++i) {
            const double from_end = up ? p.x[i] - period.x_min : period.x_min + period.length - p.x[i];
            if (from_end > reach)
                continue;
            Cell cell = frame.cell_of(p.x[i], p.y[i]);
            cell.column += up ? frame.columns() : -frame.columns();
            found_.push_back({static_cast<int32_t>(i), up ? period.length : -period.length, cell});
            ids_.push_back(p.id[i]);
        }
    count = static_cast<int64_t>(found_.size());
    p.make_room(count);
    put_in_order_of_cells(grid, ids_, [&](int64_t k) { return found_[k].cell; });
    source_.resize(count);
    shift_.resize(count);
    for (int64_t k = 0; k < count; ++k) {
        const Image &image = found_[cells_.order()[k]];
        source_[k] = image.source;
        shift_[k] = image.shift;
        p.column[first_ + k] = p.column[image.source];
    }
    copy_all(p);
}

void Images::make(Particles &p, const CellGrid &grid, Halo &halo) {
    halo_ = &halo;
    count = halo.count();
    p.make_room(count);
    put_in_order_of_cells(grid, halo.ids(), [&](int64_t k) { return halo.cell(k); });
    halo.set_order(cells_.order(), first_, p.column.data() + first_);
    copy_all(p);
}

template <class CellOf>
void Images::put_in_order_of_cells(const CellGrid &grid, const std::vector<int64_t> &id, const CellOf &cell_of) {
    first_ = grid.count();
    split_ = grid.first_column();
    Cell low{INT64_MAX, INT64_MAX}, high{INT64_MIN, INT64_MIN};
    for (int64_t k = 0; k < count; ++k) {
        const Cell at = cell_of(k);
        low = {std::min(low.column, at.column), std::min(low.row, at.row)};
        high = {std::max(high.column, at.column), std::max(high.row, at.row)};
    }
    room_.resize(count);
    cells_.number(grid.frame(), low, high, count, id.data(), cell_of, room_, 1);
}

void Images::copy_all(Particles &p) const {
    copy_motion(p);
    if (p.fluidity.empty())
        copy({&p.density, &p.pressure, &p.sxx, &p.sxy});
    else
        copy({&p.density, &p.pressure, &p.sxx, &p.sxy, &p.fluidity});
}

void Images::copy(std::initializer_list<Field<double> *> fields) const {
    if (halo_) {
        halo_->copy(fields);
        return;
    }
    for (Field<double> *field : fields)
        for (int64_t k = 0; k < count; ++k)
            (*field)[first_ + k] = (*field)[source_[k]];
}

void Images::copy(Field<uint8_t> &field) const {
    for (int64_t k = 0; k < count; ++k)
        field[first_ + k] = field[source_[k]];
}

void Images::copy_collisions(std::initializer_list<Field<double> *> fields, Field<uint8_t> &partners,
                             Field<float> &crowded) const {
    if (halo_) {
        halo_->copy_collisions(fields, partners, crowded);
        return;
    }
    copy(fields);
    copy(partners);
    for (int64_t k = 0; k < count; ++k)
        crowded[first_ + k] = crowded[source_[k]];
}

void Images::copy_motion(Particles &p) const {
    if (halo_) {
        halo_->copy_motion(p);
        return;
    }
    copy({&p.x, &p.y, &p.vx, &p.vy});
    for (int64_t k = 0; k < count; ++k)
        p.x[first_ + k] += shift_[k];
}

int64_t Images::bytes() const {
    return cells_.bytes() + static_cast<int64_t>(source_.capacity() * sizeof(int32_t) +
                                                 (shift_.capacity() + room_.capacity()) * sizeof(double) +
                                                 found_.capacity() * sizeof(Image) + ids_.capacity() * sizeof(int64_t));
}

} // namespace gp
