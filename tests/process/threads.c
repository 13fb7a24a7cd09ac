/* A host with threads of its own: simulations in several of them at once have the bits that they have alone, also where the
 * stack of a thread is 256 KiB; says how much of it was used. */
#define _GNU_SOURCE
#include "scene.h"

#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

enum { STACK = 256 * 1024, PAINT = 0xa5, HOSTS = 2 };

typedef struct task {
    int scheme, threads;
    uint64_t hash;
    const char *directory;
} task;

static void *run(void *argument) {
    task *t = (task *)argument;
    t->hash = run_scene(t->scheme, t->threads);
    return NULL;
}

/* The same with result file and checkpoint, which need stack, too. */
static void *run_with_files(void *argument) {
    task *t = (task *)argument;
    gp_sim *sim = make_scene(t->scheme, t->threads), *loaded = NULL;
    char path[4096];
    snprintf(path, sizeof path, "%s/threads.h5", t->directory);
    require(gp_output_open(sim, path, NULL) == GP_OK, "gp_output_open");
    require(gp_step(sim, t->scheme == IMPLICIT_SCHEME ? 3 : 10) == GP_OK, "gp_step");
    require(gp_output_write(sim) == GP_OK, "gp_output_write");
    snprintf(path, sizeof path, "%s/threads.gpc", t->directory);
    require(gp_save(sim, path) == GP_OK, "gp_save");
    gp_destroy(sim);
    require(gp_load_file(path, &loaded) == GP_OK, "gp_load");
    t->hash = fingerprint(loaded);
    gp_destroy(loaded);
    return NULL;
}

/* Runs it on a painted stack with a page below it that must not be touched; returns how many bytes were used. */
static long on_small_stack(void *(*function)(void *), task *t) {
    const long page = sysconf(_SC_PAGESIZE);
    unsigned char *memory = (unsigned char *)mmap(NULL, STACK + (size_t)page, PROT_READ | PROT_WRITE,
                                                  MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    unsigned char *stack = memory + page;
    pthread_attr_t attributes;
    pthread_t thread;
    long clean = 0;
    require(memory != MAP_FAILED && mprotect(memory, (size_t)page, PROT_NONE) == 0, "mmap");
    memset(stack, PAINT, STACK);
    pthread_attr_init(&attributes);
    require(pthread_attr_setstack(&attributes, stack, STACK) == 0, "pthread_attr_setstack");
    require(pthread_create(&thread, &attributes, function, t) == 0, "pthread_create");
    pthread_join(thread, NULL);
    pthread_attr_destroy(&attributes);
    while (clean < STACK && stack[clean] == PAINT)
        ++clean;
    munmap(memory, STACK + (size_t)page);
    return STACK - clean;
}

int main(int argc, char **argv) {
    const char *directory = argc > 1 ? argv[1] : ".";
    uint64_t alone[SCHEMES];
    int scheme, other, threads, k, pairs = 0;
    long deepest = 0;
    for (scheme = 0; scheme < SCHEMES; ++scheme)
        alone[scheme] = run_scene(scheme, 1);
    for (scheme = 0; scheme < SCHEMES; ++scheme)
        for (other = scheme; other < SCHEMES; ++other)
            for (threads = 1; threads <= 2; ++threads) {
                pthread_t hosts[HOSTS];
                task tasks[HOSTS];
                for (k = 0; k < HOSTS; ++k) {
                    tasks[k].scheme = k == 0 ? scheme : other;
                    tasks[k].threads = threads;
                    require(pthread_create(&hosts[k], NULL, run, &tasks[k]) == 0, "pthread_create");
                }
                for (k = 0; k < HOSTS; ++k)
                    pthread_join(hosts[k], NULL);
                require(tasks[0].hash == alone[scheme] && tasks[1].hash == alone[other],
                        "two simulations at once have other bits than alone");
                ++pairs;
            }
    for (scheme = 0; scheme < SCHEMES; ++scheme)
        for (threads = 1; threads <= 2; ++threads) {
            task t;
            long used;
            t.scheme = scheme, t.threads = threads, t.directory = directory;
            used = on_small_stack(gp_has_feature("hdf5") ? run_with_files : run, &t);
            require(t.hash == alone[scheme], "other bits on a small stack");
            deepest = used > deepest ? used : deepest;
        }
    printf("%d pairs of simulations at once: the bits that they have alone; %ld KiB of a stack of %d KiB used\n", pairs,
           (deepest + 1023) / 1024, STACK / 1024);
    return 0;
}
