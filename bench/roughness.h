/* How far a field departs from a smooth one, particle by particle. */
#ifndef GRANPERI_BENCH_ROUGHNESS_H
#define GRANPERI_BENCH_ROUGHNESS_H

#include <granperi/gp.h>

typedef struct roughness {
    double pressure; /* Pa, rms departure from the plane fitted to the neighbours' pressures */
    double unseen;   /* share of the kinetic energy in velocity differences to the neighbours that are in no gradient */
} roughness;

/* radius: m, of the neighbourhoods. Particles without pressure, and those with few neighbours, are left out. */
roughness roughness_of(gp_sim *sim, double radius);

/* Pa, the highest of the means of a particle and its neighbours, by the method's own weight: the pressure that they bear together.
 * Particles with few neighbours are left out. */
double highest_mean_pressure(gp_sim *sim, double radius);

#endif
