#include "particles.hpp"

#include <algorithm>
#include <numeric>

#include "parallel.hpp"

namespace gp {

void Particles::allocate(int64_t n, const Optional &use) {
    count = n;
    const auto size = static_cast<std::size_t>(n);
    id.resize(size);
    column.resize(size);
    for (Field<double> *field : {&x, &y, &vx, &vy, &density, &pressure, &sxx, &sxy, &lxx, &lxy, &lyx, &lyy, &cxx, &cxy,
                                 &ax, &ay, &push_x, &push_y})
        field->resize(size);
    if (use.shape)
        for (Field<double> *field : {&gxx, &gxy, &gyy, &cyx, &cyy})
            field->resize(size);
    if (use.mean_pressure)
        mean_pressure.resize(size);
    if (use.syy)
        syy.resize(size);
    if (use.stressed)
        stressed.resize(size);
    if (use.bearing_flow)
        bearing_flow.resize(size);
    if (use.densities) {
        rest.resize(size);
        inverse_rest.resize(size);
    }
    if (use.fluidity)
        for (Field<double> *field : {&fluidity, &fluid_seen, &fluid_pull, &fluid_pace})
            field->resize(size);
    if (use.sleep)
        Repose::for_each(repose, [&](const char *, Field<double> &field) { field.resize(size); });
}

void Particles::make_room(int64_t images) {
    const auto size = static_cast<std::size_t>(std::max<int64_t>(1, count + images)); // 0 is that of a field not in use
    const auto grow = [&](auto &field) {
        if (field.empty() || size == field.size())
            return;
        if (size > field.capacity())
            field.reserve(size + size / 16); // so that the next numbers of images fit, too
        field.resize(size);
    };
    grow(column);
    // The gradient and its like are not read of neighbours, but their memory changes places with that of fields that are.
    for (Field<double> *field :
         {&x,      &y,   &vx,       &vy,   &density,      &pressure, &sxx,        &sxy,          &lxx,          &lxy,
          &lyx,    &lyy, &cxx,      &cxy,  &cyx,          &cyy,      &syy,        &ax,           &ay,           &push_x,
          &push_y, &gyy, &stressed, &rest, &inverse_rest, &fluidity, &fluid_seen, &bearing_flow, &mean_pressure})
        grow(*field);
    Repose::for_each(repose,
                     [&](const char *, Field<double> &field) { grow(field); }); // changes places with ax in a sort
}

void Particles::resize(int64_t n) {
    count = n;
    const auto size = static_cast<std::size_t>(std::max<int64_t>(1, n));
    id.resize(size);
    column.resize(size);
    for (Field<double> *field :
         {&x,          &y,          &vx,         &vy,           &density,      &pressure,     &sxx,
          &sxy,        &syy,        &lxx,        &lxy,          &lyx,          &lyy,          &gxx,
          &gxy,        &gyy,        &cxx,        &cxy,          &cyx,          &cyy,          &ax,
          &ay,         &push_x,     &push_y,     &stressed,     &rest,         &inverse_rest, &fluidity,
          &fluid_seen, &fluid_pull, &fluid_pace, &bearing_flow, &mean_pressure})
        if (!field->empty())
            field->resize(size);
    if (repose.in_use())
        Repose::for_each(repose, [&](const char *, Field<double> &field) { field.resize(size); });
}

void Particles::reorder(const Field<int32_t> &old_index, int threads) {
    // Any number of a field as a double: whole ones are exact up to 2^53.
    const auto gather = [&](const auto &field) {
        for_each_block(threads, count, [&](int64_t, int64_t begin, int64_t end) {
            for (int64_t i = begin; i < end; ++i)
                ax[i] = static_cast<double>(field[old_index[i]]);
        });
    };
    const auto gather_whole = [&](auto &field) {
        gather(field);
        for_each_block(threads, count, [&](int64_t, int64_t begin, int64_t end) {
            for (int64_t i = begin; i < end; ++i)
                field[i] = static_cast<std::remove_reference_t<decltype(field[i])>>(ax[i]);
        });
    };
    gather_whole(id);
    gather_whole(column);
    // The gradient is made anew in each step, but readers may ask for it between a reorder and the next one.
    for (Field<double> *field :
         {&x, &y, &vx, &vy, &density, &pressure, &sxx, &sxy, &mean_pressure, &syy, &fluidity, &lxx, &lxy, &lyx, &lyy})
        if (!field->empty()) {
            gather(*field);
            field->swap(ax);
        }
    if (repose.in_use())
        Repose::for_each(repose, [&](const char *, Field<double> &field) {
            gather(field);
            field.swap(ax);
        });
}

std::vector<int32_t> Particles::by_id() const {
    std::vector<int32_t> sorted(static_cast<std::size_t>(count));
    std::iota(sorted.begin(), sorted.end(), 0);
    std::sort(sorted.begin(), sorted.end(), [&](int32_t a, int32_t b) { return id[a] < id[b]; });
    return sorted;
}

void Particles::give_back_accelerations() {
    hand_over(flowing, ax);
    if (ay.empty())
        hand_over(bearing.empty() ? bearing_flow : bearing, ay);
}

void Particles::give_back(bool stressed_in_shape) {
    const auto give = [](Field<double> &from, Field<double> &to) {
        if (!from.empty())
            hand_over(from, to);
    };
    give(spaced, ax);
    give(known, ay);
    if (ax.empty())
        give_back_accelerations();
    give(crowding, cyx);
    give(carried, cyy);
    if (stressed_in_shape)
        give(stressed, gyy);
}

} // namespace gp
