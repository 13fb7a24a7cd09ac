// Values at the ends of what is allowed: any status that says what is wrong will do, but no crash, no hang, no defect
// reported by the library, and no mention of a missing feature.
#include <cfloat>
#include <cstdio>
#include <functional>

#include "api_support.hpp"

using namespace api;

namespace {

constexpr double smallest = std::numeric_limits<double>::denorm_min();

void expect_sane(gp_status status, const std::string &what) {
    EXPECT_TRUE(status == GP_OK || status == GP_E_ARGUMENT || status == GP_E_DIVERGED || status == GP_E_STATE)
        << what << ": " << gp_status_string(status) << ", " << gp_last_error();
    if (status != GP_OK) {
        EXPECT_STRNE(gp_last_error(), "") << what;
    }
}

std::string shown(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

// Builds the scene as far as it is accepted, takes steps and reads everything.
void exercise(const std::string &what, const gp_config &config, const std::function<void(gp_sim *)> &build) {
    SCOPED_TRACE(what);
    gp_sim *sim = nullptr;
    const gp_status created = gp_create(&config, &sim);
    expect_sane(created, "gp_create");
    if (created != GP_OK)
        return;
    build(sim);
    gp_status stepped = GP_OK;
    for (int k = 0; k < 3; ++k) {
        const gp_status status = gp_step(sim, 1);
        expect_sane(status, "gp_step");
        stepped = stepped == GP_OK ? status : stepped;
    }
    gp_particles p{};
    p.struct_size = sizeof p;
    expect_sane(gp_get_particles(sim, GP_FIELD_ALL, &p), "gp_get_particles");
    gp_state state{};
    state.struct_size = sizeof state;
    expect_sane(gp_get_state(sim, &state), "gp_get_state");
    if (stepped == GP_OK) { // else gp_run would never come to an end
        EXPECT_GT(state.time, 0) << "steps that take no time are no steps";
    }
    const double at[3] = {0, 0.02, 1e300};
    double out[3];
    expect_sane(gp_get_surface(sim, 3, at, out), "gp_get_surface");
    expect_sane(gp_get_interface(sim, 0, 1, 3, at, out), "gp_get_interface");
    int64_t n;
    expect_sane(gp_get_plan(sim, 0, nullptr, &n), "gp_get_plan");
    gp_destroy(sim);
}

void add_two_columns(gp_sim *sim, double unit) {
    gp_column column = make_column(1, 1);
    column.width = 3 * unit;
    column.height = 3 * unit;
    const gp_plate floor = make_plate(100 * unit, 0, -100 * unit, 0);
    expect_sane(gp_add_plate(sim, &floor, nullptr), "gp_add_plate");
    expect_sane(gp_add_column(sim, &column, nullptr), "gp_add_column");
    column.x_min = 3 * unit;
    expect_sane(gp_add_column(sim, &column, nullptr), "gp_add_column");
}

} // namespace

TEST(Extremes, OfTheConfig) {
    struct Field {
        const char *name;
        double gp_config::*member;
        std::vector<double> values;
    };
    const std::vector<double> positive = {smallest, DBL_MIN, 1e-150, 1e150, DBL_MAX};
    const std::vector<Field> fields = {
        {"spacing", &gp_config::spacing, {smallest, DBL_MIN, 1e-160, 1e-100, 1e100, 1e160, DBL_MAX}},
        {"gravity_x", &gp_config::gravity_x, {smallest, 1e-160, 1e160, DBL_MAX, -DBL_MAX}},
        {"gravity_y", &gp_config::gravity_y, {0, -smallest, -1e-160, -1e160, DBL_MAX, -DBL_MAX}},
        {"sound_speed", &gp_config::sound_speed, positive},
        {"cfl", &gp_config::cfl, {smallest, 1e-300}},
        {"time_step", &gp_config::time_step, positive},
        {"horizon_length", &gp_config::horizon_length, {smallest, DBL_MAX}},
        {"friction_factor", &gp_config::friction_factor, {smallest}},
        {"delta", &gp_config::delta, positive},
        {"collision_distance", &gp_config::collision_distance, {smallest}},
        {"zero_energy_penalty", &gp_config::zero_energy_penalty, {smallest}},
        {"density_diffusion", &gp_config::density_diffusion, {smallest}},
        {"bulk_viscosity", &gp_config::bulk_viscosity, {smallest}},
    };
    for (const Field &field : fields)
        for (const double value : field.values) {
            gp_config config = make_config();
            config.*field.member = value;
            const double unit = config.spacing;
            exercise(std::string(field.name) + " = " + shown(value), config,
                     [&](gp_sim *sim) { add_two_columns(sim, unit); });
        }
}

TEST(Extremes, OfMaterials) {
    for (double gp_material::*const member :
         {&gp_material::grain_density, &gp_material::volume_fraction, &gp_material::grain_diameter, &gp_material::mu_s,
          &gp_material::mu_2, &gp_material::i0})
        for (const double value : {smallest, 1e-160, 1e160, DBL_MAX})
            exercise("material " + shown(value), make_config(), [&](gp_sim *sim) {
                gp_material material = make_material();
                material.*member = value;
                if (member == &gp_material::mu_s)
                    material.mu_2 = DBL_MAX;
                if (member == &gp_material::mu_2)
                    material.mu_s = 0;
                expect_sane(gp_add_material(sim, &material, nullptr), "gp_add_material");
                gp_column column = make_column(3, 3, 5 * spacing, 0);
                column.material = 1;
                expect_sane(gp_add_column(sim, &column, nullptr), "gp_add_column");
                add_two_columns(sim, spacing);
            });
}

TEST(Extremes, OfPositionsAndVelocities) {
    for (const double value : {smallest, 1e12, 1e18, 1e20, 1e160, DBL_MAX}) {
        const double far[2] = {-value, value}, zero[2] = {0, 0};
        exercise("positions " + shown(value), make_config(), [&](gp_sim *sim) {
            expect_sane(gp_add_particles(sim, 0, 2, far, far, nullptr, nullptr, nullptr), "gp_add_particles");
            add_two_columns(sim, spacing);
        });
        exercise("one column " + shown(value), make_config(), [&](gp_sim *sim) {
            gp_column column = make_column(3, 3, value, -value);
            expect_sane(gp_add_column(sim, &column, nullptr), "gp_add_column");
        });
        exercise("velocities " + shown(value), make_config(), [&](gp_sim *sim) {
            expect_sane(gp_add_particles(sim, 0, 2, zero, zero, far, far, nullptr), "gp_add_particles");
            add_two_columns(sim, spacing);
        });
        gp_config config = make_config();
        config.sound_speed = 10;
        exercise("velocities at a given sound speed " + shown(value), config, [&](gp_sim *sim) {
            expect_sane(gp_add_particles(sim, 0, 2, zero, zero, far, far, nullptr), "gp_add_particles");
            add_two_columns(sim, spacing);
        });
    }
}

TEST(Extremes, OfPlates) {
    for (const double value : {smallest, 1e-12, 1e5, 1e20, 1e160, DBL_MAX}) {
        const std::string text = shown(value);
        const auto with = [&](const char *what, const gp_plate &plate) {
            exercise(what + text, make_config(), [&](gp_sim *sim) {
                add_two_columns(sim, spacing);
                expect_sane(gp_add_plate(sim, &plate, nullptr), "gp_add_plate");
            });
        };
        gp_plate plate = make_floor();
        plate.vx = value;
        plate.vy = -value;
        with("velocity ", plate);
        plate = make_plate(value, 0, -value, 0);
        with("length ", plate);
        plate = make_plate(value, value, value, 2 * value < DBL_MAX ? 2 * value : 0);
        with("place ", plate);
        plate = make_floor();
        plate.friction = GP_WALL_COULOMB;
        plate.wall_mu = value;
        with("wall_mu ", plate);
        const double t[2] = {-value, value}, x[2] = {0, 1}, jump[2] = {-value, value}, soon[2] = {0, 1e-3};
        plate = make_floor();
        plate.n_knots = 2;
        plate.knot_t = t;
        plate.knot_x = plate.knot_y = x;
        with("times ", plate);
        plate.knot_t = soon;
        plate.knot_x = plate.knot_y = jump;
        with("displacements ", plate);
        exercise("driven " + text, make_config(), [&](gp_sim *sim) {
            add_two_columns(sim, spacing);
            expect_sane(gp_step(sim, 2), "gp_step");
            expect_sane(gp_set_plate_velocity(sim, 0, value, value), "gp_set_plate_velocity");
        });
    }
}

TEST(Extremes, ParticlesOnTopOfEachOther) {
    exercise("five at one place", make_config(), [&](gp_sim *sim) {
        const double x[5] = {0, 0, 0, 0, 0}, v[5] = {1, 0, -1, 0, 0};
        expect_sane(gp_add_particles(sim, 0, 5, x, x, v, v, nullptr), "gp_add_particles");
        expect_sane(gp_add_particles(sim, 0, 5, x, x, nullptr, nullptr, nullptr), "gp_add_particles");
        const gp_plate floor = make_floor();
        expect_sane(gp_add_plate(sim, &floor, nullptr), "gp_add_plate");
    });
}

TEST(Extremes, OfOutputIntervals) {
    if (!has("hdf5"))
        GTEST_SKIP() << "no HDF5 in this build";
    for (const double every : {smallest, 1e-300, 1e300, DBL_MAX}) {
        Sim sim;
        sim.add(make_column(2, 2));
        gp_output output = make_output();
        output.every_seconds = every;
        const gp_status status = gp_output_open(sim, (testing::TempDir() + "granperi_interval.h5").c_str(), &output);
        expect_sane(status, "gp_output_open");
        if (status != GP_OK)
            continue;
        EXPECT_EQ(gp_step(sim, 3), GP_OK) << gp_last_error();
        EXPECT_EQ(gp_output_close(sim), GP_OK);
    }
}
