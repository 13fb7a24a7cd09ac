// The equations of GP_STRESS_IMPLICIT: the linearised law, and operators that are adjoint with plates and periods included.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "material/linearized.hpp"
#include "stages/stages.hpp"
#include "stages/viscous_operators.hpp"
#include "world.hpp"
#include "world_support.hpp"

using namespace gp;

namespace {

constexpr double pi = 3.14159265358979323846;
const Regularized beads{std::tan(21 * pi / 180), std::tan(32 * pi / 180), 0.3 / (0.002 * 50), 1e-3};

Deviator stress_of(const Deviator &e, double pressure) {
    const double rate = std::hypot(e.xx, e.xy), eta = beads.viscosity(rate, pressure);
    return {eta * e.xx, eta * e.xy};
}

} // namespace

TEST(LinearizedLaw, IsTheDerivativeWhereStressAndRateAgree) {
    const double pressure = 300;
    for (const double rate : {1e-5, 1e-3, 0.1, 10.0})
        for (const double angle : {0.0, 0.7, 2.0, -1.3}) {
            const Deviator e{rate * std::cos(angle), rate * std::sin(angle)};
            const Linearized law = linearize(beads, stress_of(e, pressure), e, pressure);
            const double h = 1e-6 * rate;
            const Deviator right = stress_of({e.xx + h, e.xy}, pressure), left = stress_of({e.xx - h, e.xy}, pressure);
            const Deviator up = stress_of({e.xx, e.xy + h}, pressure), down = stress_of({e.xx, e.xy - h}, pressure);
            const double size = law.viscosity;
            EXPECT_NEAR(law.hxx, (right.xx - left.xx) / (2 * h), 1e-6 * size);
            EXPECT_NEAR(law.hxy, (right.xy - left.xy) / (2 * h), 1e-6 * size);
            EXPECT_NEAR(law.hxy, (up.xx - down.xx) / (2 * h), 1e-6 * size);
            EXPECT_NEAR(law.hyy, (up.xy - down.xy) / (2 * h), 1e-6 * size);
        }
}

TEST(LinearizedLaw, IsPositiveForAnyStress) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int k = 0; k < 1000; ++k) {
        const double scale = std::pow(10, 6 * uniform(generator));
        const Deviator e{scale * uniform(generator), scale * uniform(generator)};
        const Deviator s{1000 * uniform(generator),
                         1000 * uniform(generator)}; // most of these are beyond the yield stress
        const Linearized law = linearize(beads, s, e, 300);
        const double trace = law.hxx + law.hyy, determinant = law.hxx * law.hyy - law.hxy * law.hxy;
        EXPECT_GT(trace, 0);
        EXPECT_GE(determinant, -1e-12 * trace * trace);
    }
}

namespace {

// A jittered block in a corner of a rough floor and a free-slip wall; or, periodic, on a floor that spans the period.
struct Corner {
    explicit Corner(bool periodic) {
        gp_config config = default_config(GP_PRESET_DEFAULT);
        config.stress = GP_STRESS_IMPLICIT;
        config.spacing = 0.1;
        config.jitter = 0.2;
        config.threads = 1;
        if (periodic)
            config.periodic_x_max = 1.2;
        scene = std::make_unique<Scene>(config);
        gp_column column = default_column();
        column.width = 1.2;
        column.height = 1;
        std::string note;
        scene->add_column(column, note);
        gp_plate plate = default_plate();
        plate.x0 = 1.2;
        plate.x1 = 0;
        scene->add_plate(plate);
        if (!periodic) {
            plate.x0 = plate.x1 = 0;
            plate.y1 = 1;
            plate.friction = GP_WALL_FREE_SLIP;
            scene->add_plate(plate);
        }
        world = make_world(*scene);
        world->clock.dt = 1e-4;
        stages::update_neighbors(*world);
        stages::wall_volume_velocity(*world);
        test::make_gradient(*world);
        stages::viscous_system(*world);
    }
    VectorField random() {
        VectorField field;
        const int64_t n = world->particles.count;
        field.resize(n + world->images.count);
        for (Field<double> *values : {&field.x, &field.y})
            for (double &value : *values)
                value = uniform(generator);
        return field;
    }
    // f of the stress H e(u) with H = 1 and of the hidden motion.
    VectorField image(VectorField &u) {
        VectorField e, f;
        e.resize(world->particles.count);
        f.resize(world->particles.count);
        stages::viscous_rates(*world, u, stages::Plates::stand, e);
        stages::viscous_forces(*world, e, u, f);
        return f;
    }
    double dot(const VectorField &a, const VectorField &b) const {
        double sum = 0;
        for (int64_t i = 0; i < world->particles.count; ++i)
            sum += a.x[i] * b.x[i] + a.y[i] * b.y[i];
        return sum;
    }
    std::unique_ptr<Scene> scene;
    std::unique_ptr<World> world;
    std::mt19937 generator{11};
    std::uniform_real_distribution<double> uniform{-1, 1};
};

} // namespace

TEST(ViscousOperators, AreAdjoint) {
    for (const bool periodic : {false, true}) {
        Corner corner(periodic);
        const int64_t n = corner.world->particles.count;
        VectorField u = corner.random(), e, f;
        const VectorField s = corner.random();
        e.resize(n);
        f.resize(n);
        std::fill(corner.world->viscous.stiffness.begin(), corner.world->viscous.stiffness.end(), 0.0);
        stages::viscous_rates(*corner.world, u, stages::Plates::stand, e);
        stages::viscous_forces(*corner.world, s, u, f);
        const double power = 2 * corner.dot(s, e);
        // Across the ends of a period the ghosts that no particle sees are left out, of which a few have a share of some
        // 1e-9 in the mirror points of others.
        const double scale = std::sqrt(corner.dot(u, u) * corner.dot(f, f));
        EXPECT_NEAR(corner.dot(u, f), -power, (periodic ? 1e-9 : 1e-12) * scale) << periodic;
        EXPECT_GT(std::abs(power), 1e-3 * std::sqrt(corner.dot(u, u) * corner.dot(f, f)));
    }
}

TEST(ViscousOperators, AreSymmetricAndPositiveWithTheHiddenMotion) {
    for (const bool periodic : {false, true}) {
        Corner corner(periodic);
        Field<double> &stiffness = corner.world->viscous.stiffness;
        for (int64_t i = 0; i < corner.world->particles.count; ++i)
            stiffness[i] = 1 + 0.5 * std::sin(static_cast<double>(i));
        corner.world->images.copy(stiffness);
        VectorField a = corner.random(), b = corner.random();
        const VectorField fa = corner.image(a), fb = corner.image(b);
        const double scale = std::sqrt(corner.dot(a, a) * corner.dot(fb, fb));
        EXPECT_NEAR(corner.dot(a, fb), corner.dot(b, fa), 1e-11 * scale) << periodic;
        EXPECT_LT(corner.dot(a, fa), 0);
        EXPECT_LT(corner.dot(b, fb), 0);
    }
}
