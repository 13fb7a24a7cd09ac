#include "follow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../examples/c/example.h" /* CHECK */
#include "marks.h"
#include "roughness.h"

const char *const follow_header =
    "time,peak_height,x_left,x_right,kinetic_share,error_share,rms_speed,max_speed,max_pressure,pressure_noise,unseen,"
    "penalty_share,drift,drift_rms,at_rest,steps";

static const double gravity = 9.81;                            /* m/s2, the library's default */
static const double landed = 0.05, early = 0.1, Nearly = 1e-9; /* s */

static gp_state state_of(gp_sim *sim) {
    gp_state state = {.struct_size = sizeof state};
    CHECK(gp_get_state(sim, &state));
    return state;
}

static double *allocate(int64_t n) {
    double *values = calloc((size_t)(n > 0 ? n : 1), sizeof *values);
    if (!values) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return values;
}

/* Displacements since a first look. */
typedef struct drift {
    int64_t n;
    double *x, *y, largest, rms; /* m */
} drift;

static void look(drift *d, gp_sim *sim, int64_t n) {
    double *now = allocate(2 * n), sum = 0;
    int64_t i;
    CHECK(gp_copy_field(sim, GP_FIELD_X, now, n));
    CHECK(gp_copy_field(sim, GP_FIELD_Y, now + n, n));
    if (!d->x) {
        d->n = n;
        d->x = now;
        d->y = now + n;
        return;
    }
    d->largest = 0;
    for (i = 0; i < n; ++i) {
        const double moved = hypot(now[i] - d->x[i], now[n + i] - d->y[i]);
        d->largest = fmax(d->largest, moved);
        sum += moved * moved;
    }
    d->rms = sqrt(sum / (double)n);
    free(now);
}

static extent extent_of(const trial *t) {
    const extent e = {t->sides == 1 ? 0 : -t->length / 2, t->sides == 1 ? t->length : t->length / 2, trial_reference(t),
                      (int)t->sides};
    return e;
}

/* Outermost points at which the surface is above the threshold, of stations half a spacing apart. */
static double front_of(gp_sim *sim, const trial *t, const gp_state *s, double threshold) {
    const extent e = extent_of(t);
    const double dl = trial_spacing(t);
    const int64_t n = (int64_t)ceil(fmax(0, s->x_right - s->x_left) / (dl / 2)) + 1;
    double *x = allocate(2 * n), *height = x + n, left = INFINITY, right = -INFINITY;
    int64_t k;
    for (k = 0; k < n; ++k)
        x[k] = s->x_left + (double)k * dl / 2;
    CHECK(gp_get_surface(sim, n, x, height));
    for (k = 0; k < n; ++k)
        if (height[k] > threshold) {
            left = fmin(left, x[k]);
            right = fmax(right, x[k]);
        }
    free(x);
    return run_out_between(&e, left, right);
}

static double memory_of(gp_sim *sim) {
    enum { MOST = 200 };
    gp_plan_entry entries[MOST];
    int64_t n, k;
    double bytes = 0;
    CHECK(gp_get_plan(sim, MOST, entries, &n));
    for (k = 0; k < n && k < MOST; ++k)
        bytes += (double)entries[k].bytes;
    return bytes;
}

static void write_row(FILE *table, const gp_state *s, const outcome *o, const drift *d, const roughness *r,
                      const trial *t) {
    const double dl = trial_spacing(t), unit = trial_density() * gravity * trial_height(t);
    fprintf(table, "%.6g,%.8g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%d,%lld\n", s->time,
            s->peak_height, s->x_left, s->x_right, s->kinetic / o->energy, s->energy_error / o->energy, s->rms_speed,
            s->max_speed, s->max_pressure / unit, r->pressure / unit, r->unseen, s->penalty_dissipated / o->energy,
            d->largest / dl, d->rms / dl, s->at_rest, (long long)s->step);
}

static void update(outcome *o, gp_sim *sim, const trial *t, const following *f) {
    const gp_state *s = &o->state;
    const double unit = trial_density() * gravity * trial_height(t);
    if (!s->at_rest)
        o->rest = NAN;
    else if (isnan(o->rest))
        o->rest = s->time;
    o->kinetic = s->kinetic / o->energy;
    o->gain = fmax(o->gain, (s->kinetic + s->potential + s->elastic) / o->energy - 1);
    o->error = fmax(o->error, fabs(s->energy_error) / o->energy);
    o->pressure = fmax(o->pressure, s->max_pressure / unit);
    if (s->time >= landed) {
        o->late_pressure = fmax(o->late_pressure, s->max_pressure / unit);
        if (s->max_pressure / unit > o->late_mean) /* no mean is above it */
            o->late_mean = fmax(o->late_mean, highest_mean_pressure(sim, 4 * trial_spacing(t)) / unit);
    }
    if (s->time >= 0.9 * f->end)
        o->latest = fmax(o->latest, o->kinetic);
}

outcome follow(gp_sim *sim, const trial *t, const following *f) {
    const clock_t begin = clock(); /* the CPU time of all threads */
    const double dl = trial_spacing(t);
    outcome o = {.status = GP_OK, .state = state_of(sim), .rest = NAN, .gain = -INFINITY, .early = NAN};
    const extent e = extent_of(t);
    drift d = {0, NULL, NULL, 0, 0};
    roughness r = {0, 0};
    int64_t row;
    o.energy = o.state.kinetic + o.state.potential + o.state.elastic;
    if (f->table)
        fprintf(f->table, "%s\n", follow_header);
    for (row = 0;; ++row) {
        update(&o, sim, t, f);
        if (isnan(o.early) && o.state.time > early - Nearly)
            o.early = mean_distance(sim, &e);
        if (f->table) {
            if (o.state.time >= f->drift_from)
                look(&d, sim, o.state.n_particles);
            if (f->rough)
                r = roughness_of(sim, 4 * dl);
            write_row(f->table, &o.state, &o, &d, &r, t);
        }
        if (o.state.time >= f->end || o.state.time >= o.rest + f->rested ||
            (f->steps > 0 && (double)o.state.step >= f->steps))
            break;
        o.status =
            f->steps > 0 ? gp_step(sim, (int64_t)f->steps) : gp_run(sim, fmin((double)(row + 1) * f->interval, f->end));
        if (o.status != GP_E_DIVERGED)
            CHECK(o.status);
        o.state = state_of(sim);
        if (o.status == GP_E_DIVERGED || o.gain > 1) /* energy from nowhere: it will not come to rest any more */
            break;
    }
    o.peak = o.state.peak_height;
    o.tip = run_out_between(&e, o.state.x_left, o.state.x_right);
    o.front = front_of(sim, t, &o.state, 0.05 * trial_height(t));
    o.spread = run_out_of(sim, &e, 0.98);
    o.bulk = run_out_of(sim, &e, 0.90);
    o.memory = memory_of(sim);
    o.drift = d.largest / dl;
    o.seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    free(d.x);
    return o;
}
