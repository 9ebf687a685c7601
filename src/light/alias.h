/* SPDX-License-Identifier: Apache-2.0 */
/* alias.h -- chooses one of n by weight in constant time (Walker 1977, Vose 1991).
 *
 * Memory   tables come from the arena. Threads: const after alias_build.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"

/* A sample's number has 24 bits, so every probability is a whole number of 2^-24: `prob` is
 * that number, counted, and differs from the weight's share by the rounding. What is divided by
 * prob is therefore without bias; a share far below 2^-24 may never be chosen. */
typedef struct AliasSlot {
    uint32_t keep;    /* of 2^24 places in slot i, the first that i keeps */
    uint32_t other;   /* what slot i gives otherwise */
    float prob;       /* probability of i; they sum to one */
    float other_prob; /* of `other`, to be had without another read far away */
} AliasSlot;

typedef struct AliasTable {
    int count;
    AliasSlot *slots;
} AliasTable;

/* weights: count >= 1 values, >= 0, not all zero. */
AliasTable alias_build(const double *weights, int count, Arena *arena);

/* u in [0,1). *prob: of what was chosen. */
static inline int alias_sample(const AliasTable *table, float u, float *prob) {
    uint64_t place = (uint64_t)(u * 0x1p24f) * (uint64_t)table->count;
    uint32_t slot = (uint32_t)(place >> 24), rest = (uint32_t)place & 0xffffffu;
    const AliasSlot *at = &table->slots[slot];
    bool keeps = rest < at->keep;
    *prob = keeps ? at->prob : at->other_prob;
    return (int)(keeps ? slot : at->other);
}
