#include "io/checkpoint_scene.hpp"

#include <cmath>
#include <iterator>

#include "io/checkpoint_items.hpp"
#include "io/checkpoint_parts.hpp"
#include "io/material_names.hpp"

namespace gp::io {

namespace {

void write_materials(CheckpointWriter &file, const Scene &scene) {
    file.group("/materials");
    write_items(file, scene.materials(), for_each_of_material);
}

void read_materials(CheckpointReader &file, const Checker &check, Sim &sim) {
    file.group("/materials");
    const std::vector<gp_material> materials = read_items(file, check, default_material(), for_each_of_material);
    check.require(!materials.empty(), "no material 0");
    for (std::size_t k = 1; k < materials.size(); ++k) // the first one is there
        sim.add_material(materials[k]);
}

void write_bodies(CheckpointWriter &file, const Scene &scene) {
    BodyTable bodies;
    std::size_t particles = 0; // of sets
    for (const Body &b : scene.bodies()) {
        bodies.material.push_back(b.material);
        bodies.is_column.push_back(b.rectangle);
        bodies.initial_pressure.push_back(b.hydrostatic ? GP_INITIAL_HYDROSTATIC : GP_INITIAL_NONE);
        bodies.count.push_back(b.count);
        bodies.x_min.push_back(b.x_min);
        bodies.y_min.push_back(b.y_min);
        bodies.width.push_back(b.width);
        bodies.height.push_back(b.height);
        bodies.column_vx.push_back(b.vx);
        bodies.column_vy.push_back(b.vy);
        particles += b.rectangle ? 0 : static_cast<std::size_t>(b.count);
    }
    exchange_bodies(file, bodies);
    for (std::size_t k = 0; k < std::size(set_arrays); ++k) {
        CheckpointWriter::Growing array = file.begin_array<double>(set_arrays[k], particles);
        for (const Body &b : scene.bodies())
            if (!b.rectangle)
                file.append(array, b.set[k].data(), b.set[k].size());
    }
}

void read_bodies(CheckpointReader &file, const Checker &check, Sim &sim) {
    BodyTable t;
    exchange_bodies(file, t);
    const std::size_t n = t.material.size(), particles = file.size_of<double>(set_arrays[0]);
    check.same_size("bodies", t.is_column, n);
    check.same_size("bodies", t.initial_pressure, n);
    check.same_size("bodies", t.count, n);
    for (const auto *array : {&t.x_min, &t.y_min, &t.width, &t.height, &t.column_vx, &t.column_vy})
        check.same_size("bodies", *array, n);
    for (const char *name : set_arrays)
        check.require(file.size_of<double>(name) == particles, "particles of bodies: arrays of other sizes");
    const double spacing = sim.scene().config().spacing;
    std::size_t first = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const double count = static_cast<double>(t.count[k]);
        if (t.is_column[k]) {
            check.require(std::round(t.width[k] / spacing) * std::round(t.height[k] / spacing) == count,
                          format_text("column %zu is not of %g particles", k, count));
            gp_column c = default_column();
            c.x_min = t.x_min[k];
            c.y_min = t.y_min[k];
            c.width = t.width[k];
            c.height = t.height[k];
            c.material = t.material[k];
            c.vx = t.column_vx[k];
            c.vy = t.column_vy[k];
            c.initial_pressure = t.initial_pressure[k];
            sim.add_column(c);
        } else {
            check.require(count > 0 && count <= static_cast<double>(particles - first),
                          format_text("set %zu of particles has %g of %zu", k, count, particles - first));
            const bool own = !sim.crossing() || sim.crossing()->rank() == 0; // each process adds its own
            const auto size = static_cast<std::size_t>(own ? t.count[k] : 0);
            std::vector<double> values[std::size(set_arrays)];
            for (std::size_t a = 0; a < std::size(values); ++a) {
                values[a].resize(size);
                file.some(set_arrays[a], first, size, values[a].data());
            }
            sim.add_particles(t.material[k], static_cast<int64_t>(size), values[0].data(), values[1].data(),
                              values[2].data(), values[3].data());
            first += static_cast<std::size_t>(t.count[k]);
        }
    }
    check.require(first == particles,
                  format_text("%zu of %zu particles belong to no body", particles - first, particles));
}

void write_plates(CheckpointWriter &file, const Scene &scene) {
    PlateTable plates;
    for (const PlateSpec &p : scene.plates()) {
        plates.n_points.push_back(p.points.size() > 2 ? static_cast<int64_t>(p.points.size()) : 0);
        for (const Vector &point : p.points) {
            plates.point_x.push_back(point.x());
            plates.point_y.push_back(point.y());
        }
        plates.friction.push_back(p.friction);
        plates.fluidity.push_back(p.fluidity);
        plates.wall_mu.push_back(p.wall_mu);
        plates.pivot_x.push_back(p.pivot.x());
        plates.pivot_y.push_back(p.pivot.y());
        plates.vx.push_back(p.motion.velocity.x());
        plates.vy.push_back(p.motion.velocity.y());
        plates.omega.push_back(p.motion.omega);
        plates.surface_velocity.push_back(p.surface_velocity);
        plates.start_x.push_back(p.start.x());
        plates.start_y.push_back(p.start.y());
        plates.start_angle.push_back(p.start_angle);
        plates.normal_pressure.push_back(p.load);
        plates.mass_per_length.push_back(p.mass);
        plates.n_knots.push_back(static_cast<int64_t>(p.table.t.size()));
        plates.knot_t.insert(plates.knot_t.end(), p.table.t.begin(), p.table.t.end());
        plates.knot_x.insert(plates.knot_x.end(), p.table.x.begin(), p.table.x.end());
        plates.knot_y.insert(plates.knot_y.end(), p.table.y.begin(), p.table.y.end());
        plates.n_knot_angles.push_back(static_cast<int64_t>(p.table.angle.size()));
        plates.knot_angle.insert(plates.knot_angle.end(), p.table.angle.begin(), p.table.angle.end());
    }
    exchange_plates(file, plates);
}

void read_plates(CheckpointReader &file, const Checker &check, Sim &sim) {
    PlateTable t;
    exchange_plates(file, t);
    const std::size_t n = t.friction.size(), points = t.point_x.size(), knots = t.knot_t.size(),
                      angles = t.knot_angle.size();
    for (const auto *array : {&t.wall_mu, &t.pivot_x, &t.pivot_y, &t.vx, &t.vy, &t.omega, &t.surface_velocity,
                              &t.start_x, &t.start_y, &t.start_angle, &t.normal_pressure, &t.mass_per_length})
        check.same_size("plates", *array, n);
    for (const auto *array : {&t.n_points, &t.n_knots, &t.n_knot_angles})
        check.same_size("plates", *array, n);
    check.same_size("plates", t.fluidity, n);
    check.same_size("points", t.point_y, points);
    check.same_size("knots", t.knot_x, knots);
    check.same_size("knots", t.knot_y, knots);
    std::size_t point = 0, knot = 0, angle = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const auto has = [&](const char *what, int64_t count, std::size_t left) {
            check.require(count >= 0 && static_cast<uint64_t>(count) <= left,
                          format_text("plate %zu has %lld %s of %zu", k, static_cast<long long>(count), what, left));
        };
        const int64_t ends = t.n_points[k] == 0 ? 2 : t.n_points[k];
        has("points", ends, points - point);
        has("knots", t.n_knots[k], knots - knot);
        has("angles", t.n_knot_angles[k], angles - angle);
        check.require(t.n_knot_angles[k] == 0 || t.n_knot_angles[k] == t.n_knots[k],
                      format_text("plate %zu has other numbers of angles and knots", k));
        gp_plate p = default_plate();
        if (t.n_points[k] == 0) {
            p.x0 = t.point_x[point];
            p.y0 = t.point_y[point];
            p.x1 = t.point_x[point + 1];
            p.y1 = t.point_y[point + 1];
        } else {
            p.n_points = t.n_points[k];
            p.point_x = t.point_x.data() + point;
            p.point_y = t.point_y.data() + point;
        }
        p.friction = t.friction[k];
        p.fluidity = t.fluidity[k];
        p.wall_mu = t.wall_mu[k];
        p.pivot_x = t.pivot_x[k];
        p.pivot_y = t.pivot_y[k];
        p.vx = t.vx[k];
        p.vy = t.vy[k];
        p.omega = t.omega[k];
        p.surface_velocity = t.surface_velocity[k];
        p.n_knots = t.n_knots[k];
        p.knot_t = t.knot_t.data() + knot;
        p.knot_x = t.knot_x.data() + knot;
        p.knot_y = t.knot_y.data() + knot;
        if (t.n_knot_angles[k] > 0)
            p.knot_angle = t.knot_angle.data() + angle;
        p.normal_pressure = t.normal_pressure[k];
        p.mass_per_length = t.mass_per_length[k];
        sim.add_plate(p);
        sim.set_plate_start(static_cast<int32_t>(k), {t.start_x[k], t.start_y[k]}, t.start_angle[k]);
        point += static_cast<std::size_t>(ends);
        knot += static_cast<std::size_t>(t.n_knots[k]);
        angle += static_cast<std::size_t>(t.n_knot_angles[k]);
    }
    check.require(point == points, "points that belong to no plate");
    check.require(knot == knots && angle == angles, "knots that belong to no plate");
}

} // namespace

void write_scene(CheckpointWriter &file, const Scene &scene) {
    file.group("/config");
    exchange_config(file, scene.config());
    write_materials(file, scene);
    write_bodies(file, scene);
    write_plates(file, scene);
}

Sim &read_scene(CheckpointReader &file, const Checker &check, const std::function<Sim &(const gp_config &)> &create) {
    gp_config config = default_config(GP_PRESET_DEFAULT);
    file.group("/config");
    exchange_config(file, config);
    Sim &sim = create(config);
    read_materials(file, check, sim);
    read_bodies(file, check, sim);
    read_plates(file, check, sim);
    return sim;
}

} // namespace gp::io
