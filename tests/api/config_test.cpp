// Every field of gp_config: what is refused, with which status, naming which field; and what is not.
#include "api_support.hpp"

using namespace api;

namespace {

gp_status create(const gp_config &config) {
    gp_sim *sim = reinterpret_cast<gp_sim *>(1);
    const gp_status status = gp_create(&config, &sim);
    EXPECT_EQ(sim == nullptr, status != GP_OK) << "*sim is NULL on error, and only then";
    if (status == GP_OK)
        gp_destroy(sim);
    return status;
}

struct Number {
    const char *name;
    double gp_config::*member;
    std::vector<double> bad, good; // NaN and the infinities are bad for every field
};

struct Integer {
    const char *name;
    int32_t gp_config::*member;
    std::vector<int32_t> bad, good;
};

const double below_half = std::nextafter(0.5, 0.0);

const std::vector<Number> numbers = {
    {"spacing", &gp_config::spacing, {0, -0.01}, {1e-6, 1, 1000}},
    {"gravity_x", &gp_config::gravity_x, {}, {0, 9.81, -9.81}},
    {"gravity_y", &gp_config::gravity_y, {}, {0, 9.81, -1.62}},
    {"sound_speed", &gp_config::sound_speed, {-1e-9, -10}, {0, 0.1, 340}},
    {"cfl", &gp_config::cfl, {-0.1, 9e-7, 8.0001}, {0, 1e-6, 0.1, 8}},
    {"time_step", &gp_config::time_step, {-1e-9}, {0, 1e-9, 1}},
    {"interaction_radius", &gp_config::interaction_radius, {0, -4, 1.49, 8.01}, {1.5, 3.1, 8}},
    {"horizon", &gp_config::horizon, {0, -4, 1.79, 8.01}, {1.8, 3.1, 8}},
    {"horizon_length", &gp_config::horizon_length, {-0.04}, {0, 3 * spacing}},
    {"friction_factor", &gp_config::friction_factor, {-0.1, 10.1}, {0, 2, 10}},
    {"delta", &gp_config::delta, {0, -1e-6}, {1e-9, 1}},
    {"collision_distance", &gp_config::collision_distance, {-0.1, 1.01}, {0, 0.5, 1}},
    {"zero_energy_penalty", &gp_config::zero_energy_penalty, {-0.01, 0.51}, {0, 0.5}},
    {"density_diffusion", &gp_config::density_diffusion, {-0.01, 1.01}, {0, 1}},
    {"bulk_viscosity", &gp_config::bulk_viscosity, {-0.01, 1.01}, {0, 1}},
    {"channel_width", &gp_config::channel_width, {-0.1}, {0}},
    {"channel_friction", &gp_config::channel_friction, {-0.1, 0.3}, {0}}, // without width
    {"periodic_x_min", &gp_config::periodic_x_min, {}, {0}},
    {"periodic_x_max", &gp_config::periodic_x_max, {-1}, {0}}, // below periodic_x_min
    {"jitter", &gp_config::jitter, {-0.01, 0.5, 1}, {0, 0.1, below_half}},
};

const std::vector<Integer> integers = {
    {"nonlocal", &gp_config::nonlocal, {-1, 2}, {1}},
    {"stress", &gp_config::stress, {-1, 3}, {GP_STRESS_ELASTIC}},
    {"density", &gp_config::density, {-1, 2}, {GP_DENSITY_CONTINUITY}},
    {"threads", &gp_config::threads, {-1, 1025, INT32_MAX, INT32_MIN}, {0, 1}},
    {"preset", &gp_config::preset, {-1, 3}, {GP_PRESET_DEFAULT}},
};

} // namespace

TEST(Config, DefaultsAreTheDocumentedOnes) {
    gp_config c;
    ASSERT_EQ(gp_config_init(&c, sizeof c, GP_PRESET_DEFAULT), GP_OK);
    EXPECT_EQ(c.struct_size, sizeof c);
    EXPECT_EQ(c.spacing, 0.0025);
    EXPECT_EQ(c.gravity_x, 0);
    EXPECT_EQ(c.gravity_y, -9.81);
    EXPECT_EQ(c.sound_speed, 0);
    EXPECT_EQ(c.cfl, 0);
    EXPECT_EQ(c.time_step, 0);
    EXPECT_EQ(c.interaction_radius, 4);
    EXPECT_EQ(c.horizon, 4);
    EXPECT_EQ(c.horizon_length, 0);
    EXPECT_EQ(c.nonlocal, 1);
    EXPECT_EQ(c.stress, GP_STRESS_ELASTIC);
    EXPECT_EQ(c.density, GP_DENSITY_CONTINUITY);
    EXPECT_EQ(c.friction_factor, 1);
    EXPECT_EQ(c.delta, 1e-6);
    EXPECT_EQ(c.collision_distance, 0.9);
    EXPECT_EQ(c.zero_energy_penalty, 0.02);
    EXPECT_EQ(c.density_diffusion, 0.2);
    EXPECT_EQ(c.bulk_viscosity, 0.1);
    EXPECT_EQ(c.channel_width, 0);
    EXPECT_EQ(c.channel_friction, 0);
    EXPECT_EQ(c.periodic_x_min, 0);
    EXPECT_EQ(c.periodic_x_max, 0);
    EXPECT_EQ(c.threads, 1);
    EXPECT_EQ(c.seed, 0u);
    EXPECT_EQ(c.jitter, 0);
    EXPECT_EQ(c.preset, GP_PRESET_DEFAULT);
    EXPECT_EQ(create(c), GP_OK);
}

TEST(Config, EveryNumberIsChecked) {
    for (const Number &field : numbers) {
        std::vector<double> bad = field.bad;
        bad.insert(bad.end(), {not_a_number, -not_a_number, infinite, -infinite});
        for (const double value : bad) {
            SCOPED_TRACE(testing::Message() << field.name << " = " << value);
            gp_config config = make_config();
            config.*field.member = value;
            EXPECT_FAILS(create(config), GP_E_ARGUMENT, field.name);
        }
        for (const double value : field.good) {
            SCOPED_TRACE(testing::Message() << field.name << " = " << value);
            gp_config config = make_config();
            config.*field.member = value;
            EXPECT_EQ(create(config), GP_OK) << gp_last_error();
        }
    }
}

TEST(Config, EveryIntegerIsChecked) {
    for (const Integer &field : integers) {
        for (const int32_t value : field.bad) {
            SCOPED_TRACE(testing::Message() << field.name << " = " << value);
            gp_config config = make_config();
            config.*field.member = value;
            EXPECT_FAILS(create(config), GP_E_ARGUMENT, field.name);
        }
        for (const int32_t value : field.good) {
            SCOPED_TRACE(testing::Message() << field.name << " = " << value);
            gp_config config = make_config();
            config.*field.member = value;
            EXPECT_EQ(create(config), GP_OK) << gp_last_error();
        }
    }
}

TEST(Config, ThreadsNeedOpenMP) {
    for (const int32_t threads : {2, 1024}) {
        gp_config config = make_config();
        config.threads = threads;
        if (has("openmp")) {
            EXPECT_EQ(create(config), GP_OK) << gp_last_error();
        } else {
            EXPECT_FAILS(create(config), GP_E_UNSUPPORTED, "threads");
        }
    }
}

TEST(Config, HorizonLengthHasTheRangeOfTheHorizon) {
    for (const double spacings : {1.7, 8.1}) {
        gp_config config = make_config();
        config.horizon_length = spacings * spacing;
        EXPECT_FAILS(create(config), GP_E_ARGUMENT, "horizon_length");
    }
}

TEST(Config, AnySeedIsFine) {
    for (const uint64_t seed : {uint64_t(1), UINT64_MAX}) {
        gp_config config = make_config();
        config.seed = seed;
        EXPECT_EQ(create(config), GP_OK) << gp_last_error();
    }
}

TEST(Config, InconsistentFieldsAreRefused) {
    gp_config config = make_config();
    config.channel_friction = 0.5;
    EXPECT_FAILS(create(config), GP_E_ARGUMENT, "channel_friction");
    config = make_config();
    config.periodic_x_min = 1;
    config.periodic_x_max = 0.5;
    EXPECT_FAILS(create(config), GP_E_ARGUMENT, "periodic_x_max");
}

// Equal ends: not periodic, wherever they are.
TEST(Config, EqualPeriodicEndsMeanNotPeriodic) {
    gp_config config = make_config();
    config.periodic_x_min = config.periodic_x_max = 3;
    EXPECT_EQ(create(config), GP_OK) << gp_last_error();
}

// One choice that departs from the default scheme's makes no scheme: it is named.
TEST(Config, AChoiceThatMakesNoSchemeIsUnsupportedByName) {
    struct Option {
        const char *name;
        void (*set)(gp_config &);
    };
    const Option options[] = {
        {"stress", [](gp_config &c) { c.stress = GP_STRESS_REGULARIZED; }},
        {"density", [](gp_config &c) { c.density = GP_DENSITY_NUMBER; }},
        {"nonlocal", [](gp_config &c) { c.nonlocal = 0; }},
    };
    for (const Option &option : options) {
        SCOPED_TRACE(option.name);
        gp_config config = make_config();
        option.set(config);
        EXPECT_FAILS(create(config), GP_E_UNSUPPORTED, option.name);
    }
}

TEST(Config, PeriodIsChecked) {
    gp_config config = make_config();
    config.periodic_x_min = -0.1;
    config.periodic_x_max = -0.1 + 9.9 * config.spacing; // twice the horizon of 4 and two spacings are 10
    EXPECT_FAILS(create(config), GP_E_ARGUMENT, "periodic_x_max");
    config.periodic_x_max = -0.1 + 10.1 * config.spacing;
    EXPECT_EQ(create(config), GP_OK) << gp_last_error();
    config.horizon = 6;
    EXPECT_FAILS(create(config), GP_E_ARGUMENT, "periodic_x_max");
    config.periodic_x_max = -0.2;
    EXPECT_FAILS(create(config), GP_E_ARGUMENT, "periodic_x_max");
}

// As all positions do, they lie within 1e12 spacings of the origin: farther away a double does not tell two particles apart.
TEST(Config, EndsOfThePeriodArePositions) {
    gp_config config = make_config();
    config.periodic_x_max = 1e12 * config.spacing;
    EXPECT_EQ(create(config), GP_OK) << gp_last_error();
    for (const double far : {1.01e12 * config.spacing, 1e300}) {
        config.periodic_x_min = 0;
        config.periodic_x_max = far;
        EXPECT_FAILS(create(config), GP_E_ARGUMENT, "periodic_x_max");
        config.periodic_x_min = -far;
        config.periodic_x_max = 0;
        EXPECT_FAILS(create(config), GP_E_ARGUMENT, "periodic_x_min");
    }
}

TEST(Config, PaperPresetsAreTheDocumentedOnes) {
    for (const int32_t preset : {GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL}) {
        gp_config config;
        ASSERT_EQ(gp_config_init(&config, sizeof config, preset), GP_OK);
        EXPECT_EQ(config.preset, preset);
        EXPECT_EQ(config.nonlocal, preset == GP_PRESET_PAPER ? 1 : 0);
        EXPECT_EQ(config.stress, GP_STRESS_REGULARIZED);
        EXPECT_EQ(config.density, GP_DENSITY_NUMBER);
        EXPECT_EQ(config.friction_factor, preset == GP_PRESET_PAPER ? 2 : 1);
        EXPECT_EQ(config.collision_distance, 0.9);
        EXPECT_EQ(config.zero_energy_penalty, 0);
        EXPECT_EQ(config.density_diffusion, 0);
        EXPECT_EQ(config.bulk_viscosity, 0);
        EXPECT_EQ(create(config), GP_OK) << gp_last_error();
    }
    for (const int32_t preset : {-1, 3, INT32_MAX}) {
        gp_config config;
        std::memset(&config, 0x5a, sizeof config);
        const gp_config before = config;
        EXPECT_FAILS(gp_config_init(&config, sizeof config, preset), GP_E_ARGUMENT, "preset");
        EXPECT_EQ(std::memcmp(&config, &before, sizeof config), 0);
    }
}

// nonlocal, stress and density choose a scheme together: three of the combinations are one.
TEST(Config, CombinationsThatAreNoSchemeAreUnsupported) {
    for (const int32_t preset : {GP_PRESET_DEFAULT, GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL})
        for (int32_t nonlocal = 0; nonlocal < 2; ++nonlocal)
            for (int32_t stress = 0; stress < 3; ++stress)
                for (int32_t density = 0; density < 2; ++density) {
                    SCOPED_TRACE(testing::Message() << preset << ": " << nonlocal << stress << density);
                    gp_config config;
                    ASSERT_EQ(gp_config_init(&config, sizeof config, preset), GP_OK);
                    config.nonlocal = nonlocal;
                    config.stress = stress;
                    config.density = density;
                    config.zero_energy_penalty = config.density_diffusion = config.bulk_viscosity = 0;
                    const bool first = stress == GP_STRESS_ELASTIC && density == GP_DENSITY_CONTINUITY && nonlocal;
                    const bool implicit = stress == GP_STRESS_IMPLICIT && density == GP_DENSITY_CONTINUITY && nonlocal;
                    if (first || implicit || (stress == GP_STRESS_REGULARIZED && density == GP_DENSITY_NUMBER)) {
                        EXPECT_EQ(create(config), GP_OK) << gp_last_error();
                    } else {
                        EXPECT_FAILS(create(config), GP_E_UNSUPPORTED, "possible are");
                    }
                }
}

// What the default scheme alone has is refused rather than ignored.
TEST(Config, SettingsThatTheSchemeDoesNotHaveAreRefused) {
    const std::pair<const char *, double gp_config::*> settings[] = {
        {"zero_energy_penalty", &gp_config::zero_energy_penalty},
        {"density_diffusion", &gp_config::density_diffusion},
        {"bulk_viscosity", &gp_config::bulk_viscosity},
    };
    for (const int32_t preset : {GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL})
        for (const auto &setting : settings) {
            gp_config config;
            ASSERT_EQ(gp_config_init(&config, sizeof config, preset), GP_OK);
            config.*setting.second = 0.1;
            EXPECT_FAILS(create(config), GP_E_ARGUMENT, setting.first);
        }
}

// The time step cannot be judged before the scene is complete: it is refused at the first step, and the scene is still
// open then.
TEST(Config, UnstableTimeStepIsRefusedAtTheFirstStep) {
    struct Choice {
        const char *name;
        double gp_config::*member;
        double value;
    };
    for (const Choice &choice :
         {Choice{"time_step", &gp_config::time_step, 1.0}, Choice{"cfl", &gp_config::cfl, 2.0}}) {
        SCOPED_TRACE(choice.name);
        gp_config config = make_config();
        config.*choice.member = choice.value;
        Sim sim(config);
        add_collapse(sim, 4, 4);
        const uint64_t epoch = sim.epoch();
        EXPECT_FAILS(gp_step(sim, 1), GP_E_ARGUMENT, choice.name);
        EXPECT_FAILS(gp_run(sim, 0.1), GP_E_ARGUMENT, choice.name);
        EXPECT_EQ(sim.state().step, 0);
        EXPECT_EQ(sim.state().time, 0);
        EXPECT_EQ(sim.epoch(), epoch);
        sim.add(make_column(2, 2, 1, 0));
        EXPECT_EQ(sim.count(), 20);
    }
}

TEST(Config, FixedTimeStepAndCflAreUsed) {
    gp_config config = make_config();
    config.time_step = 1e-4;
    Sim fixed(config);
    add_collapse(fixed, 4, 4);
    ASSERT_EQ(gp_step(fixed, 3), GP_OK) << gp_last_error();
    EXPECT_EQ(fixed.state().dt, 1e-4);
    EXPECT_DOUBLE_EQ(fixed.state().time, 3e-4);

    config.time_step = 0;
    double dt[2];
    for (int k = 0; k < 2; ++k) {
        config.cfl = k == 0 ? 0.1 : 0.2;
        Sim sim(config);
        add_collapse(sim, 4, 4);
        ASSERT_EQ(gp_step(sim, 1), GP_OK) << gp_last_error();
        dt[k] = sim.state().dt;
    }
    EXPECT_DOUBLE_EQ(dt[1], 2 * dt[0]);
}

TEST(Config, SoundSpeedFollowsFromTheScene) {
    gp_config config = make_config();
    {
        Sim sim(config);
        sim.add(make_floor());
        sim.add(make_column(5, 10));
        EXPECT_NEAR(sim.state().sound_speed, 10 * std::sqrt(2 * 9.81 * 10 * spacing), 1e-9);
    }
    config.sound_speed = 12.5;
    Sim sim(config);
    sim.add(make_column(5, 10));
    EXPECT_EQ(sim.state().sound_speed, 12.5);
}

TEST(Config, JitterDisplacesByUpToItsShareAndFollowsTheSeed) {
    gp_config config = make_config();
    config.jitter = 0.3;
    std::vector<double> x[3];
    for (std::size_t k = 0; k < 3; ++k) {
        config.seed = k == 2 ? 1 : 0;
        Sim sim(config);
        sim.add(make_column(20, 20));
        x[k] = sim.field(GP_FIELD_X);
    }
    EXPECT_EQ(x[0], x[1]);
    EXPECT_NE(x[0], x[2]);
    double largest = 0;
    for (std::size_t k = 0; k < x[0].size(); ++k)
        largest = std::max(largest, std::abs(x[0][k] - (static_cast<double>(k % 20) + 0.5) * spacing) / spacing);
    EXPECT_LE(largest, 0.3 + 1e-12);
    EXPECT_GT(largest, 0.25);
}
