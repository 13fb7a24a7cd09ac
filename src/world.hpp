// Everything that the stages of a time step work on.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "clusters.hpp"
#include "mirrors.hpp"
#include "neighbors.hpp"
#include "particles.hpp"
#include "scene.hpp"
#include "shift_tiles.hpp"
#include "sleep.hpp"
#include "viscous_system.hpp"
#include "walls.hpp"

namespace gp {

struct Clock {
    double time = 0;
    int64_t step = 0;
    double dt = 0;               // of the last step, or of the one under way
    double time_left = 0;        // until the end that the host asked for; 0: none
    int32_t reason = GP_DT_NONE; // GP_DT_...: what set dt
};

// A part of a step that diverged, to be taken anew (gp_config.retry_halvings).
struct Piece {
    double end;    // s, on the clock
    int32_t depth; // how often the step was halved for it
};

// Energies in J per metre of depth.
struct Ledger {
    double initial = 0;          // kinetic + potential + elastic at the start
    double reference_height = 0; // m along -g, where the potential is `level`
    double dissipated = 0;       // all of it
    double penalty = 0;          // the part of the zero-energy penalty
    double walls = 0;            // the part lost between ghosts and plates, and by grains in flight above them
    double diffusion = 0;        // the part of density diffusion
    double spacing = 0;          // the part of density_of_spacing: what it gives, below 0
    double bulk = 0;             // the part of the bulk viscosity
    double collisions = 0;       // the part of the collision safeguard
    double side_walls = 0;       // the part of the friction of side walls
    double plate_work = 0;       // done by the material on the plates
    double scale = 0; // of the scene's energies: the sum at the start or the latest change of gravity, from its height
    double largest_kinetic = 0; // since then
    double level = 0; // added to the potential, so that neither going round the period nor a change of gravity shows
};

// Sums of one step over one block of particles; a cache line each.
struct alignas(64) BlockSums {
    double plastic = 0;        // J/m, dissipated by yielding
    double bulk = 0;           // J/m, dissipated by the bulk viscosity
    double diffused = 0;       // J/m, lost by density diffusion
    double spaced = 0;         // J/m, lost where the density follows the spacing
    double total_power = 0;    // W/m, of all internal and wall forces
    double internal_power = 0; // W/m, sum of V sigma:L
    double acceleration2 = 0;  // m2/s4, sum
    double unbalanced = 0;     // kg/m, mass of the particles that forces and pushes together still accelerate
    double collision_loss = 0; // J/m
    double side_walls = 0;     // J/m, dissipated by the friction of side walls
    double released = 0;       // J/m, of compression that grains in flight let go
    double lost = 0;           // J/m, kinetic energy lost in the implicit solve
    int64_t collisions = 0;    // counted from both sides
    double kinetic = 0;        // J/m
    double densest = 0;        // largest density over the material's own
    bool unbounded = false;    // a density is not a number or out of bounds (stages.hpp)
    uint8_t half_done = 0;     // 1: half of the block's clusters, in for_each_awake_block_by_halves
};

// Extremes of the velocities of one block, for the time step and the neighbour lists.
struct alignas(64) BlockRange {
    double u_min, u_max, v_min, v_max;
};

// gp_state.at_rest: below this, in g, an acceleration does not count; what does is averaged over this many steps, since grains
// that touch and flow, without stress or at yield, push each other to and fro from step to step.
constexpr double rest_acceleration = 0.05, rest_steps = 20;

// What a step changes before it is known to be good (undo.hpp).
struct StepStart {
    Clock clock;
    Ledger ledger;
    std::vector<Plate> plates;
    double shifted = 0, closed_in = 0;
    bool fields_kept = false;          // the next ones hold the present step's beginning
    std::vector<Field<double>> copied; // of fields that are changed in place
    std::array<Field<double>, 4> made; // of the velocity gradient, made anew: memory is exchanged, not copied
    Field<double> sxx, sxy;            // of the deviator, from stress on; only in the default scheme
};

// What the neighbour lists were made of. A checkpoint keeps it in place of the lists, which it makes anew from it.
struct ListOrigin {
    Field<double> x, y; // m, of the particles in sorted order
    std::vector<Plate::State> plates;

    int64_t bytes() const { return static_cast<int64_t>((x.capacity() + y.capacity()) * sizeof(double)); }
};

// Of the part of a world: how much it has to do.
struct PartShare {
    bool dealt = false; // whose cells are whose has been settled
    double work = 0;    // s, in stages, since it was
    int lists = 0;      // made since then
};

struct World {
    const Scene *scene = nullptr;
    Constants constants;
    int threads = 1;

    Particles particles;
    CellGrid grid;
    Images images; // of a periodic scene or of a part of a world, else empty
    // Of a part of a world, whose other parts other processes have: all sums over particles that steps depend on are of all.
    Crossing *crossing = nullptr;
    std::unique_ptr<Halo> halo;
    PartShare share;
    Box box; // of all particles when the lists were made
    ClusterList clusters;
    NeighborList neighbors; // of single particles; empty in the default scheme
    Walls walls;
    // With GP_STRESS_IMPLICIT, else empty.
    Mirrors mirrors;
    ViscousSystem viscous;
    Clock clock;
    double mass = 0; // kg/m, of all particles
    Ledger ledger;

    // Neighbour lists are good while particles (and plates) have moved by less than the skin against each other.
    bool lists_valid = false;
    bool lists_new = false;  // made in the present step: it has sorted the particles
    bool lists_whole = true; // false: memory ran out while they were made
    ListOrigin list_origin;
    Field<int32_t> listed; // particle of each place in the lists and cells, where a sort was undone; empty: the same
    double skin = 0;       // m
    // m, bound on the relative shift of any two since the lists were made, but for moves without a velocity (stages/collide.cpp)
    double shifted = 0;
    double closed_in = 0;     // m, and on that of those that may come into each other's reach: what makes lists anew
    ShiftTiles tiles;         // what that is measured in
    double velocity_span = 0; // m/s, bound on the difference of any two velocities, plates in reach included
    double fastest = 0;       // m/s, bound on any particle's speed

    Sleep sleep;
    std::vector<BlockSums> sums;
    std::vector<BlockRange> ranges;
    Field<uint8_t> colliding; // partners of each particle in this step's collisions
    // How much denser they are where it flows, as if no surface were near, than their density says: share of the lattice's; less than
    // none elsewhere. From force to collide. Not in the schemes by number density.
    Field<float> crowded;
    double plastic_power = 0;    // W/m, of the last step
    double unbalanced_share = 0; // of the mass, that was accelerated by more than rest_acceleration g lately
    int64_t collisions = 0;
    double max_compression = 0;  // largest density over the material's own so far, less 1
    double packing_at_start = 0; // volume_drift.hpp; the lattice's if no horizon was full
    StepStart step_start;
    std::vector<Piece> pieces; // of a diverged step, the next one last
    int64_t retries = 0;

    int64_t particle_listed_at(int64_t place) const { return listed.empty() ? place : listed[place]; }
    // m: what is within a radius now was within this of where one was when the lists were made.
    double radius_then(double radius) const {
        // Particles that were in tiles next to each other have moved by no more than closed_in; others were tiles.width() apart,
        // and may have moved by so much more: not to within reach as long as the lists are good.
        const bool listed_near = radius <= constants.reach && closed_in <= skin;
        const double moved = listed_near ? skin : closed_in + (tiles.width() - constants.reach - skin);
        return radius + std::min(shifted, moved);
    }
    const ReturnMap &map_of(int64_t i) const { return material_of(i).map; }
    const MaterialConstants &material_of(int64_t i) const {
        return constants.materials[constants.body_material[particles.column[i]]];
    }
    const FluidityConstants &fluidity_of(int64_t i) const {
        return constants.fluidities[constants.body_material[particles.column[i]]];
    }
    bool is_fluid(int64_t i) const { return fluidity_of(i).cooperativity2 > 0; }
};

// With room for so many particles, plates where they begin.
std::unique_ptr<World> make_bare_world(const Scene &scene, const Constants &constants, int64_t count);
// All is as the scene has it at the beginning; the particles are those from `first` on, as many as there is room for.
void begin_particles(World &world, int64_t first);
// The world of a scene before its first step: particles and plates in place, no lists yet.
std::unique_ptr<World> make_world(const Scene &scene);

} // namespace gp
