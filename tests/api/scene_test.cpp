// Materials, columns and sets of particles: what is refused, naming which field; what is added. Plates: plate_test.cpp.
#include "numbers_support.hpp"

using namespace api;

// ------------------------------------------------------------------------------------------------ material

TEST(Material, DefaultsAreGlassBeads) {
    const gp_material m = make_material();
    const double degree = std::acos(-1.0) / 180;
    EXPECT_EQ(m.struct_size, sizeof m);
    EXPECT_EQ(m.grain_density, 2500);
    EXPECT_EQ(m.volume_fraction, 0.62);
    EXPECT_EQ(m.grain_diameter, 0.002);
    EXPECT_DOUBLE_EQ(m.mu_s, std::tan(21 * degree));
    EXPECT_DOUBLE_EQ(m.mu_2, std::tan(32 * degree));
    EXPECT_EQ(m.i0, 0.3);
}

TEST(Material, EveryNumberIsChecked) {
    const std::vector<Number<gp_material>> numbers = {
        {"grain_density", &gp_material::grain_density, {0, -2500}, {1, 8000}},
        {"volume_fraction", &gp_material::volume_fraction, {0, -0.1, 1.01}, {1e-3, 1}},
        {"grain_diameter", &gp_material::grain_diameter, {0, -0.001}, {1e-6}},
        {"mu_s", &gp_material::mu_s, {-0.1}, {0, 0.1}},
        {"mu_2", &gp_material::mu_2, {0.1, -0.5}, {2}},
        {"i0", &gp_material::i0, {0, -0.3}, {1e-3}},
    };
    check_numbers(numbers, make_material(), gp_add_material);
}

TEST(Material, Mu2MayEqualMuS) {
    Sim sim;
    gp_material material = make_material();
    material.mu_2 = material.mu_s;
    EXPECT_EQ(sim.add(material), 1);
    material.mu_2 = std::nextafter(material.mu_s, 0.0);
    EXPECT_FAILS(gp_add_material(sim, &material, nullptr), GP_E_ARGUMENT, "mu_2");
}

TEST(Material, MaterialZeroExistsFromTheStart) {
    Sim sim;
    EXPECT_EQ(sim.add(make_column(2, 2)), 0);
    EXPECT_EQ(sim.add(make_material()), 1);
    EXPECT_EQ(sim.add(make_material()), 2);
}

TEST(Material, ColumnsTakeTheirDensityFromIt) {
    Sim sim;
    gp_material heavy = make_material();
    heavy.grain_density = 5000;
    heavy.volume_fraction = 0.5;
    gp_column column = make_column(2, 2, 1, 0);
    column.material = sim.add(heavy);
    sim.add(make_column(2, 2));
    sim.add(column);
    const std::vector<double> density = sim.field(GP_FIELD_DENSITY);
    EXPECT_DOUBLE_EQ(density.front(), 0.62 * 2500);
    EXPECT_DOUBLE_EQ(density.back(), 0.5 * 5000);
}

// -------------------------------------------------------------------------------------------------- column

TEST(Column, EveryNumberIsChecked) {
    const std::vector<Number<gp_column>> numbers = {
        {"x_min", &gp_column::x_min, {}, {-3, 0.123}},
        {"y_min", &gp_column::y_min, {}, {-3, 0.123}},
        {"width", &gp_column::width, {0, -0.1, 0.4 * spacing, 1e300}, {spacing, 0.9 * spacing}},
        {"height", &gp_column::height, {0, -0.1, 0.4 * spacing, 1e300}, {spacing, 0.9 * spacing}},
        {"vx", &gp_column::vx, {}, {-1, 2}},
        {"vy", &gp_column::vy, {}, {-1, 2}},
    };
    check_numbers(numbers, make_column(3, 3), gp_add_column);
}

TEST(Column, ChoicesAreChecked) {
    Sim sim;
    sim.add(make_material());
    for (const int32_t material : {-1, 2, INT32_MAX}) {
        gp_column column = make_column(2, 2);
        column.material = material;
        EXPECT_FAILS(gp_add_column(sim, &column, nullptr), GP_E_ARGUMENT, "material");
    }
    for (const int32_t pressure : {-1, 2}) {
        gp_column column = make_column(2, 2);
        column.initial_pressure = pressure;
        EXPECT_FAILS(gp_add_column(sim, &column, nullptr), GP_E_ARGUMENT, "initial_pressure");
    }
    EXPECT_EQ(sim.count(), 0);
    gp_column column;
    ASSERT_EQ(gp_column_init(&column, sizeof column), GP_OK);
    EXPECT_FAILS(gp_add_column(sim, &column, nullptr), GP_E_ARGUMENT, "width");
}

// More than the library can number: refused before any memory is asked for.
TEST(Column, TooManyParticlesAreRefused) {
    Sim sim;
    gp_column column = make_column(1, 1);
    column.width = 1000;
    column.height = 1000;
    EXPECT_EQ(gp_add_column(sim, &column, nullptr), GP_E_ARGUMENT) << gp_last_error();
    EXPECT_EQ(sim.count(), 0);
}

TEST(Column, ParticlesStandOnTheLatticeRowByRow) {
    Sim sim;
    gp_column column = make_column(4, 3, 0.2, -0.1);
    column.vx = 0.5;
    column.vy = -0.25;
    sim.add(column);
    const std::vector<double> x = sim.field(GP_FIELD_X), y = sim.field(GP_FIELD_Y);
    ASSERT_EQ(x.size(), 12u);
    for (std::size_t k = 0; k < 12; ++k) {
        EXPECT_NEAR(x[k], 0.2 + (static_cast<double>(k % 4) + 0.5) * spacing, 1e-15);
        EXPECT_NEAR(y[k], -0.1 + (static_cast<double>(k / 4) + 0.5) * spacing, 1e-15);
        EXPECT_EQ(sim.field(GP_FIELD_VX)[k], 0.5);
        EXPECT_EQ(sim.field(GP_FIELD_VY)[k], -0.25);
        EXPECT_EQ(sim.field(GP_FIELD_ID)[k], static_cast<double>(k));
    }
}

TEST(Column, SizeIsRoundedToWholeSpacings) {
    Sim sim;
    gp_column column = make_column(4, 3);
    column.width = 4.4 * spacing;
    column.height = 2.6 * spacing;
    sim.add(column);
    EXPECT_EQ(sim.count(), 12);
}

TEST(Column, HydrostaticPressureNeedsASupportingPlate) {
    const double rho_g = 0.62 * 2500 * 9.81;
    Sim sim;
    sim.add(make_floor(0.05)); // below the first column only
    sim.add(make_column(5, 10, -0.025, 0));
    sim.add(make_column(5, 10, 1, 0));
    gp_column column = make_column(5, 10, -0.025, 0.5);
    column.initial_pressure = GP_INITIAL_NONE;
    sim.add(column);
    const std::vector<double> p = sim.field(GP_FIELD_PRESSURE), y = sim.field(GP_FIELD_Y);
    for (std::size_t k = 0; k < 50; ++k) {
        EXPECT_NEAR(p[k], rho_g * (10 * spacing - y[k]), 1e-9 * rho_g);
        EXPECT_EQ(p[k + 50], 0);
        EXPECT_EQ(p[k + 100], 0);
    }
    // The density belongs to it: p = c^2 (rho - rho_0).
    const double c = sim.state().sound_speed;
    EXPECT_NEAR(c * c * (sim.field(GP_FIELD_DENSITY)[0] - 0.62 * 2500), p[0], 1e-6 * p[0]);
}

TEST(Column, PressureNoneIsNoneOnAFloor) {
    Sim sim;
    sim.add(make_floor());
    gp_column column = make_column(5, 5);
    column.initial_pressure = GP_INITIAL_NONE;
    sim.add(column);
    for (const double p : sim.field(GP_FIELD_PRESSURE))
        EXPECT_EQ(p, 0);
}

TEST(Column, CountsTogetherWithSetsOfParticles) {
    Sim sim;
    EXPECT_EQ(sim.add(make_column(2, 2)), 0);
    EXPECT_EQ(sim.add({1.0, 1.1}, {0.0, 0.0}), 1);
    EXPECT_EQ(sim.add(make_column(1, 1, 2, 0)), 2);
    EXPECT_EQ(sim.field(GP_FIELD_COLUMN), (std::vector<double>{0, 0, 0, 0, 1, 1, 2}));
    EXPECT_EQ(sim.field(GP_FIELD_ID), (std::vector<double>{0, 1, 2, 3, 4, 5, 6}));
}

// ----------------------------------------------------------------------------------------------- particles

TEST(Particles, ArgumentsAreChecked) {
    Sim sim;
    const double good[3] = {0, 0.1, 0.2};
    int32_t id = 7;
    EXPECT_FAILS(gp_add_particles(sim, -1, 3, good, good, nullptr, nullptr, &id), GP_E_ARGUMENT, "material");
    EXPECT_EQ(id, 0);
    EXPECT_FAILS(gp_add_particles(sim, 1, 3, good, good, nullptr, nullptr, nullptr), GP_E_ARGUMENT, "material");
    for (const int64_t n : {int64_t(-1), INT64_MIN, INT64_MAX, int64_t(1) << 32})
        EXPECT_FAILS(gp_add_particles(sim, 0, n, good, good, nullptr, nullptr, nullptr), GP_E_ARGUMENT, "n = ");
    EXPECT_FAILS(gp_add_particles(sim, 0, 3, nullptr, good, nullptr, nullptr, nullptr), GP_E_ARGUMENT, "x");
    EXPECT_FAILS(gp_add_particles(sim, 0, 3, good, nullptr, nullptr, nullptr, nullptr), GP_E_ARGUMENT, "y");
    EXPECT_FAILS(gp_add_particles(sim, 0, 3, good, good, good, nullptr, nullptr), GP_E_ARGUMENT, "vy");
    EXPECT_FAILS(gp_add_particles(sim, 0, 3, good, good, nullptr, good, nullptr), GP_E_ARGUMENT, "vx");
    for (const double value : {not_a_number, infinite, -infinite}) {
        const double bad[3] = {0, 0.1, value};
        EXPECT_FAILS(gp_add_particles(sim, 0, 3, bad, good, nullptr, nullptr, nullptr), GP_E_ARGUMENT, "x[2]");
        EXPECT_FAILS(gp_add_particles(sim, 0, 3, good, bad, nullptr, nullptr, nullptr), GP_E_ARGUMENT, "y[2]");
        EXPECT_FAILS(gp_add_particles(sim, 0, 3, good, good, bad, good, nullptr), GP_E_ARGUMENT, "vx[2]");
        EXPECT_FAILS(gp_add_particles(sim, 0, 3, good, good, good, bad, nullptr), GP_E_ARGUMENT, "vy[2]");
    }
    EXPECT_EQ(sim.count(), 0);
}

TEST(Particles, AreTakenAsTheyAre) {
    Sim sim;
    std::vector<double> x{0.5, -0.5, 0.1}, y{1, 2, 3}, vx{0.1, 0.2, 0.3}, vy{-1, -2, -3};
    ASSERT_EQ(gp_add_particles(sim, 0, 3, x.data(), y.data(), vx.data(), vy.data(), nullptr), GP_OK);
    const auto x0 = x, y0 = y, vx0 = vx, vy0 = vy;
    for (auto *values : {&x, &y, &vx, &vy})
        values->assign(3, 99.0); // the input was copied
    EXPECT_EQ(sim.field(GP_FIELD_X), x0);
    EXPECT_EQ(sim.field(GP_FIELD_Y), y0);
    EXPECT_EQ(sim.field(GP_FIELD_VX), vx0);
    EXPECT_EQ(sim.field(GP_FIELD_VY), vy0);
}

// -------------------------------------------------------------------------------------------------- period

TEST(Period, HoldsWhatIsAdded) {
    gp_config config = make_config();
    config.periodic_x_min = 0;
    config.periodic_x_max = 20 * config.spacing;
    Sim sim(config);
    gp_column column = make_column(10, 5, 10 * config.spacing);
    EXPECT_EQ(gp_add_column(sim, &column, nullptr), GP_OK) << gp_last_error();
    column.x_min += config.spacing;
    EXPECT_FAILS(gp_add_column(sim, &column, nullptr), GP_E_ARGUMENT, "period");
    const double x = -config.spacing, y = 1;
    EXPECT_FAILS(gp_add_particles(sim, 0, 1, &x, &y, nullptr, nullptr, nullptr), GP_E_ARGUMENT, "x[0]");
    gp_plate plate = make_floor();
    plate.x0 = 20 * config.spacing;
    plate.x1 = 0;
    plate.y0 = plate.y1 = 0;
    EXPECT_EQ(gp_add_plate(sim, &plate, nullptr), GP_OK) << gp_last_error();
    plate.x1 = -config.spacing;
    EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "period");
}
