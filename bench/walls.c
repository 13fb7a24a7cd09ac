/* Walls and inclines: runs one case and prints what came out and what it cost, as lines of "name value unit". */
#include "walls.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "options.h"

static const char usage[] =
    "usage: walls CASE [options]\n\n"
    "cases: slide_coulomb, slide_inertial, incline_start, incline_shear, incline_column, silo, hopper,\n"
    "       pieces, pieces_slope, bowl, drum, annular, tilt_layer, tilt_box, face\n";

gp_config walls_config(const choices *c, double spacing) {
    gp_config config;
    CHECK(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.spacing = spacing;
    config.threads = 1;
    config.jitter = c->jitter;
    if (!isnan(c->horizon))
        config.horizon = c->horizon;
    config.gravity_x = GRAVITY * sin(c->angle * DEGREE);
    config.gravity_y = -GRAVITY * cos(c->angle * DEGREE);
    return config;
}

void walls_add_beads(gp_sim *sim, double diameter, int constant) {
    gp_material material;
    CHECK(gp_material_init(&material, sizeof material));
    material.grain_diameter = diameter;
    if (constant)
        material.mu_2 = material.mu_s;
    CHECK(gp_add_material(sim, &material, NULL));
}

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        void (*run)(const choices *);
        double rows, angle, end; /* its own */
    } cases[] = {
        {"slide_coulomb", slide_coulomb, 10, 0, 0},
        {"slide_inertial", slide_inertial, 10, 0, 0.18},
        {"incline_start", incline_start, 20, 21.5, 5},
        {"incline_shear", incline_shear, 10, 26, 40},
        {"incline_column", incline_column, 28, 10, 3},
        {"silo", silo, 12, 0, 1.5},
        {"hopper", hopper, 10, 0, 0.8},
        {"pieces", pieces, 20, 0, 0.5},
        {"pieces_slope", pieces_slope, 20, 30, 0.15},
        {"bowl", bowl, 20, 0, 1},
        {"drum", drum, 16, 0, 0},
        {"annular", annular, 16, 0, 0.8},
        {"tilt_layer", tilt_layer, 10, 0, 0},
        {"tilt_box", tilt_box, 6, 0, 0},
        {"face", face, 16, 0, 1},
    };
    const int n = (int)(sizeof cases / sizeof cases[0]);
    static const char *const frictions[] = {"rough", "smooth", "coulomb"};
    static const int32_t walls[] = {GP_WALL_NO_SLIP, GP_WALL_FREE_SLIP, GP_WALL_COULOMB};
    choices c = {.rows = NAN,
                 .angle = NAN,
                 .horizon = NAN,
                 .end = NAN,
                 .filling = 5,
                 .segments = 24,
                 .froude = 1e-2,
                 .turns = 5};
    double coulomb = 0, beads = 0;
    const char *wall = "rough";
    const bench_option options[] = {
        {"--rows",
         "spacings in the layer, the height of the column, the width of the silo or of the column with faces, the "
         "outlet of a hopper, the radius of a bowl, a drum or the inner ring [depends on the case]",
         BENCH_WHOLE, &c.rows, 1, 1000},
        {"--angle", "degrees, of the incline [depends on the case]", BENCH_NUMBER, &c.angle, 0, 45},
        {"--jitter", "spacings [0]", BENCH_NUMBER, &c.jitter, 0, 0.3},
        {"--end", "s, end of the run [depends on the case]", BENCH_NUMBER, &c.end, 1e-3, 1e4},
        {"--horizon", "spacings [the library's]", BENCH_NUMBER, &c.horizon, 1.8, 8},
        {"--segments", "of a floor in pieces, a bowl or a drum [24]", BENCH_WHOLE, &c.segments, 1, WALLS_CORNERS - 1},
        {"--wall", "rough, smooth or coulomb (.3), of a floor in pieces [rough]", BENCH_TEXT, &wall, 0, 0},
        {"--froude", "omega^2 R / g, of the drum [0.01]", BENCH_NUMBER, &c.froude, 1e-6, 10},
        {"--turns", "of the drum [5]", BENCH_NUMBER, &c.turns, 0.5, 1000},
        {"--filling", "outlets, of a hopper [5]", BENCH_NUMBER, &c.filling, 2, 100},
        {"--beads", "1: glass beads in the hopper, not the published friction [0]", BENCH_WHOLE, &beads, 0, 1},
        {"--coulomb", "1: a floor with the Coulomb friction of the material, of layers that slide [0]", BENCH_WHOLE,
         &coulomb, 0, 1},
        {"--bed", "m, thickness of the layer under the column [0]", BENCH_NUMBER, &c.bed, 0, 1},
    };
    int k;
    example_program(argv[0]);
    bench_parse(argc, argv, 2, usage, (int)(sizeof options / sizeof options[0]), options);
    k = bench_case(argc, argv, cases, sizeof cases[0], n);
    c.rows = isnan(c.rows) ? cases[k].rows : c.rows;
    c.angle = isnan(c.angle) ? cases[k].angle : c.angle;
    c.end = isnan(c.end) ? cases[k].end : c.end;
    c.coulomb = coulomb != 0;
    c.beads = beads != 0;
    c.wall = walls[bench_choice("--wall", wall, 3, frictions)];
    cases[k].run(&c);
    return 0;
}
