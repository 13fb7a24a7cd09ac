/* The mu(I) law in one dimension: a layer on a rough floor, u(y, t), by an implicit finite-volume scheme. What layers are
 * compared with where there is no closed formula. */
#ifndef GRANPERI_BENCH_PLANE_FLOW_H
#define GRANPERI_BENCH_PLANE_FLOW_H

enum { PLANE_CELLS = 200 };

typedef struct plane_flow {
    double mu_s, mu_2, i0, diameter, grain_density, density; /* -, -, -, m, kg/m3, kg/m3 */
    double width;                                            /* m, of a cell */
    double along, down;                                      /* m/s2, gravity */
    double time;                                             /* s */
    double u[PLANE_CELLS];                                   /* m/s, from the floor upwards */
    double rate[PLANE_CELLS];                                /* 1/s, at the lower face of each */
} plane_flow;

/* Glass beads of 21 and 32 degrees, 2 mm across. */
plane_flow plane_flow_at(double thickness, double speed, double along, double down);
void plane_flow_run(plane_flow *f, double end);
double plane_flow_surface(const plane_flow *f);
double plane_flow_mean(const plane_flow *f);

#endif
