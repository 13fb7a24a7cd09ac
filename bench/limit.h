#ifndef GRANPERI_BENCH_LIMIT_H
#define GRANPERI_BENCH_LIMIT_H

#include "follow.h"

void search_limit(const trial *t, const following *f, FILE *table);

#endif
