// The calls of gp.h that make, change and save a simulation: each guards against exceptions, checks its pointers, and delegates.
#include "api.hpp"

#include <algorithm>
#include <cstring>

#include "check.hpp"
#include "entry.hpp"
#include "error.hpp"
#include "granperi/gp.h"
#include "io/checkpoint.hpp"
#include "level.hpp"
#include "parts.hpp"

namespace {

using namespace gp;

// For calls that change the simulation: not possible inside its callback.
Sim &outside_callback(gp_sim *handle, const char *call) {
    require_simulation(handle);
    if (handle->sim.in_callback())
        throw make_error(GP_E_STATE, "%s: called from inside the simulation's callback", call);
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

void put_id(int32_t *id, int32_t value) {
    if (id)
        *id = value;
}

// add returns an id, which the host gets once all processes have added.
template <class Add> gp_status add_together(gp_sim *sim, int32_t *id, const Add &add) {
    put_id(id, 0);
    int32_t added = 0;
    const gp_status status = guard_together(sim, [&] {
        added = add();
        return GP_OK;
    });
    if (status == GP_OK)
        put_id(id, added);
    return status;
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
        *sim = new gp_sim(complete_config(config));
        return GP_OK;
    });
}

void gp_destroy(gp_sim *sim) {
    const Entry entry; // its output may have to be closed
    if (sim && !sim->sim.in_callback())
        delete sim;
}

gp_status gp_add_material(gp_sim *sim, const gp_material *material, int32_t *id) {
    return add_together(sim, id, [&] {
        Sim &s = outside_callback(sim, "gp_add_material");
        return s.add_material(complete(material, default_material(), "gp_material"));
    });
}

gp_status gp_add_column(gp_sim *sim, const gp_column *column, int32_t *id) {
    return add_together(sim, id, [&] {
        Sim &s = outside_callback(sim, "gp_add_column");
        return s.add_column(complete(column, default_column(), "gp_column"));
    });
}

gp_status gp_add_particles(gp_sim *sim, int32_t material, int64_t n, const double *x, const double *y, const double *vx,
                           const double *vy, int32_t *id) {
    return add_together(
        sim, id, [&] { return outside_callback(sim, "gp_add_particles").add_particles(material, n, x, y, vx, vy); });
}

gp_status gp_add_plate(gp_sim *sim, const gp_plate *plate, int32_t *id) {
    return add_together(sim, id, [&] {
        Sim &s = outside_callback(sim, "gp_add_plate");
        return s.add_plate(complete(plate, default_plate(), "gp_plate"));
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
    return guard_together(sim, [&] {
        sim->sim.set_gravity(gx, gy);
        return GP_OK;
    });
}

// -------------------------------------------------------------------------------------------------- running

gp_status gp_step(gp_sim *sim, int64_t n) {
    return guard_together(sim, [&] { return outside_callback(sim, "gp_step").step(sim, n); });
}

gp_status gp_run(gp_sim *sim, double t_end) {
    return guard_together(sim, [&] { return outside_callback(sim, "gp_run").run(sim, t_end); });
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

// ---------------------------------------------------------------------------------------------------- files

gp_status gp_save(gp_sim *sim, const char *path) {
    return guard_together(sim, [&]() -> gp_status {
        require_pointer("path", path);
        Sim &s = sim->sim;
        const bool started = s.progress().started;
        if (started || sim->output) // the place in the file is told by the world
            s.prepare();
        io::save_checkpoint(path, s, started ? &s.world() : nullptr,
                            sim->output ? sim->output->position(s.world()) : sim->left_off);
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
        io::load_checkpoint(path, nullptr, create, left_off);
        loaded->left_off = std::move(left_off);
        *sim = loaded.release();
        return GP_OK;
    });
}

gp_status gp_output_open(gp_sim *sim, const char *path, const gp_output *output) {
    return guard_together(sim, [&] {
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
    return guard_together(sim, [&] {
        if (!sim->sim.sink)
            throw make_error(GP_E_STATE, "gp_output_write: no output is open");
        sim->output->write(readable(sim).world());
        return GP_OK;
    });
}

gp_status gp_output_close(gp_sim *sim) {
    return guard_together(sim, [&] {
        Sim &s = outside_callback(sim, "gp_output_close");
        if (!s.sink)
            throw make_error(GP_E_STATE, "gp_output_close: no output is open");
        s.sink = nullptr;
        const std::unique_ptr<io::Output> closing = std::move(sim->output);
        on_first(s.crossing(), [&] { closing->close(); });
        return GP_OK;
    });
}

} // extern "C"
