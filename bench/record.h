/* What a bench scene leaves behind: tables in time, profiles at chosen times, a summary. */
#ifndef GRANPERI_BENCH_RECORD_H
#define GRANPERI_BENCH_RECORD_H

#include <granperi/gp.h>

#include "marks.h"
#include "options.h"

typedef struct recording {
    const char *prefix;  /* of the files: prefix.series.csv, .surface.csv, .section.csv, .interface.csv; or "none" */
    double spacing;      /* m */
    double end;          /* s */
    double interval;     /* s between rows of the series */
    bench_list times;    /* s, of surfaces, sections and interfaces */
    bench_list sections; /* m, heights of the horizontal sections */
    double axis;         /* m, x at which the height is recorded */
    extent extent;       /* what run-outs are counted from; reference 0: none is defined */
    int32_t columns;     /* 2: there is an interface between columns 0 and 1 */
} recording;

/* Runs to the end, writes the files, prints lines of "name value unit". */
void record_run(gp_sim *sim, const recording *r);

#endif
