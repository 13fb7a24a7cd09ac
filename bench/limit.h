/* The largest stable time step of a trial, as a multiple of dl / wave speed. */
#ifndef GRANPERI_BENCH_LIMIT_H
#define GRANPERI_BENCH_LIMIT_H

#include "follow.h"

/* What a run is held against, with that of the smallest step as the reference. */
typedef struct criterion {
    double smallest; /* Courant number of the reference */
    double first;    /* of the first trial */
    double largest;  /* of the last */
    double at_rest;  /* kinetic energy / E0 that may be left in the last tenth of the run, if the reference has less */
} criterion;

/* Prints "name value unit" lines; table: a row per trial, or NULL. Every trial is run with this many seeds. */
void search_limit(const trial *t, const following *f, const criterion *c, int seeds, FILE *table);

#endif
