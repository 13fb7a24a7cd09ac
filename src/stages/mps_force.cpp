// The two forces of the paper's local model (Jin et al. 2021, 5.1): divergence of the viscous stress and gradient of the
// pressure, both by 2.7.
//
// Of the pressure's gradient 2.7 is taken by its letter, with p_j - p_i. It does not keep momentum; other codes of the kind
// use p_j - min p or p_j + p_i, which push particles apart. All three run. Measured on the collapse with a = 1.25,
// L/dl = 32: peak y/L at .42 s and 1 s .361, .336 by the letter, .388, .370 with min p and .391, .365 with the sum; the
// speed left at 1 s is .074, .026 and .028 sqrt(g d), against .013 of the force states with the same friction.
#include "mps_operators.hpp"
#include "parallel.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct Points {
    const double *x, *y, *axx, *axy, *ayy; // Pa, a symmetric tensor; of a pressure axx alone
};

// Neighbours' part and own part of the divergence: sum_j a_j r w / r^2 and sum_j r w / r^2.
struct Sums {
    double ax = 0, ay = 0, x = 0, y = 0;

    GP_INLINE Sums &operator+=(const Sums &other) {
        ax += other.ax;
        ay += other.ay;
        x += other.x;
        y += other.y;
        return *this;
    }
};

template <bool Tensor>
GP_INLINE Sums sums_over(const int32_t *__restrict row, int64_t n, double xi, double yi, const Points &at,
                         double inverse_radius, double floor) {
    const double *__restrict x = at.x, *__restrict y = at.y;
    const double *__restrict axx = at.axx, *__restrict axy = at.axy, *__restrict ayy = at.ayy;
    double ax = 0, ay = 0, sx = 0, sy = 0;
#pragma omp simd reduction(+ : ax, ay, sx, sy)
    for (int64_t k = 0; k < n; ++k) {
        const int32_t j = row[k];
        const double dx = x[j] - xi, dy = y[j] - yi;
        const double r2 = dx * dx + dy * dy;
        const double w = weight(std::sqrt(r2), inverse_radius) / (r2 + floor);
        const double wx = w * dx, wy = w * dy;
        sx += wx;
        sy += wy;
        if constexpr (Tensor) {
            ax += axx[j] * wx + axy[j] * wy;
            ay += axy[j] * wx + ayy[j] * wy;
        } else {
            ax += axx[j] * wx;
            ay += axx[j] * wy;
        }
    }
    return {ax, ay, sx, sy};
}

struct MpsForceView {
    Points particles, ghosts;
    const int64_t *start;
    const int32_t *index;
    const int32_t *contact_start; // NULL where no plate is in reach
    Contact *contacts;
    const Facet *facets;
    const int32_t *ghost_index;
    double inverse_radius, floor, scale;
    double *fx, *fy; // N/m3
};

// The load on a plate is by the sum of the stresses in place of their difference: the traction that the pairs through its
// surface pass on; of a plate that is not rough its normal part, since the shear traction is the stage wall_friction's.
void viscous_rows(const MpsForceView &v, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        const double xi = v.particles.x[i], yi = v.particles.y[i];
        const double xx = v.particles.axx[i], xy = v.particles.axy[i], yy = v.particles.ayy[i];
        Sums sum = sums_over<true>(v.index + v.start[i], v.start[i + 1] - v.start[i], xi, yi, v.particles,
                                   v.inverse_radius, v.floor);
        if (v.contact_start)
            for (int32_t k = v.contact_start[i]; k < v.contact_start[i + 1]; ++k) {
                Contact &contact = v.contacts[k];
                const Sums s = sums_over<true>(v.ghost_index + contact.begin, contact.end - contact.begin, xi, yi,
                                               v.ghosts, v.inverse_radius, v.floor);
                contact.force_x = v.scale * (s.ax + xx * s.x + xy * s.y);
                contact.force_y = v.scale * (s.ay + xy * s.x + yy * s.y);
                sum += s;
            }
        v.fx[i] = v.scale * (sum.ax - xx * sum.x - xy * sum.y);
        v.fy[i] = v.scale * (sum.ay - xy * sum.x - yy * sum.y);
    }
}

void pressure_rows(const MpsForceView &v, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        const double xi = v.particles.x[i], yi = v.particles.y[i], own = v.particles.axx[i];
        Sums sum = sums_over<false>(v.index + v.start[i], v.start[i + 1] - v.start[i], xi, yi, v.particles,
                                    v.inverse_radius, v.floor);
        if (v.contact_start)
            for (int32_t k = v.contact_start[i]; k < v.contact_start[i + 1]; ++k) {
                Contact &contact = v.contacts[k];
                const Sums s = sums_over<false>(v.ghost_index + contact.begin, contact.end - contact.begin, xi, yi,
                                                v.ghosts, v.inverse_radius, v.floor);
                contact.force_x -= v.scale * (s.ax + own * s.x);
                contact.force_y -= v.scale * (s.ay + own * s.y);
                sum += s;
                if (const Facet &facet = v.facets[contact.facet]; !passes_shear(facet)) {
                    const Vector &n = facet.segment.normal;
                    const double normal = n.x() * contact.force_x + n.y() * contact.force_y;
                    contact.force_x = normal * n.x();
                    contact.force_y = normal * n.y();
                }
            }
        v.fx[i] = -v.scale * (sum.ax - own * sum.x);
        v.fy[i] = -v.scale * (sum.ay - own * sum.y);
    }
}

MpsForceView make_view(World &world, const Points &particles, double *fx, double *fy) {
    const Constants &c = world.constants;
    Walls &w = world.walls;
    return {particles,
            {w.ghost_x.data(), w.ghost_y.data(), w.ghost_axx.data(), w.ghost_axy.data(), w.ghost_ayy.data()},
            world.neighbors.start.data(),
            world.neighbors.index.data(),
            w.in_reach() ? w.contact_start.data() : nullptr,
            w.contacts.data(),
            w.facets.data(),
            w.ghost_of_contact.data(),
            1.0 / c.interaction_radius,
            nearest_square * c.volume,
            2.0 / c.interaction_lattice.number_density,
            fx,
            fy};
}

// Force densities to accelerations, with their square for the check of what is finite.
void divide_by_density(World &world, int64_t block, int64_t begin, int64_t end, double *ax, double *ay) {
    double sum = 0;
    for (int64_t i = begin; i < end; ++i) {
        const double inverse_density = 1.0 / world.material_of(i).density;
        ax[i] *= inverse_density;
        ay[i] *= inverse_density;
        sum += ax[i] * ax[i] + ay[i] * ay[i];
    }
    world.sums[block].acceleration2 = sum;
}

} // namespace

void viscous_force(World &world) {
    Particles &p = world.particles;
    world.walls.clear_loads();
    const MpsForceView view =
        make_view(world, {p.x.data(), p.y.data(), p.sxx.data(), p.sxy.data(), p.syy.data()}, p.ax.data(), p.ay.data());
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        viscous_rows(view, begin, end);
        divide_by_density(world, block, begin, end, p.ax.data(), p.ay.data());
    });
}

void pressure_gradient(World &world) {
    Particles &p = world.particles;
    const MpsForceView view =
        make_view(world, {p.x.data(), p.y.data(), p.pressure.data(), nullptr, nullptr}, p.cxx.data(), p.cxy.data());
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        pressure_rows(view, begin, end);
        divide_by_density(world, block, begin, end, p.cxx.data(), p.cxy.data());
    });
}

} // namespace gp::stages
