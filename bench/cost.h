/* What the programs on walls and on fluidity end with, and how they read fields. */
#ifndef GRANPERI_BENCH_COST_H
#define GRANPERI_BENCH_COST_H

#include <granperi/gp.h>

/* Memory for so many numbers, to be freed. */
double *bench_doubles(int64_t count);
/* A copy of a field, to be freed. */
double *bench_field(gp_sim *sim, uint32_t bit, int64_t count);
/* Lines of time, particles, steps, CPU seconds. */
void bench_print_cost(gp_sim *sim);

#endif
