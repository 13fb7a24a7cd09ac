// gp_set_gravity: when it holds, what knows of it, and that the bits go on.
#include <cmath>
#include <string>

#include "../support/directory.hpp"
#include "api_support.hpp"

using namespace api;

namespace {

// Turned by this much of a degree per step, from straight down.
void turn(gp_sim *sim, double degrees) {
    const double angle = degrees * std::acos(-1.0) / 180;
    EXPECT_EQ(gp_set_gravity(sim, 9.81 * std::sin(angle), -9.81 * std::cos(angle)), GP_OK) << gp_last_error();
}

int32_t turn_on(void *, gp_sim *sim) {
    int64_t step = 0;
    EXPECT_EQ(gp_get_clock(sim, nullptr, nullptr, &step), GP_OK);
    turn(sim, 0.25 * static_cast<double>(step));
    return 0;
}

void count_line(void *user, int32_t level, const char *text) {
    if (level == GP_LOG_WARNING)
        static_cast<std::string *>(user)->append(text).append("\n");
}

} // namespace

TEST(Gravity, WantsFiniteNumbersAndASimulation) {
    Sim sim;
    EXPECT_FAILS(gp_set_gravity(nullptr, 0, 0), GP_E_ARGUMENT, "sim");
    EXPECT_FAILS(gp_set_gravity(sim, not_a_number, 0), GP_E_ARGUMENT, "gx");
    EXPECT_FAILS(gp_set_gravity(sim, 0, infinite), GP_E_ARGUMENT, "gy");
    EXPECT_EQ(sim.state().gravity_y, -9.81);
}

// Energies are numbers: from 1e50 on squares of speeds, and what gravity and density make of heights, come near to overflow.
TEST(Gravity, AndSpeedsAreBounded) {
    const double most = 1e50, beyond = 1.01e50;
    gp_config config = make_config();
    config.gravity_y = -beyond;
    gp_sim *none = nullptr;
    EXPECT_FAILS(gp_create(&config, &none), GP_E_ARGUMENT, "gp_config.gravity_y");
    Sim sim;
    EXPECT_FAILS(gp_set_gravity(sim, beyond, 0), GP_E_ARGUMENT, "gx");
    const gp_column fast = thrown(make_column(3, 3), beyond, 0);
    EXPECT_FAILS(gp_add_column(sim, &fast, nullptr), GP_E_ARGUMENT, "gp_column.vx");
    const double x[] = {1}, v[] = {0}, w[] = {-beyond};
    EXPECT_FAILS(gp_add_particles(sim, 0, 1, x, x, v, w, nullptr), GP_E_ARGUMENT, "vy[0]");
    gp_plate plate = make_floor();
    plate.surface_velocity = beyond;
    EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "gp_plate.surface_velocity");
    plate = make_floor();
    const double t[] = {0, 1, 1.5}, way[] = {0, 0, beyond / 2}, still[] = {0, 0, 0}, far[] = {-1e308, 1e308, 1e308};
    plate.n_knots = 3, plate.knot_t = t, plate.knot_x = still, plate.knot_y = way;
    EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "gp_plate.knot_y[2]");
    plate.knot_x = far;
    EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "gp_plate.knot_x[1]");
    plate.knot_x = plate.knot_y = nullptr, plate.knot_angle = way;
    EXPECT_FAILS(gp_add_plate(sim, &plate, nullptr), GP_E_ARGUMENT, "gp_plate.knot_angle[2]");
    gp_material heavy = make_material();
    heavy.grain_density = beyond;
    EXPECT_FAILS(gp_add_material(sim, &heavy, nullptr), GP_E_ARGUMENT, "gp_material.grain_density");
    heavy.grain_density = most;
    int32_t id = 0;
    ASSERT_EQ(gp_add_material(sim, &heavy, &id), GP_OK) << gp_last_error();
    gp_column column = thrown(make_column(3, 3), most, -most);
    column.material = id;
    sim.add(column);
    ASSERT_EQ(gp_set_gravity(sim, most, -most), GP_OK);
    const gp_state state = sim.state();
    EXPECT_TRUE(std::isfinite(state.kinetic) && std::isfinite(state.potential) && std::isfinite(state.elastic));
    EXPECT_GT(state.kinetic, 1e140);
    if (!has("hdf5"))
        return;
    const test::TemporaryDirectory directory("granperi_gravity");
    const std::string path = directory.path() + "/state.gp";
    gp_sim *loaded = nullptr;
    EXPECT_EQ(gp_save(sim, path.c_str()), GP_OK) << gp_last_error();
    EXPECT_EQ(gp_load(path.c_str(), &loaded), GP_OK) << gp_last_error();
    gp_destroy(loaded);
}

// Columns begin in balance with it, the sound speed is made for it.
TEST(Gravity, BeforeTheFirstStepIsTheConfigs) {
    gp_config config = make_config();
    config.gravity_x = 3;
    config.gravity_y = -20;
    Sim given(config), set;
    add_collapse(given);
    add_collapse(set);
    EXPECT_NE(set.state().sound_speed, given.state().sound_speed); // it is prepared, for another gravity
    ASSERT_EQ(gp_set_gravity(set, 3, -20), GP_OK);
    EXPECT_EQ(set.state().sound_speed, given.state().sound_speed);
    EXPECT_EQ(set.state().gravity_x, 3);
    ASSERT_EQ(gp_step(given, 20), GP_OK);
    ASSERT_EQ(gp_step(set, 20), GP_OK);
    EXPECT_TRUE(snapshot(set, 3) == snapshot(given, 3));
}

TEST(Gravity, HoldsFromTheNextStepOn) {
    for (int scheme = 0; scheme < 4; ++scheme) { // the presets, and the implicit one
        gp_config config = make_config();
        EXPECT_EQ(gp_config_init(&config, sizeof config, scheme % 3), GP_OK);
        config.spacing = spacing;
        config.threads = 1;
        if (scheme == 3)
            config.stress = GP_STRESS_IMPLICIT;
        config.gravity_y = 0;
        config.sound_speed = 10;
        Sim sim(config); // a block in space
        sim.add(make_column(6, 4));
        ASSERT_EQ(gp_step(sim, 3), GP_OK);
        EXPECT_EQ(sim.state().max_speed, 0);
        EXPECT_EQ(sim.state().at_rest, 1);
        const uint64_t epoch = sim.epoch();
        ASSERT_EQ(gp_set_gravity(sim, 2, -1), GP_OK);
        EXPECT_GT(sim.epoch(), epoch);
        EXPECT_EQ(sim.state().at_rest, 0) << scheme;
        EXPECT_EQ(sim.state().gravity_x, 2);
        const double before = sim.state().time;
        ASSERT_EQ(gp_step(sim, 3), GP_OK);
        const double span = sim.state().time - before;
        for (const double u : sim.field(GP_FIELD_VX))
            EXPECT_NEAR(u, 2 * span, 1e-12) << scheme;
        for (const double v : sim.field(GP_FIELD_VY))
            EXPECT_NEAR(v, -span, 1e-12) << scheme;
    }
}

// In free fall, through changes of gravity, to rounding: a step in which v comes before x loses m (g dt)^2 / 2.
TEST(Gravity, LedgerGoesOnWhereItChanges) {
    Sim sim;
    sim.add(make_column(6, 4, 3, 7));
    const double mass = 1550 * 24 * spacing * spacing,
                 all = sim.state().kinetic + sim.state().potential + sim.state().elastic;
    double lost = 0;
    for (const auto &[gx, gy] : {std::pair{0.0, -9.81}, {4.0, -7.0}, {0.0, 0.0}, {-30.0, 1.0}, {-30.0, 1.0}}) {
        const double potential = sim.state().potential;
        ASSERT_EQ(gp_set_gravity(sim, gx, gy), GP_OK);
        EXPECT_NEAR(sim.state().potential, potential, 1e-9 * all);
        for (int step = 0; step < 20; ++step) {
            ASSERT_EQ(gp_step(sim, 1), GP_OK);
            lost += 0.5 * mass * (gx * gx + gy * gy) * std::pow(sim.state().dt, 2);
        }
        const gp_state s = sim.state();
        EXPECT_NEAR(s.energy_error, lost, 1e-9 * all);
        EXPECT_NEAR(all, s.kinetic + s.potential + s.elastic + s.dissipated + s.plate_work + s.energy_error,
                    1e-9 * all);
    }
}

TEST(Gravity, ThatIsTheSameChangesNothing) {
    Sim sim;
    add_collapse(sim);
    ASSERT_EQ(gp_step(sim, 20), GP_OK);
    const std::vector<uint64_t> before = snapshot(sim, 3);
    const uint64_t epoch = sim.epoch();
    ASSERT_EQ(gp_set_gravity(sim, 0, -9.81), GP_OK);
    EXPECT_EQ(sim.epoch(), epoch);
    EXPECT_TRUE(snapshot(sim, 3) == before);
}

TEST(Gravity, IsNoRestUntilItIsBorne) {
    Sim sim;
    sim.add(make_floor());
    sim.add(make_column(12, 3));
    ASSERT_EQ(gp_run(sim, 1.5), GP_OK);
    ASSERT_EQ(sim.state().at_rest, 1);
    turn(sim, 1);
    EXPECT_EQ(sim.state().at_rest, 0);
    ASSERT_EQ(gp_step(sim, 30), GP_OK);
    EXPECT_EQ(sim.state().at_rest, 0);
    ASSERT_EQ(gp_run(sim, 3), GP_OK);
    EXPECT_EQ(sim.state().at_rest, 1);
    turn(sim, 60); // steeper than any friction
    ASSERT_EQ(gp_run(sim, 3.3), GP_OK);
    EXPECT_EQ(sim.state().at_rest, 0);
}

TEST(Gravity, ThatIsTooMuchForTheSoundSpeedIsWarnedOf) {
    Sim sim;
    std::string lines;
    ASSERT_EQ(gp_set_log(sim, count_line, &lines), GP_OK);
    sim.add(make_floor());
    sim.add(make_column(12, 8));
    ASSERT_EQ(gp_step(sim, 2), GP_OK);
    turn(sim, 10);
    EXPECT_EQ(lines, "");
    ASSERT_EQ(gp_set_gravity(sim, 0, -100), GP_OK);
    EXPECT_NE(lines.find("gp_set_gravity = (0, -100)"), std::string::npos) << lines;
    EXPECT_NE(lines.find("set gp_config.sound_speed to about"), std::string::npos) << lines;
    const std::string once = lines;
    ASSERT_EQ(gp_set_gravity(sim, 0, -101), GP_OK);
    EXPECT_EQ(lines, once);
}

// Turned in each step by the host or by a callback, with any number of threads, and with steps taken anew.
TEST(Gravity, TurnsWithTheSameBits) {
    const auto turned = [](int32_t threads, bool by_callback, int32_t retries) {
        gp_config config = make_config();
        config.threads = threads;
        config.retry_halvings = retries;
        Sim sim(config);
        add_collapse(sim, 54, 44);
        if (by_callback) {
            EXPECT_EQ(gp_set_callback(sim, 1, turn_on, nullptr), GP_OK);
            EXPECT_EQ(gp_step(sim, 40), GP_OK) << gp_last_error();
        } else {
            for (int step = 1; step <= 40; ++step) {
                EXPECT_EQ(gp_step(sim, 1), GP_OK) << gp_last_error();
                turn(sim, 0.25 * step);
            }
        }
        return snapshot(sim, 3);
    };
    const std::vector<uint64_t> one = turned(1, true, 0);
    EXPECT_TRUE(turned(1, false, 0) == one);
    EXPECT_TRUE(turned(1, true, 3) == one);
    for (int32_t threads = 2; threads <= (has("openmp") ? 4 : 1); ++threads)
        EXPECT_TRUE(turned(threads, true, 0) == one) << threads;
}

// A step that diverges and is taken back has the gravity that it began with; as each of its halves.
TEST(Gravity, IsThatOfTheHalvesOfAStep) {
    gp_config config = make_config();
    config.gravity_y = 0;
    config.retry_halvings = 4;
    config.sound_speed = 10;
    config.time_step = 5e-4;
    Sim sim(config); // a spacing per step and step is too much for one step, not for its halves
    sim.add(make_column(3, 3));
    ASSERT_EQ(gp_step(sim, 1), GP_OK) << gp_last_error();
    const double g = 1.5 * spacing / (config.time_step * config.time_step);
    ASSERT_EQ(gp_set_gravity(sim, 0, -g), GP_OK);
    ASSERT_EQ(gp_step(sim, 1), GP_OK) << gp_last_error();
    EXPECT_GT(sim.state().retries, 0);
    EXPECT_EQ(sim.state().gravity_y, -g);
    for (const double v : sim.field(GP_FIELD_VY))
        EXPECT_NEAR(v, -g * sim.state().dt, 1e-9 * g * sim.state().dt);
}

#ifdef GP_TEST_HDF5

TEST(Gravity, GoesOnFromACheckpointInTheMiddle) {
    const test::TemporaryDirectory directory("granperi_gravity");
    for (const int32_t stress : {GP_STRESS_ELASTIC, GP_STRESS_IMPLICIT})
        for (const int before : {0, 30}) { // steps: also what was replaced before the first one
            gp_config config = make_config();
            config.stress = stress;
            Sim sim(config);
            add_collapse(sim);
            turn(sim, 5);
            ASSERT_EQ(gp_set_callback(sim, 1, turn_on, nullptr), GP_OK);
            ASSERT_EQ(gp_step(sim, before), GP_OK);
            const std::string path = directory.path() + "/tilting.gpc";
            ASSERT_EQ(gp_save(sim, path.c_str()), GP_OK) << gp_last_error();
            Sim loaded;
            gp_destroy(loaded.handle);
            ASSERT_EQ(gp_load(path.c_str(), &loaded.handle), GP_OK) << gp_last_error();
            EXPECT_TRUE(snapshot(loaded, 3) == snapshot(sim, 3));
            EXPECT_EQ(loaded.state().gravity_x, sim.state().gravity_x);
            ASSERT_EQ(gp_step(sim, 10), GP_OK);
            ASSERT_EQ(gp_set_callback(loaded, 1, turn_on, nullptr), GP_OK);
            ASSERT_EQ(gp_step(loaded, 10), GP_OK);
            EXPECT_TRUE(snapshot(loaded, 3) == snapshot(sim, 3));
            ASSERT_EQ(gp_run(sim, sim.state().time + 0.02), GP_OK);
            ASSERT_EQ(gp_run(loaded, loaded.state().time + 0.02), GP_OK);
            EXPECT_TRUE(snapshot(loaded, 3) == snapshot(sim, 3));
        }
}

#endif

// ------------------------------------------------------------------------------------------------------ gp_material.k0

TEST(SideStress, IsWithinYieldAndOfTheElasticSchemeAlone) {
    gp_material material = make_material();
    material.mu_s = 0.5; // 1/3 .. 3
    for (const double k0 : {-1.0, 0.3, 3.1, not_a_number, infinite}) {
        Sim sim;
        material.k0 = k0;
        EXPECT_FAILS(gp_add_material(sim, &material, nullptr), GP_E_ARGUMENT, "gp_material.k0");
    }
    for (const double k0 : {0.0, 0.34, 1.0, 2.9}) {
        Sim sim;
        material.k0 = k0;
        EXPECT_EQ(gp_add_material(sim, &material, nullptr), GP_OK) << gp_last_error();
    }
    gp_config config = make_config();
    config.stress = GP_STRESS_IMPLICIT;
    Sim sim(config);
    material.k0 = 1;
    EXPECT_FAILS(gp_add_material(sim, &material, nullptr), GP_E_ARGUMENT, "GP_STRESS_ELASTIC");
    gp_config raised = make_config();
    raised.friction_factor = 2; // any where the friction is 1
    Sim rough(raised);
    material.k0 = 0.01;
    EXPECT_EQ(gp_add_material(rough, &material, nullptr), GP_OK) << gp_last_error();
}

// A program of 0.1 has a shorter struct: nothing of it is read.
TEST(SideStress, IsUnknownToAShorterStruct) {
    const auto after = [](uint32_t size, double beyond) {
        gp_material material = make_material();
        material.k0 = beyond;
        material.struct_size = size;
        Sim sim;
        gp_column column = make_column(8, 8);
        column.material = sim.add(material);
        sim.add(make_floor());
        sim.add(column);
        EXPECT_EQ(gp_step(sim, 10), GP_OK);
        return snapshot(sim, 1);
    };
    const uint32_t before = offsetof(gp_material, k0);
    EXPECT_TRUE(after(before, -5) == after(sizeof(gp_material), 0));
    EXPECT_FALSE(after(sizeof(gp_material), 0.6) == after(sizeof(gp_material), 0));
}

TEST(SideStress, IsWhatColumnsBeginWith) {
    Sim sim;
    gp_material material = make_material();
    material.k0 = 0.5;
    gp_column column = make_column(10, 8);
    column.material = sim.add(material);
    sim.add(make_floor());
    sim.add(column);
    const std::vector<double> y = sim.field(GP_FIELD_Y), p = sim.field(GP_FIELD_PRESSURE), s = sim.field(GP_FIELD_SXX);
    for (std::size_t i = 0; i < y.size(); ++i) {
        const double weight = 1550 * 9.81 * (8 * spacing - y[i]);
        EXPECT_NEAR(p[i] + s[i], weight, 1e-9 * weight);       // sigma_v
        EXPECT_NEAR(p[i] - s[i], 0.5 * weight, 1e-9 * weight); // sigma_h
    }
}
