/* Where the mass of a collapse lies: the one definition of a run-out in the reports. Of 90 % of the mass, 5 % lie beyond each of two
 * ends, 10 % beyond one. The tips, which are single grains, are beside it where they are what is studied. */
#ifndef GRANPERI_BENCH_MARKS_H
#define GRANPERI_BENCH_MARKS_H

#include <granperi/gp.h>

typedef struct extent {
    double left, right; /* m, feet of the material at the start */
    double reference;   /* m, L0 */
    int sides;          /* to which it can run out: 1 (the right), or 2 */
} extent;

/* (x - L0) / L0 of what holds this share of the mass, mean of both sides. */
double run_out_of(gp_sim *sim, const extent *e, double share);
/* Of two places. */
double run_out_between(const extent *e, double left, double right);
/* Mean distance of the material from the middle, or from the wall, over L0. */
double mean_distance(gp_sim *sim, const extent *e);

#endif
