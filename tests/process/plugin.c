/* A host that loads the library, uses it with threads, and closes it, again and again.
 * usage: plugin LIBRARY ROUNDS    prints how many threads and how much memory more there are after the last round */
#define _GNU_SOURCE
#include <granperi/gp.h>

#include <dirent.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static int threads_now(void) {
    DIR *directory = opendir("/proc/self/task");
    int n = -2; /* . and .. */
    while (readdir(directory))
        ++n;
    closedir(directory);
    return n;
}

static long resident_kib(void) {
    long all = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%ld %ld", &all, &resident) != 2)
        exit(1);
    fclose(file);
    return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

#define CALL(name) (*(__typeof__(&name))dlsym(library, #name))

static int use(void *library) {
    gp_config config;
    gp_column column;
    gp_sim *sim = NULL;
    if (CALL(gp_config_init)(&config, sizeof config, GP_PRESET_DEFAULT))
        return 1;
    config.threads = 2;
    if (CALL(gp_create)(&config, &sim) || CALL(gp_column_init)(&column, sizeof column))
        return 2;
    column.width = 80 * config.spacing;
    column.height = 60 * config.spacing;
    if (CALL(gp_add_column)(sim, &column, NULL) || CALL(gp_step)(sim, 2))
        return 3;
    CALL(gp_destroy)(sim);
    return 0;
}

int main(int argc, char **argv) {
    const int flags[] = {RTLD_NOW | RTLD_LOCAL, RTLD_LAZY | RTLD_LOCAL, RTLD_NOW | RTLD_GLOBAL};
    const int rounds = argc > 2 ? atoi(argv[2]) : 9;
    int k, threads_then = 0;
    long memory_then = 0;
    for (k = 0; k < rounds; ++k) {
        void *library = dlopen(argv[1], flags[k % 3]);
        int problem;
        if (!library) {
            fprintf(stderr, "FAILED: dlopen: %s\n", dlerror());
            return 1;
        }
        if ((problem = use(library)) != 0) {
            fprintf(stderr, "FAILED: round %d, use %d: %s\n", k, problem, CALL(gp_last_error)());
            return 1;
        }
        if (dlclose(library)) {
            fprintf(stderr, "FAILED: dlclose: %s\n", dlerror());
            return 1;
        }
        if (k == 2) { /* by then all that is made once is there */
            threads_then = threads_now();
            memory_then = resident_kib();
        }
    }
    usleep(20000); /* threads that wait would step into what is gone */
    printf("%d times loaded, used with 2 threads, closed: %d threads more, %ld KiB more than after the third\n", rounds,
           threads_now() - threads_then, resident_kib() - memory_then);
    return threads_now() == threads_then ? 0 : 1;
}
