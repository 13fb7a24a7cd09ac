// A host program for the tests of restarts, kills and equal bits: makes a scene or loads a checkpoint, steps, saves, writes
// an output, and prints one line per `--print`: step, time, and a hash of all that the simulation shows.
//
//   trust_host SCENE [--size N] [--threads N] [--spare-plate] [--spare-body] [--unused-material]
//              [--load FILE] [--save-at STEP FILE] [--save-in-callback STEP FILE] [--save-every STEPS FILE]
//              [--output FILE SECONDS] [--append] [--callback] [--log] [--awake]
//              [--to-step STEP] [--to-time SECONDS] [--until-killed] [--expect-diverged]
//
// One option --load replaces the making of the scene; SCENE then only says when the host drives which plate.
// Steps are counted from where the scene begins: steps_before().
#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include <unistd.h>

#include "granperi/gp.h"

namespace {

void check(gp_status status, const char *call) {
    if (status >= 0)
        return;
    std::fprintf(stderr, "%s: %s: %s\n", call, gp_status_string(status), gp_last_error());
    std::exit(1);
}
#define CHECK(call) check(call, #call)

struct Options {
    std::string scene, load, save, save_in_callback, save_every, output;
    int size = 1, threads = 1;
    int64_t save_at = -1, callback_save_at = -1, every_steps = 0, to_step = 0;
    double to_time = -1, output_seconds = 0;
    bool append = false, callback = false, log = false, awake = false, until_killed = false, expect_diverged = false;
    bool spare_plate = false, spare_body = false, unused_material = false;
};

constexpr double dl = 0.0025;

// What a scene has behind it where it begins: to fall asleep takes some 500 steps.
int64_t steps_before(const std::string &scene) {
    return scene == "sleep" ? 515 : 0;
}

void add_plate(gp_sim *sim, double x0, double y0, double x1, double y1, void (*set)(gp_plate &) = nullptr) {
    gp_plate p;
    CHECK(gp_plate_init(&p, sizeof p));
    p.x0 = x0;
    p.y0 = y0;
    p.x1 = x1;
    p.y1 = y1;
    if (set)
        set(p);
    CHECK(gp_add_plate(sim, &p, nullptr));
}

// Grains of two spacings, which flow as their neighbours do.
int32_t add_fluid(gp_sim *sim) {
    gp_material m;
    int32_t id;
    CHECK(gp_material_init(&m, sizeof m));
    m.grain_diameter = 2 * dl;
    m.nonlocal_amplitude = 0.48;
    CHECK(gp_add_material(sim, &m, &id));
    return id;
}

int32_t add_column(gp_sim *sim, double x, double y, int columns, int rows, double vx = 0, double vy = 0,
                   int32_t material = 0) {
    gp_column c;
    int32_t id;
    CHECK(gp_column_init(&c, sizeof c));
    c.x_min = x;
    c.y_min = y;
    c.width = columns * dl;
    c.height = rows * dl;
    c.vx = vx;
    c.vy = vy;
    c.material = material;
    CHECK(gp_add_column(sim, &c, &id));
    return id;
}

void add_line(gp_sim *sim, const std::vector<double> &x, const std::vector<double> &y, void (*set)(gp_plate &)) {
    gp_plate p;
    CHECK(gp_plate_init(&p, sizeof p));
    p.n_points = static_cast<int64_t>(x.size());
    p.point_x = x.data();
    p.point_y = y.data();
    set(p);
    CHECK(gp_add_plate(sim, &p, nullptr));
}

// Bodies that turn: a drum by a table of its angle, a vane by the host, a roll across the ends of the period; and hills, across
// them too, whose surface runs.
void add_turning(gp_sim *sim, int columns, int rows) {
    const double width = columns * dl, height = rows * dl, middle = 3 * width, top = 2 * height;
    static double knot_t[] = {0, 0.004, 0.02, 0.05}, knot_angle[] = {0, 0.01, 0.2, 0.4};
    add_line(sim,
             {middle - width, middle - width, middle - 0.5 * width, middle + 0.5 * width, middle + width,
              middle + width, middle - width},
             {0, top, 1.25 * top, 1.25 * top, top, 0, 0}, [](gp_plate &p) {
                 p.pivot_x = 0.5 * (p.point_x[0] + p.point_x[5]);
                 p.pivot_y = 0.5 * p.point_y[1];
                 p.n_knots = 4;
                 p.knot_t = knot_t;
                 p.knot_angle = knot_angle;
             });
    add_column(sim, middle - 0.5 * width, 0, columns, rows);
    add_plate(sim, middle - 0.5 * width - 2 * dl, dl, middle - 0.5 * width - 2 * dl, top - dl, [](gp_plate &p) {
        p.friction = GP_WALL_COULOMB;
        p.wall_mu = 0.2;
        p.pivot_x = p.x0;
        p.pivot_y = p.y1;
    });
    add_line(sim, {1.75 * width, 1.25 * width, 0.75 * width, 0.25 * width, -0.25 * width},
             {-height, -height - 4 * dl, -height, -height + 4 * dl, -height},
             [](gp_plate &p) { p.surface_velocity = -0.3; });
    add_column(sim, 0, -height + 5 * dl, columns, rows / 2);
    add_line(sim, {0.1 * width, 0, -0.1 * width, 0, 0.1 * width},
             {1.4 * height, 1.4 * height + 0.1 * width, 1.4 * height, 1.4 * height - 0.1 * width, 1.4 * height},
             [](gp_plate &p) {
                 p.pivot_y = p.point_y[0];
                 p.omega = -8;
             });
}

// Two beds in boxes, of which the thicker one falls asleep after the other, part by part. Plate 2 is a wall of the thin one.
void add_beds(gp_sim *sim, int columns) {
    const double width = columns * dl;
    double x = 0;
    add_plate(sim, 3 * width, 0, 0, 0);
    for (const int rows : {4, 12}) {
        add_plate(sim, x, 0, x, 0.04);
        add_plate(sim, x + width, 0.04, x + width, 0);
        add_column(sim, x, 0, columns, rows);
        x += 2 * width;
    }
}

gp_sim *make(const Options &o) {
    const std::string &scene = o.scene;
    const bool paper = scene == "paper" || scene == "regularized" || scene == "paper_driven";
    gp_config c;
    CHECK(gp_config_init(&c, sizeof c,
                         paper                    ? GP_PRESET_PAPER
                         : scene == "paper_local" ? GP_PRESET_PAPER_LOCAL
                                                  : GP_PRESET_DEFAULT));
    c.threads = o.threads;
    c.jitter = 0.05;
    c.seed = 7;
    const int columns = 16 * o.size, rows = 12 * o.size;
    const double width = columns * dl, height = rows * dl;
    if (scene == "implicit") {
        c.stress = GP_STRESS_IMPLICIT;
        c.delta = 1e-3;
    }
    if (scene == "regularized")
        c.friction_factor = 1;
    if (scene == "channel") {
        c.channel_width = 0.02;
        c.channel_friction = 0.3;
    }
    if (scene == "periodic" || scene == "fluid_periodic") {
        c.periodic_x_max = width;
        c.gravity_x = 5;
    }
    const bool retry = scene == "retry" || scene == "fluid_retry";
    if (retry || scene == "diverge" || scene == "diverge_periodic") { // far beyond the stable limit
        c.time_step = retry ? 2.5e-4 : scene == "diverge" ? 4e-4 : 4e-3;
        c.allow_unstable_step = 1;
        c.retry_halvings = retry ? 6 : 0;
    }
    if (scene == "diverge_periodic")
        c.periodic_x_max = width;
    if (scene == "turning")
        c.periodic_x_max = 6 * width;
    if (scene == "sleep") {
        c.sleep = 1;
        c.sound_speed = 4;
    }
    gp_sim *sim;
    CHECK(gp_create(&c, &sim));
    gp_material heavy;
    int32_t material = 0;
    CHECK(gp_material_init(&heavy, sizeof heavy));
    heavy.grain_density = 2900;
    heavy.mu_s = 0.5;
    heavy.mu_2 = 0.7;
    CHECK(gp_add_material(sim, &heavy, &material));
    if (o.unused_material)
        CHECK(gp_add_material(sim, &heavy, nullptr));

    const int32_t main_material = scene.rfind("fluid", 0) == 0 ? add_fluid(sim) : 0;
    if (scene ==
        "turning") { // a drum about a heap, a vane that the host turns, a hilly belt, across whose ends it lies
        add_turning(sim, columns, rows);
    } else if (scene == "sleep") {
        add_beds(sim, 3 * columns);
    } else if (scene == "periodic" || scene == "fluid_periodic" || scene == "diverge_periodic") {
        add_plate(sim, width, 0, 0, 0, [](gp_plate &p) { p.fluidity = GP_FLUIDITY_ZERO; });
        add_column(sim, 0, 0, columns, rows, 0.1, 0, main_material);
        add_plate(sim, 0, height, width, height, [](gp_plate &p) {
            p.normal_pressure = 300;
            p.vx = 0.2;
        });
    } else {
        add_plate(sim, 1, 0, -1, 0);
        add_column(sim, 0, 0, columns, rows, 0, 0, main_material);
        if (scene == "loaded") {
            add_plate(sim, 0, 0, 0, height + 0.02);
            add_plate(sim, width, height + 0.02, width, 0);
            add_plate(sim, 0, height, width, height, [](gp_plate &p) {
                p.normal_pressure = 500;
                p.mass_per_length = 4;
            });
        } else { // a wall, and a gate that is lifted by a table: or by the host, in "driven"
            add_plate(sim, 0, 0, 0, height + 0.02);
            static double knot_t[] = {0, 0.004, 0.02, 0.05}, knot_x[] = {0, 0, 0.001, 0.001},
                          knot_y[] = {0, 0.002, 0.04, 0.2};
            add_plate(sim, width, height + 0.02, width, 0, [](gp_plate &p) {
                p.friction = GP_WALL_COULOMB;
                p.wall_mu = 0.2;
                p.n_knots = 4;
                p.knot_t = knot_t;
                p.knot_x = knot_x;
                p.knot_y = knot_y;
            });
            std::vector<double> x, y, vx, vy; // a set of particles that fall on it
            for (int k = 0; k < 6; ++k) {
                x.push_back(0.01 + 1.1 * dl * k);
                y.push_back(height + 4 * dl + 0.3 * dl * k);
                vx.push_back(0.1);
                vy.push_back(-1);
            }
            CHECK(gp_add_particles(sim, material, 6, x.data(), y.data(), vx.data(), vy.data(), nullptr));
            add_column(sim, 0.004, height + 8 * dl, 5, 4, 0, -1.5, material);
        }
    }
    if (scene == "driven" || scene == "paper_driven") // before the first step, by a velocity in place of its table
        CHECK(gp_set_plate_velocity(sim, 2, 0.0, 0.1));
    if (scene == "gravity") // so, too, in place of the config's
        CHECK(gp_set_gravity(sim, 1, -9.7));
    if (o.spare_plate)
        add_plate(sim, 0, -50, 0, -51);
    if (o.spare_body)
        add_column(sim, 40, 0, 3, 3);
    return sim;
}

// What the host does before a step, whatever the process.
void drive(gp_sim *sim, const std::string &scene, int64_t step) {
    if (scene == "turning" && step % 30 == 7)
        CHECK(gp_set_plate_motion(sim, 1, 0.05, 0, step < 30 ? 2 : step < 60 ? -3 : 0.5));
    if (scene == "sleep" && step == 20) // it wakes what rests beside it, and that, later on, the rest
        CHECK(gp_set_plate_velocity(sim, 2, -0.06, 0));
    if (scene == "gravity") {
        if (step % 15 == 5) // it turns
            CHECK(gp_set_gravity(sim, 0.05 * static_cast<double>(step), -9.5));
        if (step == 70) // and ends
            CHECK(gp_set_gravity(sim, 0, 0));
    }
    if (scene != "driven" && scene != "paper_driven")
        return;
    if (step == 9)
        CHECK(gp_set_plate_velocity(sim, 2, 0.05, 0.8));
    if (step == 31)
        CHECK(gp_set_plate_velocity(sim, 2, 0, 0));
    if (step == 57)
        CHECK(gp_set_plate_velocity(sim, 2, 0.3, 2));
}

struct Hash {
    uint64_t value = 0xcbf29ce484222325u;
    void add(const void *data, std::size_t size) {
        const auto *bytes = static_cast<const unsigned char *>(data);
        for (std::size_t k = 0; k < size; ++k)
            value = (value ^ bytes[k]) * 0x100000001b3u;
    }
    template <class T> void add(const T &number) { add(&number, sizeof number); }
};

gp_state state_of(gp_sim *sim) {
    gp_state s{};
    s.struct_size = sizeof s;
    CHECK(gp_get_state(sim, &s));
    return s;
}

// All that can be read, the particles in the engine's own order. The first `count` by id count, and bodies' numbers.
uint64_t hash_of(gp_sim *sim, bool in_order_of_id, int64_t count) {
    Hash hash;
    gp_particles p{};
    p.struct_size = sizeof p;
    CHECK(gp_get_particles(sim, GP_FIELD_ALL, &p));
    if (in_order_of_id) {
        std::vector<double> values(static_cast<std::size_t>(p.count));
        for (uint32_t bit = 1; bit & GP_FIELD_ALL; bit <<= 1) {
            CHECK(gp_copy_field(sim, bit, values.data(), p.count));
            const auto is_zero = [](double value) { return value == 0; };
            if (bit == GP_FIELD_FLUIDITY && std::all_of(values.begin(), values.end(), is_zero))
                continue; // of no material here: the bits are those of versions without
            hash.add(values.data(), static_cast<std::size_t>(count) * sizeof(double));
        }
        return hash.value;
    }
    const auto n = static_cast<std::size_t>(p.count);
    hash.add(p.id, n * sizeof *p.id);
    hash.add(p.column, n * sizeof *p.column);
    for (const double *field : {p.x, p.y, p.vx, p.vy, p.pressure, p.density, p.sxx, p.sxy, p.syy, p.shear_rate,
                                p.inertial_number, p.viscosity, p.number_density, p.fluidity})
        hash.add(field, n * sizeof *field);
    gp_state s = state_of(sim);
    s.wall_seconds = 0;
    hash.add(s);
    gp_load load{};
    load.struct_size = sizeof load;
    for (int32_t k = 0; gp_get_plate_load(sim, k, &load) == GP_OK; ++k)
        hash.add(load);
    double stations[20], heights[20];
    for (int k = 0; k < 20; ++k)
        stations[k] = s.x_left + (s.x_right - s.x_left) * (k + 0.5) / 20;
    CHECK(gp_get_surface(sim, 20, stations, heights));
    hash.add(heights);
    return hash.value;
}

struct Host {
    Options options;
    int64_t seen = 0;
};

int32_t callback(void *user, gp_sim *sim) {
    Host &host = *static_cast<Host *>(user);
    const gp_state s = state_of(sim);
    host.seen += s.step;
    const Options &o = host.options;
    if (s.step == o.callback_save_at)
        CHECK(gp_save(sim, o.save_in_callback.c_str()));
    if (o.callback) // read a lot, change nothing
        host.seen += static_cast<int64_t>(hash_of(sim, false, 0) & 1);
    return 0;
}

void log_line(void *, int32_t level, const char *text) {
    std::printf("log %d %s\n", level, text);
}

Options parse(int argc, char **argv) {
    Options o;
    o.scene = argv[1];
    for (int k = 2; k < argc; ++k) {
        const std::string name = argv[k];
        const auto next = [&] {
            if (++k >= argc) {
                std::fprintf(stderr, "%s: a value is missing\n", name.c_str());
                std::exit(2);
            }
            return argv[k];
        };
        if (name == "--size")
            o.size = std::atoi(next());
        else if (name == "--threads")
            o.threads = std::atoi(next());
        else if (name == "--load")
            o.load = next();
        else if (name == "--save-at") {
            o.save_at = std::atoll(next());
            o.save = next();
        } else if (name == "--save-in-callback") {
            o.callback_save_at = std::atoll(next());
            o.save_in_callback = next();
        } else if (name == "--save-every") {
            o.every_steps = std::atoll(next());
            o.save_every = next();
        } else if (name == "--output") {
            o.output = next();
            o.output_seconds = std::atof(next());
        } else if (name == "--to-step")
            o.to_step = std::atoll(next());
        else if (name == "--to-time")
            o.to_time = std::atof(next());
        else if (name == "--append")
            o.append = true;
        else if (name == "--callback")
            o.callback = true;
        else if (name == "--log")
            o.log = true;
        else if (name == "--awake")
            o.awake = true;
        else if (name == "--until-killed")
            o.until_killed = true;
        else if (name == "--expect-diverged")
            o.expect_diverged = true;
        else if (name == "--spare-plate")
            o.spare_plate = true;
        else if (name == "--spare-body")
            o.spare_body = true;
        else if (name == "--unused-material")
            o.unused_material = true;
        else {
            std::fprintf(stderr, "%s: unknown option\n", name.c_str());
            std::exit(2);
        }
    }
    const int64_t before = steps_before(o.scene);
    o.to_step += before;
    o.save_at += o.save_at < 0 ? 0 : before;
    o.callback_save_at += o.callback_save_at < 0 ? 0 : before;
    return o;
}

void tell(gp_sim *sim, const char *what, const Options &o) {
    const gp_state s = state_of(sim);
    const int64_t own = s.n_particles - (o.spare_body ? 9 : 0);
    std::printf("%s %" PRId64 " %.17g %016" PRIx64 " particles %016" PRIx64 "\n", what, s.step, s.time,
                hash_of(sim, false, 0), hash_of(sim, true, own));
    std::fflush(stdout);
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 2)
        return 2;
    Host host;
    host.options = parse(argc, argv);
    const Options &o = host.options;
    gp_sim *sim;
    if (o.load.empty()) {
        sim = make(o);
        if (const int64_t before = steps_before(o.scene))
            CHECK(gp_step(sim, before));
    } else {
        CHECK(gp_load(o.load.c_str(), &sim));
    }
    tell(sim, o.load.empty() ? "made" : "loaded", o);
    if (o.log)
        CHECK(gp_set_log(sim, log_line, nullptr));
    if (o.callback || o.callback_save_at >= 0)
        CHECK(gp_set_callback(sim, 1, callback, &host));
    if (!o.output.empty()) {
        gp_output output;
        CHECK(gp_output_init(&output, sizeof output));
        output.every_seconds = o.output_seconds;
        output.append = o.append;
        CHECK(gp_output_open(sim, o.output.c_str(), &output));
    }
    if (o.to_time >= 0)
        CHECK(gp_run(sim, o.to_time));
    for (int64_t step = state_of(sim).step; o.until_killed || step < o.to_step; ++step) {
        if (step == o.save_at)
            CHECK(gp_save(sim, o.save.c_str()));
        drive(sim, o.scene, step - steps_before(o.scene));
        const gp_status status = gp_step(sim, 1);
        if ((status == GP_E_DIVERGED || status == GP_E_STATE) && o.expect_diverged) // now, or before it was loaded
            break;
        check(status, "gp_step");
        if (o.awake) {
            const gp_state s = state_of(sim);
            std::printf("awake %" PRId64 " asleep %" PRId64 "\n", s.n_awake, s.n_particles - s.n_awake);
        }
        if (o.every_steps > 0 && (step + 1) % o.every_steps == 0) {
            CHECK(gp_save(sim, o.save_every.c_str()));
            tell(sim, "saved", o);
        }
    }
    if (o.save_at >= 0 && (o.save_at >= o.to_step || o.expect_diverged))
        CHECK(gp_save(sim, o.save.c_str()));
    tell(sim, "end", o);
    gp_destroy(sim);
    return 0;
}
