/* Follows a trial to its end: what its deposit, its energy, its pressure and its rest were like. */
#ifndef GRANPERI_BENCH_FOLLOW_H
#define GRANPERI_BENCH_FOLLOW_H

#include <stdio.h>

#include "trial.h"

typedef struct following {
    double end;        /* s */
    double steps;      /* stop after so many at the latest; 0: none */
    double interval;   /* s between rows of the table */
    double drift_from; /* s, displacements count from here */
    double rested;     /* s: a run that has been at rest for so long ends */
    int rough;   /* 1: also measure the roughness of pressure and velocity, which costs some steps' time per row */
    FILE *table; /* a row per interval; NULL: none */
} following;

typedef struct outcome {
    gp_status status; /* what ended the run: GP_OK, or GP_E_DIVERGED */
    gp_state state;   /* the last */
    double energy;    /* J/m, E0 = potential + elastic + kinetic energy at the start */
    double peak;      /* m */
    double tip;       /* run-out of the connected deposit's ends over L0, mean of both sides: (x - L0) / L0 */
    double front;     /* the same where the deposit is 0.05 H thick */
    double spread;    /* the same between whose ends are 98 % of the mass */
    double bulk;      /* and 90 %: without the film of single particles ahead of the deposit, whose mass goes with dl */
    double rest;      /* s, since when it has been at rest; NAN: it is not */
    double gain;      /* largest of kinetic + potential + elastic energy over E0, less 1: none can come from anywhere */
    double error;     /* largest |energy_error| / E0 */
    double early;    /* mean distance from the middle, or the wall, over L0 at .1 s, in mid-flow; NAN: it was shorter */
    double pressure; /* largest pressure so far over rho g H */
    double late_pressure; /* the same from .05 s on, when the foot of the column no longer bears it */
    double late_mean; /* of the means of particles and their neighbours, from then on: without single grains' blows */
    double kinetic;   /* kinetic energy / E0 at the end */
    double latest;    /* largest kinetic energy / E0 in the last tenth of the run */
    double memory;    /* bytes, that the library holds at the end */
    double drift;     /* dl, largest displacement since drift_from */
    double seconds;   /* CPU s, measurements included */
} outcome;

extern const char *const follow_header; /* of the table */

outcome follow(gp_sim *sim, const trial *t, const following *f);

#endif
