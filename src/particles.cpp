#include "particles.hpp"

#include "parallel.hpp"

namespace gp {

void Particles::allocate(int64_t n, const Optional &use) {
    count = n;
    const auto size = static_cast<std::size_t>(n);
    id.resize(size);
    column.resize(size);
    for (Field<double> *field : {&x, &y, &vx, &vy, &density, &pressure, &sxx, &sxy, &lxx, &lxy, &lyx, &lyy, &cxx, &cxy,
                                 &ax, &ay, &push_x, &push_y, &scratch_double_})
        field->resize(size);
    if (use.shape)
        for (Field<double> *field : {&gxx, &gxy, &gyy, &cyx, &cyy})
            field->resize(size);
    if (use.syy)
        syy.resize(size);
    if (use.stressed)
        stressed.resize(size);
    if (use.carried)
        carried.resize(size, 1.0);
    if (use.flowing) {
        flowing.resize(size);
        crowding.resize(size);
    }
    if (use.bearing)
        bearing.resize(size);
    if (use.fluidity)
        for (Field<double> *field : {&fluidity, &fluid_seen, &fluid_pull, &fluid_pace})
            field->resize(size);
    if (use.sleep) {
        repose.resize(size);
        asleep.resize(size);
        scratch_repose_.resize(size);
        scratch_uint8_.resize(size);
    }
    scratch_int64_.resize(size);
    scratch_int32_.resize(size);
}

void Particles::make_room(int64_t images) {
    const auto size = static_cast<std::size_t>(count + images);
    const auto grow = [&](auto &field) {
        if (field.empty() || size == field.size())
            return;
        if (size > field.capacity())
            field.reserve(size + size / 16); // so that the next numbers of images fit, too
        field.resize(size);
    };
    grow(column);
    grow(scratch_int32_);
    grow(asleep);
    grow(scratch_uint8_);
    // The gradient and its like are not read of neighbours, but swap their memory with fields that are.
    for (Field<double> *field : {&x,
                                 &y,
                                 &vx,
                                 &vy,
                                 &density,
                                 &pressure,
                                 &sxx,
                                 &sxy,
                                 &lxx,
                                 &lxy,
                                 &lyx,
                                 &lyy,
                                 &cxx,
                                 &cxy,
                                 &cyx,
                                 &cyy,
                                 &syy,
                                 &stressed,
                                 &flowing,
                                 &bearing,
                                 &fluidity,
                                 &fluid_seen,
                                 &scratch_double_})
        grow(*field);
}

void Particles::reorder(const Field<int32_t> &old_index, int threads) {
    const auto gather = [&](auto &field, auto &scratch) {
        if (field.empty())
            return;
        for_each_block(threads, count, [&](int64_t, int64_t begin, int64_t end) {
            for (int64_t i = begin; i < end; ++i)
                scratch[i] = field[old_index[i]];
        });
        field.swap(scratch);
    };
    gather(id, scratch_int64_);
    gather(column, scratch_int32_);
    // The gradient is made anew in each step, but readers may ask for it between a reorder and the next one.
    for (Field<double> *field :
         {&x, &y, &vx, &vy, &density, &pressure, &sxx, &sxy, &syy, &fluidity, &lxx, &lxy, &lyx, &lyy})
        gather(*field, scratch_double_);
    if (repose.empty())
        return;
    gather(repose, scratch_repose_);
    gather(asleep, scratch_uint8_);
}

} // namespace gp
