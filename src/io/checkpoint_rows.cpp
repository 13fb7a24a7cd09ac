#include "io/checkpoint_rows.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "awake.hpp"
#include "io/checkpoint_parts.hpp"
#include "stages/stages.hpp"
#include "stretches.hpp"

namespace gp::io {

// ------------------------------------------------------------------------------------------------------ writing

template <class T> void RowWriter::begin(const char *name, std::size_t size) {
    const auto array = std::make_shared<CheckpointWriter::Growing>(file_.begin_array<T>(name, size));
    columns_.push_back([this, array](const Rows &rows, std::size_t column) {
        std::vector<T> values;
        values.reserve(rows.size());
        for (const double *row : rows)
            values.push_back(static_cast<T>(row[column]));
        file_.append(*array, values.data(), values.size());
    });
}

RowWriter::RowWriter(CheckpointWriter &file, const World &part, int64_t all) : file_(file) {
    const auto begin_in_use = [&](const char *name, const auto &field) {
        using T = typename std::decay_t<decltype(field)>::value_type;
        if (field.empty())
            file.array(name, field);
        else
            begin<T>(name, static_cast<std::size_t>(all));
    };
    const std::vector<double> numbers(1); // where lists were made is known of each
    for_each_listed_array(numbers, numbers, begin_in_use);
    file.array("listed", part.listed); // empty: a sort is not undone
    for_each_particle_array(part.particles, begin_in_use);
}

void RowWriter::append(const Rows &rows) {
    for (std::size_t column = 0; column < columns_.size(); ++column)
        columns_[column](rows, column);
}

void for_each_row(const World &part, const TakeRows &take) {
    const Particles &p = part.particles;
    OrderedRows own;
    own.count = p.count;
    own.numbers = 2;
    for_each_particle_array(p, [&](const char *, const auto &field) { own.numbers += !field.empty(); });
    own.key_of = [&](int64_t k, double *key) { key_of_cell(part, k, 0, key); };
    own.pack = [&](int64_t i, double *out) {
        *out++ = part.list_origin.x[i];
        *out++ = part.list_origin.y[i];
        for_each_particle_array(p, [&](const char *, const auto &field) {
            if (!field.empty())
                *out++ = static_cast<double>(field[i]);
        });
    };
    take_in_order(*part.crossing, own, take);
}

// ------------------------------------------------------------------------------------------------------ reading

namespace {

// The particles that this process reads: a stretch of the places in the lists.
class Stretch {
public:
    Stretch(const CheckpointReader &file, const Checker &check, const World &part)
        : file_(file), all_(part.scene->particle_count()) {
        const int64_t rank = part.crossing->rank(), ranks = part.crossing->ranks();
        first_ = all_ * rank / ranks;
        count_ = all_ * (rank + 1) / ranks - first_;
        const std::size_t listed = file.size_of<int32_t>("listed");
        check.require(listed == 0 || listed == static_cast<std::size_t>(all_),
                      "listed: not one value for each particle");
        for_each_listed_array("", "", [&](const char *name, const char *) { require_all<double>(check, name, true); });
        for_each_particle_array(part.particles, [&](const char *name, const auto &field) {
            require_all<typename std::decay_t<decltype(field)>::value_type>(check, name, !field.empty());
        });
        if (listed == 0)
            return;
        std::vector<int32_t> places(static_cast<std::size_t>(count_));
        file.some("listed", static_cast<std::size_t>(first_), places.size(), places.data());
        for (const int32_t place : places)
            check.require_each(place >= 0 && place < all_,
                               [&] { return format_text("listed: %d, expected a particle's place", place); });
        listed_.assign(places.begin(), places.end());
    }

    int64_t count() const { return count_; }
    int64_t all() const { return all_; }
    // Of the places begin .. end of the stretch: where the lists were made, and of the particles there.
    void read_listed(const char *name, int64_t begin, int64_t end, double *values) const {
        file_.some(name, static_cast<std::size_t>(first_ + begin), static_cast<std::size_t>(end - begin), values);
    }
    template <class T> void read(const char *name, int64_t begin, int64_t end, T *values) const {
        if (listed_.empty())
            file_.some(name, static_cast<std::size_t>(first_ + begin), static_cast<std::size_t>(end - begin), values);
        else
            file_.some(name, std::vector<hsize_t>(listed_.begin() + begin, listed_.begin() + end), values);
    }

private:
    template <class T> void require_all(const Checker &check, const char *name, bool in_use) const {
        if (all_ == 0) // a process alone writes what has no values for not in use
            return;
        const std::size_t size = file_.size_of<T>(name), expected = in_use ? static_cast<std::size_t>(all_) : 0;
        check.require(size == expected, format_text("%s: %zu values, expected %zu", name, size, expected));
    }

    const CheckpointReader &file_;
    int64_t all_, first_ = 0, count_ = 0;
    std::vector<hsize_t> listed_; // of each place; empty: the same
};

// Is each number below `all` told by one of the processes, and once?
class EachOnce {
public:
    EachOnce(Crossing &crossing, int64_t all)
        : crossing_(crossing), all_(all), out_(static_cast<std::size_t>(crossing.ranks())) {
        seen_.resize(static_cast<std::size_t>(first_of(crossing.rank() + 1) - first_of(crossing.rank())));
    }
    // Collective.
    bool tell(const std::vector<int64_t> &numbers) {
        for (auto &to : out_)
            to.clear();
        for (const int64_t number : numbers) {
            auto rank = static_cast<int>(number * crossing_.ranks() / all_);
            while (number >= first_of(rank + 1)) // rounded down at both
                ++rank;
            out_[static_cast<std::size_t>(rank)].push_back(static_cast<double>(number));
        }
        crossing_.deal(out_, in_);
        bool good = true;
        for (const auto &from : in_)
            for (const double number : from) {
                const auto k = static_cast<std::size_t>(static_cast<int64_t>(number) - first_of(crossing_.rank()));
                good = good && !seen_[k];
                seen_[k] = true;
            }
        return good;
    }

private:
    int64_t first_of(int rank) const { return all_ * rank / crossing_.ranks(); }

    Crossing &crossing_;
    int64_t all_;
    std::vector<bool> seen_; // of those between first_of this one and the next
    std::vector<std::vector<double>> out_, in_;
};

// Where the lists were made, and whose places these are.
void read_places(const Stretch &stretch, const Checker &check, World &part) {
    Particles &p = part.particles;
    const int64_t count = stretch.count();
    resize_part(part, count);
    stretch.read("id", 0, count, p.id.data());
    stretch.read("column", 0, count, p.column.data());
    for (int64_t i = 0; i < count; ++i) {
        const auto id = static_cast<long long>(p.id[i]);
        check.require_each(id >= 0 && id < stretch.all(),
                           [&] { return format_text("id: %lld, expected each once", id); });
        check.require_each(p.column[i] == part.scene->body_of(id),
                           [] { return std::string("a particle is of another column"); });
    }
    for_each_listed_array(
        p.x, p.y, [&](const char *name, Field<double> &field) { stretch.read_listed(name, 0, count, field.data()); });
    check_list_positions(check, part, count);
    stages::make_lists(part); // they go to their owners
}

} // namespace

void check_numbers(const Checker &check, const World &world, const char *name, const int32_t *column,
                   const double *values, std::size_t count) {
    const std::string array = name;
    for (std::size_t k = 0; k < count; ++k)
        check.finite(name, values[k]);
    for (std::size_t k = 0; k < count && array == "density"; ++k) {
        const double own = world.constants.materials[world.constants.body_material[column[k]]].density;
        // Before the first step it is the scene's: a slow sound under much weight may be beyond what a step takes.
        check.require_each(stages::is_bounded_density(values[k] / own) || (world.clock.step == 0 && values[k] >= 0),
                           [&] { return format_text("a density of %g kg/m3", values[k]); });
    }
    for (std::size_t k = 0; k < count && array == "asleep"; ++k)
        check.require_each(values[k] == 0 || values[k] == 1,
                           [&] { return format_text("asleep: %g, expected 0 or 1", values[k]); });
    for (const char *not_negative :
         {"pressure", "mean_pressure", "fluidity", "quiet_for", "quiet_pressure", "quiet_fluidity"})
        if (array == not_negative)
            for (std::size_t k = 0; k < count; ++k)
                check.require_each(values[k] >= 0,
                                   [&] { return format_text("%s: %g, expected at least 0", name, values[k]); });
}

void check_list_positions(const Checker &check, const World &world, int64_t count) {
    const Particles &p = world.particles;
    for (int64_t i = 0; i < count; ++i) {
        for (const double value : {p.x[i], p.y[i]})
            check.require_each(std::abs(value) <= farthest_of_lists * world.constants.spacing,
                               [&] { return format_text("lists: a particle at %g m", value); });
        if (const Period &period = world.constants.period)
            check.require_each(std::abs(p.x[i] - period.x_min - 0.5 * period.length) <= (0.5 + 1e-9) * period.length,
                               [&] { return format_text("lists: a particle at x = %g m, beyond the period", p.x[i]); });
    }
}

void read_rows(const CheckpointReader &file, const Checker &check, World &part) {
    Crossing &crossing = *part.crossing;
    const Stretch stretch(file, check, part);
    read_places(stretch, check, part);

    // Each sends the rest of what it reads to the owners of the cells.
    Particles &p = part.particles;
    const std::vector<int32_t> by_id = p.by_id();
    EachOnce each_once(crossing, std::max<int64_t>(1, stretch.all()));
    std::vector<const char *> names;
    std::vector<Field<double> *> fields;
    for_each_particle_array(p, [&](const char *name, auto &field) {
        if constexpr (std::is_same_v<std::decay_t<decltype(field)>, Field<double>>)
            if (!field.empty()) {
                names.push_back(name);
                fields.push_back(&field);
            }
    });
    std::vector<int64_t> id;
    std::vector<int32_t> column;
    std::vector<double> x, y;
    std::vector<std::vector<double>> values(fields.size()), out(static_cast<std::size_t>(crossing.ranks())), in;
    for_each_turn(crossing, stretch.count(), [&](int64_t begin, int64_t end) {
        const auto count = static_cast<std::size_t>(end - begin);
        id.resize(count), column.resize(count), x.resize(count), y.resize(count);
        stretch.read("id", begin, end, id.data());
        stretch.read("column", begin, end, column.data());
        for_each_listed_array(
            x, y, [&](const char *name, std::vector<double> &to) { stretch.read_listed(name, begin, end, to.data()); });
        for (std::size_t f = 0; f < fields.size(); ++f) {
            values[f].resize(count);
            stretch.read(names[f], begin, end, values[f].data());
            check_numbers(check, part, names[f], column.data(), values[f].data(), count);
        }
        check.require(each_once.tell(id), "id: expected each once");
        for (auto &to : out)
            to.clear();
        const CellFrame &frame = part.grid.frame();
        for (std::size_t k = 0; k < count; ++k) {
            const Vector middle = place_of_owner(part, frame, x[k], y[k]);
            std::vector<double> &to = out[static_cast<std::size_t>(crossing.owner(middle.x(), middle.y()))];
            to.push_back(static_cast<double>(id[k]));
            for (const std::vector<double> &of : values)
                to.push_back(of[k]);
        }
        crossing.deal(out, in);
        for (const std::vector<double> &from : in)
            for (std::size_t at = 0; at < from.size(); at += fields.size() + 1) {
                const auto found = std::lower_bound(by_id.begin(), by_id.end(), static_cast<int64_t>(from[at]),
                                                    [&](int32_t i, int64_t wanted) { return p.id[i] < wanted; });
                for (std::size_t f = 0; f < fields.size(); ++f)
                    (*fields[f])[*found] = from[at + 1 + f];
            }
    });
}

} // namespace gp::io
