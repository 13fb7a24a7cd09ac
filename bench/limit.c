#include "limit.h"

#include <math.h>

#include "../examples/c/example.h" /* CHECK */

/* Whether the deposit is the same is told on the ladder only: its scatter leaves nothing to bisect. */
enum { GRADES = 3, SEARCHED = 2, BISECTIONS = 3, MOST = 64 };
static const char *const grade_names[GRADES] = {"bounded", "stable", "same_deposit"};
static const double rung = 1.25; /* ratio of one trial's step to the one before it */

/* What is asked of a step beside that the run does not diverge. The schemes of the paper lose count of their energy with
 * any step: twice what the smallest one loses is allowed. */
static const double gain_allowed = 1e-3;  /* E0: bounded is what makes no energy */
static const double error_allowed = 0.02; /* E0: stable is what also keeps count of it, */
static const double error_excess = 2;     /* or loses it no faster than so many times the smallest step, */
static const double restless = 3;         /* calms down as far as the smallest step but for this factor */
static const double pressure_excess =
    3; /* and has no higher pressures than this times the smallest step's: the highest is a spike */
static const double deposit_allowed = 0.02; /* of the peak: and leaves the same deposit */

/* Worst of all seeds, but for the peak, which is the mean, and for what is left of the motion and the highest pressure, which
 * are the least: a grain that comes down late in one run, or hard, is no instability. */
typedef struct tried {
    double courant, gain, error, latest, pressure, peak;
    int diverged, good[GRADES];
} tried;

typedef struct search {
    const trial *trial;
    const following *follow;
    const criterion *criterion;
    int seeds, count;
    tried tried[MOST]; /* the first is the reference */
    double seconds;
} search;

static tried run_seeds(search *s, double courant) {
    trial t = *s->trial;
    tried r = {.courant = courant, .gain = -INFINITY, .latest = INFINITY, .pressure = INFINITY};
    int k;
    t.courant = courant;
    for (k = 0; k < s->seeds; ++k, ++t.seed) {
        gp_sim *sim = trial_create(&t);
        const outcome o = follow(sim, &t, s->follow);
        gp_destroy(sim);
        s->seconds += o.seconds;
        r.diverged |= o.status == GP_E_DIVERGED;
        r.gain = fmax(r.gain, o.gain);
        r.error = fmax(r.error, o.error);
        r.latest = fmin(r.latest, o.latest);
        r.pressure = fmin(r.pressure, o.pressure);
        r.peak += o.peak / s->seeds;
    }
    return r;
}

static const tried *attempt(search *s, double courant) {
    const tried *reference = &s->tried[0];
    tried *r = &s->tried[s->count++];
    *r = run_seeds(s, courant);
    r->good[0] = !r->diverged && r->gain <= gain_allowed;
    r->good[1] = r->good[0] && r->error <= fmax(error_allowed, error_excess * reference->error) &&
                 r->latest <= fmax(s->criterion->at_rest, restless * reference->latest) &&
                 r->pressure <= pressure_excess * reference->pressure;
    r->good[2] = r->good[1] && fabs(r->peak / reference->peak - 1) <= deposit_allowed;
    return r;
}

/* The smallest step tried that is not good enough, and the largest one below it. */
static void bracket(const search *s, int grade, double *good, double *bad) {
    int k;
    *good = 0;
    *bad = INFINITY;
    for (k = 0; k < s->count; ++k)
        if (!s->tried[k].good[grade])
            *bad = fmin(*bad, s->tried[k].courant);
    for (k = 0; k < s->count; ++k)
        if (s->tried[k].courant < *bad)
            *good = fmax(*good, s->tried[k].courant);
}

static void print(const search *s, gp_sim *sim) {
    gp_state state = {.struct_size = sizeof state};
    int grade;
    CHECK(gp_get_state(sim, &state));
    printf("version             %s\n", gp_version_string());
    printf("sound_speed         %.6g m/s\n", state.sound_speed);
    printf("wave_speed          %.6g m/s\n", trial_wave_speed(s->trial));
    printf("spacing             %.6g m\n", trial_spacing(s->trial));
    for (grade = 0; grade < GRADES; ++grade) {
        double good, bad;
        bracket(s, grade, &good, &bad);
        printf("%-19s %.6g dl / wave speed\n", grade_names[grade], good);
        printf("not_%-15s %.6g dl / wave speed\n", grade_names[grade], bad);
    }
    printf("reference_peak      %.8g m\n", s->tried[0].peak);
    printf("reference_latest    %.6g E0\n", s->tried[0].latest);
    printf("cpu_seconds         %.3f s\n", s->seconds);
}

static void write_table(const search *s, FILE *table) {
    const tried *r = s->tried;
    fprintf(table, "courant,bounded,stable,same_deposit,peak,gain,error,latest,pressure\n");
    for (; r < s->tried + s->count; ++r)
        fprintf(table, "%.6g,%d,%d,%d,%.8g,%.6g,%.6g,%.6g,%.6g\n", r->courant, r->good[0], r->good[1], r->good[2],
                r->peak, r->gain, r->error, r->latest, r->pressure);
}

void search_limit(const trial *t, const following *f, const criterion *c, int seeds, FILE *table) {
    search s = {.trial = t, .follow = f, .criterion = c, .seeds = seeds};
    double courant;
    int grade, k;
    gp_sim *sim;
    attempt(&s, c->smallest);
    for (courant = c->first; courant <= c->largest && s.count < MOST / 2; courant *= rung)
        if (!attempt(&s, courant)->good[0])
            break;
    for (grade = 0; grade < SEARCHED; ++grade)
        for (k = 0; k < BISECTIONS; ++k) {
            double good, bad;
            bracket(&s, grade, &good, &bad);
            if (good > 0 && isfinite(bad))
                attempt(&s, sqrt(good * bad));
        }
    if (table)
        write_table(&s, table);
    sim = trial_create(t);
    print(&s, sim);
    gp_destroy(sim);
}
