/* The granular fluidity in one dimension: a layer in steady shear below a lid, by finite volumes. What cells are compared with,
 * where there is no closed formula. */
#ifndef GRANPERI_BENCH_FLUID_LAYER_H
#define GRANPERI_BENCH_FLUID_LAYER_H

enum { FLUID_CELLS = 400 };

typedef struct fluid_layer {
    double mu_s, mu_2, i0, diameter, grain_density, amplitude; /* -, -, -, m, kg/m3, - */
    double thickness, load, weight;                            /* m, Pa on top, N/m3: pressure = load + weight z */
    double stress;                                             /* Pa, uniform */
    double rate[FLUID_CELLS];                                  /* 1/s, from the top down */
} fluid_layer;

/* Finds the stress with which the lid has this speed (m/s) over the bottom; neither passes a flux of fluidity. */
void fluid_layer_drag(fluid_layer *f, double speed);
/* m/s, at a depth (m). */
double fluid_layer_velocity(const fluid_layer *f, double depth);
/* m: the height at which a layer at this slope (a tangent), of fluidity 0 at its base, has no other solution than rest. */
double fluid_layer_stopping_height(const fluid_layer *f, double slope);

#endif
