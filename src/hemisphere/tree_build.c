#include "hemisphere/tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- build: choose the details --------------------------------------------------------- */

typedef struct Candidate {
    float    significance; /* |d| weighted by components, times the norm of its place */
    uint32_t place;        /* leaf place, haar.h's layout */
} Candidate;

/* Everything that tree_build works with. */
typedef struct Build {
    const TreeOptions *options;
    const float       *source;
    float             *coefficients; /* haar_forward of the source */
    float             *work;         /* of the same size */
    double            *areas;        /* leaves of octant 0 */
    Candidate         *candidates;   /* most significant first */
    uint32_t           candidate_count;
    uint32_t           leaf_count;
    float             *scales; /* level x components */
    bool              *kept;   /* per place */
} Build;

static float component_scale(const TreeOptions *options, int component)
{
    return options->component_scale ? options->component_scale[component] : 1.0f;
}

/* Level of the father whose child's detail stands at a place: the place's trailing zero digits
 * say how far above the leaves the child is. Octant means have none (-1). */
static int father_level(const HaarShape *shape, uint32_t place)
{
    uint32_t in_octant = place & ((1u << 2 * shape->level) - 1);
    return in_octant == 0 ? -1 : shape->level - 1 - __builtin_ctz(in_octant) / 2;
}

static int by_significance(const void *a, const void *b)
{
    const Candidate *x = a, *y = b;
    if (x->significance != y->significance) return x->significance > y->significance ? -1 : 1;
    return x->place < y->place ? -1 : x->place > y->place;
}

static void list_candidates(Build *build, Arena *arena)
{
    const HaarShape *shape = &build->options->shape;
    float           *norms = ARENA_NEW(arena, float, build->leaf_count);
    haar_norms(shape, norms, *arena);
    build->candidates = ARENA_NEW(arena, Candidate, build->leaf_count);
    for (uint32_t place = 0; place < build->leaf_count; place++) {
        if (father_level(shape, place) < 0) continue;
        const float *row = build->coefficients + (size_t)place * (size_t)shape->components;
        double       sum = 0;
        for (int c = 0; c < shape->components; c++) {
            double d = (double)(row[c] * component_scale(build->options, c));
            sum += d * d;
        }
        if (sum > 0)
            build->candidates[build->candidate_count++] =
                (Candidate){(float)sqrt(sum) * norms[place], place};
    }
    qsort(build->candidates, build->candidate_count, sizeof(Candidate), by_significance);
}

/* ---- build: what a choice of details gives back ---------------------------------------- */

/* Scales that put the largest kept detail of a level and component at 32767. */
static void choose_scales(Build *build, uint32_t kept)
{
    const HaarShape *shape = &build->options->shape;
    size_t           components = (size_t)shape->components;
    memset(build->scales, 0, sizeof(float) * components * (size_t)shape->level);
    for (uint32_t i = 0; i < kept; i++) {
        uint32_t     place = build->candidates[i].place;
        const float *row = build->coefficients + place * components;
        float *scale = build->scales + (size_t)father_level(shape, place) * components;
        for (size_t c = 0; c < components; c++)
            if (fabsf(row[c]) > scale[c]) scale[c] = fabsf(row[c]);
    }
    for (size_t i = 0; i < components * (size_t)shape->level; i++) build->scales[i] /= 32767;
}

static int16_t quantised(float value, float scale)
{
    return scale > 0 ? (int16_t)lrintf(fminf(fmaxf(value / scale, -32767), 32767)) : 0;
}

static void keep_row(const Build *build, uint32_t place)
{
    const HaarShape *shape = &build->options->shape;
    size_t           components = (size_t)shape->components, first = place * components;
    const float     *from = build->coefficients + first;
    int              level = father_level(shape, place);
    if (level < 0 || build->options->rows == TREE_ROWS_FLOAT) {
        memcpy(build->work + first, from, sizeof(float) * components);
        return;
    }
    const float *scale = build->scales + (size_t)level * components;
    for (size_t c = 0; c < components; c++)
        build->work[first + c] = scale[c] * (float)quantised(from[c], scale[c]);
}

/* work = the leaves that octant means and the first `kept` candidates invert to. */
static void reconstruct(Build *build, uint32_t kept, Arena scratch)
{
    const HaarShape *shape = &build->options->shape;
    memset(build->work, 0, sizeof(float) * build->leaf_count * (size_t)shape->components);
    if (build->options->rows == TREE_ROWS_INT16) choose_scales(build, kept);
    for (int q = 0; q < shape->octants; q++) keep_row(build, (uint32_t)q << 2 * shape->level);
    for (uint32_t i = 0; i < kept; i++) keep_row(build, build->candidates[i].place);
    haar_inverse(shape, build->work, scratch);
}

typedef struct Deviation {
    float max, rms, source_rms;
} Deviation;

static Deviation deviation(const Build *build)
{
    const HaarShape *shape = &build->options->shape;
    size_t           components = (size_t)shape->components;
    uint32_t         mask = (1u << 2 * shape->level) - 1;
    double           max = 0, error = 0, source = 0, area = 0;
    for (size_t leaf = 0; leaf < build->leaf_count; leaf++) {
        double weight = build->areas[leaf & mask];
        area += weight * (double)components;
        for (size_t c = 0; c < components; c++) {
            double scale = (double)component_scale(build->options, (int)c);
            double s = scale * (double)build->source[leaf * components + c];
            double e = scale * (double)build->work[leaf * components + c] - s;
            if (fabs(e) > max) max = fabs(e);
            error += weight * e * e;
            source += weight * s * s;
        }
    }
    return (Deviation){(float)max, (float)sqrt(error / area), (float)sqrt(source / area)};
}

/* The smallest number of candidates (by bisection: the error need not fall with every single
 * one, but the number returned was tried) that keeps to max_error. */
static bool enough_for_error(Build *build, uint32_t *kept, Arena scratch, Error *err)
{
    uint32_t low = 0, high = build->candidate_count;
    reconstruct(build, high, scratch);
    float best = deviation(build).max;
    if (best > build->options->max_error)
        return error_set(err, ERROR_INPUT,
                         "the error with every detail kept is %g, wanted at most %g: use a "
                         "larger bound or 32-bit rows", (double)best,
                         (double)build->options->max_error);
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        reconstruct(build, middle, scratch);
        if (deviation(build).max <= build->options->max_error)
            high = middle;
        else
            low = middle + 1;
    }
    *kept = high;
    return true;
}

static bool choose_kept(Build *build, uint32_t *kept, Arena scratch, Error *err)
{
    const TreeOptions *options = build->options;
    if (options->max_error > 0) {
        if (!enough_for_error(build, kept, scratch, err)) return false;
    } else {
        double rows = floor((double)options->keep_share * build->leaf_count + 0.5);
        double details = rows - options->shape.octants;
        *kept = details > 0 ? (uint32_t)details : 0;
        if (*kept > build->candidate_count) *kept = build->candidate_count;
    }
    reconstruct(build, *kept, scratch);
    for (uint32_t i = 0; i < *kept; i++) build->kept[build->candidates[i].place] = true;
    return true;
}

/* ---- build: write the blob -------------------------------------------------------------- */

/* alive[level][node]: the triangle has a kept detail at or below it. */
typedef struct Alive {
    bool *level[GEODESIC_MAX_LEVEL + 1];
} Alive;

static uint32_t child_place(int tree_level, int level, uint32_t node, uint32_t child)
{
    return (4 * node + child) << 2 * (tree_level - level - 1);
}

static Alive find_alive(const Build *build, Arena *arena)
{
    const HaarShape *shape = &build->options->shape;
    Alive            alive = {{0}};
    for (int level = shape->level; level >= 0; level--) {
        uint32_t count = (uint32_t)shape->octants << 2 * level;
        bool    *here = alive.level[level] = ARENA_NEW(arena, bool, count);
        for (uint32_t n = 0; n < count; n++) {
            here[n] = level == 0; /* octants always have a node */
            for (uint32_t i = 0; i < 4 && level < shape->level; i++) {
                bool row = i > 0 && build->kept[child_place(shape->level, level, n, i)];
                if (row || alive.level[level + 1][4 * n + i]) here[n] = true;
            }
        }
    }
    return alive;
}

static size_t align_up(size_t bytes, size_t to)
{
    return (bytes + to - 1) / to * to;
}

static TreeHeader plan_blob(const TreeOptions *options, uint32_t nodes, uint32_t rows)
{
    const HaarShape *shape = &options->shape;
    size_t           components = (size_t)shape->components;
    bool             small = options->rows == TREE_ROWS_INT16;
    size_t           means = sizeof(TreeHeader);
    size_t           scales = means + sizeof(float) * (size_t)shape->octants * components;
    size_t node_start =
        align_up(scales + (small ? 4 * (size_t)shape->level * components : 0), 8);
    size_t row_start = align_up(node_start + nodes * sizeof(TreeNode), 8);
    return (TreeHeader){.magic = TREE_MAGIC,
                        .version = TREE_VERSION,
                        .size = align_up(row_start + (small ? 2 : 4) * components * rows, 8),
                        .level = (uint8_t)shape->level,
                        .octants = (uint8_t)shape->octants,
                        .weights = (uint8_t)shape->weights,
                        .rows = (uint8_t)options->rows,
                        .components = (uint32_t)components,
                        .node_count = nodes,
                        .row_count = rows,
                        .means_offset = (uint32_t)means,
                        .scales_offset = (uint32_t)scales,
                        .nodes_offset = (uint32_t)node_start,
                        .rows_offset = row_start};
}

static void write_row(const Build *build, char *blob, const TreeHeader *header, uint32_t index,
                      uint32_t place)
{
    size_t       components = header->components;
    const float *from = build->coefficients + place * components;
    char        *rows = blob + header->rows_offset;
    if (header->rows == TREE_ROWS_FLOAT) {
        memcpy(rows + 4 * components * index, from, 4 * components);
        return;
    }
    int          level = father_level(&build->options->shape, place);
    const float *scale = build->scales + (size_t)level * components;
    for (size_t c = 0; c < components; c++) {
        int16_t q = quantised(from[c], scale[c]);
        memcpy(rows + 2 * (components * index + c), &q, sizeof q);
    }
}

/* Nodes level by level; children of one node follow each other, as do rows. */
static void write_nodes(const Build *build, char *blob, const TreeHeader *header,
                        const Alive *alive)
{
    TreeNode *node = (TreeNode *)(void *)(blob + header->nodes_offset);
    uint32_t  next_node = header->octants, next_row = 0;
    for (int level = 0; level <= header->level; level++)
        for (uint32_t n = 0; n < (uint32_t)header->octants << 2 * level; n++) {
            if (!alive->level[level][n]) continue;
            *node = (TreeNode){next_node << 4, next_row << 3};
            for (uint32_t i = 0; i < 4 && level < header->level; i++) {
                uint32_t place = child_place(header->level, level, n, i);
                if (alive->level[level + 1][4 * n + i]) node->children |= 1u << i, next_node++;
                if (i == 0 || !build->kept[place]) continue;
                node->rows |= 1u << (i - 1);
                write_row(build, blob, header, next_row++, place);
            }
            node++;
        }
}

static char *write_blob(const Build *build, uint32_t kept, Arena *arena)
{
    const HaarShape *shape = &build->options->shape;
    Alive            alive = find_alive(build, arena);
    uint32_t         nodes = 0;
    for (int level = 0; level <= shape->level; level++)
        for (uint32_t n = 0; n < (uint32_t)shape->octants << 2 * level; n++)
            nodes += alive.level[level][n];
    TreeHeader header = plan_blob(build->options, nodes, kept);
    char      *blob = arena_alloc(arena, 1, 16, header.size);
    memcpy(blob, &header, sizeof header);
    size_t bytes = sizeof(float) * header.components;
    for (size_t q = 0; q < header.octants; q++)
        memcpy(blob + header.means_offset + q * bytes,
               build->coefficients + (q << 2 * shape->level) * header.components, bytes);
    if (header.rows == TREE_ROWS_INT16)
        memcpy(blob + header.scales_offset, build->scales, bytes * header.level);
    write_nodes(build, blob, &header, &alive);
    return blob;
}

static bool check_options(const TreeOptions *options, const float *leaves, Error *err)
{
    const HaarShape *shape = &options->shape;
    if (shape->level < 0 || shape->level > GEODESIC_MAX_LEVEL)
        return error_set(err, ERROR_INPUT, "tree level is %d, wanted 0 to %d", shape->level,
                         GEODESIC_MAX_LEVEL);
    if (shape->octants != 2 && shape->octants != 4)
        return error_set(err, ERROR_INPUT, "octants are %d, wanted 2 or 4", shape->octants);
    if (shape->components < 1 || shape->components > TREE_MAX_COMPONENTS)
        return error_set(err, ERROR_INPUT, "components are %d, wanted 1 to %d",
                         shape->components, TREE_MAX_COMPONENTS);
    if ((options->keep_share > 0) == (options->max_error > 0) || options->keep_share > 1)
        return error_set(err, ERROR_INPUT, "keep share is %g and error bound %g, wanted one of "
                         "them above 0 and the share at most 1", (double)options->keep_share,
                         (double)options->max_error);
    size_t count = (size_t)haar_leaf_count(shape) * (size_t)shape->components;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(leaves[i]))
            return error_set(err, ERROR_INPUT, "leaf %zu, component %zu is %g, wanted a finite "
                             "value", i / (size_t)shape->components,
                             i % (size_t)shape->components, (double)leaves[i]);
    return true;
}

static Build start_build(const TreeOptions *options, const float *leaves, Arena *arena)
{
    const HaarShape *shape = &options->shape;
    uint32_t         count = haar_leaf_count(shape);
    size_t           values = (size_t)count * (size_t)shape->components;
    Build            build = {.options = options, .source = leaves, .leaf_count = count};
    build.coefficients = ARENA_NEW(arena, float, values);
    build.work = ARENA_NEW(arena, float, values);
    build.areas = ARENA_NEW(arena, double, (size_t)1 << 2 * shape->level);
    build.scales = ARENA_NEW(arena, float, shape->level * shape->components);
    build.kept = ARENA_NEW(arena, bool, count);
    memcpy(build.coefficients, leaves, values * sizeof(float));
    geodesic_areas(shape->level, build.areas);
    haar_forward(shape, build.coefficients, *arena);
    list_candidates(&build, arena);
    return build;
}

static TreeReport report_of(const Build *build, const TreeHeader *header)
{
    Deviation error = deviation(build);
    return (TreeReport){
        .leaves = build->leaf_count,
        .stored_rows = header->row_count + header->octants,
        .nodes = header->node_count,
        .bytes = header->size,
        .source_bytes = (size_t)build->leaf_count * header->components * sizeof(float),
        .max_error = error.max,
        .rms_error = error.rms,
        .relative_l2 = error.source_rms > 0 ? error.rms / error.source_rms : 0};
}

/* The blob is written behind the scratch, then moved to where the scratch began. */
bool tree_build(const TreeOptions *options, const float *leaves, Arena *arena,
                const void **blob, TreeReport *report, Error *err)
{
    if (!check_options(options, leaves, err)) return false;
    Arena    scratch = *arena;
    uint32_t kept = 0;
    Build    build = start_build(options, leaves, &scratch);
    if (!choose_kept(&build, &kept, scratch, err)) return false;
    const char       *made = write_blob(&build, kept, &scratch);
    const TreeHeader *header = (const TreeHeader *)(const void *)made;
    size_t            size = header->size;
    if (report) *report = report_of(&build, header);
    char *final = arena->next + (size_t)(-(uintptr_t)arena->next & 15);
    memmove(final, made, size);
    arena->next = final + size;
    *blob = final;
    return true;
}
