// What lies beneath the material in the direction of gravity as a scene begins, and the blow with which it meets that.
#pragma once

#include <vector>

#include "scene.hpp"

namespace gp {

// The plates' wetted lines where they stand as the scene begins: visit(plate, segment).
template <class Visit> void for_each_segment(const Scene &scene, const Visit &visit) {
    for (std::size_t k = 0; k < scene.plates().size(); ++k) {
        const PlateSpec &plate = scene.plates()[k];
        const Placing placing(plate.first_pose(), plate.pivot);
        for (const Segment &segment : plate.segments)
            visit(static_cast<int32_t>(k), placing.of(segment));
    }
}

// Of each body, the share of its particles beneath which there is a plate whose wetted side faces them, or a body that is
// borne by half or more. All are borne where there is no gravity, or where it acts along the period.
std::vector<double> borne_shares(const Scene &scene);

// The hardest blow with which a body of three rows or more meets a plate or another body: by falling freely, as things stand
// or once the plates that are to move are gone, and by the velocities with which it begins.
Impact hardest_impact(const Scene &scene);

} // namespace gp
