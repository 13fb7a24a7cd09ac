// A simulation that ends with its scope: what is added, done and read has to go well, and is read as values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "granperi/gp.h"

namespace test {

class Sim {
public:
    explicit Sim(const gp_config &config) { good(gp_create(&config, &handle)); }
    explicit Sim(gp_sim *owned) : handle(owned) {}
    Sim(const Sim &) = delete;
    Sim &operator=(const Sim &) = delete;
    ~Sim() { gp_destroy(handle); }
    operator gp_sim *() const { return handle; }

    int32_t add(const gp_material &material) { return id_of(gp_add_material(handle, &material, &id_)); }
    int32_t add(const gp_column &column) { return id_of(gp_add_column(handle, &column, &id_)); }
    int32_t add(const gp_plate &plate) { return id_of(gp_add_plate(handle, &plate, &id_)); }
    int32_t add(const std::vector<double> &x, const std::vector<double> &y) {
        return id_of(
            gp_add_particles(handle, 0, static_cast<int64_t>(x.size()), x.data(), y.data(), nullptr, nullptr, &id_));
    }
    int32_t material(double mu_s, double mu_2) {
        gp_material material;
        good(gp_material_init(&material, sizeof material));
        material.mu_s = mu_s;
        material.mu_2 = mu_2;
        return add(material);
    }
    int32_t column(double x_min, double y_min, double width, double height, int32_t material = 0, double vx = 0,
                   double vy = 0) {
        gp_column column;
        good(gp_column_init(&column, sizeof column));
        column.x_min = x_min;
        column.y_min = y_min;
        column.width = width;
        column.height = height;
        column.material = material;
        column.vx = vx;
        column.vy = vy;
        return add(column);
    }

    void run(double t_end) { ASSERT_EQ(gp_run(handle, t_end), GP_OK) << gp_last_error(); }
    void step(int64_t n = 1) { ASSERT_EQ(gp_step(handle, n), GP_OK) << gp_last_error(); }

    gp_state state() const {
        gp_state state{};
        state.struct_size = sizeof state;
        good(gp_get_state(handle, &state));
        return state;
    }
    gp_load load(int32_t plate) const {
        gp_load load{};
        load.struct_size = sizeof load;
        good(gp_get_plate_load(handle, plate, &load));
        return load;
    }
    gp_particles view(uint32_t fields) const {
        gp_particles particles{};
        particles.struct_size = sizeof particles;
        good(gp_get_particles(handle, fields, &particles));
        return particles;
    }
    uint64_t epoch() const { return view(0).epoch; }
    int64_t count() const { return view(0).count; }
    std::vector<double> field(uint32_t bit) const {
        std::vector<double> values(static_cast<std::size_t>(count()));
        good(gp_copy_field(handle, bit, values.data(), static_cast<int64_t>(values.size())));
        return values;
    }
    std::vector<gp_plan_entry> plan() const {
        int64_t n = 0;
        good(gp_get_plan(handle, 0, nullptr, &n));
        std::vector<gp_plan_entry> entries(static_cast<std::size_t>(n));
        good(gp_get_plan(handle, n, entries.data(), &n));
        EXPECT_EQ(n, static_cast<int64_t>(entries.size()));
        return entries;
    }
    // Of a stage; with 1 of a field, which may have the name of one.
    gp_plan_entry entry(const std::string &name, int32_t kind = 0) const {
        for (const gp_plan_entry &found : plan())
            if (found.kind == kind && found.name == name)
                return found;
        ADD_FAILURE() << "no entry " << name << " of kind " << kind;
        return {};
    }

    gp_sim *handle = nullptr;

private:
    static void good(gp_status status) { EXPECT_EQ(status, GP_OK) << gp_last_error(); }
    int32_t id_of(gp_status status) {
        good(status);
        return id_;
    }
    int32_t id_ = -1;
};

} // namespace test
