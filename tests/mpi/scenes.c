#include "scenes.h"

#include <math.h>
#include <stddef.h>

static void add_column(gp_sim *sim, double x, double y, double width, double height, int32_t material, double vx, double vy) {
    gp_column c;
    check(gp_column_init(&c, sizeof c), "gp_column_init");
    c.x_min = x, c.y_min = y, c.width = width, c.height = height, c.material = material, c.vx = vx, c.vy = vy;
    check(gp_add_column(sim, &c, NULL), "gp_add_column");
}

static gp_plate a_plate(double x0, double y0, double x1, double y1) {
    gp_plate p;
    check(gp_plate_init(&p, sizeof p), "gp_plate_init");
    p.x0 = x0, p.y0 = y0, p.x1 = x1, p.y1 = y1;
    return p;
}

static void add_plate(gp_sim *sim, const gp_plate *p) {
    check(gp_add_plate(sim, p, NULL), "gp_add_plate");
}

/* One that rubs does by 0.3. */
static void add_wall(gp_sim *sim, double x0, double y0, double x1, double y1, int32_t friction) {
    gp_plate p = a_plate(x0, y0, x1, y1);
    p.friction = friction;
    if (friction == GP_WALL_COULOMB)
        p.wall_mu = 0.3;
    add_plate(sim, &p);
}

static void floor_of(gp_sim *sim, double left, double right) { add_wall(sim, right, 0, left, 0, GP_WALL_NO_SLIP); }

static void add_line(gp_sim *sim, int n, const double *x, const double *y, double omega) {
    gp_plate p = a_plate(0, 0, 0, 0);
    p.n_points = n, p.point_x = x, p.point_y = y, p.omega = omega;
    add_plate(sim, &p);
}

static void fine(gp_config *c) { c->spacing = 0.0025; }
static void collapse(gp_sim *s) { add_column(s, -0.04, 0, 0.08, 0.05, 0, 0, 0), floor_of(s, -1, 1); }

static void incline(gp_config *c) {
    const double angle = 26 * acos(-1.0) / 180;
    c->spacing = 0.004;
    c->periodic_x_min = 0.01, c->periodic_x_max = 0.17;
    c->gravity_x = 9.81 * sin(angle), c->gravity_y = -9.81 * cos(angle);
    c->jitter = 0.2, c->seed = 3;
}
static void chute(gp_sim *s) { add_column(s, 0.01, 0, 0.16, 0.05, 0, 0.3, 0), floor_of(s, 0.01, 0.17); }

/* A loaded rough lid sheared over a layer between a smooth and a rubbing wall. */
static void box(gp_sim *s) {
    add_column(s, 0, 0, 0.08, 0.04, 0, 0, 0);
    floor_of(s, 0, 0.08);
    add_wall(s, 0, 0, 0, 0.08, GP_WALL_FREE_SLIP);
    add_wall(s, 0.08, 0.08, 0.08, 0, GP_WALL_COULOMB);
    gp_plate p = a_plate(-0.02, 0.04, 0.10, 0.04);
    p.vx = 0.2, p.normal_pressure = 500;
    add_plate(s, &p);
}

static void coarse(gp_config *c) { c->spacing = 0.004; }
/* A column between a wall and a gate, which is lifted: its height by the time. */
static void add_gated(gp_sim *s, double width, double height, int n, const double *t, const double *y) {
    static const double x[8];
    add_column(s, 0, 0, width, height, 0, 0, 0);
    floor_of(s, -1, 1);
    add_wall(s, 0, 0, 0, 0.2, GP_WALL_NO_SLIP);
    gp_plate p = a_plate(width, 0.2, width, 0);
    p.n_knots = n, p.knot_t = t, p.knot_x = x, p.knot_y = y;
    add_plate(s, &p);
}
static void lifted(gp_sim *s) {
    static const double t[] = {0, 0.01, 0.05}, y[] = {0, 0.004, 0.3};
    add_gated(s, 0.12, 0.08, 3, t, y);
}

/* A ring that turns, of 24 facets. */
static void drum(gp_sim *s) {
    enum { n = 24 };
    double x[n + 1], y[n + 1];
    for (int k = 0; k <= n; ++k) {
        x[k] = 0.08 * cos(-2 * acos(-1.0) * (k % n) / n);
        y[k] = 0.08 * sin(-2 * acos(-1.0) * (k % n) / n);
    }
    add_column(s, -0.05, -0.055, 0.1, 0.05, 0, 0, 0);
    add_line(s, n + 1, x, y, 2);
}

static void hopper(gp_sim *s) {
    const double xl[] = {-0.01, -0.05, -0.05}, yl[] = {0.0, 0.05, 0.2}, xr[] = {0.05, 0.05, 0.01}, yr[] = {0.2, 0.05, 0.0};
    add_column(s, -0.05, 0.06, 0.1, 0.08, 0, 0, -0.2);
    add_line(s, 3, xl, yl, 0);
    add_line(s, 3, xr, yr, 0);
    add_wall(s, 0.5, -0.1, -0.5, -0.1, GP_WALL_NO_SLIP);
}

static void two_materials(gp_sim *s) {
    gp_material m;
    check(gp_material_init(&m, sizeof m), "gp_material_init");
    m.grain_density = 4000, m.grain_diameter = 0.001;
    check(gp_add_material(s, &m, NULL), "gp_add_material");
    add_column(s, -0.08, 0, 0.08, 0.06, 0, 0, 0);
    add_column(s, 0, 0, 0.08, 0.08, 1, 0, 0);
    floor_of(s, -1, 1);
}

static void add_fluid_material(gp_sim *s) {
    gp_material m;
    check(gp_material_init(&m, sizeof m), "gp_material_init");
    m.nonlocal_amplitude = 0.48;
    check(gp_add_material(s, &m, NULL), "gp_add_material");
}
static void fluid(gp_sim *s) {
    add_fluid_material(s);
    add_column(s, -0.08, 0, 0.16, 0.06, 1, 0, 0);
    gp_plate p = a_plate(1, 0, -1, 0);
    p.fluidity = GP_FLUIDITY_ZERO;
    add_plate(s, &p);
}

static void channel(gp_config *c) { c->spacing = 0.004, c->channel_width = 0.05, c->channel_friction = 0.2; }

/* Grains that fly far away, and a thin layer: ranks thinner than what they see of each other. */
static void fragments(gp_sim *s) {
    const double x[] = {-0.3, 30, 31, 0.7, 0.7004}, y[] = {0.1, 40, 41, 0.01, 0.013}, vx[] = {1, 3, 3, 0, 0}, vy[] = {0, 1, 1, 0, 0};
    add_column(s, -0.04, 0, 0.08, 0.04, 0, 0, 0);
    check(gp_add_particles(s, 0, rank == 0 ? 5 : 0, x, y, vx, vy, NULL), "gp_add_particles");
    floor_of(s, -1, 1);
}

static void few(gp_config *c) { c->spacing = 0.01; }
static void handful(gp_sim *s) { add_column(s, -0.01, 0.01, 0.02, 0.03, 0, 0.1, -0.5), floor_of(s, -1, 1); }

/* Plates with material behind them, that hide it. */
static void wall_within(gp_sim *s) {
    add_column(s, -0.08, 0, 0.078, 0.08, 0, 0, 0);
    add_column(s, 0.002, 0, 0.08, 0.04, 0, 0, 0);
    floor_of(s, -1, 1);
    add_wall(s, 0, 0, 0, 0.2, GP_WALL_NO_SLIP);
    add_wall(s, 0, 0.2, 0, 0, GP_WALL_NO_SLIP);
}

static void blow(gp_config *c) { c->spacing = 0.004, c->sound_speed = 4, c->retry_halvings = 4, c->time_step = 0.0008, c->allow_unstable_step = 1; }
static void thrown(gp_sim *s) { add_column(s, -0.05, 0.004, 0.1, 0.05, 0, 0.5, -2.5), floor_of(s, -1, 1); }

static void thrown_hard(gp_sim *s) { add_column(s, -0.05, 0.004, 0.1, 0.05, 0, 0.5, -6), floor_of(s, -1, 1); }

/* The implicit scheme: its iterations go by sums over all. */
static void implicit(gp_config *c) { c->spacing = 0.004, c->stress = GP_STRESS_IMPLICIT; }
static void implicit_incline(gp_config *c) { incline(c), c->stress = GP_STRESS_IMPLICIT; }
static void implicit_few(gp_config *c) { few(c), c->stress = GP_STRESS_IMPLICIT; }

/* What rests sleeps (gp_config.sleep): a heap, all of it; a bed that a block wakes, a column that a gate lets go; over the ends of a
 * period; with fluidity. */
static void sleepy(gp_config *c) { coarse(c), c->sleep = 1; }
static void sleepy_soft(gp_config *c) { sleepy(c), c->sound_speed = 12; }
static void heap(gp_sim *s) { add_column(s, -0.06, 0, 0.12, 0.04, 0, 0, 0), floor_of(s, -1, 1); }
static void fluid_heap(gp_sim *s) {
    add_fluid_material(s);
    add_column(s, -0.06, 0, 0.12, 0.03, 1, 0, 0);
    floor_of(s, -1, 1);
}
static void bed(gp_sim *s) {
    add_column(s, 0, 0, 0.24, 0.04, 0, 0, 0);
    add_column(s, 0.1, 0.3, 0.032, 0.032, 0, 0, 0);
    floor_of(s, 0, 0.24);
    add_wall(s, 0, 0, 0, 1, GP_WALL_FREE_SLIP);
    add_wall(s, 0.24, 1, 0.24, 0, GP_WALL_NO_SLIP);
}
static void held(gp_sim *s) {
    static const double t[] = {0, 0.35, 0.36, 0.6}, y[] = {0, 0, 0.002, 0.3};
    add_gated(s, 0.16, 0.06, 4, t, y);
}
static void sleepy_ring(gp_config *c) {
    sleepy_soft(c);
    c->periodic_x_min = 0.01, c->periodic_x_max = 0.27;
    c->gravity_x = 0.3, c->jitter = 0.02, c->seed = 3;
}
static void ring(gp_sim *s) {
    add_column(s, 0.01, 0, 0.26, 0.04, 0, 0, 0);
    add_column(s, 0.1, 0.3, 0.032, 0.032, 0, 0.5, 0); /* comes down near the end */
    floor_of(s, 0.01, 0.27);
}

/* The example scenes that are not above, small. Their particles, where they have some of their own, are all the first rank's. */
static void add_lattice(gp_sim *s, double spacing, double left, double right, double bottom, double top, int (*inside)(double x, double y)) {
    enum { most = 2000 };
    double x[most], y[most];
    int64_t n = 0;
    for (double b = bottom + spacing / 2; b < top; b += spacing)
        for (double a = left + spacing / 2; a < right && n < most; a += spacing)
            if (inside(a, b))
                x[n] = a, y[n++] = b;
    check(gp_add_particles(s, 0, rank == 0 ? n : 0, x, y, NULL, NULL, NULL), "gp_add_particles");
}

/* An annular cell: the inner wall turns, the outer ones press. */
static void weightless(gp_config *c) { c->spacing = 0.005, c->gravity_y = 0; }
static int in_ring(double x, double y) { return x * x + y * y > 0.0525 * 0.0525 && x * x + y * y < 0.077 * 0.077; }
static void annular(gp_sim *s) {
    enum { corners = 32, outer = 16 };
    const double turn = 2 * acos(-1.0);
    double x[corners + 1], y[corners + 1];
    for (int k = 0; k <= corners; ++k)
        x[k] = 0.05 * cos(turn * (k % corners) / corners), y[k] = 0.05 * sin(turn * (k % corners) / corners);
    add_line(s, corners + 1, x, y, 10);
    for (int k = 0; k < outer; ++k) {
        const double from = -turn * k / outer, to = -turn * (k + 1) / outer;
        gp_plate p = a_plate(0.081 * cos(from), 0.081 * sin(from), 0.081 * cos(to), 0.081 * sin(to));
        p.normal_pressure = 1000;
        add_plate(s, &p);
    }
    add_lattice(s, 0.005, -0.08, 0.08, -0.08, 0.08, in_ring);
}

/* A heavy lid, pressed onto a period of grains and dragged over them. */
static void cell(gp_config *c) {
    c->spacing = 0.00625, c->gravity_y = -7.5, c->sound_speed = 25, c->horizon = 2;
    c->periodic_x_max = 20 * c->spacing;
}
static void couette(gp_sim *s) {
    add_column(s, 0, 0, 0.125, 0.075, 0, 0, 0);
    floor_of(s, 0, 0.125);
    gp_plate p = a_plate(0, 0.075, 0.125, 0.075);
    p.vx = 2.5, p.normal_pressure = 1600, p.mass_per_length = 1600 / 7.5;
    add_plate(s, &p);
}

/* Two columns behind two gates each, which are lifted: they meet in the gap. */
static void soft(gp_config *c) { coarse(c), c->sound_speed = 12; }
static void colliding(gp_sim *s) {
    static const double t[] = {0, 0.02, 0.1}, none[3], up[] = {0, 0.01, 0.2};
    const double at[] = {-0.052, -0.012, 0.012, 0.052};
    add_column(s, -0.052, 0, 0.04, 0.1, 0, 0, 0);
    add_column(s, 0.012, 0, 0.04, 0.06, 0, 0, 0);
    floor_of(s, -1, 1);
    for (int k = 0; k < 4; ++k) {
        gp_plate p = k % 2 ? a_plate(at[k], 0.15, at[k], 0) : a_plate(at[k], 0, at[k], 0.15);
        p.n_knots = 3, p.knot_t = t, p.knot_x = none, p.knot_y = up;
        add_plate(s, &p);
    }
}

/* What a host moves by the loads on it, after each step: one for each of the two simulations. */
typedef struct {
    int first, count; /* plates */
    double mass, velocity;
} body;
static body *new_body(void) {
    static body bodies[2];
    static int used;
    return &bodies[used++ % 2];
}
static gp_load load_on(gp_sim *s, const body *b) {
    gp_load sum = {.struct_size = sizeof sum}, one = sum;
    for (int k = 0; k < b->count; ++k) {
        check(gp_get_plate_load(s, b->first + k, &one), "gp_get_plate_load");
        sum.fx += one.fx, sum.fy += one.fy;
    }
    return sum;
}
static double last_step(gp_sim *s) {
    double time, dt;
    check(gp_get_clock(s, &time, &dt, NULL), "gp_get_clock");
    return dt;
}
static int32_t push(void *user, gp_sim *s) {
    body *b = user;
    const double dt = last_step(s);
    const gp_load load = load_on(s, b);
    const double limit = 0.3 * fmax(0, 9.81 * b->mass - load.fy) * dt, without = b->mass * b->velocity + load.fx * dt;
    b->velocity = (without + fmax(-limit, fmin(limit, -without))) / b->mass;
    for (int k = 0; k < b->count; ++k)
        check(gp_set_plate_velocity(s, b->first + k, b->velocity, 0), "gp_set_plate_velocity");
    return 0;
}
static void hit_block(gp_sim *s) {
    const double left = 0.1, right = 0.13, top = 0.03, x[] = {right, right, left, left}, y[] = {0, top, top, 0};
    add_column(s, 0, 0, 0.08, 0.1, 0, 1, 0);
    floor_of(s, -1, 1);
    add_wall(s, 0, 0, 0, 0.2, GP_WALL_NO_SLIP);
    for (int k = 0; k < 3; ++k)
        add_wall(s, x[k], y[k], x[k + 1], y[k + 1], GP_WALL_FREE_SLIP);
    body *b = new_body();
    *b = (body){2, 3, 1500 * 0.03 * 0.03, 0};
    check(gp_set_callback(s, 1, push, b), "gp_set_callback");
}
static int32_t pull(void *user, gp_sim *s) { /* a weight of 4 kg, over a pulley */
    body *b = user;
    const gp_load load = load_on(s, b);
    b->velocity = fmax(0, b->velocity + (3 * 9.81 + load.fy - 0.1 * fabs(load.fx)) / b->mass * last_step(s));
    check(gp_set_plate_velocity(s, b->first, 0, b->velocity), "gp_set_plate_velocity");
    return 0;
}
static void pulled_gate(gp_sim *s) {
    add_column(s, 0, 0, 0.08, 0.08, 0, 0, 0);
    floor_of(s, -1, 1);
    add_wall(s, 0, 0, 0, 0.1, GP_WALL_FREE_SLIP);
    add_wall(s, 0.08, 0.1, 0.08, 0, GP_WALL_COULOMB);
    body *b = new_body();
    *b = (body){2, 1, 5, 0};
    check(gp_set_callback(s, 1, pull, b), "gp_set_callback");
}

/* Debris on a hillside of 32 degrees with a step, that flows out on a plain; in metres. */
static void debris(gp_config *c) { c->spacing = 1; }
static const double hill_x[] = {0, 15, 32, 38, 45, 60, 120}, hill_y[] = {40, 30.6, 20, 18, 12, 4, 2};
static double hill_at(double x) {
    int k = 1;
    while (k < 6 && x > hill_x[k])
        ++k;
    return hill_y[k - 1] + (x - hill_x[k - 1]) * (hill_y[k] - hill_y[k - 1]) / (hill_x[k] - hill_x[k - 1]);
}
static int on_hill(double x, double y) {
    const double above = (y - hill_at(x)) * 0.85;
    return above > 0.49 && above < fmin(6, fmin(x - 4, 32 - x));
}
static void terrain(gp_sim *s) {
    double x[7], y[7];
    for (int k = 0; k < 7; ++k)
        x[k] = hill_x[6 - k], y[k] = hill_y[6 - k];
    add_line(s, 7, x, y, 0);
    add_lattice(s, 1, 4, 32, 18, 48, on_hill);
}

/* A heap that slides off a slope against a post, a closed line; a ring of grains is in its way. */
static int in_heap_or_ring(double x, double y) {
    const double heap = -x / 2 + 0.002, from_ring = hypot(x - 0.03, y - 0.04);
    return (x > -0.15 && x < -0.05 && y > heap && y < heap + 0.05) || (from_ring > 0.018 && from_ring < 0.038);
}
static void shapes(gp_sim *s) {
    const double ground_x[] = {0.6, 0, -0.6}, ground_y[] = {0, 0, 0.3};
    const double post_x[] = {0.08, 0.1, 0.1, 0.08, 0.08}, post_y[] = {0.0125, 0.0125, 0.08, 0.08, 0.0125};
    add_line(s, 3, ground_x, ground_y, 0);
    add_line(s, 5, post_x, post_y, 0);
    add_lattice(s, 0.004, -0.2, 0.08, 0, 0.15, in_heap_or_ring);
}

const scene scenes[] = {
    {"collapse", fine, collapse, 400, IMAGES},
    {"chute", incline, chute, 300, 0},
    {"box", coarse, box, 300, 0},
    {"lifted", coarse, lifted, 300, 0},
    {"drum", coarse, drum, 300, 0},
    {"hopper", coarse, hopper, 300, 0},
    {"two", coarse, two_materials, 300, TWO_COLUMNS | NEW_GRAVITY},
    {"fluid", coarse, fluid, 300, 0},
    {"channel", channel, collapse, 300, IMAGES},
    {"fragments", coarse, fragments, 300, 0},
    {"handful", few, handful, 300, 0},
    {"within", coarse, wall_within, 300, TWO_COLUMNS},
    {"thrown", blow, thrown, 200, 0},
    {"diverging", blow, thrown_hard, 200, 0},
    {"implicit", implicit, collapse, 60, IMAGES},
    {"implicit_chute", implicit_incline, chute, 20, 0},
    {"implicit_box", implicit, box, 6, 0},
    {"implicit_drum", implicit, drum, 40, 0},
    {"implicit_two", implicit, two_materials, 6, TWO_COLUMNS | NEW_GRAVITY},
    {"implicit_fragments", implicit, fragments, 40, 0},
    {"implicit_handful", implicit_few, handful, 60, 0},
    {"sleep", sleepy, heap, 1600, 0},
    {"sleep_bed", sleepy_soft, bed, 1500, 0},
    {"sleep_gate", sleepy, held, 1800, 0},
    {"sleep_ring", sleepy_ring, ring, 1500, 0},
    {"sleep_fluid", sleepy, fluid_heap, 1400, 0},
    {"annular", weightless, annular, 200, 0},
    {"couette", cell, couette, 200, 0},
    {"colliding", soft, colliding, 500, TWO_COLUMNS},
    {"hit_block", soft, hit_block, 200, 0},
    {"pulled_gate", soft, pulled_gate, 200, 0},
    {"terrain", debris, terrain, 300, 0},
    {"shapes", soft, shapes, 300, 0},
    {NULL, NULL, NULL, 0, 0},
};
