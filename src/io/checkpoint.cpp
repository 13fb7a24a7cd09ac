#include "io/checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "check.hpp"
#ifdef GP_WITH_HDF5
#include "io/checkpoint_items.hpp"
#include "io/checkpoint_parts.hpp"
#include "io/checkpoint_rows.hpp"
#include "io/checkpoint_scene.hpp"
#include "io/checkpoint_sleep.hpp"
#include "parts.hpp"
#include "stages/stages.hpp"
#include "stretches.hpp"
#endif

namespace gp::io {

#ifndef GP_WITH_HDF5

void save_checkpoint(const std::string &, const Sim &, const World *, const OutputPosition &) {
    throw make_error(GP_E_UNSUPPORTED, "gp_save: this build has no HDF5");
}

void load_checkpoint(const std::string &, Crossing *, const std::function<Sim &(const gp_config &)> &,
                     OutputPosition &) {
    throw make_error(GP_E_UNSUPPORTED, "gp_load: this build has no HDF5");
}

#else

namespace {

// ------------------------------------------------------------------------------------------------------- saving

// All of a world but the particles, and what is of each of them.
void write_common(CheckpointWriter &file, const World &world) {
    exchange_clock_and_sums(file, world);
    ListTable lists;
    lists.valid = world.lists_valid;
    lists.skin = world.skin;
    lists.shifted = world.shifted;
    lists.closed_in = world.closed_in;
    for (const Plate::State &state : world.list_origin.plates) {
        lists.plate_x.push_back(state.placed.shift.x());
        lists.plate_y.push_back(state.placed.shift.y());
        lists.plate_angle.push_back(state.placed.angle);
        lists.plate_driven.push_back(state.driven);
        lists.plate_vx.push_back(state.driven_motion.velocity.x());
        lists.plate_vy.push_back(state.driven_motion.velocity.y());
        lists.plate_omega.push_back(state.driven_motion.omega);
    }
    exchange_lists(file, lists);

    file.group("/plate_motions");
    write_items(file, world.walls.plates, for_each_of_motion);
    exchange_ghosts(file, world);
    PieceTable pieces;
    for (const Piece &piece : world.pieces) {
        pieces.end.push_back(piece.end);
        pieces.depth.push_back(piece.depth);
    }
    exchange_pieces(file, pieces);
}

// A file that is being written, by the first process.
class Saving {
public:
    // world: NULL before the first step; all: particles of all processes.
    Saving(const std::string &path, const Sim &sim, const World *world, int64_t all, const OutputPosition &position)
        : file_(path) {
        const Progress progress = sim.progress();
        write_scene(file_, sim.scene());
        exchange_progress(file_, progress);
        const PositionTable at{position, {position.path.begin(), position.path.end()}};
        exchange_position(file_, at);
        if (!world)
            return;
        write_common(file_, *world);
        file_.group("/particles");
        if (world->crossing)
            rows_ = std::make_unique<RowWriter>(file_, *world, all);
    }
    void write_particles(const World &world) {
        for_each_listed_array(world.list_origin.x, world.list_origin.y,
                              [&](const char *name, const auto &values) { file_.array(name, values); });
        file_.array("listed", world.listed);
        for_each_particle_array(world.particles, [&](const char *name, const auto &field) {
            file_.array(name, field, field.empty() ? 0 : static_cast<std::size_t>(world.particles.count));
        });
    }
    // All particles have been written.
    void write_loads_of_sleep(const std::vector<MeanLoad> &loads) {
        rows_.reset();
        write_loads(file_, loads);
    }
    void append(const std::vector<const double *> &rows) { rows_->append(rows); }
    void put_into_place() {
        rows_.reset();
        file_.put_into_place();
    }

private:
    Session session_;
    CheckpointWriter file_;
    std::unique_ptr<RowWriter> rows_;
};

// ------------------------------------------------------------------------------------------------------ loading

// Steps and the like that no run comes to, and that can still be counted on from.
constexpr int64_t most_counted = int64_t{1} << 62;

void read_clock_and_sums(CheckpointReader &file, const Checker &check, World &w) {
    exchange_clock_and_sums(file, w);
    const Clock &c = w.clock;
    check.finite("time", c.time);
    check.not_negative("dt", c.dt);
    check.not_negative("time_left", c.time_left);
    check.require(c.reason >= GP_DT_NONE && c.reason <= GP_DT_RETRY, "no such reason of a time step");
    const Ledger &l = w.ledger;
    for (const double value : {l.initial, l.reference_height, l.dissipated, l.penalty, l.walls, l.diffusion, l.spacing,
                               l.bulk, l.collisions, l.side_walls, l.plate_work, l.scale, l.largest_kinetic, l.level})
        check.finite("ledger", value);
    for (const int64_t number : {c.step, w.collisions, w.retries, w.viscous.newton, w.viscous.linear,
                                 w.viscous.failures, static_cast<int64_t>(w.viscous.last)})
        check.require(number >= 0 && number < most_counted, "a count out of bounds");
    for (const double value : {w.max_compression, w.plastic_power, w.unbalanced_share})
        check.finite("sums", value);
    check.finite("packing_at_start", w.packing_at_start);
    check.require(w.packing_at_start > 0, "packing_at_start: not above 0");
    check.not_negative("velocity_span", w.velocity_span);
    check.not_negative("fastest", w.fastest);
    check.finite("gravity/x", w.constants.gravity.x());
    check.finite("gravity/y", w.constants.gravity.y());
    check.not_negative("gravity/fall_height", w.constants.fall_height);
    check.not_negative("gravity/flow_speed", w.constants.flow_speed);
}

// Plates as they were when the lists were made. Afterwards they and the particles are to be set.
ListTable read_lists(CheckpointReader &file, const Checker &check, World &w) {
    ListTable t;
    exchange_lists(file, t);
    const double spacing = w.constants.spacing;
    const std::size_t plates = w.walls.plates.size();
    check.require(t.skin > 0 && t.skin <= spacing, format_text("skin: %g m", t.skin));
    check.not_negative("shifted", t.shifted);
    check.not_negative("closed_in", t.closed_in);
    check.same_size("lists/plate_driven", t.plate_driven, plates);
    for (const auto *array : {&t.plate_x, &t.plate_y, &t.plate_angle, &t.plate_vx, &t.plate_vy, &t.plate_omega}) {
        check.same_size("lists/plate_...", *array, plates);
        check.all_finite("lists/plate_...", *array);
    }
    for (const auto *array : {&t.plate_x, &t.plate_y})
        for (const double value : *array)
            check.require(std::abs(value) <= farthest_of_lists * spacing, format_text("lists: a plate at %g m", value));
    for (std::size_t k = 0; k < plates; ++k) {
        Plate::State state;
        state.placed = {{t.plate_x[k], t.plate_y[k]}, t.plate_angle[k]};
        state.driven = t.plate_driven[k] != 0;
        state.driven_motion = {{t.plate_vx[k], t.plate_vy[k]}, t.plate_omega[k]};
        w.walls.plates[k].state() = state;
    }
    w.walls.place_facets();
    w.skin = t.skin;
    return t;
}

// Of a process alone: the lists as they were made, of where the particles were then, and these.
void read_particles(CheckpointReader &file, const Checker &check, const Scene &scene, World &w) {
    Particles &p = w.particles;
    const std::size_t n = static_cast<std::size_t>(p.count);
    Field<int64_t> id(n);
    Field<int32_t> column(n), listed;
    file.array("id", id, n);
    file.array("column", column, n);
    file.array("listed", listed);
    check.permutation("id", id);
    for (std::size_t k = 0; k < n; ++k)
        check.require_each(column[k] == scene.body_of(id[k]),
                           [] { return std::string("a particle is of another column"); });
    if (!listed.empty()) {
        check.same_size("listed", listed, n);
        check.permutation("listed", listed);
    }
    // Particles of one cell are listed in the order of their ids, and images have the columns of their sources.
    for (std::size_t place = 0; place < n; ++place) {
        const std::size_t k = listed.empty() ? place : static_cast<std::size_t>(listed[place]);
        p.id[place] = id[k];
        p.column[place] = column[k];
    }
    for_each_listed_array(p.x, p.y, [&](const char *name, Field<double> &field) { file.array(name, field, n); });
    check_list_positions(check, w, p.count);
    stages::make_lists(w);
    for (std::size_t k = 0; k < n; ++k)
        check.require_each(w.grid.order()[k] == static_cast<int32_t>(k),
                           [] { return std::string("lists: the particles are not in their order"); });
    w.listed = std::move(listed);
    std::copy(id.begin(), id.end(), p.id.begin());
    std::copy(column.begin(), column.end(), p.column.begin());
    for_each_particle_array(p, [&](const char *name, auto &field) {
        if constexpr (std::is_same_v<std::decay_t<decltype(field)>, Field<double>>) {
            const std::size_t size = field.empty() ? 0 : n;
            file.array(name, field, size);
            check_numbers(check, w, name, p.column.data(), field.data(), size);
        }
    });
}

void read_motions(CheckpointReader &file, const Checker &check, World &w) {
    file.group("/plate_motions");
    read_items(file, check, w.walls.plates, for_each_of_motion);
    for_each_of_motion([&](const char *name, const auto &number) {
        for (const Plate &plate : w.walls.plates)
            if (const double value = std::invoke(number, plate); std::strcmp(name, "gap") != 0)
                check.finite(name, value);
            else
                check.require(!std::isnan(value), "gap: not a number");
    });
    w.walls.place_facets();
}

void read_pieces(CheckpointReader &file, const Checker &check, World &w) {
    PieceTable t;
    exchange_pieces(file, t);
    check.same_size("pieces", t.depth, t.end.size());
    check.all_finite("pieces", t.end);
    const int32_t most = w.scene->config().retry_halvings;
    for (std::size_t k = 0; k < t.end.size(); ++k) {
        check.require(t.depth[k] >= 1 && t.depth[k] <= most, "a piece of a step halved too often");
        w.pieces.push_back({t.end[k], t.depth[k]});
    }
}

// Of several processes the part of each.
std::unique_ptr<World> read_world(CheckpointReader &file, const Checker &check, const Sim &sim) {
    const Scene &scene = sim.scene();
    // As many as there are to be: before there is memory for them.
    file.group("/particles");
    const std::size_t particles = file.size_of<int64_t>("id");
    check.require(particles == static_cast<std::size_t>(scene.particle_count()),
                  format_text("particles/id: %zu values, expected %lld", particles,
                              static_cast<long long>(scene.particle_count())));
    std::unique_ptr<World> world;
    if (sim.crossing())
        world = make_part(scene, *sim.crossing());
    else
        world = make_bare_world(scene, scene.constants(), scene.particle_count());
    read_clock_and_sums(file, check, *world);
    const ListTable lists = read_lists(file, check, *world);
    file.group("/particles");
    if (world->crossing)
        read_rows(file, check, *world);
    else
        read_particles(file, check, scene, *world);
    read_motions(file, check, *world);
    exchange_ghosts(file, *world);
    for (const auto *field : {&world->walls.ghost_x, &world->walls.ghost_y})
        check.all_finite("ghosts", *field);
    if (world->images.in_use()) {
        world->images.copy_all(world->particles);
        if (!world->particles.syy.empty())
            world->images.copy(world->particles.syy);
    }
    read_pieces(file, check, *world);
    if (world->sleep.in_use)
        read_sleep(file, check, *world);
    world->lists_valid = lists.valid;
    world->lists_new = false;
    world->shifted = lists.shifted;
    world->closed_in = lists.closed_in;
    return world;
}

OutputPosition read_position(CheckpointReader &file, const Checker &check) {
    PositionTable t;
    exchange_position(file, t);
    check.not_negative("output/every_seconds", t.at.every_seconds);
    for (const int64_t number : {t.at.next, t.at.frames, t.at.step})
        check.require(number >= 0, "output: a count below 0");
    check.require(t.path.size() < 1 << 16, "output: a path of more than 65535 bytes");
    t.at.path.assign(t.path.begin(), t.path.end());
    return t.at;
}

struct Loaded {
    Sim *sim = nullptr;
    std::unique_ptr<World> world;
    Progress progress;
};

Loaded read_all(CheckpointReader &file, const std::function<Sim &(const gp_config &)> &create,
                OutputPosition &position) {
    const Checker check(file);
    Sim &sim = read_scene(file, check, create);
    Progress progress;
    exchange_progress(file, progress);
    check.require((progress.told & ~Warnings::all_kinds) == 0, "warnings of an unknown kind");
    check.not_negative("wall_seconds", progress.wall_seconds);
    position = read_position(file, check);
    Loaded loaded{&sim, nullptr, progress};
    if (progress.started)
        loaded.world = read_world(file, check, sim);
    return loaded;
}

} // namespace

void save_checkpoint(const std::string &path, const Sim &sim, const World *world, const OutputPosition &position) {
    if (!sim.crossing()) {
        Saving saving(path, sim, world, 0, position);
        if (world)
            saving.write_particles(*world);
        if (world && world->sleep.in_use)
            saving.write_loads_of_sleep(loads_of_all(*world));
        saving.put_into_place();
        return;
    }
    const int64_t all = world ? count_of_all(*world) : 0;
    OnFirst first(*sim.crossing());
    std::unique_ptr<Saving> saving;
    first.run([&] { saving = std::make_unique<Saving>(path, sim, world, all, position); });
    if (world)
        for_each_row(*world, [&](const auto &rows) { first.run([&] { saving->append(rows); }); });
    if (world && world->sleep.in_use) {
        const std::vector<MeanLoad> loads = loads_of_all(*world);
        first.run([&] { saving->write_loads_of_sleep(loads); });
    }
    first.run([&] { saving->put_into_place(); });
    first.finish();
}

namespace {

// The first of several processes reads all of the file for its checksum; the others make sure that theirs is the same.
void require_whole(const CheckpointReader &file, Crossing *crossing) {
    on_first(crossing, [&] { file.require_whole(); });
    if (!crossing)
        return;
    std::string text = file.text();
    tell_all_of(*crossing, text);
    if (text != file.text())
        file.refuse("it is another one than that of the first process");
}

} // namespace

void load_checkpoint(const std::string &path, Crossing *crossing, const std::function<Sim &(const gp_config &)> &create,
                     OutputPosition &position) {
    Session session;
    CheckpointReader file(path);
    require_whole(file, crossing);
    file.open();
    Loaded loaded;
    try {
        loaded = read_all(file, create, position);
    } catch (const Error &error) {
        // What a host would be told about an argument is here about the file.
        if (error.status() == GP_E_ARGUMENT || error.status() == GP_E_STATE || error.status() == GP_E_DIVERGED)
            file.refuse(error.what());
        throw;
    }
    loaded.sim->resume(std::move(loaded.world), loaded.progress);
}

#endif

} // namespace gp::io
