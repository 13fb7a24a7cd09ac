// The pair sums of the granular fluidity (material/fluidity.hpp): of A^2 d^2 lap g = (2 A^2 d^2 / k0) sum w (g_j - g_i), k0 the
// second moment of the full lattice, the neighbours' part (pull) and the factor of g_i (pace), added up in the pair loop of the
// gradient. The stage `stress` solves for g with both: no limit on the time step. Missing neighbours pass no flux: at free
// surfaces and plates the gradient along the normal is 0. What bears no pressure passes none either. Ghosts of plates with
// GP_FLUIDITY_ZERO have -g_i times their depth over the particle's distance.
#include "awake.hpp"
#include "stages/fluidity_exchange.hpp"
#include "stages/rows.hpp"
#include "stages/stages.hpp"

namespace gp::stages {

namespace {

// A particle nearer to its plate than a ghost's depth over this is taken to be as far: the pace stays bounded.
constexpr double steepest = 10;

// Sum of w (1 + depth / distance) over the ghosts of a contact.
GP_INLINE double pace_of_ghosts(const Walls &w, const Contact &contact, const Vector &at, double distance,
                                double inverse_radius) {
    double sum = 0;
    for (int64_t k = contact.begin; k < contact.end; ++k) {
        const int32_t g = w.ghost_of_contact[k];
        const double ratio = w.ghost_depth[g] < steepest * distance ? w.ghost_depth[g] / distance : steepest;
        sum += weight(std::hypot(w.ghost_x[g] - at.x(), w.ghost_y[g] - at.y()), inverse_radius) * (1 + ratio);
    }
    return sum;
}

} // namespace

FluidityView prepare_fluidity(World &world) {
    Particles &p = world.particles;
    if (p.bearing.empty()) // no density diffusion between several densities
        hand_over(p.ay, p.bearing);
    make_for_neighbors(world, {&p.fluid_seen, &p.bearing}, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            p.bearing[i] = p.pressure[i] > 0 ? 1.0 : 0.0;
            p.fluid_seen[i] = p.bearing[i] * p.fluidity[i];
        }
    });
    return {p.fluid_seen.data(), p.bearing.data(), p.fluid_pull.data(), p.fluid_pace.data()};
}

void fluidity(World &world) {
    Particles &p = world.particles;
    const Walls &walls = world.walls;
    const Rows rows(world);
    const double share = 2 / world.constants.lattice.second_moment, inverse_radius = 1 / world.constants.horizon;
    for_each_awake_block(world, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            double pace = p.fluid_pace[i];
            for (const Contact &contact : rows.contacts_of(i)) {
                const Facet &facet = walls.facets[contact.facet];
                if (facet.spec->fluidity != GP_FLUIDITY_ZERO)
                    continue;
                const Vector at(p.x[i], p.y[i]);
                const double distance = facet.segment.distance(walls.nearest_image(facet.segment, at));
                pace += pace_of_ghosts(walls, contact, at, distance > 0 ? distance : 0.0, inverse_radius);
            }
            const double factor = share * world.fluidity_of(i).cooperativity2, pull = p.fluid_pull[i];
            p.fluid_pull[i] = factor * (pull > 0 ? pull : 0.0); // a difference of sums
            p.fluid_pace[i] = factor * (pace > 0 ? pace : 0.0);
        }
    });
}

} // namespace gp::stages
