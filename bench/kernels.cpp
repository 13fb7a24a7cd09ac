// The stages of a step on their own (google-benchmark), in the middle of a collapse and, where the way there would be long, in
// a column at rest. Reads the engine's headers; whole steps are what bench/step measures, through gp.h.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>
#include <ctime>
#include <map>
#include <memory>
#include <vector>

#include "plan.hpp"
#include "sim.hpp"
#include "stages/stages.hpp"
#include "undo.hpp"

namespace {

constexpr double width = 0.08, height = 0.05, in_flow = 0.05; // m, m, s
constexpr int largest_in_flow = 126;                          // particles over the width

// A column on a floor, at rest for its first steps or in flow; made once.
gp::World &world_of(int resolution) {
    static std::map<int, std::unique_ptr<gp::Sim>> sims;
    std::unique_ptr<gp::Sim> &sim = sims[resolution];
    if (!sim) {
        gp_config config = gp::default_config(GP_PRESET_DEFAULT);
        config.spacing = width / resolution;
        config.threads = 1;
        sim = std::make_unique<gp::Sim>(config);
        gp_column column = gp::default_column();
        column.width = width;
        column.height = height;
        sim->add_column(column);
        gp_plate floor = gp::default_plate();
        floor.x0 = 0.3; // from right to left: its body is on the left of the way
        floor.x1 = -0.2;
        sim->add_plate(floor);
        if (resolution <= largest_in_flow)
            sim->run(nullptr, in_flow);
        else
            sim->step(nullptr, 20);
    }
    return const_cast<gp::World &>(sim->world());
}

// Of one particle, within the horizon.
double neighbors_of(const gp::World &world) {
    const gp::Particles &p = world.particles;
    const double radius = world.constants.horizon;
    int64_t pairs = 0;
    for (int64_t c = 0; c < world.clusters.count(); ++c)
        for (int64_t i = world.clusters.first[c]; i < world.clusters.first[c + 1]; ++i)
            gp::for_each_seen(world.clusters, c, i,
                              [&](int32_t j) { pairs += std::hypot(p.x[j] - p.x[i], p.y[j] - p.y[i]) < radius; });
    return static_cast<double>(pairs) / static_cast<double>(p.count);
}

void count(benchmark::State &state, const gp::World &world) {
    const double particles = static_cast<double>(world.particles.count);
    state.counters["particles"] = particles;
    state.counters["neighbors"] = neighbors_of(world);
    // Seconds per particle, which are printed with their prefix.
    state.counters["s/particle"] =
        benchmark::Counter(particles, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Work between steps. It leaves the positions as they are, so that every call has the same pairs.
void run_alone(benchmark::State &state, void (*work)(gp::World &)) {
    gp::World &world = world_of(static_cast<int>(state.range(0)));
    for (auto _ : state)
        work(world);
    count(state, world);
}

double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// A stage in its step, which is taken back each time: what a stage reads lives from the one that makes it. Its own CPU
// time alone counts: the column Time.
void run_stage(benchmark::State &state, const char *name) {
    gp::World &world = world_of(static_cast<int>(state.range(0)));
    const std::vector<gp::PlannedStage> stages = gp::make_stages(gp::traits_of(*world.scene, world.constants));
    for (auto _ : state) {
        gp::begin_step(world);
        for (const gp::PlannedStage &stage : stages) {
            if (!stage.needed || (stage.now && !stage.now(world)))
                continue;
            const double before = cpu_seconds();
            stage.run(world);
            const double seconds = cpu_seconds() - before;
            if (!std::strcmp(stage.name, name)) {
                state.SetIterationTime(seconds);
                break;
            }
        }
        gp::undo_step(world);
    }
    count(state, world);
}

void at_sizes(benchmark::internal::Benchmark *benchmark) {
    benchmark->Arg(40)->Arg(largest_in_flow)->Arg(400)->Unit(benchmark::kMicrosecond);
}

#define GP_ALONE(work) BENCHMARK_CAPTURE(run_alone, work, gp::stages::work)->Apply(at_sizes)
#define GP_STAGE(stage) BENCHMARK_CAPTURE(run_stage, stage, #stage)->Apply(at_sizes)->UseManualTime()

GP_ALONE(make_lists);
GP_STAGE(flowing);
GP_STAGE(wall_velocity);
GP_STAGE(gradient);
GP_STAGE(density_diffusion);
GP_STAGE(density_of_spacing);
GP_STAGE(density);
GP_STAGE(stress);
GP_STAGE(wall_stress);
GP_STAGE(force);
GP_ALONE(collide);
GP_ALONE(measure_velocities);

} // namespace

BENCHMARK_MAIN();
