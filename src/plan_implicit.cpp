// GP_STRESS_IMPLICIT as a stage list: the default scheme with the regularised law, solved implicitly, for the return map.
#include "plan.hpp"
#include "stage_rows.hpp"
#include "stages/stages.hpp"

namespace gp {

std::vector<PlannedStage> implicit_stages(const Traits &t, const std::vector<PlannedStage> &default_stages) {
    const StageRows rows{t, default_stages};
    PlannedStage support = rows.other("wall_contact", stages::wall_support);
    support.name = "wall_support";
    support.why = "what lies on a plate does not fall in the solve";
    if (t.parts) // other processes may have contacts, and wait
        support.now = nullptr;
    return {
        rows.same("choose_dt"),
        rows.same("move_plates"),
        rows.same("update_neighbors"),
        rows.same("keep_fields"),
        rows.other("wall_velocity", stages::wall_volume_velocity),
        rows.same("flowing"),
        rows.same("gradient"),
        rows.same("density_diffusion"),
        rows.same("density_of_spacing"),
        rows.same("density"),
        // reads velocity gradient, pressure; writes -p K^-1
        rows.particles("pressure_over_shape", "force states of the pressure", stages::pressure_over_shape),
        // reads pressure; writes ghost stress
        rows.other("wall_stress", stages::wall_isotropic_stress),
        rows.same("force"),
        // reads position; writes the operators of the viscous equations
        rows.particles("viscous_system", "regularised mu(I) law, implicit", stages::viscous_system),
        rows.same("integrate"),
        // Contact holds grains that no pressure holds, as those at the tip of a deposit. Stopped after the solve alone, each
        // fell by g dt in every step of it, and drew its neighbours along: tips of deposits crept whatever delta was. The stage
        // wall_contact corrects what this one did.
        support,
        // reads velocity, pressure; writes velocity, position, stress
        rows.particles("viscous_solve", "regularised mu(I) law, implicit", stages::viscous_solve),
        rows.same("side_wall_friction"),
        rows.same("collide"),
        rows.other("wall_contact", stages::wall_hold),
        rows.same("update_images"),
        rows.same("account"),
    };
}

} // namespace gp
