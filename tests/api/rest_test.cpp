// gp_state.at_rest: material that lies still has not come to rest while a plate is still to move it.
#include "api_support.hpp"

using namespace api;

namespace {

constexpr int columns = 12, rows = 6;

// A column between two walls that has come to rest; the wall on its right is `gate`.
void add_held_column(Sim &sim) {
    sim.add(make_floor());
    sim.add(make_left_wall(0, 0.2));
    sim.add(make_column(columns, rows));
}

gp_plate make_gate() {
    gp_plate gate = make_right_wall(columns * spacing, 0.2);
    gate.friction = GP_WALL_FREE_SLIP;
    return gate;
}

int32_t at_rest_at(Sim &sim, double time) {
    EXPECT_EQ(gp_run(sim, time), GP_OK) << gp_last_error();
    return sim.state().at_rest;
}

} // namespace

TEST(Rest, ComesWithAGateThatStays) {
    Sim sim;
    add_held_column(sim);
    sim.add(make_gate());
    EXPECT_EQ(at_rest_at(sim, 0.5), 1);
}

TEST(Rest, WaitsForATableToEnd) {
    Sim sim;
    add_held_column(sim);
    gp_plate gate = make_gate();
    const double t[] = {0, 1, 1.1, 3}, x[] = {0, 0, 0, 0}, y[] = {0, 0, 0.5, 0.5};
    gate.n_knots = 4;
    gate.knot_t = t;
    gate.knot_x = x;
    gate.knot_y = y;
    sim.add(gate);
    EXPECT_EQ(at_rest_at(sim, 0.5), 0) << "the gate is still to be lifted";
    EXPECT_EQ(at_rest_at(sim, 1.05), 0);
    EXPECT_EQ(at_rest_at(sim, 2.5), 1) << "its last knots displace it no further";
}

// A flap about its foot, and one that turns where nothing lies.
TEST(Rest, WaitsForAPlateThatIsStillToTurn) {
    for (const bool far : {false, true}) {
        Sim sim;
        add_held_column(sim);
        gp_plate flap = make_gate();
        if (far) {
            sim.add(make_gate());
            flap.x0 = flap.x1 = 1;
        }
        const double t[] = {0, 1, 1.1, 3}, angle[] = {0, 0, -0.5, -0.5};
        flap.pivot_x = flap.x1;
        flap.n_knots = 4;
        flap.knot_t = t;
        flap.knot_angle = angle;
        sim.add(flap);
        EXPECT_EQ(at_rest_at(sim, 0.5), far) << "the flap is still to be opened";
        EXPECT_EQ(at_rest_at(sim, 1.05), far);
        EXPECT_EQ(at_rest_at(sim, 2.5), 1) << "its last knots turn it no further";
    }
}

TEST(Rest, WaitsForTheHostsPlate) {
    Sim sim;
    add_held_column(sim);
    const int32_t gate = sim.add(make_gate());
    ASSERT_EQ(at_rest_at(sim, 0.5), 1);
    ASSERT_EQ(gp_set_plate_velocity(sim, gate, 0, 0.01), GP_OK);
    EXPECT_EQ(sim.state().at_rest, 0) << "it moves from now on";
    ASSERT_EQ(gp_set_plate_velocity(sim, gate, 0, 0), GP_OK);
    EXPECT_EQ(sim.state().at_rest, 1);
}

// What counts is what the material feels or comes to feel.
TEST(Rest, DoesNotWaitForPlatesOutOfReach) {
    Sim sim;
    add_held_column(sim);
    sim.add(make_gate());
    gp_plate leaves = make_plate(1, 1, 0, 1); // a lid far above
    leaves.vy = 1;
    sim.add(leaves);
    gp_plate beside = make_right_wall(3, 0.2);
    beside.vy = -1;
    sim.add(beside);
    EXPECT_EQ(at_rest_at(sim, 0.5), 1);
}

TEST(Rest, WaitsForAPlateThatIsOnItsWay) {
    Sim sim;
    add_held_column(sim);
    sim.add(make_gate());
    gp_plate lid = make_plate(0, 1, 1, 1);
    lid.vy = -0.01;
    const int32_t id = sim.add(lid);
    EXPECT_EQ(at_rest_at(sim, 0.5), 0);
    ASSERT_EQ(gp_set_plate_velocity(sim, id, 0, 0.01), GP_OK); // away again
    EXPECT_EQ(sim.state().at_rest, 1);
}

TEST(Rest, WaitsForAPlateUnderALoad) {
    Sim sim;
    add_held_column(sim);
    sim.add(make_gate());
    gp_plate lid = make_plate(0, 0.12, columns * spacing, 0.12); // 6 spacings above, from where it falls at 1 m/s2
    lid.friction = GP_WALL_FREE_SLIP;
    lid.normal_pressure = 100;
    lid.mass_per_length = 100;
    const int32_t id = sim.add(lid);
    EXPECT_EQ(at_rest_at(sim, 0.001), 0) << "nothing bears it yet, though it hardly moves";
    for (int k = 1; k <= 5; ++k)
        EXPECT_EQ(at_rest_at(sim, 0.02 * k), 0) << k;
    EXPECT_EQ(sim.load(id).fy, 0) << "it still falls";
    EXPECT_EQ(at_rest_at(sim, 5), 1);
    EXPECT_NEAR(sim.load(id).fy, 100 * columns * spacing, 0.05 * 100 * columns * spacing);
}
