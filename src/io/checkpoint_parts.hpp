// What a checkpoint consists of, each part described once for writing and reading. Only the files that write and read
// checkpoints include this.
#pragma once

#include <vector>

#include "io/checkpoint_file.hpp"
#include "io/config_names.hpp"
#include "io/output.hpp"
#include "sim.hpp"

namespace gp::io {

// Columns as they were added; and sets of particles, which have their initial positions and velocities one after the other.
struct BodyTable {
    std::vector<int32_t> material, is_column, initial_pressure;
    std::vector<int64_t> count;
    std::vector<double> x_min, y_min, width, height, column_vx, column_vy;
};

constexpr const char *set_arrays[] = {"particle_x", "particle_y", "particle_vx", "particle_vy"};

template <class File, class Table> void exchange_bodies(File &file, Table &t) {
    file.group("/bodies");
    file.array("material", t.material);
    file.array("is_column", t.is_column);
    file.array("initial_pressure", t.initial_pressure);
    file.array("count", t.count);
    file.array("x_min", t.x_min);
    file.array("y_min", t.y_min);
    file.array("width", t.width);
    file.array("height", t.height);
    file.array("column_vx", t.column_vx);
    file.array("column_vy", t.column_vy);
}

// Plates as they were added or, driven before the first step, have become since. Knots one plate after the other.
struct PlateTable {
    std::vector<int64_t> n_points, n_knots, n_knot_angles; // n_points: 0 for a plate of two ends
    std::vector<double> point_x, point_y, knot_t, knot_x, knot_y, knot_angle;
    std::vector<double> wall_mu, pivot_x, pivot_y, vx, vy, omega, surface_velocity, start_x, start_y, start_angle,
        normal_pressure, mass_per_length;
    std::vector<int32_t> friction, fluidity;
};

template <class File, class Table> void exchange_plates(File &file, Table &t) {
    file.group("/plates");
    file.array("n_points", t.n_points);
    file.array("point_x", t.point_x);
    file.array("point_y", t.point_y);
    file.array("friction", t.friction);
    file.array("fluidity", t.fluidity);
    file.array("wall_mu", t.wall_mu);
    file.array("pivot_x", t.pivot_x);
    file.array("pivot_y", t.pivot_y);
    file.array("vx", t.vx);
    file.array("vy", t.vy);
    file.array("omega", t.omega);
    file.array("surface_velocity", t.surface_velocity);
    file.array("start_x", t.start_x);
    file.array("start_y", t.start_y);
    file.array("start_angle", t.start_angle);
    file.array("normal_pressure", t.normal_pressure);
    file.array("mass_per_length", t.mass_per_length);
    file.array("n_knots", t.n_knots);
    file.array("knot_t", t.knot_t);
    file.array("knot_x", t.knot_x);
    file.array("knot_y", t.knot_y);
    file.array("n_knot_angles", t.n_knot_angles);
    file.array("knot_angle", t.knot_angle);
}

template <class File, class State> void exchange_progress(File &file, State &progress) {
    file.group("/progress");
    file.value("started", progress.started);
    file.value("diverged", progress.diverged);
    file.value("warnings_told", progress.told);
    file.value("epoch", progress.epoch);
    file.value("wall_seconds", progress.wall_seconds);
}

struct PositionTable {
    OutputPosition at;
    std::vector<uint8_t> path;
};

template <class File, class Table> void exchange_position(File &file, Table &t) {
    file.group("/output");
    file.array("path", t.path);
    file.value("every_seconds", t.at.every_seconds);
    file.value("next", t.at.next);
    file.value("frames", t.at.frames);
    file.value("step", t.at.step);
}

// ------------------------------------------------------------------------------- of a simulation that has begun

template <class File, class W> void exchange_clock_and_sums(File &file, W &w) {
    file.group("/clock");
    file.value("time", w.clock.time);
    file.value("step", w.clock.step);
    file.value("dt", w.clock.dt);
    file.value("time_left", w.clock.time_left);
    file.value("reason", w.clock.reason);
    file.group("/ledger");
    file.value("initial", w.ledger.initial);
    file.value("reference_height", w.ledger.reference_height);
    file.value("dissipated", w.ledger.dissipated);
    file.value("penalty", w.ledger.penalty);
    file.value("walls", w.ledger.walls);
    file.value("diffusion", w.ledger.diffusion);
    file.value("spacing", w.ledger.spacing);
    file.value("bulk", w.ledger.bulk);
    file.value("collisions", w.ledger.collisions);
    file.value("side_walls", w.ledger.side_walls);
    file.value("plate_work", w.ledger.plate_work);
    file.value("scale", w.ledger.scale);
    file.value("largest_kinetic", w.ledger.largest_kinetic);
    file.value("level", w.ledger.level);
    file.group("/gravity");
    file.value("x", w.constants.gravity.x());
    file.value("y", w.constants.gravity.y());
    file.value("fall_height", w.constants.fall_height);
    file.value("flow_speed", w.constants.flow_speed);
    file.group("/so_far");
    file.value("collisions", w.collisions);
    file.value("max_compression", w.max_compression);
    file.value("packing_at_start", w.packing_at_start);
    file.value("retries", w.retries);
    file.value("plastic_power", w.plastic_power);
    file.value("unbalanced_share", w.unbalanced_share);
    file.value("velocity_span", w.velocity_span);
    file.value("fastest", w.fastest);
    file.value("implicit_newton", w.viscous.newton);
    file.value("implicit_linear", w.viscous.linear);
    file.value("implicit_failures", w.viscous.failures);
    file.value("implicit_last", w.viscous.last);
    file.value("implicit_residual", w.viscous.last_residual);
}

// The lists themselves are made anew from where the particles and plates were when they were made.
struct ListTable {
    bool valid = false;
    double skin = 0, shifted = 0, closed_in = 0;
    std::vector<double> plate_x, plate_y, plate_angle; // shift and turn
    std::vector<int32_t> plate_driven; // by the host: which plates made one wall follows from how they move
    std::vector<double> plate_vx, plate_vy, plate_omega;
};

template <class File, class Table> void exchange_lists(File &file, Table &t) {
    file.group("/lists");
    file.value("valid", t.valid);
    file.value("skin", t.skin);
    file.value("shifted", t.shifted);
    file.value("closed_in", t.closed_in);
    file.array("plate_x", t.plate_x);
    file.array("plate_y", t.plate_y);
    file.array("plate_driven", t.plate_driven);
    file.array("plate_angle", t.plate_angle);
    file.array("plate_vx", t.plate_vx);
    file.array("plate_vy", t.plate_vy);
    file.array("plate_omega", t.plate_omega);
}

// Where the particles were when the lists were made, in the order of these.
template <class X, class Body> void for_each_listed_array(X &x, X &y, const Body &body) {
    body("listed_x", x);
    body("listed_y", y);
}

// In the engine's own order. Those that are not in use have no values. Images across the ends of a period follow from these.
template <class P, class Body> void for_each_particle_array(P &p, const Body &body) {
    body("id", p.id);
    body("column", p.column);
    body("x", p.x);
    body("y", p.y);
    body("vx", p.vx);
    body("vy", p.vy);
    body("density", p.density);
    body("pressure", p.pressure);
    body("mean_pressure", p.mean_pressure);
    body("sxx", p.sxx);
    body("sxy", p.sxy);
    body("syy", p.syy);
    body("fluidity", p.fluidity);
    body("lxx", p.lxx);
    body("lxy", p.lxy);
    body("lyx", p.lyx);
    body("lyy", p.lyy);
    if (p.repose.in_use())
        Repose::for_each(p.repose, body);
}

// Of every plate: visit(name, number), number(plate) being a reference.
inline constexpr auto for_each_of_motion = [](const auto &visit) {
    visit(
        "driven", [](auto &p) -> auto & { return p.state().driven; });
    visit(
        "driven_since", [](auto &p) -> auto & { return p.state().driven_since; });
    visit(
        "driven_from_x", [](auto &p) -> auto & { return p.state().driven_from.shift.x(); });
    visit(
        "driven_from_y", [](auto &p) -> auto & { return p.state().driven_from.shift.y(); });
    visit(
        "driven_from_angle", [](auto &p) -> auto & { return p.state().driven_from.angle; });
    visit(
        "driven_vx", [](auto &p) -> auto & { return p.state().driven_motion.velocity.x(); });
    visit(
        "driven_vy", [](auto &p) -> auto & { return p.state().driven_motion.velocity.y(); });
    visit(
        "driven_omega", [](auto &p) -> auto & { return p.state().driven_motion.omega; });
    visit(
        "fallen", [](auto &p) -> auto & { return p.state().fallen; });
    visit(
        "fall_speed", [](auto &p) -> auto & { return p.state().fall_speed; });
    visit(
        "wrapped", [](auto &p) -> auto & { return p.state().wrapped; });
    visit(
        "x", [](auto &p) -> auto & { return p.state().placed.shift.x(); });
    visit(
        "y", [](auto &p) -> auto & { return p.state().placed.shift.y(); });
    visit(
        "angle", [](auto &p) -> auto & { return p.state().placed.angle; });
    visit(
        "vx", [](auto &p) -> auto & { return p.state().motion.velocity.x(); });
    visit(
        "vy", [](auto &p) -> auto & { return p.state().motion.velocity.y(); });
    visit(
        "omega", [](auto &p) -> auto & { return p.state().motion.omega; });
    visit(
        "fx", [](auto &p) -> auto & { return p.force.x(); });
    visit(
        "fy", [](auto &p) -> auto & { return p.force.y(); });
    visit("torque", &Plate::torque);
    visit("torque_pivot", &Plate::torque_pivot);
    visit(
        "impulse_x", [](auto &p) -> auto & { return p.impulse.x(); });
    visit(
        "impulse_y", [](auto &p) -> auto & { return p.impulse.y(); });
    visit("impulse_torque", &Plate::impulse_torque);
    visit("gap", &Plate::gap); // may be infinite
};

// Which ghosts there are follows from the lists, and where they are from their plates: as these were then, or are now. But in the
// schemes by number density ghosts go ahead of their plates, and stay so when these stop.
template <class File, class W> void exchange_ghosts(File &file, W &world) {
    file.group("/ghosts");
    file.value("placed", world.walls.ghosts_placed);
    if constexpr (File::reads)
        if (world.walls.ghosts_placed)
            world.walls.place_ghosts(world.threads);
    const auto size = static_cast<std::size_t>(by_number_density(world.constants.scheme) ? world.walls.ghost_count : 0);
    file.array("x", world.walls.ghost_x, size);
    file.array("y", world.walls.ghost_y, size);
}

struct PieceTable {
    std::vector<double> end;
    std::vector<int32_t> depth;
};

template <class File, class Table> void exchange_pieces(File &file, Table &t) {
    file.group("/pieces");
    file.array("end", t.end);
    file.array("depth", t.depth);
}

} // namespace gp::io
