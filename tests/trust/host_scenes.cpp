#include "host_scenes.hpp"

#include <vector>

namespace {

constexpr double dl = 0.0025;

void add_plate(gp_sim *sim, double x0, double y0, double x1, double y1, void (*set)(gp_plate &) = nullptr) {
    gp_plate p;
    CHECK(gp_plate_init(&p, sizeof p));
    p.x0 = x0;
    p.y0 = y0;
    p.x1 = x1;
    p.y1 = y1;
    if (set)
        set(p);
    CHECK(gp_add_plate(sim, &p, nullptr));
}

// Grains of two spacings, which flow as their neighbours do.
int32_t add_fluid(gp_sim *sim) {
    gp_material m;
    int32_t id;
    CHECK(gp_material_init(&m, sizeof m));
    m.grain_diameter = 2 * dl;
    m.nonlocal_amplitude = 0.48;
    CHECK(gp_add_material(sim, &m, &id));
    return id;
}

int32_t add_column(gp_sim *sim, double x, double y, int columns, int rows, double vx = 0, double vy = 0,
                   int32_t material = 0) {
    gp_column c;
    int32_t id;
    CHECK(gp_column_init(&c, sizeof c));
    c.x_min = x;
    c.y_min = y;
    c.width = columns * dl;
    c.height = rows * dl;
    c.vx = vx;
    c.vy = vy;
    c.material = material;
    CHECK(gp_add_column(sim, &c, &id));
    return id;
}

void add_line(gp_sim *sim, const std::vector<double> &x, const std::vector<double> &y, void (*set)(gp_plate &)) {
    gp_plate p;
    CHECK(gp_plate_init(&p, sizeof p));
    p.n_points = static_cast<int64_t>(x.size());
    p.point_x = x.data();
    p.point_y = y.data();
    set(p);
    CHECK(gp_add_plate(sim, &p, nullptr));
}

// Bodies that turn: a drum by a table of its angle, a vane by the host, a roll across the ends of the period; and hills, across
// them too, whose surface runs.
void add_turning(gp_sim *sim, int columns, int rows) {
    const double width = columns * dl, height = rows * dl, middle = 3 * width, top = 2 * height;
    static double knot_t[] = {0, 0.004, 0.02, 0.05}, knot_angle[] = {0, 0.01, 0.2, 0.4};
    add_line(sim,
             {middle - width, middle - width, middle - 0.5 * width, middle + 0.5 * width, middle + width,
              middle + width, middle - width},
             {0, top, 1.25 * top, 1.25 * top, top, 0, 0}, [](gp_plate &p) {
                 p.pivot_x = 0.5 * (p.point_x[0] + p.point_x[5]);
                 p.pivot_y = 0.5 * p.point_y[1];
                 p.n_knots = 4;
                 p.knot_t = knot_t;
                 p.knot_angle = knot_angle;
             });
    add_column(sim, middle - 0.5 * width, 0, columns, rows);
    add_plate(sim, middle - 0.5 * width - 2 * dl, dl, middle - 0.5 * width - 2 * dl, top - dl, [](gp_plate &p) {
        p.friction = GP_WALL_COULOMB;
        p.wall_mu = 0.2;
        p.pivot_x = p.x0;
        p.pivot_y = p.y1;
    });
    add_line(sim, {1.75 * width, 1.25 * width, 0.75 * width, 0.25 * width, -0.25 * width},
             {-height, -height - 4 * dl, -height, -height + 4 * dl, -height},
             [](gp_plate &p) { p.surface_velocity = -0.3; });
    add_column(sim, 0, -height + 5 * dl, columns, rows / 2);
    add_line(sim, {0.1 * width, 0, -0.1 * width, 0, 0.1 * width},
             {1.4 * height, 1.4 * height + 0.1 * width, 1.4 * height, 1.4 * height - 0.1 * width, 1.4 * height},
             [](gp_plate &p) {
                 p.pivot_y = p.point_y[0];
                 p.omega = -8;
             });
}

// Two beds in boxes, of which the thicker one falls asleep after the other, part by part. Plate 2 is a wall of the thin one.
void add_beds(gp_sim *sim, int columns) {
    const double width = columns * dl;
    double x = 0;
    add_plate(sim, 3 * width, 0, 0, 0);
    for (const int rows : {4, 12}) {
        add_plate(sim, x, 0, x, 0.04);
        add_plate(sim, x + width, 0.04, x + width, 0);
        add_column(sim, x, 0, columns, rows);
        x += 2 * width;
    }
}

} // namespace

int64_t steps_before(const std::string &scene) {
    return scene == "sleep" ? 515 : 0;
}

gp_sim *make(const SceneOptions &o) {
    const std::string &scene = o.scene;
    const bool paper = scene == "paper" || scene == "regularized" || scene == "paper_driven";
    gp_config c;
    CHECK(gp_config_init(&c, sizeof c,
                         paper                    ? GP_PRESET_PAPER
                         : scene == "paper_local" ? GP_PRESET_PAPER_LOCAL
                                                  : GP_PRESET_DEFAULT));
    c.threads = o.threads;
    c.jitter = 0.05;
    c.seed = 7;
    const int columns = 16 * o.size, rows = 12 * o.size;
    const double width = columns * dl, height = rows * dl;
    if (scene == "implicit") {
        c.stress = GP_STRESS_IMPLICIT;
        c.delta = 1e-3;
    }
    if (scene == "regularized")
        c.friction_factor = 1;
    if (scene == "channel") {
        c.channel_width = 0.02;
        c.channel_friction = 0.3;
    }
    if (scene == "periodic" || scene == "fluid_periodic") {
        c.periodic_x_max = width;
        c.gravity_x = 5;
    }
    const bool retry = scene == "retry" || scene == "fluid_retry";
    if (retry || scene == "diverge" || scene == "diverge_periodic") { // far beyond the stable limit
        c.time_step = retry ? 2.5e-4 : scene == "diverge" ? 4e-4 : 4e-3;
        c.allow_unstable_step = 1;
        c.retry_halvings = retry ? 6 : 0;
    }
    if (scene == "diverge_periodic")
        c.periodic_x_max = width;
    if (scene == "turning")
        c.periodic_x_max = 6 * width;
    if (scene == "sleep") {
        c.sleep = 1;
        c.sound_speed = 4;
    }
    gp_sim *sim;
    CHECK(gp_create(&c, &sim));
    gp_material heavy;
    int32_t material = 0;
    CHECK(gp_material_init(&heavy, sizeof heavy));
    heavy.grain_density = 2900;
    heavy.mu_s = 0.5;
    heavy.mu_2 = 0.7;
    CHECK(gp_add_material(sim, &heavy, &material));
    if (o.unused_material)
        CHECK(gp_add_material(sim, &heavy, nullptr));

    const int32_t main_material = scene.rfind("fluid", 0) == 0 ? add_fluid(sim) : 0;
    if (scene ==
        "turning") { // a drum about a heap, a vane that the host turns, a hilly belt, across whose ends it lies
        add_turning(sim, columns, rows);
    } else if (scene == "sleep") {
        add_beds(sim, 3 * columns);
    } else if (scene == "periodic" || scene == "fluid_periodic" || scene == "diverge_periodic") {
        add_plate(sim, width, 0, 0, 0, [](gp_plate &p) { p.fluidity = GP_FLUIDITY_ZERO; });
        add_column(sim, 0, 0, columns, rows, 0.1, 0, main_material);
        add_plate(sim, 0, height, width, height, [](gp_plate &p) {
            p.normal_pressure = 300;
            p.vx = 0.2;
        });
    } else {
        add_plate(sim, 1, 0, -1, 0);
        add_column(sim, 0, 0, columns, rows, 0, 0, main_material);
        if (scene == "loaded") {
            add_plate(sim, 0, 0, 0, height + 0.02);
            add_plate(sim, width, height + 0.02, width, 0);
            add_plate(sim, 0, height, width, height, [](gp_plate &p) {
                p.normal_pressure = 500;
                p.mass_per_length = 4;
            });
        } else { // a wall, and a gate that is lifted by a table: or by the host, in "driven"
            add_plate(sim, 0, 0, 0, height + 0.02);
            static double knot_t[] = {0, 0.004, 0.02, 0.05}, knot_x[] = {0, 0, 0.001, 0.001},
                          knot_y[] = {0, 0.002, 0.04, 0.2};
            add_plate(sim, width, height + 0.02, width, 0, [](gp_plate &p) {
                p.friction = GP_WALL_COULOMB;
                p.wall_mu = 0.2;
                p.n_knots = 4;
                p.knot_t = knot_t;
                p.knot_x = knot_x;
                p.knot_y = knot_y;
            });
            std::vector<double> x, y, vx, vy; // a set of particles that fall on it
            for (int k = 0; k < 6; ++k) {
                x.push_back(0.01 + 1.1 * dl * k);
                y.push_back(height + 4 * dl + 0.3 * dl * k);
                vx.push_back(0.1);
                vy.push_back(-1);
            }
            CHECK(gp_add_particles(sim, material, 6, x.data(), y.data(), vx.data(), vy.data(), nullptr));
            add_column(sim, 0.004, height + 8 * dl, 5, 4, 0, -1.5, material);
        }
    }
    if (scene == "driven" || scene == "paper_driven") // before the first step, by a velocity in place of its table
        CHECK(gp_set_plate_velocity(sim, 2, 0.0, 0.1));
    if (scene == "gravity") // so, too, in place of the config's
        CHECK(gp_set_gravity(sim, 1, -9.7));
    if (o.spare_plate)
        add_plate(sim, 0, -50, 0, -51);
    if (o.spare_body)
        add_column(sim, 40, 0, 3, 3);
    return sim;
}

void drive(gp_sim *sim, const std::string &scene, int64_t step) {
    if (scene == "turning" && step % 30 == 7)
        CHECK(gp_set_plate_motion(sim, 1, 0.05, 0, step < 30 ? 2 : step < 60 ? -3 : 0.5));
    if (scene == "sleep" && step == 20) // it wakes what rests beside it, and that, later on, the rest
        CHECK(gp_set_plate_velocity(sim, 2, -0.06, 0));
    if (scene == "gravity") {
        if (step % 15 == 5) // it turns
            CHECK(gp_set_gravity(sim, 0.05 * static_cast<double>(step), -9.5));
        if (step == 70) // and ends
            CHECK(gp_set_gravity(sim, 0, 0));
    }
    if (scene != "driven" && scene != "paper_driven")
        return;
    if (step == 9)
        CHECK(gp_set_plate_velocity(sim, 2, 0.05, 0.8));
    if (step == 31)
        CHECK(gp_set_plate_velocity(sim, 2, 0, 0));
    if (step == 57)
        CHECK(gp_set_plate_velocity(sim, 2, 0.3, 2));
}
