#include "whole.hpp"

#include <algorithm>

#include "stages/stages.hpp"
#include "stretches.hpp"

namespace gp {

void require_partable(const Scene &scene) {
    const gp_config &config = scene.config();
    if (by_number_density(scheme_of(config)))
        throw make_error(GP_E_UNSUPPORTED, "gp_config.preset: expected the default or the implicit scheme with several "
                                           "processes, not one of the paper's");
    if (config.sleep != 0)
        throw make_error(GP_E_UNSUPPORTED, "gp_config.sleep = 1: expected 0 with several processes");
}

namespace {

// All of a world that is not of particles, number by number: what a checkpoint has of it, too (io/checkpoint_parts.hpp).
template <class Visitor, class W> void visit_common(Visitor &v, W &w) {
    v(w.clock.time), v(w.clock.step), v(w.clock.dt), v(w.clock.time_left), v(w.clock.reason);
    v(w.ledger.initial), v(w.ledger.reference_height), v(w.ledger.dissipated), v(w.ledger.penalty), v(w.ledger.walls);
    v(w.ledger.diffusion), v(w.ledger.spacing), v(w.ledger.bulk), v(w.ledger.collisions), v(w.ledger.side_walls);
    v(w.ledger.plate_work), v(w.ledger.scale), v(w.ledger.largest_kinetic), v(w.ledger.level);
    v(w.constants.gravity.x()), v(w.constants.gravity.y()), v(w.constants.fall_height), v(w.constants.flow_speed);
    v(w.mass), v(w.collisions), v(w.max_compression), v(w.packing_at_start), v(w.retries), v(w.plastic_power);
    v(w.unbalanced_share), v(w.velocity_span), v(w.fastest), v(w.skin), v(w.shifted), v(w.lists_valid);
    v(w.walls.ghosts_placed);
    v(w.viscous.newton), v(w.viscous.linear), v(w.viscous.failures), v(w.viscous.last), v(w.viscous.last_residual);
    v.list(w.pieces, [&](auto &piece) { v(piece.end), v(piece.depth); });
}

template <class Visitor, class State> void visit_state(Visitor &v, State &s) {
    v(s.driven), v(s.driven_since), v(s.fallen), v(s.fall_speed), v(s.wrapped);
    v(s.driven_from.shift.x()), v(s.driven_from.shift.y()), v(s.driven_from.angle);
    v(s.placed.shift.x()), v(s.placed.shift.y()), v(s.placed.angle);
    for (auto *motion : {&s.driven_motion, &s.motion})
        v(motion->velocity.x()), v(motion->velocity.y()), v(motion->omega);
}

template <class Visitor, class P> void visit_loads(Visitor &v, P &plate) {
    v(plate.force.x()), v(plate.force.y()), v(plate.torque), v(plate.torque_pivot);
    v(plate.impulse.x()), v(plate.impulse.y()), v(plate.impulse_torque), v(plate.gap);
}

struct Put {
    std::vector<double> numbers;
    template <class T> void operator()(const T &value) { numbers.push_back(static_cast<double>(value)); }
    template <class List, class Visit> void list(const List &items, const Visit &visit) {
        (*this)(items.size());
        for (const auto &item : items)
            visit(item);
    }
};

struct Take {
    const double *next;
    template <class T> void operator()(T &value) { value = static_cast<T>(*next++); }
    template <class List, class Visit> void list(List &items, const Visit &visit) {
        items.resize(static_cast<std::size_t>(*next++));
        for (auto &item : items)
            visit(item);
    }
};

// Where the plates are now, and were when the lists were made.
std::vector<double> common_of(const World &w) {
    Put put;
    visit_common(put, w);
    for (const Plate &plate : w.walls.plates) {
        visit_state(put, plate.state());
        visit_loads(put, plate);
    }
    for (const Plate::State &state : w.list_origin.plates)
        visit_state(put, state);
    return put.numbers;
}

// then: the plates as they were when the lists were made; else as they are.
void set_common(World &w, const std::vector<double> &numbers, bool then) {
    Take take{numbers.data()};
    visit_common(take, w);
    w.list_origin.plates.resize(w.walls.plates.size());
    for (Plate &plate : w.walls.plates) {
        Plate::State state;
        visit_state(take, state);
        plate.set_state(state);
        visit_loads(take, plate);
    }
    for (Plate::State &state : w.list_origin.plates)
        visit_state(take, state);
    if (then)
        for (std::size_t k = 0; k < w.walls.plates.size(); ++k)
            w.walls.plates[k].set_state(w.list_origin.plates[k]);
    w.walls.place_facets();
}

std::vector<double> common_of_first(Crossing &crossing, const World *first) {
    std::vector<double> numbers;
    if (first)
        numbers = common_of(*first);
    tell_all_of(crossing, numbers);
    return numbers;
}

// Lists have been made of where particles and plates were; now these are set to where they are.
void finish(World &w, const std::vector<double> &common) {
    set_common(w, common, false);
    if (w.walls.ghosts_placed)
        w.walls.place_ghosts(w.threads);
    w.lists_new = false;
    if (w.images.in_use())
        w.images.copy_all(w.particles);
}

// Rows of so many numbers that the first process has: each process asks it for some at a time, by keys of its own. Body row(key,
// out) on the first, take(k, row) where it was asked for.
template <class Key, class Row, class Take>
void ask_first(Crossing &crossing, int64_t count, std::size_t numbers, const Key &key, const Row &row,
               const Take &take) {
    const auto ranks = static_cast<std::size_t>(crossing.ranks());
    std::vector<std::vector<double>> asked(ranks), asked_here, out(ranks), in;
    for_each_turn(crossing, count, [&](int64_t begin, int64_t end) {
        asked[0].clear();
        for (int64_t k = begin; k < end; ++k)
            asked[0].push_back(static_cast<double>(key(k)));
        crossing.deal(asked, asked_here);
        for (std::size_t rank = 0; rank < ranks; ++rank) {
            out[rank].resize(numbers * asked_here[rank].size());
            double *next = out[rank].data();
            for (const double one : asked_here[rank]) {
                row(static_cast<int64_t>(one), next);
                next += numbers;
            }
        }
        crossing.deal(out, in);
        for (int64_t k = begin; k < end; ++k)
            take(k, in[0].data() + numbers * static_cast<std::size_t>(k - begin));
    });
}

// And such rows of all processes to the first one: pack(k, out), there take(row).
template <class Pack, class Take>
void tell_first(OnFirst &first, Crossing &crossing, int64_t count, std::size_t numbers, const Pack &pack,
                const Take &take) {
    std::vector<double> own, all;
    for_each_turn(crossing, count, [&](int64_t begin, int64_t end) {
        own.resize(numbers * static_cast<std::size_t>(end - begin));
        for (int64_t k = begin; k < end; ++k)
            pack(k, own.data() + numbers * static_cast<std::size_t>(k - begin));
        crossing.gather(own, all);
        first.run([&] {
            for (std::size_t at = 0; at < all.size(); at += numbers)
                take(all.data() + at);
        });
    });
}

std::vector<int64_t> places_of_ids(const Particles &p) {
    std::vector<int64_t> places(static_cast<std::size_t>(p.count));
    for (int64_t i = 0; i < p.count; ++i)
        places[p.id[i]] = i;
    return places;
}

// What lists are made of.
constexpr std::size_t listed_numbers = 4;
void pack_listed(const World &world, int64_t listed, int64_t i, double *out) {
    out[0] = static_cast<double>(world.particles.id[i]);
    out[1] = world.particles.column[i];
    out[2] = world.list_origin.x[listed];
    out[3] = world.list_origin.y[listed];
}
void take_listed(Particles &p, int64_t i, const double *row) {
    p.id[i] = static_cast<int64_t>(row[0]);
    p.column[i] = static_cast<int32_t>(row[1]);
    p.x[i] = row[2];
    p.y[i] = row[3];
}

void pack_fields(const std::vector<Field<double> *> &fields, int64_t i, double *out) {
    for (const Field<double> *field : fields)
        *out++ = (*field)[i];
}
void take_fields(const std::vector<Field<double> *> &fields, int64_t i, const double *row) {
    for (Field<double> *field : fields)
        (*field)[i] = *row++;
}

} // namespace

std::unique_ptr<World> make_part(const Scene &scene, Crossing &crossing) {
    auto part = make_bare_world(scene, scene.constants(), 1); // fields in use have a size
    part->crossing = &crossing;
    part->halo = std::make_unique<Halo>(crossing);
    part->mass = mass_of_all(*part);
    return part;
}

// Each begins with an equal share; from there particles go to their owners.
std::unique_ptr<World> deal_out(const Scene &scene, Crossing &crossing, const World *whole) {
    auto part = make_part(scene, crossing);
    const std::vector<double> common = common_of_first(crossing, whole);
    set_common(*part, common, true);
    int64_t all = whole ? whole->particles.count : 0;
    tell_all(&crossing, &all);
    const int64_t begin = all * crossing.rank() / crossing.ranks();
    const int64_t count = all * (crossing.rank() + 1) / crossing.ranks() - begin;
    resize_part(*part, count);
    Particles &p = part->particles;
    ask_first(
        crossing, count, listed_numbers, [&](int64_t k) { return begin + k; },
        [&](int64_t k, double *out) { pack_listed(*whole, k, whole->particle_listed_at(k), out); },
        [&](int64_t i, const double *row) { take_listed(p, i, row); });
    stages::make_lists(*part); // they go to their owners
    std::vector<int64_t> place_of_id;
    std::vector<Field<double> *> of_whole;
    if (whole) {
        place_of_id = places_of_ids(whole->particles);
        of_whole = carried_fields(const_cast<World *>(whole)->particles);
    }
    const std::vector<Field<double> *> fields = carried_fields(p);
    ask_first(
        crossing, p.count, fields.size(), [&](int64_t i) { return p.id[i]; },
        [&](int64_t id, double *out) { pack_fields(of_whole, place_of_id[id], out); },
        [&](int64_t i, const double *row) { take_fields(fields, i, row); });
    finish(*part, common);
    return part;
}

std::unique_ptr<World> put_together(const World &part) {
    Crossing &crossing = *part.crossing;
    const Particles &p = part.particles;
    const std::vector<double> common = common_of(part);
    const int64_t count = count_of_all(part);
    std::unique_ptr<World> whole;
    OnFirst first(crossing);
    first.run([&] {
        whole = make_bare_world(*part.scene, part.constants, count);
        set_common(*whole, common, true);
    });
    int64_t next = 0;
    tell_first(
        first, crossing, p.count, listed_numbers, [&](int64_t i, double *out) { pack_listed(part, i, i, out); },
        [&](const double *row) { take_listed(whole->particles, next++, row); });
    std::vector<int64_t> place_of_id;
    std::vector<Field<double> *> of_whole;
    first.run([&] {
        stages::make_lists(*whole);
        place_of_id = places_of_ids(whole->particles);
        of_whole = carried_fields(whole->particles);
    });
    const std::vector<Field<double> *> fields = carried_fields(const_cast<World &>(part).particles);
    tell_first(
        first, crossing, p.count, fields.size() + 1,
        [&](int64_t i, double *out) {
            *out = static_cast<double>(p.id[i]);
            pack_fields(fields, i, out + 1);
        },
        [&](const double *row) { take_fields(of_whole, place_of_id[static_cast<int64_t>(row[0])], row + 1); });
    first.run([&] { finish(*whole, common); });
    first.finish();
    return whole;
}

} // namespace gp
