#include "table.h"

#include <stdlib.h>
#include <string.h>

#include "options.h" /* bench_refuse */

FILE *bench_open_table(const char *prefix, const char *name) {
    char path[4096];
    FILE *file;
    if (strcmp(prefix, "none") == 0)
        return NULL;
    if (snprintf(path, sizeof path, "%s.%s.csv", prefix, name) >= (int)sizeof path)
        bench_refuse("--output", prefix, "too long");
    file = fopen(path, "w");
    if (!file) {
        fprintf(stderr, "cannot write %s\n", path);
        exit(1);
    }
    return file;
}

void bench_close_table(FILE *file) {
    if (file && (ferror(file) | fclose(file))) {
        fprintf(stderr, "a table could not be written\n");
        exit(1);
    }
}
