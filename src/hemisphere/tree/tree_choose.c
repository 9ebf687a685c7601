/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/tree_choose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>


/* ---- candidates -------------------------------------------------------------------------- */

static float component_scale(const TreeOptions *options, int component)
{
    return options->component_scale ? options->component_scale[component] : 1.0f;
}

static int by_significance(const void *a, const void *b)
{
    const TreeCandidate *x = a, *y = b;
    if (x->significance != y->significance) return x->significance > y->significance ? -1 : 1;
    if (x->place != y->place) return x->place < y->place ? -1 : 1;
    return (x->block > y->block) - (x->block < y->block);
}

/* The block's detail at a place of norm 1. */
static double block_magnitude(const TreeChoice *choice, uint32_t place, uint32_t block)
{
    size_t       components = (size_t)choice->options->shape.components;
    int          first = tree_block_first(block), count = tree_block_count(choice, block);
    const float *row = choice->coefficients + place * components;
    double       sum = 0;
    for (int c = first; c < first + count; c++) {
        double d = (double)(row[c] * component_scale(choice->options, c));
        sum += d * d;
    }
    return sqrt(sum);
}

static void list_candidates(TreeChoice *choice, Arena *arena)
{
    const HaarShape *shape = &choice->options->shape;
    float           *norms = ARENA_NEW(arena, float, choice->leaf_count);
    haar_norms(shape, norms, *arena);
    choice->candidates =
        ARENA_NEW(arena, TreeCandidate, (size_t)choice->leaf_count * choice->block_count);
    for (uint32_t place = 0; place < choice->leaf_count; place++)
        for (uint32_t b = 0; b < choice->block_count; b++) {
            double magnitude = block_magnitude(choice, place, b);
            if (tree_father_level(shape, place) < 0 || !(magnitude > 0)) continue;
            choice->candidates[choice->candidate_count++] =
                (TreeCandidate){(float)magnitude * norms[place], place, b};
        }
    qsort(choice->candidates, choice->candidate_count, sizeof(TreeCandidate), by_significance);
}

/* ---- what a choice of details gives back ------------------------------------------------- */

/* scales = the largest kept detail of each level and component. */
static void find_largest(TreeChoice *choice, uint32_t kept)
{
    const HaarShape *shape = &choice->options->shape;
    size_t           components = (size_t)shape->components;
    memset(choice->scales, 0, sizeof(float) * components * (size_t)shape->level);
    for (uint32_t i = 0; i < kept; i++) {
        TreeCandidate kept_one = choice->candidates[i];
        const float  *row = choice->coefficients + kept_one.place * components;
        int           level = tree_father_level(shape, kept_one.place);
        float        *scale = choice->scales + (size_t)level * components;
        int first = tree_block_first(kept_one.block);
        for (int c = first; c < first + tree_block_count(choice, kept_one.block); c++)
            if (fabsf(row[c]) > scale[c]) scale[c] = fabsf(row[c]);
    }
}

/* Would rounding the level's details to 8 bits stay within the limit? */
static bool bytes_suffice(const TreeChoice *choice, int level)
{
    int          components = choice->options->shape.components;
    const float *largest = choice->scales + level * components;
    for (int c = 0; c < components; c++)
        if (component_scale(choice->options, c) * largest[c] * (0.5f / 127) >
            choice->byte_limit)
            return false;
    return true;
}

/* Scales that put the largest kept detail of a level and component at 32767, or at 127 on the
 * finest levels, as far up as that suffices. Level 0 always has 16 bits. */
static void choose_scales(TreeChoice *choice, uint32_t kept)
{
    const HaarShape *shape = &choice->options->shape;
    int              byte_level = shape->level;
    find_largest(choice, kept);
    while (byte_level > 1 && bytes_suffice(choice, byte_level - 1)) byte_level--;
    choice->byte_level = byte_level < shape->level ? byte_level : 0;
    for (int i = 0; i < shape->level * shape->components; i++)
        choice->scales[i] /= i / shape->components >= byte_level ? 127 : 32767;
}

int tree_quantised(float value, float scale)
{
    return scale > 0 ? (int)lrintf(value / scale) : 0;
}

static void keep_block(const TreeChoice *choice, TreeCandidate kept)
{
    const HaarShape *shape = &choice->options->shape;
    size_t           row = kept.place * (size_t)shape->components;
    const float     *from = choice->coefficients + row;
    float           *to = choice->work + row;
    size_t           level = (size_t)tree_father_level(shape, kept.place);
    const float     *scale = choice->scales + level * (size_t)shape->components;
    int              first = tree_block_first(kept.block);
    for (int c = first; c < first + tree_block_count(choice, kept.block); c++)
        to[c] = choice->options->rows == TREE_ROWS_FLOAT
                    ? from[c]
                    : scale[c] * (float)tree_quantised(from[c], scale[c]);
}

/* work = the leaves that octant means and the first `kept` candidates invert to. */
static void reconstruct(TreeChoice *choice, uint32_t kept, Arena scratch)
{
    const HaarShape *shape = &choice->options->shape;
    size_t           row = (size_t)shape->components;
    memset(choice->work, 0, sizeof(float) * choice->leaf_count * row);
    if (choice->options->rows != TREE_ROWS_FLOAT) choose_scales(choice, kept);
    for (int q = 0; q < shape->octants; q++) {
        size_t mean = ((size_t)q << 2 * shape->level) * row;
        memcpy(choice->work + mean, choice->coefficients + mean, row * sizeof(float));
    }
    for (uint32_t i = 0; i < kept; i++) keep_block(choice, choice->candidates[i]);
    haar_inverse(shape, choice->work, scratch);
}

TreeDeviation tree_deviation(const TreeChoice *choice)
{
    const HaarShape *shape = &choice->options->shape;
    size_t           components = (size_t)shape->components;
    uint32_t         mask = (1u << 2 * shape->level) - 1;
    double           max = 0, error = 0, source = 0, area = 0;
    for (size_t leaf = 0; leaf < choice->leaf_count; leaf++) {
        double weight = choice->areas[leaf & mask];
        area += weight * (double)components;
        for (size_t c = 0; c < components; c++) {
            double scale = (double)component_scale(choice->options, (int)c);
            double s = scale * (double)choice->source[leaf * components + c];
            double e = scale * (double)choice->work[leaf * components + c] - s;
            if (fabs(e) > max) max = fabs(e);
            error += weight * e * e;
            source += weight * s * s;
        }
    }
    return (TreeDeviation){(float)max, (float)sqrt(error / area), (float)sqrt(source / area)};
}

/* ---- an error bound ---------------------------------------------------------------------- */

/* Largest deviation of any leaf below a triangle from the triangle's mean, over the components
 * of a block, weighted by component_scale; not above its father's: what is good enough for the
 * father needs nothing below. [level][node * block_count + block], levels above the leaves. */
typedef struct Spread {
    float *level[GEODESIC_MAX_LEVEL + 1];
} Spread;

/* One component's leaves, replaced by their fathers' level by level. */
typedef struct Ranges {
    float  *mean, *low, *high;
    double *weight; /* octant 0: areas, or leaf counts with equal weights */
} Ranges;

static Ranges leaf_ranges(const TreeChoice *choice, int component, Arena *arena)
{
    const HaarShape *shape = &choice->options->shape;
    size_t           count = choice->leaf_count, octant = (size_t)1 << 2 * shape->level;
    float            scale = component_scale(choice->options, component);
    Ranges           r = {ARENA_NEW(arena, float, count), ARENA_NEW(arena, float, count),
                          ARENA_NEW(arena, float, count), ARENA_NEW(arena, double, octant)};
    for (size_t i = 0; i < count; i++)
        r.mean[i] = r.low[i] = r.high[i] =
            scale * choice->source[i * (size_t)shape->components + (size_t)component];
    for (size_t i = 0; i < octant; i++)
        r.weight[i] = shape->weights == HAAR_AREA ? choice->areas[i] : 1.0;
    return r;
}

/* Puts the range of children 4n .. 4n+3 in place n. */
static void join_ranges(Ranges *r, uint32_t n, const double weight[4])
{
    double   sum = 0;
    uint32_t first = 4 * n;
    float    low = r->low[first], high = r->high[first];
    for (uint32_t i = 0; i < 4; i++) {
        sum += weight[i] * (double)r->mean[first + i];
        low = fminf(low, r->low[first + i]);
        high = fmaxf(high, r->high[first + i]);
    }
    r->mean[n] = (float)(sum / (weight[0] + weight[1] + weight[2] + weight[3]));
    r->low[n] = low;
    r->high[n] = high;
}

static void spread_component(const TreeChoice *choice, int component, Spread *spread,
                             Arena scratch)
{
    const HaarShape *shape = &choice->options->shape;
    Ranges           r = leaf_ranges(choice, component, &scratch);
    uint32_t block = choice->block_count > 1 ? (uint32_t)component / TREE_BLOCK : 0;
    for (int level = shape->level - 1; level >= 0; level--) {
        uint32_t octant = 1u << 2 * level;
        for (uint32_t n = 0; n < (uint32_t)shape->octants * octant; n++) {
            join_ranges(&r, n, &r.weight[4 * (n % octant)]);
            float largest = fmaxf(r.high[n] - r.mean[n], r.mean[n] - r.low[n]);
            float *worst = &spread->level[level][n * choice->block_count + block];
            *worst = fmaxf(*worst, largest);
        }
        for (uint32_t n = 0; n < octant; n++) {
            const double *w = &r.weight[4 * n];
            r.weight[n] = w[0] + w[1] + w[2] + w[3];
        }
    }
}

static Spread find_spread(const TreeChoice *choice, Arena *arena)
{
    const HaarShape *shape = &choice->options->shape;
    Spread           spread = {{0}};
    size_t           blocks = choice->block_count;
    for (int level = 0; level < shape->level; level++)
        spread.level[level] =
            ARENA_NEW(arena, float, ((size_t)shape->octants << 2 * level) * blocks);
    for (int c = 0; c < shape->components; c++) spread_component(choice, c, &spread, *arena);
    for (int level = 1; level < shape->level; level++)
        for (size_t i = 0; i < ((size_t)shape->octants << 2 * level) * blocks; i++) {
            float father = spread.level[level - 1][i / blocks / 4 * blocks + i % blocks];
            spread.level[level][i] = fminf(spread.level[level][i], father);
        }
    return spread;
}

/* The candidates below triangles that spread by more than `bound`, in the same order. With all
 * of these kept every leaf is within `bound`, since the mean of a triangle that has no kept
 * details is exact. */
static void limit_candidates(const TreeChoice *from, const Spread *spread, float bound,
                             TreeChoice *out)
{
    int tree_level = from->options->shape.level;
    out->candidate_count = 0;
    for (uint32_t i = 0; i < from->candidate_count; i++) {
        TreeCandidate c = from->candidates[i];
        int           level = tree_father_level(&from->options->shape, c.place);
        uint32_t      node = c.place >> 2 * (tree_level - level);
        if (spread->level[level][node * from->block_count + c.block] > bound)
            out->candidates[out->candidate_count++] = c;
    }
}

static float error_with(TreeChoice *choice, uint32_t kept, Arena scratch)
{
    reconstruct(choice, kept, scratch);
    return tree_deviation(choice).max;
}

/* The smallest number of candidates (by bisection: the error need not fall with every single
 * one, but the number returned was tried) that keeps to max_error; all of them do. */
static uint32_t enough_candidates(TreeChoice *choice, Arena scratch)
{
    uint32_t low = 0, high = choice->candidate_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (error_with(choice, middle, scratch) <= choice->options->max_error)
            high = middle;
        else
            low = middle + 1;
    }
    return high;
}

/* Keeps to max_error: first whole triangles that need no details go, then of the rest the least
 * significant details. Together they need a fifth to two fifths fewer rows than significance
 * alone. The first share of the bound that leaves room for quantisation is taken. */
static bool choose_for_error(TreeChoice *choice, uint32_t *kept, Arena scratch, Error *err)
{
    static const float shares[] = {0.99f, 0.9f, 0.6f, 0};
    Spread spread = find_spread(choice, &scratch);
    TreeChoice limited = *choice;
    float  best = 0, bound = choice->options->max_error;
    limited.candidates = ARENA_NEW(&scratch, TreeCandidate, choice->candidate_count);
    for (size_t i = 0; i < sizeof shares / sizeof *shares; i++) {
        limit_candidates(choice, &spread, shares[i] * bound, &limited);
        best = error_with(&limited, limited.candidate_count, scratch);
        if (best > bound) continue;
        *kept = enough_candidates(&limited, scratch);
        memcpy(choice->candidates, limited.candidates, *kept * sizeof(TreeCandidate));
        return true;
    }
    return error_set(err, ERROR_INPUT,
                     "the error with every detail kept is %g, wanted at most %g: use a larger "
                     "bound or 32-bit rows", (double)best, (double)bound);
}

static uint32_t count_for_share(const TreeChoice *choice)
{
    double blocks = choice->block_count;
    double stored =
        floor((double)choice->options->keep_share * choice->leaf_count * blocks + 0.5);
    double details = fmax(stored - choice->options->shape.octants * blocks, 0);
    return details < choice->candidate_count ? (uint32_t)details : choice->candidate_count;
}

static bool choose_kept(TreeChoice *choice, Arena scratch, Error *err)
{
    uint32_t kept = 0;
    if (choice->options->max_error > 0) {
        choice->byte_limit = choice->options->max_error / 16;
        if (!choose_for_error(choice, &kept, scratch, err)) return false;
    } else {
        kept = count_for_share(choice);
        choice->byte_limit = error_with(choice, kept, scratch) / 16; /* with 16 bits so far */
    }
    reconstruct(choice, kept, scratch);
    choice->kept_count = kept;
    for (uint32_t i = 0; i < kept; i++)
        choice->kept[choice->candidates[i].place] |= 1u << choice->candidates[i].block;
    return true;
}

static uint32_t block_count(const TreeOptions *options)
{
    uint32_t components = (uint32_t)options->shape.components;
    return options->rows == TREE_ROWS_BLOCKS ? (components + TREE_BLOCK - 1) / TREE_BLOCK : 1;
}

bool tree_choose(const TreeOptions *options, const float *leaves, Arena *arena, TreeChoice *out,
                 Error *err)
{
    const HaarShape *shape = &options->shape;
    uint32_t         count = haar_leaf_count(shape);
    size_t           values = (size_t)count * (size_t)shape->components;
    TreeChoice choice = {.options = options, .source = leaves, .leaf_count = count};
    choice.block_count = block_count(options);
    choice.coefficients = ARENA_NEW(arena, float, values);
    choice.work = ARENA_NEW(arena, float, values);
    choice.areas = ARENA_NEW(arena, double, (size_t)1 << 2 * shape->level);
    choice.scales = ARENA_NEW(arena, float, shape->level * shape->components);
    choice.kept = ARENA_NEW(arena, uint32_t, count);
    memcpy(choice.coefficients, leaves, values * sizeof(float));
    geodesic_areas(shape->level, choice.areas);
    haar_forward(shape, choice.coefficients, *arena);
    list_candidates(&choice, arena);
    if (!choose_kept(&choice, *arena, err)) return false;
    *out = choice;
    return true;
}
