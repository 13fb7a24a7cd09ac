/* What has to happen between two steps without the interpreter: the library calls this after every step, and Python
 * is only entered when there is something to do. So steps run without the GIL, and Ctrl-C stops after the present one. */
#include <signal.h>
#include <string.h>
#include <time.h>

typedef struct granperi_watch {
    int64_t step;
    int64_t every;
    double interval;
    double next;
    int32_t attention;
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

enum { GRANPERI_CALLBACK = 1, GRANPERI_LOOK = 2 };

static int32_t granperi_after_step(void *user, gp_sim *sim) {
    granperi_watch *watch = (granperi_watch *)user;
    int32_t due = 0;
    (void)sim;
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
    if (!due)
        return 0;
    watch->attention = 0;
    if (watch->interrupts)
        granperi_interrupted = 0;
    return granperi_look(watch->self, due);
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
