/* What has to happen between two steps without the interpreter: the library calls this after every step, and Python
 * is only entered when there is something to do. So steps run without the GIL, and Ctrl-C stops after the present one. */
#include <math.h>
#include <signal.h>
#include <string.h>
#include <time.h>

typedef struct granperi_watch {
    int64_t step;
    int64_t every;
    double interval;
    double next;
    int32_t attention;
    double due;
    int32_t rest_every;
    int32_t rested;
    int32_t interrupts;
    void *self;
} granperi_watch;

static int32_t granperi_look(void *self, int32_t due);
static void granperi_log(void *self, int32_t level, const char *text);

/* ------------------------------------------------------------------------------------------------- Ctrl-C */

/* Only the main thread of the interpreter changes these, but any thread may run the handler. */
static volatile sig_atomic_t granperi_interrupted;
static struct sigaction granperi_previous;
static int granperi_depth; /* runs inside the callbacks of other runs */

/* Python's handler first: when the flag is seen, the interpreter must already know. */
static void granperi_on_interrupt(int number, siginfo_t *info, void *context) {
    if (granperi_previous.sa_flags & SA_SIGINFO)
        granperi_previous.sa_sigaction(number, info, context);
    else
        granperi_previous.sa_handler(number);
    granperi_interrupted = 1;
}

static void granperi_begin(granperi_watch *watch, int32_t interrupts) {
    struct sigaction ours;
    watch->interrupts = interrupts;
    watch->next = 0;
    if (!interrupts || granperi_depth++ > 0)
        return;
    granperi_interrupted = 0;
    if (sigaction(SIGINT, NULL, &granperi_previous) != 0 ||
        (!(granperi_previous.sa_flags & SA_SIGINFO) &&
         (granperi_previous.sa_handler == SIG_DFL || granperi_previous.sa_handler == SIG_IGN)))
        return; /* nobody in Python is waiting for it */
    memset(&ours, 0, sizeof ours);
    ours.sa_sigaction = granperi_on_interrupt;
    ours.sa_mask = granperi_previous.sa_mask;
    ours.sa_flags = granperi_previous.sa_flags | SA_SIGINFO;
    sigaction(SIGINT, &ours, NULL);
}

static void granperi_end(int32_t interrupts) {
    struct sigaction now;
    if (!interrupts || --granperi_depth > 0)
        return;
    /* A callback may have set another handler: that one stays. */
    if (sigaction(SIGINT, NULL, &now) == 0 && (now.sa_flags & SA_SIGINFO) && now.sa_sigaction == granperi_on_interrupt)
        sigaction(SIGINT, &granperi_previous, NULL);
}

/* -------------------------------------------------------------------------------------------------- steps */

enum { GRANPERI_CALLBACK = 1, GRANPERI_LOOK = 2, GRANPERI_TIME = 4 };

/* As the library does it for gp_output.every_seconds: a step that ends within rounding of the time has reached it. */
static int granperi_has_reached(gp_sim *sim, double due) {
    double time, dt;
    return due < HUGE_VAL && gp_get_clock(sim, &time, &dt, NULL) >= 0 && time + 1e-9 * dt >= due;
}

/* Energies and rest alone cost 5 % of a step. */
static int granperi_is_at_rest(gp_sim *sim) {
    gp_state state;
    state.struct_size = sizeof state;
    return gp_get_state_parts(sim, 0, &state) >= 0 && state.at_rest;
}

static int32_t granperi_after_step(void *user, gp_sim *sim) {
    granperi_watch *watch = (granperi_watch *)user;
    int32_t due = 0;
    ++watch->step;
    if (watch->every > 0 && watch->step % watch->every == 0)
        due |= GRANPERI_CALLBACK;
    if (watch->attention || (watch->interrupts && granperi_interrupted))
        due |= GRANPERI_LOOK;
    if (watch->interval > 0) {
        struct timespec now;
        double seconds;
        clock_gettime(CLOCK_MONOTONIC, &now);
        seconds = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
        if (watch->next == 0)
            watch->next = seconds + watch->interval;
        else if (seconds >= watch->next) {
            watch->next = seconds + watch->interval;
            due |= GRANPERI_LOOK;
        }
    }
    if (granperi_has_reached(sim, watch->due))
        due |= GRANPERI_TIME;
    if (watch->rest_every > 0 && watch->step % watch->rest_every == 0)
        watch->rested = granperi_is_at_rest(sim);
    if (!due)
        return watch->rested;
    watch->attention = 0;
    if (watch->interrupts)
        granperi_interrupted = 0;
    return granperi_look(watch->self, due) || watch->rested;
}

static gp_status granperi_attach(gp_sim *sim, granperi_watch *watch) {
    const gp_status status = gp_set_log(sim, granperi_log, watch->self);
    return status < 0 ? status : gp_set_callback(sim, 1, granperi_after_step, watch);
}

static gp_status granperi_step(gp_sim *sim, granperi_watch *watch, int64_t n, int32_t interrupts) {
    gp_status status;
    granperi_begin(watch, interrupts);
    status = gp_step(sim, n);
    granperi_end(interrupts);
    return status;
}

static gp_status granperi_run(gp_sim *sim, granperi_watch *watch, double t_end, int32_t interrupts) {
    gp_status status;
    granperi_begin(watch, interrupts);
    status = gp_run(sim, t_end);
    granperi_end(interrupts);
    return status;
}
