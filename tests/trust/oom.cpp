// Out of memory at every allocation of small scenes: each call with its n-th allocation failing, n = 0, 1, ..., alone; and
// each fifth with all that follow; until it needs no more. What fails is operator new, with which the library allocates; HDF5 has malloc: see below. Checked is
// that the call says GP_E_MEMORY with a text, that files and simulation are as they were, that the same call succeeds when
// there is memory, that in the end all bits are those of a run with memory, and that nothing is left allocated.
//
//   trust_oom DIRECTORY           prints a table of calls and how many of their allocations failed
//   trust_oom DIRECTORY --hdf5    every malloc fails in turn, those of HDF5 too, each in a process of its own; prints what
//                                 became of the call and of the simulation. A report: HDF5 itself does not always survive
#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <new>
#include <string>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "granperi/gp.h"

// --------------------------------------------------------------------------------------------- memory that runs out

namespace {

bool armed = false, lasting = false, fired = false;
long left = 0, failures = 0, live = 0; // live: blocks
long live_new = 0;

bool inside_new = false, everywhere = false; // which allocations fail: those of operator new, or all

bool fails() {
    if (!armed || !(everywhere || inside_new))
        return false;
    if (fired ? !lasting : left-- > 0)
        return false;
    fired = true;
    ++failures;
    errno = ENOMEM;
    return true;
}

void *counted(void *memory) {
    live += memory != nullptr;
    return memory;
}

} // namespace

extern "C" {
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
void __libc_free(void *);

void *malloc(size_t size) {
    return fails() ? nullptr : counted(__libc_malloc(size));
}
void *calloc(size_t n, size_t size) {
    return fails() ? nullptr : counted(__libc_calloc(n, size));
}
void *realloc(void *memory, size_t size) {
    if (fails())
        return nullptr;
    void *const moved = __libc_realloc(memory, size);
    live += (moved != nullptr) - (memory != nullptr && (moved != nullptr || size == 0));
    return moved;
}
void *aligned_alloc(size_t alignment, size_t size) {
    return fails() ? nullptr : counted(__libc_memalign(alignment, size));
}
void *memalign(size_t alignment, size_t size) {
    return aligned_alloc(alignment, size);
}
int posix_memalign(void **memory, size_t alignment, size_t size) {
    void *const found = aligned_alloc(alignment, size);
    if (!found)
        return ENOMEM;
    *memory = found;
    return 0;
}
void free(void *memory) {
    live -= memory != nullptr;
    __libc_free(memory);
}
}

// Of C++ alone, so that a leak of the library can be told from one of HDF5.
#define REPLACED [[gnu::noinline]]
namespace {
void *allocate(std::size_t size, std::size_t alignment) {
    inside_new = true;
    void *const memory =
        alignment > alignof(std::max_align_t) ? aligned_alloc(alignment, size) : malloc(size ? size : 1);
    inside_new = false;
    if (!memory)
        throw std::bad_alloc();
    ++live_new;
    return memory;
}
void release(void *memory) {
    live_new -= memory != nullptr;
    free(memory);
}
} // namespace
// clang-format off
REPLACED void *operator new(std::size_t size) { return allocate(size, 1); }
REPLACED void *operator new(std::size_t size, std::align_val_t a) { return allocate(size, static_cast<std::size_t>(a)); }
REPLACED void operator delete(void *memory) noexcept { release(memory); }
REPLACED void operator delete(void *memory, std::size_t) noexcept { release(memory); }
REPLACED void operator delete(void *memory, std::align_val_t) noexcept { release(memory); }
REPLACED void operator delete(void *memory, std::size_t, std::align_val_t) noexcept { release(memory); }
// clang-format on

namespace {

// ------------------------------------------------------------------------------------------------------- checks

[[noreturn, gnu::format(printf, 1, 2)]] void fail(const char *format, ...) {
    armed = false;
    std::va_list arguments;
    va_start(arguments, format);
    std::vfprintf(stderr, format, arguments);
    va_end(arguments);
    std::fprintf(stderr, "\n");
    std::exit(1);
}

void check(gp_status status, const char *call) {
    if (status < 0)
        fail("%s: %s: %s", call, gp_status_string(status), gp_last_error());
}
#define CHECK(call) check(call, #call)

struct Count {
    long failed = 0, absorbed = 0; // absorbed: the call did without
};
std::map<std::string, Count> counts;

// Runs call with the n-th allocation failing, for each n, until none fails. after: of each failure. renew: after a
// success although an allocation failed, makes the call possible once more.
void sweep(const char *name, const std::function<gp_status()> &call, const std::function<void(gp_status)> &after,
           const std::function<void()> &renew) {
    for (const bool to_the_end : {false, true}) {
        for (long n = 0;; n += to_the_end ? 5 : 1) {
            if (n > 100000)
                fail("%s: too many allocations", name);
            fired = false;
            lasting = to_the_end;
            left = n;
            armed = true;
            const gp_status status = call();
            armed = false;
            if (!fired) {
                if (status < 0)
                    fail("%s: with memory: %s", name, gp_last_error());
                break;
            }
            Count &count = counts[name];
            ++count.failed;
            if (status >= 0) {
                ++count.absorbed;
                renew();
            } else if (status != GP_E_MEMORY || *gp_last_error() == '\0') {
                fail("%s: allocation %ld%s: status %d, %s", name, n, to_the_end ? " and all after it" : "", status,
                     gp_last_error());
            } else {
                after(status);
            }
        }
        if (!to_the_end)
            renew();
    }
}

// -------------------------------------------------------------------------------------------------------- scenes

constexpr double dl = 0.0025;
constexpr int steps = 8;
const char *const scenes[] = {"default", "implicit", "periodic", "channel", "retry", "paper", "paper_local"};

gp_config config_of(const std::string &scene) {
    gp_config c;
    CHECK(gp_config_init(&c, sizeof c,
                         scene == "paper"         ? GP_PRESET_PAPER
                         : scene == "paper_local" ? GP_PRESET_PAPER_LOCAL
                                                  : GP_PRESET_DEFAULT));
    c.threads = 1; // GNU OpenMP ends the process when it gets no memory for its threads
    c.jitter = 0.05;
    if (scene == "implicit") {
        c.stress = GP_STRESS_IMPLICIT;
        c.delta = 1e-2;
    } else if (scene == "periodic") {
        c.periodic_x_max = 10 * dl;
        c.gravity_x = 3;
    } else if (scene == "channel") {
        c.channel_width = 0.02;
        c.channel_friction = 0.3;
    } else if (scene == "retry") { // beyond the stable limit
        c.time_step = 2.5e-4;
        c.allow_unstable_step = 1;
        c.retry_halvings = 8;
    }
    return c;
}

gp_plate plate_of(double x0, double y0, double x1, double y1) {
    gp_plate p;
    CHECK(gp_plate_init(&p, sizeof p));
    p.x0 = x0;
    p.y0 = y0;
    p.x1 = x1;
    p.y1 = y1;
    return p;
}

// Everything that can be added to a scene, each piece as a call that can be repeated until it succeeds.
std::vector<std::pair<const char *, std::function<gp_status(gp_sim *)>>> pieces_of(const std::string &scene) {
    const double right = 10 * dl, top = 6 * dl;
    std::vector<std::pair<const char *, std::function<gp_status(gp_sim *)>>> pieces;
    const auto plate = [&](const gp_plate &p) {
        pieces.emplace_back("gp_add_plate", [p](gp_sim *sim) { return gp_add_plate(sim, &p, nullptr); });
    };
    pieces.emplace_back("gp_add_material", [](gp_sim *sim) {
        gp_material m;
        gp_material_init(&m, sizeof m);
        m.grain_density = 2800;
        return gp_add_material(sim, &m, nullptr);
    });
    gp_column c;
    CHECK(gp_column_init(&c, sizeof c));
    c.width = right;
    c.height = top + 0.3 * dl; // with a note for the log, but for the period
    c.vx = 0.5;
    pieces.emplace_back("gp_add_column", [c](gp_sim *sim) { return gp_add_column(sim, &c, nullptr); });
    if (scene == "periodic") {
        plate(plate_of(right, 0, 0, 0));
        gp_plate lid = plate_of(0, top, right, top);
        lid.normal_pressure = 300;
        plate(lid);
        return pieces;
    }
    plate(plate_of(1, 0, -1, 0));
    gp_plate gate = plate_of(right, top, right, 0);
    static const double t[] = {0, 0.001, 0.1}, x[] = {0, 0, 0.001}, y[] = {0, 0.0005, 0.2};
    gate.n_knots = 3;
    gate.knot_t = t;
    gate.knot_x = x;
    gate.knot_y = y;
    gate.friction = GP_WALL_COULOMB;
    gate.wall_mu = 0.2;
    plate(gate);
    pieces.emplace_back("gp_add_particles", [=](gp_sim *sim) {
        const double px[] = {3 * dl, 4.2 * dl, 5.5 * dl}, py[] = {top + dl, top + 1.2 * dl, top + 1.1 * dl};
        const double v[] = {0, 0, 0}, vy[] = {-1, -2, -1};
        return gp_add_particles(sim, 1, 3, px, py, v, vy, nullptr);
    });
    return pieces;
}

void log_line(void *user, int32_t, const char *) {
    ++*static_cast<long *>(user);
}
long log_lines = 0;

gp_sim *make(const std::string &scene) {
    gp_sim *sim;
    const gp_config config = config_of(scene);
    CHECK(gp_create(&config, &sim));
    CHECK(gp_set_log(sim, log_line, &log_lines));
    for (const auto &[name, add] : pieces_of(scene))
        CHECK(add(sim));
    return sim;
}

gp_state state_of(gp_sim *sim) {
    gp_state s{};
    s.struct_size = sizeof s;
    CHECK(gp_get_state(sim, &s));
    s.wall_seconds = 0;
    return s;
}

// All that can be read, as bytes.
std::string bits_of(gp_sim *sim) {
    std::string bits;
    const auto add = [&](const void *data, std::size_t size) { bits.append(static_cast<const char *>(data), size); };
    gp_particles p{};
    p.struct_size = sizeof p;
    CHECK(gp_get_particles(sim, GP_FIELD_ALL, &p));
    const auto n = static_cast<std::size_t>(p.count);
    add(p.id, n * sizeof *p.id);
    add(p.column, n * sizeof *p.column);
    for (const double *field : {p.x, p.y, p.vx, p.vy, p.pressure, p.density, p.sxx, p.sxy, p.syy, p.shear_rate,
                                p.inertial_number, p.viscosity, p.number_density})
        add(field, n * sizeof *field);
    const gp_state s = state_of(sim);
    add(&s, sizeof s);
    for (int32_t k = 0; k < 2; ++k) {
        gp_load load{};
        load.struct_size = sizeof load;
        CHECK(gp_get_plate_load(sim, k, &load));
        add(&load, sizeof load);
    }
    return bits;
}

void require_same(const std::string &found, const std::string &expected, const char *what) {
    if (found != expected)
        fail("%s: other bits", what);
}

std::size_t files_in(const std::string &directory) {
    const std::filesystem::directory_iterator first(directory);
    return static_cast<std::size_t>(std::distance(begin(first), end(first)));
}

// Both counters of live blocks, after the end of what is looked at.
struct Leak {
    Leak() {
        H5close();
        before = live;
        before_new = live_new;
        before_open = files_in("/proc/self/fd");
    }
    void require_none(const char *what) const {
        if (live_new != before_new)
            fail("%s: %ld blocks of operator new are left", what, live_new - before_new);
        if (files_in("/proc/self/fd") != before_open)
            fail("%s: files are left open", what);
        H5close();
        if (live != before)
            fail("%s: %ld blocks of malloc are left", what, live - before);
    }
    long before, before_new;
    std::size_t before_open;
};

// ---------------------------------------------------------------------------------------------------------- calls

void make_and_read(const std::string &scene) {
    const gp_config config = config_of(scene);
    gp_sim *sim = nullptr;
    const auto nothing = [](gp_status) {};
    const auto keep = [] {};
    sweep(
        "gp_create", [&] { return gp_create(&config, &sim); },
        [&](gp_status) {
            if (sim)
                fail("gp_create: a simulation beside an error");
        },
        [&] { gp_destroy(sim); });
    CHECK(gp_set_log(sim, log_line, &log_lines));
    gp_sim *calm = make(scene);
    for (const auto &[name, add] : pieces_of(scene)) {
        // A piece that is added must not be added again: once for each way to fail, on simulations of their own.
        for (const bool to_the_end : {false, true}) {
            gp_sim *copy = to_the_end ? sim : make(scene);
            lasting = to_the_end;
            for (long n = 0;; ++n) {
                fired = false;
                left = n;
                armed = true;
                const gp_status status = add(copy);
                armed = false;
                if (!fired) {
                    CHECK(status);
                    break;
                }
                ++counts[name].failed;
                if (status != GP_E_MEMORY)
                    fail("%s: allocation %ld: status %d, %s", name, n, status, gp_last_error());
            }
            if (!to_the_end)
                gp_destroy(copy);
        }
    }
    gp_state state{};
    state.struct_size = sizeof state;
    gp_particles particles{};
    particles.struct_size = sizeof particles;
    gp_plan_entry entries[64];
    int64_t n;
    std::vector<double> values(static_cast<std::size_t>(state_of(calm).n_particles));
    const double station = 3 * dl;
    double out;
    sweep(
        "gp_get_state", [&] { return gp_get_state(sim, &state); }, nothing, keep);
    sweep(
        "gp_get_particles", [&] { return gp_get_particles(sim, GP_FIELD_ALL, &particles); }, nothing, keep);
    for (uint32_t bit = 1; bit & GP_FIELD_ALL; bit <<= 1)
        sweep(
            "gp_copy_field",
            [&] { return gp_copy_field(sim, bit, values.data(), static_cast<int64_t>(values.size())); }, nothing, keep);
    sweep(
        "gp_get_surface", [&] { return gp_get_surface(sim, 1, &station, &out); }, nothing, keep);
    if (scene != "periodic")
        sweep(
            "gp_get_interface", [&] { return gp_get_interface(sim, 0, 1, 1, &station, &out); }, nothing, keep);
    sweep(
        "gp_get_plan", [&] { return gp_get_plan(sim, 64, entries, &n); }, nothing, keep);
    require_same(bits_of(sim), bits_of(calm), "a scene made with failures");
    CHECK(gp_step(sim, steps));
    CHECK(gp_step(calm, steps));
    require_same(bits_of(sim), bits_of(calm), "steps after failures");
    gp_destroy(sim);
    gp_destroy(calm);
}

// After each failure the simulation can be read and goes on to the same bits.
void step(const std::string &scene) {
    gp_sim *calm = make(scene);
    CHECK(gp_step(calm, steps));
    const std::string expected = bits_of(calm);
    gp_destroy(calm);
    gp_sim *sim = make(scene);
    const auto renew = [&] {
        gp_destroy(sim);
        sim = make(scene);
    };
    sweep(
        "gp_step", [&] { return gp_step(sim, steps); },
        [&](gp_status) {
            bits_of(sim);
            const gp_status again = gp_step(sim, steps - state_of(sim).step);
            check(again, "gp_step after GP_E_MEMORY");
            require_same(bits_of(sim), expected, "gp_step, after a failure");
            renew();
        },
        renew);
    gp_destroy(sim);
}

std::string read(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void save_and_load(const std::string &scene, const std::string &directory) {
    const std::string path = directory + "/state.gp", old = directory + "/old.gp";
    gp_sim *sim = make(scene);
    CHECK(gp_save(sim, path.c_str()));
    CHECK(gp_step(sim, steps));
    CHECK(gp_save(sim, old.c_str()));
    const std::string before = read(path), expected_file = read(old), expected = bits_of(sim);
    const std::size_t files = files_in(directory);
    sweep(
        "gp_save", [&] { return gp_save(sim, path.c_str()); },
        [&](gp_status) {
            if (read(path) != before || files_in(directory) != files)
                fail("gp_save: a failed call left something");
        },
        [&] {
            if (read(path) != expected_file)
                fail("gp_save: another checkpoint");
            std::ofstream(path, std::ios::binary) << before;
        });
    if (read(path) != expected_file)
        fail("gp_save: another checkpoint");
    require_same(bits_of(sim), expected, "gp_save changed the simulation");
    gp_sim *loaded = nullptr;
    sweep(
        "gp_load", [&] { return gp_load(path.c_str(), &loaded); },
        [&](gp_status) {
            if (loaded)
                fail("gp_load: a simulation beside an error");
        },
        [&] {
            require_same(bits_of(loaded), expected, "gp_load");
            gp_destroy(loaded);
        });
    require_same(bits_of(loaded), expected, "gp_load");
    CHECK(gp_step(sim, steps));
    CHECK(gp_step(loaded, steps));
    require_same(bits_of(loaded), bits_of(sim), "steps after gp_load");
    gp_destroy(loaded);
    gp_destroy(sim);
}

void output(const std::string &directory) {
    const std::string path = directory + "/run.h5", saved = directory + "/output.gp";
    gp_output options;
    CHECK(gp_output_init(&options, sizeof options));
    options.every_seconds = 1e-5;
    options.fields = GP_FIELD_VELOCITY | GP_FIELD_PRESSURE;
    options.compression = 1;
    gp_sim *calm = make("default");
    CHECK(gp_step(calm, 6));
    const std::string expected = bits_of(calm);
    gp_destroy(calm);

    gp_sim *sim = make("default");
    const auto nothing = [](gp_status) {};
    const auto close = [&] { CHECK(gp_output_close(sim)); };
    sweep(
        "gp_output_open", [&] { return gp_output_open(sim, path.c_str(), &options); }, nothing, close);
    CHECK(gp_step(sim, 2));
    sweep(
        "gp_output_write", [&] { return gp_output_write(sim); }, nothing, [] {});
    close();
    const auto open = [&] {
        CHECK(gp_output_open(sim, path.c_str(), &options));
        CHECK(gp_output_write(sim));
    };
    open();
    sweep(
        "gp_output_close", [&] { return gp_output_close(sim); }, [&](gp_status) { open(); }, open);

    // A step whose frame is lost is complete.
    const auto renew = [&] {
        gp_destroy(sim);
        sim = make("default");
        CHECK(gp_output_open(sim, path.c_str(), &options));
        CHECK(gp_step(sim, 4));
    };
    renew();
    sweep(
        "gp_step with output", [&] { return gp_step(sim, 2); },
        [&](gp_status) {
            CHECK(gp_step(sim, 6 - state_of(sim).step));
            require_same(bits_of(sim), expected, "gp_step with output, after a failure");
            renew();
        },
        renew);
    CHECK(gp_save(sim, saved.c_str()));
    close();
    gp_destroy(sim);
    CHECK(gp_load(saved.c_str(), &sim));
    options.append = 1;
    const std::string before = read(path);
    sweep(
        "gp_output_open, append", [&] { return gp_output_open(sim, path.c_str(), &options); },
        [&](gp_status) {
            if (read(path) != before)
                fail("gp_output_open, append: a failed call changed the file");
        },
        close);
    gp_destroy(sim);
}

// What the process keeps from the first use of each call on is there before anything is counted.
void use_once(const std::string &directory) {
    const std::string path = directory + "/once.gp", frames = directory + "/once.h5";
    for (const char *name : {"gp_create", "gp_add_material", "gp_add_column", "gp_add_particles", "gp_add_plate",
                             "gp_get_state", "gp_get_particles", "gp_copy_field", "gp_get_surface", "gp_get_interface",
                             "gp_get_plan", "gp_step", "gp_save", "gp_load", "gp_output_open", "gp_output_write",
                             "gp_output_close", "gp_step with output", "gp_output_open, append"})
        counts[name] = {};
    gp_sim *sim = make("default"), *loaded;
    CHECK(gp_output_open(sim, frames.c_str(), nullptr));
    CHECK(gp_output_write(sim));
    CHECK(gp_save(sim, path.c_str()));
    CHECK(gp_load(path.c_str(), &loaded));
    gp_destroy(loaded);
    gp_destroy(sim);
    std::filesystem::remove(path);
}

// In a child process: the n-th malloc of a call fails. What the child found, for its exit code.
enum Outcome { done, absorbed, memory, io, other, spoilt, crashed };
const char *const outcome_names[] = {"",
                                     "succeeded without",
                                     "GP_E_MEMORY",
                                     "GP_E_IO",
                                     "another status",
                                     "but the simulation was not whole after it",
                                     "and the process ended"};

Outcome try_one(gp_sim *sim, const std::string &expected, long n, const std::function<gp_status()> &call) {
    fired = false;
    everywhere = true;
    left = n;
    armed = true;
    const gp_status status = call();
    armed = everywhere = false;
    if (!fired)
        return done;
    const gp_status again = gp_step(sim, steps);
    if (again < 0 || bits_of(sim) != expected)
        return spoilt;
    return status >= 0 ? absorbed : status == GP_E_MEMORY ? memory : status == GP_E_IO ? io : other;
}

void report_hdf5(const std::string &directory) {
    const std::string path = directory + "/state.gp", frames = directory + "/run.h5";
    gp_sim *sim = make("default"), *loaded;
    CHECK(gp_step(sim, steps));
    CHECK(gp_save(sim, path.c_str()));
    CHECK(gp_load(path.c_str(), &loaded));
    CHECK(gp_step(loaded, steps));
    const std::string expected = bits_of(loaded);
    gp_destroy(loaded);
    gp_output manual;
    CHECK(gp_output_init(&manual, sizeof manual));
    const std::pair<const char *, std::function<gp_status()>> calls[] = {
        {"gp_save", [&] { return gp_save(sim, path.c_str()); }},
        {"gp_load", [&] { return gp_load(path.c_str(), &loaded); }},
        {"gp_output_open", [&] { return gp_output_open(sim, frames.c_str(), &manual); }},
        {"gp_output_write", [&] { return gp_output_write(sim); }},
        {"gp_output_close", [&] { return gp_output_close(sim); }}};
    for (const auto &[name, call] : calls) {
        if (std::strcmp(name, "gp_output_write") == 0)
            CHECK(gp_output_open(sim, frames.c_str(), &manual));
        long found[crashed + 1] = {};
        for (long n = 0; found[done] == 0; ++n) {
            std::fflush(stdout);
            const pid_t child = ::fork();
            if (child == 0)
                ::_exit(try_one(sim, expected, n, call)); // nothing of HDF5's own end
            int status = 0;
            ::waitpid(child, &status, 0);
            ++found[WIFEXITED(status) && WEXITSTATUS(status) < crashed ? WEXITSTATUS(status) : crashed];
        }
        std::printf("%s:", name);
        for (int k = absorbed; k <= crashed; ++k)
            if (found[k] > 0)
                std::printf(" %ld %s;", found[k], outcome_names[k]);
        std::printf("\n");
    }
    gp_destroy(sim);
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 2)
        return 2;
    const std::string directory = std::string(argv[1]) + "/trust_oom";
    std::filesystem::remove_all(directory);
    std::filesystem::create_directories(directory);
    if (argc > 2) {
        report_hdf5(directory);
        return 0;
    }
    use_once(directory);
    for (const char *const scene : scenes) {
        const Leak leak;
        make_and_read(scene);
        step(scene);
        leak.require_none(scene);
    }
    {
        const Leak leak;
        save_and_load("default", directory);
        leak.require_none("gp_save and gp_load");
    }
    const Leak leak;
    output(directory);
    leak.require_none("gp_output");
    std::filesystem::remove_all(directory);
    long failed = 0;
    for (const auto &[name, count] : counts) {
        std::printf("%-24s %6ld failed, %ld of them done without\n", name.c_str(), count.failed, count.absorbed);
        failed += count.failed;
    }
    std::printf("%ld calls out of memory, %ld allocations failed, nothing lost, nothing left\n", failed, failures);
    return 0;
}
