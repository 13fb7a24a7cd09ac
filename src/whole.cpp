#include "whole.hpp"

#include <algorithm>

#include "parts.hpp"
#include "stages/stages.hpp"

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
    if (w.images.in_use()) {
        w.images.copy_motion(w.particles);
        Particles &p = w.particles;
        w.images.copy({&p.density, &p.pressure, &p.sxx, &p.sxy});
        if (!p.fluidity.empty())
            w.images.copy(p.fluidity);
    }
}

} // namespace

std::unique_ptr<World> deal_out(const Scene &scene, Crossing &crossing, const World *whole) {
    auto part = make_bare_world(scene, scene.constants(), 1); // fields in use have a size
    resize_part(*part, whole ? whole->particles.count : 0);
    part->crossing = &crossing;
    part->halo = std::make_unique<Halo>(crossing);
    const std::vector<double> common = common_of_first(crossing, whole);
    set_common(*part, common, true);
    Particles &p = part->particles;
    std::vector<int64_t> place_of_id;
    if (whole) {
        const ListOrigin &origin = whole->list_origin;
        place_of_id.resize(static_cast<std::size_t>(p.count));
        for (int64_t k = 0; k < p.count; ++k) {
            const int64_t i = whole->particle_listed_at(k);
            p.id[k] = whole->particles.id[i];
            p.column[k] = whole->particles.column[i];
            p.x[k] = origin.x[k];
            p.y[k] = origin.y[k];
            place_of_id[p.id[k]] = i;
        }
    }
    stages::make_lists(*part); // they go to their owners
    std::vector<double> own(p.id.begin(), p.id.begin() + p.count), all, counts;
    crossing.gather_everywhere({static_cast<double>(p.count)}, counts);
    crossing.gather(own, all);
    const std::vector<Field<double> *> fields = carried_fields(p);
    std::vector<std::vector<double>> out(static_cast<std::size_t>(crossing.ranks())), in;
    if (whole) {
        const std::vector<Field<double> *> from = carried_fields(const_cast<World *>(whole)->particles);
        std::size_t next = 0;
        for (std::size_t rank = 0; rank < out.size(); ++rank)
            for (auto left = static_cast<int64_t>(counts[rank]); left > 0; --left) {
                const int64_t i = place_of_id[static_cast<std::size_t>(all[next++])];
                for (const Field<double> *field : from)
                    out[rank].push_back((*field)[i]);
            }
    }
    crossing.deal(out, in);
    const double *number = in[0].data();
    for (int64_t i = 0; i < p.count; ++i)
        for (Field<double> *field : fields)
            (*field)[i] = *number++;
    finish(*part, common);
    return part;
}

std::unique_ptr<World> put_together(const World &part) {
    Crossing &crossing = *part.crossing;
    const Particles &p = part.particles;
    const std::vector<Field<double> *> fields = carried_fields(const_cast<World &>(part).particles);
    const std::size_t numbers = fields.size() + 4;
    std::vector<double> own, all;
    own.reserve(numbers * static_cast<std::size_t>(p.count));
    for (int64_t i = 0; i < p.count; ++i) {
        own.insert(own.end(), {static_cast<double>(p.id[i]), static_cast<double>(p.column[i]), part.list_origin.x[i],
                               part.list_origin.y[i]});
        for (const Field<double> *field : fields)
            own.push_back((*field)[i]);
    }
    crossing.gather(own, all);
    if (crossing.rank() != 0)
        return nullptr;
    const auto count = static_cast<int64_t>(all.size() / numbers);
    auto whole = make_bare_world(*part.scene, part.constants, count);
    const std::vector<double> common = common_of(part);
    set_common(*whole, common, true);
    Particles &w = whole->particles;
    std::vector<const double *> record_of_id(static_cast<std::size_t>(count));
    for (int64_t i = 0; i < count; ++i) {
        const double *record = all.data() + numbers * static_cast<std::size_t>(i);
        w.id[i] = static_cast<int64_t>(record[0]);
        w.column[i] = static_cast<int32_t>(record[1]);
        w.x[i] = record[2];
        w.y[i] = record[3];
        record_of_id[w.id[i]] = record;
    }
    stages::make_lists(*whole);
    const std::vector<Field<double> *> of_whole = carried_fields(w);
    for (int64_t i = 0; i < count; ++i) {
        const double *number = record_of_id[w.id[i]] + 4;
        for (Field<double> *field : of_whole)
            (*field)[i] = *number++;
    }
    finish(*whole, common);
    return whole;
}

} // namespace gp
