#include "plan.hpp"

#include <algorithm>
#include <cstring>

#include "stages/stages.hpp"
#include "undo.hpp"

namespace gp {

Traits traits_of(const Scene &scene, const Constants &constants) {
    Traits t;
    t.scheme = constants.scheme;
    t.particles = scene.particle_count() > 0;
    t.periodic = static_cast<bool>(scene.period());
    t.plates = !scene.plates().empty();
    t.friction_plates = std::any_of(scene.plates().begin(), scene.plates().end(), [&](const PlateSpec &plate) {
        return (plate.friction == GP_WALL_COULOMB && plate.wall_mu > 0) ||
               (plate.friction == GP_WALL_NO_SLIP && constants.scheme == Scheme::adjoint);
    });
    t.channel = scene.config().channel_width > 0;
    t.side_walls = scene.config().channel_width > 0 && scene.config().channel_friction > 0;
    t.penalty = constants.penalty > 0;
    t.collisions = scene.config().collision_distance > 0;
    t.diffusion = scene.config().density_diffusion > 0;
    t.fluid = constants.fluid;
    t.sleep = scene.config().sleep == 1;
    return t;
}

namespace {

bool in_reach(const World &world) {
    return world.walls.in_reach();
}

bool any_awake(const World &world) {
    return !world.sleep.idle;
}

bool awake_in_reach(const World &world) {
    return world.walls.in_reach() && any_awake(world);
}

bool plates_move(const World &world) {
    const std::vector<Plate> &plates = world.walls.plates;
    return std::any_of(plates.begin(), plates.end(),
                       [&](const Plate &plate) { return plate.moves_after(world.clock.time) || plate.motion().any(); });
}

// The time step of the default scheme, in order: reading this table is reading the method.
std::vector<PlannedStage> default_stages(const Traits &t) {
    const char *no_particles = "the scene has no particles";
    const char *no_plates = "the scene has no plates";
    const char *none_near = "no plate is within reach of material";
    const char *not_periodic = "the scene is not periodic";
    const char *no_side_walls = t.channel ? "channel_friction is 0" : "channel_width is 0";
    const bool walls = t.particles && t.plates, friction = walls && t.friction_plates, sleep = t.particles && t.sleep;
    // Where all material sleeps these have no work.
    const auto awake = sleep ? any_awake : nullptr;
    const auto awake_near = sleep ? awake_in_reach : in_reach;
    const char *all_sleep = "all material sleeps";
    const char *no_work = sleep ? "no plate is within reach of material that is awake" : none_near;
    const char *no_sleep = t.particles ? "sleep is 0" : no_particles;
    // clang-format off
    return {
        // name, when the scene needs it, why, why not, function, whether it has work now, what it says when not
        // reads how fast particles and plates are, what is left of the run; writes the clock's dt
        {"choose_dt", true, "every scene has a clock", "", stages::choose_dt, nullptr, ""},
        // writes where plates and their ghosts are in this step, and how they move
        {"move_plates", t.plates, "a plate moves", no_plates,
         stages::move_plates, plates_move, "no plate moves now"},
        // reads position; if the lists have run out, sorts the particles and makes lists, images, contacts, ghosts
        {"update_neighbors", t.particles, "particles interact", no_particles, stages::update_neighbors, nullptr, ""},
        // reads what moved, by how the step before ended; writes who is awake
        {"wake", sleep, "sleep is 1: what nothing reaches is left out", no_sleep, stages::wake, nullptr, ""},
        // copies what the next stages overwrite; takes the pushes' memory for the gradient before the step, until integrate
        {"keep_fields", t.particles, "a step that diverges is taken back", no_particles, keep_fields, awake, all_sleep},
        // reads pressure, stress; writes which particles flow, in the acceleration's memory
        {"flowing", t.particles, "densities are tied to each other and to the spacing where it flows", no_particles,
         stages::flowing, awake, all_sleep},
        // reads velocity, which particles flow; writes ghost velocity
        {"wall_velocity", walls, "a plate is within reach of material", t.particles ? no_plates : no_particles,
         stages::wall_velocity, awake_near, no_work},
        // reads position, velocity; writes shape tensor, velocity gradient and, where it flows, number density; with density
        // diffusion also reads density, and writes what is exchanged: one loop over pairs for all
        {"gradient", t.particles, t.diffusion ? "particles interact; with the pair sums of density_diffusion"
                                              : "particles interact",
         no_particles, t.diffusion ? stages::gradient_and_exchange : stages::gradient, awake, all_sleep},
        // reads what is exchanged; writes density
        {"density_diffusion", t.particles && t.diffusion, "density_diffusion > 0", "density_diffusion is 0",
         stages::density_diffusion, awake, all_sleep},
        // reads number density, velocity gradient; writes density; leaves in the acceleration's memory what is spaced how
        {"density_of_spacing", t.particles, "what flows keeps its volume", no_particles, stages::density_of_spacing,
         awake, all_sleep},
        // reads velocity gradient; writes density, pressure
        {"density", t.particles, "density by continuity", no_particles, stages::density, awake, all_sleep},
        // reads what neighbours pull the fluidity to, summed up by the gradient; writes it for the stress
        {"fluidity", t.particles && t.fluid, "a material has nonlocal_amplitude > 0", "nonlocal_amplitude is 0",
         stages::fluidity, awake, all_sleep},
        // reads velocity gradient, pressure, its mean, shape tensor for the last time; writes stress, sigma K^-1; with fluidity that,
        // too
        {"stress", t.particles, "elastic trial and return map", no_particles, stages::stress, awake, all_sleep},
        // reads pressure, stress; writes ghost stress
        {"wall_stress", walls, "a plate is within reach of material", t.particles ? no_plates : no_particles,
         stages::wall_stress, awake_near, no_work},
        // reads sigma K^-1, velocity, velocity gradient, number density; writes acceleration, and what is crowded; with
        // wall_friction also reads position, stress, and writes what plates take off the slip: who has the forces at hand has those
        {"force", t.particles, t.penalty ? "force states, gravity, zero-energy penalty" : "force states, gravity",
         no_particles,
         friction && t.scheme == Scheme::adjoint ? stages::force_and_friction : stages::force, awake, all_sleep},
        // reads acceleration, pressure; writes velocity, position, the mean of the pressure
        {"integrate", t.particles, "particles move", no_particles, stages::integrate, awake, all_sleep},
        // reads what plates take off the slip, or finds it by the contact forces; writes velocity, position
        {"wall_friction", friction, "a plate has friction", "no plate has friction",
         stages::wall_friction, awake_near, no_work},
        // reads pressure; writes velocity, position
        {"side_wall_friction", t.particles && t.side_walls, "channel_width > 0 and channel_friction > 0",
         t.particles ? no_side_walls : no_particles, stages::side_wall_friction, awake, all_sleep},
        // writes position, velocity of the images; reads these, what flows and is crowded; writes velocity, position
        {"collide", t.particles && t.collisions,
         by_number_density(t.scheme) ? "collision_distance > 0" : "collision_distance > 0; what flows collides",
         "collision_distance is 0", stages::collide, awake, all_sleep},
        // reads position, velocity; writes velocity, position
        {"wall_contact", walls, "a plate is within reach of material", t.particles ? no_plates : no_particles,
         stages::wall_contact, awake_near, no_work},
        // reads velocity, stress; writes who rests, and the velocity of what falls asleep
        {"sleep", sleep, "sleep is 1: what rests is left out", no_sleep, stages::sleep, awake, all_sleep},
        // reads position, velocity; writes those of the images
        {"update_images", t.particles && (t.periodic || t.parts),
         t.parts ? "other processes have particles, too" : "the scene is periodic in x", t.particles ? not_periodic : no_particles,
         stages::update_images, awake, all_sleep},
        // reads contact forces, velocity; writes ledger, loads, extremes, and moves loaded plates by their loads
        {"account", t.particles, "energy ledger, loads, extremes", no_particles, stages::account, nullptr, ""},
    };
    // clang-format on
}

} // namespace

std::vector<PlannedStage> make_stages(const Traits &t) {
    struct Choice {
        Scheme scheme;
        const char *elsewhere;
        std::vector<PlannedStage> stages;
    };
    const std::vector<PlannedStage> first = default_stages(t);
    const Choice choices[] = {
        {Scheme::adjoint, "a stage of the default scheme", first},
        {Scheme::implicit, "a stage of the implicit scheme (GP_STRESS_IMPLICIT)", implicit_stages(t, first)},
        {Scheme::paper, "a stage of the paper's schemes (GP_PRESET_PAPER)", paper_stages(t, first)},
        {Scheme::paper_local, "a stage of the paper's local model (GP_PRESET_PAPER_LOCAL)",
         paper_local_stages(t, first)}};
    std::vector<PlannedStage> stages;
    for (const Choice &choice : choices)
        if (choice.scheme == t.scheme)
            stages = choice.stages;
    // What only the other schemes have is named as left out.
    for (const Choice &choice : choices)
        for (PlannedStage stage : choice.stages) {
            const auto same_name = [&](const PlannedStage &other) { return !std::strcmp(other.name, stage.name); };
            if (std::any_of(stages.begin(), stages.end(), same_name))
                continue;
            stage.needed = false;
            stage.why_not = choice.elsewhere;
            stages.push_back(stage);
        }
    return stages;
}

namespace {

template <class T> int64_t bytes_of(const T &field) {
    return static_cast<int64_t>(field.capacity() * sizeof(typename T::value_type));
}

template <class... Fields> int64_t bytes_of_all(const Fields &...fields) {
    return (bytes_of(fields) + ...);
}

int64_t bytes_of_repose(const Repose &repose) {
    int64_t bytes = 0;
    Repose::for_each(repose, [&](const char *, const Field<double> &field) { bytes += bytes_of(field); });
    return bytes;
}

gp_plan_entry field_entry(const char *name, bool active, const char *reason, int64_t bytes) {
    gp_plan_entry entry{};
    entry.name = name;
    entry.reason = reason;
    entry.kind = 1;
    entry.active = active ? 1 : 0;
    entry.bytes = bytes;
    return entry;
}

} // namespace

std::vector<gp_plan_entry> describe_plan(const std::vector<PlannedStage> &stages, const Traits &t, const World &world) {
    std::vector<gp_plan_entry> entries;
    for (const PlannedStage &stage : stages) {
        gp_plan_entry entry{};
        const bool now = stage.needed && (!stage.now || stage.now(world));
        entry.name = stage.name;
        entry.reason = !stage.needed ? stage.why_not : (now ? stage.why : stage.idle);
        entry.kind = 0;
        entry.active = now ? 1 : 0;
        entry.seconds = stage.seconds;
        entry.calls = stage.calls;
        entries.push_back(entry);
    }
    const Particles &p = world.particles;
    const char *always = t.particles ? "every scene with particles has it" : "the scene has no particles";
    const auto common = [&](const char *name, int64_t bytes) {
        entries.push_back(field_entry(name, t.particles, always, bytes));
    };
    common("id", bytes_of(p.id));
    common("column", bytes_of(p.column));
    common("position", bytes_of_all(p.x, p.y));
    common("velocity", bytes_of_all(p.vx, p.vy));
    common("density", bytes_of(p.density));
    common("pressure", bytes_of(p.pressure));
    common("deviatoric_stress", bytes_of_all(p.sxx, p.sxy));
    const auto optional = [&](const char *name, bool needed, const char *why, const char *why_not, int64_t bytes) {
        entries.push_back(field_entry(name, t.particles && needed,
                                      !t.particles ? always
                                      : needed     ? why
                                                   : why_not,
                                      bytes));
    };
    optional("mean_pressure", world.constants.rate_dependent, "friction goes by the inertial number",
             t.scheme == Scheme::adjoint ? "all material has mu_2 = mu_s or a fluidity"
                                         : "a field of the default scheme",
             bytes_of(p.mean_pressure));
    common("velocity_gradient", bytes_of_all(p.lxx, p.lxy, p.lyx, p.lyy));
    const bool force_states = t.scheme != Scheme::paper_local, viscous = by_number_density(t.scheme);
    optional("viscous_stress_yy", viscous, "the viscous stress has a trace", "the deviatoric stress has no trace",
             bytes_of(p.syy));
    optional("inverse_shape_tensor", force_states, "force states need it", "the local model has no force states",
             bytes_of_all(p.gxx, p.gxy, p.gyy));
    common("stress_over_shape", bytes_of_all(p.cxx, p.cxy, p.cyx, p.cyy));
    common("acceleration", bytes_of_all(p.ax, p.ay));
    common("push", bytes_of_all(p.push_x, p.push_y));
    const bool own_memory = t.scheme != Scheme::adjoint;
    entries.push_back(field_entry(
        "stressed", t.penalty,
        !t.penalty   ? "zero_energy_penalty is 0"
        : own_memory ? "the zero-energy penalty acts on stressed material"
                     : "the zero-energy penalty acts on stressed material; in the inverse shape tensor's memory",
        bytes_of(p.stressed)));
    const char *by_number = "the density is that of the positions";
    optional("flowing", !viscous, "densities are tied where it flows; in the acceleration's memory", by_number,
             bytes_of(p.flowing));
    optional("crowding", !viscous, "what flows keeps its volume; in the memory of stress over shape", by_number,
             bytes_of(p.crowding));
    optional("spaced", !viscous && t.collisions, "collisions ask for what is crowded; in the acceleration's memory",
             viscous ? by_number : "collision_distance is 0", bytes_of_all(p.spaced, p.known));
    entries.push_back(field_entry("bearing", t.diffusion || t.fluid,
                                  t.diffusion ? "density_diffusion > 0; in the acceleration's memory"
                                  : t.fluid   ? "nonlocal_amplitude > 0; in the acceleration's memory"
                                              : "density_diffusion and nonlocal_amplitude are 0",
                                  bytes_of_all(p.bearing, p.bearing_flow)));
    const bool exchanged = t.diffusion && !world.constants.one_density();
    entries.push_back(field_entry("rest_density", exchanged,
                                  !t.diffusion ? "density_diffusion is 0"
                                  : exchanged  ? "density diffusion between materials of different density"
                                               : "all material is of one density",
                                  bytes_of_all(p.rest, p.inverse_rest)));
    optional("fluidity", t.fluid, "a material has nonlocal_amplitude > 0", "nonlocal_amplitude is 0",
             bytes_of_all(p.fluidity, p.fluid_seen) + bytes_of_all(p.fluid_pull, p.fluid_pace));
    const bool flights = t.plates && !by_number_density(t.scheme);
    entries.push_back(
        field_entry("carried", flights,
                    flights     ? "grains in flight above a plate carry no stress; in the memory of stress over shape"
                    : !t.plates ? "the scene has no plates"
                                : "the paper's schemes know no flight",
                    bytes_of(p.carried)));
    entries.push_back(field_entry("colliding", t.collisions,
                                  t.collisions ? "collision_distance > 0" : "collision_distance is 0",
                                  bytes_of(world.colliding)));
    entries.push_back(field_entry("crowded", t.collisions && !viscous,
                                  !t.collisions ? "collision_distance is 0"
                                  : viscous     ? by_number
                                            : "collisions are of what flows; crowded pairs are moved apart, not braked",
                                  bytes_of(world.crowded)));
    int64_t kept = 0;
    for (const Field<double> &field : world.step_start.copied)
        kept += bytes_of(field);
    for (const Field<double> &field : world.step_start.made)
        kept += bytes_of(field);
    kept += bytes_of_all(world.step_start.sxx, world.step_start.sxy);
    optional("kept_fields", true, "a step that diverges is taken back", "", kept);
    common("cells", world.grid.bytes());
    common("clusters", world.clusters.bytes());
    optional("neighbor_lists", t.scheme != Scheme::adjoint, "operators on single particles",
             "the default scheme's operators work on clusters", world.neighbors.bytes());
    common("list_origin", world.list_origin.bytes() + world.tiles.bytes());
    optional("images", t.periodic || t.parts,
             t.parts ? "other processes have particles, too" : "the scene is periodic in x",
             "the scene is not periodic", world.images.bytes() + (world.halo ? world.halo->bytes() : 0));
    optional("viscous_system", t.scheme == Scheme::implicit, "the implicit solve's operators and vectors",
             "no implicit solve", world.viscous.bytes() + world.mirrors.bytes());
    optional("sleep", t.sleep, "sleep is 1: how long it has rested, spans and loads of what sleeps", "sleep is 0",
             bytes_of_repose(p.repose) + world.sleep.bytes());
    common("block_sums", bytes_of_all(world.sums, world.ranges));
    entries.push_back(field_entry("ghosts", t.plates && world.walls.in_reach(),
                                  !t.plates ? "the scene has no plates"
                                            : (world.walls.in_reach() ? "a plate is within reach of material"
                                                                      : "no plate is within reach of material"),
                                  world.walls.bytes()));
    return entries;
}

} // namespace gp
