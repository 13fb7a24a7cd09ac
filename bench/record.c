#include "record.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../examples/c/example.h" /* CHECK */
#include "table.h"

typedef struct files {
    FILE *series, *surface, *section, *interface;
} files;

static FILE *open_table(const recording *r, const char *name, const char *header) {
    FILE *file = bench_open_table(r->prefix, name);
    if (file)
        fprintf(file, "%s\n", header);
    return file;
}

static gp_state state_of(gp_sim *sim) {
    gp_state state;
    state.struct_size = sizeof state;
    CHECK(gp_get_state(sim, &state));
    return state;
}

static double energy_of(const gp_state *s) {
    return s->kinetic + s->potential + s->elastic + s->dissipated + s->plate_work + s->energy_error;
}

static double surface_at(gp_sim *sim, double x) {
    double height;
    CHECK(gp_get_surface(sim, 1, &x, &height));
    return height;
}

typedef struct run_outs {
    double most, nearly_all, tip; /* of 90 and 98 % of the mass, of the connected deposit's ends */
} run_outs;

static run_outs run_outs_of(gp_sim *sim, const recording *r, const gp_state *s) {
    const run_outs none = {NAN, NAN, NAN};
    run_outs w;
    if (r->extent.reference == 0)
        return none;
    w.most = run_out_of(sim, &r->extent, 0.90);
    w.nearly_all = run_out_of(sim, &r->extent, 0.98);
    w.tip = run_out_between(&r->extent, s->x_left, s->x_right);
    return w;
}

static void write_series(FILE *file, gp_sim *sim, const recording *r, const gp_state *s, double energy) {
    run_outs w;
    if (!file)
        return;
    w = run_outs_of(sim, r, s);
    fprintf(file, "%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%d\n", s->time, s->peak_height,
            s->peak_x, w.most, w.nearly_all, w.tip, surface_at(sim, r->axis), s->rms_speed, s->max_speed,
            s->kinetic / energy, s->energy_error / energy, s->max_pressure, s->at_rest);
}

static double *allocate(int64_t n) {
    double *values = calloc((size_t)n, sizeof *values);
    if (!values) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return values;
}

/* The library's surface is that of the largest connected set. For what is apart from it, another column or single grains,
 * half a spacing above the highest particle within a spacing of the station. */
static void add_detached(gp_sim *sim, const recording *r, const gp_state *s, int64_t n, double begin, double step,
                         double *height) {
    gp_particles p;
    int64_t i, k;
    p.struct_size = sizeof p;
    CHECK(gp_get_particles(sim, GP_FIELD_POSITION, &p));
    for (i = 0; i < p.count; ++i)
        for (k = (int64_t)ceil((p.x[i] - r->spacing - begin) / step); begin + (double)k * step <= p.x[i] + r->spacing;
             ++k) {
            const double x = begin + (double)k * step;
            if (k >= 0 && k < n && (x < s->x_left || x > s->x_right))
                height[k] = fmax(height[k], p.y[i] + r->spacing / 2);
        }
}

/* From the leftmost to the rightmost particle. */
static void find_extent(gp_sim *sim, double *left, double *right) {
    gp_particles p;
    int64_t i;
    p.struct_size = sizeof p;
    CHECK(gp_get_particles(sim, GP_FIELD_X, &p));
    for (i = 0; i < p.count; ++i) {
        *left = fmin(*left, p.x[i]);
        *right = fmax(*right, p.x[i]);
    }
}

/* Stations half a spacing apart over all particles. */
static void write_surface(FILE *file, gp_sim *sim, const recording *r, const gp_state *s) {
    const double step = r->spacing / 2;
    double left = s->x_left, right = s->x_right, *x, *height;
    int64_t n, k;
    if (!file)
        return;
    find_extent(sim, &left, &right);
    n = (int64_t)floor((right - left) / step) + 3;
    x = allocate(2 * n);
    height = x + n;
    for (k = 0; k < n; ++k)
        x[k] = left + (double)(k - 1) * step;
    CHECK(gp_get_surface(sim, n, x, height));
    add_detached(sim, r, s, n, x[0], step, height);
    for (k = 0; k < n; ++k)
        fprintf(file, "%.6g,%.6g,%.6g,%d\n", s->time, x[k], height[k], x[k] >= s->x_left && x[k] <= s->x_right);
    free(x);
}

/* Mean velocity of the particles within one spacing of the section, in bins one spacing wide. */
static void write_section(FILE *file, gp_sim *sim, const recording *r, const gp_state *s, double y) {
    const int64_t n = (int64_t)floor((s->x_right - s->x_left) / r->spacing) + 1;
    gp_particles p;
    double *sums;
    int64_t k, i;
    if (!file)
        return;
    sums = allocate(3 * n);
    p.struct_size = sizeof p;
    CHECK(gp_get_particles(sim, GP_FIELD_POSITION | GP_FIELD_VELOCITY, &p));
    for (i = 0; i < p.count; ++i) {
        k = (int64_t)floor((p.x[i] - s->x_left) / r->spacing);
        if (fabs(p.y[i] - y) > r->spacing || k < 0 || k >= n)
            continue;
        sums[3 * k] += 1;
        sums[3 * k + 1] += p.vx[i];
        sums[3 * k + 2] += hypot(p.vx[i], p.vy[i]);
    }
    for (k = 0; k < n; ++k)
        if (sums[3 * k] > 0)
            fprintf(file, "%.6g,%.6g,%.6g,%.6g,%.6g,%g\n", s->time, y, s->x_left + ((double)k + 0.5) * r->spacing,
                    sums[3 * k + 1] / sums[3 * k], sums[3 * k + 2] / sums[3 * k], sums[3 * k]);
    free(sums);
}

/* Rows a quarter of a spacing apart; those where the columns do not touch are left out. */
static void write_interface(FILE *file, gp_sim *sim, const recording *r, const gp_state *s) {
    const double step = r->spacing / 4;
    const int64_t n = (int64_t)ceil(s->peak_height / step) + 1;
    double *y, *x;
    int64_t k;
    if (!file || r->columns < 2)
        return;
    y = allocate(2 * n);
    x = y + n;
    for (k = 0; k < n; ++k)
        y[k] = ((double)k + 0.5) * step;
    CHECK(gp_get_interface(sim, 0, 1, n, y, x));
    for (k = 0; k < n; ++k)
        if (!isnan(x[k]))
            fprintf(file, "%.6g,%.6g,%.6g\n", s->time, y[k], x[k]);
    free(y);
}

static void write_profiles(const files *f, gp_sim *sim, const recording *r, const gp_state *s) {
    int k;
    write_surface(f->surface, sim, r, s);
    write_interface(f->interface, sim, r, s);
    for (k = 0; k < r->sections.count; ++k)
        write_section(f->section, sim, r, s, r->sections.value[k]);
}

static void print_summary(const recording *r, gp_sim *sim, const gp_state *s, double energy, double rest_since,
                          double highest_pressure, double cpu_seconds) {
    const double steps = (double)s->n_particles * (double)s->step;
    printf("version             %s\n", gp_version_string());
    printf("time                %.6g s\n", s->time);
    printf("particles           %lld\n", (long long)s->n_particles);
    printf("steps               %lld\n", (long long)s->step);
    printf("spacing             %.6g m\n", r->spacing);
    printf("sound_speed         %.6g m/s\n", s->sound_speed);
    printf("peak_height         %.6g m\n", s->peak_height);
    printf("axis_height         %.6g m\n", surface_at(sim, r->axis));
    printf("x_left              %.6g m\n", s->x_left);
    printf("x_right             %.6g m\n", s->x_right);
    if (r->extent.reference > 0) {
        const run_outs w = run_outs_of(sim, r, s);
        printf("run_out_90          %.6g L0\n", w.most);
        printf("run_out_98          %.6g L0\n", w.nearly_all);
        printf("tip                 %.6g L0\n", w.tip);
        printf("reference_length    %.6g m\n", r->extent.reference);
    }
    printf("rms_speed           %.6g m/s\n", s->rms_speed);
    printf("kinetic_share       %.6g E0\n", s->kinetic / energy);
    printf("energy_initial      %.6g J/m\n", energy);
    printf("energy_error_share  %.6g E0\n", s->energy_error / energy);
    printf("highest_pressure    %.6g Pa\n", highest_pressure);
    printf("collisions          %lld\n", (long long)s->collisions);
    printf("at_rest             %d\n", s->at_rest);
    if (s->at_rest)
        printf("at_rest_since       %.6g s\n", rest_since);
    printf("cpu_seconds         %.3f s\n", cpu_seconds);
    printf("particle_steps_rate %.4g per CPU second\n", cpu_seconds > 0 ? steps / cpu_seconds : 0);
}

void record_run(gp_sim *sim, const recording *r) {
    const clock_t begin = clock(); /* the CPU time of all threads, the recording included */
    const double nearly = 1e-9;    /* s: times this close are the same */
    files f;
    gp_state s = state_of(sim);
    const double energy = energy_of(&s);
    double rest_since = 0, highest_pressure = s.max_pressure;
    int was_at_rest = 0, k;
    long rows = 0;
    f.series =
        open_table(r, "series",
                   "time,peak_height,peak_x,run_out_90,run_out_98,tip,axis_height,rms_speed,max_speed,kinetic_share,"
                   "energy_error_share,max_pressure,at_rest");
    f.surface = open_table(r, "surface", "time,x,height,connected");
    f.section = open_table(r, "section", "time,y,x,vx,speed,particles");
    f.interface = open_table(r, "interface", "time,y,x");
    for (;;) {
        const double row = fmin((double)rows * r->interval, r->end);
        double next = r->end;
        highest_pressure = fmax(highest_pressure, s.max_pressure);
        if (s.at_rest && !was_at_rest)
            rest_since = s.time;
        was_at_rest = s.at_rest;
        for (k = 0; k < r->times.count; ++k)
            if (fabs(r->times.value[k] - s.time) < nearly)
                write_profiles(&f, sim, r, &s);
        if (s.time >= row - nearly) {
            write_series(f.series, sim, r, &s, energy);
            ++rows;
        }
        if (s.time >= r->end)
            break;
        next = fmin(next, (double)rows * r->interval);
        for (k = 0; k < r->times.count; ++k)
            if (r->times.value[k] > s.time + nearly)
                next = fmin(next, r->times.value[k]);
        CHECK(gp_run(sim, next));
        s = state_of(sim);
    }
    print_summary(r, sim, &s, energy, rest_since, highest_pressure, (double)(clock() - begin) / CLOCKS_PER_SEC);
    bench_close_table(f.series);
    bench_close_table(f.surface);
    bench_close_table(f.section);
    bench_close_table(f.interface);
}
