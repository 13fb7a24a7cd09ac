/* Exact solutions: runs one of them and prints its error and what it cost, as lines of "name value unit".
 *
 *     exact CASE [--resolution N] [--horizon K] [--cfl C] [--sound-speed M] [--end SECONDS] [--angle DEGREES]
 *              [--columns N]
 *
 * Resolution: particles over the thickness of the layer (hydrostatic: height of the column). --sound-speed is in largest
 * flow speeds. Every steady flow starts from its exact solution, so the error is what the scheme makes of it. */
#include "exact_cases.h"

#include <math.h>

#include "options.h"

static const char usage[] =
    "usage: exact CASE [options]\n\n"
    "cases: hydrostatic, shear_box, bagnold, bagnold_startup, chute, couette_cell, slope,\n       gradient\n";

static void bagnold_steady(const options *o) {
    bagnold(o, 0);
}

static void bagnold_startup(const options *o) {
    bagnold(o, 1);
}

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        void (*run)(const options *);
    } cases[] = {
        {"hydrostatic", hydrostatic},
        {"shear_box", shear_box},
        {"bagnold", bagnold_steady},
        {"chute", chute_flow},
        {"couette_cell", couette_cell},
        {"bagnold_startup", bagnold_startup},
        {"slope", slope},
        {"gradient", gradient},
    };
    options o = {20, 12, 0, 0, 0, 0, 0, -1, -1, -1, 0};
    double resolution = o.resolution, columns = o.columns, profile_rows = 0;
    const bench_option known[] = {
        {"--resolution", "particles over the height of the scene [20]", BENCH_WHOLE, &resolution, 4, 2000},
        {"--columns", "spacings in the periodic width of the layer [12]", BENCH_WHOLE, &columns, 12, 1000},
        {"--horizon", "spacings [the scheme's own]", BENCH_NUMBER, &o.horizon, -INFINITY, INFINITY},
        {"--cfl", "time step over spacing / wave speed [the scheme's own]", BENCH_NUMBER, &o.cfl, -INFINITY, INFINITY},
        {"--sound-speed", "over the largest flow speed; hydrostatic: m/s [10]", BENCH_NUMBER, &o.mach, -INFINITY,
         INFINITY},
        {"--end", "s, end of the run [depends on the case]", BENCH_NUMBER, &o.end, -INFINITY, INFINITY},
        {"--angle", "degrees, of the incline [bagnold 26, slope 20]", BENCH_NUMBER, &o.angle, -INFINITY, INFINITY},
        {"--penalty", "of the scheme [its own]", BENCH_NUMBER, &o.penalty, -INFINITY, INFINITY},
        {"--diffusion", "of the scheme [its own]", BENCH_NUMBER, &o.diffusion, -INFINITY, INFINITY},
        {"--viscosity", "bulk viscosity of the scheme [its own]", BENCH_NUMBER, &o.viscosity, -INFINITY, INFINITY},
        {"--profile", "1: rows of y, velocity, exact velocity [0]", BENCH_NUMBER, &profile_rows, -INFINITY, INFINITY},
    };
    int k;
    bench_parse(argc, argv, 2, usage, (int)(sizeof known / sizeof known[0]), known);
    k = bench_case(argc, argv, cases, sizeof cases[0], (int)(sizeof cases / sizeof cases[0]));
    o.resolution = (int)resolution;
    o.columns = (int)columns;
    o.profile = profile_rows != 0;
    cases[k].run(&o);
    return 0;
}
