// For the tests at the ends of what the library takes: what must hold whatever the scene.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "../support/scene.hpp"

namespace test {

inline std::vector<uint32_t> all_fields() {
    std::vector<uint32_t> bits;
    for (uint32_t bit = 1; bit & GP_FIELD_ALL; bit <<= 1)
        bits.push_back(bit);
    return bits;
}

// No field of any particle and no number of the state is NaN or infinite.
inline void expect_finite(Sim &sim) {
    for (const uint32_t bit : all_fields())
        for (const double value : sim.field(bit))
            ASSERT_TRUE(std::isfinite(value)) << "field " << bit;
    const gp_state s = sim.state();
    for (const double value :
         {s.time, s.dt, s.kinetic, s.potential, s.elastic, s.dissipated, s.plate_work, s.energy_error, s.momentum_x,
          s.momentum_y, s.max_speed, s.x_left, s.x_right, s.peak_height, s.max_pressure})
        ASSERT_TRUE(std::isfinite(value));
}

// Largest difference of two fields.
inline double difference(const std::vector<double> &a, const std::vector<double> &b) {
    EXPECT_EQ(a.size(), b.size());
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

// Runs to the next whole `every` after which the material is at rest; at the latest to `end`.
inline gp_state run_to_rest(Sim &sim, double every, double end) {
    gp_state state = sim.state();
    while (!state.at_rest && state.time < end - 0.5 * every) {
        sim.run(state.time + every);
        state = sim.state();
        if (testing::Test::HasFatalFailure())
            break;
    }
    return state;
}

} // namespace test
