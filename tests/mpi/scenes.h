/* The scenes that run on several processes and on one: same_values.c compares them. */
#ifndef GRANPERI_TESTS_MPI_SCENES_H
#define GRANPERI_TESTS_MPI_SCENES_H

#include <granperi/gp_mpi.h>

enum {
    TWO_COLUMNS = 1, /* compared by their interface, too */
    NEW_GRAVITY = 2, /* changed halfway */
    IMAGES = 4       /* so wide that processes see particles of each other, however many there are */
};

typedef struct {
    const char *name;
    void (*config)(gp_config *);
    void (*build)(gp_sim *);
    int steps;
    unsigned has; /* what is above, or-ed */
} scene;

extern const scene scenes[]; /* the last has no name */
extern int rank;             /* of this process: what has particles of its own gives all of them to the first */

/* Ends all processes with the library's message if a call has failed. */
void check(gp_status status, const char *what);

#endif
