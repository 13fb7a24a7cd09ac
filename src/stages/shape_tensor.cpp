#include "operators.hpp"
#include "parallel.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

struct ShapeView {
    Rows rows;
    const double *x, *y, *gx, *gy;
    double inverse_radius, lattice_moment;
    double *ixx, *ixy, *iyy;
};

GP_INLINE void add_shape(Moments &sum, const int32_t *__restrict row, int64_t n, double xi, double yi,
                         const double *__restrict x, const double *__restrict y, double inverse_radius) {
    double kxx = 0, kxy = 0, kyy = 0;
#pragma omp simd reduction(+ : kxx, kxy, kyy)
    for (int64_t k = 0; k < n; ++k) {
        const int32_t j = row[k];
        const double dx = x[j] - xi, dy = y[j] - yi;
        const double w = weight(std::sqrt(dx * dx + dy * dy), inverse_radius);
        kxx += w * dx * dx;
        kxy += w * dx * dy;
        kyy += w * dy * dy;
    }
    sum.kxx += kxx;
    sum.kxy += kxy;
    sum.kyy += kyy;
}

void shape_rows(const ShapeView &v, int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
        Moments m;
        add_shape(m, v.rows.row(i), v.rows.count(i), v.x[i], v.y[i], v.x, v.y, v.inverse_radius);
        for (const Contact &contact : v.rows.contacts_of(i)) {
            add_shape(m, v.rows.ghosts(contact), Rows::ghost_count(contact), v.x[i], v.y[i], v.gx, v.gy,
                      v.inverse_radius);
        }
        const SymmetricTensor g = inverse_shape(m, v.lattice_moment);
        v.ixx[i] = g.xx;
        v.ixy[i] = g.xy;
        v.iyy[i] = g.yy;
    }
}

} // namespace

void shape_tensor(World &world) {
    Particles &p = world.particles;
    const Walls &w = world.walls;
    const ShapeView view{Rows(world),
                         p.x.data(),
                         p.y.data(),
                         w.ghost_x.data(),
                         w.ghost_y.data(),
                         1.0 / world.constants.horizon,
                         world.constants.lattice.second_moment,
                         p.gxx.data(),
                         p.gxy.data(),
                         p.gyy.data()};
    for_each_block(world.threads, p.count, [&](int64_t, int64_t begin, int64_t end) { shape_rows(view, begin, end); });
}

} // namespace gp::stages
