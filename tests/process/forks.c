/* A host that forks. Children forked before and after the library has used threads have the same bits as the parent; so do
 * those that only replace themselves (exec). usage: forks [again] */
#define _GNU_SOURCE
#include "scene.h"

#include <sys/wait.h>
#include <unistd.h>

/* The child's fingerprint, with this many threads; 0 if it fails. With program, by exec of that. */
static uint64_t in_child(int threads, const char *program) {
    int ends[2], status = 0;
    uint64_t hash = 0;
    pid_t child;
    require(pipe(ends) == 0, "pipe");
    child = fork();
    require(child >= 0, "fork");
    if (child == 0) {
        alarm(60); /* one that waits for ever is to be seen */
        if (program) {
            dup2(ends[1], STDOUT_FILENO);
            execl(program, program, "again", (char *)NULL);
            _exit(1);
        }
        hash = run_scene(DEFAULT_SCHEME, threads);
        _exit(write(ends[1], &hash, sizeof hash) != (ssize_t)sizeof hash);
    }
    close(ends[1]);
    if (read(ends[0], &hash, sizeof hash) != (ssize_t)sizeof hash)
        hash = 0;
    close(ends[0]);
    waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? hash : 0;
}

int main(int argc, char **argv) {
    uint64_t before, parent;
    int threads, children = 0;
    if (argc > 1) {
        parent = run_scene(DEFAULT_SCHEME, 3);
        return fwrite(&parent, sizeof parent, 1, stdout) != 1;
    }
    before = in_child(3, NULL);
    parent = run_scene(DEFAULT_SCHEME, 3);
    require(before == parent, "a child forked before the first use");
    for (threads = 1; threads <= 3; ++threads, ++children)
        require(in_child(threads, NULL) == parent, "a child forked after the parent has used threads");
    require(in_child(3, argv[0]) == parent, "a child that replaces itself");
    require(run_scene(DEFAULT_SCHEME, 3) == parent, "the parent afterwards");
    printf("%d children: the parent's bits\n", children + 2);
    return 0;
}
