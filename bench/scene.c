/* Runs one collapse from the command line and records it: what docs/validation.md is made of.
 *
 * The scenes are those of Jin, Lu, Tai & Xu (2021), sections 4 to 6, with every choice of the scheme, the friction and the
 * set-up as an option. */
#include <math.h>
#include <stdio.h>

#include "../examples/c/example.h" /* CHECK, floor, gates */
#include "options.h"
#include "record.h"

typedef struct choices {
    double resolution, length, aspect, number, lift_time, diameter, volume_fraction, threads;
    double friction_factor, horizon, horizon_length, mu_s_degrees, mu_2_degrees, mu_s, mu_2, i0;
    double channel_width, channel_friction, cfl;
    const char *preset;
} choices;

enum { BOTH_SIDE, ONE_SIDE, COLLIDING, SCENES };
static const char *const scene_names[SCENES] = {"both_side", "one_side", "colliding"};
static const char *const preset_names[] = {"default", "paper", "local"};
static const int32_t presets[] = {GP_PRESET_DEFAULT, GP_PRESET_PAPER, GP_PRESET_PAPER_LOCAL};

static const char usage[] =
    "usage: scene both_side|one_side|colliding [options]\n\n"
    "both_side   a column, --length wide, --aspect halves of it high, collapses to both sides\n"
    "one_side    a column beside a smooth wall, --length wide, --aspect lengths high, collapses to the right\n"
    "colliding   two columns 0.04 m apart collide; --case 1: 0.156 and 0.054 m high, 0.08 m wide each;\n"
    "            --case 2: 0.152 m high, 0.04 and 0.08 m wide\n"
    "Prints lines of \"name value unit\".\n";

static gp_sim *create(const choices *c, double spacing) {
    const double degree = acos(-1.0) / 180;
    gp_config config;
    gp_material material;
    gp_sim *sim;
    CHECK(gp_config_init(&config, sizeof config, presets[bench_choice("--preset", c->preset, 3, preset_names)]));
    config.spacing = spacing;
    config.threads = (int32_t)c->threads;
    config.cfl = c->cfl;
    config.horizon_length = c->horizon_length;
    config.channel_width = c->channel_width;
    config.channel_friction = c->channel_friction;
    if (!isnan(c->horizon))
        config.horizon = c->horizon;
    if (!isnan(c->friction_factor))
        config.friction_factor = c->friction_factor;
    CHECK(gp_create(&config, &sim));
    CHECK(gp_set_log(sim, example_log, NULL));
    CHECK(gp_material_init(&material, sizeof material));
    material.grain_diameter = c->diameter;
    /* The density of the flow stays that of the glass beads: only the inertial number sees what is not fixed by it. */
    material.grain_density *= material.volume_fraction / c->volume_fraction;
    material.volume_fraction = c->volume_fraction;
    material.mu_s = isnan(c->mu_s) ? tan(c->mu_s_degrees * degree) : c->mu_s;
    material.mu_2 = isnan(c->mu_2) ? tan(c->mu_2_degrees * degree) : c->mu_2;
    material.i0 = c->i0;
    CHECK(gp_add_material(sim, &material, NULL));
    return sim;
}

static void add_column(gp_sim *sim, double x_min, double width, double height) {
    gp_column column;
    CHECK(gp_column_init(&column, sizeof column));
    column.x_min = x_min;
    column.y_min = 0;
    column.width = width;
    column.height = height;
    column.material = 1;
    CHECK(gp_add_column(sim, &column, NULL));
}

/* The library rounds columns to whole spacings; gates and feet have to follow. */
static double whole(double length, double spacing) {
    return spacing * fmax(1, round(length / spacing));
}

static void add_both_side(gp_sim *sim, const choices *c, recording *r) {
    const double half = whole(c->length, r->spacing) / 2, height = whole(c->aspect * c->length / 2, r->spacing);
    const double reach = half + 4 * height + 20 * r->spacing; /* run-outs reach some 2.5 heights */
    add_column(sim, -half, 2 * half, height);
    example_add_floor(sim, -reach, reach);
    example_add_gate(sim, -half, EXAMPLE_MATERIAL_RIGHT, height, r->spacing, c->lift_time);
    example_add_gate(sim, half, EXAMPLE_MATERIAL_LEFT, height, r->spacing, c->lift_time);
    r->extent = (extent){-half, half, half, 2};
}

static void add_one_side(gp_sim *sim, const choices *c, recording *r) {
    const double length = whole(c->length, r->spacing), height = whole(c->aspect * c->length, r->spacing);
    gp_plate wall;
    add_column(sim, 0, length, height);
    CHECK(gp_plate_init(&wall, sizeof wall)); /* material on the right of the way up */
    wall.y1 = height + 6 * r->spacing;
    wall.friction = GP_WALL_FREE_SLIP;
    CHECK(gp_add_plate(sim, &wall, NULL));
    example_add_floor(sim, 0, length + 4 * height + 20 * r->spacing);
    example_add_gate(sim, length, EXAMPLE_MATERIAL_LEFT, height, r->spacing, c->lift_time);
    r->extent = (extent){0, length, length, 1};
    r->axis = 2 * r->spacing; /* nearer, the wall takes the place of material in the smoothed volume fraction */
}

static void add_colliding(gp_sim *sim, const choices *c, recording *r) {
    const int second = c->number == 2;
    const double gap = 0.04, left_width = whole(second ? 0.04 : 0.08, r->spacing),
                 right_width = whole(0.08, r->spacing);
    const double left = whole(second ? 0.152 : 0.156, r->spacing), right = whole(second ? 0.152 : 0.054, r->spacing);
    const double reach = gap / 2 + right_width + 4 * fmax(left, right) + 20 * r->spacing;
    const double x_left = -gap / 2 - left_width, x_right = gap / 2 + right_width;
    add_column(sim, x_left, left_width, left);
    add_column(sim, gap / 2, right_width, right);
    example_add_floor(sim, -reach, reach);
    example_add_gate(sim, x_left, EXAMPLE_MATERIAL_RIGHT, left, r->spacing, c->lift_time);
    example_add_gate(sim, -gap / 2, EXAMPLE_MATERIAL_LEFT, left, r->spacing, c->lift_time);
    example_add_gate(sim, gap / 2, EXAMPLE_MATERIAL_RIGHT, right, r->spacing, c->lift_time);
    example_add_gate(sim, x_right, EXAMPLE_MATERIAL_LEFT, right, r->spacing, c->lift_time);
    r->columns = 2;
}

static void fill_defaults(choices *c, recording *r, int scene) {
    static const choices by_scene[SCENES] = {
        {.resolution = 32, .length = 0.08, .aspect = 1.25, .diameter = 0.002},
        {.resolution = 80, .length = 0.20, .aspect = 0.7, .diameter = 0.0007},
        {.resolution = 40, .length = 0.08, .diameter = 0.002},
    };
    *c = by_scene[scene];
    c->number = 1;
    c->lift_time = 0.1;
    c->volume_fraction = 0.62;
    c->threads = 1;
    c->friction_factor = c->horizon = c->mu_s = c->mu_2 = NAN;
    c->mu_s_degrees = 21;
    c->mu_2_degrees = 32;
    c->i0 = 0.3;
    c->preset = "default";
    *r = (recording){.prefix = "none", .end = 1, .interval = 0.01};
}

int main(int argc, char **argv) {
    choices c;
    recording r;
    const bench_option options[] = {
        {"--resolution", "spacings in the length (colliding: in 0.08 m) [32, 80, 40]", BENCH_WHOLE, &c.resolution, 1,
         1e5},
        {"--length", "m [both_side 0.08, one_side 0.20]", BENCH_NUMBER, &c.length, 1e-6, 1e6},
        {"--aspect", "height over half the width, or over the length (one_side) [1.25, 0.7]", BENCH_NUMBER, &c.aspect,
         0.01, 1000},
        {"--case", "1 or 2, of colliding [1]", BENCH_WHOLE, &c.number, 1, 2},
        {"--end", "s [1]", BENCH_NUMBER, &r.end, 1e-9, 1e6},
        {"--lift-time", "s in which a gate clears its column; 0: no gates [0.1]", BENCH_NUMBER, &c.lift_time, 0, 1e6},
        {"--preset", "default, paper (non-local) or local (paper's local model) [default]", BENCH_TEXT, &c.preset, 0,
         0},
        {"--friction-factor", "[the preset's]", BENCH_NUMBER, &c.friction_factor, 0, 10},
        {"--horizon", "spacings [the preset's]", BENCH_NUMBER, &c.horizon, 1.8, 8},
        {"--horizon-length", "m, in place of --horizon; 0: none [0]", BENCH_NUMBER, &c.horizon_length, 0, 1e6},
        {"--mu-s-degrees", "friction angle at rest [21]", BENCH_NUMBER, &c.mu_s_degrees, 0, 89},
        {"--mu-2-degrees", "friction angle of fast flow [32]", BENCH_NUMBER, &c.mu_2_degrees, 0, 89},
        {"--mu-s", "friction coefficient, in place of the angle", BENCH_NUMBER, &c.mu_s, 0, 100},
        {"--mu-2", "friction coefficient, in place of the angle", BENCH_NUMBER, &c.mu_2, 0, 100},
        {"--i0", "inertial number half way [0.3]", BENCH_NUMBER, &c.i0, 1e-9, 1e9},
        {"--diameter", "m, of the grains [0.002; one_side 0.0007]", BENCH_NUMBER, &c.diameter, 1e-9, 1e6},
        {"--volume-fraction", "phi, at the same density of the flow [0.62]", BENCH_NUMBER, &c.volume_fraction, 0.01, 1},
        {"--channel-width", "m between side walls; 0: none [0]", BENCH_NUMBER, &c.channel_width, 0, 1e6},
        {"--channel-friction", "Coulomb coefficient of the side walls [0]", BENCH_NUMBER, &c.channel_friction, 0, 100},
        {"--cfl", "0: the scheme's own [0]", BENCH_NUMBER, &c.cfl, 0, 2},
        {"--threads", "0: the OpenMP default [1]", BENCH_WHOLE, &c.threads, 0, 1024},
        {"--output", "prefix of the tables, or none [none]", BENCH_TEXT, &r.prefix, 0, 0},
        {"--interval", "s between rows of the series [0.01]", BENCH_NUMBER, &r.interval, 1e-6, 1e6},
        {"--times", "s, of profiles: t1,t2,... [none]", BENCH_LIST, &r.times, 0, 1e6},
        {"--velocity-section", "m, heights of horizontal sections: y1,y2,... [none]", BENCH_LIST, &r.sections, 0, 1e6},
    };
    const int n_options = (int)(sizeof options / sizeof options[0]);
    gp_sim *sim;
    int scene;

    example_program(argv[0]);
    fill_defaults(&c, &r, BOTH_SIDE);
    bench_parse(argc, argv, argc, usage, n_options, options); /* only for --help */
    if (argc < 2)
        bench_refuse("scene", NULL, "expected both_side, one_side or colliding first");
    scene = bench_choice("scene", argv[1], SCENES, scene_names);
    fill_defaults(&c, &r, scene);
    bench_parse(argc, argv, 2, usage, n_options, options);

    r.spacing = (scene == COLLIDING ? 0.08 : c.length) / c.resolution;
    sim = create(&c, r.spacing);
    if (scene == BOTH_SIDE)
        add_both_side(sim, &c, &r);
    else if (scene == ONE_SIDE)
        add_one_side(sim, &c, &r);
    else
        add_colliding(sim, &c, &r);
    record_run(sim, &r);
    gp_destroy(sim);
    return 0;
}
