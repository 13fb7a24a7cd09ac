// Materials, columns, sets of particles and plates: what is refused, naming which field; what is added.
#include "api_support.hpp"

using namespace api;

namespace {

template <class T> struct Number {
    const char *name;
    double T::*member;
    std::vector<double> bad, good; // NaN and the infinities are bad for every field
};

// Adds `valid` with one field changed; each refusal names the field and leaves the simulation as it was.
template <class T, class Add> void check_numbers(const std::vector<Number<T>> &numbers, const T &valid, Add add) {
    Sim sim;
    const uint64_t epoch = sim.epoch();
    for (const Number<T> &field : numbers) {
        std::vector<double> bad = field.bad;
        bad.insert(bad.end(), {not_a_number, infinite, -infinite});
        for (const double value : bad) {
            SCOPED_TRACE(testing::Message() << field.name << " = " << value);
            T changed = valid;
            changed.*field.member = value;
            int32_t id = 55;
            EXPECT_FAILS(add(sim, &changed, &id), GP_E_ARGUMENT, field.name);
            EXPECT_EQ(id, 0);
        }
    }
    EXPECT_EQ(sim.epoch(), epoch);
    EXPECT_EQ(sim.count(), 0);
    for (const Number<T> &field : numbers)
        for (const double value : field.good) {
            SCOPED_TRACE(testing::Message() << field.name << " = " << value);
            T changed = valid;
            changed.*field.member = value;
            EXPECT_EQ(add(sim, &changed, nullptr), GP_OK) << gp_last_error();
        }
}

gp_plate coulomb(double mu) {
    gp_plate plate = make_floor();
    plate.friction = GP_WALL_COULOMB;
    plate.wall_mu = mu;
    return plate;
}

// A plate that follows a table: fixed arrays, so that a test may change single knots.
struct TablePlate {
    std::vector<double> t{0, 0.1, 0.3}, x{0, 0.05, 0.05}, y{0, 0, 0.1};
    gp_plate plate() const {
        gp_plate plate = make_floor();
        plate.n_knots = static_cast<int64_t>(t.size());
        plate.knot_t = t.data();
        plate.knot_x = x.data();
        plate.knot_y = y.data();
        return plate;
    }
};

} // namespace

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

// --------------------------------------------------------------------------------------------------- plate

TEST(Plate, DefaultIsAFixedNoSlipPlate) {
    gp_plate p;
    ASSERT_EQ(gp_plate_init(&p, sizeof p), GP_OK);
    EXPECT_EQ(p.struct_size, sizeof p);
    EXPECT_EQ(p.friction, GP_WALL_NO_SLIP);
    for (const double value : {p.wall_mu, p.vx, p.vy, p.normal_pressure, p.mass_per_length})
        EXPECT_EQ(value, 0);
    EXPECT_EQ(p.n_knots, 0);
    EXPECT_TRUE(!p.knot_t && !p.knot_x && !p.knot_y);
    Sim sim;
    EXPECT_FAILS(gp_add_plate(sim, &p, nullptr), GP_E_ARGUMENT, "gp_plate"); // its ends are to be set
}

TEST(Plate, EveryNumberIsChecked) {
    const std::vector<Number<gp_plate>> numbers = {
        {"x0", &gp_plate::x0, {}, {3}},
        {"y0", &gp_plate::y0, {}, {3}},
        {"x1", &gp_plate::x1, {}, {-3}},
        {"y1", &gp_plate::y1, {}, {-3}},
        {"wall_mu", &gp_plate::wall_mu, {-0.1}, {0, 0.5, 10}},
        {"vx", &gp_plate::vx, {}, {1}},
        {"vy", &gp_plate::vy, {}, {-1}},
        {"normal_pressure", &gp_plate::normal_pressure, {-100}, {0}},
        {"mass_per_length", &gp_plate::mass_per_length, {-1, 2}, {0}}, // only with normal_pressure
    };
    check_numbers(numbers, coulomb(0.3), gp_add_plate);
}

TEST(Plate, EndsHaveToDiffer) {
    Sim sim;
    gp_plate plate = make_plate(0.3, 0.2, 0.3, 0.2);
    EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "gp_plate");
    plate.x0 = -1e308;
    plate.x1 = 1e308; // a length beyond all numbers
    EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "gp_plate");
}

TEST(Plate, ChoicesAreChecked) {
    Sim sim;
    for (const int32_t friction : {-1, 3}) {
        gp_plate plate = make_floor();
        plate.friction = friction;
        EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "friction");
    }
    for (const int32_t friction : {GP_WALL_NO_SLIP, GP_WALL_FREE_SLIP}) {
        gp_plate plate = coulomb(0.3);
        plate.friction = friction;
        EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "wall_mu");
    }
    for (const int64_t n : {int64_t(-1), INT64_MIN}) {
        gp_plate plate = TablePlate().plate();
        plate.n_knots = n;
        EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "n_knots");
    }
    EXPECT_EQ(sim.add(make_floor()), 0) << "the refused ones were not counted";
}

TEST(Plate, LoadsAreChecked) {
    Sim sim;
    gp_plate plate = make_floor();
    plate.normal_pressure = 100;
    plate.vx = 0.1; // along the floor: prescribed
    int32_t id = 9;
    EXPECT_EQ(gp_add_plate(sim, &plate, &id), GP_OK) << gp_last_error();
    EXPECT_EQ(id, 0);
    EXPECT_FAILS(gp_set_plate_velocity(sim, id, 0, 0.1), GP_E_ARGUMENT, "velocity");
    EXPECT_EQ(gp_set_plate_velocity(sim, id, 0.2, 0), GP_OK);
    plate.vy = 0.1; // along its normal: the load's business
    EXPECT_FAILS(gp_add_plate(sim, &plate, &id), GP_E_ARGUMENT, "gp_plate velocity");
    plate = make_floor();
    plate.normal_pressure = 100;
    const double t = 0, x = 0;
    plate.n_knots = 1;
    plate.knot_t = &t;
    plate.knot_x = plate.knot_y = &x;
    EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "n_knots");
}

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

TEST(Plate, TableIsChecked) {
    Sim sim;
    const auto refuse = [&](const gp_plate &plate, const char *name) {
        EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, name);
    };
    const TablePlate valid;
    for (int k = 0; k < 2; ++k) {
        gp_plate plate = valid.plate();
        (k == 0 ? plate.vx : plate.vy) = 1;
        refuse(plate, k == 0 ? "vx" : "vy");
    }
    for (int k = 0; k < 3; ++k) {
        gp_plate plate = valid.plate();
        (k == 0 ? plate.knot_t : k == 1 ? plate.knot_x : plate.knot_y) = nullptr;
        refuse(plate, k == 0 ? "knot_t" : k == 1 ? "knot_x" : "knot_y");
    }
    for (const double value : {not_a_number, infinite, -infinite})
        for (const std::size_t knot : {0u, 2u}) {
            TablePlate table;
            table.t[knot] = value;
            refuse(table.plate(), "knot_t");
            table = TablePlate();
            table.x[knot] = value;
            refuse(table.plate(), "knot_x");
            table = TablePlate();
            table.y[knot] = value;
            refuse(table.plate(), "knot_y");
        }
    TablePlate table;
    table.t = {0, 0.1, 0.1};
    refuse(table.plate(), "knot_t");
    table.t = {0, 0.1, 0.05};
    refuse(table.plate(), "knot_t");
    EXPECT_EQ(sim.add(valid.plate()), 0);
}

TEST(Plate, ArraysOfAnEmptyTableAreNotRead) {
    Sim sim;
    gp_plate plate = make_floor();
    plate.vx = 1;
    plate.knot_t = plate.knot_x = plate.knot_y = reinterpret_cast<const double *>(8);
    EXPECT_EQ(sim.add(plate), 0);
}

TEST(Plate, FollowsItsVelocityOrItsTable) {
    Sim sim;
    gp_plate plate = make_plate(6, 5, 4, 5);
    plate.vx = 0.5;
    plate.vy = -2;
    sim.add(plate);
    {
        TablePlate table; // gone when the plate moves: its input was copied
        gp_plate p = table.plate();
        p.y0 = p.y1 = 7;
        sim.add(p);
        table.x.assign(3, 99.0);
    }
    sim.add({0.0}, {0.0});
    const auto expect_at = [&](double time, double x1, double y1) {
        ASSERT_EQ(gp_run(sim, time), GP_OK) << gp_last_error();
        EXPECT_NEAR(sim.load(0).dx, 0.5 * time, 1e-12);
        EXPECT_NEAR(sim.load(0).dy, -2 * time, 1e-12);
        EXPECT_NEAR(sim.load(1).dx, x1, 1e-12);
        EXPECT_NEAR(sim.load(1).dy, y1, 1e-12);
    };
    expect_at(0.05, 0.025, 0);
    expect_at(0.1, 0.05, 0);
    expect_at(0.2, 0.05, 0.05);
    expect_at(0.3, 0.05, 0.1);
    expect_at(0.4, 0.05, 0.1);
}

TEST(PlateVelocity, IsChecked) {
    Sim sim;
    EXPECT_FAILS(gp_set_plate_velocity(sim, 0, 0, 0), GP_E_ARGUMENT, "plate");
    sim.add(make_floor());
    for (const int32_t plate : {-1, 1, INT32_MAX})
        EXPECT_FAILS(gp_set_plate_velocity(sim, plate, 0, 0), GP_E_ARGUMENT, "plate");
    for (const double value : {not_a_number, infinite, -infinite}) {
        EXPECT_FAILS(gp_set_plate_velocity(sim, 0, value, 0), GP_E_ARGUMENT, "vx");
        EXPECT_FAILS(gp_set_plate_velocity(sim, 0, 0, value), GP_E_ARGUMENT, "vy");
    }
    EXPECT_EQ(gp_set_plate_velocity(sim, 0, 1, -1), GP_OK);
}

TEST(PlateVelocity, TakesOverFromWhereThePlateIs) {
    Sim sim;
    TablePlate table;
    table.t = {0, 1};
    table.x = {0, 1};
    table.y = {0, 2};
    sim.add(table.plate());
    sim.add({0.0}, {1.0});
    ASSERT_EQ(gp_run(sim, 0.5), GP_OK);
    ASSERT_EQ(gp_set_plate_velocity(sim, 0, 0, -1), GP_OK);
    EXPECT_NEAR(sim.load(0).dx, 0.5, 1e-12);
    EXPECT_NEAR(sim.load(0).dy, 1, 1e-12);
    ASSERT_EQ(gp_run(sim, 0.75), GP_OK);
    EXPECT_NEAR(sim.load(0).dx, 0.5, 1e-12);
    EXPECT_NEAR(sim.load(0).dy, 0.75, 1e-12);
    ASSERT_EQ(gp_set_plate_velocity(sim, 0, 4, 0), GP_OK);
    ASSERT_EQ(gp_run(sim, 1), GP_OK);
    EXPECT_NEAR(sim.load(0).dx, 1.5, 1e-12);
    EXPECT_NEAR(sim.load(0).dy, 0.75, 1e-12);
}

TEST(PlateVelocity, ReplacesAConstantVelocityBeforeTheStart) {
    Sim sim;
    gp_plate plate = make_plate(6, 5, 4, 5);
    plate.vx = 3;
    sim.add(plate);
    sim.add({0.0}, {0.0});
    ASSERT_EQ(gp_set_plate_velocity(sim, 0, -1, 0), GP_OK);
    ASSERT_EQ(gp_run(sim, 0.1), GP_OK);
    EXPECT_NEAR(sim.load(0).dx, -0.1, 1e-12);
}

// A table need not begin at zero: the plate is where its table has put it when the host takes over before the start.
TEST(PlateVelocity, TakesOverFromWhereTheTableBegins) {
    Sim sim;
    TablePlate table;
    table.x = {0.2, 0.3, 0.3};
    table.y = {0.1, 0.1, 0.1};
    sim.add(table.plate());
    sim.add({0.0}, {1.0});
    EXPECT_DOUBLE_EQ(sim.load(0).dx, 0.2);
    ASSERT_EQ(gp_set_plate_velocity(sim, 0, 1, 0), GP_OK);
    EXPECT_DOUBLE_EQ(sim.load(0).dx, 0.2);
    EXPECT_DOUBLE_EQ(sim.load(0).dy, 0.1);
    ASSERT_EQ(gp_run(sim, 0.1), GP_OK);
    EXPECT_NEAR(sim.load(0).dx, 0.3, 1e-12);
    EXPECT_NEAR(sim.load(0).dy, 0.1, 1e-12);
}
