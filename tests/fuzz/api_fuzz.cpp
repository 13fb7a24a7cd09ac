// Sequences of calls of gp.h, two simulations side by side: hostile values and sizes, any order, calls out of callbacks.
// An error changes nothing; what is stepped stays finite; a checkpoint has the bits of what was saved.
#include <algorithm>
#include <cstddef>

#include "fuzz.hpp"

using namespace fuzz;

namespace {

constexpr double dl = 0.01;
constexpr int64_t most_particles = 250;
constexpr int most_steps = 24; // of one input

// What can be set in a struct, by its place, with a usual value of doubles (0: that of its _init).
struct Item {
    std::size_t offset;
    char type; // d, i (32 bits), l (64 bits)
    double usual;
};
#define D(type, member, usual)                                                                                         \
    { offsetof(type, member), 'd', usual }
#define I(type, member, usual)                                                                                         \
    { offsetof(type, member), 'i', usual }
#define L(type, member, usual)                                                                                         \
    { offsetof(type, member), 'l', usual }
const Item config_items[] = {D(gp_config, spacing, dl),
                             D(gp_config, gravity_x, 3),
                             D(gp_config, gravity_y, -9.81),
                             D(gp_config, sound_speed, 20),
                             D(gp_config, cfl, 0.3),
                             D(gp_config, time_step, 1e-4),
                             D(gp_config, interaction_radius, 3.1),
                             D(gp_config, horizon, 3),
                             D(gp_config, horizon_length, 0.03),
                             I(gp_config, nonlocal, 0),
                             I(gp_config, stress, 2),
                             I(gp_config, density, 1),
                             D(gp_config, friction_factor, 1),
                             D(gp_config, delta, 1e-2),
                             D(gp_config, collision_distance, 0.5),
                             D(gp_config, zero_energy_penalty, 0.01),
                             D(gp_config, density_diffusion, 0.1),
                             D(gp_config, channel_width, 0.1),
                             D(gp_config, channel_friction, 0.3),
                             D(gp_config, periodic_x_min, -0.1),
                             D(gp_config, periodic_x_max, 0.2),
                             I(gp_config, threads, 1),
                             L(gp_config, seed, 1),
                             D(gp_config, jitter, 0.2),
                             I(gp_config, preset, 1),
                             D(gp_config, bulk_viscosity, 0.05),
                             D(gp_config, implicit_tolerance, 1e-4),
                             I(gp_config, implicit_iterations, 20),
                             I(gp_config, allow_unstable_step, 1),
                             I(gp_config, retry_halvings, 3),
                             I(gp_config, sleep, 1)};
const Item material_items[] = {D(gp_material, grain_density, 2500),
                               D(gp_material, volume_fraction, 0.6),
                               D(gp_material, grain_diameter, 0.002),
                               D(gp_material, mu_s, 0.38),
                               D(gp_material, mu_2, 0.64),
                               D(gp_material, i0, 0.3),
                               D(gp_material, k0, 0.6),
                               D(gp_material, nonlocal_amplitude, 0.48),
                               D(gp_material, fluidity_time, 1e-3)};
const Item column_items[] = {D(gp_column, x_min, 3 * dl), D(gp_column, y_min, dl),
                             D(gp_column, width, 6 * dl), D(gp_column, height, 5 * dl),
                             I(gp_column, material, 1),   D(gp_column, vx, 0.5),
                             D(gp_column, vy, -0.5),      I(gp_column, initial_pressure, 1)};
const Item plate_items[] = {D(gp_plate, x0, 10 * dl),
                            D(gp_plate, y0, 4 * dl),
                            D(gp_plate, x1, -10 * dl),
                            D(gp_plate, y1, dl),
                            I(gp_plate, friction, 2),
                            D(gp_plate, wall_mu, 0.3),
                            D(gp_plate, vx, 0.2),
                            D(gp_plate, vy, 0.4),
                            D(gp_plate, normal_pressure, 200),
                            D(gp_plate, mass_per_length, 3),
                            L(gp_plate, n_points, 4),
                            D(gp_plate, pivot_x, 0.05),
                            D(gp_plate, pivot_y, 0.1),
                            D(gp_plate, omega, 2),
                            D(gp_plate, surface_velocity, 0.3),
                            I(gp_plate, fluidity, 1)};
const Item output_items[] = {D(gp_output, every_seconds, 1e-3), I(gp_output, fields, 0xff),
                             I(gp_output, compression, 1), I(gp_output, single_precision, 1), L(gp_output, append, 1)};

// A struct in a buffer with room behind it, so that a wrong struct_size is no error of this program.
template <class T> struct Struct {
    alignas(T) unsigned char room[66000] = {};
    T &value() { return *reinterpret_cast<T *>(room); }

    template <std::size_t N> const T *change(Bytes &in, const Item (&items)[N]) {
        for (int n = in.below(5); n > 0; --n) {
            const Item &item = items[static_cast<std::size_t>(in.below(N))];
            if (item.type == 'd') {
                const double number = in.number(item.usual);
                std::memcpy(room + item.offset, &number, sizeof number);
            } else {
                const int64_t number = in.integer(static_cast<int64_t>(item.usual));
                std::memcpy(room + item.offset, &number, item.type == 'i' ? 4 : 8);
            }
        }
        const uint8_t kind = in.byte();
        const uint32_t sizes[] = {0, 4, 8, sizeof(T) - 8, sizeof(T) + 8, 65536, 65537, 0xffffffffu};
        if (kind >= 240)
            value().struct_size = sizes[kind % 8];
        if (kind == 239)
            room[sizeof(T) + 3] = 1;
        return kind == 238 ? nullptr : &value();
    }
};

struct Host {
    gp_sim *sim = nullptr;
    int steps_left = 0;
    uint8_t reenter = 0;
    int64_t particles = 0;
    bool diverged = false;
};

int32_t callback(void *user, gp_sim *sim) {
    Host &host = *static_cast<Host *>(user);
    bits_of(sim, true);
    gp_column column;
    switch (host.reenter % 8) {
    case 1: ALWAYS(checked(gp_step(sim, 1)) == GP_E_STATE); break;
    case 2: gp_destroy(sim); break;
    case 3: ALWAYS(checked(gp_set_callback(sim, 1, nullptr, nullptr)) == GP_E_STATE); break;
    case 4:
        ALWAYS(gp_column_init(&column, sizeof column) == GP_OK);
        ALWAYS(checked(gp_add_column(sim, &column, nullptr)) == GP_E_STATE);
        break;
    case 5: ALWAYS(checked(gp_save(sim, own_file("callback.gp").c_str())) == GP_OK); break;
    case 6:
        checked(gp_set_plate_motion(sim, 0, 0.1, 0, host.reenter & 8 ? 3 : 0));
        ALWAYS(checked(gp_set_gravity(sim, 0.1 * host.steps_left, -9)) == GP_OK);
        break;
    case 7: ALWAYS(checked(gp_output_close(sim)) == GP_E_STATE); break;
    default: break;
    }
    return --host.steps_left <= 0;
}

void log_line(void *, int32_t level, const char *text) {
    ALWAYS((level == GP_LOG_INFO || level == GP_LOG_WARNING) && *text != '\0');
}

void create(Host &host, Bytes &in) {
    static Struct<gp_config> config;
    config = {};
    ALWAYS(gp_config_init(&config.value(), sizeof(gp_config), in.below(3)) == GP_OK);
    gp_config &c = config.value();
    c.spacing = dl;
    c.threads = 1;
    const gp_config *given = config.change(in, config_items);
    if (c.implicit_iterations > 50 && c.implicit_iterations <= 10000)
        c.implicit_iterations = 50;
    host = {};
    if (checked(gp_create(given, &host.sim)) < 0) {
        ALWAYS(host.sim == nullptr);
        return;
    }
    gp_set_log(host.sim, log_line, nullptr);
}

// Of a call that may fail: then all is as before.
template <class Call> void unless_changed(gp_sim *sim, const Call &call) {
    gp_state state{};
    state.struct_size = sizeof state;
    const bool readable = gp_get_state(sim, &state) == GP_OK; // not a scene that cannot be: see checked_scene
    const std::string before = readable ? bits_of(sim, false) : "";
    if (checked(call()) < 0 && readable)
        ALWAYS(bits_of(sim, false) == before);
}

void step(Host &host, Bytes &in) {
    if (host.steps_left <= 0)
        return;
    const uint8_t kind = in.byte();
    host.reenter = in.byte();
    gp_state before{};
    before.struct_size = sizeof before;
    const bool readable = checked(gp_get_state(host.sim, &before)) == GP_OK;
    ALWAYS(gp_set_callback(host.sim, 1, callback, &host) == GP_OK);
    const gp_status status =
        checked(kind % 2 ? gp_step(host.sim, in.integer(3)) : gp_run(host.sim, before.time + in.number(2e-3)));
    if (status == GP_E_DIVERGED && readable) {
        host.diverged = true;
        ALWAYS(checked(gp_step(host.sim, 1)) == GP_E_STATE);
    }
    if (readable) {
        bits_of(host.sim, state_of(host.sim).step > 0);
        ALWAYS(state_of(host.sim).time >= before.time && state_of(host.sim).step >= before.step);
    }
}

void save_and_load(Host &host) {
    const std::string path = own_file("state.gp");
    gp_state state{};
    state.struct_size = sizeof state;
    if (gp_get_state(host.sim, &state) < 0)
        return;
    const std::string before = bits_of(host.sim, false);
    ALWAYS(checked(gp_save(host.sim, path.c_str())) == GP_OK);
    ALWAYS(bits_of(host.sim, false) == before);
    gp_sim *loaded;
    ALWAYS(checked(gp_load(path.c_str(), &loaded)) == GP_OK);
    ALWAYS(bits_of(loaded, false) == before);
    gp_destroy(host.sim);
    host.sim = loaded;
}

void add(Host &host, Bytes &in, int what) {
    int32_t id = 7;
    const auto give = [&](gp_status status) {
        ALWAYS(status == GP_OK || id == 0);
        return status;
    };
    if (what == 0) {
        static Struct<gp_material> material;
        material = {};
        ALWAYS(gp_material_init(&material.value(), sizeof(gp_material)) == GP_OK);
        const gp_material *given = material.change(in, material_items);
        unless_changed(host.sim, [&] { return give(gp_add_material(host.sim, given, &id)); });
    } else if (what == 1) {
        static Struct<gp_column> column;
        column = {};
        ALWAYS(gp_column_init(&column.value(), sizeof(gp_column)) == GP_OK);
        gp_column &c = column.value();
        c.width = (1 + in.below(8)) * dl;
        c.height = (1 + in.below(8)) * dl;
        c.x_min = in.below(16) * dl;
        c.y_min = in.below(16) * dl;
        const gp_column *given = column.change(in, column_items);
        const double many = std::abs(c.width * c.height) / (dl * dl); // spacing may be another: see create
        if (many + static_cast<double>(host.particles) > most_particles && many < 1e13)
            return;
        unless_changed(host.sim, [&] {
            const gp_status status = give(gp_add_column(host.sim, given, &id));
            host.particles += status == GP_OK ? static_cast<int64_t>(many) + 1 : 0;
            return status;
        });
    } else if (what == 2) {
        double x[8], y[8], vx[8], vy[8];
        for (int k = 0; k < 8; ++k) {
            x[k] = in.number(k * dl);
            y[k] = in.number(12 * dl);
            vx[k] = in.number(0.1);
            vy[k] = in.number(-1);
        }
        const uint8_t kind = in.byte();
        const bool none = kind % 16 == 15;
        const int64_t n = none ? in.integer(4) : kind % 9;
        unless_changed(host.sim, [&] {
            return give(gp_add_particles(host.sim, in.below(3) - 1, n, none ? nullptr : x, y, kind & 16 ? vx : nullptr,
                                         kind & 32 ? vy : nullptr, &id));
        });
        host.particles += 8;
    } else {
        static Struct<gp_plate> plate;
        plate = {};
        ALWAYS(gp_plate_init(&plate.value(), sizeof(gp_plate)) == GP_OK);
        gp_plate &p = plate.value();
        const uint8_t kind = in.byte();
        p.x0 = kind & 1 ? 0.3 : 0;
        p.x1 = kind & 1 ? -0.1 : 0;
        p.y1 = kind & 1 ? 0 : 0.2;
        double t[4], x[4], y[4], angle[4], line_x[7], line_y[7];
        if (kind & 8) { // a line: valleys, rings, or whatever the input makes of them
            const bool closed = (kind & 16) != 0;
            p.x0 = p.y0 = p.x1 = p.y1 = 0;
            p.n_points = kind & 32 ? in.integer(5) : closed ? 7 : 2 + in.below(6);
            for (int k = 0; k < 7; ++k) {
                const double turn = (kind & 64 ? -1.05 : 1.05) * (k % 6);
                line_x[k] = in.number(closed ? 0.05 + 0.12 * std::cos(turn) : 0.3 - 0.08 * k);
                line_y[k] = in.number(closed ? 0.05 + 0.12 * std::sin(turn) : k % 2 * 0.05);
            }
            p.point_x = p.n_points <= 7 ? line_x : nullptr;
            p.point_y = line_y;
        }
        if (kind & 2) {
            p.n_knots = kind & 4 ? in.integer(2) : in.below(5);
            for (int k = 0; k < 4; ++k) {
                t[k] = in.number(k * 1e-3);
                x[k] = in.number(0.001);
                y[k] = in.number(0.002 * k);
                angle[k] = in.number(0.01 * k);
            }
            p.knot_t = p.n_knots <= 4 ? t : nullptr;
            p.knot_x = x;
            p.knot_y = p.n_knots <= 4 ? y : nullptr;
            p.knot_angle = kind & 128 ? angle : nullptr;
        }
        const gp_plate *given = plate.change(in, plate_items);
        unless_changed(host.sim, [&] { return give(gp_add_plate(host.sim, given, &id)); });
    }
}

void read(Host &host, Bytes &in) {
    double values[300], out[300];
    for (int k = 0; k < 6; ++k)
        values[k] = in.number(dl * k);
    gp_load load{};
    load.struct_size = in.below(4) ? sizeof load : in.byte();
    gp_plan_entry entries[70];
    int64_t n = 0;
    gp_particles particles{};
    particles.struct_size = in.below(4) ? sizeof particles : in.byte();
    ALWAYS(checked(gp_get_clock(host.sim, &values[0], nullptr, &n)) == GP_OK);
    gp_state state{};
    state.struct_size = in.below(4) ? sizeof state : in.byte();
    checked(gp_get_state_parts(host.sim, in.byte() % (GP_STATE_ALL + 2), &state));
    checked(gp_get_surface(host.sim, in.below(7) - 1, values, out));
    checked(gp_get_interface(host.sim, in.below(4) - 1, in.below(4) - 1, in.below(6), values, out));
    checked(gp_get_plate_load(host.sim, in.below(5) - 1, &load));
    checked(gp_get_plan(host.sim, in.below(71), entries, &n));
    checked(gp_get_particles(host.sim, static_cast<uint32_t>(in.integer(GP_FIELD_ALL)), &particles));
    checked(gp_copy_field(host.sim, 1u << in.below(18), out, std::min<int64_t>(300, in.integer(0))));
}

void output(Host &host, Bytes &in) {
    const uint8_t kind = in.byte();
    static Struct<gp_output> options;
    options = {};
    ALWAYS(gp_output_init(&options.value(), sizeof(gp_output)) == GP_OK);
    const std::string path = own_file(kind & 1 ? "run.h5" : "other.h5");
    if (kind < 100) {
        const gp_output *given = options.change(in, output_items);
        unless_changed(host.sim, [&] {
            return gp_output_open(host.sim, kind == 99 ? nullptr : kind == 98 ? "/" : path.c_str(), given);
        });
    } else if (kind < 180)
        unless_changed(host.sim, [&] { return gp_output_write(host.sim); });
    else
        unless_changed(host.sim, [&] { return gp_output_close(host.sim); });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, std::size_t size) {
    Bytes in(data, std::min<std::size_t>(size, 1024));
    Host hosts[2];
    int steps_left = most_steps, saves_left = 2;
    while (!in.empty()) {
        const uint8_t choice = in.byte();
        Host &host = hosts[choice >> 7];
        if (!host.sim && choice % 16 != 15) {
            create(host, in);
            continue;
        }
        host.steps_left = steps_left;
        switch (choice % 16) {
        case 0: add(host, in, 0); break;
        case 1:
        case 2: add(host, in, 1); break;
        case 3: add(host, in, 2); break;
        case 4:
        case 5: add(host, in, 3); break;
        case 6:
        case 7:
        case 8: step(host, in); break;
        case 9: read(host, in); break;
        case 10: output(host, in); break;
        case 11:
            if (saves_left-- > 0)
                save_and_load(host);
            break;
        case 12:
            unless_changed(host.sim, [&] {
                const int32_t plate = in.below(5) - 1;
                const double x = in.number(0.1), y = in.number(0.3);
                if (plate == 3)
                    return gp_set_gravity(host.sim, 30 * x, -30 * y);
                return in.below(2) ? gp_set_plate_velocity(host.sim, plate, x, y)
                                   : gp_set_plate_motion(host.sim, plate, x, y, in.number(4));
            });
            break;
        case 13: checked(gp_set_callback(host.sim, in.integer(1), callback, &host)); break;
        case 14:
            gp_destroy(host.sim);
            host = {};
            break;
        default: // no simulation
            ALWAYS(checked(gp_step(nullptr, 1)) == GP_E_ARGUMENT);
            ALWAYS(checked(gp_get_state(nullptr, nullptr)) == GP_E_ARGUMENT);
            ALWAYS(checked(gp_create(nullptr, nullptr)) == GP_E_ARGUMENT);
            ALWAYS(checked(gp_save(nullptr, nullptr)) == GP_E_ARGUMENT);
            break;
        }
        if (host.sim)
            steps_left = host.steps_left;
    }
    for (Host &host : hosts)
        gp_destroy(host.sim);
    return 0;
}
