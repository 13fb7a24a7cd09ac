/* Material between two circles about the origin. */
#ifndef GRANPERI_BENCH_RINGS_H
#define GRANPERI_BENCH_RINGS_H

#include <granperi/gp.h>

/* Particles of a material in rings between two radii, every other one turned by half of its particles' distance. */
void add_rings(gp_sim *sim, int32_t material, double inner, double outer, int rings, double spacing);

#endif
