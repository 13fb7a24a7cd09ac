// The friction of plates in the equations of GP_STRESS_IMPLICIT. What a plate transmits along itself is a law at its surface,
// as in the default scheme (wall_contact.cpp): per particle and plate, with N the normal force that the plate bears and y the
// distance,
//
//   T sqrt(g^2 + e_n^2 + delta^2) = mu(|g|) N g,   g = slip / (2 y),
//
// the material's own law (viscous_operators.hpp) on the plane of the plate: g is its shear there, e_n its stretching along the
// plate, which leaves less to shear. The tractions are the derivative of a convex function of the slips: the linearised
// equations stay symmetric and positive definite, T holds but never drives, and is never more than mu N.
#pragma once

#include "world.hpp"

namespace gp::stages {

enum class Plates { move, stand }; // stand: for changes of u

// The laws of the step's contacts, for stress, rates and velocities as they are in ViscousSystem, whose last viscous_forces they
// were; and the tractions by them.
void find_wall_laws(World &world);

// g of u for every contact: into rate.
void wall_rates(World &world, const VectorField &u, Plates plates, Field<double> &rate);

// Adds the force of tractions (Pa) on the particles to f.
void add_wall_tractions(World &world, const Field<double> &stress, VectorField &f);

// The force of a contact's present traction on its particle, N/m3.
Vector wall_traction(const World &world, const Contact &contact);

// Adds the tractions' part of the diagonal.
void add_wall_diagonal(World &world, Field<double> &diagonal);

} // namespace gp::stages
