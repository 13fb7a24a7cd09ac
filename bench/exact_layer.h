/* What the exact solutions have in common: the material, layers that are periodic in x, and the lines of a result. */
#ifndef GP_BENCH_EXACT_LAYER_H
#define GP_BENCH_EXACT_LAYER_H

#include <granperi/gp.h>

typedef struct options {
    int resolution;
    int columns;                           /* width of the periodic box in spacings */
    double horizon, cfl, mach, end, angle; /* 0: the case's own */
    double penalty, diffusion, viscosity;  /* negative: the scheme's own */
    int profile;
} options;

#define PI 3.14159265358979323846
#define GRAIN_DENSITY 2500.0 /* kg/m3 */
#define FRACTION 0.62
#define DENSITY 1550.0 /* kg/m3 */
#define GRAVITY 9.81   /* m/s2 */

typedef struct law {
    double mu_s, mu_2, i0, d;
} law;

typedef double (*profile)(double y, const void *data);

typedef struct layer {
    gp_sim *sim;
    int64_t count;
    int columns; /* particles in a row */
    double spacing, thickness, c0;
    int32_t bottom, top;
} layer;

typedef struct scene {
    law material;
    double rho_s, phi, thickness, gx, gy;
    double fastest; /* m/s, for the sound speed */
    profile u;      /* velocity to begin with; NULL: rest */
    const void *data;
    double load, lid_speed, floor_speed; /* a rough lid if load > 0 */
} scene;

#define CHECK(call) check((call), #call)
/* Ends the program where a call has failed. */
void check(gp_status status, const char *call);
/* Glass beads of diameter d (m). */
law beads(double d);
double friction(const law *l, double inertial);
double inverse_friction(const law *l, double mu);
/* The scene at o->resolution, in its exact state. */
layer make_layer(const options *o, const scene *s);
/* A copy of a field, to be freed. */
double *field(const layer *a, uint32_t bit);
gp_state state_of(gp_sim *sim);
/* Goes on to `to`; mean force on the floor between the two times, N/m: along it, and *fy. */
double mean_plate_force(layer *a, double *fy, double from, double to);
/* Lines of time, particles, steps, CPU seconds. */
void print_cost(gp_sim *sim);
/* Compares the mean velocity of each row of particles with the exact one at its mean height. */
void print_profile(const layer *a, const options *o, profile exact, const void *data, double scale);

#endif
