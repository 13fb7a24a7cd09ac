/* Exact solutions: runs one of them and prints its error and what it cost, as lines of "name value unit".
 *
 *     exact CASE [--resolution N] [--horizon K] [--cfl C] [--sound-speed M] [--end SECONDS] [--angle DEGREES]
 *              [--columns N]
 *
 * Resolution: particles over the thickness of the layer (hydrostatic: height of the column). --sound-speed is in largest
 * flow speeds. Every steady flow starts from its exact solution, so the error is what the scheme makes of it. */
#include "exact_cases.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void usage(FILE *out) {
    fprintf(out,
            "usage: exact CASE [options]\n\n"
            "cases: hydrostatic, shear_box, bagnold, bagnold_startup, chute, couette_cell, slope,\n       gradient\n\n"
            "options [default]\n"
            "  --resolution N    particles over the height of the scene [20]\n"
            "  --columns N       spacings in the periodic width of the layer [12]\n"
            "  --horizon K       in spacings [the scheme's own]\n"
            "  --cfl C           time step over spacing / wave speed [the scheme's own]\n"
            "  --sound-speed M   over the largest flow speed; hydrostatic: m/s [10]\n"
            "  --end SECONDS     end of the run [depends on the case]\n"
            "  --angle DEGREES   of the incline [bagnold 26, slope 20]\n"
            "  --penalty, --diffusion, --viscosity X\n"
            "                    of the scheme [its own]\n"
            "  --profile 1       prints rows of y, velocity, exact velocity [0]\n");
}

/* Ends the program unless value is within its bounds. */
static int whole(const char *name, double value, int least, int most) {
    if (!(value >= least && value <= most)) {
        fprintf(stderr, "exact: %s %g: expected a whole number from %d to %d\n", name, value, least, most);
        exit(2);
    }
    return (int)value;
}

int main(int argc, char **argv) {
    options o = {20, 12, 0, 0, 0, 0, 0, -1, -1, -1, 0};
    double resolution = 20, columns = 12, profile_rows = 0;
    const struct {
        const char *name;
        double *value;
    } known[] = {{"--resolution", &resolution},
                 {"--columns", &columns},
                 {"--horizon", &o.horizon},
                 {"--cfl", &o.cfl},
                 {"--sound-speed", &o.mach},
                 {"--end", &o.end},
                 {"--angle", &o.angle},
                 {"--penalty", &o.penalty},
                 {"--diffusion", &o.diffusion},
                 {"--viscosity", &o.viscosity},
                 {"--profile", &profile_rows}};
    int k;
    size_t n;
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        usage(stdout);
        return 0;
    }
    for (k = 2; k < argc; k += 2) {
        char *rest = NULL;
        for (n = 0; n < sizeof known / sizeof known[0]; ++n)
            if (k + 1 < argc && strcmp(argv[k], known[n].name) == 0)
                *known[n].value = strtod(argv[k + 1], &rest);
        if (!rest || rest == argv[k + 1] || *rest) {
            fprintf(stderr, "exact: %s: unknown option, or no number after it (see --help)\n", argv[k]);
            return 2;
        }
    }
    o.resolution = whole("--resolution", resolution, 4, 2000);
    o.columns = whole("--columns", columns, 12, 1000);
    o.profile = profile_rows != 0;
    if (argc < 2) {
        usage(stderr);
        return 2;
    }
    if (strcmp(argv[1], "hydrostatic") == 0)
        hydrostatic(&o);
    else if (strcmp(argv[1], "shear_box") == 0)
        shear_box(&o);
    else if (strcmp(argv[1], "bagnold") == 0)
        bagnold(&o, 0);
    else if (strcmp(argv[1], "bagnold_startup") == 0)
        bagnold(&o, 1);
    else if (strcmp(argv[1], "chute") == 0)
        chute_flow(&o);
    else if (strcmp(argv[1], "couette_cell") == 0)
        couette_cell(&o);
    else if (strcmp(argv[1], "slope") == 0)
        slope(&o);
    else if (strcmp(argv[1], "gradient") == 0)
        gradient(&o);
    else {
        fprintf(stderr, "exact: %s: unknown case (see --help)\n", argv[1]);
        return 2;
    }
    return 0;
}
