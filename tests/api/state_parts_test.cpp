// gp_get_state_parts, and what gp_get_state measures for the structs of older programs.
#include <cmath>
#include <cstddef>
#include <cstring>

#include "api_support.hpp"

using namespace api;

namespace {

gp_state parts_of(gp_sim *sim, uint32_t parts) {
    gp_state state;
    std::memset(static_cast<void *>(&state), 0x5a, sizeof state);
    state.struct_size = sizeof state;
    EXPECT_EQ(gp_get_state_parts(sim, parts, &state), GP_OK) << gp_last_error();
    return state;
}

// The fields of one part, the same as the whole state's or all NaN.
void compare(const gp_state &state, const gp_state &all, bool asked, double gp_state::*field) {
    if (asked)
        EXPECT_EQ(state.*field, all.*field);
    else
        EXPECT_TRUE(std::isnan(state.*field));
}

void compare(const gp_state &state, const gp_state &all, uint32_t parts) {
    for (double gp_state::*field :
         {&gp_state::x_left, &gp_state::x_right, &gp_state::peak_x, &gp_state::peak_height, &gp_state::detached})
        compare(state, all, parts & GP_STATE_DEPOSIT, field);
    for (double gp_state::*field : {&gp_state::x_q01, &gp_state::x_q05, &gp_state::x_q25, &gp_state::x_q50,
                                    &gp_state::x_q75, &gp_state::x_q95, &gp_state::x_q99})
        compare(state, all, parts & GP_STATE_MARKS, field);
    compare(state, all, parts & GP_STATE_DRIFT, &gp_state::volume_drift);
    for (double gp_state::*field :
         {&gp_state::time, &gp_state::dt, &gp_state::kinetic, &gp_state::potential, &gp_state::elastic,
          &gp_state::energy_error, &gp_state::momentum_x, &gp_state::max_speed, &gp_state::rms_speed,
          &gp_state::max_pressure, &gp_state::centre_x, &gp_state::centre_y, &gp_state::dt_limit})
        compare(state, all, true, field);
    EXPECT_EQ(state.at_rest, all.at_rest);
    EXPECT_EQ(state.n_particles, all.n_particles);
}

} // namespace

TEST(StateParts, AreThoseOfTheStateAndTheOthersNaN) {
    for (uint32_t parts = 0; parts <= GP_STATE_ALL; ++parts) {
        Sim sim;
        add_collapse(sim);
        ASSERT_EQ(gp_step(sim, 50), GP_OK);
        const gp_state some = parts_of(sim, parts); // before the whole, and behind it
        const gp_state all = sim.state();
        compare(some, all, parts);
        compare(parts_of(sim, parts), all, parts);
        compare(parts_of(sim, GP_STATE_ALL & ~parts), all, GP_STATE_ALL & ~parts);
    }
}

TEST(StateParts, AreMeasuredAnewAfterAStep) {
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_step(sim, 5), GP_OK);
    const double before = parts_of(sim, GP_STATE_MARKS).x_q50;
    ASSERT_EQ(gp_step(sim, 200), GP_OK);
    EXPECT_TRUE(std::isnan(parts_of(sim, 0).x_q50));
    EXPECT_NE(parts_of(sim, GP_STATE_MARKS).x_q50, before);
}

TEST(StateParts, UnknownOnesAndNullAreRefused) {
    Sim sim;
    add_collapse(sim);
    gp_state state{};
    state.struct_size = sizeof state;
    EXPECT_FAILS(gp_get_state_parts(sim, GP_STATE_ALL + 1, &state), GP_E_ARGUMENT, "parts = 0x8");
    EXPECT_FAILS(gp_get_state_parts(sim, 0, nullptr), GP_E_ARGUMENT, "state");
    EXPECT_FAILS(gp_get_state_parts(nullptr, 0, &state), GP_E_ARGUMENT, "sim");
    state.struct_size = 0;
    EXPECT_FAILS(gp_get_state_parts(sim, 0, &state), GP_E_ARGUMENT, "struct_size");
}

// A program of before these fields has no room for them, and what it has is as it was.
TEST(StateParts, AnOlderStructGetsAllThatItHas) {
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_step(sim, 50), GP_OK);
    const auto handed = [&](std::size_t size) {
        gp_state state{};
        state.struct_size = static_cast<uint32_t>(size);
        EXPECT_EQ(gp_get_state(sim, &state), GP_OK);
        return state;
    };
    const gp_state short_one = handed(offsetof(gp_state, x_left)),
                   first = handed(offsetof(gp_state, spacing_dissipated));
    const gp_state all = handed(sizeof(gp_state));
    EXPECT_EQ(short_one.rms_speed, all.rms_speed);
    EXPECT_EQ(short_one.x_left, 0) << "not written";
    for (double gp_state::*field : {&gp_state::x_left, &gp_state::x_right, &gp_state::peak_x, &gp_state::peak_height,
                                    &gp_state::kinetic, &gp_state::max_compression})
        EXPECT_EQ(first.*field, all.*field);
    EXPECT_EQ(first.x_q01, 0) << "not written";
    EXPECT_TRUE(std::isfinite(all.x_q01) && std::isfinite(all.volume_drift) && std::isfinite(all.detached));
}
