/* Tables that the bench programs write beside what they print. */
#ifndef GRANPERI_BENCH_TABLE_H
#define GRANPERI_BENCH_TABLE_H

#include <stdio.h>

/* The new file PREFIX.NAME.csv; NULL where the prefix is "none". Ends the program with a message if it cannot be. */
FILE *bench_open_table(const char *prefix, const char *name);

/* Ends the program with a message if not all was written. file may be NULL. */
void bench_close_table(FILE *file);

#endif
