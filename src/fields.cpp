#include "fields.hpp"

#include <cmath>

#include "kernel.hpp"
#include "parallel.hpp"

namespace gp {

namespace {

template <class Value> const double *derive(const World &world, Field<double> &out, const Value &value) {
    out.resize(world.particles.count);
    for_each_block(world.threads, world.particles.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i)
            out[i] = value(i);
    });
    return out.data();
}

// |gamma| = sqrt(D:D / 2), Jin et al. (2021) 3.3.
double shear_rate(const Particles &p, int64_t i) {
    return shear_rate(Symmetric{p.lxx[i], 0.5 * (p.lxy[i] + p.lyx[i]), p.lyy[i]});
}

double number_density(const World &world, int64_t i) {
    const Particles &p = world.particles;
    const double radius = world.constants.interaction_radius;
    double sum = 0;
    // The cells are those of the last sort: particles have moved by less than `shifted` since.
    for_each_candidate(world.grid, world.images, p.x[i], p.y[i], radius + world.shifted, [&](int64_t place) {
        const int64_t j = world.particle_listed_at(place);
        if (j != i)
            sum += weight(std::hypot(p.x[j] - p.x[i], p.y[j] - p.y[i]), 1.0 / radius);
    });
    return sum;
}

} // namespace

const double *read_field(const World &world, uint32_t bit, Field<double> &scratch) {
    const Particles &p = world.particles;
    switch (bit) {
    case GP_FIELD_X: return p.x.data();
    case GP_FIELD_Y: return p.y.data();
    case GP_FIELD_VX: return p.vx.data();
    case GP_FIELD_VY: return p.vy.data();
    case GP_FIELD_PRESSURE: return p.pressure.data();
    case GP_FIELD_DENSITY: return p.density.data();
    case GP_FIELD_SXX: return p.sxx.data();
    case GP_FIELD_SXY: return p.sxy.data();
    case GP_FIELD_SYY:
        if (!p.syy.empty())
            return p.syy.data();
        return derive(world, scratch, [&](int64_t i) { return -p.sxx[i]; });
    case GP_FIELD_SHEAR_RATE: return derive(world, scratch, [&](int64_t i) { return shear_rate(p, i); });
    case GP_FIELD_INERTIAL_NUMBER:
        return derive(world, scratch, [&](int64_t i) {
            const MaterialConstants &m = world.material_of(i);
            return p.pressure[i] > 0
                       ? 2 * m.grain_diameter * shear_rate(p, i) / std::sqrt(p.pressure[i] / m.grain_density)
                       : 0.0;
        });
    case GP_FIELD_VISCOSITY:
        if (by_number_density(world.constants.scheme))
            return derive(world, scratch, [&](int64_t i) {
                return world.material_of(i).law.viscosity(shear_rate(p, i), p.pressure[i]);
            });
        return derive(world, scratch, [&](int64_t i) {
            return equivalent_stress({p.sxx[i], p.sxy[i]}) / std::hypot(shear_rate(p, i), world.scene->config().delta);
        });
    case GP_FIELD_NUMBER_DENSITY:
        if (by_number_density(world.constants.scheme)) // as the scheme found it, with the ghosts
            return derive(world, scratch, [&](int64_t i) {
                return p.density[i] / world.material_of(i).density * world.constants.interaction_lattice.number_density;
            });
        return derive(world, scratch, [&](int64_t i) { return number_density(world, i); });
    case GP_FIELD_FLUIDITY:
        if (!p.fluidity.empty())
            return p.fluidity.data();
        return derive(world, scratch, [](int64_t) { return 0.0; });
    default: return nullptr;
    }
}

void copy_field_by_id(const World &world, uint32_t bit, double *out) {
    const Particles &p = world.particles;
    if (bit == GP_FIELD_ID || bit == GP_FIELD_COLUMN) {
        for (int64_t i = 0; i < p.count; ++i)
            out[p.id[i]] = bit == GP_FIELD_ID ? static_cast<double>(p.id[i]) : static_cast<double>(p.column[i]);
        return;
    }
    Field<double> scratch;
    const double *values = read_field(world, bit, scratch);
    for (int64_t i = 0; i < p.count; ++i)
        out[p.id[i]] = values[i];
}

} // namespace gp
