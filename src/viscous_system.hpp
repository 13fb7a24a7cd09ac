// What GP_STRESS_IMPLICIT keeps of one step: the operators of its equations on the step's neighbourhoods, and the vectors
// of the solver. Empty in the other schemes. stages/viscous_operators.hpp has the equations.
#pragma once

#include <cstdint>

#include <vector>

#include "binned_sum.hpp"
#include "geometry.hpp"
#include "material/regularized.hpp"
#include "particles.hpp"

namespace gp {

// Two components of every particle; with room for the images where neighbours read it.
struct VectorField {
    Field<double> x, y;
    void resize(int64_t n) {
        x.resize(n);
        y.resize(n);
    }
    int64_t bytes() const { return static_cast<int64_t>((x.capacity() + y.capacity()) * sizeof(double)); }
};

// The law of one contact's traction T = share * stress, stress = eta_r g for the pressure, g = slip / lever
// (stages/viscous_walls.hpp).
struct WallLaw {
    Vector tangent = Vector::Zero();
    double lever = 1;    // m, twice the distance
    double share = 0;    // 1/m: N/m3 over Pa
    double pressure = 0; // Pa
    Regularized law;
};

struct ViscousSystem {
    // w r_ij and w of every pair, in the order of the neighbour lists; of every contact's ghosts; of every ghost's particles.
    VectorField pair, contact_pair, seen_pair;
    Field<double> pair_weight, contact_weight, seen_weight;
    Field<double> inner_xx, inner_xy, inner_yy; // K^-1 of the particles alone, or what is in its place among few
    Field<double> beside;                       // 1 where one plate is in reach, else 0
    Field<double> seen_shear;                   // of the shear along plates, the share that the gradient sees
    Field<double> mirror_share;
    // u_ghost - u_plate = (t (x) t + normal n (x) n) (u_mean - u_plate)
    Field<double> ghost_normal;
    VectorField ghost_velocity, ghost_force;
    Field<double> pressure; // Pa, that the yield stress goes by

    VectorField target;                               // u*, m/s
    VectorField velocity, rate;                       // u, m/s; e = (D_xx - D_yy, 2 D_xy) / 2, 1/s
    Field<double> full_xx, full_xy, full_yx, full_yy; // velocity gradient of the last viscous_rates, 1/s
    Field<double> lxx, lxy, lyx, lyy;                 // that of the particles alone
    Field<double> stiffness;                          // of what the gradient does not see, Pa s/m2 per unit of w
    VectorField stress;                               // s_xx, s_xy, Pa
    VectorField force;                                // N/m3
    VectorField change, rate_change, residual, direction, image, bend; // of the linear solve
    Field<double> diagonal;
    Field<double> hxx, hxy, hyy;     // of the linearised law, Pa s
    Field<double> viscosity;         // Pa s
    Field<double> kxx, kxy, kyy;     // of the diagonal
    std::vector<BinnedBlock> blocks; // of a sum over particles
    std::vector<WallLaw> wall_laws;  // of every contact, as the next ones
    Field<double> wall_rate, wall_stress, wall_change,
        wall_h; // g, 1/s; stress, Pa; change of g; of the linearised law, Pa s

    // Over the whole run.
    int64_t newton = 0, linear = 0, failures = 0;
    int32_t last = 0;
    double last_residual = 0;

    int64_t bytes() const {
        int64_t total = 0;
        for (const VectorField *field :
             {&pair, &contact_pair, &seen_pair, &ghost_velocity, &ghost_force, &target, &velocity, &rate, &stress,
              &force, &change, &rate_change, &residual, &direction, &image, &bend})
            total += field->bytes();
        for (const Field<double> *field : {&pair_weight, &contact_weight,
                                           &seen_weight, &seen_shear,
                                           &beside,      &inner_xx,
                                           &inner_xy,    &inner_yy,
                                           &full_xx,     &full_xy,
                                           &full_yx,     &full_yy,
                                           &lxx,         &lxy,
                                           &lyx,         &lyy,
                                           &stiffness,   &mirror_share,
                                           &pressure,    &ghost_normal,
                                           &diagonal,    &hxx,
                                           &hxy,         &hyy,
                                           &viscosity,   &kxx,
                                           &kxy,         &kyy,
                                           &wall_rate,   &wall_stress,
                                           &wall_change, &wall_h})
            total += static_cast<int64_t>(field->capacity() * sizeof(double));
        return total +
               static_cast<int64_t>(wall_laws.capacity() * sizeof(WallLaw) + blocks.capacity() * sizeof(BinnedBlock));
    }
};

} // namespace gp
