// Views of the particle fields and copies in the order of id.
#include <algorithm>
#include <set>

#include "api_support.hpp"

using namespace api;

namespace {

// The pointer of each bit, in the order of the bits from GP_FIELD_X on.
std::vector<const double *> numbers_of(const gp_particles &p) {
    return {p.x,
            p.y,
            p.vx,
            p.vy,
            p.pressure,
            p.density,
            p.sxx,
            p.sxy,
            p.syy,
            p.shear_rate,
            p.inertial_number,
            p.viscosity,
            p.number_density,
            p.fluidity};
}

void start(Sim &sim, int steps = 40) {
    add_collapse(sim);
    ASSERT_EQ(gp_step(sim, steps), GP_OK) << gp_last_error();
}

} // namespace

TEST(Views, ShowOnlyTheAskedFields) {
    Sim sim;
    start(sim);
    for (uint32_t bit = 1; bit & GP_FIELD_ALL; bit <<= 1) {
        gp_particles p;
        std::memset(&p, 0xff, sizeof p);
        p.struct_size = sizeof p;
        ASSERT_EQ(gp_get_particles(sim, bit, &p), GP_OK) << gp_last_error();
        EXPECT_EQ(p.struct_size, sizeof p);
        EXPECT_EQ(p.count, 120);
        EXPECT_EQ(p.id != nullptr, bit == GP_FIELD_ID);
        EXPECT_EQ(p.column != nullptr, bit == GP_FIELD_COLUMN);
        const std::vector<const double *> numbers = numbers_of(p);
        for (std::size_t k = 0; k < numbers.size(); ++k)
            EXPECT_EQ(numbers[k] != nullptr, bit == GP_FIELD_X << k) << "bit " << bit << ", field " << k;
    }
    const gp_particles none = sim.view(0);
    EXPECT_TRUE(!none.id && !none.column);
    for (const double *pointer : numbers_of(none))
        EXPECT_EQ(pointer, nullptr);
    const gp_particles all = sim.view(GP_FIELD_ALL);
    EXPECT_TRUE(all.id && all.column);
    for (const double *pointer : numbers_of(all))
        EXPECT_NE(pointer, nullptr);
}

TEST(Views, UnknownFieldsAreRefused) {
    Sim sim;
    start(sim, 1);
    for (const uint32_t fields : {GP_FIELD_ALL + 1, 1u << 31, UINT32_MAX}) {
        gp_particles p{};
        p.struct_size = sizeof p;
        EXPECT_FAILS(gp_get_particles(sim, fields, &p), GP_E_ARGUMENT, "fields");
        EXPECT_EQ(p.count, 0);
    }
}

TEST(Views, AgreeWithCopiesThroughTheId) {
    Sim sim;
    start(sim);
    const gp_particles p = sim.view(GP_FIELD_ALL);
    const auto n = static_cast<std::size_t>(p.count);
    std::set<int64_t> ids(p.id, p.id + n);
    EXPECT_EQ(ids.size(), n);
    EXPECT_EQ(*ids.begin(), 0);
    EXPECT_EQ(*ids.rbegin(), p.count - 1);
    const std::vector<const double *> numbers = numbers_of(p);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        const std::vector<double> copy = sim.field(GP_FIELD_X << k);
        for (std::size_t i = 0; i < n; ++i)
            ASSERT_EQ(bits_of(copy[static_cast<std::size_t>(p.id[i])]), bits_of(numbers[k][i])) << "field " << k;
    }
    const std::vector<double> id = sim.field(GP_FIELD_ID), column = sim.field(GP_FIELD_COLUMN);
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_EQ(id[i], static_cast<double>(i));
        EXPECT_EQ(column[static_cast<std::size_t>(p.id[i])], p.column[i]);
    }
}

TEST(Views, StayValidUntilTheSimulationChanges) {
    Sim sim;
    start(sim);
    const gp_particles p = sim.view(GP_FIELD_ALL);
    const auto n = static_cast<std::size_t>(p.count);
    std::vector<std::vector<double>> before;
    for (const double *pointer : numbers_of(p))
        before.emplace_back(pointer, pointer + n);
    // Everything that only reads, and what fails.
    snapshot(sim, 3);
    sim.plan();
    sim.view(GP_FIELD_ALL);
    sim.view(GP_FIELD_SYY);
    double x = 0.01, height;
    gp_get_surface(sim, 1, &x, &height);
    gp_step(sim, -1);
    gp_run(sim, 0);
    gp_step(sim, 0);
    if (has("hdf5")) {
        ASSERT_EQ(gp_output_open(sim, (testing::TempDir() + "granperi_view.h5").c_str(), nullptr), GP_OK);
        ASSERT_EQ(gp_output_write(sim), GP_OK);
        ASSERT_EQ(gp_output_close(sim), GP_OK);
    }
    EXPECT_EQ(sim.epoch(), p.epoch);
    const std::vector<const double *> numbers = numbers_of(p);
    for (std::size_t k = 0; k < numbers.size(); ++k)
        EXPECT_TRUE(std::equal(before[k].begin(), before[k].end(), numbers[k])) << k;
}

TEST(Views, EpochGrowsWithEveryChange) {
    Sim sim;
    uint64_t epoch = sim.epoch();
    const auto expect_grown = [&](const char *what) {
        EXPECT_GT(sim.epoch(), epoch) << what;
        epoch = sim.epoch();
    };
    sim.add(make_material());
    expect_grown("gp_add_material");
    sim.add(make_floor());
    expect_grown("gp_add_plate");
    sim.add(make_column(3, 3));
    expect_grown("gp_add_column");
    sim.add({1.0}, {0.0});
    expect_grown("gp_add_particles");
    ASSERT_EQ(gp_set_plate_velocity(sim, 0, 0, 0), GP_OK);
    expect_grown("gp_set_plate_velocity");
    ASSERT_EQ(gp_step(sim, 1), GP_OK);
    expect_grown("gp_step");
    ASSERT_EQ(gp_run(sim, 2 * sim.state().time), GP_OK);
    expect_grown("gp_run");
    ASSERT_EQ(gp_set_plate_velocity(sim, 0, 0, 0), GP_OK);
    expect_grown("gp_set_plate_velocity after the start");
    for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(gp_step(sim, 1), GP_OK);
        expect_grown("each step");
    }
}

TEST(Views, CopyFieldTakesExactlyOneBitAndTheCount) {
    Sim sim;
    start(sim, 1);
    std::vector<double> values(121, 7);
    for (const uint32_t field :
         {0u, GP_FIELD_POSITION, GP_FIELD_ALL, GP_FIELD_ALL + 1, 1u << 31, GP_FIELD_ID | GP_FIELD_X})
        EXPECT_FAILS(gp_copy_field(sim, field, values.data(), 120), GP_E_ARGUMENT, "field");
    for (const int64_t n : {int64_t(0), int64_t(119), int64_t(121), int64_t(-1), INT64_MAX})
        EXPECT_FAILS(gp_copy_field(sim, GP_FIELD_X, values.data(), n), GP_E_ARGUMENT, "n = ");
    EXPECT_EQ(values, std::vector<double>(121, 7));
    EXPECT_EQ(gp_copy_field(sim, GP_FIELD_X, values.data(), 120), GP_OK);
    EXPECT_EQ(values.back(), 7) << "no more than n are written";
}

// What gp.h says of the fields, computed from the others.
TEST(Fields, AreWhatTheHeaderSays) {
    gp_config config = make_config();
    config.delta = 0.5;
    config.interaction_radius = 2.7;
    Sim sim(config);
    start(sim, 60);
    const gp_particles p = sim.view(GP_FIELD_ALL);
    const gp_material m = make_material();
    const double c = sim.state().sound_speed, rho = m.volume_fraction * m.grain_density, radius = 2.7 * spacing;
    int pressed = 0, free = 0;
    for (int64_t i = 0; i < p.count; ++i) {
        EXPECT_EQ(p.sxx[i] + p.syy[i], 0);
        EXPECT_GE(p.pressure[i], 0);
        EXPECT_GE(p.shear_rate[i], 0);
        EXPECT_NEAR(p.pressure[i], std::max(0.0, c * c * (p.density[i] - rho)), 1e-9 * rho * c * c);
        const double tau = std::sqrt(p.sxx[i] * p.sxx[i] + p.sxy[i] * p.sxy[i]);
        const double viscosity = tau / std::sqrt(p.shear_rate[i] * p.shear_rate[i] + 0.25);
        EXPECT_NEAR(p.viscosity[i], viscosity, 1e-12 * viscosity);
        if (p.pressure[i] > 0) {
            const double number = 2 * m.grain_diameter * p.shear_rate[i] / std::sqrt(p.pressure[i] / m.grain_density);
            EXPECT_NEAR(p.inertial_number[i], number, 1e-12 * number);
            EXPECT_LE(tau, (m.mu_2 + 1e-9) * p.pressure[i]) << "beyond the largest friction";
            ++pressed;
        } else {
            EXPECT_EQ(p.inertial_number[i], 0);
            EXPECT_EQ(tau, 0);
            ++free;
        }
        double sum = 0;
        for (int64_t j = 0; j < p.count; ++j) {
            const double r = std::hypot(p.x[j] - p.x[i], p.y[j] - p.y[i]);
            if (j != i && r < radius)
                sum += std::pow(1 - r / radius, 3);
        }
        EXPECT_NEAR(p.number_density[i], sum, 1e-9);
    }
    EXPECT_GT(pressed, 30);
    EXPECT_GT(free, 0);
}
