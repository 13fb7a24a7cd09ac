// The operators of viscous_operators.hpp where particles and plates are: ways of pairs, the ghosts' shares, and what the hidden
// motion goes by. Made once a step; the solver then applies them many times.
#include <algorithm>
#include <cmath>

#include "kernel.hpp"
#include "operators.hpp"
#include "parallel.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"
#include "stages/viscous_operators.hpp"

namespace gp::stages {

namespace {

void pair_rows(const Rows &rows, const double *__restrict x, const double *__restrict y, double inverse_radius,
               double *__restrict qx, double *__restrict qy, double *__restrict ws, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        const double xi = x[i], yi = y[i];
#pragma omp simd
        for (int64_t k = rows.start[i]; k < rows.start[i + 1]; ++k) {
            const int32_t j = rows.index[k];
            const double dx = x[j] - xi, dy = y[j] - yi;
            const double w = weight(std::sqrt(dx * dx + dy * dy), inverse_radius);
            ws[k] = w;
            qx[k] = w * dx;
            qy[k] = w * dy;
        }
    }
}

// A ghost's velocity is that at its mirror point, turned round along the normal: shear does not pass through the surface
// (viscous_walls.hpp). The particles' shares in it fall off so fast with their
// distance from the point that on a lattice the mirror particle has it all but alone: then a uniform stress is in
// equilibrium row by row. With the wide average of the default scheme's ghosts plates drag too much (rows beside a plate
// overtake it).
constexpr double core = 0.5; // dl

// Closer to the plate than this, the particles about the mirror point do not tell the slope (there are none, and others
// take their place).
constexpr double least_distance = 0.25; // dl

// Shares and ratios of the ghosts, ways between ghosts and particles.
void make_ghosts(World &world) {
    const Walls &w = world.walls;
    const Particles &p = world.particles;
    const Mirrors &mirrors = world.mirrors;
    ViscousSystem &v = world.viscous;
    const double inverse_radius = 1.0 / world.constants.horizon, spacing = world.constants.spacing;
    v.seen_pair.resize(static_cast<int64_t>(w.particles_of_ghost.index.size()));
    v.seen_weight.resize(v.seen_pair.x.size());
    v.contact_pair.resize(static_cast<int64_t>(w.ghost_of_contact.size()));
    v.contact_weight.resize(v.contact_pair.x.size());
    v.mirror_share.resize(static_cast<int64_t>(mirrors.of_ghost.index.size()));
    v.ghost_normal.resize(w.ghost_count);
    v.ghost_velocity.resize(w.ghost_count);
    v.ghost_force.resize(w.ghost_count);
    for_each_block<ghost_block_size>(world.threads, w.ghost_count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t g = begin; g < end; ++g) {
            for (int64_t k = w.particles_of_ghost.start[g]; k < w.particles_of_ghost.start[g + 1]; ++k) {
                const int32_t i = w.particles_of_ghost.index[k];
                const double dx = w.ghost_x[g] - p.x[i], dy = w.ghost_y[g] - p.y[i];
                const double q = weight(std::sqrt(dx * dx + dy * dy), inverse_radius);
                v.seen_weight[k] = q;
                v.seen_pair.x[k] = q * dx;
                v.seen_pair.y[k] = q * dy;
            }
            const Vector n(w.ghost_nx[g], w.ghost_ny[g]), ghost(w.ghost_x[g], w.ghost_y[g]);
            const Vector mirror = ghost + 2 * w.ghost_distance[g] * n;
            double sum = 0, distance = 0;
            for (int64_t k = mirrors.of_ghost.start[g]; k < mirrors.of_ghost.start[g + 1]; ++k) {
                const int32_t i = mirrors.of_ghost.index[k];
                const double dx = p.x[i] - mirror.x(), dy = p.y[i] - mirror.y();
                const double soft = 1.0 / (dx * dx + dy * dy + core * core * spacing * spacing);
                const double share = soft * soft * soft * soft;
                v.mirror_share[k] = share;
                sum += share;
                distance += share * (n.dot(Vector(p.x[i], p.y[i]) - ghost) - w.ghost_distance[g]);
            }
            for (int64_t k = mirrors.of_ghost.start[g]; k < mirrors.of_ghost.start[g + 1]; ++k)
                v.mirror_share[k] /= sum;
            const double ratio = w.ghost_distance[g] / std::max(distance / sum, least_distance * spacing);
            v.ghost_normal[g] = -ratio;
        }
    });
    for_each_block<ghost_block_size>(world.threads, static_cast<int64_t>(w.contacts.size()),
                                     [&](int64_t, int64_t begin, int64_t end) {
                                         for (int64_t c = begin; c < end; ++c) {
                                             const int64_t i = w.contacts[c].particle;
                                             for (int64_t k = w.contacts[c].begin; k < w.contacts[c].end; ++k) {
                                                 const int32_t g = w.ghost_of_contact[k];
                                                 const double dx = w.ghost_x[g] - p.x[i], dy = w.ghost_y[g] - p.y[i];
                                                 const double q = weight(std::sqrt(dx * dx + dy * dy), inverse_radius);
                                                 v.contact_weight[k] = q;
                                                 v.contact_pair.x[k] = q * dx;
                                                 v.contact_pair.y[k] = q * dy;
                                             }
                                         }
                                     });
}

// Of the shear along the plates beside particle i, the share that its gradient sees, which is fitted to ghosts that pass none:
// 1/2 in the row beside a plate, .9 in the next. m: of the particles alone.
double seen_shear(const World &world, int64_t i, const Moments &m) {
    const ViscousSystem &v = world.viscous;
    double least = 1;
    for (const Contact &contact : Rows(world).contacts_of(i)) {
        const Vector &n = world.walls.facets[contact.listed_facet].segment.normal;
        double ghosts = 0;
        for (int64_t k = contact.begin; k < contact.end; ++k)
            if (v.contact_weight[k] > 0) {
                const double across = n.x() * v.contact_pair.x[k] + n.y() * v.contact_pair.y[k];
                ghosts += across * across / v.contact_weight[k];
            }
        const double own = n.x() * n.x() * m.kxx + 2 * n.x() * n.y() * m.kxy + n.y() * n.y() * m.kyy;
        const double known = std::max(own, deficient_share * world.constants.lattice.second_moment);
        least = std::min(least, known / (known + ghosts));
    }
    return least;
}

// Beside one plate the hidden motion along its normal is that of the fit to the ghosts as well, if K^-1 is the inverse.
bool sees_one_plate(const World &world, int64_t i, Moments m) {
    const ViscousSystem &v = world.viscous;
    const Particles &p = world.particles;
    const Rows::Run run = Rows(world).contacts_of(i);
    if (run.last - run.first != 1)
        return false;
    for (int64_t k = run.first->begin; k < run.first->end; ++k)
        if (v.contact_weight[k] > 0) {
            const double qx = v.contact_pair.x[k], qy = v.contact_pair.y[k], inverse = 1 / v.contact_weight[k];
            m.kxx += inverse * qx * qx;
            m.kxy += inverse * qx * qy;
            m.kyy += inverse * qy * qy;
        }
    const double off = std::abs(m.kxx * p.gxx[i] + m.kxy * p.gxy[i] - 1) +
                       std::abs(m.kxy * p.gxy[i] + m.kyy * p.gyy[i] - 1) +
                       std::abs(m.kxx * p.gxy[i] + m.kxy * p.gyy[i]);
    return off < 1e-6;
}

// What the hidden motion u_j - u_i - L r, L = M P, goes by: its energy, c/2 sum w |u_j - u_i - L r|^2, is the derivative's with
// 2 P - P K P, which is P = K^-1 where that is the inverse; so it is one among few neighbours, too. (Left out there, grains at
// tips went astray at 5e-4 m/s whatever delta.) And the share of the shear that the gradient sees.
void make_inner_shapes(World &world) {
    const Particles &p = world.particles;
    ViscousSystem &v = world.viscous;
    const Rows rows(world);
    const double k0 = world.constants.lattice.second_moment;
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            Moments m;
            const auto add = [&m](double w, double qx, double qy) {
                if (w > 0) {
                    m.kxx += qx * qx / w;
                    m.kxy += qx * qy / w;
                    m.kyy += qy * qy / w;
                }
            };
            for (int64_t k = rows.start[i]; k < rows.start[i + 1]; ++k)
                add(v.pair_weight[k], v.pair.x[k], v.pair.y[k]);
            const SymmetricTensor g = inverse_shape(m, k0);
            Tensor shape, inverse;
            shape << m.kxx, m.kxy, m.kxy, m.kyy;
            inverse << g.xx, g.xy, g.xy, g.yy;
            const Tensor fit = 2 * inverse - inverse * shape * inverse;
            v.inner_xx[i] = fit(0, 0);
            v.inner_xy[i] = fit(0, 1);
            v.inner_yy[i] = fit(1, 1);
            v.seen_shear[i] = seen_shear(world, i, m);
            v.beside[i] = sees_one_plate(world, i, m) ? 1.0 : 0.0;
        }
    });
}

void make_room(World &world) {
    ViscousSystem &v = world.viscous;
    const int64_t n = world.particles.count, with_images = n + world.images.count;
    for (VectorField *field : {&v.target, &v.rate, &v.stress, &v.force, &v.rate_change, &v.residual, &v.image, &v.bend})
        field->resize(n);
    for (VectorField *field : {&v.velocity, &v.change, &v.direction})
        field->resize(with_images);
    for (Field<double> *field : {&v.diagonal, &v.hxx, &v.hxy, &v.hyy, &v.viscosity, &v.seen_shear, &v.inner_xx,
                                 &v.inner_xy, &v.inner_yy, &v.full_xx, &v.full_xy, &v.full_yx, &v.full_yy})
        field->resize(n);
    for (Field<double> *field : {&v.kxx, &v.kxy, &v.kyy, &v.stiffness, &v.beside, &v.lxx, &v.lxy, &v.lyx, &v.lyy})
        field->resize(with_images);
    v.blocks.resize(static_cast<std::size_t>(block_count(n)));
}

} // namespace

void viscous_system(World &world) {
    const Particles &p = world.particles;
    ViscousSystem &v = world.viscous;
    make_room(world);
    v.pair.resize(static_cast<int64_t>(world.neighbors.index.size()));
    v.pair_weight.resize(v.pair.x.size());
    const Rows rows(world);
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        pair_rows(rows, p.x.data(), p.y.data(), 1.0 / world.constants.horizon, v.pair.x.data(), v.pair.y.data(),
                  v.pair_weight.data(), begin, end);
    });
    make_ghosts(world);
    v.pressure.assign(p.pressure.begin(), p.pressure.begin() + p.count);
    make_inner_shapes(world);
    world.images.copy(v.beside);
}

} // namespace gp::stages
