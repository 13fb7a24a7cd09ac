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
    const std::pair<const char *, double> numbers[] = {{"time", s.time},
                                                       {"dt", s.dt},
                                                       {"kinetic", s.kinetic},
                                                       {"potential", s.potential},
                                                       {"elastic", s.elastic},
                                                       {"dissipated", s.dissipated},
                                                       {"plate_work", s.plate_work},
                                                       {"energy_error", s.energy_error},
                                                       {"momentum_x", s.momentum_x},
                                                       {"momentum_y", s.momentum_y},
                                                       {"max_speed", s.max_speed},
                                                       {"x_left", s.x_left},
                                                       {"x_right", s.x_right},
                                                       {"peak_height", s.peak_height},
                                                       {"max_pressure", s.max_pressure}};
    for (const auto &[name, value] : numbers)
        ASSERT_TRUE(std::isfinite(value))
            << name << " = " << value << ", left " << s.x_left << ", right " << s.x_right << ", at " << s.peak_x;
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
