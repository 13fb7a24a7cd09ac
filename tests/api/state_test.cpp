// State, surface, interface, loads and the plan.
#include <algorithm>
#include <set>

#include "api_support.hpp"

using namespace api;

// --------------------------------------------------------------------------------------------------- state

TEST(State, OfTheInitialColumn) {
    Sim sim;
    sim.add(make_floor());
    sim.add(make_column(20, 10, 0.5, 0));
    const gp_state s = sim.state();
    const double mass = 200 * spacing * spacing * 0.62 * 2500;
    EXPECT_EQ(s.struct_size, sizeof s);
    EXPECT_EQ(s.time, 0);
    EXPECT_EQ(s.step, 0);
    EXPECT_EQ(s.dt, 0);
    EXPECT_EQ(s.n_particles, 200);
    EXPECT_EQ(s.n_awake, 200);
    EXPECT_EQ(s.kinetic, 0);
    EXPECT_NEAR(s.potential, mass * 9.81 * 5 * spacing, 1e-9);
    EXPECT_GT(s.elastic, 0) << "the column begins compressed by its weight";
    EXPECT_LT(s.elastic, 0.01 * s.potential);
    for (const double value :
         {s.dissipated, s.plate_work, s.momentum_x, s.momentum_y, s.max_speed, s.rms_speed, s.penalty_dissipated,
          s.wall_dissipated, s.bulk_dissipated, s.collision_dissipated, s.wall_seconds})
        EXPECT_EQ(value, 0);
    EXPECT_NEAR(s.energy_error, 0, 1e-12);
    EXPECT_EQ(s.collisions, 0);
    EXPECT_NEAR(s.x_left, 0.5, 1e-12);
    EXPECT_NEAR(s.x_right, 0.7, 1e-12);
    EXPECT_NEAR(s.peak_height, 0.1, 0.5 * spacing);
    EXPECT_GT(s.peak_x, 0.5);
    EXPECT_LT(s.peak_x, 0.7);
    EXPECT_NEAR(s.max_pressure, 0.62 * 2500 * 9.81 * 9.5 * spacing, 1e-6);
}

TEST(State, SumsTheParticles) {
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_run(sim, 0.1), GP_OK);
    const gp_state s = sim.state();
    const gp_particles p = sim.view(GP_FIELD_ALL);
    const double m = spacing * spacing * 0.62 * 2500;
    double kinetic = 0, momentum_x = 0, momentum_y = 0, potential = 0, speed2 = 0, fastest = 0, pressure = 0;
    for (int64_t i = 0; i < p.count; ++i) {
        const double v2 = p.vx[i] * p.vx[i] + p.vy[i] * p.vy[i];
        kinetic += 0.5 * m * v2;
        potential += m * 9.81 * p.y[i];
        momentum_x += m * p.vx[i];
        momentum_y += m * p.vy[i];
        speed2 += v2;
        fastest = std::max(fastest, std::sqrt(v2));
        pressure = std::max(pressure, p.pressure[i]);
    }
    EXPECT_NEAR(s.kinetic, kinetic, 1e-9 * kinetic);
    EXPECT_NEAR(s.potential, potential, 1e-9 * potential);
    EXPECT_NEAR(s.momentum_x, momentum_x, 1e-9);
    EXPECT_NEAR(s.momentum_y, momentum_y, 1e-9);
    EXPECT_NEAR(s.max_speed, fastest, 1e-12);
    EXPECT_NEAR(s.rms_speed, std::sqrt(speed2 / static_cast<double>(p.count)), 1e-12);
    EXPECT_EQ(s.max_pressure, pressure);
    EXPECT_GT(s.wall_seconds, 0);
    EXPECT_GE(s.x_right, s.x_left);
}

// initial kinetic + potential + elastic = kinetic + potential + elastic + dissipated + plate_work + energy_error.
TEST(State, LedgerBalances) {
    Sim sim;
    add_collapse(sim);
    const gp_state first = sim.state();
    const double initial = first.kinetic + first.potential + first.elastic;
    double dissipated = 0;
    for (int k = 0; k < 5; ++k) {
        ASSERT_EQ(gp_step(sim, 60), GP_OK);
        const gp_state s = sim.state();
        EXPECT_NEAR(s.kinetic + s.potential + s.elastic + s.dissipated + s.plate_work + s.energy_error, initial,
                    1e-12 * initial);
        EXPECT_LT(std::abs(s.energy_error), 0.02 * initial);
        EXPECT_GE(s.dissipated, dissipated - 1e-3 * initial);
        dissipated = s.dissipated;
        for (const double part : {s.penalty_dissipated, s.bulk_dissipated, s.collision_dissipated})
            EXPECT_GE(part, -1e-6 * initial);
    }
    EXPECT_GT(dissipated, 0);
}

TEST(State, FrontsAreThoseOfTheLargestConnectedSet) {
    Sim sim;
    sim.add(make_column(10, 5));
    sim.add({5.0, -3.0}, {0.0, 4.0}); // strays
    const gp_state s = sim.state();
    EXPECT_NEAR(s.x_left, 0, 1e-12);
    EXPECT_NEAR(s.x_right, 10 * spacing, 1e-12);
    EXPECT_LT(s.peak_height, 1);
}

// A low heap on a rough floor: motion dies out, and the flag says so.
TEST(State, AtRestIsTold) {
    Sim sim;
    add_collapse(sim, 12, 3);
    EXPECT_EQ(sim.state().at_rest, 0);
    ASSERT_EQ(gp_run(sim, 0.05), GP_OK);
    EXPECT_EQ(sim.state().at_rest, 0);
    int32_t at_rest = 0;
    for (int k = 1; k <= 30 && !at_rest; ++k) {
        ASSERT_EQ(gp_run(sim, 0.05 + 0.1 * k), GP_OK);
        at_rest = sim.state().at_rest;
    }
    EXPECT_EQ(at_rest, 1);
}

// ------------------------------------------------------------------------------------------------- surface

TEST(Surface, IsTheTopOfTheColumnAndZeroBesideIt) {
    Sim sim;
    sim.add(make_floor());
    sim.add(make_column(20, 10));
    const std::vector<double> x = {-0.5, -0.05, 0.05, 0.1, 0.15, 0.25, 100, -1e300, 1e300};
    std::vector<double> height(x.size(), 7);
    ASSERT_EQ(gp_get_surface(sim, static_cast<int64_t>(x.size()), x.data(), height.data()), GP_OK) << gp_last_error();
    for (std::size_t k = 0; k < x.size(); ++k)
        if (x[k] >= 0.05 && x[k] <= 0.15) {
            EXPECT_NEAR(height[k], 0.1, 0.5 * spacing) << x[k];
        } else {
            EXPECT_EQ(height[k], 0) << x[k];
        }
}

TEST(Surface, IsOfTheConnectedDepositOnly) {
    Sim sim;
    sim.add(make_column(20, 10));
    sim.add(make_column(4, 4, 1, 0));
    sim.add(make_column(4, 4, 0.05, 0.5));
    const std::vector<double> x = {0.07, 1.02};
    std::vector<double> height(2);
    ASSERT_EQ(gp_get_surface(sim, 2, x.data(), height.data()), GP_OK);
    EXPECT_NEAR(height[0], 0.1, 0.5 * spacing);
    EXPECT_EQ(height[1], 0);
}

TEST(Surface, ArgumentsAreChecked) {
    Sim sim;
    sim.add(make_column(4, 4));
    double height[2] = {7, 7};
    for (const double value : {not_a_number, infinite, -infinite}) {
        const double x[2] = {0.01, value};
        EXPECT_FAILS(gp_get_surface(sim, 2, x, height), GP_E_ARGUMENT, "x[1]");
    }
    EXPECT_FAILS(gp_get_surface(sim, -1, height, height), GP_E_ARGUMENT, "n = ");
    EXPECT_EQ(height[0], 7);
    EXPECT_EQ(gp_get_surface(sim, 0, nullptr, nullptr), GP_OK);
}

// ----------------------------------------------------------------------------------------------- interface

TEST(Interface, SeparatesTwoColumns) {
    Sim sim;
    sim.add(make_floor());
    sim.add(make_column(8, 10));
    sim.add(make_column(8, 6, 8 * spacing, 0));
    sim.add(make_column(4, 4, 1, 0));
    const double y[4] = {0.02, 0.055, 0.08, 5};
    double x[4];
    ASSERT_EQ(gp_get_interface(sim, 0, 1, 4, y, x), GP_OK) << gp_last_error();
    EXPECT_NEAR(x[0], 8 * spacing, 1e-9);
    EXPECT_NEAR(x[1], 8 * spacing, 1e-9);
    EXPECT_TRUE(std::isnan(x[2])) << "above the lower column";
    EXPECT_TRUE(std::isnan(x[3])) << "above both";
    ASSERT_EQ(gp_get_interface(sim, 1, 2, 1, y, x), GP_OK);
    EXPECT_TRUE(std::isnan(x[0])) << "they do not touch";
}

TEST(Interface, ArgumentsAreChecked) {
    Sim sim;
    sim.add(make_column(4, 4));
    sim.add(make_column(4, 4, 4 * spacing, 0));
    double y = 0.02, x = 7;
    for (const int32_t id : {-1, 2, INT32_MAX, INT32_MIN}) {
        EXPECT_FAILS(gp_get_interface(sim, id, 1, 1, &y, &x), GP_E_ARGUMENT, "left");
        EXPECT_FAILS(gp_get_interface(sim, 0, id, 1, &y, &x), GP_E_ARGUMENT, "right");
    }
    EXPECT_EQ(gp_get_interface(sim, 1, 1, 1, &y, &x), GP_E_ARGUMENT);
    EXPECT_FAILS(gp_get_interface(sim, 0, 1, -1, &y, &x), GP_E_ARGUMENT, "n = ");
    for (const double value : {not_a_number, infinite, -infinite})
        EXPECT_FAILS(gp_get_interface(sim, 0, 1, 1, &value, &x), GP_E_ARGUMENT, "y[0]");
    EXPECT_EQ(x, 7);
    EXPECT_EQ(gp_get_interface(sim, 0, 1, 0, nullptr, nullptr), GP_OK);
}

// ---------------------------------------------------------------------------------------------------- load

TEST(Load, IsZeroBeforeTheFirstStepAndWithoutMaterial) {
    Sim sim;
    sim.add(make_floor());
    sim.add(make_plate(12, 8, 10, 8));
    sim.add(make_column(10, 10));
    const auto expect_none = [&](int32_t plate) {
        const auto load = sim.load(plate);
        for (const double value : {load.fx, load.fy, load.torque, load.dx, load.dy, load.impulse_x, load.impulse_y})
            EXPECT_EQ(value, 0) << plate;
    };
    expect_none(0);
    expect_none(1);
    ASSERT_EQ(gp_step(sim, 5), GP_OK);
    EXPECT_LT(sim.load(0).fy, 0);
    expect_none(1); // far away from all material
}

TEST(Load, IsTheWeightOfAColumnBetweenWalls) {
    Sim sim;
    sim.add(make_floor());
    for (const double x : {0.0, 10 * spacing}) {
        gp_plate wall = x == 0 ? make_left_wall(x, 0.3) : make_right_wall(x, 0.3);
        wall.friction = GP_WALL_FREE_SLIP;
        sim.add(wall);
    }
    sim.add(make_column(10, 10));
    const double weight = 100 * spacing * spacing * 0.62 * 2500 * 9.81;
    double impulse_x = 0, impulse_y = 0;
    for (int k = 0; k < 400; ++k) {
        ASSERT_EQ(gp_step(sim, 1), GP_OK);
        const auto load = sim.load(0);
        const gp_state s = sim.state();
        impulse_x += s.dt * load.fx;
        impulse_y += s.dt * load.fy;
        ASSERT_NEAR(load.impulse_x, impulse_x, 1e-9 * weight);
        ASSERT_NEAR(load.impulse_y, impulse_y, 1e-9 * weight);
        // All of the momentum has come from the weight and the plates.
        double given_x = 0, given_y = 0;
        for (int32_t plate = 0; plate < 3; ++plate) {
            given_x += sim.load(plate).impulse_x;
            given_y += sim.load(plate).impulse_y;
        }
        ASSERT_NEAR(s.momentum_x, -given_x, 1e-9 * weight);
        ASSERT_NEAR(s.momentum_y, -weight * s.time - given_y, 1e-9 * weight);
    }
    EXPECT_NEAR(impulse_y / sim.state().time, -weight, 0.05 * weight);
    // The floor's end 0 is at x = 2: the weight acts 1.95 m to the left of it, counter-clockwise.
    EXPECT_NEAR(sim.load(0).torque, -1.95 * sim.load(0).fy, 0.05 * weight);
    EXPECT_LT(sim.load(1).fx, 0) << "the material presses the left wall to the left";
    EXPECT_GT(sim.load(2).fx, 0);
    for (int32_t plate = 1; plate < 3; ++plate)
        EXPECT_NEAR(sim.load(plate).impulse_y, 0, 0.03 * weight * sim.state().time)
            << "free slip: no shear traction, but the forces' reach leaves a share of the order of dl / extent";
}

TEST(Load, IdsAreChecked) {
    Sim sim;
    gp_load none{};
    none.struct_size = sizeof none;
    EXPECT_FAILS(gp_get_plate_load(sim, 0, &none), GP_E_ARGUMENT,
                 "plate = 0: the simulation has none yet, add it first");
    EXPECT_FAILS(gp_get_plate_load(nullptr, 0, &none), GP_E_ARGUMENT, "gp_create");
    sim.add(make_floor());
    for (const int32_t id : {-1, 1, INT32_MAX, INT32_MIN}) {
        gp_load load{};
        load.struct_size = sizeof load;
        EXPECT_FAILS(gp_get_plate_load(sim, id, &load), GP_E_ARGUMENT, "plate");
    }
}

// ---------------------------------------------------------------------------------------------------- plan

namespace {

gp_plan_entry entry(const std::vector<gp_plan_entry> &plan, const std::string &name) {
    const auto found = std::find_if(plan.begin(), plan.end(), [&](const gp_plan_entry &e) { return e.name == name; });
    if (found == plan.end())
        throw std::runtime_error("the plan has no " + name);
    return *found;
}

const char *const wall_stages[] = {"wall_velocity", "wall_stress", "wall_contact"};

} // namespace

TEST(Plan, EntriesAreWellFormed) {
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_step(sim, 3), GP_OK);
    const std::vector<gp_plan_entry> plan = sim.plan();
    ASSERT_GT(plan.size(), 10u);
    std::set<std::pair<int32_t, std::string>> names;
    bool fields = false;
    int64_t bytes = 0;
    for (const gp_plan_entry &e : plan) {
        ASSERT_NE(e.name, nullptr);
        ASSERT_NE(e.reason, nullptr);
        SCOPED_TRACE(e.name);
        EXPECT_STRNE(e.name, "");
        EXPECT_STRNE(e.reason, "");
        EXPECT_TRUE(names.insert({e.kind, e.name}).second) << "listed twice";
        EXPECT_TRUE(e.kind == 0 || e.kind == 1);
        EXPECT_FALSE(fields && e.kind == 0) << "stages come first";
        fields = e.kind == 1;
        EXPECT_TRUE(e.active == 0 || e.active == 1);
        EXPECT_GE(e.bytes, 0);
        if (e.kind == 0) {
            EXPECT_EQ(e.bytes, 0);
            if (e.active) {
                EXPECT_EQ(e.calls, 3);
            }
            EXPECT_GE(e.seconds, 0);
        } else {
            EXPECT_EQ(e.seconds, 0);
            EXPECT_EQ(e.calls, 0);
        }
        EXPECT_EQ(e.reserved[0], 0);
        EXPECT_EQ(e.reserved[1], 0);
        bytes += e.bytes;
    }
    EXPECT_TRUE(fields);
    EXPECT_GT(bytes, sim.count() * 8 * 10) << "the fields' memory is told";
}

TEST(Plan, FillsUpToNEntries) {
    Sim sim;
    add_collapse(sim, 3, 3);
    int64_t all = -1;
    ASSERT_EQ(gp_get_plan(sim, 0, nullptr, &all), GP_OK);
    ASSERT_GT(all, 3);
    gp_plan_entry untouched;
    std::memset(&untouched, 0x5a, sizeof untouched);
    for (const int64_t n : {int64_t(1), int64_t(3), all, all + 2}) {
        std::vector<gp_plan_entry> entries(static_cast<std::size_t>(all + 4), untouched);
        int64_t told = -1;
        ASSERT_EQ(gp_get_plan(sim, n, entries.data(), &told), GP_OK);
        EXPECT_EQ(told, all);
        for (int64_t k = 0; k < all + 4; ++k) {
            const bool same = std::memcmp(&entries[static_cast<std::size_t>(k)], &untouched, sizeof untouched) == 0;
            EXPECT_EQ(same, k >= std::min(n, all)) << n << ", " << k;
        }
    }
    gp_plan_entry some;
    int64_t told = 9;
    EXPECT_FAILS(gp_get_plan(sim, -1, &some, &told), GP_E_ARGUMENT, "n = ");
    EXPECT_EQ(told, 0);
}

TEST(Plan, SaysWhatASceneLeavesOut) {
    Sim no_plates, no_particles;
    no_plates.add(make_column(5, 5));
    no_particles.add(make_floor());
    for (const char *stage : wall_stages) {
        const gp_plan_entry e = entry(no_plates.plan(), stage);
        EXPECT_EQ(e.active, 0) << stage;
        EXPECT_NE(std::string(e.reason).find("no plates"), std::string::npos) << e.reason;
    }
    EXPECT_EQ(entry(no_plates.plan(), "move_plates").active, 0);
    EXPECT_EQ(entry(no_plates.plan(), "force").active, 1);
    EXPECT_EQ(entry(no_particles.plan(), "force").active, 0);
    EXPECT_NE(std::string(entry(no_particles.plan(), "force").reason).find("no particles"), std::string::npos);

    gp_config config = make_config();
    config.collision_distance = 0;
    Sim no_collisions(config);
    no_collisions.add(make_column(5, 5));
    EXPECT_EQ(entry(no_collisions.plan(), "collide").active, 0);
    EXPECT_NE(std::string(entry(no_collisions.plan(), "collide").reason).find("collision_distance"), std::string::npos);
    EXPECT_EQ(entry(no_plates.plan(), "collide").active, 1);
    ASSERT_EQ(gp_step(no_collisions, 2), GP_OK);
    EXPECT_EQ(entry(no_collisions.plan(), "collide").calls, 0);

    // The traction of a rough plate is a law of friction, too: only what slips freely, or has a wall_mu of 0, needs none.
    const auto friction_of = [](int32_t friction, double wall_mu) {
        Sim sim;
        gp_plate floor = make_floor();
        floor.friction = friction;
        floor.wall_mu = wall_mu;
        sim.add(floor);
        sim.add(make_column(3, 3));
        return entry(sim.plan(), "wall_friction");
    };
    EXPECT_EQ(friction_of(GP_WALL_NO_SLIP, 0).active, 1);
    EXPECT_EQ(friction_of(GP_WALL_COULOMB, 0.3).active, 1);
    for (const int32_t friction : {GP_WALL_FREE_SLIP, GP_WALL_COULOMB}) {
        const gp_plan_entry e = friction_of(friction, 0);
        EXPECT_EQ(e.active, 0) << friction;
        EXPECT_NE(std::string(e.reason).find("no plate has friction"), std::string::npos) << e.reason;
    }
}

// A gate beside a falling column goes away by its table: then nothing moves and no plate is near, and the engine has
// nothing to do for plates.
TEST(Plan, AGateThatHasLeftCostsNothing) {
    Sim sim;
    gp_plate gate = make_right_wall(10 * spacing, 0.2);
    const double t[2] = {0, 0.05}, x[2] = {0, 3}, y[2] = {0, 0};
    gate.n_knots = 2;
    gate.knot_t = t;
    gate.knot_x = x;
    gate.knot_y = y;
    sim.add(gate);
    sim.add(make_column(10, 10));
    EXPECT_EQ(entry(sim.plan(), "move_plates").active, 1);
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    for (const char *stage : wall_stages)
        EXPECT_EQ(entry(sim.plan(), stage).active, 1) << stage;
    ASSERT_EQ(gp_run(sim, 0.06), GP_OK);
    const std::vector<gp_plan_entry> before = sim.plan();
    EXPECT_EQ(entry(before, "move_plates").active, 0) << entry(before, "move_plates").reason;
    for (const char *stage : wall_stages)
        EXPECT_EQ(entry(before, stage).active, 0) << stage;
    ASSERT_EQ(gp_step(sim, 10), GP_OK);
    const std::vector<gp_plan_entry> after = sim.plan();
    EXPECT_EQ(entry(after, "move_plates").calls, entry(before, "move_plates").calls);
    for (const char *stage : wall_stages)
        EXPECT_EQ(entry(after, stage).calls, entry(before, stage).calls) << stage;
    EXPECT_EQ(entry(after, "force").calls, entry(before, "force").calls + 10);
    EXPECT_GT(entry(after, "force").seconds, entry(before, "force").seconds);

    // Driven by the host, it moves again.
    ASSERT_EQ(gp_set_plate_velocity(sim, 0, -1, 0), GP_OK);
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    EXPECT_EQ(entry(sim.plan(), "move_plates").active, 1);
    EXPECT_GT(entry(sim.plan(), "move_plates").calls, entry(after, "move_plates").calls);
}

TEST(Plan, SecondsAndCallsGrow) {
    Sim sim;
    add_collapse(sim);
    for (const gp_plan_entry &e : sim.plan()) {
        EXPECT_EQ(e.calls, 0) << e.name;
        EXPECT_EQ(e.seconds, 0) << e.name;
    }
    double seconds = 0;
    for (int k = 1; k <= 3; ++k) {
        ASSERT_EQ(gp_step(sim, 20), GP_OK);
        double sum = 0;
        for (const gp_plan_entry &e : sim.plan())
            sum += e.seconds;
        EXPECT_EQ(entry(sim.plan(), "gradient").calls, 20 * k);
        EXPECT_GT(sum, seconds);
        EXPECT_NEAR(sum, sim.state().wall_seconds, 0.1 * sum) << "the stages are all that a step does";
        seconds = sum;
    }
}
