// What becomes of a result file and of the run when the disk says no.
#ifdef GP_TEST_HDF5
#include "../support/file_size_limit.hpp"
#include "output_support.hpp"

using namespace api;

TEST_F(Output, PathsThatCannotBeWrittenAreAnIoErrorAndTheSimulationGoesOn) {
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        add_collapse(sim, 4, 4);
        ASSERT_EQ(gp_step(sim, 3), GP_OK);
        const std::string missing = directory + "/missing/run.h5";
        for (const std::string &bad : {missing, directory, std::string(), std::string("/dev/full")})
            if (k == 1) {
                EXPECT_EQ(gp_output_open(sim, bad.c_str(), nullptr), GP_E_IO) << bad << ": " << gp_last_error();
                EXPECT_TRUE(last_error_has(bad)) << gp_last_error();
                EXPECT_EQ(gp_output_write(sim), GP_E_STATE) << "nothing is open";
            }
        ASSERT_EQ(gp_step(sim, 3), GP_OK);
        bits[k] = snapshot(sim, 3);
        ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK) << gp_last_error();
        ASSERT_EQ(gp_output_close(sim), GP_OK);
    }
    EXPECT_EQ(bits[0], bits[1]);
}

// A disk that is full for a while: gp_output_write says so, the frames before are kept, later ones are written again.
TEST_F(Output, AFullDiskCostsOnlyTheFrame) {
    Sim sim;
    sim.add(make_column(20, 20));
    ASSERT_EQ(gp_output_open(sim, path.c_str(), nullptr), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK);
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    {
        const test::FileSizeLimit limit(std::filesystem::file_size(path));
        EXPECT_EQ(gp_output_write(sim), GP_E_IO) << gp_last_error();
        EXPECT_TRUE(last_error_has(path)) << gp_last_error();
    }
    EXPECT_EQ(frame_times(path).size(), 1u);
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    ASSERT_EQ(gp_output_write(sim), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_output_close(sim), GP_OK) << gp_last_error();
    EXPECT_EQ(frame_times(path), (std::vector<double>{0, sim.state().time}));
}

// "after GP_E_IO (of an output that writes by itself) the step is complete, the frame is lost and the run may go on".
TEST_F(Output, AFullDiskInARunLosesTheFrameAndNoStep) {
    gp_config config = make_config();
    config.time_step = 1e-4;
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim(config);
        sim.add(make_column(20, 20));
        int calls = 0;
        const auto count = [](void *user, gp_sim *) {
            ++*static_cast<int *>(user);
            return int32_t(0);
        };
        ASSERT_EQ(gp_set_callback(sim, 1, count, &calls), GP_OK);
        if (k == 1) {
            gp_output output = make_output();
            output.every_seconds = 1e-3;
            ASSERT_EQ(gp_output_open(sim, path.c_str(), &output), GP_OK) << gp_last_error();
            ASSERT_EQ(gp_step(sim, 15), GP_OK);
            const test::FileSizeLimit limit(std::filesystem::file_size(path));
            EXPECT_EQ(gp_step(sim, 10), GP_E_IO) << gp_last_error();
            EXPECT_EQ(sim.state().step, 20);
            EXPECT_EQ(gp_step(sim, 5), GP_OK) << "no frame is due: " << gp_last_error();
            EXPECT_EQ(calls, 25) << "the callback sees every complete step";
        } else {
            ASSERT_EQ(gp_step(sim, 25), GP_OK);
        }
        ASSERT_EQ(gp_run(sim, 4e-3), GP_OK) << gp_last_error();
        EXPECT_EQ(sim.state().time, 4e-3);
        if (k == 1) {
            ASSERT_EQ(gp_output_close(sim), GP_OK);
        }
        bits[k] = snapshot(sim);
    }
    EXPECT_EQ(bits[0], bits[1]);
    const std::vector<double> t = frame_times(path);
    ASSERT_EQ(t.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k)
        EXPECT_NEAR(t[k], static_cast<double>(k < 2 ? k : k + 1) * 1e-3, 1e-12);
}

#endif
