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

#include <granperi/gp_mpi.h>

enum { EXIT_STOPPED = 75 }; /* EX_TEMPFAIL of sysexits.h: to be gone on with */

static const char help[] =
    "usage: mpirun -n N granperi-mpi FILE --end T [options]\n"
    "\n"
    "Takes the simulation that is saved in FILE (gp_save, Simulation.save, sim%save; also before its first step) on to\n"
    "time T on N processes.\n"
    "\n"
    "  --end T       s, the clock's time at which it ends\n"
    "  --output F    result file for frames\n"
    "  --every S     s, between frames [1/100 of the run]\n"
    "  --append      go on with the frames that F has\n"
    "  --save F      checkpoint at the end\n"
    "  --quiet       no progress\n"
    "\n"
    "SIGTERM or SIGUSR1 on any process: it saves and ends, with status 75. Without --save it saves to FILE.stopped.\n"
    "(mpirun itself answers SIGTERM by killing all; it hands SIGUSR1 on.)\n";

static struct {
    const char *file, *output, *save;
    double end, every;
    int append, quiet;
} options = {NULL, NULL, NULL, NAN, 0, 0, 0};

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
        } else if (!strcmp(a, "--quiet")) {
            options.quiet = 1;
        } else if (!strcmp(a, "--end")) {
            options.end = number(a, value), ++k;
        } else if (!strcmp(a, "--every")) {
            options.every = number(a, value), ++k;
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
    if ((options.every != 0 || options.append) && !options.output)
        fail("--every and --append are of --output, which is missing");
}

static void say(void *user, int32_t level, const char *text) {
    (void)user;
    fprintf(stderr, "granperi-mpi: %s%s\n", level == GP_LOG_WARNING ? "warning: " : "", text);
}

static double begin_time, begun, told;

static void tell(void) {
    double time, dt;
    int64_t step;
    gp_get_clock(sim, &time, &dt, &step);
    const double took = MPI_Wtime() - begun, share = (time - begin_time) / (options.end - begin_time);
    fprintf(stderr, "t = %.4g s of %.4g, step %lld, dt %.3g s; %.0f s so far%s", time, options.end, (long long)step, dt, took,
            share > 0.01 ? "" : "\n");
    if (share > 0.01)
        fprintf(stderr, ", %.0f s to go\n", took * (1 / share - 1));
}

/* All processes decide alike, whichever has got the signal. */
static int32_t after_steps(void *user, gp_sim *stepped) {
    (void)user, (void)stepped;
    int stop = asked_to_stop;
    MPI_Allreduce(MPI_IN_PLACE, &stop, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (rank == 0 && !options.quiet && MPI_Wtime() - told > 5) {
        told = MPI_Wtime();
        tell();
    }
    return stop;
}

int main(int argc, char **argv) {
    int provided;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    read_arguments(argc, argv);
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = ask_to_stop;
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGUSR1, &action, NULL);

    check(gp_load_mpi(options.file, MPI_COMM_WORLD, &sim));
    gp_set_log(sim, say, NULL);
    gp_get_clock(sim, &begin_time, NULL, NULL);
    if (!(options.end > begin_time))
        fail("--end %g: expected a time after that of %s, %g s", options.end, options.file, begin_time);
    if (options.output) {
        gp_output output;
        check(gp_output_init(&output, sizeof output));
        output.every_seconds = options.every != 0 ? options.every : (options.end - begin_time) / 100;
        output.append = options.append;
        check(gp_output_open(sim, options.output, &output));
    }
    begun = told = MPI_Wtime();
    check(gp_set_callback(sim, 20, after_steps, NULL));
    const gp_status status = gp_run(sim, options.end);
    check(status);
    if (rank == 0 && !options.quiet)
        tell();
    char stopped[4096];
    snprintf(stopped, sizeof stopped, "%s.stopped", options.file);
    const char *save = options.save ? options.save : status == GP_STOPPED ? stopped : NULL;
    if (save)
        check(gp_save(sim, save));
    if (status == GP_STOPPED && rank == 0)
        fprintf(stderr, "granperi-mpi: stopped by a signal, saved to %s\n", save);
    if (options.output)
        check(gp_output_close(sim));
    gp_destroy(sim);
    MPI_Finalize();
    return status == GP_STOPPED ? EXIT_STOPPED : 0;
}
