// Result files as a program sees them: opened, written, closed. What is in them: output_contents_test.cpp; when the disk says
// no: output_failures_test.cpp; the layout: unit/frame_file_test.cpp.
#include "output_support.hpp"

using namespace api;

TEST_F(Output, DefaultsAreTheDocumentedOnes) {
    const gp_output o = make_output();
    EXPECT_EQ(o.struct_size, sizeof o);
    EXPECT_EQ(o.every_seconds, 0);
    EXPECT_EQ(o.fields,
              GP_FIELD_POSITION | GP_FIELD_VELOCITY | GP_FIELD_PRESSURE | GP_FIELD_SHEAR_RATE | GP_FIELD_COLUMN);
    EXPECT_EQ(o.compression, 4);
    EXPECT_EQ(o.single_precision, 0);
}

// In every build, also in one without HDF5.
TEST_F(Output, OptionsAreChecked) {
    Sim sim;
    sim.add(make_column(2, 2));
    const auto refuse = [&](const gp_output &output, const char *name) {
        EXPECT_FAILS(gp_output_open(sim, path.c_str(), &output), GP_E_ARGUMENT, name);
        EXPECT_FALSE(std::filesystem::exists(path)) << "nothing is created";
        EXPECT_EQ(gp_output_close(sim), GP_E_STATE) << "nothing is open";
    };
    for (const double value : {not_a_number, infinite, -infinite, -0.1}) {
        gp_output output = make_output();
        output.every_seconds = value;
        refuse(output, "every_seconds");
    }
    for (const uint32_t fields : {GP_FIELD_ALL + 1, UINT32_MAX}) {
        gp_output output = make_output();
        output.fields = fields;
        refuse(output, "fields");
    }
    for (const int32_t level : {-1, 10}) {
        gp_output output = make_output();
        output.compression = level;
        refuse(output, "compression");
    }
    for (const int32_t single : {-1, 2}) {
        gp_output output = make_output();
        output.single_precision = single;
        refuse(output, "single_precision");
    }
}

TEST_F(Output, WithoutHdf5IsUnsupported) {
    if (has("hdf5"))
        GTEST_SKIP() << "this build has HDF5";
    Sim sim;
    sim.add(make_column(2, 2));
    EXPECT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_E_UNSUPPORTED) << gp_last_error();
    EXPECT_EQ(gp_output_write(sim), GP_E_STATE);
    EXPECT_EQ(gp_output_close(sim), GP_E_STATE);
    EXPECT_EQ(gp_step(sim, 2), GP_OK);
}

TEST_F(Output, WriteAndCloseNeedAnOpenOne) {
    Sim sim;
    sim.add(make_column(2, 2));
    EXPECT_FAILS(gp_output_write(sim), GP_E_STATE, "gp_output_write");
    EXPECT_FAILS(gp_output_close(sim), GP_E_STATE, "gp_output_close");
}

#ifdef GP_TEST_HDF5

TEST_F(Output, FramesAreWrittenOnCall) {
    Sim sim;
    add_collapse(sim, 5, 4);
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
    EXPECT_TRUE(std::filesystem::exists(path));
    EXPECT_TRUE(std::filesystem::exists(directory + "/run.xdmf"));
    std::vector<double> expected;
    for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
        expected.push_back(sim.state().time);
        EXPECT_EQ(frame_times(path), expected) << "a complete frame can be read while the output is open";
        ASSERT_EQ(gp_step(sim, 5), GP_OK);
    }
    ASSERT_EQ(gp_output_close(sim), GP_OK) << gp_last_error();
    EXPECT_EQ(frame_times(path), expected);
    EXPECT_EQ(gp_output_write(sim), GP_E_STATE);
    EXPECT_EQ(gp_output_close(sim), GP_E_STATE);
    std::ifstream xdmf(directory + "/run.xdmf");
    const std::string text((std::istreambuf_iterator<char>(xdmf)), std::istreambuf_iterator<char>());
    EXPECT_NE(text.find("run.h5:"), std::string::npos);
}

TEST_F(Output, FollowsTheRunByItself) {
    Sim sim;
    add_collapse(sim, 5, 4);
    gp_output output = make_output();
    output.every_seconds = 0.01;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    EXPECT_EQ(frame_times(path), std::vector<double>{0});
    ASSERT_EQ(gp_run(sim, 0.052), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK) << "one more in between";
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const std::vector<double> t = frame_times(path);
    ASSERT_EQ(t.size(), 7u);
    for (std::size_t k = 1; k < 6; ++k) {
        EXPECT_GE(t[k], 0.01 * static_cast<double>(k) - 1e-12);
        EXPECT_LT(t[k], 0.01 * static_cast<double>(k) + 2 * sim.state().dt + 1e-3);
    }
    EXPECT_EQ(t.back(), 0.052);
}

// Runs that end on the multiples: each has its frame, and no multiple has two.
TEST_F(Output, HasOneFramePerMultipleAlsoWhereRunsEndOnThem) {
    Sim sim;
    add_collapse(sim, 3, 3);
    gp_output output = make_output();
    output.every_seconds = 0.003;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    for (int k = 1; k <= 10; ++k)
        ASSERT_EQ(gp_run(sim, 0.003 * k), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const std::vector<double> t = frame_times(path);
    ASSERT_EQ(t.size(), 11u);
    for (std::size_t k = 0; k < t.size(); ++k)
        EXPECT_NEAR(t[k], 0.003 * static_cast<double>(k), 1e-12);
}

// A step longer than the interval: one frame, not one per multiple that it passes.
TEST_F(Output, AStepWritesAtMostOneFrame) {
    gp_config config = make_config();
    config.time_step = 2e-4;
    Sim sim(config);
    sim.add(make_column(2, 2));
    gp_output output = make_output();
    output.every_seconds = 3e-5;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_step(sim, 4), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    EXPECT_EQ(frame_times(path).size(), 5u);
}

TEST_F(Output, OnlyOneAtATime) {
    Sim sim;
    sim.add(make_column(2, 2));
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK);
    EXPECT_FAILS(gp_output_open(sim, (directory + "/other.h5").c_str(), nullptr), GP_E_STATE, "open");
    EXPECT_FALSE(std::filesystem::exists(directory + "/other.h5"));
    EXPECT_EQ(gp_output_write(sim), GP_OK) << "the first one is still open";
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    ASSERT_EQ(gp_output_open(sim, (directory + "/other.h5").c_str(), nullptr), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    EXPECT_EQ(frame_times(path).size(), 1u);
    EXPECT_EQ(frame_times(directory + "/other.h5").size(), 0u);
}

TEST_F(Output, ReplacesAnExistingFile) {
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        sim.add(make_column(2, 2));
        ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
        for (int frame = 0; frame < 3 - k; ++frame)
            ASSERT_EQ(gp_output_write(sim), GP_OK);
        ASSERT_EQ(gp_output_close(sim), GP_OK);
        EXPECT_EQ(frame_times(path).size(), static_cast<std::size_t>(3 - k));
    }
}

TEST_F(Output, DestroyClosesIt) {
    {
        Sim sim;
        sim.add(make_column(2, 2));
        ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK);
        ASSERT_EQ(gp_output_write(sim), GP_OK);
    }
    EXPECT_EQ(frame_times(path).size(), 1u);
}

TEST_F(Output, AnEmptySceneHasFramesToo) {
    Sim sim;
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_step(sim, 2), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    EXPECT_EQ(frame_times(path).size(), 2u);
}

// The file has the scene as it was when it was opened: that is the world that goes on.
TEST_F(Output, KnowsWhatIsSetBeforeTheFirstStep) {
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK);
    const double sound_speed = sim.state().sound_speed;
    ASSERT_EQ(gp_set_gravity(sim, 0, -9.81), GP_OK); // as it is
    ASSERT_EQ(gp_set_gravity(sim, 0, -1), GP_OK);
    ASSERT_EQ(gp_set_plate_velocity(sim, 1, 0, 0.3), GP_OK);
    EXPECT_EQ(sim.state().gravity_y, -1);
    EXPECT_EQ(sim.state().sound_speed, sound_speed);
    EXPECT_EQ(sim.state().at_rest, 0);
    const std::string saved = directory + "/before.gpc";
    ASSERT_EQ(gp_save(sim, saved.c_str()), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_step(sim, 10), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    gp_load load{};
    load.struct_size = sizeof load;
    ASSERT_EQ(gp_get_plate_load(sim, 1, &load), GP_OK);
    EXPECT_NEAR(load.dy, 0.3 * sim.state().time, 1e-15);
    const test::Reader file(path);
    EXPECT_EQ(file.attribute("/parameters", "sound_speed"), std::vector<double>{sim.state().sound_speed});
    EXPECT_EQ(frame_times(path), std::vector<double>{sim.state().time});
    const gp_column late = make_column(2, 2, 50, 50);
    EXPECT_FAILS(gp_add_column(sim, &late, nullptr), GP_E_STATE, "first step");

    Sim loaded;
    gp_destroy(loaded.handle);
    ASSERT_EQ(gp_load(saved.c_str(), &loaded.handle), GP_OK) << gp_last_error();
    EXPECT_EQ(loaded.state().sound_speed, sound_speed);
    ASSERT_EQ(gp_step(loaded, 10), GP_OK);
    EXPECT_TRUE(snapshot(loaded, 3) == snapshot(sim, 3));
}

TEST_F(Output, DoesNotChangeTheRun) {
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        add_collapse(sim, 6, 6);
        gp_output output = make_output();
        output.every_seconds = 1e-3;
        output.fields = GP_FIELD_ALL;
        if (k == 1) {
            ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK);
        }
        ASSERT_EQ(gp_step(sim, 40), GP_OK);
        bits[k] = snapshot(sim, 3);
    }
    EXPECT_EQ(bits[0], bits[1]);
}

#endif
