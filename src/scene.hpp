// The scene: config + materials + bodies of particles + plates, checked when they are added and not changed after the
// first step; and the constants that follow from it.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "geometry.hpp"
#include "granperi/gp.h"
#include "kernel.hpp"
#include "material/number_density_state.hpp"
#include "material/regularized.hpp"
#include "material/return_map.hpp"

namespace gp {

// The schemes that there are: stage lists over the same fields (plan.cpp, plan_implicit.cpp, plan_paper.cpp).
enum class Scheme {
    adjoint,    // the default: continuity, return map, adjoint operators
    implicit,   // the same with the regularised law in place of the return map, solved implicitly
    paper,      // Jin et al. (2021): number density, regularised law, force states
    paper_local // its local model: the same by MPS operators
};
Scheme scheme_of(const gp_config &config); // throws for a combination of choices that is none of them

// Does the pressure follow from the particle number density, with the paper's operators and ghosts?
inline bool by_number_density(Scheme scheme) {
    return scheme == Scheme::paper || scheme == Scheme::paper_local;
}

gp_config default_config(int32_t preset); // throws for an unknown preset
gp_material default_material();
gp_column default_column();
gp_plate default_plate();

// How a rigid body moves: velocity of its pivot, and rate of turning.
struct Motion {
    Vector velocity = Vector::Zero(); // m/s
    double omega = 0;                 // rad/s, counter-clockwise
    bool operator==(const Motion &other) const { return velocity == other.velocity && omega == other.omega; }
    bool any() const { return velocity != Vector::Zero() || omega != 0; }
};

// Displacement and turn of a plate over time: a table of knots, or nothing.
struct MotionTable {
    std::vector<double> t, x, y, angle; // s, m, m, rad; angle: empty where the plate does not turn
    bool empty() const { return t.empty(); }
    Vector displacement(double time) const;
    double turn(double time) const;
    double last_time() const { return t.empty() ? 0.0 : t.back(); }
};

struct PlateSpec {
    std::vector<Vector> points;    // m, of the wetted line as given: at time 0, before the table displaces it
    std::vector<Segment> segments; // between them
    int32_t friction = GP_WALL_NO_SLIP;
    double wall_mu = 0;
    Vector pivot = Vector::Zero(); // m, about which it turns
    Motion motion;                 // of a plate without a table
    double surface_velocity = 0;   // m/s, along the line, of the surface alone
    MotionTable table;
    Vector start = Vector::Zero(); // displacement at time 0, of a plate without a table
    double start_angle = 0;        // rad, the same of its turn
    double load = 0;               // Pa on its back, towards the material; 0: the motion is prescribed
    double mass = 0;               // kg/m2 of a loaded plate; 0: chosen with the constants
    int32_t fluidity = GP_FLUIDITY_FREE;

    // What follows from the points.
    double length = 0;                   // m, of the line
    Vector back_normal = Vector::Zero(); // of the straight way from the first point to the last: a load acts along it,
    double back_length = 0;              // m, on this length
    Vector middle = Vector::Zero();      // m, of the box around the points,
    Vector extent = Vector::Zero();      // m, and its size
    double farthest = 0;                 // m, from the pivot, of any point

    explicit PlateSpec(std::vector<Vector> line);
    void set_pivot(const Vector &at);
    // Where it stands at time 0.
    Pose first_pose() const {
        return table.empty() ? Pose{start, start_angle} : Pose{table.displacement(0), table.turn(0)};
    }
    // Is a segment whose normal is this one within a distance of a point?
    bool lies_at(const Vector &point, const Vector &normal, double within) const;
    bool closed() const { return points.front() == points.back(); }
};

// Throws if a motion prescribed for a loaded plate has a part along its normal, or turns it. name: of the argument.
void require_tangential(const PlateSpec &plate, const Motion &motion, const char *name);

// A column or a set of particles from the host.
struct Body {
    int32_t material = 0;
    int64_t first = 0, count = 0; // its particles
    bool rectangle = false;       // a column: the next fields are meant
    double x_min = 0, y_min = 0, width = 0, height = 0;
    bool hydrostatic = false;
    double vx = 0, vy = 0;
    int64_t across = 1;         // particles of a row
    std::vector<double> set[4]; // x, y, vx, vy of those of a set
};

struct MaterialConstants {
    double density; // rho0 = phi rho_s, kg/m3
    double grain_density, grain_diameter;
    double k0;           // stress across over stress along, with which columns begin; 0: isotropic
    double bulk_modulus; // rho0 c0^2, Pa
    ReturnMap map;
    Regularized law;
};

// Of the granular fluidity. Apart from the others: loops that have nothing to do with it do not step over it.
struct FluidityConstants {
    double cooperativity2; // m2, (A d)^2; 0: the local law
    double time;           // s, t0
};

// Sound speed over the largest flow speed, so that the density varies by about 1 % ([1], section 2.2).
constexpr double sound_to_flow_speed = 10.0;

// Speed of the hardest blow over the sound speed. In theory what is stopped at v is compressed by v / c0, bearing rho c v. Blocks
// that fall on a rough floor, 6 x 6 to 40 x 20, also without sides, with and without jitter; compression in v / c0 where they are
// densest and of the densest fifth; largest energy error over the kinetic energy, in %:
//
//   c0 / v   densest       fifth        energy
//     10     1.0 to 2.5    .2 to 1.0    -8.5
//     33      .7 to 2.8    .1 to 1.0    -0.8 to -3.9
//     50      .6 to 2.8     0 to 1.0    -0.6 to -2.2
//     60      .6 to 2.5     0 to 1.0    -0.5 to -1.8
//
// These with cfl .8. The energy error is in proportion to the time step, too (33: -3.8, -1.8, -.9, -.5 % with cfl .8, .4, .2, .1), so
// a longer step with a smaller sound speed is no gain. There is no plateau in what becomes of a block that falls far: the stiffer, the less of
// its energy it springs back with (a block of 20 x 10 spacings from .5 m: .30, .19, .09 with c0 / v = 10, 33, 100), and the
// narrower its heap (the middle half of its mass within .64, .57, .39, .25 m with 10, 20, 40, 80).
constexpr double most_blow = 1.0 / 60;

// A blow that a scene foresees (scene_falls.hpp).
struct Impact {
    double speed = 0;   // m/s, along the normal of what is met; 0: none
    double fall = 0;    // m, the part of the way that is a free fall; 0: by the velocity with which it begins
    int32_t body = -1;  // that meets
    int32_t plate = -1; // the plate, or
    int32_t onto = -1;  // the body that is met
};

// What follows from the scene once it is complete.
struct Constants {
    Scheme scheme;
    double spacing, volume;
    Vector gravity;
    Period period;                   // in x; empty where the scene is not periodic
    double horizon;                  // m
    double interaction_radius;       // m
    double reach;                    // m, of the neighbour and ghost lists: the largest radius that the scheme uses
    LatticeSums lattice;             // for the horizon
    LatticeSums interaction_lattice; // for the interaction radius
    OneSidedSlope one_sided;         // of the weight
    double sound_speed;              // c0, m/s
    double flow_speed; // m/s, the largest that the scene can reach; at the start the sound speed is based on it
    bool sound_speed_is_arbitrary; // nothing in the scene sets a speed
    Impact impact;                 // the hardest; none with the number density
    bool sound_speed_is_of_impact; // chosen for it
    double wave_speed;             // of elastic compression waves: c0 sqrt(1 + G/(rho c0^2)), c0 without G; m/s
    double fall_height;            // m, that the flow speed is based on
    double plate_mass;             // kg/m2, of a loaded plate that has none of its own
    double plate_step;             // s, largest step that is stable for the lightest loaded plate
    double sound_step;             // s, largest step that is stable for elastic waves
    double own_step;               // s, that the scheme takes of its own accord
    double quick_step;             // s, the same where the material moves quickly
    double viscous_step;           // s, the same with the coefficients that damp
    double contrast_step;          // s, largest step that is stable where materials of different density meet
    double penalty;                // Pa s/m2 per unit of w: zero_energy_penalty rho c0 / (dl N0)
    double elastic_penalty;        // the same inside the yield surface, over that
    double pressure_memory;        // s, over which the pressure of the inertial number is averaged
    bool rate_dependent;           // a material in use has friction by the inertial number; only in the default scheme
    bool fluid;                    // a material in use has a fluidity
    std::vector<FluidityConstants> fluidities; // of the materials
    std::vector<MaterialConstants> materials;
    std::vector<int32_t> body_material;

    // Are all bodies of one density?
    bool one_density() const {
        for (const int32_t material : body_material)
            if (materials[material].density != materials[body_material[0]].density)
                return false;
        return true;
    }

    // s, sqrt(fall_height/g), or spacing/c0 x 100 without gravity
    double time_scale() const {
        const double g = gravity.norm();
        return g > 0 && fall_height > 0 ? std::sqrt(fall_height / g) : 100 * spacing / sound_speed;
    }
};

struct InitialStress {
    double pressure = 0, sxx = 0, sxy = 0; // Pa
};

class Scene {
public:
    explicit Scene(const gp_config &config); // throws gp::Error

    int32_t add_material(const gp_material &material);
    // note: receives a text if the size had to be rounded to whole spacings, else stays empty.
    int32_t add_column(const gp_column &column, std::string &note);
    int32_t add_particles(int32_t material, int64_t n, const double *x, const double *y, const double *vx,
                          const double *vy);
    // Throws what that would.
    void check_particles(int32_t material, int64_t n, const double *x, const double *y, const double *vx,
                         const double *vy) const;
    int32_t add_plate(const gp_plate &plate);
    // In place of the config's.
    void set_gravity(const Vector &gravity);
    // From now on the plate has this constant motion in place of its own.
    void drive_plate(int32_t plate, const Motion &motion);
    // Throws if a plate is too long to turn within the period. name: of the argument.
    void require_room_to_turn(const PlateSpec &plate, const Motion &motion, const char *name) const;
    // Of a plate that was driven before the first step: how its table, which is gone, displaced and turned it.
    void set_plate_start(int32_t plate, const Vector &start, double angle);

    const gp_config &config() const { return config_; }
    Period period() const {
        if (config_.periodic_x_max > config_.periodic_x_min)
            return {config_.periodic_x_min, config_.periodic_x_max - config_.periodic_x_min};
        return {};
    }
    const std::vector<gp_material> &materials() const { return materials_; }
    const std::vector<Body> &bodies() const { return bodies_; }
    const std::vector<PlateSpec> &plates() const { return plates_; }
    int64_t particle_count() const { return bodies_.empty() ? 0 : bodies_.back().first + bodies_.back().count; }

    // Of a particle as it begins, by its id. Those of columns are laid anew whenever they are asked for: so a scene is as small with
    // any number of them. body: its own.
    Vector position(const Body &body, int64_t id) const;
    Vector velocity(const Body &body, int64_t id) const {
        if (body.rectangle)
            return {body.vx, body.vy};
        return {body.set[2][id - body.first], body.set[3][id - body.first]};
    }
    int32_t body_of(int64_t id) const;
    // Calls visit(id, body, position) for all particles.
    template <class Visit> void for_each_particle(const Visit &visit) const {
        for (std::size_t b = 0; b < bodies_.size(); ++b)
            for (int64_t id = bodies_[b].first; id < bodies_[b].first + bodies_[b].count; ++id)
                visit(id, static_cast<int32_t>(b), position(bodies_[b], id));
    }

    Constants constants() const { return constants(impact()); }
    // With the impact known: to find it takes a look at all particles.
    Constants constants(const Impact &impact) const;
    Impact impact() const;
    // Gravity, and the height and speed of a fall of material that is at the places that are visited (of plates that are where they
    // begin).
    using Places = std::function<void(const std::function<void(const Vector &)> &visit)>;
    void set_fall(Constants &constants, const Vector &gravity, const Places &for_each_place) const;
    // With which the particles first .. end begin (gp_column.initial_pressure).
    std::vector<InitialStress> initial_stress(const Constants &constants, int64_t first, int64_t end) const;

private:
    gp_config config_;
    std::vector<gp_material> materials_;
    std::vector<Body> bodies_;
    std::vector<PlateSpec> plates_;
};

} // namespace gp
