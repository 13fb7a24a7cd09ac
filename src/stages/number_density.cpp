#include "mps_operators.hpp"
#include "parallel.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct DensityView {
    Rows rows;
    const double *x, *y, *gx, *gy;
    double inverse_radius;
    double *sum;
};

void number_density_rows(const DensityView &v, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        double sum = number_density_sum(v.rows.row(i), v.rows.count(i), v.x[i], v.y[i], v.x, v.y, v.inverse_radius);
        for (const Contact &contact : v.rows.contacts_of(i)) {
            sum += number_density_sum(v.rows.ghosts(contact), Rows::ghost_count(contact), v.x[i], v.y[i], v.gx, v.gy,
                                      v.inverse_radius);
        }
        v.sum[i] = sum;
    }
}

} // namespace

void number_density(World &world) {
    Particles &p = world.particles;
    const Constants &c = world.constants;
    const Walls &w = world.walls;
    const DensityView view{Rows(world),      p.x.data(),       p.y.data(),
                           w.ghost_x.data(), w.ghost_y.data(), 1.0 / c.interaction_radius,
                           p.density.data()};
    const double inverse = 1.0 / c.interaction_lattice.number_density;
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        double densest = 0;
        bool unbounded = false;
        number_density_rows(view, begin, end);
        for (int64_t i = begin; i < end; ++i) {
            const MaterialConstants &material = world.material_of(i);
            const double ratio = p.density[i] * inverse;
            p.density[i] = material.density * ratio;
            p.pressure[i] = state_pressure(ratio, material.bulk_modulus);
            densest = ratio > densest ? ratio : densest;
            unbounded |= !is_bounded_density(ratio);
        }
        world.sums[block].densest = densest;
        world.sums[block].unbounded = unbounded;
    });
    world.images.copy({&p.density, &p.pressure});
}

} // namespace gp::stages
