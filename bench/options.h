/* Command lines of the bench programs: "--name value" pairs from a table. */
#ifndef GRANPERI_BENCH_OPTIONS_H
#define GRANPERI_BENCH_OPTIONS_H

#include <stddef.h>

enum { BENCH_LIST_MAX = 64 };

typedef struct bench_list {
    int count;
    double value[BENCH_LIST_MAX];
} bench_list;

/* What follows the option's name. */
typedef enum bench_kind {
    BENCH_NUMBER, /* value: double *, from low to high */
    BENCH_WHOLE,  /* the same, without a fraction */
    BENCH_TEXT,   /* value: const char ** */
    BENCH_LIST    /* value: bench_list *, numbers from low to high separated by commas */
} bench_kind;

typedef struct bench_option {
    const char *name; /* "--..." */
    const char *help; /* says the unit and the default */
    bench_kind kind;
    void *value;
    double low, high;
} bench_option;

/* Reads argv[first] and what follows. --help, anywhere, ends the program with status 0, a bad option with a message and
 * status 2. usage: text before the table of options. */
void bench_parse(int argc, char **argv, int first, const char *usage, int n, const bench_option *options);

/* Ends the program with this message and status 2. */
void bench_refuse(const char *name, const char *value, const char *expected);

/* Number of the case that the first argument names; any other is refused. cases: n structs of `size` bytes that begin with a name. */
int bench_case(int argc, char **argv, const void *cases, size_t size, int n);

/* Index of text among the n names; ends the program if it is none of them. */
int bench_choice(const char *option, const char *text, int n, const char *const *names);

#endif
