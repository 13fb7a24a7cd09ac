// The regularised law solved implicitly (GP_STRESS_IMPLICIT): Newton's method for the equations of viscous_operators.hpp,
// each linear system by conjugate gradients with a diagonal preconditioner.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "binned_sum.hpp"
#include "error.hpp"
#include "material/linearized.hpp"
#include "parallel.hpp"
#include "parts.hpp"
#include "stages/push.hpp"
#include "stages/stages.hpp"
#include "stages/viscous_operators.hpp"

namespace gp::stages {

namespace {

// Sum over the particles here of term(i).
template <class Term> BinnedSum part_of_sum(World &world, const Term &term) {
    std::vector<BinnedBlock> &blocks = world.viscous.blocks;
    for_each_block(world.threads, world.particles.count, [&](int64_t block, int64_t begin, int64_t end) {
        blocks[block] = BinnedSum::block_of(begin, end, term);
    });
    BinnedSum sum;
    for (const BinnedBlock &block : blocks)
        sum.add(block);
    return sum;
}

// Over the contacts here of term(c).
template <class Term> void add_contacts(const World &world, BinnedSum &sum, const Term &term) {
    sum.add(static_cast<int64_t>(world.viscous.wall_laws.size()), term);
}

// Sums over all particles, whoever has them: what the iterations depend on. So their number, and all bits, are those of a process
// alone.
template <std::size_t N>
std::array<double, N> values_of_all(World &world, std::array<BinnedSum, N> sums, double &largest) {
    static_assert(N <= most_sums);
    if (world.crossing)
        combine_sums(*world.crossing, sums.data(), static_cast<int>(N), largest);
    std::array<double, N> values;
    for (std::size_t k = 0; k < N; ++k)
        values[k] = sums[k].value();
    return values;
}
template <class... Term> std::array<double, sizeof...(Term)> sums_of(World &world, const Term &...term) {
    double none = 0;
    return values_of_all(world, std::array<BinnedSum, sizeof...(Term)>{part_of_sum(world, term)...}, none);
}
template <class Term> double sum_of(World &world, const Term &term) {
    return sums_of(world, term)[0];
}

template <class Body> void for_each_particle(World &world, const Body &body) {
    for_each_block(world.threads, world.particles.count, [&](int64_t, int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i)
            body(i);
    });
}

// The terms of a dot product.
auto product(const VectorField &a, const VectorField &b) {
    return [&](int64_t i) { return a.x[i] * b.x[i] + a.y[i] * b.y[i]; };
}

double dot(World &world, const VectorField &a, const VectorField &b) {
    return sum_of(world, product(a, b));
}

double number_of_particles(const World &world) {
    return static_cast<double>(world.scene->particle_count()); // everywhere
}

double inertia(const World &world, int64_t i) {
    return world.material_of(i).density / world.clock.dt; // N s/m4
}

// The law for the rate as the gradient sees it: beside plates that is a share of the shear only.
Regularized law_of(const World &world, int64_t i) {
    Regularized law = world.material_of(i).law;
    law.rate_factor *= world.viscous.seen_shear[i];
    law.delta *= world.viscous.seen_shear[i];
    return law;
}

// rho (u* - u) / dt + f: into residual.
void momentum_residual(World &world) {
    ViscousSystem &v = world.viscous;
    for_each_particle(world, [&](int64_t i) {
        const double m = inertia(world, i);
        v.residual.x[i] = m * (v.target.x[i] - v.velocity.x[i]) + v.force.x[i];
        v.residual.y[i] = m * (v.target.y[i] - v.velocity.y[i]) + v.force.y[i];
    });
}

// Image of a change of velocity under the linearised equations: rho/dt - f(H e(.)).
void apply(World &world, VectorField &direction, VectorField &image) {
    ViscousSystem &v = world.viscous;
    VectorField &e = v.rate_change;
    viscous_rates(world, direction, Plates::stand, e);
    for_each_particle(world, [&](int64_t i) {
        const double xx = v.hxx[i] * e.x[i] + v.hxy[i] * e.y[i];
        e.y[i] = v.hxy[i] * e.x[i] + v.hyy[i] * e.y[i];
        e.x[i] = xx;
    });
    viscous_forces(world, e, direction, image);
    wall_rates(world, direction, Plates::stand, v.wall_change);
    for (std::size_t c = 0; c < v.wall_laws.size(); ++c)
        v.wall_change[c] *= v.wall_h[c];
    add_wall_tractions(world, v.wall_change, image);
    for_each_particle(world, [&](int64_t i) {
        const double m = inertia(world, i);
        image.x[i] = m * direction.x[i] - image.x[i];
        image.y[i] = m * direction.y[i] - image.y[i];
    });
}

// Solves for `change` until the residual (overwritten) is below `goal`, in its Euclidean norm.
void conjugate_gradients(World &world, double goal) {
    ViscousSystem &v = world.viscous;
    VectorField &r = v.residual, &p = v.direction;
    for_each_particle(world, [&](int64_t i) {
        v.diagonal[i] = 1.0 / (inertia(world, i) + v.diagonal[i]);
        v.change.x[i] = v.change.y[i] = 0;
        p.x[i] = v.diagonal[i] * r.x[i];
        p.y[i] = v.diagonal[i] * r.y[i];
    });
    auto [rho, left2] = sums_of(world, product(r, p), product(r, r));
    // In exact arithmetic two per particle would do.
    const int64_t most = std::max<int64_t>(200, 4 * world.scene->particle_count());
    for (int64_t k = 0; k < most; ++k) {
        if (!(std::sqrt(left2) > goal))
            return;
        apply(world, p, v.image);
        ++v.linear;
        const double curvature = dot(world, p, v.image);
        if (!(curvature > 0))
            return; // at the limit of rounding
        const double alpha = rho / curvature;
        for_each_particle(world, [&](int64_t i) {
            v.change.x[i] += alpha * p.x[i];
            v.change.y[i] += alpha * p.y[i];
            r.x[i] -= alpha * v.image.x[i];
            r.y[i] -= alpha * v.image.y[i];
        });
        const auto weighted = [&](int64_t i) { return v.diagonal[i] * (r.x[i] * r.x[i] + r.y[i] * r.y[i]); };
        const auto [next, next_left2] = sums_of(world, weighted, product(r, r));
        const double beta = next / rho;
        rho = next;
        left2 = next_left2;
        for_each_particle(world, [&](int64_t i) {
            p.x[i] = v.diagonal[i] * r.x[i] + beta * p.x[i];
            p.y[i] = v.diagonal[i] * r.y[i] + beta * p.y[i];
        });
    }
}

// Viscosity for what the gradient does not see of the motion, as a share of the material's own (as it is at the start of
// the step): what is rigid in its visible motion is so in the rest. With .01, .02, .03, .05 the collapse with a = 1.25, L/dl = 16
// ends with a peak of .403, .409, .414, .414, R90 of .98, .97, .98, .98; with too little single deposits creep on at up to
// 8e-4 m/s (L/dl = 10), whatever delta is. With .03 it takes 3.5 % of what is dissipated, with .05 4.1 %.
constexpr double hidden_share = 0.03;

void find_stiffness(World &world) {
    const Particles &p = world.particles;
    ViscousSystem &v = world.viscous;
    const double scale = hidden_share / world.constants.lattice.second_moment;
    for_each_particle(world, [&](int64_t i) {
        const double rate = equivalent_stress({v.rate.x[i], v.rate.y[i]});
        v.stiffness[i] = scale * law_of(world, i).viscosity(rate, p.pressure[i]);
    });
    world.images.copy(v.stiffness);
}

// The function that u is the minimum of, along `change`: its derivative `part` of the way. What the hidden motion adds to
// it is linear: `hidden` + part `hidden_change`.
struct Slope {
    double hidden, hidden_change;

    double at(World &world, double part) const {
        const ViscousSystem &v = world.viscous;
        BinnedSum sum = part_of_sum(world, [&](int64_t i) {
            const double dx = v.change.x[i], dy = v.change.y[i];
            const double ex = v.rate_change.x[i], ey = v.rate_change.y[i];
            const Deviator e{v.rate.x[i] + part * ex, v.rate.y[i] + part * ey};
            const double eta = law_of(world, i).viscosity(equivalent_stress(e), v.pressure[i]);
            return inertia(world, i) * ((v.velocity.x[i] - v.target.x[i] + part * dx) * dx +
                                        (v.velocity.y[i] - v.target.y[i] + part * dy) * dy) +
                   2.0 * eta * (e.xx * ex + e.xy * ey);
        });
        add_contacts(world, sum, [&](int64_t c) {
            const WallLaw &wall = v.wall_laws[c];
            const double g = v.wall_rate[c] + part * v.wall_change[c];
            return wall.share * wall.lever * wall.law.viscosity(std::abs(g), wall.pressure) * g * v.wall_change[c];
        });
        double none = 0;
        return hidden + part * hidden_change + values_of_all<1>(world, {sum}, none)[0];
    }
};

// Work of the hidden motion of u on `change`: its force is f - f of the stress alone.
double hidden_slope(World &world, const VectorField &u) {
    ViscousSystem &v = world.viscous;
    for_each_particle(world, [&](int64_t i) { v.bend.x[i] = v.bend.y[i] = 0; });
    viscous_forces(world, v.bend, u, v.image);
    return -dot(world, v.change, v.image);
}

// How much of the change to take: all of it, unless the function rises again so steeply that it has passed its minimum by
// far. The function is convex and needs no new rates: bisection is cheap.
double step_length(World &world, double hidden) {
    const Slope slope{hidden, hidden_slope(world, world.viscous.change)};
    const double before = slope.at(world, 0);
    if (!(before < 0) || slope.at(world, 1) <= -0.5 * before)
        return 1;
    double low = 0, high = 1;
    for (int k = 0; k < 30; ++k) {
        const double middle = 0.5 * (low + high), here = slope.at(world, middle);
        if (std::abs(here) <= -0.1 * before)
            return middle;
        (here < 0 ? low : high) = middle;
    }
    return low > 0 ? low : high;
}

// Leaves the part of the stress that the law admits at this rate; returns the most that it does, Pa.
double take_admissible_stress(World &world, int64_t i, double rate) {
    ViscousSystem &v = world.viscous;
    const double most = law_of(world, i).yield(rate, v.pressure[i]).stress;
    const Deviator s = within({v.stress.x[i], v.stress.y[i]}, most);
    v.stress.x[i] = s.xx;
    v.stress.y[i] = s.xy;
    return most;
}

struct Misfit {
    double momentum; // share of the forces
    double law;      // rates against the stress, over what is allowed
};

// Leaves the forces of the admissible part of the stress, and what they leave of the momentum in residual.
Misfit measure_misfit(World &world, double force_scale) {
    ViscousSystem &v = world.viscous;
    const double delta = world.scene->config().delta;
    double fastest2 = 0;
    for (int64_t i = 0; i < world.particles.count; ++i)
        fastest2 = std::max(fastest2, v.velocity.x[i] * v.velocity.x[i] + v.velocity.y[i] * v.velocity.y[i]);
    BinnedSum mismatch = part_of_sum(world, [&](int64_t i) {
        const Deviator e{v.rate.x[i], v.rate.y[i]};
        const double rate = equivalent_stress(e), most = take_admissible_stress(world, i, rate);
        if (most == 0)
            return 0.0;
        const double ratio = std::hypot(rate, law_of(world, i).delta) / most;
        const double dx = e.xx - ratio * v.stress.x[i], dy = e.xy - ratio * v.stress.y[i];
        return dx * dx + dy * dy;
    });
    add_contacts(world, mismatch, [&](int64_t c) {
        const WallLaw &wall = v.wall_laws[c];
        const double g = v.wall_rate[c], most = wall.law.yield(std::abs(g), wall.pressure).stress;
        v.wall_stress[c] = std::clamp(v.wall_stress[c], -most, most);
        const double off = most > 0 ? g - std::hypot(g, wall.law.delta) / most * v.wall_stress[c] : 0.0;
        return off * off;
    });
    viscous_forces(world, v.stress, v.velocity, v.force);
    add_wall_tractions(world, v.wall_stress, v.force);
    momentum_residual(world);
    const auto [mismatch2, rate2, force2, residual2] = values_of_all<4>(
        world,
        {mismatch, part_of_sum(world, product(v.rate, v.rate)), part_of_sum(world, product(v.force, v.force)),
         part_of_sum(world, product(v.residual, v.residual))},
        fastest2);
    const double n = number_of_particles(world);
    const double tolerance = world.scene->config().implicit_tolerance;
    const double forces = std::sqrt(force2 / n) + force_scale;
    // Material that moves without forces has some of the size of what is rounded off.
    const double rounded = 16 * std::numeric_limits<double>::epsilon() * std::sqrt(fastest2);
    const double mean_inertia = world.mass / (n * world.particles.volume * world.clock.dt);
    const double counted = forces + rounded * mean_inertia / tolerance;
    const double allowed = std::sqrt(tolerance) * (std::sqrt(rate2 / n) + delta) + rounded / world.constants.spacing;
    return {counted > 0 ? std::sqrt(residual2 / n) / counted : 0.0, std::sqrt(mismatch2 / n) / allowed};
}

// Velocity and stress before the step: at rest these are the solution already.
void begin_as_before(World &world) {
    const Particles &p = world.particles;
    ViscousSystem &v = world.viscous;
    const double dt = world.clock.dt;
    for_each_particle(world, [&](int64_t i) {
        v.velocity.x[i] = p.vx[i] - p.push_x[i] - dt * p.ax[i];
        v.velocity.y[i] = p.vy[i] - p.push_y[i] - dt * p.ay[i];
        v.stress.x[i] = p.sxx[i];
        v.stress.y[i] = p.sxy[i];
    });
}

// Finds velocity, stress and force of the end of the step; throws if it cannot.
void solve(World &world) {
    const Particles &p = world.particles;
    ViscousSystem &v = world.viscous;
    const gp_config &config = world.scene->config();
    const double n = number_of_particles(world);
    // The forces that the law has to balance: all others.
    const double force_scale = std::sqrt(sum_of(world,
                                                [&](int64_t i) {
                                                    const double rho = world.material_of(i).density;
                                                    return rho * rho * (p.ax[i] * p.ax[i] + p.ay[i] * p.ay[i]);
                                                }) /
                                         n);
    for_each_particle(world, [&](int64_t i) {
        v.target.x[i] = p.vx[i];
        v.target.y[i] = p.vy[i];
    });
    begin_as_before(world);
    for (v.last = 0;; ++v.last, ++v.newton) {
        viscous_rates(world, v.velocity, Plates::move, v.rate);
        wall_rates(world, v.velocity, Plates::move, v.wall_rate);
        if (v.last == 0)
            find_stiffness(world);
        const Misfit misfit = measure_misfit(world, force_scale);
        v.last_residual = misfit.momentum;
        if (misfit.momentum <= config.implicit_tolerance && misfit.law <= 1)
            return;
        if (v.last == config.implicit_iterations || !std::isfinite(misfit.momentum + misfit.law)) {
            ++v.failures;
            throw make_error(
                GP_E_DIVERGED,
                "viscous_solve: no convergence in %d Newton steps (gp_config.implicit_iterations): %g of the "
                "forces are left, tolerance %g, rates off by %g of what is allowed; time %g s, step %lld",
                v.last, misfit.momentum, config.implicit_tolerance, misfit.law, world.clock.time,
                static_cast<long long>(world.clock.step));
        }
        for_each_particle(world, [&](int64_t i) {
            const Linearized law =
                linearize(law_of(world, i), {v.stress.x[i], v.stress.y[i]}, {v.rate.x[i], v.rate.y[i]}, v.pressure[i]);
            v.stress.x[i] = law.stress.xx;
            v.stress.y[i] = law.stress.xy;
            v.hxx[i] = law.hxx;
            v.hxy[i] = law.hxy;
            v.hyy[i] = law.hyy;
            v.viscosity[i] = law.viscosity;
        });
        for (std::size_t c = 0; c < v.wall_laws.size(); ++c) {
            const WallLaw &wall = v.wall_laws[c];
            const Linearized law = linearize(wall.law, {v.wall_stress[c], 0}, {v.wall_rate[c], 0}, wall.pressure);
            v.wall_stress[c] = law.stress.xx;
            v.wall_h[c] = law.hxx;
        }
        viscous_forces(world, v.stress, v.velocity, v.force);
        add_wall_tractions(world, v.wall_stress, v.force);
        momentum_residual(world);
        viscous_diagonal(world, v.viscosity, v.diagonal);
        add_wall_diagonal(world, v.diagonal);
        const double left = std::sqrt(dot(world, v.residual, v.residual));
        const double goal = 0.3 * config.implicit_tolerance * force_scale * std::sqrt(n);
        conjugate_gradients(world, std::max(goal, 1e-2 * left));
        viscous_rates(world, v.velocity, Plates::move, v.rate_change);
        const double hidden = hidden_slope(world, v.velocity);
        viscous_rates(world, v.change, Plates::stand, v.rate_change);
        wall_rates(world, v.change, Plates::stand, v.wall_change);
        const double part = step_length(world, hidden);
        for_each_particle(world, [&](int64_t i) {
            v.velocity.x[i] += part * v.change.x[i];
            v.velocity.y[i] += part * v.change.y[i];
            const double ex = v.rate_change.x[i], ey = v.rate_change.y[i];
            v.stress.x[i] += part * (v.hxx[i] * ex + v.hxy[i] * ey);
            v.stress.y[i] += part * (v.hxy[i] * ex + v.hyy[i] * ey);
        });
        for (std::size_t c = 0; c < v.wall_laws.size(); ++c)
            v.wall_stress[c] += part * v.wall_h[c] * v.wall_change[c];
    }
}

} // namespace

void viscous_forecast(World &world) {
    ViscousSystem &v = world.viscous;
    begin_as_before(world);
    viscous_rates(world, v.velocity, Plates::move, v.rate);
    find_stiffness(world);
    for_each_particle(world, [&](int64_t i) {
        take_admissible_stress(world, i, equivalent_stress({v.rate.x[i], v.rate.y[i]}));
    });
    viscous_forces(world, v.stress, v.velocity, v.force);
    find_wall_laws(world);
    add_wall_tractions(world, v.wall_stress, v.force);
}

void viscous_solve(World &world) {
    Particles &p = world.particles;
    ViscousSystem &v = world.viscous;
    if (world.walls.contacts.empty())
        v.wall_laws.clear();
    solve(world);

    const double dt = world.clock.dt;
    // What plates do to the material by the viscous stress: it joins the contacts' forces, and leaves the balance of the
    // force stage as it was.
    double plate_power = 0, friction = 0;
    for (Contact &contact : world.walls.contacts) {
        const Vector traction = wall_traction(world, contact);
        const Vector force = viscous_contact_force(world, v.velocity, contact) + traction;
        const auto c = &contact - world.walls.contacts.data();
        friction += p.volume * v.wall_laws[c].share * v.wall_laws[c].lever * v.wall_stress[c] * v.wall_rate[c];
        const double power =
            force.dot(world.walls.velocity_at(contact.facet, {p.x[contact.particle], p.y[contact.particle]}));
        contact.force_x += force.x();
        contact.force_y += force.y();
        contact.power += power;
        plate_power += p.volume * power;
    }
    if (!world.walls.contacts.empty())
        world.sums.front().total_power += plate_power;
    const double work = p.volume * part_of_sum(world, product(v.velocity, v.force)).value();
    for_each_block(world.threads, p.count, [&](int64_t block, int64_t begin, int64_t end) {
        double plastic = 0, lost = 0;
        for (int64_t i = begin; i < end; ++i) {
            p.sxx[i] = v.stress.x[i];
            p.sxy[i] = v.stress.y[i];
            const double by_density = dt / world.material_of(i).density;
            lost -= world.material_of(i).density *
                    push_particle(p, i, by_density * v.force.x[i], by_density * v.force.y[i], dt);
            plastic += 2.0 * (v.stress.x[i] * v.rate.x[i] + v.stress.y[i] * v.rate.y[i]);
        }
        world.sums[block].plastic = p.volume * plastic * dt;
        world.sums[block].lost = p.volume * lost;
    });
    // The adjoint operators' balance: what the plates do goes into s : D, into the hidden motion and into the material. The
    // step's own loss (that of a backward step) is the rest of what the material has lost.
    double plastic = 0, lost = 0;
    for (const BlockSums &block : world.sums) {
        plastic += block.plastic;
        lost += block.lost;
    }
    world.ledger.penalty += dt * (plate_power - work - friction) - plastic;
    world.ledger.walls += dt * friction;
    world.ledger.dissipated += dt * plate_power + lost - plastic; // s : D joins in account
    world.images.copy({&p.sxx, &p.sxy});
}

} // namespace gp::stages
