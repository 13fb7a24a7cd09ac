// The equations of GP_STRESS_IMPLICIT, for the velocity u at the end of a step:
//
//   rho (u - u*) / dt = f(s),   s sqrt(|e|^2 + delta^2) = mu(|e|) p e,   e = deviator of D(u),
//
// u* being the velocity after all other forces, and f the force density of the force states of s. Rates and forces are
// adjoint, ghosts behind plates included: a ghost's velocity is a linear function of those of the particles that it sees,
// and the force on the ghost goes back to these by the same weights. So u is the minimum of a convex function, the
// linearised equations are symmetric and positive definite, and what the material loses is what the plates get.
#pragma once

#include "stages/viscous_walls.hpp"
#include "world.hpp"

namespace gp::stages {

// e of u. Makes u's images and the ghosts' velocities.
void viscous_rates(World &world, VectorField &u, Plates plates, VectorField &e);

// f of s and of what L does not see of u, N/m3, by ViscousSystem::stiffness. Of u, viscous_rates was the last. S K^-1 - c L
// and the ghosts' forces are left behind: viscous_contact_force reads them.
void viscous_forces(World &world, const VectorField &s, const VectorField &u, VectorField &f);

// What a contact brings of the last viscous_forces, N/m3.
Vector viscous_contact_force(const World &world, const VectorField &u, const Contact &contact);

// Diagonal of the linearised equations without the inertia, for isotropic viscosities eta (Pa s): N s/m4.
void viscous_diagonal(World &world, const Field<double> &eta, Field<double> &diagonal);

} // namespace gp::stages
