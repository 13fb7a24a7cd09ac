// What follows from a scene before its first step.
#include <gtest/gtest.h>

#include <cmath>

#include "scene.hpp"

using namespace gp;

namespace {

Scene column_scene(double y_min, double vx = 0) {
    gp_config config = default_config(GP_PRESET_DEFAULT);
    config.spacing = 0.0025;
    Scene scene(config);
    gp_column column = default_column();
    column.x_min = -0.04;
    column.y_min = y_min;
    column.width = 0.08;
    column.height = 0.05;
    column.vx = vx;
    std::string note;
    scene.add_column(column, note);
    return scene;
}

void add_plate(Scene &scene, double x0, double y0, double x1, double y1, double vy = 0,
               int32_t friction = GP_WALL_NO_SLIP) {
    gp_plate plate = default_plate();
    plate.x0 = x0;
    plate.y0 = y0;
    plate.x1 = x1;
    plate.y1 = y1;
    plate.vy = vy;
    plate.friction = friction;
    scene.add_plate(plate);
}

} // namespace

TEST(SoundSpeed, IsTenTimesTheLargestSpeedOfTheScene) {
    const double g = 9.81;
    Scene resting = column_scene(0);
    EXPECT_NEAR(resting.constants().sound_speed, 10 * std::sqrt(2 * g * 0.05), 1e-9);
    Scene falling = column_scene(0.1);
    EXPECT_NEAR(falling.constants().sound_speed, 10 * std::sqrt(2 * g * 0.05), 1e-9); // nothing beneath it
    add_plate(falling, 1, 0, -1, 0);
    EXPECT_NEAR(falling.constants().sound_speed, 10 * std::sqrt(2 * g * 0.15), 1e-9);
    add_plate(falling, 3, -1, 2, -1); // deeper, but not beneath it
    EXPECT_NEAR(falling.constants().sound_speed, 10 * std::sqrt(2 * g * 0.15), 1e-9);
    Scene thrown = column_scene(0, 2);
    add_plate(thrown, 1, 0, -1, 0);
    EXPECT_NEAR(thrown.constants().sound_speed, 10 * std::sqrt(2 * g * 0.05 + 4), 1e-9);
    // A free-slip gate that is pulled along itself does not move the material, a rough one does.
    Scene gated = column_scene(0);
    add_plate(gated, 0.04, 0.1, 0.04, 0, 3, GP_WALL_FREE_SLIP);
    EXPECT_NEAR(gated.constants().sound_speed, 10 * std::sqrt(2 * g * 0.05), 1e-9);
    add_plate(gated, -0.04, 0, -0.04, 0.1, 3, GP_WALL_NO_SLIP);
    EXPECT_NEAR(gated.constants().sound_speed, 10 * std::sqrt(2 * g * 0.05 + 9), 1e-9);
}

TEST(InitialPressure, BalancesTheWeightWhereAPlateBearsIt) {
    Scene borne = column_scene(0);
    add_plate(borne, 1, 0, -1, 0);
    const Constants c = borne.constants();
    const std::vector<double> p = borne.initial_pressure(c);
    for (std::size_t i = 0; i < p.size(); ++i)
        EXPECT_NEAR(p[i], 1550 * 9.81 * (0.05 - borne.y[i]), 1e-9);
    Scene hanging = column_scene(0.01);
    add_plate(hanging, 1, 0, -1, 0);
    for (double value : hanging.initial_pressure(hanging.constants()))
        EXPECT_EQ(value, 0);
}

TEST(MotionTable, IsLinearBetweenKnotsAndAtRestOutside) {
    MotionTable table{{1, 2, 4}, {0, 3, 3}, {5, 5, 9}};
    EXPECT_EQ(table.displacement(0).x(), 0);
    EXPECT_EQ(table.displacement(1.5).x(), 1.5);
    EXPECT_EQ(table.displacement(3).y(), 7);
    EXPECT_EQ(table.displacement(9).y(), 9);
}
