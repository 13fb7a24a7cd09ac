/* Runs that are saved by some processes and gone on with by others end as the unbroken run of one process does.
 *
 *   restarts make SCENE STEPS FILE     [on any number of processes] a scene from its beginning
 *   restarts go_on FILE STEPS FILE     another stretch, on any number
 *   restarts alone FILE STEPS FILE     the same by the functions for one process
 *   restarts compare FILE FILE         1 if the states differ
 *   restarts saves FILE STEPS FILE     on any number: from the first, saves every so many steps to the second, 40 times, and that
 *                                      again and again until it is killed; to STEP.h5 in a directory, whose name ends with a /,
 *                                      only once
 *   restarts whole FILE DIRECTORY/     1 if the state is not that of the same step there
 *   restarts threads FILE              1 if several threads are not refused by an MPI begun without any; writes the file
 *   restarts warnings                  on any number: 1 if a scene full of mistakes has not the same warnings as by one process */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <granperi/gp_mpi.h>

static void check(gp_status status) {
    if (status < 0) {
        fprintf(stderr, "restarts: %s\n", gp_last_error());
        MPI_Abort(MPI_COMM_WORLD, 2);
    }
}

/* A bed that sleeps when a block has nearly come down to it. */
static void build_bed(gp_sim *sim) {
    gp_column column;
    gp_plate plate;
    check(gp_column_init(&column, sizeof column));
    column.width = 0.24, column.height = 0.04;
    check(gp_add_column(sim, &column, NULL));
    column.x_min = 0.1, column.y_min = 0.3, column.width = column.height = 0.032;
    check(gp_add_column(sim, &column, NULL));
    const double at[][4] = {{0.24, 0, 0, 0}, {0, 0, 0, 1}, {0.24, 1, 0.24, 0}};
    for (int k = 0; k < 3; ++k) {
        check(gp_plate_init(&plate, sizeof plate));
        plate.x0 = at[k][0], plate.y0 = at[k][1], plate.x1 = at[k][2], plate.y1 = at[k][3];
        check(gp_add_plate(sim, &plate, NULL));
    }
}

static void build(gp_sim *sim, const char *scene) {
    if (!strcmp(scene, "sleep")) {
        build_bed(sim);
        return;
    }
    gp_column column;
    gp_plate plate;
    check(gp_column_init(&column, sizeof column));
    check(gp_plate_init(&plate, sizeof plate));
    column.x_min = 0.01, column.width = 0.12, column.height = 0.06, column.vx = 0.3;
    const int blow = !strcmp(scene, "blow"), periodic = !blow && strcmp(scene, "gate") != 0;
    if (blow) /* strikes the floor after some 50 steps, and diverges */
        column.y_min = 0.1, column.vy = -2;
    check(gp_add_column(sim, &column, NULL));
    plate.x0 = periodic ? 0.16 : 1, plate.x1 = periodic ? 0 : -1;
    check(gp_add_plate(sim, &plate, NULL));
    if (periodic) { /* two sets of particles on top, all of them the first process's */
        int rank;
        double x[20], y[20], v[20];
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        for (int set = 0; set < 2; ++set) {
            for (int k = 0; k < 20; ++k)
                x[k] = 0.03 + 0.004 * k, y[k] = 0.063 + 0.004 * set, v[k] = 0.1 * set;
            check(gp_add_particles(sim, 0, rank == 0 ? 20 : 0, x, y, v, v, NULL));
        }
        return;
    }
    if (blow)
        return;
    /* A gate that is lifted and a lid that falls. */
    static const double t[] = {0, 0.02, 0.1}, x[] = {0, 0, 0}, y[] = {0, 0.005, 0.2};
    plate.x0 = plate.x1 = 0.13, plate.y0 = 0.2, plate.n_knots = 3, plate.knot_t = t, plate.knot_x = x, plate.knot_y = y;
    check(gp_add_plate(sim, &plate, NULL));
    check(gp_plate_init(&plate, sizeof plate));
    plate.x0 = 0.0, plate.x1 = 0.12, plate.y0 = plate.y1 = 0.065, plate.normal_pressure = 50;
    check(gp_add_plate(sim, &plate, NULL));
}

/* What is counted and decided is the same on any number of processes; sums of floating numbers may differ in their last
   bits. */
static int compare_states(const gp_state *a, const gp_state *b) {
    const struct {
        const char *name;
        int64_t of[2];
    } counts[] = {
        {"step", {a->step, b->step}},
        {"n_particles", {a->n_particles, b->n_particles}},
        {"n_awake", {a->n_awake, b->n_awake}},
        {"at_rest", {a->at_rest, b->at_rest}},
        {"collisions", {a->collisions, b->collisions}},
        {"retries", {a->retries, b->retries}},
        {"dt_reason", {a->dt_reason, b->dt_reason}},
    };
    int different = 0;
    for (size_t k = 0; k < sizeof counts / sizeof counts[0]; ++k)
        if (counts[k].of[0] != counts[k].of[1]) {
            printf("%s: %lld, %lld\n", counts[k].name, (long long)counts[k].of[0], (long long)counts[k].of[1]);
            different = 1;
        }
    if (a->time != b->time || a->dt != b->dt) {
        printf("time: %.17g, %.17g; dt: %.17g, %.17g\n", a->time, b->time, a->dt, b->dt);
        different = 1;
    }
    return different;
}

static int compare(const char *a, const char *b) {
    gp_sim *sims[2];
    gp_state states[2];
    const char *files[] = {a, b};
    for (int k = 0; k < 2; ++k) {
        check(gp_load(files[k], &sims[k]));
        memset(&states[k], 0, sizeof states[k]);
        states[k].struct_size = sizeof states[k];
        check(gp_get_state(sims[k], &states[k]));
    }
    int different = compare_states(&states[0], &states[1]);
    const int64_t n = states[0].n_particles;
    if (n != states[1].n_particles)
        return 1;
    double *values[2] = {malloc(sizeof(double) * (size_t)n), malloc(sizeof(double) * (size_t)n)};
    for (uint32_t bit = 1; bit <= GP_FIELD_ALL; bit <<= 1)
        if (bit & GP_FIELD_ALL) {
            for (int k = 0; k < 2; ++k)
                check(gp_copy_field(sims[k], bit, values[k], n));
            for (int64_t i = 0; i < n; ++i)
                if (values[0][i] != values[1][i]) {
                    printf("field 0x%x of %lld: %.17g, %.17g\n", (unsigned)bit, (long long)i, values[0][i],
                           values[1][i]);
                    different = 1;
                    break;
                }
        }
    for (int32_t plate = 0;; ++plate) {
        gp_load loads[2];
        memset(loads, 0, sizeof loads);
        loads[0].struct_size = loads[1].struct_size = sizeof loads[0];
        if (gp_get_plate_load(sims[0], plate, &loads[0]) < 0)
            break;
        check(gp_get_plate_load(sims[1], plate, &loads[1]));
        different |= memcmp(&loads[0], &loads[1], sizeof loads[0]) != 0;
    }
    return different;
}

static void save_often(const char *from, long steps, const char *to) {
    const size_t length = strlen(to);
    const int once = length > 0 && to[length - 1] == '/';
    do {
        gp_sim *sim;
        check(gp_load_mpi(from, MPI_COMM_WORLD, &sim));
        for (int k = 0; k < 40; ++k) {
            char path[1024];
            int64_t step;
            check(gp_step(sim, steps));
            check(gp_get_clock(sim, NULL, NULL, &step));
            snprintf(path, sizeof path, "%s%lld.h5", to, (long long)step);
            check(gp_save(sim, once ? path : to));
        }
        gp_destroy(sim);
    } while (!once);
}

static int whole(const char *file, const char *directory) {
    char path[1024];
    gp_sim *sim;
    int64_t step;
    check(gp_load(file, &sim));
    check(gp_get_clock(sim, NULL, NULL, &step));
    gp_destroy(sim);
    snprintf(path, sizeof path, "%s%lld.h5", directory, (long long)step);
    return compare(file, path);
}

static void keep(void *text, int32_t level, const char *message) {
    (void)level;
    strncat(text, message, 8000 - strlen(text) - 1);
    strncat(text, "\n", 8000 - strlen(text) - 1);
}

/* Material behind plates, on their lines, across them, twice in one place, and one column that nothing bears. */
static void warn(gp_sim *sim, int periodic, char *text) {
    gp_column column;
    gp_plate plate;
    check(gp_column_init(&column, sizeof column));
    check(gp_plate_init(&plate, sizeof plate));
    column.width = 0.12, column.height = 0.06;
    check(gp_add_column(sim, &column, NULL));
    column.x_min = 0.1015, column.y_min = 0.021, column.width = 0.04;
    check(gp_add_column(sim, &column, NULL));
    column.x_min = 0.17, column.y_min = 0.2, column.width = 0.02;
    check(gp_add_column(sim, &column, NULL));
    plate.x0 = periodic ? 0.16 : 0.15, plate.x1 = periodic ? 0 : -0.1;
    check(gp_add_plate(sim, &plate, NULL));
    plate.x0 = plate.x1 = 0.05, plate.y0 = -0.01, plate.y1 = 0.09;
    check(gp_add_plate(sim, &plate, NULL));
    plate.x0 = 0.05, plate.x1 = 0.1, plate.y0 = plate.y1 = 0.062;
    check(gp_add_plate(sim, &plate, NULL));
    *text = 0;
    check(gp_set_log(sim, keep, text));
    check(gp_step(sim, 1));
    gp_destroy(sim);
}

static int warnings(void) {
    static char together[8000], alone[8000];
    int different = 0, rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    for (int periodic = 0; periodic < 2; ++periodic) {
        gp_config config;
        gp_sim *sim;
        check(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
        config.spacing = 0.004, config.jitter = 0.1, config.threads = 1, config.periodic_x_max = periodic ? 0.2 : 0;
        check(gp_create_mpi(&config, MPI_COMM_WORLD, &sim));
        warn(sim, periodic, together);
        if (rank > 0)
            continue;
        check(gp_create(&config, &sim));
        warn(sim, periodic, alone);
        if (strcmp(alone, together) || !strstr(alone, "column") || !strstr(alone, "pairs of particles"))
            printf("alone:\n%stogether:\n%s", alone, together), different = 1;
        else if (getenv("GRANPERI_TELL"))
            printf("%s", alone);
    }
    return different;
}

static int refused(gp_status status, gp_sim *const *sim) {
    const int good = status == GP_E_STATE && !*sim && strstr(gp_last_error(), "MPI_THREAD_FUNNELED");
    if (!good)
        printf("status %d: %s\n", (int)status, gp_last_error());
    return good;
}

static int refuse_threads(const char *path) {
    gp_config config;
    gp_sim *sim;
    int provided, rank, good;
    MPI_Query_thread(&provided);
    if (provided != MPI_THREAD_SINGLE) /* as an environment variable may ask for */
        return 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
    config.threads = 0;
    if (rank == 0) {
        check(gp_create(&config, &sim));
        check(gp_save(sim, path));
        gp_destroy(sim);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    good = refused(gp_load_mpi(path, MPI_COMM_WORLD, &sim), &sim);
    good = refused(gp_create_mpi(&config, MPI_COMM_WORLD, &sim), &sim) && good;
    config.threads = 2;
    return !(refused(gp_create_mpi(&config, MPI_COMM_WORLD, &sim), &sim) && good);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv); /* without threads */
    int rank, result = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const char *mode = argc > 1 ? argv[1] : "";
    if (!strcmp(mode, "compare") && argc == 4) {
        result = compare(argv[2], argv[3]);
    } else if (!strcmp(mode, "whole") && argc == 4) {
        result = whole(argv[2], argv[3]);
    } else if (!strcmp(mode, "threads") && argc == 3) {
        result = refuse_threads(argv[2]);
    } else if (!strcmp(mode, "warnings")) {
        result = warnings();
    } else if (!strcmp(mode, "saves") && argc == 5) {
        save_often(argv[2], atol(argv[3]), argv[4]);
    } else if (argc == 5) {
        gp_sim *sim;
        if (!strcmp(mode, "make")) {
            gp_config config;
            check(gp_config_init(&config, sizeof config, GP_PRESET_DEFAULT));
            config.spacing = 0.004, config.jitter = 0.1, config.threads = 1;
            if (!strcmp(argv[2], "blow"))
                config.sound_speed = 4, config.time_step = 0.0008, config.allow_unstable_step = 1;
            else if (strcmp(argv[2], "gate") != 0 && strcmp(argv[2], "sleep") != 0)
                config.periodic_x_max = 0.16, config.gravity_x = 4;
            if (!strcmp(argv[2], "sleep"))
                config.sleep = 1, config.sound_speed = 12, config.jitter = 0;
            if (!strcmp(argv[2], "implicit"))
                config.stress = GP_STRESS_IMPLICIT;
            check(gp_create_mpi(&config, MPI_COMM_WORLD, &sim));
            build(sim, argv[2]);
        } else if (!strcmp(mode, "alone")) {
            check(gp_load(argv[2], &sim));
        } else {
            check(gp_load_mpi(argv[2], MPI_COMM_WORLD, &sim));
        }
        check(gp_step(sim, atol(argv[3])));
        check(gp_save(sim, argv[4]));
        gp_destroy(sim);
    } else {
        fprintf(stderr, "restarts: see the head of restarts.c\n");
        result = 2;
    }
    MPI_Finalize();
    return result;
}
