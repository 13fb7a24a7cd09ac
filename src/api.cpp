// The extern "C" file of gp.h: each call guards against exceptions, checks its pointers, and delegates.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>

#include "check.hpp"
#include "diagnostics.hpp"
#include "entry.hpp"
#include "error.hpp"
#include "fields.hpp"
#include "granperi/gp.h"
#include "handle.hpp"
#include "io/checkpoint.hpp"
#include "level.hpp"
#include "stretches.hpp"

namespace {

using namespace gp;

void require_simulation(const gp_sim *handle) {
    if (!handle)
        throw make_error(GP_E_ARGUMENT,
                         "sim = NULL: expected a simulation of gp_create or gp_load; has that call failed?");
}

// For calls that change the simulation: not possible inside its callback.
Sim &outside_callback(gp_sim *handle, const char *call) {
    require_simulation(handle);
    if (handle->sim.in_callback())
        throw make_error(GP_E_STATE, "%s: called from inside the simulation's callback", call);
    return handle->sim;
}

Sim &readable(gp_sim *handle) {
    require_simulation(handle);
    handle->sim.prepare();
    return handle->sim;
}

template <class T> gp_status initialise(T *target, std::size_t size, const T &defaults, const char *name) {
    require_pointer(name, target);
    if (size < 2 * sizeof(uint32_t) || size > 65536)
        throw make_error(GP_E_ARGUMENT, "size = %zu: expected sizeof(%s)", size, name);
    T whole = defaults;
    whole.struct_size = static_cast<uint32_t>(size);
    std::memset(static_cast<void *>(target), 0, size);
    std::memcpy(static_cast<void *>(target), &whole, std::min(size, sizeof(T)));
    return GP_OK;
}

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

// What the first process has found goes to all.
template <class T> void tell_all(const Sim &sim, T *values, int64_t count) {
    if (sim.crossing())
        sim.crossing()->broadcast(values, count * static_cast<int64_t>(sizeof(T)), 0);
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

void put_id(int32_t *id, int32_t value) {
    if (id)
        *id = value;
}

} // namespace

extern "C" {

// ------------------------------------------------------------------------------------------ status, version

const char *gp_status_string(gp_status status) {
    return status_text(status);
}

const char *gp_last_error(void) {
    return last_error();
}

uint32_t gp_version(void) {
    return GP_VERSION_MAJOR * 10000u + GP_VERSION_MINOR * 100u + GP_VERSION_PATCH;
}

#define GP_TEXT(x) #x
#define GP_NUMBER_TEXT(x) GP_TEXT(x)
const char *gp_version_string(void) {
    return GP_NUMBER_TEXT(GP_VERSION_MAJOR) "." GP_NUMBER_TEXT(GP_VERSION_MINOR) "." GP_NUMBER_TEXT(GP_VERSION_PATCH);
}

int32_t gp_has_feature(const char *name) {
    if (!name)
        return 0;
#ifdef GP_WITH_HDF5
    if (std::strcmp(name, "hdf5") == 0)
        return 1;
#endif
#ifdef GP_WITH_OPENMP
    if (std::strcmp(name, "openmp") == 0)
        return 1;
#endif
    if (std::strcmp(name, "mpi") == 0)
        return has_mpi ? 1 : 0;
    return std::strcmp(name, level_name) == 0;
}

// ----------------------------------------------------------------------------------------------- parameters

gp_status gp_config_init(gp_config *config, size_t size, int32_t preset) {
    return guard([&] { return initialise(config, size, default_config(preset), "gp_config"); });
}

gp_status gp_material_init(gp_material *material, size_t size) {
    return guard([&] { return initialise(material, size, default_material(), "gp_material"); });
}

gp_status gp_column_init(gp_column *column, size_t size) {
    return guard([&] { return initialise(column, size, default_column(), "gp_column"); });
}

gp_status gp_plate_init(gp_plate *plate, size_t size) {
    return guard([&] { return initialise(plate, size, default_plate(), "gp_plate"); });
}

gp_status gp_output_init(gp_output *output, size_t size) {
    return guard([&] { return initialise(output, size, io::default_output(), "gp_output"); });
}

// ---------------------------------------------------------------------------------------------------- scene

gp_status gp_create(const gp_config *config, gp_sim **sim) {
    return guard([&] {
        require_pointer("sim", sim);
        *sim = nullptr;
        require_level();
        // Fields that an older program does not know are those of the preset it knows: the default one.
        *sim = new gp_sim(complete(config, default_config(GP_PRESET_DEFAULT), "gp_config"));
        return GP_OK;
    });
}

void gp_destroy(gp_sim *sim) {
    const Entry entry; // its output may have to be closed
    if (sim && !sim->sim.in_callback())
        delete sim;
}

gp_status gp_add_material(gp_sim *sim, const gp_material *material, int32_t *id) {
    return guard([&] {
        put_id(id, 0);
        Sim &s = outside_callback(sim, "gp_add_material");
        put_id(id, s.add_material(complete(material, default_material(), "gp_material")));
        return GP_OK;
    });
}

gp_status gp_add_column(gp_sim *sim, const gp_column *column, int32_t *id) {
    return guard([&] {
        put_id(id, 0);
        Sim &s = outside_callback(sim, "gp_add_column");
        put_id(id, s.add_column(complete(column, default_column(), "gp_column")));
        return GP_OK;
    });
}

gp_status gp_add_particles(gp_sim *sim, int32_t material, int64_t n, const double *x, const double *y, const double *vx,
                           const double *vy, int32_t *id) {
    return guard([&] {
        put_id(id, 0);
        put_id(id, outside_callback(sim, "gp_add_particles").add_particles(material, n, x, y, vx, vy));
        return GP_OK;
    });
}

gp_status gp_add_plate(gp_sim *sim, const gp_plate *plate, int32_t *id) {
    return guard([&] {
        put_id(id, 0);
        Sim &s = outside_callback(sim, "gp_add_plate");
        put_id(id, s.add_plate(complete(plate, default_plate(), "gp_plate")));
        return GP_OK;
    });
}

gp_status gp_set_plate_velocity(gp_sim *sim, int32_t plate, double vx, double vy) {
    return gp_set_plate_motion(sim, plate, vx, vy, 0);
}

gp_status gp_set_plate_motion(gp_sim *sim, int32_t plate, double vx, double vy, double omega) {
    return guard([&] {
        require_simulation(sim);
        sim->sim.set_plate_motion(plate, vx, vy, omega);
        return GP_OK;
    });
}

gp_status gp_set_gravity(gp_sim *sim, double gx, double gy) {
    return guard([&] {
        require_simulation(sim);
        sim->sim.set_gravity(gx, gy);
        return GP_OK;
    });
}

// -------------------------------------------------------------------------------------------------- running

gp_status gp_step(gp_sim *sim, int64_t n) {
    return guard([&] { return outside_callback(sim, "gp_step").step(sim, n); });
}

gp_status gp_run(gp_sim *sim, double t_end) {
    return guard([&] { return outside_callback(sim, "gp_run").run(sim, t_end); });
}

gp_status gp_set_callback(gp_sim *sim, int64_t every, gp_callback callback, void *user) {
    return guard([&] {
        outside_callback(sim, "gp_set_callback").set_callback(every, callback, user);
        return GP_OK;
    });
}

gp_status gp_set_log(gp_sim *sim, gp_log log, void *user) {
    return guard([&] {
        outside_callback(sim, "gp_set_log").set_log(log, user);
        return GP_OK;
    });
}

// -------------------------------------------------------------------------------------------------- reading

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
        for (uint32_t k = 0; k < std::size(pointers); ++k) {
            const uint32_t bit = GP_FIELD_X << k;
            if (fields & bit)
                *pointers[k] = read_field(world, bit, sim->derived[k]);
        }
        return hand_out(particles, view, "gp_particles");
    });
}

gp_status gp_copy_field(gp_sim *sim, uint32_t field, double *dst, int64_t n) {
    return guard([&] {
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
    return guard([&] {
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
    return guard([&] {
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
    return guard([&] {
        require_stations(n, "x", x, "height", height);
        Sim &s = readable(sim);
        const Surface surface(s.world(), connected_deposit(s.world()));
        on_first(s.world(), [&] {
            for (int64_t k = 0; k < n; ++k)
                if (!surface.height(x[k], height[k]))
                    height[k] = 0;
        });
        tell_all(s, height, n);
        return GP_OK;
    });
}

gp_status gp_get_interface(gp_sim *sim, int32_t left, int32_t right, int64_t n, const double *y, double *x) {
    return guard([&] {
        Sim &s = readable(sim);
        const auto bodies = static_cast<int64_t>(s.scene().bodies().size());
        require_choice("left", left, bodies);
        require_choice("right", right, bodies);
        if (left == right)
            throw make_error(GP_E_ARGUMENT, "right = %d: expected another column than left", right);
        require_stations(n, "y", y, "x", x);
        for (int64_t k = 0; k < n; ++k)
            if (!interface_at(s.world(), left, right, y[k], x[k]))
                x[k] = std::numeric_limits<double>::quiet_NaN();
        tell_all(s, x, n);
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

// ---------------------------------------------------------------------------------------------------- files

gp_status gp_save(gp_sim *sim, const char *path) {
    return guard([&]() -> gp_status {
        require_simulation(sim);
        require_pointer("path", path);
        Sim &s = sim->sim;
        const auto save = [&](const World *world) {
            io::save_checkpoint(path, s, world, sim->output ? sim->output->position(s.world()) : sim->left_off);
        };
        if (!s.progress().started) {
            if (s.crossing())
                run_on_first(*s.crossing(), [&] { save(nullptr); });
            else
                save(nullptr);
            return GP_OK;
        }
        s.prepare();
        const World *whole = s.whole();
        on_first(s.world(), [&] { save(whole); });
        return GP_OK;
    });
}

gp_status gp_load_file(const char *path, gp_sim **sim) {
    return guard([&]() -> gp_status {
        require_pointer("sim", sim);
        *sim = nullptr;
        require_pointer("path", path);
        require_level();
        std::unique_ptr<gp_sim> loaded;
        const auto create = [&](const gp_config &config) -> Sim & {
            loaded = std::make_unique<gp_sim>(config);
            return loaded->sim;
        };
        io::OutputPosition left_off;
        io::load_checkpoint(path, create, left_off);
        loaded->left_off = std::move(left_off);
        *sim = loaded.release();
        return GP_OK;
    });
}

gp_status gp_output_open(gp_sim *sim, const char *path, const gp_output *output) {
    return guard([&] {
        Sim &s = outside_callback(sim, "gp_output_open");
        require_pointer("path", path);
        if (s.sink)
            throw make_error(GP_E_STATE, "gp_output_open: an output is open already; gp_output_close it first");
        const gp_output options = output ? complete(output, io::default_output(), "gp_output") : io::default_output();
        s.prepare();
        sim->output = std::make_unique<io::Output>(path, options, s.world(), sim->left_off);
        s.sink = sim->output.get();
        sim->left_off = {};
        return GP_OK;
    });
}

gp_status gp_output_write(gp_sim *sim) {
    return guard([&] {
        require_simulation(sim);
        if (!sim->sim.sink)
            throw make_error(GP_E_STATE, "gp_output_write: no output is open");
        sim->output->write(readable(sim).world());
        return GP_OK;
    });
}

gp_status gp_output_close(gp_sim *sim) {
    return guard([&] {
        Sim &s = outside_callback(sim, "gp_output_close");
        if (!s.sink)
            throw make_error(GP_E_STATE, "gp_output_close: no output is open");
        s.sink = nullptr;
        const std::unique_ptr<io::Output> closing = std::move(sim->output);
        on_first(s.world(), [&] { closing->close(); });
        return GP_OK;
    });
}

} // extern "C"
