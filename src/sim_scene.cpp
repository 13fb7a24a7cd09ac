// What the host adds to the scene, and what it does to plates and gravity before and during a run.
#include <algorithm>

#include "check.hpp"
#include "ledger.hpp"
#include "parts.hpp"
#include "sim.hpp"
#include "stages/stages.hpp"

namespace gp {

void Sim::require_unstarted(const char *call) const {
    const int64_t step = started_ ? world_->clock.step : 0;
    if (step > 0)
        throw make_error(GP_E_STATE,
                         "%s: the scene is fixed once the first step is taken (step %lld): add to it before", call,
                         static_cast<long long>(step));
    if (started_)
        throw make_error(GP_E_STATE,
                         "%s: the scene is fixed since a first step was tried, or a plate or gravity set while an "
                         "output was open: add to it before",
                         call);
    if (sink)
        throw make_error(GP_E_STATE,
                         "%s: the scene is fixed while an output is open: add to it before, or close the output", call);
}

void Sim::scene_changed() {
    world_.reset();
    warnings_ = {};
    ++epoch_;
}

int32_t Sim::add_material(const gp_material &material) {
    require_unstarted("gp_add_material");
    const int32_t id = scene_.add_material(material);
    scene_changed();
    return id;
}

int32_t Sim::add_column(const gp_column &column) {
    require_unstarted("gp_add_column");
    std::string note;
    const int32_t id = scene_.add_column(column, note);
    scene_changed();
    if (!note.empty())
        log(GP_LOG_WARNING, note);
    return id;
}

int32_t Sim::add_particles(int32_t material, int64_t n, const double *x, const double *y, const double *vx,
                           const double *vy) {
    require_unstarted("gp_add_particles");
    const int32_t id =
        crossing_ ? add_particles_of_all(material, n, x, y, vx, vy) : scene_.add_particles(material, n, x, y, vx, vy);
    scene_changed();
    return id;
}

// What each process adds, one after the other. What is wrong with one's, its own scene says; all say it.
int32_t Sim::add_particles_of_all(int32_t material, int64_t n, const double *x, const double *y, const double *vx,
                                  const double *vy) {
    std::string wrong;
    try {
        if (n != 0)
            scene_.check_particles(material, n, x, y, vx, vy);
    } catch (const Error &error) {
        wrong = error.what();
    }
    const double own = wrong.empty() ? 0 : 1;
    double any = own;
    crossing_->combine(&any, 1, nullptr, 0);
    if (any > 0)
        throw Error(GP_E_ARGUMENT, text_of_largest(*crossing_, any = own, wrong));
    std::vector<double> all[4];
    const double *const given[4] = {x, y, vx, vy};
    for (int k = 0; k < 4; ++k) {
        std::vector<double> mine(static_cast<std::size_t>(n), 0.0);
        if (given[k])
            std::copy_n(given[k], n, mine.begin());
        crossing_->gather_everywhere(mine, all[k]);
    }
    return scene_.add_particles(material, static_cast<int64_t>(all[0].size()), all[0].data(), all[1].data(),
                                all[2].data(), all[3].data());
}

int32_t Sim::add_plate(const gp_plate &plate) {
    require_unstarted("gp_add_plate");
    const int32_t id = scene_.add_plate(plate);
    scene_changed();
    return id;
}

void Sim::set_plate_motion(int32_t plate, double vx, double vy, double omega) {
    require_choice("plate", plate, static_cast<int64_t>(scene_.plates().size()));
    require_quantity("vx", vx);
    require_quantity("vy", vy);
    require_quantity("omega", omega);
    if (crossing_)
        crossing_->require_going();
    const Motion motion{{vx, vy}, omega};
    require_tangential(scene_.plates()[plate], motion, "plate");
    scene_.require_room_to_turn(scene_.plates()[plate], motion, "plate");
    if (is_scene_fixed()) {
        started_ = true;
        Plate &driven = world_->walls.plates[plate];
        driven.drive(world_->clock.time, motion);
        if (driven.gap <= 0) // the lists and the step's size count on the span from the next step on
            world_->velocity_span = std::max(world_->velocity_span, driven.fastest() + world_->fastest);
        ++epoch_;
    } else {
        scene_.drive_plate(plate, motion);
        scene_changed();
    }
}

void Sim::set_gravity(double gx, double gy) {
    require_quantity("gx", gx);
    require_quantity("gy", gy);
    const Vector gravity(gx, gy);
    if (is_scene_fixed()) {
        if (gravity == world_->constants.gravity)
            return;
        started_ = true;
        change_gravity(*world_, gravity);
        if (world_->sleep.in_use)
            stages::wake_all(*world_);
        ++epoch_;
        if (log_)
            warn(warnings_.of_gravity(*world_)); // of constants
    } else {
        scene_.set_gravity(gravity);
        scene_changed();
    }
}

} // namespace gp
