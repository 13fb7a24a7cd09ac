typedef struct granperi_watch {
    int64_t step;       /* steps seen so far */
    int64_t every;      /* Python's callback is due when step is a multiple of it; 0: there is none */
    double interval;    /* s of wall-clock time between looks (progress, signals without a C handler); 0: no looks */
    double next;        /* when the next look is due */
    int32_t attention;  /* 1: look after this step (the library has said something) */
    double due;         /* s of simulated time: look after the first step at or past it; HUGE_VAL: never */
    int32_t rest_every; /* > 0: after each step whose number is a multiple of it, stop if the material is at rest */
    int32_t rested;     /* 1: that has stopped the run */
    int32_t interrupts; /* 1: this run is one that Ctrl-C stops */
    void *self;         /* handle of the Python object */
} granperi_watch;

gp_status granperi_attach(gp_sim *sim, granperi_watch *watch);
gp_status granperi_step(gp_sim *sim, granperi_watch *watch, int64_t n, int32_t interrupts);
gp_status granperi_run(gp_sim *sim, granperi_watch *watch, double t_end, int32_t interrupts);

extern "Python" {
    int32_t granperi_look(void *self, int32_t due);
    void granperi_log(void *self, int32_t level, const char *text);
}
