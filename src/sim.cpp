#include "sim.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

#include "entry.hpp"
#include "ledger.hpp"
#include "parts.hpp"
#include "stages/stages.hpp"
#include "undo.hpp"
#include "volume_drift.hpp"

namespace gp {

namespace {

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// While it lives, the host's callback runs: also one that throws leaves it so.
class InCallback {
public:
    explicit InCallback(bool &flag) : flag_(flag) { flag_ = true; }
    InCallback(const InCallback &) = delete;
    InCallback &operator=(const InCallback &) = delete;
    ~InCallback() { flag_ = false; }

private:
    bool &flag_;
};

} // namespace

// ---------------------------------------------------------------------------------------------- time loop

Sim::Sim(const gp_config &config, std::shared_ptr<Crossing> crossing) : scene_(config), crossing_(std::move(crossing)) {
    if (crossing_)
        require_partable(scene_);
}

void Sim::run_stages() {
    World &world = *world_;
    double before = now();
    const double begin = before, waited = crossing_ ? crossing_->waited() : 0.0;
    for (PlannedStage &stage : stages_) {
        if (!stage.needed || (stage.now && !stage.now(world)))
            continue;
        stage.run(world);
        const double after = now();
        stage.seconds += after - before;
        ++stage.calls;
        before = after;
    }
    world.clock.time += world.clock.dt;
    ++world.clock.step;
    wall_seconds_ += before - begin;
    if (crossing_)
        world.share.work += before - begin - (crossing_->waited() - waited);
}

// A step that diverges is undone and, if the host wants it, taken anew as two pieces of half its size, one after the other;
// a piece that diverges likewise. Each piece is a whole step to everyone who looks.
std::vector<std::string> Sim::take_step() {
    World &world = *world_;
    const int32_t most = scene_.config().retry_halvings;
    stages::require_moderate_flow(world); // no shorter step would help
    std::vector<std::string> notes;
    for (bool done = false; !done;) {
        begin_step(world);
        try {
            run_stages();
            done = true;
        } catch (const Error &error) {
            if (error.status() != GP_E_DIVERGED)
                leave_step();
            const double dt = world.clock.dt;
            undo_step(world);
            std::vector<Piece> &pieces = world.pieces;
            const double time = world.clock.time;
            const int32_t depth = pieces.empty() ? 1 : pieces.back().depth + 1;
            pieces.reserve(pieces.size() + 2);
            if (depth > most || !(time + 0.5 * dt > time))
                throw;
            if (depth == 1)
                pieces.push_back({time + dt, 1});
            pieces.back().depth = depth;
            pieces.push_back({time + 0.5 * dt, depth});
            ++world.retries;
            if (notes.empty())
                notes = warnings_.of_retry(world, error.what());
        } catch (const SharedFailure &) {
            throw;
        } catch (...) {
            leave_step();
        }
    }
    const Clock &clock = world.clock;
    while (!world.pieces.empty() && world.pieces.back().end - clock.time < 1e-9 * clock.dt)
        world.pieces.pop_back();
    ++epoch_;
    return notes;
}

// In a handler of what is no divergence: out of memory, most likely. A process alone may take the step again; of several, each
// may be anywhere in it: that is the end.
void Sim::leave_step() {
    if (!is_shared(crossing_.get())) {
        undo_step(*world_, UndoneOrder::as_it_is);
        throw;
    }
    Failure failure = failure_at_hand();
    failure.foreseen = false;
    throw crossing_->fail(failure);
}

gp_status Sim::advance(gp_sim *handle, double t_end) {
    std::vector<std::string> notes;
    try {
        notes = take_step();
    } catch (const Error &error) {
        diverged_ = error.status() == GP_E_DIVERGED;
        ++epoch_;
        throw;
    } catch (...) { // out of memory
        ++epoch_;
        throw;
    }
    // The step that was to land on the end has done so but for rounding: this before anyone looks.
    Clock &clock = world_->clock;
    if (t_end - clock.time < 1e-9 * clock.dt)
        clock.time = t_end;
    // An output that fails takes its frame with it, not the step: the callback sees that first.
    std::exception_ptr lost;
    try {
        if (sink)
            everywhere(crossing_.get(), [&] { sink->step_done(*world_); });
    } catch (...) {
        lost = std::current_exception();
    }
    try {
        warn(notes);
        if (log_ && !crossing_) // which looks at all particles, and every so often
            warn(warnings_.of_step(*world_));
    } catch (...) { // out of memory
        lost = lost ? lost : std::current_exception();
    }
    bool stop = false;
    if (callback_ && world_->clock.step % callback_every_ == 0) {
        const InCallback guard(in_callback_);
        const BackToHost host;
        stop = callback_(callback_user_, handle) != 0;
    }
    if (lost)
        std::rethrow_exception(lost);
    return stop ? GP_STOPPED : GP_OK;
}

gp_status Sim::step(gp_sim *handle, int64_t n) {
    if (n < 0)
        throw make_error(GP_E_ARGUMENT, "n = %lld: expected a whole number >= 0", static_cast<long long>(n));
    if (n == 0)
        return GP_OK;
    require_steppable();
    world_->clock.time_left = 0;
    for (int64_t k = 0; k < n; ++k)
        if (const gp_status status = advance(handle, INFINITY); status != GP_OK)
            return status;
    return GP_OK;
}

gp_status Sim::run(gp_sim *handle, double t_end) {
    const double time = world_ ? world_->clock.time : 0.0;
    if (!std::isfinite(t_end) || t_end < time)
        throw make_error(GP_E_ARGUMENT, "t_end = %g: expected a finite time not before the clock's %g s", t_end, time);
    if (t_end == time)
        return GP_OK;
    require_steppable();
    Clock &clock = world_->clock;
    while (clock.time < t_end) {
        clock.time_left = t_end - clock.time;
        if (const gp_status status = advance(handle, t_end); status != GP_OK)
            return status;
    }
    return GP_OK;
}

// --------------------------------------------------------------------------------------------------- world

void Sim::prepare() {
    if (is_prepared())
        return;
    if (world_) { // memory ran out in a step; readers need the cells, the next step makes its own lists
        stages::make_lists(*world_);
        world_->lists_valid = false;
        return;
    }
    set_world(begin_world());
}

// The world before its first step, with lists and ledger.
std::unique_ptr<World> Sim::begin_world() const {
    auto world = crossing_ ? begin_part(scene_, *crossing_) : make_world(scene_);
    stages::measure_velocities(*world);
    stages::update_neighbors(*world);
    if (by_number_density(world->constants.scheme))
        stages::number_density(*world);
    open_ledger(*world);
    for (int64_t i = 0; i < world->particles.count; ++i)
        world->max_compression =
            std::max(world->max_compression, world->particles.density[i] / world->material_of(i).density - 1);
    if (crossing_)
        crossing_->combine(&world->max_compression, 1, nullptr, 0);

    const Packing packing = measure_packing(*world, Part::all);
    world->packing_at_start = packing.particles > 0
                                  ? packing.number_density
                                  : packing_of_lattice(world->constants.horizon, world->constants.spacing);
    return world;
}

void Sim::set_world(std::unique_ptr<World> world) {
    traits_ = traits_of(scene_, world->constants);
    traits_.parts = crossing_ != nullptr;
    stages_ = make_stages(traits_);
    world_ = std::move(world);
}

std::vector<gp_plan_entry> Sim::plan() const {
    std::vector<gp_plan_entry> entries = describe_plan(stages_, traits_, *world_);
    if (!crossing_)
        return entries;
    const Traffic traffic = crossing_->traffic();
    gp_plan_entry entry{};
    entry.kind = 2;
    entry.active = 1;
    entry.name = "messages";
    entry.reason = "sent by this process in steps and readings; bytes: theirs; seconds: in all calls of MPI";
    entry.bytes = traffic.bytes;
    entry.seconds = crossing_->waited();
    entry.calls = traffic.messages;
    entries.push_back(entry);
    entry.bytes = 0;
    entry.seconds = 0;
    entry.name = "reductions";
    entry.reason = "over all processes";
    entry.calls = traffic.reductions;
    entries.push_back(entry);
    entry.name = "cuts";
    entry.reason = "of the plane into boxes of equal work";
    entry.calls = traffic.cuts;
    entries.push_back(entry);
    return entries;
}

Progress Sim::progress() const {
    return {started_, diverged_, warnings_.told(), epoch_, wall_seconds_};
}

void Sim::resume(std::unique_ptr<World> world, const Progress &progress) {
    epoch_ = progress.epoch;
    if (world)
        set_world(std::move(world));
    started_ = progress.started;
    diverged_ = progress.diverged;
    warnings_.set_told(progress.told);
    wall_seconds_ = progress.wall_seconds;
}

void Sim::require_steppable() {
    if (diverged_)
        throw make_error(GP_E_STATE, "the simulation has diverged and cannot be stepped");
    prepare();
    check_demanded_step();
    if (world_->clock.step == 0)
        stages::require_moderate_flow(*world_);
    if (const std::string note = warnings_.note_of_scene(*world_); !note.empty())
        log(GP_LOG_INFO, note);
    warn(warnings_.of_scene(*world_));
    started_ = true;
}

void Sim::check_demanded_step() const {
    if (scene_.config().allow_unstable_step)
        return;
    const double demanded = scene_.config().time_step;
    const double limit = stages::stable_dt(world_->constants);
    if (demanded > limit)
        throw make_error(GP_E_ARGUMENT,
                         "gp_config.time_step = %g: expected at most %g s, the stable limit of this scene, or "
                         "allow_unstable_step = 1",
                         demanded, limit);
    const double cfl = scene_.config().cfl;
    if (cfl * world_->constants.spacing / world_->constants.wave_speed > limit)
        throw make_error(GP_E_ARGUMENT,
                         "gp_config.cfl = %g: expected at most %g, the stable limit, or allow_unstable_step = 1", cfl,
                         limit * world_->constants.wave_speed / world_->constants.spacing);
}

// ----------------------------------------------------------------------------------------------- callbacks

void Sim::set_callback(int64_t every, gp_callback callback, void *user) {
    if (callback && every < 1)
        throw make_error(GP_E_ARGUMENT, "every = %lld: expected a whole number >= 1", static_cast<long long>(every));
    callback_ = callback;
    callback_user_ = user;
    callback_every_ = callback ? every : 1;
}

void Sim::set_log(gp_log callback, void *user) {
    log_ = callback;
    log_user_ = user;
}

void Sim::log(int32_t level, const std::string &text) const {
    if (log_ && (!crossing_ || crossing_->rank() == 0)) { // once
        const BackToHost host;
        log_(log_user_, level, text.c_str());
    }
}

void Sim::warn(const std::vector<std::string> &texts) const {
    for (const std::string &text : texts)
        log(GP_LOG_WARNING, text);
}

} // namespace gp
