// The stages of a time step; plan.cpp says in which order they run. Each is one function, most of them in a file of their own.
#pragma once

#include "world.hpp"

namespace gp::stages {

// What a step may do at most; beyond, the simulation has diverged. Relative to its material's own, a density is not below 0
// (0 is that of a lone particle by its number density) and below 2: a blow as fast as sound makes it 2. In one step no
// particle moves by more than a spacing against another, or by its acceleration: it would be past its neighbours without
// having felt them. Sound moves nothing as far, and steps chosen for the flow end at a quarter.
constexpr double density_bound = 2, motion_bound = 1; // 1, dl
inline bool is_bounded_density(double ratio) {
    return ratio >= 0 && ratio < density_bound; // not a NaN
}

// Relative motion allowed in one step that is not demanded, in dl: positions, and so neighbours, change little.
constexpr double flow_share = 0.25;

// The step's size, its reason and its bounds; shortened to land on the end of the run or of a part of a diverged step.
void choose_dt(World &world);
// The largest step that is stable for waves, viscous terms and loaded plates: what a host may demand.
double stable_dt(const Constants &constants);
// Throws if the flow is so much faster than sound that its steps would be next to nothing: GP_E_DIVERGED, at the start
// GP_E_ARGUMENT.
void require_moderate_flow(const World &world);

void move_plates(World &world);
void update_neighbors(World &world);
// Sorts the particles, and finds lists and ghosts for world.skin and the plates where they are placed. The same
// positions in the sorted order give the same lists: world.list_origin keeps them.
void make_lists(World &world);
// Positions and velocities of the images across the ends of the period.
void update_images(World &world);

// Which particles flow.
void flowing(World &world);
// Ghost velocities through the plates' surfaces.
void wall_velocity(World &world);
// Shape tensor and velocity gradient (Jin et al. 2021, 3.11; the adjoint of 3.10), and the number density of what flows.
void gradient(World &world);
// The same and, over the same pairs, the sums of density_diffusion, which comes next.
void gradient_and_exchange(World &world);
// Optional smoothing of the density where the material flows.
void density_diffusion(World &world);
// Density of what flows where its particles have come closer than it says.
void density_of_spacing(World &world);
// Continuity and equation of state.
void density(World &world);
// The pair sums of the granular fluidity.
void fluidity(World &world);
// Elastic trial and return map; leaves sigma K^-1.
void stress(World &world);
// Ghost stresses extrapolated from the particles.
void wall_stress(World &world);
// Force states (3.9, 3.10), zero-energy penalty, gravity; loads on the plates.
void force(World &world);
// The same and, for the stage wall_friction of the default scheme, what plates take off the slip along them.
void force_and_friction(World &world);
// That of the particles begin .. end, which know their accelerations.
void find_friction(World &world, int64_t begin, int64_t end);
// u, then r.
void integrate(World &world);
// Throws GP_E_DIVERGED if a density, a stress or an acceleration is not finite or out of bounds. Comes before the first
// change to the particles that undo.hpp does not take back. ax, ay: those that BlockSums::acceleration2 was summed of.
void require_bounded_step(const World &world, const Field<double> &ax, const Field<double> &ay);
// Coulomb friction of plates: in the default scheme what has been found with the forces.
void wall_friction(World &world);
// Coulomb friction of the channel's side walls.
void side_wall_friction(World &world);
// Collisions of particles that come too close (2.9, 2.10).
void collide(World &world);
// The same against plates: nothing passes through.
void wall_contact(World &world);
// Energy ledger and extremes of this step.
void account(World &world);
// With gp_config.sleep. Wakes what something may reach in this step; lays down what nothing does, at its end.
void wake(World &world);
void sleep(World &world);
// After a change that all material feels.
void wake_all(World &world);
// The loads of what sleeps on the plates.
void add_held_loads(World &world);
// Before and after the stress: keep what is needed of what is quiet when it sleeps; after it also sigma K^-1 of what sleeps and is
// seen.
void remember_shape(World &world);
void hold_stress(World &world);
// The part of account that the next step's size follows from; also run before the first step.
void measure_velocities(World &world);

// ------------------------------------------------------------------------------------- of the implicit scheme

// Ghost velocities for the change of volume alone.
void wall_volume_velocity(World &world);
// -p K^-1, with the penalty's half of L.
void pressure_over_shape(World &world);
// Ghost pressures extrapolated from the particles.
void wall_isotropic_stress(World &world);
// The operators of the viscous equations (viscous_operators.hpp) where particles and plates are now, at r^k.
void viscous_system(World &world);
// What plates bear of single particles before the solve; what is left to do, or to take back, after it.
void wall_support(World &world);
void wall_hold(World &world);
// The viscous forces by the stress and the velocity before the step, into viscous.force: what the solve begins with.
void viscous_forecast(World &world);
// Velocity and stress at the end of the step, by the regularised law.
void viscous_solve(World &world);

// ------------------------------------------------------------------------------------ of the paper's schemes

// u* and r* by gravity (3.14, 3.15); in the local model also by the viscous force.
void predict(World &world);
void predict_with_viscosity(World &world);
// Number density and equation of state (2.4, 2.8).
void number_density(World &world);
// Ghost velocities: the plate's own.
void ghost_velocity(World &world);
// Velocity gradient by the MPS operator (2.7).
void mps_gradient(World &world);
// Shape tensor alone (3.11).
void shape_tensor(World &world);
// eta_r D (3.6); the second leaves sigma K^-1, too.
void viscous_stress(World &world);
void viscous_stress_over_shape(World &world);
// Ghost stresses: those of the wall particles. For force states; for viscous_force; for pressure_gradient.
void wall_particles(World &world);
void wall_viscous_stress(World &world);
void wall_pressure(World &world);
// The local model's forces (5.1, by 2.7).
void viscous_force(World &world);
void pressure_gradient(World &world);
// u^{k+1} and r^{k+1} (3.16, 3.17).
void correct(World &world);
void correct_by_pressure(World &world);
// account for operators that are not adjoint: what does not balance stays in the ledger's error.
void account_unbalanced(World &world);

} // namespace gp::stages
