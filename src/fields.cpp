#include "fields.hpp"

#include <algorithm>
#include <cmath>

#include "kernel.hpp"
#include "parallel.hpp"
#include "stretches.hpp"

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

// The cells are those of the last sort, around where the particle was then.
double number_density_at(const World &world, int64_t place) {
    const Particles &p = world.particles;
    const ListOrigin &origin = world.list_origin;
    const double radius = world.constants.interaction_radius;
    const int64_t i = world.particle_listed_at(place);
    double sum = 0;
    for_each_candidate(world.grid, world.images, origin.x[place], origin.y[place], world.radius_then(radius),
                       [&](int64_t there) {
                           const int64_t j = world.particle_listed_at(there);
                           if (j != i)
                               sum += weight(std::hypot(p.x[j] - p.x[i], p.y[j] - p.y[i]), 1.0 / radius);
                       });
    return sum;
}

const double *derive_number_density(const World &world, Field<double> &out) {
    out.resize(world.particles.count);
    for_each_block(world.threads, world.particles.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t place = begin; place < end; ++place)
            out[world.particle_listed_at(place)] = number_density_at(world, place);
    });
    return out.data();
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
        return derive_number_density(world, scratch);
    case GP_FIELD_FLUIDITY:
        if (!p.fluidity.empty())
            return p.fluidity.data();
        return derive(world, scratch, [](int64_t) { return 0.0; });
    default: return nullptr;
    }
}

FieldsById::FieldsById(const World &world) : world_(world), count_(count_of_all(world)) {
    if (world.crossing) {
        by_id_ = world.particles.by_id();
        return;
    }
    by_id_.resize(static_cast<std::size_t>(world.particles.count)); // all are here
    for (int64_t i = 0; i < count_; ++i)
        by_id_[world.particles.id[i]] = static_cast<int32_t>(i);
}

void FieldsById::read(uint32_t bit, int64_t first, int64_t count, double *out) {
    const Particles &p = world_.particles;
    const bool stored = bit != GP_FIELD_ID && bit != GP_FIELD_COLUMN;
    if (stored && bit != bit_) {
        values_ = read_field(world_, bit, scratch_);
        bit_ = bit;
    }
    const auto value_of = [&](int32_t i) {
        return stored ? values_[i] : static_cast<double>(bit == GP_FIELD_ID ? p.id[i] : p.column[i]);
    };
    if (!world_.crossing) {
        for (int64_t k = 0; k < count; ++k)
            out[k] = value_of(by_id_[first + k]);
        return;
    }
    std::vector<double> own, all;
    auto next =
        std::lower_bound(by_id_.begin(), by_id_.end(), first, [&](int32_t i, int64_t id) { return p.id[i] < id; });
    for (; next != by_id_.end() && p.id[*next] < first + count; ++next) {
        own.push_back(static_cast<double>(p.id[*next]));
        own.push_back(value_of(*next));
    }
    world_.crossing->gather(own, all);
    for (std::size_t k = 0; k < all.size(); k += 2)
        out[static_cast<int64_t>(all[k]) - first] = all[k + 1];
}

} // namespace gp
