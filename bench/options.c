#include "options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *program = "bench";

void bench_refuse(const char *name, const char *value, const char *expected) {
    fprintf(stderr, "%s: %s%s%s: %s (see --help)\n", program, name, value ? " " : "", value ? value : "", expected);
    exit(2);
}

int bench_case(int argc, char **argv, const void *cases, size_t size, int n) {
    for (int k = 0; argc > 1 && k < n; ++k)
        if (strcmp(argv[1], *(const char *const *)((const char *)cases + (size_t)k * size)) == 0)
            return k;
    bench_refuse(argc < 2 ? "a case" : argv[1], NULL, "expected one of the cases");
    return -1;
}

static double number(const bench_option *o, const char *text, char **rest) {
    char expected[120];
    const double value = strtod(text, rest);
    const int whole = o->kind == BENCH_WHOLE;
    if (*rest == text || !(value >= o->low && value <= o->high) || (whole && value != floor(value))) {
        snprintf(expected, sizeof expected, "expected a %snumber from %g to %g", whole ? "whole " : "", o->low,
                 o->high);
        bench_refuse(o->name, text, expected);
    }
    return value;
}

static void read_list(const bench_option *o, const char *text) {
    bench_list *list = o->value;
    char *rest;
    list->count = 0;
    for (;;) {
        if (list->count == BENCH_LIST_MAX)
            bench_refuse(o->name, text, "too many values");
        list->value[list->count++] = number(o, text, &rest);
        if (*rest == '\0')
            return;
        if (*rest != ',')
            bench_refuse(o->name, text, "expected numbers separated by commas");
        text = rest + 1;
    }
}

static void read_value(const bench_option *o, const char *text) {
    char *rest;
    switch (o->kind) {
    case BENCH_TEXT: *(const char **)o->value = text; break;
    case BENCH_LIST: read_list(o, text); break;
    default:
        *(double *)o->value = number(o, text, &rest);
        if (*rest != '\0')
            bench_refuse(o->name, text, "expected a number");
    }
}

void bench_parse(int argc, char **argv, int first, const char *usage, int n, const bench_option *options) {
    const char *slash = strrchr(argv[0], '/');
    int k, i;
    program = slash ? slash + 1 : argv[0];
    for (k = 1; k < argc; ++k)
        if (strcmp(argv[k], "--help") == 0) {
            printf("%s\noptions [default]\n", usage);
            for (i = 0; i < n; ++i)
                printf("  %-20s %s\n", options[i].name, options[i].help);
            exit(0);
        }
    for (k = first; k < argc; k += 2) {
        for (i = 0; i < n && strcmp(argv[k], options[i].name) != 0; ++i)
            ;
        if (i == n)
            bench_refuse(argv[k], NULL, "unknown option");
        if (k + 1 == argc || argv[k + 1][0] == '\0')
            bench_refuse(argv[k], NULL, "expected a value after it");
        read_value(&options[i], argv[k + 1]);
    }
}

int bench_choice(const char *option, const char *text, int n, const char *const *names) {
    char expected[200] = "expected one of";
    int k;
    for (k = 0; k < n; ++k) {
        if (strcmp(text, names[k]) == 0)
            return k;
        strncat(expected, k ? ", " : " ", sizeof expected - strlen(expected) - 1);
        strncat(expected, names[k], sizeof expected - strlen(expected) - 1);
    }
    bench_refuse(option, text, expected);
    return -1;
}
