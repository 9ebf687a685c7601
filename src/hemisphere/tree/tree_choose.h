/* SPDX-License-Identifier: Apache-2.0 */
/* tree_choose.h -- which details of a function a compressed tree keeps, and how precisely: what
 * tree_choose.c decides and tree_build.c writes. Internal to src/hemisphere.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree.h"

/* One block of a detail row; rows that are not TREE_ROWS_BLOCKS have one block only. */
typedef struct TreeCandidate {
    float    significance; /* |d| weighted by components, times the norm of its place */
    uint32_t place;        /* leaf place, haar.h's layout */
    uint32_t block;
} TreeCandidate;

typedef struct TreeChoice {
    const TreeOptions *options;
    const float       *source;
    float             *coefficients; /* haar_forward of the source */
    float             *work;         /* of the same size: what the kept details give back */
    double            *areas;        /* leaves of octant 0, sr */
    TreeCandidate     *candidates;   /* the first kept_count of them stay */
    uint32_t           candidate_count, kept_count;
    uint32_t           leaf_count;
    uint32_t           block_count;
    float             *scales;     /* level x components */
    float              byte_limit; /* rounding to 8 bits may cost this much */
    int                byte_level; /* from which level rows have 8 bits; 0: none */
    uint32_t          *kept;       /* per place: bit b is set: block b stays */
} TreeChoice;

typedef struct TreeDeviation {
    float max, rms, source_rms;
} TreeDeviation;

/* Transforms the leaves and chooses; everything is taken from the arena. */
bool tree_choose(const TreeOptions *options, const float *leaves, Arena *arena, TreeChoice *out,
                 Error *err);

/* Deviation of choice->work from the source. */
TreeDeviation tree_deviation(const TreeChoice *choice);

/* Level of the father whose child's detail stands at a place: the child is as many levels
 * above the leaves as the place has trailing zero digits. Octant means have none (-1). */
static inline int tree_father_level(const HaarShape *shape, uint32_t place)
{
    uint32_t in_octant = place & ((1u << 2 * shape->level) - 1);
    return in_octant == 0 ? -1 : shape->level - 1 - __builtin_ctz(in_octant) / 2;
}

/* A detail as the multiple of its scale that is stored. */
int tree_quantised(float value, float scale);

/* Components of a block: first .. first + count - 1. */
static inline int tree_block_first(uint32_t block)
{
    return TREE_BLOCK * (int)block;
}

static inline int tree_block_count(const TreeChoice *choice, uint32_t block)
{
    int left = choice->options->shape.components - tree_block_first(block);
    return choice->block_count > 1 && left > TREE_BLOCK ? TREE_BLOCK : left;
}
