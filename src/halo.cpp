#include "halo.hpp"

#include <algorithm>

namespace gp {

namespace {

struct Rank {
    int rank;
    Box box;
    double shift; // m, of particles here on the way there
};

double distance2(const Box &box, double x, double y) {
    const double dx = std::max({0.0, box.x_min - x, x - box.x_max}), dy = std::max({0.0, box.y_min - y, y - box.y_max});
    return dx * dx + dy * dy;
}

// Whose particles may see some of those within `own`, and over which end of the period.
std::vector<Rank> ranks_in_reach(Crossing &crossing, const Box &own, const Period &period, double reach) {
    std::vector<double> all;
    crossing.gather_everywhere({own.x_min, own.x_max, own.y_min, own.y_max}, all);
    std::vector<Rank> found;
    for (int rank = 0; rank < crossing.ranks(); ++rank) {
        const double *b = all.data() + 4 * static_cast<std::size_t>(rank);
        const Box box{b[0], b[1], b[2], b[3]};
        if (!(box.x_min <= box.x_max) || !(own.x_min <= own.x_max)) // without particles
            continue;
        for (const double shift : {0.0, period.length, -period.length}) {
            if (rank != crossing.rank() || shift != 0)
                if (Box{own.x_min + shift, own.x_max + shift, own.y_min, own.y_max}.gap(box) <= reach)
                    found.push_back({rank, box, shift});
            if (!period)
                break;
        }
    }
    return found;
}

} // namespace

void Halo::find(const Particles &p, const CellFrame &frame, const Period &period, double reach) {
    source_.clear();
    shift_.clear();
    const auto ranks = static_cast<std::size_t>(crossing_.ranks());
    std::vector<std::vector<double>> out(ranks), in;
    std::vector<int64_t> out_count(ranks, 0), in_count(ranks, 0);
    constexpr std::size_t numbers = 4;
    const double reach2 = reach * reach;
    for (const Rank &there : ranks_in_reach(crossing_, box_of(p), period, reach))
        for (int64_t i = 0; i < p.count; ++i) {
            if (distance2(there.box, p.x[i] + there.shift, p.y[i]) > reach2)
                continue;
            source_.push_back(static_cast<int32_t>(i));
            shift_.push_back(there.shift);
            Cell cell = frame.cell_of(p.x[i], p.y[i]);
            if (there.shift != 0)
                cell.column += there.shift > 0 ? frame.columns() : -frame.columns();
            const auto number = [](int64_t whole) { return static_cast<double>(whole); };
            out[there.rank].insert(out[there.rank].end(),
                                   {number(p.id[i]), number(p.column[i]), number(cell.column), number(cell.row)});
            ++out_count[there.rank];
        }
    crossing_.deal(out, in);
    id_.clear();
    cell_.clear();
    column_.clear();
    for (std::size_t rank = 0; rank < ranks; ++rank) {
        in_count[rank] = static_cast<int64_t>(in[rank].size() / numbers);
        for (const double *r = in[rank].data(), *end = r + in[rank].size(); r != end; r += numbers) {
            id_.push_back(static_cast<int64_t>(r[0]));
            column_.push_back(static_cast<int32_t>(r[1]));
            cell_.push_back({static_cast<int64_t>(r[2]), static_cast<int64_t>(r[3])});
        }
    }
    crossing_.link(out_count, in_count);
}

void Halo::set_order(const Field<int32_t> &order, int64_t first, int32_t *column) {
    place_.resize(id_.size());
    for (std::size_t k = 0; k < id_.size(); ++k) {
        place_[order[k]] = static_cast<int32_t>(first + static_cast<int64_t>(k));
        column[k] = column_[order[k]];
    }
}

template <class Pack, class Unpack> void Halo::exchange(int numbers, const Pack &pack, const Unpack &unpack) {
    out_.resize(static_cast<std::size_t>(numbers) * source_.size());
    in_.resize(static_cast<std::size_t>(numbers) * place_.size());
    double *out = out_.data();
    for (std::size_t k = 0; k < source_.size(); ++k, out += numbers)
        pack(source_[k], shift_[k], out);
    crossing_.swap(out_.data(), in_.data(), numbers);
    const double *in = in_.data();
    for (std::size_t k = 0; k < place_.size(); ++k, in += numbers)
        unpack(place_[k], in);
}

void Halo::copy(std::initializer_list<Field<double> *> fields) {
    exchange(
        static_cast<int>(fields.size()),
        [&](int32_t i, double, double *out) {
            for (const Field<double> *field : fields)
                *out++ = (*field)[i];
        },
        [&](int32_t j, const double *in) {
            for (Field<double> *field : fields)
                (*field)[j] = *in++;
        });
}

void Halo::copy_collisions(std::initializer_list<Field<double> *> fields, Field<uint8_t> &partners,
                           Field<float> &crowded) {
    exchange(
        static_cast<int>(fields.size()) + 2,
        [&](int32_t i, double, double *out) {
            for (const Field<double> *field : fields)
                *out++ = (*field)[i];
            *out++ = partners[i];
            *out = crowded[i];
        },
        [&](int32_t j, const double *in) {
            for (Field<double> *field : fields)
                (*field)[j] = *in++;
            partners[j] = static_cast<uint8_t>(*in++);
            crowded[j] = static_cast<float>(*in);
        });
}

void Halo::copy_motion(Particles &p) {
    exchange(
        4,
        [&](int32_t i, double shift, double *out) {
            out[0] = p.x[i] + shift;
            out[1] = p.y[i];
            out[2] = p.vx[i];
            out[3] = p.vy[i];
        },
        [&](int32_t j, const double *in) {
            p.x[j] = in[0];
            p.y[j] = in[1];
            p.vx[j] = in[2];
            p.vy[j] = in[3];
        });
}

void Halo::copy_motion(Particles &p, Sleep &sleep) {
    exchange(
        5,
        [&](int32_t i, double shift, double *out) {
            out[0] = p.x[i] + shift;
            out[1] = p.y[i];
            out[2] = p.vx[i];
            out[3] = p.vy[i];
            out[4] = sleep.restless[sleep.span_of[i]];
        },
        [&](int32_t j, const double *in) {
            p.x[j] = in[0];
            p.y[j] = in[1];
            p.vx[j] = in[2];
            p.vy[j] = in[3];
            sleep.restless[sleep.span_of[j]] = static_cast<uint8_t>(in[4]);
        });
}

void Halo::copy_rest(Sleep &sleep) {
    exchange(
        2,
        [&](int32_t i, double, double *out) {
            out[0] = sleep.restless[sleep.span_of[i]];
            out[1] = static_cast<double>(sleep.plates[sleep.span_of[i]]);
        },
        [&](int32_t j, const double *in) {
            sleep.restless[sleep.span_of[j]] = static_cast<uint8_t>(in[0]);
            sleep.plates[sleep.span_of[j]] = static_cast<uint64_t>(in[1]);
        });
}

int64_t Halo::bytes() const {
    return static_cast<int64_t>((source_.capacity() + column_.capacity() + place_.capacity()) * sizeof(int32_t) +
                                (shift_.capacity() + out_.capacity() + in_.capacity()) * sizeof(double) +
                                id_.capacity() * sizeof(int64_t) + cell_.capacity() * sizeof(Cell));
}

} // namespace gp
