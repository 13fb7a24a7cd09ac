// What follows from a scene before its first step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene.hpp"
#include "scene_falls.hpp"

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

TEST(SoundSpeed, IsTenTimesTheLargestSpeedOfTheSceneOrSixtyTimesItsHardestBlow) {
    const double g = 9.81;
    Scene resting = column_scene(0);
    EXPECT_NEAR(resting.constants().sound_speed, 10 * std::sqrt(2 * g * 0.05), 1e-9);
    Scene falling = column_scene(0.1);
    EXPECT_NEAR(falling.constants().sound_speed, 10 * std::sqrt(2 * g * 0.05), 1e-9); // nothing beneath it
    add_plate(falling, 1, 0, -1, 0);
    EXPECT_NEAR(falling.constants().flow_speed, std::sqrt(2 * g * 0.15), 1e-9);
    EXPECT_NEAR(falling.constants().sound_speed, 60 * std::sqrt(2 * g * 0.1), 1e-9); // for the blow
    add_plate(falling, 3, -1, 2, -1);                                                // deeper, but not beneath it
    EXPECT_NEAR(falling.constants().sound_speed, 60 * std::sqrt(2 * g * 0.1), 1e-9);
    Scene standing = column_scene(0.002); // less than a spacing above it is no fall
    add_plate(standing, 1, 0, -1, 0);
    EXPECT_NEAR(standing.constants().sound_speed, 10 * std::sqrt(2 * g * 0.052), 1e-9);
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

// Where gravity and lattice are askew, the overhanging face of a column that stands is no fall.
TEST(SoundSpeed, OfAColumnOnAnInclineIsThatOfTheFlow) {
    for (const double angle : {-0.5, 0.2, 0.45, 0.8})
        for (const double jitter : {0.0, 0.4}) {
            gp_config config = default_config(GP_PRESET_DEFAULT);
            config.gravity_x = 9.81 * std::sin(angle);
            config.gravity_y = -9.81 * std::cos(angle);
            config.jitter = jitter;
            Scene scene(config);
            gp_column column = default_column();
            column.width = 0.1;
            column.height = 0.05;
            std::string note;
            scene.add_column(column, note);
            for (int k = -10; k < 10; ++k) // in pieces, which end anywhere on the lattice
                add_plate(scene, 0.031 * (k + 1), 0, 0.031 * k, 0);
            const Constants c = scene.constants();
            EXPECT_EQ(c.sound_speed, 10 * c.flow_speed) << angle << " " << jitter;
        }
}

namespace {

constexpr double rho = 1550, g = 9.81, depth = 0.05;

Scene tilted_scene(double angle, double mu = std::tan(std::acos(-1.0) / 180 * 21), int32_t stress = GP_STRESS_ELASTIC) {
    gp_config config = default_config(GP_PRESET_DEFAULT);
    config.spacing = 0.0025;
    config.gravity_x = g * std::sin(angle);
    config.gravity_y = -g * std::cos(angle);
    config.stress = stress;
    Scene scene(config);
    gp_material material = default_material();
    material.mu_s = material.mu_2 = mu;
    gp_column column = default_column();
    column.material = scene.add_material(material);
    column.width = 0.08;
    column.height = depth / 2;
    std::string note;
    scene.add_column(column, note); // one on the other
    column.y_min = depth / 2;
    scene.add_column(column, note);
    return scene;
}

Vector place_of(const Scene &scene, std::size_t particle) {
    const auto id = static_cast<int64_t>(particle);
    return scene.position(scene.bodies()[scene.body_of(id)], id);
}

// Expects p, sxx and sxy as these multiples of the weight per area and depth.
void expect_stress(const Scene &scene, double p, double sxx, double sxy) {
    const std::vector<InitialStress> stress = scene.initial_stress(scene.constants(), 0, scene.particle_count());
    for (std::size_t i = 0; i < stress.size(); ++i) {
        const double weight = rho * g * (depth - place_of(scene, i).y());
        EXPECT_NEAR(stress[i].pressure, p * weight, 1e-9);
        EXPECT_NEAR(stress[i].sxx, sxx * weight, 1e-9);
        EXPECT_NEAR(stress[i].sxy, sxy * weight, 1e-9);
    }
}

} // namespace

// A part of the particles is sorted at a time: what stands and what falls are in different ones.
TEST(Impact, IsFoundAmongMoreParticlesThanAreSortedAtATime) {
    gp_config config = default_config(GP_PRESET_DEFAULT);
    config.spacing = 0.001;
    config.jitter = 0.1;
    Scene scene(config);
    std::string note;
    gp_column column = default_column();
    column.width = 3;
    column.height = 0.3;
    scene.add_column(column, note);
    column.x_min = 3.1;
    column.y_min = 0.5;
    column.width = 0.7;
    scene.add_column(column, note);
    add_plate(scene, 5, 0, -1, 0);
    ASSERT_GT(scene.particle_count(), 1 << 20);
    const Impact impact = scene.impact();
    EXPECT_EQ(impact.body, 1);
    EXPECT_EQ(impact.plate, 0);
    EXPECT_NEAR(impact.fall, 0.5, config.jitter * config.spacing);
    EXPECT_NEAR(impact.speed, std::sqrt(2 * 9.81 * impact.fall), 1e-9);
    EXPECT_EQ(borne_shares(scene), std::vector<double>(2, 1.0));
}

TEST(InitialStress, BalancesTheWeightWhereAPlateBearsIt) {
    Scene borne = column_scene(0);
    add_plate(borne, 1, 0, -1, 0);
    expect_stress(borne, 1, 0, 0);
    Scene hanging = column_scene(0.01);
    add_plate(hanging, 1, 0, -1, 0);
    expect_stress(hanging, 0, 0, 0);
}

TEST(InitialStress, HasTheShearThatTheFloorBears) {
    for (const double angle : {-0.3, 0.1, 0.3, 0.5}) {
        const double yield = std::tan(std::acos(-1.0) / 180 * 21), cosine = std::cos(angle);
        Scene rough = tilted_scene(angle);
        add_plate(rough, 1, 0, -1, 0);
        const double most = yield * cosine;
        expect_stress(rough, cosine, 0, std::clamp(std::sin(angle), -most, most));
        Scene smooth = tilted_scene(angle);
        add_plate(smooth, 1, 0, -1, 0, 0, GP_WALL_FREE_SLIP);
        expect_stress(smooth, cosine, 0, 0);
        Scene coulomb = tilted_scene(angle);
        gp_plate plate = default_plate();
        plate.x0 = 1;
        plate.x1 = -1;
        plate.friction = GP_WALL_COULOMB;
        plate.wall_mu = 0.2;
        coulomb.add_plate(plate);
        expect_stress(coulomb, cosine, 0, std::clamp(std::sin(angle), -0.2 * cosine, 0.2 * cosine));
        Scene implicit = tilted_scene(angle, yield, GP_STRESS_IMPLICIT);
        add_plate(implicit, 1, 0, -1, 0);
        expect_stress(implicit, cosine, 0, 0);
    }
    // A wall at the lower end has to bear only what the floor does not hold: nothing of 0.3.
    for (const double angle : {-0.3, -0.5}) {
        Scene corner = tilted_scene(angle);
        add_plate(corner, 1, 0, -1, 0);
        add_plate(corner, 0, 0, 0, 1);
        if (angle == -0.3) {
            expect_stress(corner, std::cos(angle), 0, std::sin(angle));
            continue;
        }
        for (const InitialStress &s : corner.initial_stress(corner.constants(), 0, corner.particle_count()))
            EXPECT_EQ(s.sxy, 0);
    }
    // The same turned by a right angle: gravity presses against a wall at the right.
    gp_config config = default_config(GP_PRESET_DEFAULT);
    config.spacing = 0.0025;
    config.gravity_x = 8;
    config.gravity_y = 2;
    Scene turned(config);
    gp_column column = default_column();
    column.width = depth;
    column.height = 0.08;
    std::string note;
    turned.add_column(column, note);
    add_plate(turned, depth, 1, depth, -1);
    const std::vector<InitialStress> stress = turned.initial_stress(turned.constants(), 0, turned.particle_count());
    for (std::size_t i = 0; i < stress.size(); ++i) {
        // The forces on the part above x: rho g x + sigma (1, 0) = 0.
        EXPECT_NEAR(stress[i].pressure, rho * 8 * place_of(turned, i).x(), 1e-9);
        EXPECT_NEAR(stress[i].sxy, -rho * 2 * place_of(turned, i).x(), 1e-9);
    }
}

TEST(InitialStress, IsUniaxialBetweenFreeSidesThatTheFrictionHolds) {
    for (const double mu : {0.9, 1.0, 1.5}) {
        Scene free = tilted_scene(0, mu);
        add_plate(free, 1, 0, -1, 0);
        expect_stress(free, mu < 1 ? 1 : 0.5, mu < 1 ? 0 : 0.5, 0);
    }
    Scene one_side = tilted_scene(0, 1.5);
    add_plate(one_side, 1, 0, -1, 0);
    add_plate(one_side, 0, 0, 0, 1);
    expect_stress(one_side, 0.5, 0.5, 0);
    Scene box = tilted_scene(0, 1.5);
    add_plate(box, 1, 0, -1, 0);
    add_plate(box, 0, 0, 0, 1);
    add_plate(box, 0.08, 1, 0.08, 0);
    expect_stress(box, 1, 0, 0);
    // Columns side by side are one: the last has the only free side.
    gp_config config = default_config(GP_PRESET_DEFAULT);
    config.spacing = 0.0025;
    Scene row(config);
    gp_material material = default_material();
    material.mu_s = material.mu_2 = 1.5;
    gp_column column = default_column();
    column.material = row.add_material(material);
    column.width = 0.01;
    column.height = depth;
    std::string note;
    for (int k = 0; k < 4; ++k) {
        column.x_min = k * column.width;
        row.add_column(column, note);
    }
    add_plate(row, 1, 0, -1, 0);
    add_plate(row, 0, 0, 0, 1);
    expect_stress(row, 0.5, 0.5, 0);
    add_plate(row, 0.04, 1, 0.04, 0);
    expect_stress(row, 1, 0, 0);
    // With both gravities the shear is what the yield leaves.
    Scene steep = tilted_scene(0.5, 1);
    add_plate(steep, 1, 0, -1, 0);
    expect_stress(steep, 0.5 * std::cos(0.5), 0.5 * std::cos(0.5), 0);
}

TEST(MotionTable, IsLinearBetweenKnotsAndAtRestOutside) {
    MotionTable table{{1, 2, 4}, {0, 3, 3}, {5, 5, 9}, {0, 0, 4}};
    EXPECT_EQ(table.displacement(0).x(), 0);
    EXPECT_EQ(table.displacement(1.5).x(), 1.5);
    EXPECT_EQ(table.displacement(3).y(), 7);
    EXPECT_EQ(table.displacement(9).y(), 9);
    EXPECT_EQ(table.turn(1.5), 0);
    EXPECT_EQ(table.turn(3), 2);
}
