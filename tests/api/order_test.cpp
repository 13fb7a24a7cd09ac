// Which call is possible when; callbacks and the log.
#include <functional>

#include "api_support.hpp"

using namespace api;

namespace {

// Lets a std::function be the callback; counts the calls.
struct Callback {
    std::function<int32_t(gp_sim *)> body = [](gp_sim *) { return 0; };
    int calls = 0;
    static int32_t run(void *user, gp_sim *sim) {
        auto *self = static_cast<Callback *>(user);
        ++self->calls;
        return self->body(sim);
    }
    gp_status set(gp_sim *sim, int64_t every = 1) { return gp_set_callback(sim, every, run, this); }
};

struct Log {
    std::vector<std::pair<int32_t, std::string>> lines;
    static void run(void *user, int32_t level, const char *text) {
        static_cast<Log *>(user)->lines.emplace_back(level, text);
    }
};

gp_state state_of(gp_sim *sim) {
    gp_state state{};
    state.struct_size = sizeof state;
    EXPECT_EQ(gp_get_state(sim, &state), GP_OK);
    return state;
}

void expect_scene_is_fixed(gp_sim *sim, const char *why) {
    const gp_material material = make_material();
    const gp_column column = make_column(2, 2, 1, 0);
    const gp_plate plate = make_floor();
    const double value = 3;
    int32_t id = 8;
    EXPECT_FAILS(gp_add_material(sim, &material, &id), GP_E_STATE, why);
    EXPECT_EQ(id, 0);
    EXPECT_FAILS(gp_add_column(sim, &column, nullptr), GP_E_STATE, why);
    EXPECT_FAILS(gp_add_particles(sim, 0, 1, &value, &value, nullptr, nullptr, nullptr), GP_E_STATE, why);
    EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_STATE, why);
}

} // namespace

// --------------------------------------------------------------------------------------------------- order

TEST(Order, TheSceneIsFixedAfterTheFirstStep) {
    Sim sim;
    sim.add(make_floor());
    sim.add(make_column(3, 3));
    sim.state(); // reading does not fix it
    sim.plan();
    sim.view(GP_FIELD_ALL);
    sim.add(make_column(3, 3, 1, 0));
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    expect_scene_is_fixed(sim, "step");
    EXPECT_EQ(sim.count(), 18);
    EXPECT_EQ(gp_set_plate_velocity(sim, 0, 0, 0), GP_OK);
    EXPECT_EQ(gp_step(sim, 1), GP_OK);
}

TEST(Order, TheSceneIsFixedWhileAnOutputIsOpen) {
    if (!has("hdf5"))
        GTEST_SKIP() << "no HDF5 in this build";
    Sim sim;
    sim.add(make_floor());
    sim.add(make_column(3, 3));
    const std::string path = testing::TempDir() + "granperi_order.h5";
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
    expect_scene_is_fixed(sim, "output");
    EXPECT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    sim.add(make_column(3, 3, 1, 0));
    EXPECT_EQ(sim.count(), 18);
    // What is set now is no more the scene's.
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
    EXPECT_EQ(gp_set_plate_velocity(sim, 0, 0.1, 0), GP_OK);
    EXPECT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    expect_scene_is_fixed(sim, "gravity set while an output was open");
}

TEST(Order, AnOutputIsClosedAndSavedBesideAfterGravityWasSet) {
    if (!has("hdf5"))
        GTEST_SKIP() << "no HDF5 in this build";
    for (const bool saves : {false, true}) {
        Sim sim;
        sim.add(make_floor());
        sim.add(make_column(3, 3));
        ASSERT_EQ(gp_output_open(sim, (testing::TempDir() + "granperi_changed.h5").c_str(), nullptr), GP_OK)
            << gp_last_error();
        EXPECT_EQ(gp_set_gravity(sim, 1, -9), GP_OK);
        if (saves) {
            EXPECT_EQ(gp_save(sim, (testing::TempDir() + "granperi_changed.gp").c_str()), GP_OK) << gp_last_error();
            EXPECT_EQ(gp_set_plate_velocity(sim, 0, 0.1, 0), GP_OK);
        }
        ASSERT_EQ(gp_output_close(sim), GP_OK) << gp_last_error();
        EXPECT_EQ(gp_step(sim, 1), GP_OK);
    }
}

// ----------------------------------------------------------------------------------------------- callbacks

TEST(Callbacks, MayReadDriveAndWriteButNothingElse) {
    gp_config config = make_config();
    config.cfl = 0.8; // its own would go with the speed of the gate
    Sim sim(config);
    add_collapse(sim, 4, 4);
    sim.add(make_column(2, 2, 1, 0));
    const bool hdf5 = has("hdf5");
    if (hdf5) {
        ASSERT_EQ(gp_output_open(sim, (testing::TempDir() + "granperi_callback.h5").c_str(), nullptr), GP_OK);
    }
    Callback callback;
    callback.body = [&](gp_sim *s) {
        EXPECT_EQ(s, sim.handle);
        const gp_material material = make_material();
        const gp_column column = make_column(2, 2, 2, 0);
        const gp_plate plate = make_floor();
        const double value = 3;
        // Also where the arguments ask for nothing, or are wrong besides.
        EXPECT_FAILS(gp_step(s, 1), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_step(s, 0), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_run(s, 10), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_run(s, state_of(s).time), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_add_material(s, &material, nullptr), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_add_column(s, &column, nullptr), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_add_particles(s, 0, 1, &value, &value, nullptr, nullptr, nullptr), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_add_plate(s, &plate, nullptr), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_set_callback(s, 1, nullptr, nullptr), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_set_log(s, nullptr, nullptr), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_output_open(s, "x", nullptr), GP_E_STATE, "callback");
        EXPECT_FAILS(gp_output_close(s), GP_E_STATE, "callback");
        gp_destroy(s);

        gp_particles particles{};
        particles.struct_size = sizeof particles;
        EXPECT_EQ(gp_get_particles(s, GP_FIELD_ALL, &particles), GP_OK);
        EXPECT_EQ(particles.count, 20);
        std::vector<double> x(20);
        EXPECT_EQ(gp_copy_field(s, GP_FIELD_X, x.data(), 20), GP_OK);
        EXPECT_EQ(state_of(s).step, callback.calls);
        EXPECT_EQ(gp_get_surface(s, 1, x.data(), x.data()), GP_OK);
        EXPECT_EQ(gp_get_interface(s, 0, 1, 1, x.data(), x.data()), GP_OK);
        gp_load load{};
        load.struct_size = sizeof load;
        EXPECT_EQ(gp_get_plate_load(s, 0, &load), GP_OK);
        int64_t n;
        EXPECT_EQ(gp_get_plan(s, 0, nullptr, &n), GP_OK);
        EXPECT_EQ(gp_set_plate_velocity(s, 2, 0, 3), GP_OK);
        if (hdf5) {
            EXPECT_EQ(gp_output_write(s), GP_OK) << gp_last_error();
        } else {
            EXPECT_EQ(gp_output_write(s), GP_E_STATE);
        }
        return 0;
    };
    ASSERT_EQ(callback.set(sim), GP_OK);
    EXPECT_EQ(gp_step(sim, 3), GP_OK) << gp_last_error();
    EXPECT_EQ(callback.calls, 3);
    EXPECT_EQ(sim.state().step, 3);
    // The gate moved at 1 m/s in the first step and at 3 m/s from then on.
    const double dt = sim.state().dt;
    EXPECT_NEAR(sim.load(2).dy, dt + 2 * 3 * dt, 1e-9);
    ASSERT_EQ(gp_set_callback(sim, 1, nullptr, nullptr), GP_OK) << "outside all is as before";
}

TEST(Callbacks, ThatOnlyReadDoNotChangeTheRun) {
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        add_collapse(sim, 6, 6);
        Callback callback;
        callback.body = [](gp_sim *s) {
            gp_particles particles{};
            particles.struct_size = sizeof particles;
            EXPECT_EQ(gp_get_particles(s, GP_FIELD_ALL, &particles), GP_OK);
            state_of(s);
            return 0;
        };
        if (k == 1) {
            ASSERT_EQ(callback.set(sim), GP_OK);
        }
        ASSERT_EQ(gp_run(sim, 0.02), GP_OK);
        bits[k] = snapshot(sim, 3);
    }
    EXPECT_EQ(bits[0], bits[1]);
}

TEST(Callbacks, StopTheRun) {
    for (const int32_t answer : {1, -1, INT32_MIN}) {
        Sim sim;
        add_collapse(sim, 3, 3);
        Callback callback;
        callback.body = [&](gp_sim *s) { return state_of(s).step == 5 ? answer : 0; };
        ASSERT_EQ(callback.set(sim), GP_OK);
        EXPECT_EQ(gp_step(sim, 100), GP_STOPPED);
        EXPECT_EQ(sim.state().step, 5) << "the step that the callback saw is complete";
        EXPECT_EQ(gp_step(sim, 2), GP_OK);
        EXPECT_EQ(sim.state().step, 7);
    }
    Sim sim;
    add_collapse(sim, 3, 3);
    Callback callback;
    callback.body = [](gp_sim *s) { return state_of(s).step % 4 == 0; };
    ASSERT_EQ(callback.set(sim), GP_OK);
    EXPECT_EQ(gp_run(sim, 0.05), GP_STOPPED);
    EXPECT_EQ(sim.state().step, 4);
    EXPECT_LT(sim.state().time, 0.05);
    EXPECT_EQ(gp_run(sim, 0.05), GP_STOPPED);
    EXPECT_EQ(sim.state().step, 8);
    ASSERT_EQ(gp_set_callback(sim, 1, nullptr, nullptr), GP_OK);
    EXPECT_EQ(gp_run(sim, 0.05), GP_OK);
    EXPECT_EQ(sim.state().time, 0.05);
}

TEST(Callbacks, StopInTheLastStepIsTold) {
    Sim sim;
    add_collapse(sim, 3, 3);
    Callback callback;
    callback.body = [](gp_sim *s) { return state_of(s).step == 3; };
    ASSERT_EQ(callback.set(sim), GP_OK);
    EXPECT_EQ(gp_step(sim, 3), GP_STOPPED);
    EXPECT_EQ(sim.state().step, 3);
}

TEST(Callbacks, ComeAfterEveryNthStep) {
    Sim sim;
    add_collapse(sim, 3, 3);
    std::vector<int64_t> steps;
    Callback callback;
    callback.body = [&](gp_sim *s) {
        steps.push_back(state_of(s).step);
        return 0;
    };
    for (const int64_t every : {int64_t(0), int64_t(-1), INT64_MIN})
        EXPECT_FAILS(callback.set(sim, every), GP_E_ARGUMENT, "every");
    ASSERT_EQ(callback.set(sim, 3), GP_OK);
    EXPECT_FAILS(callback.set(sim, 0), GP_E_ARGUMENT, "every"); // and the one that is set stays
    ASSERT_EQ(gp_step(sim, 4), GP_OK);
    ASSERT_EQ(gp_step(sim, 4), GP_OK);
    ASSERT_EQ(gp_step(sim, 4), GP_OK);
    EXPECT_EQ(steps, (std::vector<int64_t>{3, 6, 9, 12}));
    ASSERT_EQ(callback.set(sim, INT64_MAX), GP_OK);
    ASSERT_EQ(gp_step(sim, 4), GP_OK);
    EXPECT_EQ(steps.size(), 4u);
}

TEST(Callbacks, CanBeReplacedAndRemoved) {
    Sim sim;
    add_collapse(sim, 3, 3);
    Callback first, second;
    ASSERT_EQ(first.set(sim), GP_OK);
    ASSERT_EQ(gp_step(sim, 2), GP_OK);
    ASSERT_EQ(second.set(sim), GP_OK);
    ASSERT_EQ(gp_step(sim, 3), GP_OK);
    ASSERT_EQ(gp_set_callback(sim, 0, nullptr, &second), GP_OK) << "every is not read";
    ASSERT_EQ(gp_step(sim, 4), GP_OK);
    EXPECT_EQ(first.calls, 2);
    EXPECT_EQ(second.calls, 3);
}

TEST(Callbacks, MayUseOtherSimulations) {
    Sim outer, inner;
    add_collapse(outer, 3, 3);
    add_collapse(inner, 3, 3);
    Callback callback, within;
    within.body = [&](gp_sim *) {
        EXPECT_EQ(gp_step(outer, 1), GP_E_STATE);
        return 0;
    };
    ASSERT_EQ(within.set(inner), GP_OK);
    callback.body = [&](gp_sim *) {
        EXPECT_EQ(gp_step(inner, 2), GP_OK) << gp_last_error();
        Sim fresh;
        fresh.add(make_column(1, 1));
        EXPECT_EQ(gp_step(fresh, 1), GP_OK);
        return 0;
    };
    ASSERT_EQ(callback.set(outer), GP_OK);
    EXPECT_EQ(gp_step(outer, 3), GP_OK);
    EXPECT_EQ(outer.state().step, 3);
    EXPECT_EQ(inner.state().step, 6);
}

TEST(Callbacks, DriveAPlateAsATableWould) {
    // At rest for two steps, then lifted: the host's way and the table's give the same plate.
    Sim sim;
    add_collapse(sim, 4, 4);
    ASSERT_EQ(gp_set_plate_velocity(sim, 2, 0, 0), GP_OK);
    double start = 0;
    Callback callback;
    callback.body = [&](gp_sim *s) {
        if (state_of(s).step == 2) {
            start = state_of(s).time;
            EXPECT_EQ(gp_set_plate_velocity(s, 2, 0, 2), GP_OK);
        }
        return 0;
    };
    ASSERT_EQ(callback.set(sim), GP_OK);
    ASSERT_EQ(gp_run(sim, 0.02), GP_OK);
    EXPECT_GT(start, 0);
    EXPECT_NEAR(sim.load(2).dy, 2 * (0.02 - start), 1e-12);
}

// ----------------------------------------------------------------------------------------------------- log

TEST(Logs, TellOfRoundedColumns) {
    Sim sim;
    Log log;
    gp_column column = make_column(3, 3);
    column.width = 3.3 * spacing;
    EXPECT_EQ(gp_add_column(sim, &column, nullptr), GP_OK); // silent at the start
    ASSERT_EQ(gp_set_log(sim, Log::run, &log), GP_OK);
    sim.add(make_column(3, 3, 1, 0));
    EXPECT_TRUE(log.lines.empty()) << log.lines[0].second;
    sim.add(column);
    ASSERT_EQ(log.lines.size(), 1u);
    EXPECT_EQ(log.lines[0].first, GP_LOG_WARNING);
    EXPECT_NE(log.lines[0].second.find("rounded"), std::string::npos) << log.lines[0].second;
    EXPECT_NE(log.lines[0].second.find("0.033"), std::string::npos) << log.lines[0].second;
    column.width = not_a_number;
    EXPECT_EQ(gp_add_column(sim, &column, nullptr), GP_E_ARGUMENT);
    EXPECT_EQ(log.lines.size(), 1u) << "errors are told by the status";
    ASSERT_EQ(gp_set_log(sim, nullptr, nullptr), GP_OK);
    column.width = 3.3 * spacing;
    EXPECT_EQ(gp_add_column(sim, &column, nullptr), GP_OK);
    EXPECT_EQ(log.lines.size(), 1u);
}

TEST(Logs, TellOnceOfParticlesInAPlate) {
    Sim sim;
    Log log;
    ASSERT_EQ(gp_set_log(sim, Log::run, &log), GP_OK);
    sim.add(make_floor());
    sim.add(make_column(3, 3, 0, -0.5 * spacing)); // its lowest row is on the floor's line
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    ASSERT_EQ(log.lines.size(), 1u);
    EXPECT_EQ(log.lines[0].first, GP_LOG_WARNING);
    EXPECT_NE(log.lines[0].second.find("plate"), std::string::npos) << log.lines[0].second;
}
