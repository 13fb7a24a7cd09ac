// How much memory a particle takes, as gp_get_plan tells it.
#include <numeric>

#include "api_support.hpp"

using namespace api;

namespace {

double bytes_of(const Sim &sim, const std::vector<gp_plan_entry> &plan, const char *name) {
    for (const gp_plan_entry &entry : plan)
        if (entry.kind == 1 && !std::strcmp(entry.name, name))
            return static_cast<double>(entry.bytes) / static_cast<double>(sim.count());
    ADD_FAILURE() << name;
    return 0;
}

double bytes_of_all(const Sim &sim, const std::vector<gp_plan_entry> &plan) {
    const int64_t sum = std::accumulate(plan.begin(), plan.end(), int64_t{0},
                                        [](int64_t all, const gp_plan_entry &entry) { return all + entry.bytes; });
    return static_cast<double>(sum) / static_cast<double>(sim.count());
}

// 120 x 83 particles on a floor, between walls or not.
void add_block(Sim &sim, bool walls) {
    sim.add(make_floor());
    if (walls) {
        sim.add(make_plate(0, 0, 0, 2));
        sim.add(make_plate(120 * spacing, 2, 120 * spacing, 0));
    }
    sim.add(make_column(120, 83));
}

} // namespace

// Carried from step to step 84; velocity gradient 32, the other memory of it, which is the pushes' too, 32; stress over shape 32,
// shape tensor 24, acceleration 16, the density before the step 8. Whatever else a stage makes lies in these.
TEST(Bytes, FieldsThatLiveForSomeStagesShareTheirMemory) {
    Sim sim;
    add_block(sim, false);
    ASSERT_EQ(gp_step(sim, 5), GP_OK);
    const auto plan = sim.plan();
    double fields = 0;
    for (const char *name : {"id",
                             "column",
                             "position",
                             "velocity",
                             "density",
                             "pressure",
                             "mean_pressure",
                             "deviatoric_stress",
                             "velocity_gradient",
                             "inverse_shape_tensor",
                             "stress_over_shape",
                             "acceleration",
                             "push",
                             "kept_fields",
                             "stressed",
                             "flowing",
                             "crowding",
                             "bearing",
                             "rest_density",
                             "carried"})
        fields += bytes_of(sim, plan, name);
    EXPECT_EQ(fields, 84 + 32 + 32 + 32 + 24 + 16 + 8);
}

// The rows of clusters: of a dense set pi (4.8 dl)^2 = 72 particles are in the reach of one at the thickest skin, 95 in that of
// one of four in two rows side by side, 2 bytes each for every four particles: 48. With a twentieth of room, offsets, and the rows of
// 512 particles that are found at a time (10 at 10^4 particles) it is 70.
TEST(Bytes, OfAFlowOfTenThousand) {
    Sim sim;
    add_block(sim, false);
    ASSERT_EQ(gp_run(sim, 0.06), GP_OK);
    const auto plan = sim.plan();
    EXPECT_LT(bytes_of(sim, plan, "clusters"), 70);
    EXPECT_LT(bytes_of(sim, plan, "cells"), 4 + 4 * 4 + 1); // the order; at most four cells each
    // Beside a plate a particle sees some thirty ghosts, and these it: that goes with the root of the number of particles.
    EXPECT_LT(bytes_of_all(sim, plan) - bytes_of(sim, plan, "ghosts"), 358);
}

TEST(Bytes, OfTenThousandAtRest) {
    Sim sim;
    add_block(sim, true);
    ASSERT_EQ(gp_step(sim, 100), GP_OK);
    const auto plan = sim.plan();
    EXPECT_LT(bytes_of(sim, plan, "clusters"), 50); // the skin is thin
    EXPECT_LT(bytes_of_all(sim, plan) - bytes_of(sim, plan, "ghosts"), 308);
}

// Where no friction goes by the inertial number its pressure has no memory.
TEST(Bytes, OfTheMeanPressureAreThoseOfTheInertialNumber) {
    struct Case {
        double mu_2, amplitude;
        int32_t stress;
        double bytes;
    };
    const double mu_s = std::tan(21 * std::acos(-1) / 180), mu_2 = std::tan(32 * std::acos(-1) / 180);
    for (const Case &c : {Case{mu_2, 0, GP_STRESS_ELASTIC, 8}, Case{mu_s, 0, GP_STRESS_ELASTIC, 0},
                          Case{mu_2, 0.5, GP_STRESS_ELASTIC, 0}, Case{mu_2, 0, GP_STRESS_IMPLICIT, 0}}) {
        gp_config config = make_config();
        config.stress = c.stress;
        Sim sim(config);
        gp_material material;
        gp_material_init(&material, sizeof material);
        material.mu_s = mu_s;
        material.mu_2 = c.mu_2;
        material.nonlocal_amplitude = c.amplitude;
        sim.add(make_floor());
        gp_column column = make_column(20, 10);
        column.material = sim.add(material);
        sim.add(column);
        ASSERT_EQ(gp_step(sim, 3), GP_OK) << gp_last_error();
        EXPECT_EQ(bytes_of(sim, sim.plan(), "mean_pressure"), c.bytes) << c.mu_2 << " " << c.amplitude;
    }
}

// What a step lends is back when it ends: the same memory after any step.
TEST(Bytes, AreTheSameAfterEachStep) {
    Sim sim;
    sim.add(make_floor());
    sim.add(make_column(20, 10));
    ASSERT_EQ(gp_step(sim, 2), GP_OK);
    const auto before = sim.plan();
    for (int k = 0; k < 5; ++k) {
        ASSERT_EQ(gp_step(sim, 1), GP_OK);
        const auto now = sim.plan();
        for (const char *name : {"acceleration", "push", "inverse_shape_tensor", "stress_over_shape", "kept_fields"})
            EXPECT_EQ(bytes_of(sim, now, name), bytes_of(sim, before, name)) << name;
        for (const char *name : {"stressed", "flowing", "crowding", "bearing", "carried"})
            EXPECT_EQ(bytes_of(sim, now, name), 0) << name;
    }
}
