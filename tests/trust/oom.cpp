// Out of memory at every allocation of small scenes: each call with its n-th allocation failing, n = 0, 1, ..., alone; and
// each fifth with all that follow; until it needs no more. What fails is operator new, with which the library allocates;
// HDF5 has malloc: see oom_hdf5.cpp. Checked is that the call says GP_E_MEMORY with a text, that files and simulation are as
// they were, that the same call succeeds when there is memory, that in the end all bits are those of a run with memory, and
// that nothing is left allocated.
//
//   trust_oom DIRECTORY           prints a table of calls and how many of their allocations failed
//   trust_oom DIRECTORY --hdf5    the report of oom_hdf5.cpp
#include <hdf5.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "../support/bytes.hpp"
#include "oom_scenes.hpp"

using namespace test;
using namespace test::memory;

namespace {

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
    count_lines_of_log(sim);
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

// As it is, perhaps with its particles put back into the order of before the step that failed.
void require_savable(gp_sim *sim, const std::string &path) {
    gp_sim *loaded;
    CHECK(gp_save(sim, path.c_str()));
    CHECK(gp_load(path.c_str(), &loaded));
    require_same(bits_of(loaded), bits_of(sim), "gp_load of what was saved after a failure");
    gp_destroy(loaded);
    std::filesystem::remove(path);
}

// After each failure the simulation can be read, and each sixteenth time saved, and goes on to the same bits.
void step(const std::string &scene, const std::string &directory) {
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
            if (counts["gp_step"].failed % 16 == 0)
                require_savable(sim, directory + "/failed.gp");
            const gp_status again = gp_step(sim, steps - state_of(sim).step);
            check(again, "gp_step after GP_E_MEMORY");
            require_same(bits_of(sim), expected, "gp_step, after a failure");
            renew();
        },
        renew);
    gp_destroy(sim);
}

void save_and_load(const std::string &scene, const std::string &directory) {
    const std::string path = directory + "/state.gp", old = directory + "/old.gp";
    gp_sim *sim = make(scene);
    CHECK(gp_save(sim, path.c_str()));
    CHECK(gp_step(sim, steps));
    CHECK(gp_save(sim, old.c_str()));
    const std::string before = bytes_of(path), expected_file = bytes_of(old), expected = bits_of(sim);
    const std::size_t files = files_in(directory);
    sweep(
        "gp_save", [&] { return gp_save(sim, path.c_str()); },
        [&](gp_status) {
            if (bytes_of(path) != before || files_in(directory) != files)
                fail("gp_save: a failed call left something");
        },
        [&] {
            if (bytes_of(path) != expected_file)
                fail("gp_save: another checkpoint");
            std::ofstream(path, std::ios::binary) << before;
        });
    if (bytes_of(path) != expected_file)
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
    const std::string before = bytes_of(path);
    sweep(
        "gp_output_open, append", [&] { return gp_output_open(sim, path.c_str(), &options); },
        [&](gp_status) {
            if (bytes_of(path) != before)
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
        step(scene, directory);
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
