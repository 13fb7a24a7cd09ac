// Blows, and plates that move fast, leave, close on material or stand in its midst.
#include "extreme_support.hpp"

using namespace test;

namespace {

constexpr double dl = 0.005;

} // namespace

// A block of 8 x 8 falls on a floor at v: the pressure is that of a compression wave, rho c v, c that of uniaxial strain.
TEST(Impact, IsTheWaterHammerAndComesToRest) {
    for (const double speed : {1., 10., 100.}) {
        SCOPED_TRACE(speed);
        Sim sim(config(dl));
        sim.column(-4 * dl, 5 * dl, 8 * dl, 8 * dl, 0, 0, -speed);
        sim.add(floor_at(0, -200 * dl, 200 * dl));
        const gp_state start = sim.state();
        const double energy = start.kinetic + start.potential;
        double peak = 0, highest = 0;
        gp_state s{};
        const double wave = 1550 * start.sound_speed * std::sqrt(1.3) * speed;
        for (int k = 0; k < 400; ++k) {
            sim.step(2);
            s = sim.state();
            peak = std::max(peak, s.max_pressure);
            highest = std::max(highest, s.kinetic + s.potential + s.elastic);
        }
        EXPECT_LT(peak, 1.2 * wave);
        EXPECT_GT(peak, 0.8 * wave);
        EXPECT_LT(highest, 1.001 * energy);
        EXPECT_LT(s.kinetic, 0.5 * start.kinetic);
        expect_finite(sim);
        for (const double y : sim.field(GP_FIELD_Y))
            EXPECT_GT(y, 0);
        if (speed < 5) {
            s = run_to_rest(sim, 0.1, 3);
            EXPECT_EQ(s.at_rest, 1);
        }
    }
}

TEST(Impact, OnADepositComesToRest) {
    Sim sim(config(dl));
    sim.column(-8 * dl, 0, 16 * dl, 5 * dl);
    sim.column(-3 * dl, 10 * dl, 6 * dl, 6 * dl, 0, 0, -5);
    for (const gp_plate &p :
         {floor_at(0, -30 * dl, 30 * dl), plate(-8 * dl, 0, -8 * dl, 1), plate(8 * dl, 1, 8 * dl, 0)})
        sim.add(p);
    const gp_state start = sim.state();
    const double energy = start.kinetic + start.potential + start.elastic;
    const gp_state s = run_to_rest(sim, 0.1, 4);
    EXPECT_EQ(s.at_rest, 1);
    EXPECT_LT(std::abs(s.energy_error), 0.05 * energy);
    expect_finite(sim);
}

// A plate at 10 m/s sweeps a heap along and leaves the scene, 100 of its widths away.
TEST(FastPlate, SweepsAndLeaves) {
    Sim sim(config(dl));
    sim.column(0.02, 0, 8 * dl, 8 * dl);
    sim.add(floor_at(0, -0.1, 2));
    gp_plate ram = plate(0, 0, 0, 8, GP_WALL_FREE_SLIP); // nothing splashes over it
    ram.vx = 10;
    const int32_t swept = sim.add(ram);
    gp_plate gone = plate(-0.01, 0, -0.01, 0.1);
    gone.vx = -10;
    const int32_t left = sim.add(gone);
    sim.run(0.05);
    const gp_state s = sim.state();
    EXPECT_LT(s.plate_work, 0);
    EXPECT_LE(s.kinetic + s.elastic, -s.plate_work * 1.05);
    for (const double x : sim.field(GP_FIELD_X))
        EXPECT_GT(x, sim.load(swept).dx);
    EXPECT_EQ(sim.load(left).fx, 0);
    expect_finite(sim);
    ASSERT_EQ(gp_set_plate_velocity(sim, swept, -10, 0), GP_OK);
    sim.run(0.4); // it leaves, too
    EXPECT_EQ(sim.load(swept).fx, 0);
    expect_finite(sim);
}

// A lid closes on material in a box that is no way out: the pressure is K times the compression (rho / rho0 - 1), but for
// the layers at lid and floor, where the velocity normal to a plate is extrapolated with a limit: of each a share of a
// spacing is not compressed. Driven on to the floor it is not stopped, but leaves numbers: a run to the moment when it has
// passed the floor would take time steps without end.
TEST(ClosingPlates, CompressWithABoundedPressure) {
    const int rows = 16;
    gp_config c = config(dl);
    c.sound_speed = 20;
    Sim sim(c);
    sim.column(0, 0, 8 * dl, rows * dl);
    for (const gp_plate &p : {floor_at(0, -0.1, 0.2, GP_WALL_FREE_SLIP), plate(0, -0.1, 0, 0.2, GP_WALL_FREE_SLIP),
                              plate(8 * dl, 0.2, 8 * dl, -0.1, GP_WALL_FREE_SLIP)})
        sim.add(p);
    gp_plate lid = plate(-0.1, rows * dl, 0.2, rows * dl, GP_WALL_FREE_SLIP);
    lid.vy = -0.2;
    sim.add(lid);
    for (const double squeeze : {0.05, 0.1, 0.2}) {
        sim.run(squeeze * rows * dl / 0.2);
        const gp_state s = sim.state();
        const double modulus = 1550 * s.sound_speed * s.sound_speed, pressure = mean(sim.field(GP_FIELD_PRESSURE));
        EXPECT_NEAR(pressure / modulus, 1 / (1 - squeeze) - 1, 2.0 / rows * (1 / (1 - squeeze) - 1));
        EXPECT_LT(std::abs(s.energy_error), 0.05 * -s.plate_work);
        expect_finite(sim);
    }
    // On to nothing: whatever the status, no NaN and no silence.
    const gp_status status = gp_step(sim, 3000); // at ever shorter time steps
    EXPECT_TRUE(status == GP_OK || (status == GP_E_DIVERGED && *gp_last_error() != 0)) << status;
    EXPECT_EQ(sim.state().n_particles, 8 * rows);
    expect_finite(sim);
}

// A gate of no thickness in the midst of material, and one so short that it has next to no length.
TEST(PlateInTheMidst, LeavesTheRestAtRest) {
    for (const double length : {20 * dl, 1e-5 * dl}) {
        SCOPED_TRACE(length);
        Sim sim(config(dl));
        sim.column(-8 * dl, 0, 16 * dl, 10 * dl);
        for (const gp_plate &p :
             {floor_at(0, -8 * dl, 8 * dl), plate(-8 * dl, 0, -8 * dl, 0.2), plate(8 * dl, 0.2, 8 * dl, 0),
              plate(0, 0, 0, length), plate(0, length, 0, 0)}) // wetted on both sides
            sim.add(p);
        const gp_state s = run_to_rest(sim, 0.1, 1);
        EXPECT_EQ(s.at_rest, 1);
        EXPECT_NEAR(s.peak_height, 10 * dl, 0.2 * dl);
        expect_finite(sim);
    }
    gp_plate none = plate(0, 0, 0, 0);
    Sim sim(config(dl));
    EXPECT_EQ(gp_add_plate(sim, &none, nullptr), GP_E_ARGUMENT);
    EXPECT_NE(std::string(gp_last_error()).find("length"), std::string::npos);
}
