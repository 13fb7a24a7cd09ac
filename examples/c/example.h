/* What the examples share: options, error check, lifted gates, a run with a progress line, a summary. */
#ifndef GRANPERI_EXAMPLE_H
#define GRANPERI_EXAMPLE_H

#include <granperi/gp.h>

/* The options that every example takes. An example sets its own defaults before it calls example_parse. */
typedef struct example_options {
    double resolution;   /* particles over the reference length */
    double end;          /* s */
    double threads;      /* 0: the OpenMP default */
    double lift_time;    /* s in which a gate clears the height of its column; 0: no gates */
    double mu_s_degrees; /* friction angle at rest */
    double mu_2_degrees; /* friction angle of fast flow */
    const char *output;  /* HDF5 file; "none": no file */
} example_options;

/* One option more, a number, for a single example. */
typedef struct example_extra {
    const char *name;     /* "--..." */
    const char *argument; /* for the help: what follows it */
    const char *help;
    double *value;
    double low, high; /* the range allowed */
    int whole;        /* 1: a whole number */
} example_extra;

/* Glass beads, 1 s, gates that take 0.1 s; the file is only the default if this build of the library can write it. */
example_options example_defaults(double resolution, double end, const char *output);

/* Messages name the program by the last part of this path; example_parse sees to it. */
void example_program(const char *path);

/* Reads the command line. --help ends the program with status 0, a bad option with a message and status 2.
 * An end that is NAN stands for "depends on the case"; a lift_time or friction angles that are NAN and an output
 * that is NULL are not options of this example. extra may be NULL. */
void example_parse(int argc, char **argv, const char *about, example_options *options, const example_extra *extra);

/* Ends the program with the library's message if a call failed: with status 2 if an argument was wrong, 3 if this
 * version does not have what was asked for, else 1. */
void example_check(gp_status status, const char *call);
#define CHECK(call) example_check((call), #call)

/* For gp_set_log: the library's warnings to stderr. */
void example_log(void *user, int32_t level, const char *text);

/* A simulation of this spacing whose material 1 is glass beads of this diameter (m) with the friction of the options.
 */
gp_sim *example_create(const example_options *options, double spacing, double grain_diameter);

/* The same with what else of the configuration is not the default's; spacing and threads are set here. */
gp_sim *example_create_with(const example_options *options, gp_config config, double spacing, double grain_diameter);

/* A rough floor at y = 0 from x_left to x_right. */
void example_add_floor(gp_sim *sim, double x_left, double x_right);

enum { EXAMPLE_MATERIAL_LEFT, EXAMPLE_MATERIAL_RIGHT };

/* A smooth gate at x, wetted on the given side, that is lifted off a column of this height. Nothing if lift_time is 0.
 */
void example_add_gate(gp_sim *sim, double x, int side, double height, double spacing, double lift_time);

/* Particles of material 1 at rest on the lattice of the spacing, within the box and where inside(x, y, user) is not 0. */
void example_fill(gp_sim *sim, double spacing, double x_min, double x_max, double y_min, double y_max,
                  int (*inside)(double x, double y, const void *user), const void *user);

gp_state example_state(gp_sim *sim);
gp_load example_load(gp_sim *sim, int32_t plate);

/* Runs to options->end with a frame every 0.01 s and prints the summary: lines of "name value unit". */
void example_run(gp_sim *sim, const example_options *options);

/* The same with look(user, sim) after each `every`-th step; what it returns is not heeded. */
void example_run_and_look(gp_sim *sim, const example_options *options, int64_t every, gp_callback look, void *user);

#endif
