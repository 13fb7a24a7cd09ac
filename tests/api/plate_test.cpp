// Plates: what is refused, naming which field; how they move, by themselves and driven by the host.
#include "numbers_support.hpp"

using namespace api;

namespace {

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
