/* Scenes on as many processes as MPI gives, beside the same scene on one: fields, clock, loads have to be equal.
 *
 *   mpirun -n N same_values [scene [threads]]   all scenes without one; prints what differs, and returns 1 if something does. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes.h"

int rank;
static int ranks, threads = 1, failures;

void check(gp_status status, const char *what) {
    if (status < 0) {
        fprintf(stderr, "rank %d: %s: %s: %s\n", rank, what, gp_status_string(status), gp_last_error());
        MPI_Abort(MPI_COMM_WORLD, 2);
    }
}

static gp_sim *make(const scene *s, int alone) {
    gp_config c;
    gp_sim *sim;
    check(gp_config_init(&c, sizeof c, GP_PRESET_DEFAULT), "gp_config_init");
    c.threads = alone ? 1 : threads;
    s->config(&c);
    if (alone)
        check(gp_create(&c, &sim), "gp_create");
    else
        check(gp_create_mpi(&c, MPI_COMM_WORLD, &sim), "gp_create_mpi");
    return sim;
}

static gp_state state_of(gp_sim *sim) {
    gp_state state;
    memset(&state, 0, sizeof state);
    state.struct_size = sizeof state;
    check(gp_get_state(sim, &state), "gp_get_state");
    return state;
}

static void differ(const scene *s, const char *what, double alone, double together) {
    if (failures++ < 20)
        printf("%s on %d: %s: %.17g alone, %.17g together\n", s->name, ranks, what, alone, together);
}

static void equal(const scene *s, const char *what, double a, double b) {
    if (a != b && !(isnan(a) && isnan(b)))
        differ(s, what, a, b);
}
static void close_to(const scene *s, const char *what, double a, double b, double scale) {
    if (!(fabs(a - b) <= 1e-9 * scale))
        differ(s, what, a, b);
}
#define EQUAL(name) equal(s, #name, (double)a.name, (double)b.name)
#define CLOSE(name) close_to(s, #name, a.name, b.name, scale) /* sums of many roundings */

static void compare_loads(const scene *s, gp_sim *alone, gp_sim *together) {
    for (int32_t plate = 0;; ++plate) {
        gp_load a, b;
        memset(&a, 0, sizeof a);
        a.struct_size = sizeof a;
        b = a;
        if (gp_get_plate_load(alone, plate, &a) < 0)
            break;
        check(gp_get_plate_load(together, plate, &b), "gp_get_plate_load");
        EQUAL(fx), EQUAL(fy), EQUAL(torque), EQUAL(dx), EQUAL(dy), EQUAL(impulse_x), EQUAL(impulse_y), EQUAL(torque_pivot);
        EQUAL(angle), EQUAL(impulse_torque);
    }
}

/* Surface, and interface of the first two columns, at some places of the whole. */
static void compare_shapes(const scene *s, gp_sim *alone, gp_sim *together, const gp_state *whole) {
    enum { n = 41 };
    double at[n], a[n], b[n];
    for (int k = 0; k < n; ++k)
        at[k] = whole->x_left + (whole->x_right - whole->x_left) * k / (n - 1);
    check(gp_get_surface(together, n, at, b), "gp_get_surface");
    if (rank == 0)
        check(gp_get_surface(alone, n, at, a), "gp_get_surface");
    for (int k = 0; k < n && rank == 0; ++k)
        equal(s, "surface", a[k], b[k]);
    if (!(s->has & TWO_COLUMNS))
        return;
    for (int k = 0; k < n; ++k)
        at[k] = whole->peak_height * k / (n - 1);
    check(gp_get_interface(together, 0, 1, n, at, b), "gp_get_interface");
    if (rank == 0)
        check(gp_get_interface(alone, 0, 1, n, at, a), "gp_get_interface");
    for (int k = 0; k < n && rank == 0; ++k)
        equal(s, "interface", a[k], b[k]);
}

static void compare(const scene *s, gp_sim *alone, gp_sim *together) {
    static const uint32_t fields[] = {GP_FIELD_X,   GP_FIELD_Y,   GP_FIELD_VX,         GP_FIELD_VY,             GP_FIELD_PRESSURE,       GP_FIELD_DENSITY,
                                      GP_FIELD_SXX, GP_FIELD_SXY, GP_FIELD_SHEAR_RATE, GP_FIELD_NUMBER_DENSITY, GP_FIELD_FLUIDITY,       GP_FIELD_COLUMN};
    const gp_state b = state_of(together);
    const int64_t n = b.n_particles;
    double *theirs = malloc(sizeof(double) * (size_t)n), *ours = malloc(sizeof(double) * (size_t)n);
    for (size_t f = 0; f < sizeof fields / sizeof *fields; ++f) {
        check(gp_copy_field(together, fields[f], rank == 0 ? theirs : NULL, rank == 0 ? n : 0), "gp_copy_field");
        if (rank > 0)
            continue;
        check(gp_copy_field(alone, fields[f], ours, n), "gp_copy_field");
        for (int64_t k = 0; k < n; ++k)
            if (ours[k] != theirs[k]) {
                char what[64];
                snprintf(what, sizeof what, "step %lld, field 0x%x of %lld", (long long)b.step, (unsigned)fields[f], (long long)k);
                differ(s, what, ours[k], theirs[k]);
                break;
            }
    }
    free(theirs), free(ours);
    compare_shapes(s, alone, together, &b);
    if (rank > 0)
        return;
    const gp_state a = state_of(alone);
    const double scale = a.kinetic + a.potential + a.elastic + fabs(a.dissipated);
    EQUAL(time), EQUAL(step), EQUAL(dt), EQUAL(n_particles), EQUAL(n_awake), EQUAL(kinetic), EQUAL(potential), EQUAL(elastic);
    EQUAL(momentum_x), EQUAL(momentum_y), EQUAL(max_speed), EQUAL(rms_speed), EQUAL(x_left), EQUAL(x_right);
    EQUAL(peak_x), EQUAL(peak_height), EQUAL(max_pressure), EQUAL(at_rest), EQUAL(collisions), EQUAL(retries);
    EQUAL(max_compression), EQUAL(x_q05), EQUAL(x_q50), EQUAL(detached), EQUAL(volume_drift);
    EQUAL(implicit_newton), EQUAL(implicit_linear), EQUAL(implicit_last), EQUAL(implicit_failures), EQUAL(implicit_residual);
    CLOSE(dissipated), CLOSE(plate_work), CLOSE(wall_dissipated), CLOSE(bulk_dissipated), CLOSE(energy_error);
    compare_loads(s, alone, together);
}

static gp_plan_entry entry_of(gp_sim *sim, const char *name) {
    gp_plan_entry plan[128];
    int64_t n;
    check(gp_get_plan(sim, 128, plan, &n), "gp_get_plan");
    for (int64_t k = 0; k < n && k < 128; ++k)
        if (!strcmp(plan[k].name, name))
            return plan[k];
    fprintf(stderr, "the plan has no %s\n", name);
    MPI_Abort(MPI_COMM_WORLD, 2);
    return plan[0];
}

/* The plan knows of the particles that this process sees of others. */
static void check_images(const scene *s, gp_sim *together) {
    const gp_plan_entry images = entry_of(together, "images");
    if (rank == 0 && (!images.active || strcmp(images.reason, "other processes have particles, too")))
        differ(s, images.reason, 0, images.active);
    long long own = (long long)images.bytes, all = 0;
    MPI_Reduce(&own, &all, 1, MPI_LONG_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0 && ranks > 1 && s->has & IMAGES && all == 0)
        differ(s, "bytes of images", 0, 1);
}

static long run(const scene *s) {
    gp_sim *together = make(s, 0), *alone = NULL;
    /* gp_add_particles is each rank's own: all of them the first one's. */
    s->build(together);
    if (rank == 0) {
        alone = make(s, 1);
        s->build(alone);
    }
    for (int part = 0; part < 2; ++part) {
        const gp_status b = gp_step(together, s->steps / 2);
        if (rank == 0) {
            char text[1024];
            snprintf(text, sizeof text, "%s", gp_last_error());
            const gp_status a = gp_step(alone, s->steps / 2);
            if (a != b || (a < 0 && strcmp(gp_last_error(), text)))
                differ(s, text, a, b), puts(gp_last_error());
        }
        compare(s, alone, together);
        if (part == 0 && s->has & NEW_GRAVITY) {
            check(gp_set_gravity(together, 1.5, -9.6), "gp_set_gravity");
            if (rank == 0)
                check(gp_set_gravity(alone, 1.5, -9.6), "gp_set_gravity");
        }
    }
    check_images(s, together);
    const long cuts = (long)entry_of(together, "cuts").calls; /* more than one where the work has become uneven */
    gp_destroy(together);
    gp_destroy(alone);
    return cuts;
}

int main(int argc, char **argv) {
    int provided;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (argc > 2)
        threads = atoi(argv[2]);
    for (const scene *s = scenes; s->name; ++s)
        if (argc < 2 || !strcmp(argv[1], "all") || !strcmp(argv[1], s->name)) {
            const int before = failures;
            const long cuts = run(s);
            if (rank == 0 && failures == before)
                printf("%s on %d: equal, cut %ld times\n", s->name, ranks, cuts);
            fflush(stdout);
        }
    MPI_Bcast(&failures, 1, MPI_INT, 0, MPI_COMM_WORLD);
    MPI_Finalize();
    return failures > 0;
}
