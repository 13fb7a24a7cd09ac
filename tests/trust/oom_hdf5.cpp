// A report: every malloc of a call fails in turn, those of HDF5 too, each in a process of its own, since HDF5 itself does not
// always survive. Prints what became of the call and of the simulation.
#include <cstdio>
#include <cstring>

#include <sys/wait.h>
#include <unistd.h>

#include "oom_scenes.hpp"

namespace test {

using namespace memory;

namespace {

// What the child found, for its exit code.
enum Outcome { done, absorbed, no_memory, io, other, spoilt, crashed };
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
    return status >= 0 ? absorbed : status == GP_E_MEMORY ? no_memory : status == GP_E_IO ? io : other;
}

} // namespace

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

} // namespace test
