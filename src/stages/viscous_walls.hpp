// The friction of plates in the equations of GP_STRESS_IMPLICIT. What a plate transmits along itself is a law at its surface,
// as in the default scheme (wall_friction.cpp): per particle and plate, with N the normal force that the plate bears before the
// step and y the distance,
//
//   T sqrt(g^2 + e_n^2 + delta^2) = mu(|g|) (p/N of the flow rule) N g,   g = slip / (2 y),
//
// the material's own law (viscous_operators.hpp) on the plane of the plate: g is its shear there, e_n its stretching, which leaves
// less to shear and bears on N. Both are means between the particle and the plate, which does not stretch: half of the
// particle's e_n. (With all of it R90 of the collapse with a = 1.25 at L/dl = 16 is 1.12, with none .88; the default scheme's 1.01,
// and 1.08 at L/dl = 256.) The tractions are the derivative of a convex function of the slips: the linearised equations stay
// symmetric and positive definite, and T holds but never drives. Sliding layers of 1, 2, 6, 10, 20 rows are braked by 1.000 of
// mu times their weight, of 3 by 1.00 to 1.01.
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
