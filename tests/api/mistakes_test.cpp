// The first mistakes of a scene are told before its first step, with what to change; scenes that are meant so are not.
#include <unistd.h>

#include <cstdio>
#include <utility>

#include "log_support.hpp"

using namespace api;

namespace {

gp_plate turned_over(gp_plate plate) {
    std::swap(plate.x0, plate.x1);
    std::swap(plate.y0, plate.y1);
    return plate;
}

// Particles on the lattice of the spacing wherever the condition holds.
template <class Inside> void add_shape(Sim &sim, double x_max, double y_max, const Inside &inside) {
    std::vector<double> x, y;
    for (double v = 0.5 * spacing; v < y_max; v += spacing)
        for (double u = 0.5 * spacing - x_max; u < x_max; u += spacing)
            if (inside(u, v)) {
                x.push_back(u);
                y.push_back(v);
            }
    sim.add(x, y);
}

// A funnel of 60 degrees with an opening of 6 spacings, at y = 0, and material in it. A bin's floor below.
void add_hopper(Sim &sim, double drop) {
    const double slope = std::sqrt(3.0), half = 0.03, wide = 0.12, top = (wide - half) * slope;
    sim.add(make_plate(wide, top, half, 0));
    sim.add(make_plate(-half, 0, -wide, top));
    sim.add(make_right_wall(wide, 0.4));
    sim.add(make_left_wall(-wide, 0.4));
    sim.add(make_plate(1, -drop, -1, -drop));
    add_shape(sim, wide, 0.25, [&](double x, double y) {
        return (half + y / slope - std::abs(x)) * 0.5 * slope > 0.5 * spacing && std::abs(x) < wide - 0.4 * spacing;
    });
}

} // namespace

// ------------------------------------------------------------------------------------------------ plates turned over

TEST(Mistakes, AFloorTurnedOver) {
    const Build build = [](Sim &sim) {
        sim.add(turned_over(make_floor()));
        sim.add(make_column(10, 10));
    };
    expect_once(make_config(), build, 1e-3,
                {"plate 0", "only on the side of its body", "50 particles", "Swap its ends?"}); // five rows
    expect_once(make_config(), build, 1e-3, {"column 0 has nothing below it"});
    expect_silence(
        make_config(),
        [](Sim &sim) {
            sim.add(make_floor());
            sim.add(make_column(10, 10));
        },
        1e-3);
}

TEST(Mistakes, AWallTurnedOverAcrossTheEndsOfAPeriod) {
    gp_config config = make_config();
    config.periodic_x_max = 20 * spacing;
    expect_once(config,
                [](Sim &sim) {
                    sim.add(make_plate(20 * spacing, 0, 0, 0));
                    sim.add(make_right_wall(0, 0.1)); // material on its left: at the other end
                    sim.add(make_column(4, 8));
                },
                1e-3, {"plate 1 has material only on the side of its body", "Swap its ends?"});
    expect_silence(
        config,
        [](Sim &sim) {
            sim.add(make_plate(20 * spacing, 0, 0, 0));
            sim.add(make_right_wall(0, 0.1));
            sim.add(make_column(10, 8, 10 * spacing));
        },
        1e-3);
}

// ----------------------------------------------------------------------------------------- material behind or across

TEST(Mistakes, MaterialBehindAPlate) {
    for (const double behind : {1.0, 3.0, 4.5}) // spacings, of its nearest face
        expect_once(make_config(),
                    [&](Sim &sim) {
                        sim.add(make_floor());
                        sim.add(make_left_wall(0, 0.2));
                        sim.add(make_column(10, 10));
                        sim.add(make_column(10, 10, -(10 + behind) * spacing));
                    },
                    1e-4, {"particles begin behind plate 1", "back to back"});
    expect_silence( // farther than its ghosts reach: another pile
        make_config(),
        [](Sim &sim) {
            sim.add(make_floor());
            sim.add(make_left_wall(0, 0.2));
            sim.add(make_column(10, 10));
            sim.add(make_column(10, 10, -18 * spacing));
        },
        1e-4);
}

TEST(Mistakes, AColumnAcrossAPlate) {
    expect_once(make_config(),
                [](Sim &sim) {
                    sim.add(make_floor());
                    sim.add(make_column(10, 10, 0, -3 * spacing));
                },
                1e-4, {"column 0 lies across the line of plate 0", "30 particles behind it"});
}

// Two plates back to back face all that is near either.
TEST(Mistakes, AGateWettedOnBothSidesIsNone) {
    for (const double apart : {0.0, 0.5, 2.0, 4.0})
        expect_silence(
            make_config(),
            [&](Sim &sim) {
                sim.add(make_floor());
                sim.add(make_right_wall(0, 0.2));
                sim.add(make_left_wall(apart * spacing, 0.2));
                sim.add(make_column(10, 10, -10 * spacing));
                sim.add(make_column(10, 10, apart * spacing));
            },
            1e-4);
}

// A block on the floor, amid material, whose faces hide each other's backs; a slope of many plates.
TEST(Mistakes, BodiesOfSeveralPlatesAreNone) {
    expect_silence(
        make_config(),
        [](Sim &sim) {
            const double size = 3 * spacing;
            sim.add(make_floor());
            sim.add(make_plate(size, 0, size, size));
            sim.add(make_plate(size, size, 0, size));
            sim.add(make_plate(0, size, 0, 0));
            sim.add(make_column(10, 10, -10 * spacing));
            sim.add(make_column(10, 10, size));
            sim.add(make_column(3, 7, 0, size));
        },
        1e-4);
    expect_silence(
        make_config(),
        [](Sim &sim) {
            for (int k = -20; k < 20; ++k)
                sim.add(make_plate((k + 1) * 2 * spacing, 0.3 * spacing * ((k + 1) % 2), k * 2 * spacing,
                                   0.3 * spacing * (k % 2)));
            sim.add(make_column(10, 10, 0, 0.5 * spacing));
        },
        1e-4);
}

// ------------------------------------------------------------------------------------------------------ nothing below

TEST(Mistakes, NoFloor) {
    expect_once(make_config(), [](Sim &sim) { sim.add(make_column(10, 10)); }, 1e-3, {"column 0 has nothing below it"});
    expect_once( // one that ends before it
        make_config(),
        [](Sim &sim) {
            sim.add(make_floor(0.3));
            sim.add(make_column(10, 10));
            sim.add(make_column(10, 10, 0.35));
        },
        1e-3, {"column 1 has nothing below it"});
    expect_once( // that bears a third of it
        make_config(),
        [](Sim &sim) {
            sim.add(make_floor(4 * spacing));
            sim.add(make_column(12, 10));
        },
        1e-3, {"66.7 % of column 0 has nothing below it"});
    expect_once( // on another that nothing bears
        make_config(),
        [](Sim &sim) {
            sim.add(make_column(10, 5));
            sim.add(make_column(10, 5, 0, 5 * spacing));
        },
        1e-3, {"column 0 has nothing below it", "(and so of 1 more)"});
}

TEST(Mistakes, NoFloorInAPeriodicScene) {
    gp_config config = make_config();
    config.periodic_x_max = 20 * spacing;
    const auto build = [](double x_max) {
        return [x_max](Sim &sim) {
            sim.add(make_plate(x_max * spacing, 0, 0, 0));
            sim.add(make_column(6, 10, 14 * spacing));
        };
    };
    expect_once(config, build(12), 1e-3, {"column 0 has nothing below it"});
    expect_silence(config, build(20), 1e-3);
    // On an incline what is below lies across the end of the period.
    for (const double angle : {26.0, -26.0, 70.0}) {
        config.gravity_x = 9.81 * std::sin(angle * std::acos(-1.0) / 180);
        config.gravity_y = -9.81 * std::cos(angle * std::acos(-1.0) / 180);
        expect_silence(config, build(20), 1e-3);
    }
}

TEST(Mistakes, FallsThatAreMeantAreNone) {
    const Build fall = [](Sim &sim) { // on to a floor far below, a wider column, and one borne by that
        sim.add(make_plate(0.5, -0.05, -0.5, -0.05));
        sim.add(make_column(20, 4, 0, -0.05));
        sim.add(make_column(10, 5));
        sim.add(make_column(10, 5, 0, 0.1));
    };
    expect_silence(make_config(), fall, 1e-3);
    gp_config space = make_config(); // no gravity: nothing falls, and columns may collide
    space.gravity_y = 0;
    expect_silence(
        space,
        [](Sim &sim) {
            sim.add(thrown(make_column(10, 10), 1, 0));
            sim.add(thrown(make_column(10, 10, 0.15), -1, 0));
        },
        1e-3);
    gp_config chute = make_config(); // gravity along the period: it falls for ever, as it should
    chute.gravity_x = 9.81;
    chute.gravity_y = 0;
    chute.periodic_x_max = 20 * spacing;
    expect_silence(
        chute,
        [](Sim &sim) {
            sim.add(make_plate(20 * spacing, 0, 0, 0));
            sim.add(make_plate(0, 10 * spacing, 20 * spacing, 10 * spacing));
            sim.add(make_column(20, 10));
        },
        1e-2);
}

TEST(Mistakes, NoMaterial) {
    const Build build = [](Sim &sim) { sim.add(make_floor()); };
    gp_config config = make_config();
    expect_once(config, build, 1e-3, {"the scene has no material"});
}

// ----------------------------------------------------------------------------------------------------- left behind

TEST(Mistakes, ParticlesThatLeftEveryPlate) {
    const Build build = [](Sim &sim) { // a column wider than its floor
        sim.add(make_floor(8 * spacing));
        sim.add(make_column(20, 6, -10 * spacing));
    };
    const Log log = log_of(make_config(), build, 0.4);
    EXPECT_EQ(log.count({"particles have left every plate behind", "of 120", "plates longer"}), 1) << log.all();
    EXPECT_EQ(log.warnings.size(), 1u) << log.all();
}

TEST(Mistakes, AreToldOnceAcrossACheckpoint) {
    if (!gp_has_feature("hdf5"))
        GTEST_SKIP() << "no checkpoints in this build";
    const std::string path = testing::TempDir() + "mistakes_" + std::to_string(::getpid()) + ".h5";
    {
        Sim sim;
        Log log;
        ASSERT_EQ(gp_set_log(sim, Log::run, &log), GP_OK);
        sim.add(make_floor(8 * spacing));
        sim.add(make_column(20, 6, -10 * spacing));
        ASSERT_EQ(gp_run(sim, 0.3), GP_OK) << gp_last_error();
        EXPECT_EQ(log.count({"left every plate"}), 1) << log.all();
        ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK) << gp_last_error();
    }
    gp_sim *sim = nullptr;
    ASSERT_EQ(gp_load(path.c_str(), &sim), GP_OK) << gp_last_error();
    std::remove(path.c_str());
    Log log;
    ASSERT_EQ(gp_set_log(sim, Log::run, &log), GP_OK);
    EXPECT_EQ(gp_run(sim, 0.35), GP_OK) << gp_last_error();
    EXPECT_TRUE(log.warnings.empty()) << log.all();
    gp_destroy(sim);
}

// ----------------------------------------------------------------------------------------------------------- blows

// A block that falls far: the automatic sound speed is made for the blow, says so and is silent afterwards; so is one that
// follows what the warnings of a soft one say.
TEST(Blows, AreForeseen) {
    for (const double fall : {0.3, 1.0}) {
        const Build build = [fall](Sim &sim) {
            sim.add(make_floor());
            sim.add(make_column(16, 8, 0, fall));
        };
        const double speed = std::sqrt(2 * 9.81 * fall), end = 1.05 * std::sqrt(2 * fall / 9.81) + 0.02;
        const Log log = log_of(make_config(), build, end);
        EXPECT_TRUE(log.warnings.empty()) << log.all();
        ASSERT_EQ(log.notes.size(), 1u);
        EXPECT_NE(log.notes[0].find("column 0 meets plate 0"), std::string::npos) << log.notes[0];
        Sim sim;
        build(sim);
        EXPECT_NEAR(sim.state().sound_speed, 60 * speed, 1e-9 * speed);

        gp_config soft = make_config();
        soft.sound_speed = 10 * std::sqrt(2 * 9.81 * (fall + 8 * spacing));
        const Log told = log_of(soft, build, end);
        ASSERT_EQ(told.count({"compression of", "as in a blow or a jet"}), 1) << told.all();
        EXPECT_EQ(told.count({"slower"}), 0) << told.all();
        const std::string text = told.warnings[0], before = "gp_config.sound_speed to about ";
        ASSERT_NE(text.find(before), std::string::npos) << text;
        soft.sound_speed = std::stod(text.substr(text.find(before) + before.size()));
        EXPECT_LT(soft.sound_speed, 2.5 * 60 * speed) << "not much more than it needs";
        expect_silence(soft, build, end);
    }
}

// What stands on something needs no more than it did: also with jitter, on another column, a little above its floor.
TEST(Blows, DoNotChangeWhatStands) {
    for (const double jitter : {0.0, 0.45})
        for (const double gap : {0.0, 0.9}) {
            gp_config config = make_config();
            config.jitter = jitter;
            Sim sim(config);
            sim.add(make_floor());
            sim.add(make_left_wall(0, 1));
            sim.add(make_column(10, 20, 0, gap * spacing));
            sim.add(make_column(6, 20, 0, (20 + gap) * spacing));
            EXPECT_NEAR(sim.state().sound_speed, 10 * std::sqrt(2 * 9.81 * (40 + gap) * spacing),
                        jitter > 0 ? 0.35 : 1e-9);
        }
}

TEST(Blows, OfWhatIsThrown) {
    const double v = 3;
    gp_config config = make_config();
    config.gravity_y = 0;
    const auto speed_of = [&](const Build &build) {
        Sim sim(config);
        build(sim);
        return sim.state().sound_speed;
    };
    EXPECT_NEAR(speed_of([&](Sim &sim) { // at a wall
                    sim.add(make_right_wall(0.5, 0.5));
                    sim.add(thrown(make_column(10, 10, 0, 0.1), v, 0));
                }),
                60 * v, 1e-9);
    EXPECT_NEAR(speed_of([&](Sim &sim) { // past it
                    sim.add(make_right_wall(0.5, 0.5));
                    sim.add(thrown(make_column(10, 10, 0, 0.7), v, 0));
                }),
                10 * v, 1e-9);
    EXPECT_NEAR(speed_of([&](Sim &sim) { // two that meet: each is stopped from v
                    sim.add(thrown(make_column(10, 10), v, 0));
                    sim.add(thrown(make_column(10, 10, 0.5), -v, 0));
                }),
                60 * v, 1e-9);
    EXPECT_NEAR(speed_of([&](Sim &sim) { // that part
                    sim.add(thrown(make_column(10, 10), -v, 0));
                    sim.add(thrown(make_column(10, 10, 0.5), v, 0));
                }),
                20 * v, 1e-9);
}

// A hopper that opens at once, and one whose gate is pulled away: the jet falls into a bin, and nothing is to be said.
TEST(Blows, OfAJetOutOfAHopper) {
    for (const bool gated : {false, true}) {
        const Build build = [gated](Sim &sim) {
            add_hopper(sim, 0.1);
            if (gated) {
                gp_plate gate = make_plate(0.03, 0, -0.03, 0);
                gate.vx = 1;
                sim.add(gate);
            }
        };
        const Log log = log_of(make_config(), build, 0.2);
        EXPECT_TRUE(log.warnings.empty()) << log.all();
        ASSERT_EQ(log.notes.size(), 1u);
        EXPECT_NE(log.notes[0].find("column 0 meets plate 4"), std::string::npos) << log.notes[0];
    }
}
