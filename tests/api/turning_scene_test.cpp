// Plates of many points, plates that turn, belts: what is refused, naming which argument and which point; where they are.
#include "api_support.hpp"

using namespace api;

namespace {

// A level floor in three segments, from the right to the left, and whatever a test makes of it.
struct Line {
    std::vector<double> x{0.3, 0.1, -0.1, -0.3}, y{0, 0, 0, 0};
    gp_plate plate() && = delete; // it points to this line
    gp_plate plate() const & {
        gp_plate p = make_plate(0, 0, 0, 0);
        p.n_points = static_cast<int64_t>(x.size());
        p.point_x = x.data();
        p.point_y = y.data();
        return p;
    }
};

// A drum about the origin.
Line ring(int count, double radius) {
    Line line;
    line.x.clear();
    line.y.clear();
    for (int k = 0; k <= count; ++k) {
        const double angle = -2 * std::acos(-1.0) * (k % count) / count;
        line.x.push_back(radius * std::cos(angle));
        line.y.push_back(radius * std::sin(angle));
    }
    return line;
}

void expect_refused(Sim &sim, const gp_plate &plate, const std::vector<std::string> &named) {
    int32_t id = 5;
    EXPECT_EQ(gp_add_plate(sim, &plate, &id), GP_E_ARGUMENT);
    EXPECT_EQ(id, 0);
    for (const std::string &text : named)
        EXPECT_TRUE(last_error_has(text)) << gp_last_error() << "\n does not name " << text;
}

} // namespace

TEST(Line, NumberOfPointsIsChecked) {
    Sim sim;
    for (const int64_t n : {int64_t(1), int64_t(-1), INT64_MIN, int64_t(10000001), INT64_MAX}) {
        const Line line;
        gp_plate plate = line.plate();
        plate.n_points = n;
        expect_refused(sim, plate, {"gp_plate.n_points", std::to_string(n), "2 to 10000000"});
    }
    const Line line;
    EXPECT_EQ(sim.add(line.plate()), 0) << "the refused ones were not counted";
}

TEST(Line, PointsAreChecked) {
    Sim sim;
    for (int axis = 0; axis < 2; ++axis) {
        const std::string name = axis == 0 ? "gp_plate.point_x" : "gp_plate.point_y";
        const Line valid;
        gp_plate plate = valid.plate();
        (axis == 0 ? plate.point_x : plate.point_y) = nullptr;
        expect_refused(sim, plate, {name, "NULL"});
        for (const std::size_t point : {0u, 2u, 3u})
            for (const double value : {not_a_number, infinite, -infinite}) {
                Line line;
                (axis == 0 ? line.x : line.y)[point] = value;
                expect_refused(sim, line.plate(), {name + "[" + std::to_string(point) + "]"});
            }
    }
}

TEST(Line, SegmentsAreNoShorterThanATenthOfTheSpacing) {
    Sim sim;
    Line line;
    line.x[2] = line.x[1] - 0.0999 * spacing;
    expect_refused(sim, line.plate(), {"gp_plate.point_x[2]", "point_y[2]", "a tenth of the spacing"});
    line.x[2] = line.x[1];
    expect_refused(sim, line.plate(), {"point_x[2]", "0 m from the point before"});
    line.x[2] = line.x[1] - 0.1001 * spacing;
    EXPECT_EQ(sim.add(line.plate()), 0);
}

TEST(Line, DoesNotCrossTouchOrFoldBack) {
    Sim sim;
    const std::string expected = "does not cross, touch or fold back";
    Line crossing;
    crossing.x = {0.3, -0.3, -0.3, 0.1, 0.1};
    crossing.y = {0, 0, 0.2, 0.2, -0.2};
    expect_refused(sim, crossing.plate(), {"point_x, point_y", "point 0", "point 3", expected});
    Line touching = crossing;
    touching.y.back() = 0; // its last point on its first segment
    expect_refused(sim, touching.plate(), {"point 0", "point 3", expected});
    Line corner = crossing;
    corner.x.back() = -0.3; // the last point on an earlier one
    corner.y.back() = 0;
    expect_refused(sim, corner.plate(), {"point 3", expected});
    Line folded;
    folded.x = {0.3, -0.3, 0.1};
    folded.y = {0, 0, 0};
    expect_refused(sim, folded.plate(), {"point 0", "point 1", expected});
    Line there_and_back;
    there_and_back.x = {0.3, -0.3, 0.3}; // closed, without an inside
    there_and_back.y = {0, 0, 0};
    expect_refused(sim, there_and_back.plate(), {expected});
    Line eight; // closed, and crosses itself
    eight.x = {0, 0.2, 0.2, 0, 0};
    eight.y = {0, 0.2, 0, 0.2, 0};
    expect_refused(sim, eight.plate(), {"point 0", "point 2", expected});
    const Line drum = ring(12, 0.1), triangle = ring(3, 0.1);
    EXPECT_EQ(sim.add(drum.plate()), 0) << "a closed line meets itself at its first point only";
    EXPECT_EQ(sim.add(triangle.plate()), 1);
    Line spiral; // near to itself, and allowed
    spiral.x.clear();
    spiral.y.clear();
    for (int k = 0; k < 200; ++k) {
        const double angle = 0.2 * k, radius = 0.05 + 0.02 * angle / (2 * std::acos(-1.0));
        spiral.x.push_back(radius * std::cos(angle));
        spiral.y.push_back(radius * std::sin(angle));
    }
    EXPECT_EQ(sim.add(spiral.plate()), 2);
}

TEST(Line, OfPointsHasNoEndsOfItsOwn) {
    Sim sim;
    double gp_plate::*const ends[] = {&gp_plate::x0, &gp_plate::y0, &gp_plate::x1, &gp_plate::y1};
    const char *names[] = {"gp_plate.x0", "gp_plate.y0", "gp_plate.x1", "gp_plate.y1"};
    for (int k = 0; k < 4; ++k) {
        const Line line;
        gp_plate plate = line.plate();
        plate.*ends[k] = 0.1;
        expect_refused(sim, plate, {names[k], "0 for a plate with n_points"});
    }
    // Without n_points the arrays are not read.
    gp_plate plate = make_floor();
    plate.point_x = plate.point_y = reinterpret_cast<const double *>(8);
    EXPECT_EQ(sim.add(plate), 0);
}

TEST(Line, HoldsWithinThePeriod) {
    gp_config config = make_config();
    config.periodic_x_max = 0.6;
    config.periodic_x_min = 0;
    Sim sim(config);
    Line line;
    line.x = {0.6, 0.4, 0.2, 0};
    EXPECT_EQ(sim.add(line.plate()), 0);
    line.x[0] = 0.61;
    expect_refused(sim, line.plate(), {"gp_plate from x", "period"});
}

TEST(Line, BearsALoadUnlessItIsClosed) {
    Sim sim;
    const Line line;
    gp_plate plate = line.plate();
    plate.normal_pressure = 100;
    EXPECT_EQ(sim.add(plate), 0);
    const Line closed = ring(12, 0.1);
    plate = closed.plate();
    plate.normal_pressure = 100;
    expect_refused(sim, plate, {"gp_plate.normal_pressure", "0 for a closed line"});
}

TEST(Turn, EveryNumberIsChecked) {
    Sim sim;
    double gp_plate::*const members[] = {&gp_plate::omega, &gp_plate::pivot_x, &gp_plate::pivot_y,
                                         &gp_plate::surface_velocity};
    const char *names[] = {"gp_plate.omega", "gp_plate.pivot_x", "gp_plate.pivot_y", "gp_plate.surface_velocity"};
    for (int k = 0; k < 4; ++k)
        for (const double value : {not_a_number, infinite, -infinite}) {
            gp_plate plate = make_floor();
            plate.*members[k] = value;
            expect_refused(sim, plate, {names[k]});
        }
    for (int k = 0; k < 4; ++k) {
        gp_plate plate = make_floor();
        plate.*members[k] = -0.3;
        EXPECT_EQ(sim.add(plate), k);
    }
}

TEST(Turn, IsEitherConstantOrATableOrALoads) {
    Sim sim;
    const std::vector<double> t{0, 1}, angle{0, 0.5}, way{0, 0.1};
    gp_plate table = make_floor();
    table.n_knots = 2;
    table.knot_t = t.data();
    table.knot_angle = angle.data();
    gp_plate plate = table;
    plate.omega = 1;
    expect_refused(sim, plate, {"gp_plate.omega", "0 when the plate has a table"});
    for (int k = 0; k < 2; ++k) { // one of the displacements
        plate = table;
        (k == 0 ? plate.knot_x : plate.knot_y) = way.data();
        expect_refused(sim, plate, {k == 0 ? "gp_plate.knot_y" : "gp_plate.knot_x", "NULL", "both"});
    }
    plate = table;
    plate.knot_t = nullptr;
    expect_refused(sim, plate, {"gp_plate.knot_t", "NULL"});
    for (const double value : {not_a_number, infinite}) {
        std::vector<double> bad = angle;
        bad[1] = value;
        plate = table;
        plate.knot_angle = bad.data();
        expect_refused(sim, plate, {"gp_plate.knot_angle[1]"});
    }
    plate = make_floor();
    plate.normal_pressure = 100;
    plate.omega = 1;
    expect_refused(sim, plate, {"gp_plate omega = 1", "normal_pressure"});
    plate = table;
    plate.normal_pressure = 100;
    expect_refused(sim, plate, {"gp_plate.n_knots", "normal_pressure"});
    EXPECT_EQ(sim.add(table), 0) << "a table of angles alone";
    table.knot_x = table.knot_y = way.data();
    EXPECT_EQ(sim.add(table), 1);
}

TEST(Turn, HasRoomInThePeriod) {
    gp_config config = make_config();
    config.periodic_x_max = 0.5;
    config.periodic_x_min = 0;
    Sim sim(config);
    const std::vector<double> t{0, 1}, angle{0, 0.5};
    gp_plate plate = make_plate(0.2, 0, 0.2, 0.6); // upright it fits, lying it does not
    EXPECT_EQ(sim.add(plate), 0);
    plate.omega = 1;
    expect_refused(sim, plate, {"gp_plate omega = 1", "0.6 m", "period of 0.5 m"});
    plate.omega = 0;
    plate.n_knots = 2;
    plate.knot_t = t.data();
    plate.knot_angle = angle.data();
    expect_refused(sim, plate, {"gp_plate omega", "period of 0.5 m"});
    EXPECT_FAILS(gp_set_plate_motion(sim, 0, 0, 0, 1), GP_E_ARGUMENT, "omega = 1");
    EXPECT_EQ(gp_set_plate_motion(sim, 0, 0.1, 0, 0), GP_OK);
}

TEST(Belt, NeedsFriction) {
    Sim sim;
    gp_plate plate = make_floor();
    plate.surface_velocity = 0.5;
    plate.friction = GP_WALL_FREE_SLIP;
    expect_refused(sim, plate, {"gp_plate.surface_velocity", "0 for a plate without friction"});
    plate.friction = GP_WALL_COULOMB;
    plate.wall_mu = 0.3;
    EXPECT_EQ(sim.add(plate), 0);
}

TEST(PlateMotion, IsChecked) {
    Sim sim;
    EXPECT_FAILS(gp_set_plate_motion(sim, 0, 0, 0, 0), GP_E_ARGUMENT, "plate");
    EXPECT_EQ(gp_set_plate_motion(nullptr, 0, 0, 0, 0), GP_E_ARGUMENT);
    sim.add(make_floor());
    gp_plate loaded = make_floor();
    loaded.y0 = loaded.y1 = -1;
    loaded.normal_pressure = 100;
    sim.add(loaded);
    for (const int32_t plate : {-1, 2, INT32_MAX})
        EXPECT_FAILS(gp_set_plate_motion(sim, plate, 0, 0, 0), GP_E_ARGUMENT, "plate");
    for (const double value : {not_a_number, infinite, -infinite}) {
        EXPECT_FAILS(gp_set_plate_motion(sim, 0, value, 0, 0), GP_E_ARGUMENT, "vx");
        EXPECT_FAILS(gp_set_plate_motion(sim, 0, 0, value, 0), GP_E_ARGUMENT, "vy");
        EXPECT_FAILS(gp_set_plate_motion(sim, 0, 0, 0, value), GP_E_ARGUMENT, "omega");
    }
    EXPECT_FAILS(gp_set_plate_motion(sim, 1, 0, 0, 0.5), GP_E_ARGUMENT, "omega = 0.5");
    EXPECT_EQ(gp_set_plate_motion(sim, 1, 0.1, 0, 0), GP_OK) << gp_last_error();
    EXPECT_EQ(gp_set_plate_motion(sim, 0, 1, -1, 3), GP_OK);
}

TEST(PlateMotion, GoesOnFromWhereThePlateIs) {
    Sim sim;
    const std::vector<double> t{0, 1}, x{0, 1}, y{0, 2}, angle{0.1, 2.1};
    gp_plate plate = make_plate(6, 5, 4, 5);
    plate.n_knots = 2;
    plate.knot_t = t.data();
    plate.knot_x = x.data();
    plate.knot_y = y.data();
    plate.knot_angle = angle.data();
    sim.add(plate);
    sim.add({0.0}, {1.0});
    const auto expect_at = [&](double time, double dx, double dy, double turned) {
        ASSERT_EQ(gp_run(sim, time), GP_OK) << gp_last_error();
        EXPECT_NEAR(sim.load(0).dx, dx, 1e-12);
        EXPECT_NEAR(sim.load(0).dy, dy, 1e-12);
        EXPECT_NEAR(sim.load(0).angle, turned, 1e-12);
    };
    expect_at(0, 0, 0, 0.1);
    expect_at(0.5, 0.5, 1, 1.1);
    ASSERT_EQ(gp_set_plate_motion(sim, 0, 0, -1, 4), GP_OK);
    expect_at(0.75, 0.5, 0.75, 2.1);
    ASSERT_EQ(gp_set_plate_velocity(sim, 0, 4, 0), GP_OK); // with a turn of zero
    expect_at(1, 1.5, 0.75, 2.1);
    ASSERT_EQ(gp_set_plate_motion(sim, 0, 0, 0, -10), GP_OK);
    expect_at(2, 1.5, 0.75, -7.9); // it has turned more than once: the angle counts on
}

// A constant turn before the first step is replaced, with what a table has begun.
TEST(PlateMotion, BeforeTheStartReplacesWhatThePlateWasToDo) {
    for (const bool table : {false, true}) {
        Sim sim;
        const std::vector<double> t{0, 1}, angle{0.3, 1};
        gp_plate plate = make_plate(6, 5, 4, 5);
        if (table) {
            plate.n_knots = 2;
            plate.knot_t = t.data();
            plate.knot_angle = angle.data();
        } else
            plate.omega = 3;
        sim.add(plate);
        sim.add({0.0}, {0.0});
        ASSERT_EQ(gp_set_plate_motion(sim, 0, 0, 0, -1), GP_OK);
        ASSERT_EQ(gp_run(sim, 0.1), GP_OK);
        EXPECT_NEAR(sim.load(0).angle, (table ? 0.3 : 0) - 0.1, 1e-12);
    }
}

TEST(PlateMotion, FromACallback) {
    Sim sim;
    gp_plate plate = make_plate(6, 5, 4, 5);
    sim.add(plate);
    sim.add({0.0}, {0.0});
    const auto turn = [](void *, gp_sim *s) -> int32_t { return gp_set_plate_motion(s, 0, 0, 0, 2) != GP_OK; };
    ASSERT_EQ(gp_set_callback(sim, 1, turn, nullptr), GP_OK);
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    const double from = sim.state().time;
    ASSERT_EQ(gp_step(sim, 9), GP_OK);
    EXPECT_NEAR(sim.load(0).angle, 2 * (sim.state().time - from), 1e-12);
}

// A program compiled before there were lines, turns and belts hands over a shorter struct, and takes a shorter load.
TEST(Turn, IsUnknownToOlderPrograms) {
    Sim sim;
    gp_plate plate = make_floor();
    plate.n_points = 77; // what lies behind the end of its struct
    plate.omega = not_a_number;
    plate.surface_velocity = 3;
    plate.struct_size = offsetof(gp_plate, n_points);
    EXPECT_EQ(sim.add(plate), 0);
    sim.add(make_column(4, 4));
    ASSERT_EQ(gp_step(sim, 5), GP_OK);
    using Load = gp_load; // with "()" behind it the name would be the macro
    Load load{};
    load.struct_size = offsetof(Load, torque_pivot);
    load.torque_pivot = load.angle = load.impulse_torque = 55;
    ASSERT_EQ(gp_get_plate_load(sim, 0, &load), GP_OK);
    EXPECT_LT(load.fy, 0);
    EXPECT_EQ(load.torque_pivot, 55);
    EXPECT_EQ(load.angle, 55);
    EXPECT_EQ(load.impulse_torque, 55);
    EXPECT_EQ(sim.load(0).angle, 0);
}
