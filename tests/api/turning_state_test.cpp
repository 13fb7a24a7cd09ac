// Bits of scenes with plates that turn: checkpoints, threads, steps that are taken back.
#include "api_support.hpp"

using namespace api;

namespace {

constexpr int plates = 3;

// A drum that turns with material in it, a vane in it that the host turns, a belt under a layer beside it.
struct Turning {
    explicit Turning(int32_t threads = 1, double radius = 0.2, double time_step = 0, int32_t halvings = 0)
        : sim([&] {
              gp_config config = make_config();
              config.threads = threads;
              config.time_step = time_step;
              config.allow_unstable_step = time_step > 0;
              config.retry_halvings = halvings;
              config.jitter = 0.05;
              return config;
          }()) {
        std::vector<double> x, y;
        const int count = 24;
        for (int k = 0; k <= count; ++k) {
            const double angle = -2 * std::acos(-1.0) * (k % count) / count;
            x.push_back(radius * std::cos(angle));
            y.push_back(radius * std::sin(angle));
        }
        gp_plate drum = make_plate(0, 0, 0, 0);
        drum.n_points = count + 1;
        drum.point_x = x.data();
        drum.point_y = y.data();
        drum.omega = 3;
        sim.add(drum);
        gp_plate vane = make_plate(-0.5 * radius, 0, -0.5 * radius, -0.7 * radius);
        vane.pivot_x = -0.5 * radius;
        sim.add(vane);
        gp_plate belt = make_plate(4 * radius, 0, 2 * radius, 0);
        belt.surface_velocity = -0.5;
        sim.add(belt);
        std::vector<double> px, py;
        const double inside = radius * std::cos(std::acos(-1.0) / count) - spacing;
        for (double at_y = -radius; at_y < -0.2 * radius; at_y += spacing)
            for (double at_x = -radius; at_x < radius; at_x += spacing)
                if (std::hypot(at_x, at_y) < inside && std::abs(at_x + 0.5 * radius) > spacing) {
                    px.push_back(at_x);
                    py.push_back(at_y);
                }
        sim.add(px, py);
        sim.add(make_column(15, 6, 2.2 * radius, 0));
    }
    // Steps with the host's doing.
    static gp_status go(Sim &sim, int64_t from, int64_t to) {
        gp_status status = GP_OK;
        for (int64_t step = from; step < to && status == GP_OK; ++step) {
            if (step == 5)
                status = gp_set_plate_motion(sim, 1, 0.05, 0, -2);
            if (step == 70)
                status = gp_set_plate_motion(sim, 1, 0, 0, 1);
            if (status == GP_OK)
                status = gp_step(sim, 1);
        }
        return status;
    }
    Sim sim;
};

} // namespace

TEST(TurningState, OfAnyNumberOfThreadsHasTheSameBits) {
    if (!has("openmp"))
        GTEST_SKIP() << "no OpenMP in this build";
    std::vector<uint64_t> one;
    for (const int32_t threads : {1, 2, 3, 4}) {
        Turning turning(threads, 0.45); // particles enough to share out
        EXPECT_GT(turning.sim.count(), 1500);
        ASSERT_EQ(Turning::go(turning.sim, 0, 80), GP_OK) << gp_last_error();
        const std::vector<uint64_t> bits = snapshot(turning.sim, plates);
        if (threads == 1)
            one = bits;
        else
            EXPECT_TRUE(bits == one) << threads << " threads differ from one";
    }
}

#ifdef GP_TEST_HDF5
TEST(TurningState, GoesOnFromACheckpoint) {
    const std::string path = testing::TempDir() + "granperi_turning.gpc";
    Turning whole;
    ASSERT_EQ(Turning::go(whole.sim, 0, 300), GP_OK) << gp_last_error();
    const std::vector<uint64_t> expected = snapshot(whole.sim, plates);
    for (const int64_t at : {0, 3, 40, 170}) { // before the host takes over, and between
        SCOPED_TRACE(at);
        Turning turning;
        ASSERT_EQ(Turning::go(turning.sim, 0, at), GP_OK);
        ASSERT_EQ(gp_save(turning.sim, path.c_str()), GP_OK) << gp_last_error();
        Sim loaded;
        gp_destroy(loaded.handle);
        ASSERT_EQ(gp_load(path.c_str(), &loaded.handle), GP_OK) << gp_last_error();
        EXPECT_TRUE(snapshot(loaded, plates) == snapshot(turning.sim, plates));
        ASSERT_EQ(Turning::go(loaded, at, 300), GP_OK);
        EXPECT_TRUE(snapshot(loaded, plates) == expected);
    }
    std::remove(path.c_str());
}
#endif

namespace {

// But for volume_drift, and for the number density, whose sums go by the cells: after a step undone these are new ones.
std::vector<uint64_t> shown(const Sim &sim) {
    std::vector<uint64_t> bits;
    add_fields(bits, sim, GP_FIELD_ALL & ~GP_FIELD_NUMBER_DENSITY);
    add_state(bits, but_for_lists(sim.state()));
    add_loads(bits, sim, plates);
    return bits;
}

} // namespace

// A step that diverges leaves what was before it, the angles and loads of plates included.
TEST(TurningState, IsThatOfTheLastGoodStep) {
    const double limit = Turning().sim.state().dt_limit;
    for (const double factor : {3.5, 4.5}) {
        SCOPED_TRACE(factor);
        Turning turning(1, 0.2, factor * limit);
        gp_status status = GP_OK;
        std::vector<uint64_t> before;
        int64_t step = 0;
        for (; step < 500 && status == GP_OK; ++step) {
            before = shown(turning.sim);
            status = Turning::go(turning.sim, step, step + 1);
        }
        ASSERT_EQ(status, GP_E_DIVERGED) << gp_last_error();
        EXPECT_GT(step, 1);
        EXPECT_TRUE(shown(turning.sim) == before);
        EXPECT_EQ(gp_step(turning.sim, 1), GP_E_STATE);
    }
}

TEST(TurningState, GoesOnWithAShorterStep) {
    const double limit = Turning().sim.state().dt_limit;
    Turning turning(1, 0.2, 4.5 * limit, 8);
    ASSERT_EQ(Turning::go(turning.sim, 0, 120), GP_OK) << gp_last_error();
    const gp_state state = turning.sim.state();
    EXPECT_GT(state.retries, 0);
    EXPECT_NEAR(turning.sim.load(0).angle, 3 * state.time, 1e-12 * 3 * state.time);
}
