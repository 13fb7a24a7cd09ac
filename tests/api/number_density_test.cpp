// GP_FIELD_NUMBER_DENSITY, which is summed over the cells of the last sort, where all moves together.
#include <algorithm>

#include "../support/scene.hpp"

using namespace test;

TEST(NumberDensity, IsThatOfTheLatticeWhileAllFalls) {
    for (const bool periodic : {false, true}) {
        Sim sim(periodic ? flowing_round(0.01, 0.2, 5) : config(0.01));
        sim.column(0, 0, 0.2, 0.2, sim.material(0.38, 0.62));
        const std::vector<double> before = sim.field(GP_FIELD_NUMBER_DENSITY);
        EXPECT_GT(*std::min_element(before.begin(), before.end()), 0) << periodic;
        // A part of its fall by 100 spacings nothing moves against anything: the lists are those of the start.
        for (const double time : {0.05, 0.2, 0.45}) {
            sim.run(time);
            const std::vector<double> now = sim.field(GP_FIELD_NUMBER_DENSITY);
            for (std::size_t i = 0; i < now.size(); ++i)
                ASSERT_NEAR(now[i], before[i], 1e-9) << periodic << " " << time << " " << i;
        }
    }
}

// Across the ends of the period, too, where the lists reach less far than the weight does.
TEST(NumberDensity, IsThatOfARowWhereverThePeriodEnds) {
    gp_config c = flowing_round(0.01, 0.2, 5);
    c.horizon = 1.8;
    c.interaction_radius = 6;
    Sim sim(c);
    sim.column(0, 0, 0.2, 0.2, sim.material(0.38, 0.62));
    for (const double time : {0.0, 0.05, 0.2}) {
        if (time > 0)
            sim.run(time);
        const std::vector<double> y = sim.field(GP_FIELD_Y), density = sim.field(GP_FIELD_NUMBER_DENSITY);
        for (std::size_t i = 0; i < y.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (std::abs(y[i] - y[j]) < 1e-6 * c.spacing) {
                    ASSERT_NEAR(density[i], density[j], 1e-6) << time << " " << i << " " << j;
                }
    }
}
