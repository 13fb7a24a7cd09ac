/* A scene with every coefficient of the scheme as an option: a column that collapses, or a layer that should stay at rest. */
#ifndef GRANPERI_BENCH_TRIAL_H
#define GRANPERI_BENCH_TRIAL_H

#include <granperi/gp.h>

#include "options.h"

typedef enum trial_scene { TRIAL_COLLAPSE, TRIAL_LAYER } trial_scene;

/* NAN stands for the scheme's own value. */
typedef struct trial {
    trial_scene scene;
    const char *scheme;
    double resolution; /* spacings in the length */
    double length;     /* m, of the column */
    double aspect;     /* its height over L0 */
    double sides;      /* to which it collapses: with 1, a smooth wall is at the other; L0 = length / sides */
    double lift_time;  /* s, of the gates of the collapse */
    double sound_factor, cfl, courant, horizon, interaction_radius, delta, collision_distance, zero_energy_penalty,
        density_diffusion, bulk_viscosity, friction_factor, retry_halvings, implicit_tolerance;
    double jitter, seed, threads;
    double mu_s_degrees, mu_2_degrees, diameter;
    const char *mode;  /* of the layer: the pattern of the initial velocity */
    double mode_speed; /* its amplitude over c0 */
} trial;

enum { TRIAL_OPTIONS = 27 };

trial trial_defaults(trial_scene scene);

/* Fills options[TRIAL_OPTIONS] with what sets the fields of *t. */
void trial_options(trial *t, bench_option *options);

double trial_spacing(const trial *t);   /* m */
double trial_reference(const trial *t); /* m, L0 */
double trial_height(const trial *t);    /* m, of the column, and the depth of the layer, which is periodic */

/* The simulation before its first step. Ends the program if the library refuses the options. */
gp_sim *trial_create(const trial *t);

/* Elastic wave speed (m/s) and sound speed of a trial with the automatic time step, found by taking one step. */
double trial_wave_speed(const trial *t);

/* kg/m3, of the material of every trial */
double trial_density(void);

#endif
