// Missing pointers, out-pointers after errors, and that an error changes nothing.
#include <functional>

#include "api_support.hpp"

using namespace api;

namespace {

struct Call {
    const char *name; // of the argument that is missing
    std::function<gp_status()> call;
};

} // namespace

TEST(Pointers, EveryMissingPointerIsNamed) {
    Sim sim;
    add_collapse(sim, 3, 3);
    const gp_config config = make_config();
    const gp_material material = make_material();
    const gp_column column = make_column(2, 2);
    const gp_plate plate = make_floor();
    gp_particles particles{};
    particles.struct_size = sizeof particles;
    gp_state state{};
    state.struct_size = sizeof state;
    gp_load load{};
    load.struct_size = sizeof load;
    gp_plan_entry entry;
    gp_sim *other;
    int64_t n;
    double value = 0;
    std::vector<double> all(9);
    const std::vector<Call> calls = {
        {"gp_config", [&] { return gp_config_init(nullptr, sizeof(gp_config), GP_PRESET_DEFAULT); }},
        {"gp_material", [&] { return gp_material_init(nullptr, sizeof(gp_material)); }},
        {"gp_column", [&] { return gp_column_init(nullptr, sizeof(gp_column)); }},
        {"gp_plate", [&] { return gp_plate_init(nullptr, sizeof(gp_plate)); }},
        {"gp_output", [&] { return gp_output_init(nullptr, sizeof(gp_output)); }},
        {"config", [&] { return gp_create(nullptr, &other); }},
        {"sim", [&] { return gp_create(&config, nullptr); }},
        {"sim", [&] { return gp_add_material(nullptr, &material, nullptr); }},
        {"material", [&] { return gp_add_material(sim, nullptr, nullptr); }},
        {"sim", [&] { return gp_add_column(nullptr, &column, nullptr); }},
        {"column", [&] { return gp_add_column(sim, nullptr, nullptr); }},
        {"sim", [&] { return gp_add_particles(nullptr, 0, 1, &value, &value, nullptr, nullptr, nullptr); }},
        {"x", [&] { return gp_add_particles(sim, 0, 1, nullptr, &value, nullptr, nullptr, nullptr); }},
        {"y", [&] { return gp_add_particles(sim, 0, 1, &value, nullptr, nullptr, nullptr, nullptr); }},
        {"sim", [&] { return gp_add_plate(nullptr, &plate, nullptr); }},
        {"plate", [&] { return gp_add_plate(sim, nullptr, nullptr); }},
        {"sim", [&] { return gp_set_plate_velocity(nullptr, 0, 0, 0); }},
        {"sim", [&] { return gp_step(nullptr, 1); }},
        {"sim", [&] { return gp_step(nullptr, 0); }},
        {"sim", [&] { return gp_run(nullptr, 1); }},
        {"sim", [&] { return gp_set_callback(nullptr, 1, nullptr, nullptr); }},
        {"sim", [&] { return gp_set_log(nullptr, nullptr, nullptr); }},
        {"sim", [&] { return gp_get_particles(nullptr, 0, &particles); }},
        {"particles", [&] { return gp_get_particles(sim, 0, nullptr); }},
        {"sim", [&] { return gp_copy_field(nullptr, GP_FIELD_X, all.data(), 9); }},
        {"dst", [&] { return gp_copy_field(sim, GP_FIELD_X, nullptr, 9); }},
        {"sim", [&] { return gp_get_state(nullptr, &state); }},
        {"state", [&] { return gp_get_state(sim, nullptr); }},
        {"sim", [&] { return gp_get_state_parts(nullptr, 0, &state); }},
        {"state", [&] { return gp_get_state_parts(sim, 0, nullptr); }},
        {"sim", [&] { return gp_get_clock(nullptr, &value, &value, nullptr); }},
        {"sim", [&] { return gp_get_surface(nullptr, 1, &value, &value); }},
        {"sim", [&] { return gp_get_surface(nullptr, 0, nullptr, nullptr); }},
        {"x", [&] { return gp_get_surface(sim, 1, nullptr, &value); }},
        {"height", [&] { return gp_get_surface(sim, 1, &value, nullptr); }},
        {"sim", [&] { return gp_get_interface(nullptr, 0, 1, 1, &value, &value); }},
        {"sim", [&] { return gp_get_plate_load(nullptr, 0, &load); }},
        {"load", [&] { return gp_get_plate_load(sim, 0, nullptr); }},
        {"sim", [&] { return gp_get_plan(nullptr, 1, &entry, &n); }},
        {"entries", [&] { return gp_get_plan(sim, 1, nullptr, &n); }},
        {"n_out", [&] { return gp_get_plan(sim, 1, &entry, nullptr); }},
        {"sim", [&] { return gp_save(nullptr, "x"); }},
        {"path", [&] { return gp_save(sim, nullptr); }},
        {"path", [&] { return gp_load(nullptr, &other); }},
        {"sim", [&] { return gp_load("x", nullptr); }},
        {"sim", [&] { return gp_output_open(nullptr, "x", nullptr); }},
        {"path", [&] { return gp_output_open(sim, nullptr, nullptr); }},
        {"sim", [&] { return gp_output_write(nullptr); }},
        {"sim", [&] { return gp_output_close(nullptr); }},
    };
    const std::vector<uint64_t> before = snapshot(sim, 3);
    const uint64_t epoch = sim.epoch();
    for (std::size_t k = 0; k < calls.size(); ++k) {
        SCOPED_TRACE(testing::Message() << "call " << k << " without " << calls[k].name);
        EXPECT_FAILS(calls[k].call(), GP_E_ARGUMENT, calls[k].name);
    }
    EXPECT_EQ(snapshot(sim, 3), before);
    EXPECT_EQ(sim.epoch(), epoch);
}

TEST(Pointers, InterfaceNamesItsArrays) {
    Sim sim;
    sim.add(make_column(3, 3));
    sim.add(make_column(3, 3, 3 * spacing, 0));
    double value = 0;
    EXPECT_FAILS(gp_get_interface(sim, 0, 1, 1, nullptr, &value), GP_E_ARGUMENT, "y");
    EXPECT_FAILS(gp_get_interface(sim, 0, 1, 1, &value, nullptr), GP_E_ARGUMENT, "x");
    EXPECT_EQ(gp_get_interface(sim, 0, 1, 0, nullptr, nullptr), GP_OK);
}

TEST(Pointers, DestroyTakesNull) {
    gp_destroy(nullptr);
}

TEST(Pointers, IdsMayBeNull) {
    Sim sim;
    const gp_material material = make_material();
    const gp_column column = make_column(2, 2);
    const gp_plate plate = make_floor();
    const double value = 3;
    EXPECT_EQ(gp_add_material(sim, &material, nullptr), GP_OK);
    EXPECT_EQ(gp_add_column(sim, &column, nullptr), GP_OK);
    EXPECT_EQ(gp_add_particles(sim, 0, 1, &value, &value, nullptr, nullptr, nullptr), GP_OK);
    EXPECT_EQ(gp_add_plate(sim, &plate, nullptr), GP_OK);
    EXPECT_EQ(sim.count(), 5);
}

TEST(Pointers, HandlesIdsAndCountsAreNullOrZeroAfterAnError) {
    Sim sim;
    const auto expect_id_zero = [](auto add) {
        int32_t id = 31;
        EXPECT_LT(add(&id), 0);
        EXPECT_EQ(id, 0);
    };
    gp_material material = make_material();
    material.i0 = not_a_number;
    gp_column column = make_column(2, 2);
    column.width = not_a_number;
    gp_plate plate = make_floor();
    plate.x0 = not_a_number;
    for (gp_sim *handle : {sim.handle, static_cast<gp_sim *>(nullptr)}) {
        expect_id_zero([&](int32_t *id) { return gp_add_material(handle, &material, id); });
        expect_id_zero([&](int32_t *id) { return gp_add_column(handle, &column, id); });
        expect_id_zero([&](int32_t *id) { return gp_add_plate(handle, &plate, id); });
        expect_id_zero(
            [&](int32_t *id) { return gp_add_particles(handle, 0, 1, nullptr, nullptr, nullptr, nullptr, id); });
    }
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    material = make_material();
    expect_id_zero([&](int32_t *id) { return gp_add_material(sim, &material, id); });

    gp_plan_entry entry;
    for (const auto &call : {+[](gp_sim *s, gp_plan_entry *, int64_t *n) { return gp_get_plan(s, -1, nullptr, n); },
                             +[](gp_sim *s, gp_plan_entry *, int64_t *n) { return gp_get_plan(s, 3, nullptr, n); },
                             +[](gp_sim *, gp_plan_entry *e, int64_t *n) { return gp_get_plan(nullptr, 1, e, n); }}) {
        int64_t n = 31;
        EXPECT_EQ(call(sim, &entry, &n), GP_E_ARGUMENT);
        EXPECT_EQ(n, 0);
    }
    gp_sim *other = sim.handle;
    EXPECT_EQ(gp_load("nowhere", &other), has("hdf5") ? GP_E_IO : GP_E_UNSUPPORTED);
    EXPECT_EQ(other, nullptr);
    other = sim.handle;
    EXPECT_EQ(gp_create(nullptr, &other), GP_E_ARGUMENT);
    EXPECT_EQ(other, nullptr);
}

// Each call that can fail does, before the start and between steps: the run is the same to the bit as without.
TEST(Errors, ChangeNothing) {
    const auto fail_everything = [](Sim &sim) {
        gp_material material = make_material();
        material.mu_2 = 0;
        gp_column column = make_column(2, 2);
        column.vx = not_a_number;
        gp_plate plate = make_floor();
        plate.wall_mu = 1;
        const double x[2] = {0, not_a_number}, y[2] = {0, 0};
        double out[3] = {7, 7, 7};
        gp_state state{};
        gp_particles particles{};
        particles.struct_size = sizeof particles;
        gp_load load{};
        load.struct_size = sizeof load;
        int64_t n;
        std::string file = testing::TempDir() + "no such directory/out.h5";
        const gp_status statuses[] = {gp_add_material(sim, &material, nullptr),
                                      gp_add_column(sim, &column, nullptr),
                                      gp_add_particles(sim, 0, 2, x, y, nullptr, nullptr, nullptr),
                                      gp_add_plate(sim, &plate, nullptr),
                                      gp_set_plate_velocity(sim, 3, 0, 0),
                                      gp_set_plate_velocity(sim, 0, not_a_number, 0),
                                      gp_step(sim, -1),
                                      gp_run(sim, -1),
                                      gp_run(sim, not_a_number),
                                      gp_run(sim, infinite),
                                      gp_set_callback(
                                          sim, 0, +[](void *, gp_sim *) { return int32_t(1); }, nullptr),
                                      gp_get_particles(sim, GP_FIELD_ALL + 1, &particles),
                                      gp_copy_field(sim, GP_FIELD_POSITION, out, 3),
                                      gp_copy_field(sim, GP_FIELD_X, out, 3),
                                      gp_get_state(sim, &state),
                                      gp_get_surface(sim, 2, x, out),
                                      gp_get_surface(sim, -1, x, out),
                                      gp_get_interface(sim, 0, 0, 1, y, out),
                                      gp_get_plate_load(sim, 3, &load),
                                      gp_get_plan(sim, -1, nullptr, &n),
                                      gp_save(sim, file.c_str()),
                                      gp_output_open(sim, file.c_str(), nullptr),
                                      gp_output_write(sim),
                                      gp_output_close(sim)};
        for (const gp_status status : statuses)
            EXPECT_LT(status, 0) << &status - statuses;
        for (const double value : out)
            EXPECT_EQ(value, 7);
        EXPECT_EQ(particles.count, 0);
        EXPECT_EQ(load.fx, 0);
    };
    std::vector<uint64_t> bits[2];
    for (int k = 0; k < 2; ++k) {
        Sim sim;
        add_collapse(sim, 8, 8);
        for (int steps = 0; steps < 3; ++steps) {
            if (k == 1) {
                const uint64_t epoch = sim.epoch();
                const int64_t count = sim.count();
                fail_everything(sim);
                EXPECT_EQ(sim.epoch(), epoch);
                EXPECT_EQ(sim.count(), count);
            }
            ASSERT_EQ(gp_step(sim, 10), GP_OK) << gp_last_error();
        }
        bits[k] = snapshot(sim, 3);
    }
    EXPECT_EQ(bits[0], bits[1]);
}
