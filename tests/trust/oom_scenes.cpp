#include "oom_scenes.hpp"

#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace test {

void fail(const char *format, ...) {
    memory::armed = false;
    std::va_list arguments;
    va_start(arguments, format);
    std::vfprintf(stderr, format, arguments);
    va_end(arguments);
    std::fprintf(stderr, "\n");
    std::exit(1);
}

void check(gp_status status, const char *call) {
    if (status < 0)
        fail("%s: %s: %s", call, gp_status_string(status), gp_last_error());
}

gp_config config_of(const std::string &scene) {
    gp_config c;
    CHECK(gp_config_init(&c, sizeof c,
                         scene == "paper"         ? GP_PRESET_PAPER
                         : scene == "paper_local" ? GP_PRESET_PAPER_LOCAL
                                                  : GP_PRESET_DEFAULT));
    c.threads = 1; // GNU OpenMP ends the process when it gets no memory for its threads
    c.jitter = 0.05;
    if (scene == "implicit") {
        c.stress = GP_STRESS_IMPLICIT;
        c.delta = 1e-2;
    } else if (scene == "periodic") {
        c.periodic_x_max = 10 * dl;
        c.gravity_x = 3;
    } else if (scene == "channel") {
        c.channel_width = 0.02;
        c.channel_friction = 0.3;
    } else if (scene == "retry") { // beyond the stable limit
        c.time_step = 2.5e-4;
        c.allow_unstable_step = 1;
        c.retry_halvings = 8;
    }
    return c;
}

gp_plate plate_of(double x0, double y0, double x1, double y1) {
    gp_plate p;
    CHECK(gp_plate_init(&p, sizeof p));
    p.x0 = x0;
    p.y0 = y0;
    p.x1 = x1;
    p.y1 = y1;
    return p;
}

std::vector<Piece> pieces_of(const std::string &scene) {
    const double right = 10 * dl, top = 6 * dl;
    std::vector<Piece> pieces;
    const auto plate = [&](const gp_plate &p) {
        pieces.emplace_back("gp_add_plate", [p](gp_sim *sim) { return gp_add_plate(sim, &p, nullptr); });
    };
    pieces.emplace_back("gp_add_material", [](gp_sim *sim) {
        gp_material m;
        gp_material_init(&m, sizeof m);
        m.grain_density = 2800;
        return gp_add_material(sim, &m, nullptr);
    });
    gp_column c;
    CHECK(gp_column_init(&c, sizeof c));
    c.width = right;
    c.height = top + 0.3 * dl; // with a note for the log, but for the period
    c.vx = 0.5;
    pieces.emplace_back("gp_add_column", [c](gp_sim *sim) { return gp_add_column(sim, &c, nullptr); });
    if (scene == "periodic") {
        plate(plate_of(right, 0, 0, 0));
        gp_plate lid = plate_of(0, top, right, top);
        lid.normal_pressure = 300;
        plate(lid);
        return pieces;
    }
    plate(plate_of(1, 0, -1, 0));
    gp_plate gate = plate_of(right, top, right, 0);
    static const double t[] = {0, 0.001, 0.1}, x[] = {0, 0, 0.001}, y[] = {0, 0.0005, 0.2};
    gate.n_knots = 3;
    gate.knot_t = t;
    gate.knot_x = x;
    gate.knot_y = y;
    gate.friction = GP_WALL_COULOMB;
    gate.wall_mu = 0.2;
    plate(gate);
    pieces.emplace_back("gp_add_particles", [=](gp_sim *sim) {
        const double px[] = {3 * dl, 4.2 * dl, 5.5 * dl}, py[] = {top + dl, top + 1.2 * dl, top + 1.1 * dl};
        const double v[] = {0, 0, 0}, vy[] = {-1, -2, -1};
        return gp_add_particles(sim, 1, 3, px, py, v, vy, nullptr);
    });
    return pieces;
}

void count_lines_of_log(gp_sim *sim) {
    static long lines = 0;
    const auto line = [](void *user, int32_t, const char *) { ++*static_cast<long *>(user); };
    CHECK(gp_set_log(sim, line, &lines));
}

gp_sim *make(const std::string &scene) {
    gp_sim *sim;
    const gp_config config = config_of(scene);
    CHECK(gp_create(&config, &sim));
    count_lines_of_log(sim);
    for (const auto &[name, add] : pieces_of(scene))
        CHECK(add(sim));
    return sim;
}

gp_state state_of(gp_sim *sim) {
    gp_state s{};
    s.struct_size = sizeof s;
    CHECK(gp_get_state(sim, &s));
    s.wall_seconds = 0;
    return s;
}

std::string bits_of(gp_sim *sim) {
    std::string bits;
    const auto add = [&](const void *data, std::size_t size) { bits.append(static_cast<const char *>(data), size); };
    gp_particles p{};
    p.struct_size = sizeof p;
    CHECK(gp_get_particles(sim, GP_FIELD_ALL, &p));
    const auto n = static_cast<std::size_t>(p.count);
    add(p.id, n * sizeof *p.id);
    add(p.column, n * sizeof *p.column);
    for (const double *field : {p.x, p.y, p.vx, p.vy, p.pressure, p.density, p.sxx, p.sxy, p.syy, p.shear_rate,
                                p.inertial_number, p.viscosity, p.number_density, p.fluidity})
        add(field, n * sizeof *field);
    const gp_state s = state_of(sim);
    add(&s, sizeof s);
    for (int32_t k = 0; k < 2; ++k) {
        gp_load load{};
        load.struct_size = sizeof load;
        CHECK(gp_get_plate_load(sim, k, &load));
        add(&load, sizeof load);
    }
    return bits;
}

void require_same(const std::string &found, const std::string &expected, const char *what) {
    if (found != expected)
        fail("%s: other bits", what);
}

} // namespace test
