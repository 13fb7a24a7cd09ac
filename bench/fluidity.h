/* Granular fluidity: the cases of the program, and what they share. */
#ifndef GRANPERI_BENCH_FLUIDITY_H
#define GRANPERI_BENCH_FLUIDITY_H

#include <granperi/gp.h>

#include "../examples/c/example.h" /* CHECK */
#include "cost.h"
#include "fluid_layer.h"

typedef struct choices {
    double per_grain;   /* spacings in a grain */
    double horizon;     /* spacings */
    double amplitude;   /* -, of the fluidity */
    double speed;       /* m/s, of the lid */
    double sound_speed; /* m/s */
    double angle;       /* degrees, of the incline */
    double rows;        /* spacings in the layer on the incline, and in the column's width */
    double end;         /* s */
    double jitter;      /* spacings */
    const char *preset; /* scheme */
    const char *lid;    /* free or zero: what the lid of a Couette cell does to the fluidity */
} choices;

gp_config fluid_config(const choices *c, double spacing);
gp_material fluid_beads(const choices *c, double diameter);
fluid_layer fluid_law(const gp_material *m);

/* An annular Couette cell without gravity: torque and profile. */
void fluid_annular(const choices *c);

#endif
