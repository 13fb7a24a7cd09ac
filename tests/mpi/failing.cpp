// One process runs out of memory in the middle of a call: all leave that call, with one status and one text, which names the
// process, and go on to another simulation. So it is with mistakes; and a simulation that is left when MPI ends does no harm.
//
//   mpirun -n N failing DIRECTORY RUNS   the same calls RUNS times over, with one allocation of one process failing at a time
//
// The allocation is another one each time, over all that a run makes, and so is the process. Waiting for ever is a failure.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <unistd.h>
#include <vector>

#include <granperi/gp_mpi.h>

#include "../trust/failing_memory.hpp"

using namespace test::memory;

namespace {

int rank, ranks;

[[noreturn]] void give_up(const char *what, const char *text) {
    std::fprintf(stderr, "rank %d: %s: %s\n", rank, what, text);
    MPI_Abort(MPI_COMM_WORLD, 1);
    std::abort();
}

// How a run has ended on this process.
struct End {
    int32_t call = 0, status = GP_OK;
    char text[1024] = "";
};

// All processes have to be told the same.
void require_same_end(const End &end) {
    std::vector<End> all(static_cast<std::size_t>(ranks));
    MPI_Allgather(&end, sizeof end, MPI_BYTE, all.data(), sizeof end, MPI_BYTE, MPI_COMM_WORLD);
    for (const End &other : all)
        if (other.call != end.call || other.status != end.status || std::strcmp(other.text, end.text) != 0) {
            char text[2200];
            std::snprintf(text, sizeof text, "call %d, status %d, '%s'; another has call %d, status %d, '%s'", end.call,
                          end.status, end.text, other.call, other.status, other.text);
            give_up("another end than elsewhere", text);
        }
}

// The calls of a run, until one fails.
class Run {
public:
    // talks: what its callback does first is to talk to the others.
    explicit Run(const std::string &directory, bool talks = false)
        : talks_(talks), frames_(directory + "/frames.h5"), saved_(directory + "/saved.h5"),
          first_(directory + "/first.h5") {}
    Run(const Run &) = delete;
    Run &operator=(const Run &) = delete;
    ~Run() { gp_destroy(sim_); }

    bool all() { return build() && read() && write() && go_on(); }
    const End &end() const { return end_; }
    gp_sim *sim() const { return sim_; }
    const std::vector<double> &places() const { return x_; }

private:
    bool call(gp_status status) {
        ++end_.call;
        end_.status = status;
        if (status < 0)
            std::snprintf(end_.text, sizeof end_.text, "%s", gp_last_error());
        return status >= 0;
    }
    bool build() {
        gp_config config;
        gp_column column;
        gp_plate plate;
        gp_material material;
        gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT);
        gp_column_init(&column, sizeof column);
        gp_plate_init(&plate, sizeof plate);
        gp_material_init(&material, sizeof material);
        config.spacing = 0.005, config.threads = 1;
        column.width = 0.08, column.height = 0.04, column.vx = 0.5;
        plate.x0 = 0.5, plate.x1 = -0.5;
        const double x[] = {0.12 + 0.01 * rank, 0.125 + 0.01 * rank}, y[] = {0.0025, 0.0025};
        return call(gp_create_mpi(&config, MPI_COMM_WORLD, &sim_)) && call(gp_add_material(sim_, &material, nullptr)) &&
               call(gp_add_column(sim_, &column, nullptr)) && call(gp_add_plate(sim_, &plate, nullptr)) &&
               call(gp_add_particles(sim_, 1, 2, x, y, nullptr, nullptr, nullptr)) &&
               call(gp_save(sim_, first_.c_str()));
    }
    bool read() {
        gp_state state{};
        state.struct_size = sizeof state;
        double at[3] = {0.01, 0.05, 0.07}, height[3];
        if (!call(gp_get_state(sim_, &state)))
            return false;
        armed_before_ = armed;
        armed = false;
        x_.assign(static_cast<std::size_t>(state.n_particles), 0.0);
        armed = armed_before_;
        const int64_t n = rank == 0 ? state.n_particles : 0;
        return call(gp_get_surface(sim_, 3, at, height)) && call(gp_copy_field(sim_, GP_FIELD_X, x_.data(), n)) &&
               call(gp_get_interface(sim_, 0, 1, 3, at, height));
    }
    bool write() {
        gp_output options;
        gp_output_init(&options, sizeof options);
        options.every_seconds = 1e-3;
        return call(gp_output_open(sim_, frames_.c_str(), &options)) &&
               call(gp_set_callback(sim_, 3, talks_ ? talk : look, nullptr)) && call(gp_step(sim_, 24)) &&
               call(gp_set_gravity(sim_, 1, -9)) && call(gp_step(sim_, 6)) && call(gp_output_write(sim_)) &&
               call(gp_save(sim_, saved_.c_str())) && call(gp_output_close(sim_));
    }
    bool go_on() {
        gp_destroy(sim_);
        sim_ = nullptr;
        if (!call(gp_load_mpi(saved_.c_str(), MPI_COMM_WORLD, &sim_)) || !call(gp_step(sim_, 6)) || !read())
            return false;
        gp_sim *other = nullptr;
        const bool loaded = call(gp_load_mpi(first_.c_str(), MPI_COMM_WORLD, &other));
        const bool stepped = loaded && call(gp_step(other, 1));
        gp_destroy(other);
        return stepped;
    }
    // What hosts do in theirs: they read, and talk to each other.
    static int32_t look(void *, gp_sim *sim) {
        gp_state state{};
        state.struct_size = sizeof state;
        int failed = gp_get_state(sim, &state) < 0;
        MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
        return failed;
    }

    static int32_t talk(void *, gp_sim *) {
        int stop = 0;
        MPI_Allreduce(MPI_IN_PLACE, &stop, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
        return stop;
    }

    bool talks_;
    std::string frames_, saved_, first_;
    gp_sim *sim_ = nullptr;
    End end_;
    std::vector<double> x_;
    bool armed_before_ = false;
};

// Allocations that a whole run makes here.
long count_allocations(const std::string &directory, std::vector<double> &places) {
    constexpr long enough = 1L << 40;
    Run run(directory);
    fired = false, left = enough, armed = true;
    const bool good = run.all();
    armed = false;
    if (!good)
        give_up("with memory", run.end().text);
    places = run.places();
    return enough - left;
}

gp_status end_of(gp_status status, End &end) {
    end.status = status;
    std::snprintf(end.text, sizeof end.text, "%s", status < 0 ? gp_last_error() : "");
    return status;
}

gp_column small_column() {
    gp_column column;
    gp_column_init(&column, sizeof column);
    column.width = 0.08, column.height = 0.04;
    return column;
}

// With the column and a floor, after some steps; without them, empty.
gp_sim *make_small(bool whole) {
    gp_config config;
    gp_plate plate;
    gp_sim *sim = nullptr;
    gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT);
    gp_plate_init(&plate, sizeof plate);
    config.spacing = 0.005, config.threads = 1;
    plate.x0 = 0.5, plate.x1 = -0.5;
    const gp_column column = small_column();
    if (gp_create_mpi(&config, MPI_COMM_WORLD, &sim) || gp_add_plate(sim, &plate, nullptr) ||
        (whole && (gp_add_column(sim, &column, nullptr) || gp_step(sim, 3))))
        give_up("a small simulation", gp_last_error());
    return sim;
}

// What all have done wrong leaves the simulation as it is; what one has done wrong is told to all, and named.
void make_mistakes() {
    gp_sim *sim = make_small(false);
    End end;
    if (end_of(gp_add_column(sim, nullptr, nullptr), end) != GP_E_ARGUMENT || std::strstr(end.text, "rank"))
        give_up("a mistake of all", end.text);
    require_same_end(end);
    const gp_column column = small_column();
    if (end_of(gp_add_column(sim, &column, nullptr), end) || end_of(gp_step(sim, 3), end))
        give_up("after a mistake of all", end.text);
    double value;
    const int64_t wrong = rank == ranks - 1 ? 1 : rank == 0 ? 128 : 0;
    std::vector<double> values(128);
    if (end_of(gp_copy_field(sim, GP_FIELD_X, rank == 0 ? values.data() : &value, wrong), end) != GP_E_ARGUMENT ||
        std::strncmp(end.text, "rank ", 5) != 0)
        give_up("a mistake of one", end.text);
    require_same_end(end);
    if (end_of(gp_set_plate_velocity(sim, 0, 1, 0), end) != GP_E_ARGUMENT)
        give_up("a plate is moved after the end", end.text);
    require_same_end(end);
    gp_destroy(sim);

    sim = make_small(false);
    int32_t id = 7;
    if (end_of(gp_add_column(sim, rank == 0 ? nullptr : &column, &id), end) != GP_E_ARGUMENT || id != 0)
        give_up("an id in spite of a mistake of one", end.text);
    gp_destroy(sim);
}

// Who has been told of a mistake of all goes on to the next one, and others may still be in the first: of those that the first
// process finds and tells, some hear before they throw it.
void make_mistakes_in_a_row(const std::string &directory) {
    gp_sim *sim = make_small(true);
    const std::string nowhere = directory + "/none/saved.h5";
    End end;
    for (int k = 0; k < 300; ++k) {
        if (end_of(gp_save(sim, nowhere.c_str()), end) != GP_E_IO)
            give_up("a file in no folder", end.text);
        for (int more = 0; more < 2; ++more)
            if (end_of(gp_add_column(sim, nullptr, nullptr), end) != GP_E_ARGUMENT)
                give_up("a mistake after another", end.text);
    }
    require_same_end(end);
    if (end_of(gp_step(sim, 1), end))
        give_up("after many mistakes", end.text);
    gp_destroy(sim);
}

double potential_of(gp_sim *sim, double &gravity) {
    gp_state state{};
    state.struct_size = sizeof state;
    if (gp_get_state(sim, &state))
        give_up("a state", gp_last_error());
    gravity = state.gravity_x;
    return state.potential;
}

// Where the first process lacks memory to measure energies, gravity is as it was, and may be set anew.
void change_gravity_without_memory() {
    double gravity;
    gp_sim *sim = make_small(true);
    gp_set_gravity(sim, 1, -9);
    const double expected = potential_of(sim, gravity);
    gp_destroy(sim);
    int gone_on = 0;
    for (int at = 0, done = 0; !done; ++at) {
        sim = make_small(true);
        left = at, fired = lasting = false, armed = rank == 0;
        End end;
        end_of(gp_set_gravity(sim, 1, -9), end);
        armed = false;
        require_same_end(end);
        done = end.status == GP_OK;
        if (!done && gp_step(sim, 0) == GP_OK) {
            ++gone_on;
            if (potential_of(sim, gravity), gravity != 0)
                give_up("gravity without memory", "it has changed");
            if (end_of(gp_set_gravity(sim, 1, -9), end) || potential_of(sim, gravity) != expected || gravity != 1)
                give_up("gravity after it had no memory", end.text);
        }
        gp_destroy(sim);
    }
    if (gone_on == 0)
        give_up("gravity without memory", "expected some to go on");
}

} // namespace

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (argc != 3)
        give_up("arguments", "expected DIRECTORY and RUNS");
    alarm(120);
    const std::string directory = argv[1];
    make_mistakes();
    make_mistakes_in_a_row(directory);
    change_gravity_without_memory();
    const long runs = std::atol(argv[2]);
    std::vector<double> expected, places;
    const long own = count_allocations(directory, expected);
    std::vector<long> allocations(static_cast<std::size_t>(ranks));
    MPI_Allgather(&own, 1, MPI_LONG, allocations.data(), 1, MPI_LONG, MPI_COMM_WORLD);
    long failed = 0;
    std::vector<long> calls;
    for (long k = 0; k < runs; ++k) {
        alarm(120);
        const int victim = static_cast<int>(k % ranks);
        Run run(directory, k / ranks / 2 % 2 == 1);
        lasting = k / ranks % 2 == 1;
        // Each run at its place between the first allocation and the last, closer together at first, where calls take few.
        const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(runs);
        left =
            static_cast<long>(std::pow(share, 3) * static_cast<double>(allocations[static_cast<std::size_t>(victim)]));
        const long at = left;
        fired = false;
        armed = rank == victim;
        run.all();
        armed = false;
        End end = run.end();
        require_same_end(end);
        char named[32];
        std::snprintf(named, sizeof named, "rank %d: ", victim);
        if (end.status < 0 && (end.status != GP_E_MEMORY || std::strncmp(end.text, named, std::strlen(named)) != 0 ||
                               std::strstr(end.text + 1, "rank ")))
            give_up("expected out of memory, named once", end.text);
        if (rank == 0 && std::getenv("GRANPERI_TELL"))
            std::printf("allocation %ld of rank %d: call %d: %s\n", at, victim, end.call, end.text);
        failed += end.status < 0;
        calls.push_back(end.call);
        if (run.sim()) { // what is left says the same of itself, or is whole
            end_of(gp_step(run.sim(), 1), end);
            require_same_end(end);
        }
    }
    std::sort(calls.begin(), calls.end());
    const auto kinds = std::unique(calls.begin(), calls.end()) - calls.begin();
    count_allocations(directory, places);
    if (places != expected)
        give_up("after all failures", "another simulation has other values");
    if (rank == 0)
        std::printf("%d processes, %ld allocations on the first: %ld of %ld runs failed, in %ld calls\n", ranks, own,
                    failed, runs, static_cast<long>(kinds));
    gp_sim *const forgotten = make_small(true);
    MPI_Finalize();
    gp_destroy(forgotten);
    return failed > 0 ? 0 : 1;
}
