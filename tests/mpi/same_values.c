/* Scenes on as many processes as MPI gives, beside the same scene on one: fields, clock, loads have to be equal.
 *
 *   mpirun -n N same_values [scene [threads]]   all scenes without one; prints what differs, and returns 1 if something does. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <granperi/gp_mpi.h>

static int rank, ranks, threads = 1, failures;

static void check(gp_status status, const char *what) {
    if (status < 0) {
        fprintf(stderr, "rank %d: %s: %s: %s\n", rank, what, gp_status_string(status), gp_last_error());
        MPI_Abort(MPI_COMM_WORLD, 2);
    }
}

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

typedef struct {
    const char *name;
    void (*config)(gp_config *);
    void (*build)(gp_sim *);
    int steps;
} scene;

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

static const scene scenes[] = {
    {"collapse", fine, collapse, 400}, {"chute", incline, chute, 300},        {"box", coarse, box, 300},
    {"lifted", coarse, lifted, 300},   {"drum", coarse, drum, 300},           {"hopper", coarse, hopper, 300},
    {"two", coarse, two_materials, 300}, {"fluid", coarse, fluid, 300},       {"channel", channel, collapse, 300},
    {"fragments", coarse, fragments, 300}, {"handful", few, handful, 300},    {"within", coarse, wall_within, 300},
    {"thrown", blow, thrown, 200},        {"diverging", blow, thrown_hard, 200},
    {"implicit", implicit, collapse, 60}, {"implicit_chute", implicit_incline, chute, 20}, {"implicit_box", implicit, box, 6},
    {"implicit_drum", implicit, drum, 40}, {"implicit_two", implicit, two_materials, 6}, {"implicit_fragments", implicit, fragments, 40},
    {"implicit_handful", implicit_few, handful, 60},
    {"sleep", sleepy, heap, 1600},        {"sleep_bed", sleepy_soft, bed, 1500}, {"sleep_gate", sleepy, held, 1800},
    {"sleep_ring", sleepy_ring, ring, 1500}, {"sleep_fluid", sleepy, fluid_heap, 1400},
    {"annular", weightless, annular, 200}, {"couette", cell, couette, 200},   {"colliding", soft, colliding, 500},
    {"hit_block", soft, hit_block, 200},  {"pulled_gate", soft, pulled_gate, 200}, {"terrain", debris, terrain, 300},
    {"shapes", soft, shapes, 300},
};

static gp_sim *make(const scene *s, int alone) {
    gp_config c;
    gp_sim *sim;
    check(gp_config_init(&c, sizeof c, GP_PRESET_DEFAULT), "gp_config_init");
    c.threads = alone ? 1 : threads;
    s->config(&c);
    if (alone)
        check(gp_create(&c, &sim), "gp_create");
    else
        check(gp_create_mpi(&c, MPI_COMM_WORLD, &sim), "gp_create_mpi");
    return sim;
}

static gp_state state_of(gp_sim *sim) {
    gp_state state;
    memset(&state, 0, sizeof state);
    state.struct_size = sizeof state;
    check(gp_get_state(sim, &state), "gp_get_state");
    return state;
}

static void differ(const scene *s, const char *what, double alone, double together) {
    if (failures++ < 20)
        printf("%s on %d: %s: %.17g alone, %.17g together\n", s->name, ranks, what, alone, together);
}

static void equal(const scene *s, const char *what, double a, double b) {
    if (a != b && !(isnan(a) && isnan(b)))
        differ(s, what, a, b);
}
static void close_to(const scene *s, const char *what, double a, double b, double scale) {
    if (!(fabs(a - b) <= 1e-9 * scale))
        differ(s, what, a, b);
}
#define EQUAL(name) equal(s, #name, (double)a.name, (double)b.name)
#define CLOSE(name) close_to(s, #name, a.name, b.name, scale) /* sums of many roundings */

static void compare_loads(const scene *s, gp_sim *alone, gp_sim *together) {
    for (int32_t plate = 0;; ++plate) {
        gp_load a, b;
        memset(&a, 0, sizeof a);
        a.struct_size = sizeof a;
        b = a;
        if (gp_get_plate_load(alone, plate, &a) < 0)
            break;
        check(gp_get_plate_load(together, plate, &b), "gp_get_plate_load");
        EQUAL(fx), EQUAL(fy), EQUAL(torque), EQUAL(dx), EQUAL(dy), EQUAL(impulse_x), EQUAL(impulse_y), EQUAL(torque_pivot);
        EQUAL(angle), EQUAL(impulse_torque);
    }
}

/* Surface, and interface of the first two columns, at some places of the whole. */
static void compare_shapes(const scene *s, gp_sim *alone, gp_sim *together, const gp_state *whole) {
    enum { n = 41 };
    double at[n], a[n], b[n];
    for (int k = 0; k < n; ++k)
        at[k] = whole->x_left + (whole->x_right - whole->x_left) * k / (n - 1);
    check(gp_get_surface(together, n, at, b), "gp_get_surface");
    if (rank == 0)
        check(gp_get_surface(alone, n, at, a), "gp_get_surface");
    for (int k = 0; k < n && rank == 0; ++k)
        equal(s, "surface", a[k], b[k]);
    if (s->build != two_materials && s->build != wall_within && s->build != colliding)
        return;
    for (int k = 0; k < n; ++k)
        at[k] = whole->peak_height * k / (n - 1);
    check(gp_get_interface(together, 0, 1, n, at, b), "gp_get_interface");
    if (rank == 0)
        check(gp_get_interface(alone, 0, 1, n, at, a), "gp_get_interface");
    for (int k = 0; k < n && rank == 0; ++k)
        equal(s, "interface", a[k], b[k]);
}

static void compare(const scene *s, gp_sim *alone, gp_sim *together) {
    static const uint32_t fields[] = {GP_FIELD_X,   GP_FIELD_Y,   GP_FIELD_VX,         GP_FIELD_VY,             GP_FIELD_PRESSURE,       GP_FIELD_DENSITY,
                                      GP_FIELD_SXX, GP_FIELD_SXY, GP_FIELD_SHEAR_RATE, GP_FIELD_NUMBER_DENSITY, GP_FIELD_FLUIDITY,       GP_FIELD_COLUMN};
    const gp_state b = state_of(together);
    const int64_t n = b.n_particles;
    double *theirs = malloc(sizeof(double) * (size_t)n), *ours = malloc(sizeof(double) * (size_t)n);
    for (size_t f = 0; f < sizeof fields / sizeof *fields; ++f) {
        check(gp_copy_field(together, fields[f], rank == 0 ? theirs : NULL, rank == 0 ? n : 0), "gp_copy_field");
        if (rank > 0)
            continue;
        check(gp_copy_field(alone, fields[f], ours, n), "gp_copy_field");
        for (int64_t k = 0; k < n; ++k)
            if (ours[k] != theirs[k]) {
                char what[64];
                snprintf(what, sizeof what, "step %lld, field 0x%x of %lld", (long long)b.step, (unsigned)fields[f], (long long)k);
                differ(s, what, ours[k], theirs[k]);
                break;
            }
    }
    free(theirs), free(ours);
    compare_shapes(s, alone, together, &b);
    if (rank > 0)
        return;
    const gp_state a = state_of(alone);
    const double scale = a.kinetic + a.potential + a.elastic + fabs(a.dissipated);
    EQUAL(time), EQUAL(step), EQUAL(dt), EQUAL(n_particles), EQUAL(n_awake), EQUAL(kinetic), EQUAL(potential), EQUAL(elastic);
    EQUAL(momentum_x), EQUAL(momentum_y), EQUAL(max_speed), EQUAL(rms_speed), EQUAL(x_left), EQUAL(x_right);
    EQUAL(peak_x), EQUAL(peak_height), EQUAL(max_pressure), EQUAL(at_rest), EQUAL(collisions), EQUAL(retries);
    EQUAL(max_compression), EQUAL(x_q05), EQUAL(x_q50), EQUAL(detached), EQUAL(volume_drift);
    EQUAL(implicit_newton), EQUAL(implicit_linear), EQUAL(implicit_last), EQUAL(implicit_failures), EQUAL(implicit_residual);
    CLOSE(dissipated), CLOSE(plate_work), CLOSE(wall_dissipated), CLOSE(bulk_dissipated), CLOSE(energy_error);
    compare_loads(s, alone, together);
}

static gp_plan_entry entry_of(gp_sim *sim, const char *name) {
    gp_plan_entry plan[128];
    int64_t n;
    check(gp_get_plan(sim, 128, plan, &n), "gp_get_plan");
    for (int64_t k = 0; k < n && k < 128; ++k)
        if (!strcmp(plan[k].name, name))
            return plan[k];
    fprintf(stderr, "the plan has no %s\n", name);
    MPI_Abort(MPI_COMM_WORLD, 2);
    return plan[0];
}

/* The plan knows of the particles that this process sees of others. */
static void check_images(const scene *s, gp_sim *together) {
    const gp_plan_entry images = entry_of(together, "images");
    if (rank == 0 && (!images.active || strcmp(images.reason, "other processes have particles, too")))
        differ(s, images.reason, 0, images.active);
    long long own = (long long)images.bytes, all = 0;
    MPI_Reduce(&own, &all, 1, MPI_LONG_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0 && ranks > 1 && s->build == collapse && all == 0) /* a handful may be all of one process */
        differ(s, "bytes of images", 0, 1);
}

static long run(const scene *s) {
    gp_sim *together = make(s, 0), *alone = NULL;
    /* gp_add_particles is each rank's own: all of them the first one's. */
    s->build(together);
    if (rank == 0) {
        alone = make(s, 1);
        s->build(alone);
    }
    for (int part = 0; part < 2; ++part) {
        const gp_status b = gp_step(together, s->steps / 2);
        if (rank == 0) {
            char text[1024];
            snprintf(text, sizeof text, "%s", gp_last_error());
            const gp_status a = gp_step(alone, s->steps / 2);
            if (a != b || (a < 0 && strcmp(gp_last_error(), text)))
                differ(s, text, a, b), puts(gp_last_error());
        }
        compare(s, alone, together);
        if (part == 0 && s->build == two_materials) { /* the second half under another gravity */
            check(gp_set_gravity(together, 1.5, -9.6), "gp_set_gravity");
            if (rank == 0)
                check(gp_set_gravity(alone, 1.5, -9.6), "gp_set_gravity");
        }
    }
    check_images(s, together);
    const long cuts = (long)entry_of(together, "cuts").calls; /* more than one where the work has become uneven */
    gp_destroy(together);
    gp_destroy(alone);
    return cuts;
}

int main(int argc, char **argv) {
    int provided;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (argc > 2)
        threads = atoi(argv[2]);
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; ++k)
        if (argc < 2 || !strcmp(argv[1], "all") || !strcmp(argv[1], scenes[k].name)) {
            const int before = failures;
            const long cuts = run(&scenes[k]);
            if (rank == 0 && failures == before)
                printf("%s on %d: equal, cut %ld times\n", scenes[k].name, ranks, cuts);
            fflush(stdout);
        }
    MPI_Bcast(&failures, 1, MPI_INT, 0, MPI_COMM_WORLD);
    MPI_Finalize();
    return failures > 0;
}
