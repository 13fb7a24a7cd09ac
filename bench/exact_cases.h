/* The exact solutions: each builds its scene, runs it, and prints its error and what it cost. */
#ifndef GP_BENCH_EXACT_CASES_H
#define GP_BENCH_EXACT_CASES_H

#include "exact_layer.h"

void hydrostatic(const options *o);
void shear_box(const options *o);
void gradient(const options *o);
void bagnold(const options *o, int start_up);
void chute_flow(const options *o);
void couette_cell(const options *o);
void slope(const options *o);

#endif
