// Whatever scene is drawn (drawn_scene.hpp) is refused with a text before the first step, or runs to an end that physics
// allows. GRANPERI_SCENES and GRANPERI_SEED (the first number) make longer runs, or repeat one scene.
#include <cstdio>
#include <cstdlib>

#include "drawn_scene.hpp"
#include "extreme_support.hpp"

using namespace test;

namespace {

double nearest_pair(Sim &sim) {
    const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
    double nearest = HUGE_VAL;
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            nearest = std::min(nearest, std::hypot(x[i] - x[j], y[i] - y[j]));
    return nearest;
}

// The largest speed that the scene can reach, as the library has it: it takes ten times that for its own sound speed.
double reachable_speed(Drawn scene) {
    scene.config.sound_speed = 0;
    Built built = build(scene);
    return built.status == GP_OK ? 0.1 * built.sim.state().sound_speed : 0;
}

enum Kind { elastic, implicit, paper, paper_local, kinds };

Kind kind_of(const gp_config &c) {
    return c.preset == GP_PRESET_PAPER         ? paper
           : c.preset == GP_PRESET_PAPER_LOCAL ? paper_local
           : c.stress == GP_STRESS_IMPLICIT    ? implicit
                                               : elastic;
}

struct Tally {
    int64_t scenes = 0, refused = 0, refused_at_step = 0, ran = 0;
    int64_t of_kind[kinds] = {}, diverged[kinds] = {};
    int64_t unconverged = 0; // of the diverged implicit ones: the solve
    int64_t energies = 0;    // scenes whose energy was checked
    double worst_energy = -1, worst_error = 0, worst_momentum = 0;
};

uint64_t number_from(const char *name, uint64_t otherwise) {
    const char *text = std::getenv(name);
    return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

void check_scene(uint64_t seed, Tally &tally) {
    const Drawn scene = draw(seed);
    SCOPED_TRACE(description(seed, scene));
    ++tally.scenes;
    auto [built, sim] = build(scene);
    if (built != GP_OK) {
        ++tally.refused;
        EXPECT_TRUE(built == GP_E_ARGUMENT || built == GP_E_UNSUPPORTED) << built;
        EXPECT_STRNE(gp_last_error(), "");
        return;
    }
    const gp_state start = sim.state();
    const double nearest = nearest_pair(sim) / scene.config.spacing;
    const Kind kind = kind_of(scene.config);
    const bool adjoint = kind == elastic || kind == implicit;
    ++tally.of_kind[kind];
    double scale = start.kinetic + start.elastic, speed = start.max_speed;
    double gx = scene.config.gravity_x, gy = scene.config.gravity_y, fallen_x = 0, fallen_y = 0; // m/s
    for (int64_t step = 0; step < scene.steps; ++step) {
        if (seed % 3 == 0 && step == scene.steps / 2) { // of some the gravity turns on the way
            gx = 0.8 * scene.config.gravity_x - 0.6 * scene.config.gravity_y;
            gy = 0.6 * scene.config.gravity_x + 0.8 * scene.config.gravity_y;
            ASSERT_EQ(gp_set_gravity(sim, gx, gy), GP_OK) << gp_last_error();
        }
        const gp_status status = gp_step(sim, 1);
        if (status == GP_E_ARGUMENT && step == 0) {
            ++tally.refused_at_step;
            EXPECT_STRNE(gp_last_error(), "");
            return;
        }
        if (status == GP_E_DIVERGED) {
            const std::string error = gp_last_error();
            ++tally.diverged[kind];
            if (kind == implicit && error.rfind("viscous_solve", 0) == 0) {
                ++tally.unconverged;
                std::printf("no convergence: %llu, step %lld: %s\n", static_cast<unsigned long long>(seed),
                            static_cast<long long>(step), error.c_str());
                return;
            }
            // The schemes of the paper have no bounds. The library's own diverge only in a scene that is faster than the
            // sound speed demanded for it: compression by half and more, which the equation of state is not made for.
            const double mach = adjoint ? reachable_speed(scene) / start.sound_speed : 0;
            EXPECT_TRUE(!adjoint || (scene.config.sound_speed > 0 && mach > 1))
                << "step " << step << ", Mach " << mach << ": " << error;
            return;
        }
        ASSERT_EQ(status, GP_OK) << "step " << step << ": " << gp_last_error();
        const gp_state s = sim.state();
        fallen_x += gx * s.dt;
        fallen_y += gy * s.dt;
        scale = std::max(scale, s.kinetic + s.elastic);
        speed = std::max(speed, s.max_speed);
        if (step % 10 == 9 || step + 1 == scene.steps) {
            SCOPED_TRACE("step " + std::to_string(step));
            ASSERT_NO_FATAL_FAILURE(expect_finite(sim));
        }
    }
    ++tally.ran;
    const gp_state end = sim.state();
    EXPECT_EQ(end.n_particles, start.n_particles);
    if (!adjoint || end.n_particles == 0)
        return;

    double mass = 0;
    {
        const std::vector<double> column = sim.field(GP_FIELD_COLUMN);
        std::vector<double> density;
        gp_material beads;
        gp_material_init(&beads, sizeof beads);
        const auto add = [&](int32_t m) {
            const gp_material &of = m == 0 ? beads : scene.materials[static_cast<std::size_t>(m) - 1];
            density.push_back(of.grain_density * of.volume_fraction);
        };
        for (const gp_column &c : scene.columns)
            add(c.material);
        for (const DrawnSet &set : scene.sets)
            add(set.material);
        for (const double id : column)
            mass += density[static_cast<std::size_t>(id)] * scene.config.spacing * scene.config.spacing;
    }
    if (scene.plates.empty() && scene.config.channel_width == 0) {
        // Internal forces and collisions cancel to rounding: that of the largest momentum, and of elastic forces.
        const double unit = mass * (speed + 1e-2 * end.sound_speed);
        const double mx = end.momentum_x - start.momentum_x - mass * fallen_x;
        const double my = end.momentum_y - start.momentum_y - mass * fallen_y;
        tally.worst_momentum = std::max(tally.worst_momentum, std::hypot(mx, my) / unit);
        EXPECT_LT(std::hypot(mx, my), 1e-11 * unit);
    }
    // In the largest kinetic and elastic energy and the weight times a spacing: what one step's rounding of the path costs.
    // Particles on top of each other are closer than the time step allows for, and speeds beyond the demanded sound speed
    // are not the scheme's: there the energy may be wrong, but nothing diverges.
    scale += mass * std::hypot(scene.config.gravity_x, scene.config.gravity_y) * scene.config.spacing +
             std::abs(end.plate_work);
    // Random plates that move cut through material and through each other: those two on one line with different velocities
    // have given errors of half the plates' work.
    const bool moving = std::any_of(scene.plates.begin(), scene.plates.end(), [](const DrawnPlate &d) {
        return d.plate.vx != 0 || d.plate.vy != 0 || !d.t.empty() || d.plate.normal_pressure > 0 ||
               d.plate.omega != 0 || d.plate.surface_velocity != 0;
    });
    if (nearest < 0.6 || speed > 0.3 * end.sound_speed || scale == 0 || moving)
        return;
    ++tally.energies;
    const double total = end.kinetic + end.potential + end.elastic;
    const double grown = (total - (start.kinetic + start.potential + start.elastic) + end.plate_work) / scale;
    tally.worst_energy = std::max(tally.worst_energy, grown);
    tally.worst_error = std::max(tally.worst_error, std::abs(end.energy_error) / scale);
    EXPECT_LT(grown, 0.05);
    EXPECT_LT(std::abs(end.energy_error) / scale, 0.3);
}

void print(const char *what, const Tally &t) {
    const auto number = [](int64_t n) { return static_cast<long long>(n); };
    std::printf("%s: %lld scenes, %lld refused, %lld refused at the first step, %lld ran\n", what, number(t.scenes),
                number(t.refused), number(t.refused_at_step), number(t.ran));
    const char *names[kinds] = {"default", "implicit", "paper", "local"};
    for (int k = 0; k < kinds; ++k)
        std::printf("  %s: %lld of %lld diverged\n", names[k], number(t.diverged[k]), number(t.of_kind[k]));
    std::printf("  %lld solves without convergence; worst momentum %.1e; of %lld energies: grown %.1e, error %.1e\n",
                number(t.unconverged), t.worst_momentum, number(t.energies), t.worst_energy, t.worst_error);
}

} // namespace

TEST(RandomScenes, AreRefusedOrRun) {
    const uint64_t first = number_from("GRANPERI_SEED", 1), count = number_from("GRANPERI_SCENES", 2000);
    Tally tally;
    for (uint64_t seed = first; seed < first + count && !HasFatalFailure(); ++seed)
        check_scene(seed, tally);
    print("random scenes", tally);
    if (count >= 1000) { // what is drawn is not refused for the most part
        EXPECT_GT(tally.ran, tally.scenes / 2);
        EXPECT_GT(tally.refused, 0);
        EXPECT_GT(tally.energies, tally.scenes / 40);
        EXPECT_LE(tally.diverged[elastic], tally.of_kind[elastic] / 100);
    }
}

// A few steps, before rounding has grown: bounces of single particles on edges of zero pressure multiply it.
TEST(RandomScenes, MirroredAreMirrored) {
    const uint64_t first = number_from("GRANPERI_SEED", 1), count = number_from("GRANPERI_SCENES", 2000) / 2;
    int64_t compared = 0;
    for (uint64_t seed = first; seed < first + count; ++seed) {
        Drawn scene = draw(seed);
        if (!(scene.config.spacing > 0 && scene.config.spacing < 1e9))
            continue;
        scene.config.jitter =
            0; // which has no mirror image; nor has a lattice that begins at the first point of a line
        scene.plates.erase(std::remove_if(scene.plates.begin(), scene.plates.end(),
                                          [](const DrawnPlate &drawn) { return !drawn.line_x.empty(); }),
                           scene.plates.end());
        make_plates_whole(scene);
        SCOPED_TRACE(description(seed, scene));
        auto [left_status, left] = build(scene);
        auto [right_status, right] = build(mirrored(scene));
        if (left_status != GP_OK || right_status != GP_OK)
            continue;
        if (nearest_pair(left) < 0.3 * scene.config.spacing)
            continue; // of particles on top of each other rounding decides
        const gp_status a = gp_step(left, 5), b = gp_step(right, 5);
        EXPECT_EQ(a, b);
        if (a != GP_OK || left.state().n_particles == 0)
            continue;
        ++compared;
        // Columns are filled from the left: order the particles by what they are.
        const std::vector<double> y = left.field(GP_FIELD_Y), other_y = right.field(GP_FIELD_Y);
        const gp_state l = left.state(), r = right.state();
        // An implicit solve ends somewhere within its tolerance of 1e-5 of the forces: rounding decides where.
        const bool implicit = scene.config.stress == GP_STRESS_IMPLICIT;
        const double share = implicit ? 1e-4 : 1e-7;
        EXPECT_NEAR(l.kinetic, r.kinetic, share * (l.kinetic + l.elastic));
        EXPECT_NEAR(l.elastic, r.elastic, share * (l.kinetic + l.elastic));
        EXPECT_NEAR(mean(y), mean(other_y), (implicit ? 1e-6 : 1e-9) * scene.config.spacing);
    }
    if (count >= 100) {
        EXPECT_GT(compared, static_cast<int64_t>(count) / 8);
    }
    std::printf("mirrored: %lld compared\n", static_cast<long long>(compared));
}

// Work is shared from 16 blocks of 64 particles on.
TEST(RandomScenes, HaveTheSameBitsForAnyNumberOfThreads) {
    if (!gp_has_feature("openmp"))
        GTEST_SKIP() << "no OpenMP in this build";
    const uint64_t first = number_from("GRANPERI_SEED", 1);
    int compared = 0;
    for (uint64_t seed = first; compared < 6 && seed < first + 1000; ++seed) {
        Drawn scene = draw(seed);
        if (scene.columns.empty() || scene.config.periodic_x_max > scene.config.periodic_x_min)
            continue;
        scene.columns[0].width = scene.columns[0].height = 36 * scene.config.spacing;
        SCOPED_TRACE(description(seed, scene));
        auto [status_of_one, one] = build(scene);
        if (status_of_one != GP_OK)
            continue;
        scene.config.threads = 2;
        auto [status_of_two, two] = build(scene);
        ASSERT_EQ(status_of_two, GP_OK);
        const gp_status status = gp_step(one, 10);
        EXPECT_EQ(gp_step(two, 10), status);
        if (status != GP_OK)
            continue;
        ++compared;
        for (const uint32_t bit : all_fields())
            EXPECT_EQ(one.field(bit), two.field(bit)) << bit;
        EXPECT_EQ(one.state().dissipated, two.state().dissipated);
    }
    EXPECT_EQ(compared, 6);
}
