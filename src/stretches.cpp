#include "stretches.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace gp {

namespace {

// What each process may send of a stretch.
int64_t share_of_stretch(const Crossing &crossing) {
    return std::max<int64_t>(1, stretch_size / crossing.ranks());
}

} // namespace

int64_t count_of_all(const World &world) {
    return world.crossing ? sum_of_all(*world.crossing, world.particles.count) : world.particles.count;
}

void key_of_cell(const World &part, int64_t k, int64_t columns, double *key) {
    const Cell cell = part.grid.frame().cell_of(part.list_origin.x[k], part.list_origin.y[k]);
    key[0] = static_cast<double>(cell.row);
    key[1] = static_cast<double>(cell.column + columns);
    key[2] = static_cast<double>(part.particles.id[k]);
}

// In each turn all tell up to where they could send, and send up to the least of that.
void take_in_order(Crossing &crossing, const OrderedRows &own, const TakeRows &body) {
    const int64_t most = share_of_stretch(crossing);
    const std::size_t numbers = static_cast<std::size_t>(own.numbers) + key_numbers;
    const auto before = [](const double *a, const double *b) {
        return std::lexicographical_compare(a, a + key_numbers, b, b + key_numbers);
    };
    std::vector<double> out, all;
    std::vector<const double *> rows;
    OnFirst first(crossing);
    for (int64_t next = 0;;) {
        std::vector<double> last(key_numbers, INFINITY);
        if (next + most < own.count)
            own.key_of(next + most - 1, last.data());
        crossing.gather_everywhere(last, all);
        const double *least = all.data();
        for (const double *at = all.data(), *end = at + all.size(); at != end; at += key_numbers)
            if (before(at, least))
                least = at;
        std::copy_n(least, key_numbers, last.begin());
        out.clear();
        for (; next < own.count; ++next) {
            double key[key_numbers];
            own.key_of(next, key);
            if (before(last.data(), key))
                break;
            out.insert(out.end(), key, key + key_numbers);
            out.resize(out.size() + static_cast<std::size_t>(own.numbers));
            own.pack(next, &out[out.size() - static_cast<std::size_t>(own.numbers)]);
        }
        crossing.gather(out, all);
        first.run([&] {
            rows.clear();
            for (std::size_t at = 0; at < all.size(); at += numbers)
                rows.push_back(&all[at]);
            std::sort(rows.begin(), rows.end(), before);
            for (const double *&row : rows)
                row += key_numbers;
            body(rows);
        });
        if (last[0] == INFINITY)
            break;
    }
    first.finish();
}

void for_each_turn(Crossing &crossing, int64_t count, const std::function<void(int64_t begin, int64_t end)> &body) {
    const int64_t most = share_of_stretch(crossing);
    const int64_t own = (count + most - 1) / most;
    auto turns = static_cast<double>(own);
    crossing.combine(&turns, 1, nullptr, 0);
    for (int64_t turn = 0; turn < static_cast<int64_t>(turns); ++turn)
        body(std::min(count, turn * most), std::min(count, (turn + 1) * most));
}

void collect_numbers(Crossing &crossing, const double *own, int64_t count,
                     const std::function<void(int64_t all)> &make_room,
                     const std::function<void(const std::vector<double> &piece)> &body) {
    constexpr int64_t numbers = collected_numbers;
    const int64_t all = sum_of_all(crossing, count);
    OnFirst first(crossing);
    first.run([&] { make_room(all); });
    std::vector<double> out, piece;
    for_each_turn(crossing, (count + numbers - 1) / numbers, [&](int64_t begin, int64_t end) {
        out.assign(own + std::min(count, numbers * begin), own + std::min(count, numbers * end));
        crossing.gather(out, piece);
        first.run([&] { body(piece); });
    });
    first.finish();
}

namespace {

std::unique_ptr<World> make_stretch(const World &part) {
    auto stretch = std::make_unique<World>();
    stretch->scene = part.scene;
    stretch->constants = part.constants;
    stretch->clock = part.clock;
    stretch->ledger = part.ledger;
    stretch->particles.volume = part.particles.volume;
    return stretch;
}

std::vector<Field<double> *> summed_fields(Particles &p) {
    return {&p.x, &p.y, &p.vx, &p.vy, &p.density, &p.pressure, &p.sxx, &p.sxy};
}

} // namespace

void for_each_stretch(const World &world, const std::vector<char> &flags, const TakeStretch &body) {
    if (!world.crossing) {
        body(world, flags.data());
        return;
    }
    const Particles &p = world.particles;
    const std::vector<Field<double> *> from = summed_fields(const_cast<Particles &>(p));
    OrderedRows own;
    own.count = p.count;
    own.numbers = static_cast<int>(from.size()) + 3;
    own.key_of = [&](int64_t k, double *key) { key_of_cell(world, k, 0, key); };
    own.pack = [&](int64_t i, double *out) {
        *out++ = static_cast<double>(p.id[i]);
        *out++ = p.column[i];
        *out++ = flags.empty() ? 0 : flags[static_cast<std::size_t>(i)];
        for (const Field<double> *field : from)
            *out++ = (*field)[i];
    };
    const std::unique_ptr<World> stretch = make_stretch(world);
    Particles &s = stretch->particles;
    const std::vector<Field<double> *> to = summed_fields(s);
    std::vector<char> flags_of;
    take_in_order(*world.crossing, own, [&](const std::vector<const double *> &rows) {
        s.count = static_cast<int64_t>(rows.size());
        s.id.resize(rows.size());
        s.column.resize(rows.size());
        flags_of.resize(rows.size());
        for (Field<double> *field : to)
            field->resize(rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double *row = rows[i];
            s.id[i] = static_cast<int64_t>(*row++);
            s.column[i] = static_cast<int32_t>(*row++);
            flags_of[i] = static_cast<char>(*row++);
            for (Field<double> *field : to)
                (*field)[i] = *row++;
        }
        body(*stretch, flags_of.data());
    });
}

} // namespace gp
