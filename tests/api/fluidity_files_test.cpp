// Checkpoints and result files of scenes with a granular fluidity.
#ifdef GP_TEST_HDF5
#include "../support/directory.hpp"
#include "../support/result_file.hpp"
#include "fluidity_support.hpp"

using namespace api;

namespace {

class FluidityFiles : public testing::Test {
protected:
    const test::TemporaryDirectory temporary{"granperi_fluidity"};
    const std::string path = temporary.path() + "/state.gpc", h5 = temporary.path() + "/run.h5";

    // A run that is saved on the way goes on with the bits of one that is not.
    void check(const gp_config &config, void (*build)(Sim &), int32_t plates) const {
        for (const int steps : {0, 1, 37, 150}) {
            Sim sim(config), loaded;
            build(sim);
            ASSERT_EQ(gp_step(sim, steps), GP_OK) << gp_last_error();
            ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK) << gp_last_error();
            gp_destroy(loaded.handle);
            ASSERT_EQ(gp_load(path.c_str(), &loaded.handle), GP_OK) << gp_last_error();
            EXPECT_TRUE(snapshot(loaded, plates) == snapshot(sim, plates)) << "at step " << steps;
            ASSERT_EQ(gp_step(sim, 60), GP_OK) << gp_last_error();
            ASSERT_EQ(gp_step(loaded, 60), GP_OK) << gp_last_error();
            EXPECT_TRUE(snapshot(loaded, plates) == snapshot(sim, plates)) << "60 steps after step " << steps;
            EXPECT_GT(largest(loaded.field(GP_FIELD_FLUIDITY)), 0);
        }
    }
};

} // namespace

TEST_F(FluidityFiles, CheckpointsOfASlowCellGoOnWithTheSameBits) {
    check(couette_config(), add_couette, couette_plates);
}

TEST_F(FluidityFiles, CheckpointsOfACollapseGoOnWithTheSameBits) {
    gp_config config = make_config();
    config.jitter = 0.1;
    check(
        config, [](Sim &sim) { add_fluid_collapse(sim); }, collapse_plates);
}

TEST_F(FluidityFiles, ResultFilesHaveItFrameByFrame) {
    Sim sim(couette_config());
    add_couette(sim);
    gp_output output = make_output();
    output.fields = GP_FIELD_FLUIDITY;
    ASSERT_EQ(gp_output_open(sim, h5.c_str(), &output), GP_OK) << gp_last_error();
    std::vector<double> expected;
    for (int frame = 0; frame < 3; ++frame) {
        ASSERT_EQ(gp_step(sim, 50), GP_OK);
        ASSERT_EQ(gp_output_write(sim), GP_OK);
        const std::vector<double> now = sim.field(GP_FIELD_FLUIDITY);
        expected.insert(expected.end(), now.begin(), now.end());
    }
    ASSERT_EQ(gp_output_close(sim), GP_OK);
    const test::Reader file(h5);
    EXPECT_EQ(file.numbers("/particles/all/fluidity/value"), expected);
    EXPECT_EQ(file.text_attribute("/particles/all/fluidity/value", "unit"), "s-1");
}

#endif
