#include "parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "awake.hpp"
#include "error.hpp"

namespace gp {

namespace {

// One over the unit of energies that are added up: a 2^60th of what the material of a spacing stores under the pressure rho c0^2.
double energy_scale(const World &world) {
    return world.walls.load_scale.torque;
}

std::initializer_list<double Ledger::*> sums_of_ledger() {
    static constexpr std::initializer_list<double Ledger::*> sums = {
        &Ledger::dissipated, &Ledger::penalty,    &Ledger::walls,      &Ledger::diffusion, &Ledger::spacing,
        &Ledger::bulk,       &Ledger::collisions, &Ledger::side_walls, &Ledger::plate_work};
    return sums;
}

// Numbers to be added up over all processes: put in, combined, taken out in the same order.
class Sums {
public:
    void put(const ExactSum &sum) { wholes.push_back(sum.whole()); }
    void put(double value, double scale) {
        ExactSum sum;
        sum.add(value, scale);
        put(sum);
    }
    void take(ExactSum &sum) { sum.set_whole(wholes[next_++]); }
    double take(double scale) {
        ExactSum sum;
        take(sum);
        return sum.value(scale);
    }
    std::vector<Whole> wholes;

private:
    std::size_t next_ = 0;
};

} // namespace

double sum_of_all(const World &world, double energy) {
    Sums sums;
    sums.put(energy, energy_scale(world));
    world.crossing->combine(nullptr, 0, sums.wholes.data(), 1);
    return sums.take(energy_scale(world));
}

int64_t sum_of_all(Crossing &crossing, int64_t count) {
    Whole all = count;
    crossing.combine(nullptr, 0, &all, 1);
    return static_cast<int64_t>(all);
}

std::vector<double> least_of_all(Crossing &crossing, const std::vector<double> &own, int64_t numbers, int64_t keys) {
    std::vector<double> all;
    crossing.gather_everywhere(own, all);
    auto least = all.begin();
    for (auto next = all.begin(); next != all.end(); next += numbers)
        if (std::lexicographical_compare(next, next + keys, least, least + keys))
            least = next;
    return all.empty() ? all : std::vector<double>(least, least + numbers);
}

void combine_sums(Crossing &crossing, BinnedSum *sums, int n_sums, double &largest) {
    std::array<Whole, most_sums * bins::count> wholes;
    std::array<double, most_sums + 1> tops;
    auto *next = wholes.data();
    for (int k = 0; k < n_sums; ++k) {
        next = std::copy(sums[k].wholes.begin(), sums[k].wholes.end(), next);
        tops[k] = sums[k].top;
    }
    tops[n_sums] = largest;
    crossing.combine(tops.data(), n_sums + 1, wholes.data(), n_sums * bins::count);
    next = wholes.data();
    for (int k = 0; k < n_sums; ++k, next += bins::count) {
        std::copy_n(next, bins::count, sums[k].wholes.begin());
        sums[k].top = tops[k];
    }
    largest = tops[n_sums];
}

void combine_books(World &world, BlockRange &range, BlockSums &total) {
    const double energy = energy_scale(world);
    const Ledger &before = world.step_start.ledger;
    double largest[5] = {-range.u_min, range.u_max, -range.v_min, range.v_max, total.densest};
    Sums sums;
    for (Plate &plate : world.walls.plates)
        for (const ExactSum &load : plate.load.all())
            sums.put(load);
    for (double Ledger::*sum : sums_of_ledger())
        sums.put(world.ledger.*sum - before.*sum, energy);
    const double mass = std::exp2(60 - std::ilogb(world.mass));
    sums.put(total.kinetic, energy);
    sums.put(total.plastic, energy);
    sums.put(total.unbalanced, mass);
    sums.wholes.push_back(total.collisions);
    Sleep &sleep = world.sleep;
    if (sleep.in_use)
        sums.wholes.push_back(std::count(sleep.asleep.begin(), sleep.asleep.end(), 0));
    world.crossing->combine(largest, 5, sums.wholes.data(), static_cast<int>(sums.wholes.size()));
    range = {-largest[0], largest[1], -largest[2], largest[3]};
    total.densest = largest[4];
    for (Plate &plate : world.walls.plates)
        for (ExactSum &load : plate.load.all())
            sums.take(load);
    for (double Ledger::*sum : sums_of_ledger())
        world.ledger.*sum = before.*sum + sums.take(energy);
    total.kinetic = sums.take(energy);
    total.plastic = sums.take(energy);
    total.unbalanced = sums.take(mass);
    if (sleep.in_use) {
        sleep.awake_of_all = static_cast<int64_t>(sums.wholes.back());
        sums.wholes.pop_back();
    }
    total.collisions = static_cast<int64_t>(sums.wholes.back());
}

// ----------------------------------------------------------------------------------------------------- errors

std::string text_of_largest(Crossing &crossing, double &value, const std::string &text) {
    double largest = value;
    crossing.combine(&largest, 1, nullptr, 0);
    double first = value == largest ? static_cast<double>(-crossing.rank()) : -INFINITY;
    crossing.combine(&first, 1, nullptr, 0);
    value = largest;
    const int from = static_cast<int>(-first);
    std::string chosen = text;
    tell_all_of(crossing, chosen, from);
    return chosen;
}

void run_on_first(Crossing &crossing, const std::function<void()> &body) {
    Failure failure;
    if (crossing.rank() == 0) {
        try {
            body();
        } catch (const SharedFailure &) {
            throw;
        } catch (...) {
            failure = failure_at_hand();
            if ((!failure.foreseen || failure.status == GP_E_MEMORY) && is_shared(&crossing))
                name_rank(failure, 0);
        }
    }
    tell_all(&crossing, &failure.status);
    if (failure.status == GP_OK)
        return;
    tell_all(&crossing, &failure);
    throw Error(failure.status, failure.text);
}

void require_bounded_everywhere(const World &world, bool suspect, const std::function<void()> &look) {
    std::string text;
    std::vector<double> own; // key, rank
    if (suspect)
        try {
            look();
        } catch (const Divergence &found) {
            text = found.what();
            own.assign(found.key.begin(), found.key.end());
        } catch (const Error &error) {
            text = error.what();
            own.assign(4, 0.0);
        }
    if (!own.empty())
        own.push_back(world.crossing->rank());
    double diverged = own.empty() ? 0 : 1;
    world.crossing->combine(&diverged, 1, nullptr, 0);
    if (diverged == 0)
        return;
    const std::vector<double> least = least_of_all(*world.crossing, own, 5, 5);
    tell_all_of(*world.crossing, text, static_cast<int>(least[4]));
    throw Error(GP_E_DIVERGED, text);
}

// ------------------------------------------------------------------------------------------------------- parts

void require_partable(const Scene &scene) {
    const gp_config &config = scene.config();
    if (by_number_density(scheme_of(config)))
        throw make_error(GP_E_UNSUPPORTED, "gp_config.preset: expected the default or the implicit scheme with several "
                                           "processes, not one of the paper's");
}

std::unique_ptr<World> make_part(const Scene &scene, Crossing &crossing) {
    Impact impact;
    run_on_first(crossing, [&] { impact = scene.impact(); });
    tell_all(&crossing, &impact);
    auto part = make_bare_world(scene, scene.constants(impact), 1); // fields in use have a size
    part->crossing = &crossing;
    part->halo = std::make_unique<Halo>(crossing);
    return part;
}

std::unique_ptr<World> begin_part(const Scene &scene, Crossing &crossing) {
    auto part = make_part(scene, crossing);
    const int64_t all = scene.particle_count(), first = all * crossing.rank() / crossing.ranks();
    resize_part(*part, all * (crossing.rank() + 1) / crossing.ranks() - first);
    begin_particles(*part, first);
    return part;
}

// -------------------------------------------------------------------------------------------------- migration

namespace {

// Work of the busiest process over the mean, from which on the cells are dealt out anew; after so many new lists it is looked at.
constexpr double most_uneven = 1.05;
constexpr int lists_between = 10;

void deal_out_anew(World &world, const CellFrame &frame) {
    Particles &p = world.particles;
    std::vector<double> x(p.count), y(p.count);
    for (int64_t i = 0; i < p.count; ++i) {
        const Vector middle = place_of_owner(world, frame, p.x[i], p.y[i]);
        x[i] = middle.x();
        y[i] = middle.y();
    }
    world.crossing->cut(p.count, x.data(), y.data(),
                        world.share.work > 0 ? world.share.work : static_cast<double>(p.count));
}

// Has the work of the processes since the last time become uneven?
bool is_uneven(World &world) {
    const double work = world.share.work;
    double most = work;
    constexpr double scale = 0x1p40; // 1/s
    Sums sums;
    sums.put(work, scale);
    world.crossing->combine(&most, 1, sums.wholes.data(), 1);
    const double all = sums.take(scale);
    return most * world.crossing->ranks() > most_uneven * all;
}

} // namespace

std::vector<Field<double> *> carried_fields(Particles &p) {
    std::vector<Field<double> *> fields = {&p.x,   &p.y,   &p.vx,  &p.vy,  &p.density, &p.pressure,
                                           &p.sxx, &p.sxy, &p.lxx, &p.lxy, &p.lyx,     &p.lyy};
    for (Field<double> *field : {&p.mean_pressure, &p.fluidity})
        if (!field->empty())
            fields.push_back(field);
    if (p.repose.in_use())
        Repose::for_each(p.repose, [&](const char *, Field<double> &field) { fields.push_back(&field); });
    return fields;
}

namespace {

// What particles that go elsewhere press plates with while they sleep goes with them. left: their ids, and to whom.
void send_loads(World &world, std::vector<std::pair<int64_t, int>> &left) {
    std::sort(left.begin(), left.end());
    std::vector<MeanLoad> kept;
    std::vector<std::vector<double>> out(static_cast<std::size_t>(world.crossing->ranks())), in;
    for (const MeanLoad &load : world.sleep.loads) {
        const auto found = std::lower_bound(left.begin(), left.end(), std::pair<int64_t, int>(load.id, 0));
        if (found == left.end() || found->first != load.id) {
            kept.push_back(load);
            continue;
        }
        std::vector<double> &to = out[found->second];
        to.resize(to.size() + MeanLoad::numbers);
        load.put(&to[to.size() - MeanLoad::numbers]);
    }
    world.crossing->deal(out, in);
    for (const std::vector<double> &from : in)
        for (std::size_t at = 0; at < from.size(); at += MeanLoad::numbers)
            kept.push_back(MeanLoad::of(&from[at]));
    world.sleep.loads.swap(kept);
}

} // namespace

void go_to_owners(World &world, const CellFrame &frame) {
    Crossing &crossing = *world.crossing;
    Particles &p = world.particles;
    PartShare &share = world.share;
    if (!share.dealt || (++share.lists >= lists_between && is_uneven(world))) {
        deal_out_anew(world, frame);
        share = {};
        share.dealt = true;
    }
    const std::vector<Field<double> *> fields = carried_fields(p);
    std::vector<std::pair<int64_t, int>> left; // only with sleep
    std::vector<std::vector<double>> out(static_cast<std::size_t>(crossing.ranks())), in;
    int64_t kept = 0;
    for (int64_t i = 0; i < p.count; ++i) {
        const Vector middle = place_of_owner(world, frame, p.x[i], p.y[i]);
        const int owner = crossing.owner(middle.x(), middle.y());
        if (owner == crossing.rank()) {
            p.id[kept] = p.id[i];
            p.column[kept] = p.column[i];
            for (Field<double> *field : fields)
                (*field)[kept] = (*field)[i];
            ++kept;
            continue;
        }
        std::vector<double> &to = out[owner];
        to.push_back(static_cast<double>(p.id[i]));
        to.push_back(static_cast<double>(p.column[i]));
        for (const Field<double> *field : fields)
            to.push_back((*field)[i]);
        if (world.sleep.in_use)
            left.emplace_back(p.id[i], owner);
    }
    crossing.deal(out, in);
    if (world.sleep.in_use)
        send_loads(world, left);
    const std::size_t numbers = fields.size() + 2;
    int64_t count = kept;
    for (const std::vector<double> &from : in)
        count += static_cast<int64_t>(from.size() / numbers);
    resize_part(world, count);
    for (const std::vector<double> &from : in)
        for (const double *r = from.data(), *end = r + from.size(); r != end; ++kept) {
            p.id[kept] = static_cast<int64_t>(*r++);
            p.column[kept] = static_cast<int32_t>(*r++);
            for (Field<double> *field : fields)
                (*field)[kept] = *r++;
        }
}

void resize_part(World &world, int64_t count) {
    world.particles.resize(count);
    world.clusters.starts.clear();
    const int64_t blocks = block_count(count);
    world.sums.assign(static_cast<std::size_t>(blocks), BlockSums());
    world.ranges.assign(static_cast<std::size_t>(blocks), BlockRange{INFINITY, -INFINITY, INFINITY, -INFINITY});
    if (!world.colliding.empty())
        world.colliding.resize(static_cast<std::size_t>(std::max<int64_t>(1, count)));
    if (!world.crowded.empty())
        world.crowded.resize(static_cast<std::size_t>(std::max<int64_t>(1, count)));
}

} // namespace gp
