// The stages of a time step, in the order in which plan.cpp runs them. Each is one function in one file.
#pragma once

#include "world.hpp"

namespace gp::stages {

// Largest step that sound and flow allow: cfl dl / wave speed, and a quarter spacing of relative motion; shortened to
// land on the end of the run.
void choose_dt(World &world);
// The largest step that is stable for sound, for a demanded time step.
double stable_dt(const Constants &constants);

void move_plates(World &world);
void update_neighbors(World &world);
// Positions and velocities of the images across the ends of the period.
void update_images(World &world);

// Ghost velocities through the plates' surfaces.
void wall_velocity(World &world);
// Shape tensor and velocity gradient (Jin et al. 2021, 3.11; the adjoint of 3.10).
void gradient(World &world);
// Continuity and equation of state.
void density(World &world);
// Optional smoothing of the density where the material flows.
void density_diffusion(World &world);
// Elastic trial and return map; leaves sigma K^-1.
void stress(World &world);
// Ghost stresses extrapolated from the particles.
void wall_stress(World &world);
// Force states (3.9, 3.10), zero-energy penalty, gravity; loads on the plates.
void force(World &world);
// u, then r.
void integrate(World &world);
// Coulomb friction of plates.
void wall_friction(World &world);
// Coulomb friction of the channel's side walls.
void side_wall_friction(World &world);
// Collisions of particles that come too close (2.9, 2.10).
void collide(World &world);
// The same against plates: nothing passes through.
void wall_contact(World &world);
// Energy ledger and extremes of this step.
void account(World &world);
// The part of account that the next step's size follows from; also run before the first step.
void measure_velocities(World &world);

} // namespace gp::stages
