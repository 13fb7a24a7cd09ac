// What the peridynamic operators sum over one particle's neighbours, and the shape tensor's inverse.
//
// The gradient L_i = sum_j w (u_j - u_i) (x) r_ij K_i^-1 and the force density f_i = sum_j w (A_i + A_j) r_ij with
// A = sigma K^-1 are adjoint: sum_i u_i . f_i = -sum_i sigma_i : L_i to rounding, for any K^-1 (power identity).
// K = sum_j w r (x) r has no volume in it: all particles have the same one, and it cancels.
#pragma once

#include <Eigen/Eigenvalues>

#include "geometry.hpp"
#include "kernel.hpp"

namespace gp {

// K and M = sum w (u_j - u_i) (x) r, so that L = M K^-1; and N = sum w where it is asked for.
struct Moments {
    double n = 0;
    double kxx = 0, kxy = 0, kyy = 0;
    double mxx = 0, mxy = 0, myx = 0, myy = 0;

    GP_INLINE Moments &operator+=(const Moments &other) {
        n += other.n;
        kxx += other.kxx;
        kxy += other.kxy;
        kyy += other.kyy;
        mxx += other.mxx;
        mxy += other.mxy;
        myx += other.myx;
        myy += other.myy;
        return *this;
    }
};

// Below this share of the full-lattice value an eigenvalue of K no longer describes a neighbourhood: a free corner has
// .14 to .4 (horizons of 8 to 1.8 dl), a straight row has 0 across itself.
constexpr double deficient_share = 0.1;

// Nor does the whole of K below this trace, the share of a quarter plane, over the full-lattice value of an eigenvalue: few
// particles. Its inverse would make them as stiff as their distance is short, too stiff for the time step: two to six grains
// that met in free space left with up to 13 times their energy. With the inverse reduced by the square of what is missing
// they lose some, collisions included; where a plate or a deposit is near, none of this acts. A corner's own trace is .91 to .59
// (horizons of 1.8 to 8 dl; .69 with 4), so with .7 gradients at corners are no longer exact.
//
// Least stable step of 720 random clumps of 3 to 30 grains in free space, .85 dl apart at least (2 over the highest frequency of
// their discrete operators, in dl / wave speed), by horizon; the scheme's own step is no longer (scene_constants.cpp):
//   2.5 dl .64    3 dl .72    4 dl 1.04    6 dl 1.92        own .59, .71, .95, 1.42
constexpr double few_trace = 0.5;

// K^-1, with the inverse of an eigenvalue l below the floor f = 0.1 k0 replaced by l / f^2: continuous, and 0 for no, a
// single or only collinear neighbours in the direction that they do not span.
inline Tensor deficient_inverse(double kxx, double kxy, double kyy, double lattice_moment) {
    Tensor k;
    k << kxx, kxy, kxy, kyy;
    Eigen::SelfAdjointEigenSolver<Tensor> solver;
    solver.computeDirect(k);
    const double floor = deficient_share * lattice_moment;
    Vector inverse;
    for (int a = 0; a < 2; ++a) {
        const double value = solver.eigenvalues()[a] > 0 ? solver.eigenvalues()[a] : 0.0;
        inverse[a] = value >= floor ? 1.0 / value : value / (floor * floor);
    }
    return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

struct SymmetricTensor {
    double xx, xy, yy;
};

// A grain that sees plates, but of particles fewer than make this trace (over k0; two to three a spacing away do) is in
// flight: it carries no stress, and blows hold it off plates and others. With stress it hovered a spacing or two above a
// floor, and bounced from there without end, each time higher; so it falls, touches, and lies there.
constexpr double flight_trace = 0.15;

GP_INLINE double carried_share(double particles_trace, double lattice_moment) {
    const double share = particles_trace / (flight_trace * lattice_moment);
    return share < 1.0 ? share * share : 1.0;
}

GP_INLINE SymmetricTensor inverse_shape(const Moments &m, double lattice_moment) {
    // The smaller eigenvalue is at least det/trace.
    const double trace = m.kxx + m.kyy, determinant = m.kxx * m.kyy - m.kxy * m.kxy;
    const double share = trace / (few_trace * lattice_moment);
    if (share >= 1.0 && determinant > deficient_share * lattice_moment * trace) {
        const double scale = 1.0 / determinant;
        return {m.kyy * scale, -m.kxy * scale, m.kxx * scale};
    }
    const Tensor inverse = (share < 1.0 ? share * share : 1.0) * deficient_inverse(m.kxx, m.kxy, m.kyy, lattice_moment);
    return {inverse(0, 0), inverse(0, 1), inverse(1, 1)};
}

} // namespace gp
