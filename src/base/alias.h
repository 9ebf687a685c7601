/* alias.h -- chooses one of n by weight in constant time (Walker 1977, Vose 1991).
 *
 * Memory   tables come from the arena. Threads: const after alias_build.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"

typedef struct AliasTable {
    int       count;
    float    *keep;  /* probability of keeping slot i */
    uint32_t *other; /* what slot i gives otherwise */
    float    *prob;  /* probability of i; they sum to one */
} AliasTable;

/* weights: count >= 1 values, >= 0, not all zero. */
AliasTable alias_build(const double *weights, int count, Arena *arena);

/* u in [0,1). */
static inline int alias_sample(const AliasTable *table, float u)
{
    float scaled = u * (float)table->count;
    int   slot = (int)scaled;
    if (slot >= table->count) slot = table->count - 1;
    return scaled - (float)slot < table->keep[slot] ? slot : (int)table->other[slot];
}
