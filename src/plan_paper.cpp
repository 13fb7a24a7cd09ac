// The schemes of Jin et al. (2021) as stage lists over the same fields.
#include "plan.hpp"
#include "stage_rows.hpp"
#include "stages/stages.hpp"

namespace gp {

// The non-local scheme: figure 1 of the paper.
std::vector<PlannedStage> paper_stages(const Traits &t, const std::vector<PlannedStage> &default_stages) {
    const StageRows rows{t, default_stages};
    return {
        rows.same("choose_dt"),
        rows.same("move_plates"),
        rows.same("update_neighbors"),
        rows.same("keep_fields"),
        // writes u*, r* (3.14, 3.15), those of the images, too
        rows.particles("predict", "gravity first, then the forces", stages::predict),
        // reads position; writes density, pressure (2.4, 2.8)
        rows.particles("number_density", "density by the particle number density", stages::number_density),
        rows.walls("ghost_velocity", stages::ghost_velocity),
        // reads position, velocity; writes velocity gradient (2.7)
        rows.particles("mps_gradient", "velocity gradient by the MPS operator", stages::mps_gradient),
        // reads position; writes shape tensor (3.11)
        rows.particles("shape_tensor", "force states need it", stages::shape_tensor),
        // reads velocity gradient, pressure, shape tensor; writes viscous stress, sigma K^-1 (3.6, 3.12)
        rows.particles("viscous_stress", "regularised mu(I) law", stages::viscous_stress_over_shape),
        // reads position, velocity; writes ghost stress
        rows.walls("wall_particles", stages::wall_particles),
        // reads sigma K^-1; writes acceleration (3.9, 3.10)
        rows.same("force"),
        // reads acceleration; writes u^{k+1}, r^{k+1} (3.16, 3.17)
        rows.particles("correct", "the forces' part of the motion", stages::correct),
        rows.same("wall_friction"),
        rows.same("side_wall_friction"),
        rows.same("collide"),
        rows.same("wall_contact"),
        rows.same("update_images"),
        rows.other("account", stages::account_unbalanced),
    };
}

// The local model (section 5.1): viscous force in the predictor, pressure in the corrector.
std::vector<PlannedStage> paper_local_stages(const Traits &t, const std::vector<PlannedStage> &default_stages) {
    const StageRows rows{t, default_stages};
    return {
        rows.same("choose_dt"),
        rows.same("move_plates"),
        rows.same("update_neighbors"),
        rows.same("keep_fields"),
        rows.walls("ghost_velocity", stages::ghost_velocity),
        // reads position, velocity; writes velocity gradient (2.7)
        rows.particles("mps_gradient", "velocity gradient by the MPS operator", stages::mps_gradient),
        // reads velocity gradient, pressure; writes viscous stress (3.6)
        rows.particles("viscous_stress", "regularised mu(I) law", stages::viscous_stress),
        // reads position, velocity; writes ghost stress
        rows.walls("wall_viscous_stress", stages::wall_viscous_stress),
        // reads viscous stress; writes acceleration
        rows.particles("viscous_force", "divergence of the viscous stress", stages::viscous_force),
        // reads acceleration; writes u*, r*, those of the images, too
        rows.particles("predict", "gravity and viscous force first, then the pressure", stages::predict_with_viscosity),
        // reads position; writes density, pressure (2.4, 2.8)
        rows.particles("number_density", "density by the particle number density", stages::number_density),
        // reads position; writes ghost pressure
        rows.walls("wall_pressure", stages::wall_pressure),
        // reads pressure; writes acceleration (2.7)
        rows.particles("pressure_gradient", "gradient of the pressure", stages::pressure_gradient),
        // reads acceleration; writes u^{k+1}, r^{k+1}
        rows.particles("correct", "the pressure's part of the motion", stages::correct_by_pressure),
        rows.same("wall_friction"),
        rows.same("side_wall_friction"),
        rows.same("collide"),
        rows.same("wall_contact"),
        rows.same("update_images"),
        rows.other("account", stages::account_unbalanced),
    };
}

} // namespace gp
