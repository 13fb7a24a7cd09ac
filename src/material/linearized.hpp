// The regularised law as the implicit scheme solves it: deviatoric stress s and deviatoric rate e with
//   s sqrt(|e|^2 + delta^2) = mu(|e|) p e,   |e| = |gamma| of the deviator of D,
// linearised in s and e at once (after Chan, Golub & Mulet 1999). Linearised in e alone, s = eta_r(e) e, Newton's method
// converges within |e| ~ delta only; this form converges from afar for any delta.
#pragma once

#include <cmath>

#include "material/regularized.hpp"
#include "material/return_map.hpp"

namespace gp {

struct Linearized {
    Deviator stress;      // eta_r(e) e, Pa
    double viscosity;     // eta_r(e), Pa s
    double hxx, hxy, hyy; // H of s + ds = stress + H de, Pa s: symmetric, positive semi-definite
};

// The nearest stress to s that is not beyond `most`.
GP_INLINE Deviator within(const Deviator &s, double most) {
    const double size = std::sqrt(s.xx * s.xx + s.xy * s.xy);
    const double scale = size > most ? most / size : 1.0;
    return {scale * s.xx, scale * s.xy};
}

// s: the present stress; the part of it within the yield surface counts. H is symmetrised: with |s| <= mu p it is then
// positive, and at the solution, where s and e are parallel, it is the derivative itself.
GP_INLINE Linearized linearize(const Regularized &law, const Deviator &s, const Deviator &e, double pressure) {
    const double rate = std::sqrt(e.xx * e.xx + e.xy * e.xy);
    const Regularized::Yield yield = law.yield(rate, pressure);
    const double root = std::sqrt(rate * rate + law.delta * law.delta), inverse = 1.0 / root;
    const Deviator bounded = within(s, yield.stress);
    const double eta = yield.stress * inverse;
    const double back = inverse * inverse, slope = rate > 0.0 ? yield.slope * inverse / rate : 0.0;
    return {{eta * e.xx, eta * e.xy},
            eta,
            eta - back * bounded.xx * e.xx + slope * e.xx * e.xx,
            -0.5 * back * (bounded.xx * e.xy + bounded.xy * e.xx) + slope * e.xx * e.xy,
            eta - back * bounded.xy * e.xy + slope * e.xy * e.xy};
}

} // namespace gp
