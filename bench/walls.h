/* What walls and inclines do to glass beads of 21 and 32 degrees: the cases of the program, and what they share. */
#ifndef GRANPERI_BENCH_WALLS_H
#define GRANPERI_BENCH_WALLS_H

#include <granperi/gp.h>

#include "../examples/c/example.h" /* CHECK */
#include "cost.h"

#define DEGREE (3.14159265358979323846 / 180)
#define GRAVITY 9.81   /* m/s2 */
#define DENSITY 1550.0 /* kg/m3, of the flow */

typedef struct choices {
    double rows;     /* spacings in the layer, in the height of the column, in the width of the silo or in the outlet */
    double angle;    /* degrees, of the incline */
    double jitter;   /* spacings */
    double horizon;  /* spacings; NAN: the library's */
    double end;      /* s */
    double filling;  /* of a hopper, outlets high */
    int32_t beads;   /* 1: a hopper has glass beads of 21 and 32 degrees in place of the published friction */
    int32_t coulomb; /* 1: the floor has the Coulomb friction of the material in place of a rough surface */
    double bed;      /* m, thickness of a layer of the same grains under the column, that can be eroded */
    double segments; /* of a floor, a bowl, a drum */
    int32_t wall;    /* friction of a floor in pieces, GP_WALL_... */
    double froude;   /* omega^2 R / g, of the drum */
    double turns;    /* of the drum */
} choices;

typedef struct walls_point {
    double x, y; /* m */
} walls_point;

enum { WALLS_CORNERS = 512, WALLS_MOST = 100000 }; /* of a line; particles of a filling */

gp_config walls_config(const choices *c, double spacing);
/* Material 1: glass beads of this diameter (m); mu_2 = mu_s if constant. Material 0 is the library's own. */
void walls_add_beads(gp_sim *sim, double diameter, int constant);
/* Corners of an arc about the origin, degrees; returns how many. Clockwise, the material is inside. */
int walls_arc(double radius, double from, double to, int count, walls_point *points);
/* Particles of material 1 on the lattice of the spacing where `inside` says so. */
void walls_fill(gp_sim *sim, double spacing, walls_point low, walls_point high,
                int (*inside)(double x, double y, const void *user), const void *user);

/* A layer thrown along its level floor: traction over friction times weight, way to the stop; friction mu_s at any rate. */
void slide_coulomb(const choices *c);
/* The same with mu(I), 5 mm thick, beside the law in one dimension. */
void slide_inertial(const choices *c);
/* A layer of 20 diameters on an incline: its start from rest beside the law in one dimension. */
void incline_start(const choices *c);
/* The same, long: height and velocity of the surface, at four times. */
void incline_shear(const choices *c);
/* A column released on an incline or on a layer of its grains, a wall behind it: where its mass comes to rest. */
void incline_column(const choices *c);
/* A silo that empties through an outlet in its floor: the flow rate, and the same in four parts of the time from .2 s on. */
void hopper(const choices *c);
/* A level floor in pieces under a column between smooth walls: pressure, rest. */
void pieces(const choices *c);
/* A slope in pieces: the way that a block has gone down. */
void pieces_slope(const choices *c);
/* A bowl of segments, filled to its middle: rest, and energy that its walls give back. */
void bowl(const choices *c);
/* A drum that turns, 30 % full: slope of the surface, work and dissipation. */
void drum(const choices *c);
/* An annular Couette cell without gravity: torque and zone of flow beside the law in one dimension. */
void annular(const choices *c);
/* A layer without ends, and a closed box, that are tilted by a degree per second. */
void tilt_layer(const choices *c);
void tilt_box(const choices *c);
/* A column of a = 1.25 with mu = 1.5, whose faces should stand. */
void face(const choices *c);
/* A tall silo with rough walls whose floor sinks: friction of the walls, what the floor bears, the ratio of stresses above it. */
void silo(const choices *c);

#endif
