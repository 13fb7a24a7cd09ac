#include "undo.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>

#include "awake.hpp"
#include "error.hpp"
#include "material/compression.hpp"

namespace gp {

namespace {

// A list without memory of its own: it is made in every step.
struct FieldList {
    std::array<Field<double> *, 16> field{};
    std::size_t count = 0;

    void add(std::initializer_list<Field<double> *> more) {
        if (more.size() > field.size() - count)
            throw make_error(GP_E_INTERNAL, "undo: more than %zu fields", field.size());
        for (Field<double> *one : more)
            field[count++] = one;
    }
    std::size_t size() const { return count; }
    Field<double> *operator[](std::size_t k) const { return field[k]; }
    Field<double> *const *begin() const { return field.data(); }
    Field<double> *const *end() const { return field.data() + count; }
};

// After a step of the default scheme the pressure is that of the density (stages::density), and need not be kept; a scene
// begins with pressures of its own, whose densities are rounded.
bool pressure_follows(const World &world) {
    return world.constants.scheme == Scheme::adjoint && world.clock.step > 0;
}

FieldList fields_changed_in_place(World &world) {
    Particles &p = world.particles;
    FieldList fields;
    fields.add({&p.density});
    if (!pressure_follows(world))
        fields.add({&p.pressure});
    const Scheme scheme = world.constants.scheme;
    if (scheme != Scheme::adjoint) // particles move before all of the step is known
        fields.add({&p.sxx, &p.sxy, &p.x, &p.y, &p.vx, &p.vy});
    if (by_number_density(scheme))
        fields.add({&p.syy});
    if (world.constants.fluid)
        fields.add({&p.fluidity});
    return fields;
}

void follow_density(World &world) {
    Particles &p = world.particles;
    const double c2 = world.constants.sound_speed * world.constants.sound_speed;
    for (int64_t i = 0; i < p.count; ++i)
        p.pressure[i] = pressure_of(p.density[i], world.material_of(i).density, c2);
}

std::array<Field<double> *, 4> fields_made_anew(World &world) {
    Particles &p = world.particles;
    return {&p.lxx, &p.lxy, &p.lyx, &p.lyy};
}

// The order of before the step's sort. Lists and cells stay those of the sorted order, to be read through `listed`.
void undo_sort(World &world) {
    const Field<int32_t> &order = world.grid.order();
    Field<int32_t> place(order.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        place[order[k]] = static_cast<int32_t>(k);
    world.listed = order;
    world.particles.reorder(place, world.threads);
}

// What the step has lent goes back to the fields that it begins with.
void give_memory_back(World &world) {
    StepStart &start = world.step_start;
    Particles &p = world.particles;
    if (world.constants.scheme != Scheme::adjoint) {
        p.give_back(false);
        return;
    }
    p.give_back(true);
    if (!start.sxx.empty()) {
        hand_over(start.sxx, p.gxx);
        hand_over(start.sxy, p.gxy);
    }
    if (p.push_x.empty()) {
        hand_over(start.made[0], p.push_x);
        hand_over(start.made[1], p.push_y);
    }
}

} // namespace

void begin_step(World &world) {
    StepStart &start = world.step_start;
    start.clock = world.clock;
    start.ledger = world.ledger;
    start.plates = world.walls.plates;
    start.shifted = world.shifted;
    start.closed_in = world.closed_in;
    start.fields_kept = false;
    world.lists_new = false;
}

void keep_fields(World &world) {
    StepStart &start = world.step_start;
    const auto changed = fields_changed_in_place(world);
    const auto made = fields_made_anew(world);
    start.copied.resize(changed.size());
    for (std::size_t k = 0; k < changed.size(); ++k)
        start.copied[k].resize(world.particles.count);
    if (world.constants.scheme == Scheme::adjoint) { // pushes come after the step is known to be good
        hand_over(world.particles.push_x, start.made[0]);
        hand_over(world.particles.push_y, start.made[1]);
    }
    for (std::size_t k = 0; k < made.size(); ++k)
        start.made[k].resize(made[k]->size()); // with the places of images
    for_each_awake_block(world, [&](int64_t, int64_t begin, int64_t end) {
        for (std::size_t k = 0; k < changed.size(); ++k)
            std::copy(changed[k]->data() + begin, changed[k]->data() + end, start.copied[k].data() + begin);
    });
    for (std::size_t k = 0; k < made.size(); ++k)
        made[k]->swap(start.made[k]);
    start.fields_kept = true;
}

void accept_step(World &world) {
    world.step_start.fields_kept = false;
    give_memory_back(world);
}

void undo_step(World &world, UndoneOrder order) {
    StepStart &start = world.step_start;
    if (start.fields_kept) {
        if (!start.sxx.empty()) {
            for_each_awake_block(
                world, [&](int64_t, int64_t begin, int64_t end) { // the rest of the memory is the shape's
                    std::copy(start.sxx.data() + begin, start.sxx.data() + end, world.particles.sxx.data() + begin);
                    std::copy(start.sxy.data() + begin, start.sxy.data() + end, world.particles.sxy.data() + begin);
                });
        }
        const auto changed = fields_changed_in_place(world);
        const auto made = fields_made_anew(world);
        for_each_awake_block(world, [&](int64_t, int64_t begin, int64_t end) {
            for (std::size_t k = 0; k < changed.size(); ++k)
                std::copy(start.copied[k].data() + begin, start.copied[k].data() + end, changed[k]->data() + begin);
        });
        if (pressure_follows(world))
            follow_density(world);
        for (std::size_t k = 0; k < made.size(); ++k)
            made[k]->swap(start.made[k]);
        if (world.images.in_use()) {
            const Particles &p = world.particles;
            world.images.copy_motion(world.particles);
            for (Field<double> *field : changed)
                if (field != &p.x && field != &p.y && field != &p.vx && field != &p.vy)
                    world.images.copy(*field);
            world.images.copy({&world.particles.pressure, &world.particles.sxx, &world.particles.sxy});
        }
    }
    give_memory_back(world);
    const bool sorted = world.lists_new && start.fields_kept && !world.constants.period && !world.crossing;
    if (world.lists_new)
        world.lists_valid = false; // the plates are about to be where they were
    start.fields_kept = false;
    const double level = world.ledger.level; // positions that have returned into the period stay there
    world.clock = start.clock;
    world.ledger = start.ledger;
    world.ledger.level = level;
    world.walls.plates = start.plates;
    world.walls.place_facets();
    world.shifted = start.shifted;
    world.closed_in = start.closed_in;
    if (sorted && order == UndoneOrder::before)
        undo_sort(world); // last: it needs memory
}

} // namespace gp
