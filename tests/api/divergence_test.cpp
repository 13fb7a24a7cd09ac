// What happens to a step that diverges, and taking it anew in halves.
#include <cstring>

#include "log_support.hpp"

using namespace api;

namespace {

struct Step {
    double time, dt;
    int64_t step;
    int32_t reason;
};

// Every step that the callback sees.
struct Record {
    std::vector<Step> steps;
    static int32_t run(void *user, gp_sim *sim) {
        gp_state s{};
        s.struct_size = sizeof s;
        EXPECT_EQ(gp_get_state(sim, &s), GP_OK);
        static_cast<Record *>(user)->steps.push_back({s.time, s.dt, s.step, s.dt_reason});
        return 0;
    }
};

double limit_of(const gp_config &config) {
    Sim sim(config);
    add_collapse(sim);
    return sim.state().dt_limit;
}

// A demanded step so far beyond the limit that the collapse diverges within a few.
gp_config unstable_config(int32_t preset = GP_PRESET_DEFAULT) {
    gp_config config;
    EXPECT_EQ(gp_config_init(&config, sizeof config, preset), GP_OK);
    config.spacing = spacing;
    config.threads = 1;
    config.time_step = 8 * limit_of(config);
    config.allow_unstable_step = 1;
    return config;
}

// Everything in the library's own order; all but the number density, which is summed in the order of the last sort.
std::vector<uint64_t> views(const Sim &sim) {
    const gp_particles p = sim.view(GP_FIELD_ALL & ~GP_FIELD_NUMBER_DENSITY);
    std::vector<uint64_t> bits;
    for (const double *field : {p.x, p.y, p.vx, p.vy, p.pressure, p.density, p.sxx, p.sxy, p.syy, p.shear_rate,
                                p.inertial_number, p.viscosity, p.fluidity})
        for (int64_t i = 0; i < p.count; ++i)
            bits.push_back(bits_of(field[i]));
    bits.insert(bits.end(), p.id, p.id + p.count);
    bits.insert(bits.end(), p.column, p.column + p.count);
    return bits;
}

// The state and the loads.
std::vector<uint64_t> scalars(const Sim &sim, int32_t plates) {
    std::vector<uint64_t> bits;
    add_state(bits, but_for_lists(sim.state()));
    add_loads(bits, sim, plates);
    return bits;
}

} // namespace

// ------------------------------------------------------------------------------------------------ divergence

// Fields, their order, the state and the loads are those before the step that failed, for every scheme, in steps that sort
// the particles and in steps that do not, and for any number of threads.
TEST(Divergence, LeavesTheLastGoodStepBitForBit) {
    for (const int32_t preset : {GP_PRESET_DEFAULT, GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL})
        for (const double factor : {0.55, 1.0}) // in shares of the 8 limits: of some the failing step sorts
            for (const int32_t threads : {1, 4}) {
                if (threads > 1 && !has("openmp"))
                    continue;
                SCOPED_TRACE(testing::Message() << "preset " << preset << ", " << factor << ", threads " << threads);
                gp_config config = unstable_config(preset);
                config.time_step *= factor;
                config.threads = threads;
                Sim sim(config);
                add_collapse(sim, 30, 24);
                gp_status status = GP_OK;
                std::vector<uint64_t> fields, state;
                std::vector<double> number_density;
                uint64_t epoch = 0;
                for (int k = 0; k < 1000 && status == GP_OK; ++k) {
                    fields = views(sim);
                    state = scalars(sim, 3);
                    number_density = sim.field(GP_FIELD_NUMBER_DENSITY);
                    epoch = sim.epoch();
                    status = gp_step(sim, 1);
                }
                ASSERT_EQ(status, GP_E_DIVERGED) << gp_last_error();
                for (const char *named : {"particle", "at (", "time", "step"})
                    EXPECT_TRUE(last_error_has(named)) << gp_last_error();
                EXPECT_NE(sim.epoch(), epoch);
                EXPECT_EQ(views(sim), fields);
                EXPECT_EQ(scalars(sim, 3), state);
                const std::vector<double> after = sim.field(GP_FIELD_NUMBER_DENSITY);
                for (std::size_t i = 0; i < after.size(); ++i)
                    ASSERT_NEAR(after[i], number_density[i], 1e-12 * (1 + number_density[i]));
                EXPECT_EQ(gp_step(sim, 1), GP_E_STATE);
                EXPECT_EQ(gp_run(sim, 1e9), GP_E_STATE);
                sim.plan();
            }
}

// Returned positions stay in the period, and so does the order of that sort; all else is as it was.
TEST(Divergence, LeavesTheLastGoodStepOfAPeriodicScene) {
    gp_config config = make_config();
    config.periodic_x_min = 0;
    config.periodic_x_max = 20 * spacing;
    config.gravity_x = 5;
    const auto build = [](Sim &sim) {
        sim.add(make_plate(20 * spacing, 0, 0, 0));
        sim.add(make_column(20, 10));
    };
    {
        Sim sim(config);
        build(sim);
        config.time_step = 8 * sim.state().dt_limit;
    }
    config.allow_unstable_step = 1;
    Sim sim(config);
    build(sim);
    gp_status status = GP_OK;
    const uint32_t kept[] = {GP_FIELD_Y,       GP_FIELD_VX,  GP_FIELD_VY,  GP_FIELD_PRESSURE,
                             GP_FIELD_DENSITY, GP_FIELD_SXX, GP_FIELD_SXY, GP_FIELD_SHEAR_RATE};
    std::vector<std::vector<double>> before;
    std::vector<double> x;
    gp_state state{};
    for (int k = 0; k < 1000 && status == GP_OK; ++k) {
        before.clear();
        for (const uint32_t field : kept)
            before.push_back(sim.field(field));
        x = sim.field(GP_FIELD_X);
        state = sim.state();
        status = gp_step(sim, 1);
    }
    ASSERT_EQ(status, GP_E_DIVERGED) << gp_last_error();
    ASSERT_GT(state.step, 1);
    for (std::size_t k = 0; k < before.size(); ++k)
        EXPECT_EQ(sim.field(kept[k]), before[k]) << "field " << k;
    const std::vector<double> after = sim.field(GP_FIELD_X);
    for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_NEAR(std::remainder(after[i] - x[i], 20 * spacing), 0, 1e-14);
    EXPECT_EQ(sim.state().time, state.time);
    EXPECT_EQ(sim.state().dt_reason, state.dt_reason);
    EXPECT_NEAR(sim.state().kinetic, state.kinetic, 1e-12 * state.kinetic);
    EXPECT_NEAR(sim.state().potential, state.potential, 1e-12 * state.kinetic);
}

// --------------------------------------------------------------------------------------------------- retries

TEST(Retry, HalvesTheStepThatDivergesAndGoesOn) {
    gp_config config = unstable_config();
    const double end = 40.5 * config.time_step;
    Sim stops(config);
    add_collapse(stops);
    ASSERT_EQ(gp_run(stops, end), GP_E_DIVERGED) << gp_last_error();
    EXPECT_EQ(stops.state().retries, 0);
    const int64_t good = stops.state().step;

    config.retry_halvings = 6;
    Sim goes_on(config);
    add_collapse(goes_on);
    Log log;
    ASSERT_EQ(gp_set_log(goes_on, Log::run, &log), GP_OK);
    Record record;
    ASSERT_EQ(gp_set_callback(goes_on, 1, Record::run, &record), GP_OK);
    ASSERT_EQ(gp_run(goes_on, end), GP_OK) << gp_last_error();
    EXPECT_EQ(goes_on.state().time, end);
    EXPECT_GT(goes_on.state().retries, 0);
    EXPECT_EQ(log.count({"retry_halvings"}), 1);

    // What the callback saw are whole steps in a row; those of a diverged step are its halves, or halves of these.
    double time = 0;
    bool halved = false;
    for (std::size_t k = 0; k < record.steps.size(); ++k) {
        const Step &step = record.steps[k];
        EXPECT_EQ(step.step, static_cast<int64_t>(k + 1));
        EXPECT_NEAR(step.time - time, step.dt, 1e-12 * end);
        if (static_cast<int64_t>(k) < good) {
            EXPECT_EQ(step.reason, GP_DT_DEMANDED);
        }
        if (step.reason == GP_DT_RETRY && step.time < end - 2 * config.time_step) { // the last ones land on the end
            const double share = std::log2(config.time_step / step.dt);
            EXPECT_NEAR(share, std::round(share), 1e-6);
            EXPECT_GE(share, 0.9);
            EXPECT_LE(share, 6.1);
            halved = true;
        }
        time = step.time;
    }
    EXPECT_TRUE(halved);
    // The two halves end where the whole would have: on the raster of the demanded steps.
    for (int64_t n = 1; n < 39; ++n) { // the run's last steps are shortened to land on its end
        double nearest = infinite;
        for (const Step &step : record.steps)
            nearest = std::min(nearest, std::abs(step.time - static_cast<double>(n) * config.time_step));
        EXPECT_LT(nearest, 1e-9 * end) << "after " << n << " steps";
    }
}

// A step taken anew is the step that would have been taken at once: undone means as if it had never been.
TEST(Retry, IsTheSameAsTheShorterStepAtOnce) {
    for (const int32_t preset : {GP_PRESET_DEFAULT, GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL})
        for (const int32_t threads : {1, 4}) {
            if (threads > 1 && !has("openmp"))
                continue;
            SCOPED_TRACE(testing::Message() << "preset " << preset << ", threads " << threads);
            gp_config config = unstable_config(preset);
            config.threads = threads;
            config.retry_halvings = 10;
            Sim retried(config);
            add_collapse(retried, 30, 24);
            while (retried.state().retries == 0)
                ASSERT_EQ(gp_step(retried, 1), GP_OK) << gp_last_error();
            const gp_state s = retried.state();
            ASSERT_EQ(s.dt_reason, GP_DT_RETRY);

            config.retry_halvings = 0;
            Sim at_once(config);
            add_collapse(at_once, 30, 24);
            ASSERT_EQ(gp_step(at_once, s.step - 1), GP_OK) << gp_last_error();
            ASSERT_EQ(gp_run(at_once, s.time), GP_OK) << gp_last_error();
            EXPECT_EQ(at_once.state().step, s.step);
            for (const uint32_t field : {GP_FIELD_X, GP_FIELD_Y, GP_FIELD_VX, GP_FIELD_VY, GP_FIELD_PRESSURE,
                                         GP_FIELD_DENSITY, GP_FIELD_SXX, GP_FIELD_SXY, GP_FIELD_SHEAR_RATE})
                EXPECT_EQ(retried.field(field), at_once.field(field)) << "field " << field;
            EXPECT_EQ(s.dissipated, at_once.state().dissipated);
            EXPECT_EQ(retried.load(0).fy, at_once.load(0).fy);
        }
}

TEST(Retry, GivesUpAfterItsHalvings) {
    // Beside each other at twice the speed of sound: a blow that makes the density double however short the steps are.
    gp_config config = make_config();
    config.sound_speed = 1;
    config.gravity_y = 0;
    config.retry_halvings = 3;
    Sim sim(config);
    gp_column left = make_column(10, 10), right = make_column(10, 10, 10 * spacing);
    left.vx = 4;
    right.vx = -4;
    sim.add(left);
    sim.add(right);
    Log log;
    ASSERT_EQ(gp_set_log(sim, Log::run, &log), GP_OK);
    ASSERT_EQ(gp_run(sim, 0.1), GP_E_DIVERGED);
    EXPECT_TRUE(last_error_has("density")) << gp_last_error();
    EXPECT_GE(sim.state().retries, 3);
    EXPECT_EQ(gp_step(sim, 1), GP_E_STATE);
    for (const double value : sim.field(GP_FIELD_DENSITY))
        EXPECT_LT(value, 2 * 1550);
}

TEST(Retry, CostsNoMemoryOfItsOwn) {
    int64_t bytes[2];
    for (int32_t k = 0; k < 2; ++k) {
        gp_config config = make_config();
        config.retry_halvings = 5 * k;
        Sim sim(config);
        add_collapse(sim);
        ASSERT_EQ(gp_step(sim, 2), GP_OK);
        bytes[k] = 0;
        for (const gp_plan_entry &entry : sim.plan()) {
            bytes[k] += entry.bytes;
            if (std::strcmp(entry.name, "kept_fields") == 0) {
                EXPECT_EQ(entry.active, 1);
                EXPECT_EQ(entry.bytes, sim.count() * 3 * 8) << "density; half of the gradient's other memory";
            }
        }
    }
    EXPECT_EQ(bytes[0], bytes[1]);
}
