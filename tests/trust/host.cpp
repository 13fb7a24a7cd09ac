// A host program for the tests of restarts, kills and equal bits: makes a scene or loads a checkpoint, steps, saves, writes
// an output, and prints lines of step, time, and a hash of all that the simulation shows. The scenes are in host_scenes.cpp.
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
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "host_scenes.hpp"

namespace {

struct Options : SceneOptions {
    std::string load, save, save_in_callback, save_every, output;
    int64_t save_at = -1, callback_save_at = -1, every_steps = 0, to_step = 0;
    double to_time = -1, output_seconds = 0;
    bool append = false, callback = false, log = false, awake = false, until_killed = false, expect_diverged = false;
};

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
