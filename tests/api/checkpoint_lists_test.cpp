// A simulation that has been loaded goes on with the same bits, also where lists are of particles that lie far apart, and across the
// ends of a period, between materials of different density.
#include "../support/directory.hpp"
#include "../support/scene.hpp"

using namespace test;

#ifdef GP_TEST_HDF5

namespace {

const uint32_t fields[] = {GP_FIELD_X,        GP_FIELD_Y,       GP_FIELD_VX,  GP_FIELD_VY,
                           GP_FIELD_PRESSURE, GP_FIELD_DENSITY, GP_FIELD_SXX, GP_FIELD_NUMBER_DENSITY};

void expect_same(const Sim &loaded, const Sim &sim) {
    for (const uint32_t bit : fields)
        ASSERT_EQ(loaded.field(bit), sim.field(bit)) << "field " << bit;
}

// Saved after so many steps, and compared after a few more, with the same lists, and after many, with new ones.
void expect_the_same_to_go_on(Sim &sim, int64_t steps) {
    const TemporaryDirectory directory{"granperi_lists"};
    const std::string path = directory.path() + "/state.gpc";
    sim.step(steps);
    ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK) << gp_last_error();
    gp_sim *handle = nullptr;
    ASSERT_EQ(gp_load(path.c_str(), &handle), GP_OK) << gp_last_error();
    Sim loaded(handle);
    expect_same(loaded, sim);
    for (const int64_t more : {1, 3, 60}) {
        sim.step(more);
        loaded.step(more);
        expect_same(loaded, sim);
    }
}

} // namespace

TEST(CheckpointLists, OfAGrainFarAway) {
    Sim sim(config(0.01));
    sim.column(0, 0, 0.2, 0.2, sim.material(0.38, 0.62));
    sim.column(2.5, 2.5, 0.05, 0.05);
    sim.add(floor_at(0, -1, 1));
    expect_the_same_to_go_on(sim, 45);
}

TEST(CheckpointLists, AcrossAPeriodOfTwoDensities) {
    gp_config c = flowing_round(0.01, 0.4, 8);
    c.jitter = 0.2;
    Sim sim(c);
    const int32_t light = sim.material(0.38, 0.62);
    gp_material heavy;
    ASSERT_EQ(gp_material_init(&heavy, sizeof heavy), GP_OK);
    heavy.grain_density *= 3;
    sim.column(0, 0, 0.2, 0.15, light);
    sim.column(0.2, 0, 0.2, 0.15, sim.add(heavy), 0.5); // runs into the light one across the end
    sim.add(floor_at(0, 0, 0.4));
    expect_the_same_to_go_on(sim, 120);
    EXPECT_GT(sim.state().collisions, 0);
}

TEST(CheckpointLists, OfAWidePeriod) {
    gp_config c = flowing_round(0.01, 4, 3);
    c.jitter = 0.1;
    Sim sim(c);
    sim.column(0, 0, 0.1, 0.4, sim.material(0.38, 0.62));
    sim.column(3.9, 0, 0.1, 0.4);
    sim.add(floor_at(0, 0, 4));
    expect_the_same_to_go_on(sim, 120);
}

#endif
