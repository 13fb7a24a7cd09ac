/* granperi-mpi FILE --end T: takes a simulation that any program has saved (gp_save, also before its first step) on to time T,
 * on all processes of MPI. --help says more. */
#define _POSIX_C_SOURCE 200809L

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <granperi/gp_mpi.h>

enum { EXIT_STOPPED = 75 }; /* EX_TEMPFAIL of sysexits.h: to be gone on with */

static const char help[] =
    "usage: mpirun -n N granperi-mpi FILE --end T [options]\n"
    "\n"
    "Takes the simulation that is saved in FILE (gp_save, Simulation.save, sim%save; also before its first step) on\n"
    "to time T on N processes.\n"
    "\n"
    "  --end T         s, the clock's time at which it ends\n"
    "  --output F      result file for frames; one that exists is replaced at the start\n"
    "  --every S       s, between frames [1/100 of the run]\n"
    "  --fields LIST   what is in them, with commas [velocity,pressure,shear_rate,column]; also density, stress,\n"
    "                  inertial_number, viscosity, number_density, fluidity, all\n"
    "  --end-frame     a frame at the end, too, where it is no multiple of S\n"
    "  --append        go on with the frames that F has\n"
    "  --save F        checkpoint at the end\n"
    "  --checkpoint S  s of wall-clock time, between checkpoints to the same file on the way [none]\n"
    "  --quiet         no progress\n"
    "\n"
    "SIGTERM or SIGUSR1 on any process: it saves and ends, with status 75. Without --save it saves to FILE.stopped.\n"
    "(mpirun itself answers SIGTERM by killing all; it hands SIGUSR1 on.)\n"
    "\n"
    "An error on the way: it saves the last good step likewise, and ends with status 2. Where the file of --save\n"
    "cannot be written, or a step has diverged and that file exists, it saves to FILE.stopped.\n";

static struct {
    const char *file, *output, *save;
    double end, every, checkpoint; /* NaN: not given */
    int append, end_frame, quiet;
    uint32_t fields; /* 0: not given */
} options = {NULL, NULL, NULL, NAN, NAN, NAN, 0, 0, 0, 0};

static const struct {
    const char *name;
    uint32_t bits;
} field_names[] = {
    {"id", GP_FIELD_ID},
    {"column", GP_FIELD_COLUMN},
    {"x", GP_FIELD_X},
    {"y", GP_FIELD_Y},
    {"position", GP_FIELD_POSITION},
    {"vx", GP_FIELD_VX},
    {"vy", GP_FIELD_VY},
    {"velocity", GP_FIELD_VELOCITY},
    {"pressure", GP_FIELD_PRESSURE},
    {"density", GP_FIELD_DENSITY},
    {"sxx", GP_FIELD_SXX},
    {"sxy", GP_FIELD_SXY},
    {"syy", GP_FIELD_SYY},
    {"stress", GP_FIELD_SXX | GP_FIELD_SXY | GP_FIELD_SYY},
    {"shear_rate", GP_FIELD_SHEAR_RATE},
    {"inertial_number", GP_FIELD_INERTIAL_NUMBER},
    {"viscosity", GP_FIELD_VISCOSITY},
    {"number_density", GP_FIELD_NUMBER_DENSITY},
    {"fluidity", GP_FIELD_FLUIDITY},
    {"all", GP_FIELD_ALL},
};

static int rank, ranks;
static gp_sim *sim;
static volatile sig_atomic_t asked_to_stop;

static void ask_to_stop(int signal_number) {
    (void)signal_number;
    asked_to_stop = 1;
}

/* The same on every process, which all end: one of them says it. */
static void fail(const char *format, ...) {
    if (rank == 0) {
        va_list values;
        va_start(values, format);
        fputs("granperi-mpi: ", stderr);
        vfprintf(stderr, format, values);
        fputc('\n', stderr);
        va_end(values);
    }
    gp_destroy(sim);
    MPI_Finalize();
    exit(2);
}

static void check(gp_status status) {
    if (status < 0)
        fail("%s", gp_last_error());
}

static double number(const char *option, const char *text) {
    char *end;
    errno = 0;
    const double value = text ? strtod(text, &end) : NAN;
    if (!text || end == text || *end || errno || !isfinite(value))
        fail("%s %s: expected a number", option, text ? text : "");
    return value;
}

static double above_0(const char *option, const char *text) {
    const double value = number(option, text);
    if (!(value > 0))
        fail("%s %s: expected a number above 0", option, text);
    return value;
}

static uint32_t fields(const char *option, const char *text) {
    uint32_t bits = 0;
    for (const char *name = text ? text : ""; name;) {
        const size_t length = strcspn(name, ",");
        size_t k = 0;
        while (k < sizeof field_names / sizeof *field_names &&
               (strlen(field_names[k].name) != length || strncmp(field_names[k].name, name, length) != 0))
            ++k;
        if (k == sizeof field_names / sizeof *field_names)
            fail("%s %s: there is no field '%.*s'; --help names them", option, text ? text : "", (int)length, name);
        bits |= field_names[k].bits;
        name = name[length] ? name + length + 1 : NULL;
    }
    return bits;
}

static void read_arguments(int argc, char **argv) {
    for (int k = 1; k < argc; ++k) {
        const char *a = argv[k], *value = k + 1 < argc ? argv[k + 1] : NULL;
        if (!strcmp(a, "--help")) {
            if (rank == 0)
                fputs(help, stdout);
            MPI_Finalize();
            exit(0);
        } else if (!strcmp(a, "--append")) {
            options.append = 1;
        } else if (!strcmp(a, "--end-frame")) {
            options.end_frame = 1;
        } else if (!strcmp(a, "--fields")) {
            options.fields = fields(a, value), ++k;
        } else if (!strcmp(a, "--quiet")) {
            options.quiet = 1;
        } else if (!strcmp(a, "--end")) {
            options.end = number(a, value), ++k;
        } else if (!strcmp(a, "--every")) {
            options.every = above_0(a, value), ++k;
        } else if (!strcmp(a, "--checkpoint")) {
            options.checkpoint = above_0(a, value), ++k;
        } else if (!strcmp(a, "--output") || !strcmp(a, "--save")) {
            if (!value)
                fail("%s: expected a file", a);
            *(a[2] == 'o' ? &options.output : &options.save) = value, ++k;
        } else if (a[0] == '-' && a[1]) {
            fail("%s: no such option; --help names them", a);
        } else if (options.file) {
            fail("%s: one file is given already, %s", a, options.file);
        } else {
            options.file = a;
        }
    }
    if (!options.file)
        fail("no file given; --help says what is needed");
    if (isnan(options.end))
        fail("--end is missing: the time at which the run ends, in s");
    if ((!isnan(options.every) || options.append || options.end_frame || options.fields) && !options.output)
        fail("--every, --fields, --end-frame and --append are of --output, which is missing");
    if (!isnan(options.checkpoint) && !options.save)
        fail("--checkpoint is of --save, which is missing");
}

/* What the first process finds, on all. */
static int of_first(int value) {
    MPI_Bcast(&value, 1, MPI_INT, 0, MPI_COMM_WORLD);
    return value;
}

/* Before the work that is to be saved there. */
static void require_place(const char *path) {
    char directory[4096];
    struct stat there;
    int error = 0;
    snprintf(directory, sizeof directory, "%s", path);
    char *slash = strrchr(directory, '/');
    if (!slash)
        snprintf(directory, sizeof directory, ".");
    else
        slash[slash == directory] = '\0';
    if (rank == 0 && stat(path, &there) == 0 && S_ISDIR(there.st_mode))
        error = EISDIR;
    else if (rank == 0 && (stat(directory, &there) != 0 || access(directory, W_OK | X_OK) != 0))
        error = errno;
    else if (rank == 0 && !S_ISDIR(there.st_mode))
        error = ENOTDIR;
    error = of_first(error);
    if (error)
        fail("--save %s: cannot be written: %s", path, strerror(error));
}

static void say(void *user, int32_t level, const char *text) {
    (void)user;
    fprintf(stderr, "granperi-mpi: %s%s\n", level == GP_LOG_WARNING ? "warning: " : "", text);
}

static double begin_time, begun, told, saved;

static void tell(void) {
    double time, dt;
    int64_t step;
    gp_get_clock(sim, &time, &dt, &step);
    const double took = MPI_Wtime() - begun, share = (time - begin_time) / (options.end - begin_time);
    fprintf(stderr, "t = %.4g s of %.4g, step %lld, dt %.3g s; %.0f s so far%s", time, options.end, (long long)step, dt,
            took, share > 0.01 ? "" : "\n");
    if (share > 0.01)
        fprintf(stderr, ", %.0f s to go\n", took * (1 / share - 1));
}

/* All processes decide alike, whichever has got the signal. */
static int32_t after_steps(void *user, gp_sim *stepped) {
    (void)user;
    int due[2] = {asked_to_stop, 0}; /* to stop, to save */
    if (rank == 0)
        due[1] = MPI_Wtime() - saved > options.checkpoint; /* not if that is NaN */
    MPI_Allreduce(MPI_IN_PLACE, due, 2, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (rank == 0 && !options.quiet && MPI_Wtime() - told > 5) {
        told = MPI_Wtime();
        tell();
    }
    if (due[1] && !due[0]) {
        if (gp_save(stepped, options.save) < 0 && rank == 0) /* the end will try again */
            fprintf(stderr, "granperi-mpi: warning: no checkpoint: %s\n", gp_last_error());
        saved = MPI_Wtime();
    }
    return due[0];
}

static char stopped[4096 + 16]; /* FILE.stopped */

/* After an error in the run: nothing that was computed is lost, nor a checkpoint from which it could go on. */
static void fail_saved(gp_status status, int64_t begin_step) {
    char error[1024];
    int64_t step;
    snprintf(error, sizeof error, "%s", gp_last_error());
    gp_get_clock(sim, NULL, NULL, &step);
    if (!of_first(step > begin_step))
        fail("%s", error);
    const int kept = status == GP_E_DIVERGED && options.save && of_first(access(options.save, F_OK) == 0);
    if (options.save && !kept && gp_save(sim, options.save) >= 0)
        fail("%s; the last good step is saved to %s", error, options.save);
    if (gp_save(sim, stopped) >= 0)
        fail("%s; the last good step is saved to %s", error, stopped);
    fail("%s; nothing is saved", error);
}

/* Unless the last step has reached a multiple, which has its frame. */
static gp_status write_end_frame(void) {
    double time, dt;
    gp_get_clock(sim, &time, &dt, NULL);
    const double rounding = 1e-9 * dt, due = options.every * (floor((time - dt + rounding) / options.every) + 1);
    return time + rounding >= due ? GP_OK : gp_output_write(sim);
}

/* The end of the run, or where it has been stopped; to where, or NULL. */
static const char *save_end(gp_status status) {
    if (!options.save && status != GP_STOPPED)
        return NULL;
    const char *to = options.save ? options.save : stopped;
    if (gp_save(sim, to) >= 0)
        return to;
    char error[1024];
    snprintf(error, sizeof error, "%s", gp_last_error());
    if (to != stopped && gp_save(sim, stopped) >= 0)
        fail("%s; saved to %s instead of %s", error, stopped, to);
    fail("%s; nothing is saved", error);
    return NULL;
}

int main(int argc, char **argv) {
    int provided;
    struct sigaction action; /* first: it may come at any time */
    memset(&action, 0, sizeof action);
    action.sa_handler = ask_to_stop;
    action.sa_flags = SA_RESTART;
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGUSR1, &action, NULL);
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    read_arguments(argc, argv);
    if (options.save)
        require_place(options.save);
    if (strlen(options.file) > sizeof stopped - 16)
        fail("%s: the name is too long", options.file);
    snprintf(stopped, sizeof stopped, "%s.stopped", options.file);

    int64_t begin_step;
    check(gp_load_mpi(options.file, MPI_COMM_WORLD, &sim));
    gp_set_log(sim, say, NULL);
    gp_get_clock(sim, &begin_time, NULL, &begin_step);
    if (!(options.end > begin_time))
        fail("--end %g: expected a time after that of %s, %g s", options.end, options.file, begin_time);
    if (options.output) {
        gp_output output;
        check(gp_output_init(&output, sizeof output));
        if (isnan(options.every))
            options.every = (options.end - begin_time) / 100;
        output.every_seconds = options.every;
        output.append = options.append;
        if (options.fields)
            output.fields = options.fields;
        check(gp_output_open(sim, options.output, &output));
    }
    begun = told = saved = MPI_Wtime();
    check(gp_set_callback(sim, 20, after_steps, NULL));
    gp_status status = gp_run(sim, options.end);
    if (status == GP_OK && options.end_frame)
        status = write_end_frame();
    if (status < 0)
        fail_saved(status, begin_step);
    if (rank == 0 && !options.quiet)
        tell();
    const char *save = save_end(status);
    if (status == GP_STOPPED && rank == 0)
        fprintf(stderr, "granperi-mpi: stopped by a signal, saved to %s\n", save);
    if (options.output)
        check(gp_output_close(sim));
    gp_destroy(sim);
    MPI_Finalize();
    return status == GP_STOPPED ? EXIT_STOPPED : 0;
}
