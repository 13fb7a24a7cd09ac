#include "mps_operators.hpp"
#include "parallel.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct View {
    const double *x, *y, *gx, *gy;
    const int64_t *start;
    const int32_t *index;
    const int32_t *contact_start; // NULL where no plate is in reach
    const Contact *contacts;
    const int32_t *ghost_index;
    double inverse_radius;
    double *sum;
};

GP_MULTIVERSION void number_density_rows(const View &v, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        double sum = number_density_sum(v.index + v.start[i], v.start[i + 1] - v.start[i], v.x[i], v.y[i], v.x, v.y,
                                        v.inverse_radius);
        if (v.contact_start)
            for (int32_t k = v.contact_start[i]; k < v.contact_start[i + 1]; ++k) {
                const Contact &contact = v.contacts[k];
                sum += number_density_sum(v.ghost_index + contact.begin, contact.end - contact.begin, v.x[i], v.y[i],
                                          v.gx, v.gy, v.inverse_radius);
            }
        v.sum[i] = sum;
    }
}

} // namespace

void number_density(World &world) {
    Particles &p = world.particles;
    const Constants &c = world.constants;
    const Walls &w = world.walls;
    const View view{p.x.data(),
                    p.y.data(),
                    w.ghost_x.data(),
                    w.ghost_y.data(),
                    world.neighbors.start.data(),
                    world.neighbors.index.data(),
                    w.in_reach() ? w.contact_start.data() : nullptr,
                    w.contacts.data(),
                    w.ghost_of_contact.data(),
                    1.0 / c.interaction_radius,
                    p.density.data()};
    const double inverse = 1.0 / c.interaction_lattice.number_density;
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) {
        number_density_rows(view, begin, end);
        for (int64_t i = begin; i < end; ++i) {
            const MaterialConstants &material = world.material_of(i);
            const double ratio = p.density[i] * inverse;
            p.density[i] = material.density * ratio;
            p.pressure[i] = state_pressure(ratio, material.bulk_modulus);
        }
    });
    world.images.copy({&p.density, &p.pressure});
}

} // namespace gp::stages
