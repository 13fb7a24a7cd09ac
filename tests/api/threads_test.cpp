// Simulations in several threads at once, and the same bits for any number of threads in one.
#include <thread>

#include "api_support.hpp"

using namespace api;

namespace {

// Particles enough for the work to be shared out among four threads; materials, jitter and a gate in motion,
// so that much goes on.
std::vector<uint64_t> collapse(int32_t threads, int steps, uint64_t seed = 3) {
    gp_config config = make_config();
    config.threads = threads;
    config.jitter = 0.05;
    config.seed = seed;
    config.density_diffusion = 0.05;
    Sim sim(config);
    add_collapse(sim, 54, 44);
    gp_material material = make_material();
    material.grain_density = 3500;
    gp_column column = make_column(12, 12, 5 * spacing, 45 * spacing);
    column.material = sim.add(material);
    column.vx = 1;
    sim.add(column);
    EXPECT_GT(sim.count(), 2400);
    EXPECT_EQ(gp_step(sim, steps), GP_OK) << gp_last_error();
    return snapshot(sim, 3);
}

} // namespace

TEST(Threads, AnyNumberGivesTheSameBits) {
    if (!has("openmp"))
        GTEST_SKIP() << "no OpenMP in this build";
    const std::vector<uint64_t> one = collapse(1, 200);
    for (const int32_t threads : {2, 4})
        EXPECT_TRUE(collapse(threads, 200) == one) << threads << " threads differ from one";
}

TEST(Threads, TheSameRunTwiceGivesTheSameBits) {
    EXPECT_TRUE(collapse(1, 30) == collapse(1, 30));
    EXPECT_FALSE(collapse(1, 30) == collapse(1, 30, 4)) << "and another seed gives others";
}

TEST(Threads, TwoSimulationsAtOnce) {
    const int32_t each = has("openmp") ? 2 : 1;
    const std::vector<uint64_t> expected[2] = {collapse(each, 40, 1), collapse(each, 40, 2)};
    std::vector<uint64_t> found[2];
    std::thread other([&] { found[0] = collapse(each, 40, 1); });
    found[1] = collapse(each, 40, 2);
    other.join();
    for (int k = 0; k < 2; ++k)
        EXPECT_TRUE(found[k] == expected[k]) << k;
}

// One simulation belongs to one thread at a time, but not for ever to the same.
TEST(Threads, ASimulationMayMoveToAnotherThread) {
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        add_collapse(sim, 6, 6);
        for (int part = 0; part < 3; ++part) {
            const auto go_on = [&] { EXPECT_EQ(gp_step(sim, 10), GP_OK); };
            if (k == 1)
                std::thread(go_on).join();
            else
                go_on();
        }
        bits[k] = snapshot(sim, 3);
    }
    EXPECT_EQ(bits[0], bits[1]);
}

#ifdef GP_TEST_HDF5
// HDF5 itself is not made for two threads at once: the library sees to it.
TEST(Threads, TwoOutputsAtOnce) {
    const auto run = [](int which) {
        const std::string path = testing::TempDir() + "granperi_threads_" + std::to_string(which) + ".h5";
        for (int again = 0; again < 3; ++again) {
            Sim sim;
            add_collapse(sim, 5, 5);
            gp_output output = make_output();
            output.every_seconds = 1e-4;
            EXPECT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
            EXPECT_EQ(gp_step(sim, 20), GP_OK) << gp_last_error();
            EXPECT_EQ(gp_output_close(sim), GP_OK) << gp_last_error();
        }
    };
    std::thread other(run, 0);
    run(1);
    other.join();
}
#endif

TEST(Threads, EachHasItsOwnLastError) {
    const auto fail = [](const char *name, int *wrong) {
        for (int k = 0; k < 500; ++k) {
            gp_config config = make_config();
            (std::string(name) == "cfl" ? config.cfl : config.delta) = -1;
            gp_sim *sim;
            gp_create(&config, &sim);
            *wrong += !last_error_has(name);
        }
    };
    int wrong[2] = {0, 0};
    std::thread other(fail, "cfl", &wrong[0]);
    fail("delta", &wrong[1]);
    other.join();
    EXPECT_EQ(wrong[0], 0);
    EXPECT_EQ(wrong[1], 0);
}
