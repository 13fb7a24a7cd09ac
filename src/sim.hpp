// A simulation: the scene, the world that the stages work on, and the loop over time steps.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "granperi/gp.h"
#include "plan.hpp"
#include "scene.hpp"
#include "warnings.hpp"
#include "world.hpp"

namespace gp {

// A sink of frames that follows a run (io/). Kept abstract here: sim knows no file format.
class FrameSink {
public:
    virtual ~FrameSink() = default;
    virtual void step_done(const World &world) = 0; // throws gp::Error(GP_E_IO)
};

// Where a simulation is, beside its world.
struct Progress {
    bool started = false;  // the scene is fixed
    bool diverged = false; // no more steps
    uint32_t told = 0;     // warnings
    uint64_t epoch = 0;
    double wall_seconds = 0;
};

class Sim {
public:
    // crossing: to the other processes that the simulation is of; all calls are theirs, too, in the same order.
    explicit Sim(const gp_config &config, std::shared_ptr<Crossing> crossing = nullptr);

    // Adding to the scene; possible until the first step.
    int32_t add_material(const gp_material &material);
    int32_t add_column(const gp_column &column);
    int32_t add_particles(int32_t material, int64_t n, const double *x, const double *y, const double *vx,
                          const double *vy);
    int32_t add_plate(const gp_plate &plate);
    void set_plate_motion(int32_t plate, double vx, double vy, double omega);
    void set_gravity(double gx, double gy);

    gp_status step(gp_sim *handle, int64_t n);
    gp_status run(gp_sim *handle, double t_end);

    void set_callback(int64_t every, gp_callback callback, void *user);
    void set_log(gp_log callback, void *user);
    void log(int32_t level, const std::string &text) const;
    void warn(const std::vector<std::string> &texts) const;

    // Builds what the stages work on from the scene, if that is still to be done, or what a step without memory has left
    // unfinished. Readers call it first.
    void prepare();
    bool is_prepared() const { return world_ && world_->lists_whole; }
    Progress progress() const;
    Crossing *crossing() const { return crossing_.get(); }
    // Goes on from a checkpoint: world is that of this scene, or the part of it; NULL before the first step.
    void resume(std::unique_ptr<World> world, const Progress &progress);
    void set_plate_start(int32_t plate, const Vector &start, double angle) {
        scene_.set_plate_start(plate, start, angle);
    }
    const Scene &scene() const { return scene_; }
    const World &world() const { return *world_; }
    // Without preparing anything.
    Clock clock() const { return world_ ? world_->clock : Clock{}; }
    std::vector<gp_plan_entry> plan() const;

    uint64_t epoch() const { return epoch_; }
    double wall_seconds() const { return wall_seconds_; }
    bool in_callback() const { return in_callback_; }

    FrameSink *sink = nullptr; // the open output, if any

private:
    void require_unstarted(const char *call) const;
    // An open output has written the scene: from then on plates and gravity change within the world that it is of.
    bool is_scene_fixed() const { return started_ || sink; }
    void require_steppable();
    void scene_changed();
    void check_demanded_step() const;
    void run_stages();
    std::vector<std::string> take_step(); // or a piece of it after halving; returns what the log is to be told
    [[noreturn]] void leave_step();
    void set_world(std::unique_ptr<World> world);
    gp_status advance(gp_sim *handle, double t_end); // one step, output and callback

    std::unique_ptr<World> begin_world() const;
    int32_t add_particles_of_all(int32_t material, int64_t n, const double *x, const double *y, const double *vx,
                                 const double *vy);

    Scene scene_;
    std::shared_ptr<Crossing> crossing_;
    std::unique_ptr<World> world_; // or the part of it that is this process's
    Traits traits_{};
    std::vector<PlannedStage> stages_;
    bool started_ = false, diverged_ = false, in_callback_ = false;
    Warnings warnings_;
    uint64_t epoch_ = 0;
    double wall_seconds_ = 0;

    gp_callback callback_ = nullptr;
    void *callback_user_ = nullptr;
    int64_t callback_every_ = 1;
    gp_log log_ = nullptr;
    void *log_user_ = nullptr;
};

} // namespace gp
