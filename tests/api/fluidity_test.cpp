// The granular fluidity as a program sees it: what is refused, what older programs get, where it is read, and that threads and
// retries keep its bits. What it does to a flow is tested by physics/fluidity_test.cpp.
#include "fluidity_support.hpp"
#include "log_support.hpp"

using namespace api;

// ------------------------------------------------------------------------------------------------- arguments

TEST(FluidityArguments, AreOffByDefault) {
    const gp_material material = make_material();
    EXPECT_EQ(material.nonlocal_amplitude, 0);
    EXPECT_EQ(material.fluidity_time, 1e-4);
    EXPECT_EQ(make_floor().fluidity, GP_FLUIDITY_FREE);
}

TEST(FluidityArguments, OutOfRangeAreNamedWithTheirRange) {
    Sim sim;
    const auto refuse = [&](double gp_material::*member, double value, const char *text) {
        gp_material material = make_fluid();
        material.*member = value;
        int32_t id = 7;
        EXPECT_FAILS(gp_add_material(sim, &material, &id), GP_E_ARGUMENT, text);
        EXPECT_EQ(id, 0);
    };
    for (const double value : {-0.1, 10.1, infinite, -infinite, not_a_number})
        refuse(&gp_material::nonlocal_amplitude, value, "expected a number from 0 to 10");
    refuse(&gp_material::nonlocal_amplitude, 12, "gp_material.nonlocal_amplitude = 12");
    for (const double value : {0.0, -1e-4, infinite, not_a_number})
        refuse(&gp_material::fluidity_time, value, "gp_material.fluidity_time = ");
    refuse(&gp_material::fluidity_time, 0, "expected a finite number > 0");
    refuse(&gp_material::mu_s, 0, "gp_material.mu_s = 0: expected a number > 0 with nonlocal_amplitude");
    gp_material flat = make_fluid();
    flat.mu_2 = flat.mu_s;
    EXPECT_FAILS(gp_add_material(sim, &flat, nullptr), GP_E_ARGUMENT,
                 "expected a number > mu_s with nonlocal_amplitude");
    flat.nonlocal_amplitude = flat.mu_s = 0; // neither is asked for by the local law
    EXPECT_EQ(gp_add_material(sim, &flat, nullptr), GP_OK) << gp_last_error();
    for (const double value : {1e-3, 10.0}) {
        const gp_material material = make_fluid(value);
        EXPECT_EQ(gp_add_material(sim, &material, nullptr), GP_OK) << gp_last_error();
    }
}

TEST(FluidityArguments, FrictionFactorZeroLeavesNothingToYield) {
    gp_config config = make_config();
    config.friction_factor = 0;
    Sim sim(config);
    const gp_material material = make_fluid();
    EXPECT_FAILS(gp_add_material(sim, &material, nullptr), GP_E_ARGUMENT, "gp_config.friction_factor = 0");
    sim.add(make_fluid(0));
}

TEST(FluidityArguments, OtherSchemesDoNotHaveIt) {
    gp_config configs[3] = {make_config(), {}, {}};
    configs[0].stress = GP_STRESS_IMPLICIT;
    ASSERT_EQ(gp_config_init(&configs[1], sizeof(gp_config), GP_PRESET_PAPER), GP_OK);
    ASSERT_EQ(gp_config_init(&configs[2], sizeof(gp_config), GP_PRESET_PAPER_LOCAL), GP_OK);
    for (const gp_config &config : configs) {
        Sim sim(config);
        const gp_material material = make_fluid();
        EXPECT_FAILS(gp_add_material(sim, &material, nullptr), GP_E_UNSUPPORTED,
                     "gp_material.nonlocal_amplitude = 0.48: expected 0");
        sim.add(make_fluid(0));
        gp_plate floor = make_floor();
        floor.fluidity = GP_FLUIDITY_ZERO; // says nothing where no material has one
        sim.add(floor);
    }
}

TEST(FluidityArguments, OfAPlateAreAChoice) {
    Sim sim;
    for (const int32_t value : {-1, 2}) {
        gp_plate floor = make_floor();
        floor.fluidity = value;
        EXPECT_FAILS(gp_add_plate(sim, &floor, nullptr), GP_E_ARGUMENT, "gp_plate.fluidity = ");
        EXPECT_TRUE(last_error_has("expected a whole number from 0 to 1"));
    }
}

// -------------------------------------------------------------------------------------------- older programs

// A program of 0.1 has structs that end before the new members: what lies behind them is not its own.
TEST(FluidityOfOlderPrograms, AMaterialIsOfTheLocalLaw) {
    ASSERT_EQ(offsetof(gp_material, nonlocal_amplitude), 56u) << "the size in 0.1";
    const auto after = [](uint32_t size, double beyond) {
        gp_material material = make_fluid(beyond);
        material.fluidity_time = beyond > 0 ? -1 : material.fluidity_time;
        material.struct_size = size;
        Sim sim;
        add_fluid_collapse(sim, 8, 8, material);
        EXPECT_EQ(gp_step(sim, 20), GP_OK) << gp_last_error();
        return snapshot(sim, collapse_plates);
    };
    EXPECT_TRUE(after(56, 0.48) == after(sizeof(gp_material), 0));
}

TEST(FluidityOfOlderPrograms, APlatePassesNoFlux) {
    const auto after = [](uint32_t size, int32_t fluidity) {
        gp_plate floor = couette_floor();
        floor.fluidity = fluidity;
        floor.struct_size = size;
        Sim sim(couette_config());
        add_couette(sim, floor);
        EXPECT_EQ(gp_step(sim, 200), GP_OK) << gp_last_error();
        return snapshot(sim, couette_plates);
    };
    const uint32_t of_first = offsetof(gp_plate, n_points), before = offsetof(gp_plate, fluidity);
    const std::vector<uint64_t> free = after(sizeof(gp_plate), GP_FLUIDITY_FREE);
    EXPECT_TRUE(after(of_first, GP_FLUIDITY_ZERO) == free);
    EXPECT_TRUE(after(before, 7) == free);
    EXPECT_FALSE(after(sizeof(gp_plate), GP_FLUIDITY_ZERO) == free);
}

TEST(FluidityOfOlderPrograms, ViewsEndBeforeIt) {
    Sim sim;
    add_fluid_collapse(sim);
    gp_particles particles{};
    particles.struct_size = offsetof(gp_particles, fluidity);
    const double sentinel = 0;
    particles.fluidity = &sentinel;
    ASSERT_EQ(gp_get_particles(sim, GP_FIELD_ALL, &particles), GP_OK) << gp_last_error();
    EXPECT_EQ(particles.fluidity, &sentinel);
    EXPECT_NE(particles.number_density, nullptr);
}

// --------------------------------------------------------------------------------------------------- reading

TEST(Fluidity, IsReadLikeAnyField) {
    Sim sim(couette_config());
    add_couette(sim);
    EXPECT_EQ(largest(sim.field(GP_FIELD_FLUIDITY)), 0) << "at rest before the first step";
    ASSERT_EQ(gp_step(sim, 300), GP_OK) << gp_last_error();
    EXPECT_EQ(GP_FIELD_ALL & GP_FIELD_FLUIDITY, GP_FIELD_FLUIDITY);
    const gp_particles all = sim.view(GP_FIELD_ALL);
    const std::vector<double> copy = sim.field(GP_FIELD_FLUIDITY);
    ASSERT_NE(all.fluidity, nullptr);
    for (int64_t i = 0; i < all.count; ++i)
        EXPECT_EQ(all.fluidity[i], copy[static_cast<std::size_t>(all.id[i])]);
    EXPECT_EQ(sim.view(GP_FIELD_ALL & ~GP_FIELD_FLUIDITY).fluidity, nullptr);
    EXPECT_GT(largest(copy), 0);
    EXPECT_GE(*std::min_element(copy.begin(), copy.end()), 0);
    gp_particles particles{};
    particles.struct_size = sizeof particles;
    EXPECT_FAILS(gp_get_particles(sim, GP_FIELD_ALL + 1, &particles), GP_E_ARGUMENT, "fields");
}

// Of two materials in one scene the one without has none, and moves as it does alone.
TEST(Fluidity, IsOfTheMaterialsThatHaveAnAmplitude) {
    gp_config config = make_config();
    config.sound_speed = 12;
    config.time_step = 4e-4;
    const auto build = [](Sim &sim, double amplitude) {
        sim.add(make_floor());
        sim.add(make_column(10, 9)); // beads, far from what follows
        gp_column column = make_column(10, 9, 80 * spacing, 0);
        column.material = sim.add(make_fluid(amplitude));
        sim.add(column);
        EXPECT_EQ(gp_step(sim, 200), GP_OK) << gp_last_error();
    };
    Sim both(config), local(config);
    build(both, 0.48);
    build(local, 0);
    EXPECT_EQ(largest(of_column(both, 0, GP_FIELD_FLUIDITY)), 0);
    EXPECT_GT(largest(of_column(both, 1, GP_FIELD_FLUIDITY)), 1e-3);
    EXPECT_EQ(largest(local.field(GP_FIELD_FLUIDITY)), 0);
    const std::vector<double> x = of_column(both, 0, GP_FIELD_X), alone = of_column(local, 0, GP_FIELD_X);
    for (std::size_t i = 0; i < x.size(); ++i) // other loops, so other rounding
        EXPECT_NEAR(x[i], alone[i], 1e-9 * spacing);
    const std::vector<double> other_x = of_column(both, 1, GP_FIELD_X), other_alone = of_column(local, 1, GP_FIELD_X);
    double apart = 0;
    for (std::size_t i = 0; i < other_x.size(); ++i)
        apart = std::max(apart, std::abs(other_x[i] - other_alone[i]));
    EXPECT_GT(apart, 1e-3 * spacing);
}

// Without friction, and so without a stress to flow at: grains in flight beside those of another material.
TEST(Fluidity, OfAMaterialWithoutFrictionIsZero) {
    Sim sim;
    gp_material smooth = make_material();
    smooth.mu_s = smooth.mu_2 = 0;
    gp_column grain = make_column(2, 2, 0, 20 * spacing);
    grain.material = sim.add(smooth);
    sim.add(grain);
    gp_column column = make_column(8, 6);
    column.material = sim.add(make_fluid());
    sim.add(column);
    sim.add(make_floor());
    ASSERT_EQ(gp_step(sim, 20), GP_OK) << gp_last_error();
    for (const double value : of_column(sim, 0, GP_FIELD_FLUIDITY))
        EXPECT_EQ(value, 0);
}

// A material that no column is of changes nothing.
TEST(Fluidity, DoesNotExistWhereNoParticleHasIt) {
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        if (k == 1)
            sim.add(make_fluid());
        add_collapse(sim);
        ASSERT_EQ(gp_step(sim, 40), GP_OK);
        bits[k] = snapshot(sim, collapse_plates);
        for (const gp_plan_entry &entry : sim.plan())
            if (std::string(entry.name) == "fluidity") {
                EXPECT_EQ(entry.active, 0);
                EXPECT_EQ(entry.bytes, 0);
                EXPECT_EQ(entry.calls, 0);
                EXPECT_STREQ(entry.reason, "nonlocal_amplitude is 0");
            }
    }
    EXPECT_TRUE(bits[0] == bits[1]);
}

// ------------------------------------------------------------------------------------------------- same bits

// The layer does not know where its period ends: what is uniform along it stays so, but for rounding.
TEST(Fluidity, IsUniformOverTheEndsOfAPeriod) {
    Sim sim(couette_config());
    add_couette(sim);
    ASSERT_EQ(gp_step(sim, 400), GP_OK) << gp_last_error();
    for (const uint32_t field : {GP_FIELD_VX, GP_FIELD_FLUIDITY}) {
        const std::vector<double> values = sim.field(field);
        const double scale = largest(values);
        for (std::size_t row = 0; row < values.size() / around; ++row) {
            const auto [least, most] = std::minmax_element(values.begin() + static_cast<int64_t>(row) * around,
                                                           values.begin() + static_cast<int64_t>(row + 1) * around);
            EXPECT_LT(*most - *least, 1e-9 * scale) << "row " << row << ", field " << field;
        }
    }
}

TEST(Fluidity, HasTheSameBitsForAnyNumberOfThreads) {
    if (!has("openmp"))
        GTEST_SKIP() << "no OpenMP in this build";
    const auto after = [](int32_t threads) {
        gp_config config = make_config();
        config.threads = threads;
        config.jitter = 0.05;
        Sim sim(config);
        add_fluid_collapse(sim, 40, 32);
        EXPECT_GT(sim.count(), 1200);
        EXPECT_EQ(gp_step(sim, 80), GP_OK) << gp_last_error();
        return snapshot(sim, collapse_plates);
    };
    const std::vector<uint64_t> one = after(1);
    for (const int32_t threads : {2, 3, 4})
        EXPECT_TRUE(after(threads) == one) << threads << " threads";
}

namespace {

gp_config unstable_fluid_config() {
    gp_config config = make_config();
    Sim sim(config);
    add_fluid_collapse(sim, 30, 24);
    config.time_step = 4 * sim.state().dt_limit;
    config.allow_unstable_step = 1;
    return config;
}

} // namespace

TEST(Fluidity, OfAStepThatDivergesIsThatBeforeIt) {
    Sim sim(unstable_fluid_config());
    add_fluid_collapse(sim, 30, 24);
    std::vector<double> before;
    gp_status status = GP_OK;
    for (int k = 0; k < 1000 && status == GP_OK; ++k) {
        before = sim.field(GP_FIELD_FLUIDITY);
        status = gp_step(sim, 1);
    }
    ASSERT_EQ(status, GP_E_DIVERGED) << gp_last_error();
    EXPECT_GT(largest(before), 0);
    EXPECT_TRUE(sim.field(GP_FIELD_FLUIDITY) == before);
}

TEST(Fluidity, OfAStepTakenAnewIsThatOfTheShorterStepAtOnce) {
    gp_config config = unstable_fluid_config();
    config.retry_halvings = 10;
    Sim retried(config);
    add_fluid_collapse(retried, 30, 24);
    while (retried.state().retries == 0)
        ASSERT_EQ(gp_step(retried, 1), GP_OK) << gp_last_error();
    const gp_state s = retried.state();
    config.retry_halvings = 0;
    Sim at_once(config);
    add_fluid_collapse(at_once, 30, 24);
    ASSERT_EQ(gp_step(at_once, s.step - 1), GP_OK) << gp_last_error();
    ASSERT_EQ(gp_run(at_once, s.time), GP_OK) << gp_last_error();
    for (const uint32_t field : {GP_FIELD_X, GP_FIELD_VX, GP_FIELD_SXY, GP_FIELD_FLUIDITY})
        EXPECT_TRUE(retried.field(field) == at_once.field(field)) << "field " << field;
}

// ---------------------------------------------------------------------------------------------------- log

TEST(FluidityLog, TellsOnceThatASpacingIsTooCoarse) {
    const auto build = [](double diameter, double amplitude) {
        return [=](Sim &sim) {
            gp_material material = make_fluid(amplitude);
            material.grain_diameter = diameter;
            sim.add(material); // not in use: of no account
            gp_column column = make_column(8, 8);
            column.material = sim.add(material);
            sim.add(make_floor());
            sim.add(column);
        };
    };
    expect_once(make_config(), build(spacing, 0.48), 0.01,
                {"gp_material.nonlocal_amplitude = 0.48 of material 2", "0.0048 m", "spacing of 0.01 m",
                 "set gp_config.spacing to at most 0.005", "or nonlocal_amplitude to 0"});
    expect_silence(make_config(), build(2 * spacing, 0.48), 0.01);
    expect_silence(make_config(), build(spacing, 0), 0.01);
    expect_silence(
        make_config(),
        [&](Sim &sim) {
            sim.add(make_fluid(0.48));
            sim.add(make_floor());
            sim.add(make_column(8, 8));
        },
        0.01);
}
