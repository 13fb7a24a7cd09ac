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
    double resolution; /* spacings in the length L = 0.08 m */
    double lift_time;  /* s, of the gates of the collapse */
    double sound_factor, cfl, courant, horizon, interaction_radius, delta, collision_distance, zero_energy_penalty,
        density_diffusion, bulk_viscosity, friction_factor, retry_halvings, implicit_tolerance;
    double jitter, seed, threads;
    double mu_s_degrees, mu_2_degrees, diameter;
    const char *mode;  /* of the layer: the pattern of the initial velocity */
    double mode_speed; /* its amplitude over c0 */
} trial;

enum { TRIAL_OPTIONS = 23 };

/* The column is H = 0.05 m high, so that a = 1.25; the layer is as deep, and periodic. */
extern const double trial_height, trial_half_width; /* m */

trial trial_defaults(trial_scene scene);

/* Fills options[TRIAL_OPTIONS] with what sets the fields of *t. */
void trial_options(trial *t, bench_option *options);

double trial_spacing(const trial *t); /* m */

/* The simulation before its first step. Ends the program if the library refuses the options. */
gp_sim *trial_create(const trial *t);

/* Elastic wave speed (m/s) and sound speed of a trial with the automatic time step, found by taking one step. */
double trial_wave_speed(const trial *t);

/* kg/m3, of the material of every trial */
double trial_density(void);

#endif
