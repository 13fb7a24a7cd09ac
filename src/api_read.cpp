// The calls of gp.h that read a simulation: as those of api.cpp.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <type_traits>
#include <vector>

#include "api.hpp"
#include "check.hpp"
#include "diagnostics.hpp"
#include "error.hpp"
#include "fields.hpp"
#include "granperi/gp.h"
#include "stretches.hpp"

namespace {

using namespace gp;

// Hands out a struct that the library fills, as much of it as the caller has room for.
template <class T> gp_status hand_out(T *target, T filled, const char *name) {
    require_pointer(name, target);
    const uint32_t size = target->struct_size;
    if (size < 2 * sizeof(uint32_t))
        throw make_error(GP_E_ARGUMENT, "%s.struct_size = %u: expected sizeof(%s), set by the caller", name, size,
                         name);
    filled.struct_size = size;
    std::memcpy(static_cast<void *>(target), &filled, std::min<std::size_t>(size, sizeof(T)));
    return GP_OK;
}

// Measures what has not been measured since the last step.
gp_status hand_out_state(gp_sim *sim, uint32_t parts, gp_state *target) {
    Sim &s = readable(sim);
    const bool fresh = sim->state_epoch != s.epoch();
    if (fresh || (parts & ~sim->state_parts)) {
        if (fresh)
            sim->state = measure_sums(s.world());
        measure_parts(s.world(), fresh ? parts : parts & ~sim->state_parts, sim->state);
        sim->state_parts = fresh ? parts : sim->state_parts | parts;
        sim->state_epoch = s.epoch();
    }
    sim->state.wall_seconds = s.wall_seconds();
    gp_state state = sim->state;
    leave_out(GP_STATE_ALL & ~parts, state);
    return hand_out(target, state, "gp_state");
}

void require_stations(int64_t n, const char *in_name, const double *in, const char *out_name, const double *out) {
    if (n < 0)
        throw make_error(GP_E_ARGUMENT, "n = %lld: expected a whole number >= 0", static_cast<long long>(n));
    if (n == 0)
        return;
    require_pointer(in_name, in);
    require_pointer(out_name, out);
    for (int64_t k = 0; k < n; ++k)
        if (!std::isfinite(in[k]))
            throw make_error(GP_E_ARGUMENT, "%s[%lld] = %g: expected a finite number", in_name,
                             static_cast<long long>(k), in[k]);
}

} // namespace

extern "C" {

gp_status gp_get_particles(gp_sim *sim, uint32_t fields, gp_particles *particles) {
    return guard([&] {
        require_pointer("particles", particles);
        if (fields & ~GP_FIELD_ALL)
            throw make_error(GP_E_ARGUMENT, "fields = 0x%x: expected bits GP_FIELD_... up to 0x%x", fields,
                             GP_FIELD_ALL);
        Sim &s = readable(sim);
        const World &world = s.world();
        gp_particles view{};
        view.count = world.particles.count;
        view.epoch = s.epoch();
        if (fields & GP_FIELD_ID)
            view.id = world.particles.id.data();
        if (fields & GP_FIELD_COLUMN)
            view.column = world.particles.column.data();
        // In the order of the bits.
        const double **pointers[] = {&view.x,
                                     &view.y,
                                     &view.vx,
                                     &view.vy,
                                     &view.pressure,
                                     &view.density,
                                     &view.sxx,
                                     &view.sxy,
                                     &view.syy,
                                     &view.shear_rate,
                                     &view.inertial_number,
                                     &view.viscosity,
                                     &view.number_density,
                                     &view.fluidity};
        static_assert(std::size(pointers) == std::extent_v<decltype(gp_sim::derived)>);
        static_assert((GP_FIELD_X << std::size(pointers)) - 1 == GP_FIELD_ALL, "a field without a pointer");
        for (uint32_t k = 0; k < std::size(pointers); ++k) {
            const uint32_t bit = GP_FIELD_X << k;
            if (fields & bit)
                *pointers[k] = read_field(world, bit, sim->derived[k]);
        }
        return hand_out(particles, view, "gp_particles");
    });
}

gp_status gp_copy_field(gp_sim *sim, uint32_t field, double *dst, int64_t n) {
    return guard_together(sim, [&] {
        if (field == 0 || (field & (field - 1)) || (field & ~GP_FIELD_ALL))
            throw make_error(GP_E_ARGUMENT, "field = 0x%x: expected exactly one of the bits GP_FIELD_...", field);
        Sim &s = readable(sim);
        if (s.crossing() && s.crossing()->rank() > 0 && n != 0)
            throw make_error(GP_E_ARGUMENT, "n = %lld: expected 0 but on the first process", static_cast<long long>(n));
        FieldsById fields(s.world());
        on_first(s.world(), [&] {
            if (n != fields.count())
                throw make_error(GP_E_ARGUMENT, "n = %lld: expected the number of particles, %lld",
                                 static_cast<long long>(n), static_cast<long long>(fields.count()));
            if (n > 0)
                require_pointer("dst", dst);
        });
        for (int64_t first = 0; first < fields.count(); first += stretch_size)
            fields.read(field, first, std::min(stretch_size, fields.count() - first), dst ? dst + first : nullptr);
        return GP_OK;
    });
}

gp_status gp_get_state(gp_sim *sim, gp_state *state) {
    return guard_together(sim, [&] {
        require_pointer("state", state);
        const uint32_t size = state->struct_size; // an older program's ends before what it does not know
        return hand_out_state(sim,
                              size <= offsetof(gp_state, x_left)  ? 0
                              : size <= offsetof(gp_state, x_q01) ? GP_STATE_DEPOSIT
                                                                  : GP_STATE_ALL,
                              state);
    });
}

gp_status gp_get_state_parts(gp_sim *sim, uint32_t parts, gp_state *state) {
    return guard_together(sim, [&] {
        require_pointer("state", state);
        if (parts & ~static_cast<uint32_t>(GP_STATE_ALL))
            throw make_error(GP_E_ARGUMENT, "parts = 0x%x: expected bits GP_STATE_... up to 0x%x", parts, GP_STATE_ALL);
        return hand_out_state(sim, parts, state);
    });
}

gp_status gp_get_clock(gp_sim *sim, double *time, double *dt, int64_t *step) {
    return guard([&] {
        require_simulation(sim);
        const Clock clock = sim->sim.clock();
        if (time)
            *time = clock.time;
        if (dt)
            *dt = clock.step > 0 ? clock.dt : 0.0;
        if (step)
            *step = clock.step;
        return GP_OK;
    });
}

gp_status gp_get_surface(gp_sim *sim, int64_t n, const double *x, double *height) {
    return guard_together(sim, [&] {
        require_stations(n, "x", x, "height", height);
        Sim &s = readable(sim);
        const Surface surface(s.world(), connected_deposit(s.world()));
        on_first(s.world(), [&] {
            for (int64_t k = 0; k < n; ++k)
                if (!surface.height(x[k], height[k]))
                    height[k] = 0;
        });
        tell_all(s.crossing(), height, n);
        return GP_OK;
    });
}

gp_status gp_get_interface(gp_sim *sim, int32_t left, int32_t right, int64_t n, const double *y, double *x) {
    return guard_together(sim, [&] {
        Sim &s = readable(sim);
        const auto bodies = static_cast<int64_t>(s.scene().bodies().size());
        require_choice("left", left, bodies);
        require_choice("right", right, bodies);
        if (left == right)
            throw make_error(GP_E_ARGUMENT, "right = %d: expected another column than left", right);
        require_stations(n, "y", y, "x", x);
        find_interface(s.world(), left, right, n, y, x);
        tell_all(s.crossing(), x, n);
        return GP_OK;
    });
}

gp_status gp_get_plate_load(gp_sim *sim, int32_t plate, gp_load *load) {
    return guard([&] {
        require_pointer("load", load);
        const World &world = readable(sim).world();
        require_choice("plate", plate, static_cast<int64_t>(world.walls.plates.size()));
        const Plate &p = world.walls.plates[plate];
        const Pose pose = p.pose(world.clock.time);
        gp_load filled{};
        filled.fx = p.force.x();
        filled.fy = p.force.y();
        filled.torque = p.torque;
        filled.dx = pose.shift.x();
        filled.dy = pose.shift.y();
        filled.impulse_x = p.impulse.x();
        filled.impulse_y = p.impulse.y();
        filled.torque_pivot = p.torque_pivot;
        filled.angle = pose.angle;
        filled.impulse_torque = p.impulse_torque;
        return hand_out(load, filled, "gp_load");
    });
}

gp_status gp_get_plan(gp_sim *sim, int64_t n, gp_plan_entry *entries, int64_t *n_out) {
    return guard([&] {
        require_pointer("n_out", n_out);
        *n_out = 0;
        if (n < 0)
            throw make_error(GP_E_ARGUMENT, "n = %lld: expected a whole number >= 0", static_cast<long long>(n));
        if (n > 0)
            require_pointer("entries", entries);
        const std::vector<gp_plan_entry> plan = readable(sim).plan();
        std::copy_n(plan.begin(), std::min<std::size_t>(plan.size(), static_cast<std::size_t>(n)), entries);
        *n_out = static_cast<int64_t>(plan.size());
        return GP_OK;
    });
}

} // extern "C"
