/* The granular fluidity in one dimension: a layer in steady shear below a lid, and the gap of an annular cell, by finite volumes. What
 * cells are compared with, where there is no closed formula. */
#ifndef GRANPERI_BENCH_FLUID_LAYER_H
#define GRANPERI_BENCH_FLUID_LAYER_H

enum { FLUID_CELLS = 400 };

typedef struct fluid_layer {
    double mu_s, mu_2, i0, diameter, grain_density, amplitude; /* -, -, -, m, kg/m3, - */
    double thickness, load, weight;                            /* m, Pa on top, N/m3: pressure = load + weight z */
    int zero_top;                                              /* 1: the fluidity is 0 there; 0: no flux */
    double stress;                                             /* Pa, uniform */
    double rate[FLUID_CELLS];                                  /* 1/s, from the top down */
} fluid_layer;

/* Finds the stress with which the lid has this speed (m/s) over the bottom, which passes no flux of fluidity. */
void fluid_layer_drag(fluid_layer *f, double speed);
/* m/s, at a depth (m). */
double fluid_layer_velocity(const fluid_layer *f, double depth);
/* m: the height at which a layer at this slope (a tangent), of fluidity 0 at its base, has no other solution than rest. */
double fluid_layer_stopping_height(const fluid_layer *f, double slope);

/* Of the same law an annular cell under one pressure, whose inner wall turns and whose outer one holds; neither passes a flux. */
typedef struct fluid_annulus {
    const fluid_layer *law;
    double inner, outer, pressure; /* m, m, Pa */
    double moment;                 /* N: the shear stress is moment / (2 pi r^2) */
    double turning[FLUID_CELLS];   /* 1/s, rate over radius, from the inside out */
} fluid_annulus;

/* Finds the moment with which the inner wall turns at this rate, rad/s. */
void fluid_annulus_turn(fluid_annulus *f, double omega);
/* m/s, along the walls at this radius (m). */
double fluid_annulus_velocity(const fluid_annulus *f, double radius);

#endif
