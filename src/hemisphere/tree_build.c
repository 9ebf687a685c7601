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
    float              byte_limit; /* rounding to 8 bits may cost this much */
    int                byte_level; /* from which level rows have 8 bits; 0: none */
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

/* scales = the largest kept detail of each level and component. */
static void find_largest(Build *build, uint32_t kept)
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
}

/* Would rounding the level's details to 8 bits stay within the limit? */
static bool bytes_suffice(const Build *build, int level)
{
    int          components = build->options->shape.components;
    const float *largest = build->scales + level * components;
    for (int c = 0; c < components; c++)
        if (component_scale(build->options, c) * largest[c] * (0.5f / 127) > build->byte_limit)
            return false;
    return true;
}

/* Scales that put the largest kept detail of a level and component at 32767, or at 127 on the
 * finest levels, as far up as that suffices. Level 0 always has 16 bits. */
static void choose_scales(Build *build, uint32_t kept)
{
    const HaarShape *shape = &build->options->shape;
    int              byte_level = shape->level;
    find_largest(build, kept);
    while (byte_level > 1 && bytes_suffice(build, byte_level - 1)) byte_level--;
    build->byte_level = byte_level < shape->level ? byte_level : 0;
    for (int i = 0; i < shape->level * shape->components; i++)
        build->scales[i] /= i / shape->components >= byte_level ? 127 : 32767;
}

static int quantised(float value, float scale)
{
    return scale > 0 ? (int)lrintf(value / scale) : 0;
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

/* Largest deviation of any leaf below a triangle from the triangle's mean, over all components,
 * weighted by component_scale; not above its father's: what is good enough for the father needs
 * nothing below. [level][node] for the levels above the leaves. */
typedef struct Spread {
    float *level[GEODESIC_MAX_LEVEL + 1];
} Spread;

/* One component's leaves, replaced by their fathers' level by level. */
typedef struct Ranges {
    float  *mean, *low, *high;
    double *weight; /* octant 0: areas, or leaf counts with equal weights */
} Ranges;

static Ranges leaf_ranges(const Build *build, int component, Arena *arena)
{
    const HaarShape *shape = &build->options->shape;
    size_t           count = build->leaf_count, octant = (size_t)1 << 2 * shape->level;
    float            scale = component_scale(build->options, component);
    Ranges           r = {ARENA_NEW(arena, float, count), ARENA_NEW(arena, float, count),
                          ARENA_NEW(arena, float, count), ARENA_NEW(arena, double, octant)};
    for (size_t i = 0; i < count; i++)
        r.mean[i] = r.low[i] = r.high[i] =
            scale * build->source[i * (size_t)shape->components + (size_t)component];
    for (size_t i = 0; i < octant; i++)
        r.weight[i] = shape->weights == HAAR_AREA ? build->areas[i] : 1.0;
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

static void spread_component(const Build *build, int component, Spread *spread, Arena scratch)
{
    const HaarShape *shape = &build->options->shape;
    Ranges           r = leaf_ranges(build, component, &scratch);
    for (int level = shape->level - 1; level >= 0; level--) {
        uint32_t octant = 1u << 2 * level;
        for (uint32_t n = 0; n < (uint32_t)shape->octants * octant; n++) {
            join_ranges(&r, n, &r.weight[4 * (n % octant)]);
            float largest = fmaxf(r.high[n] - r.mean[n], r.mean[n] - r.low[n]);
            spread->level[level][n] = fmaxf(spread->level[level][n], largest);
        }
        for (uint32_t n = 0; n < octant; n++) {
            const double *w = &r.weight[4 * n];
            r.weight[n] = w[0] + w[1] + w[2] + w[3];
        }
    }
}

static Spread find_spread(const Build *build, Arena *arena)
{
    const HaarShape *shape = &build->options->shape;
    Spread           spread = {{0}};
    for (int level = 0; level < shape->level; level++)
        spread.level[level] = ARENA_NEW(arena, float, (size_t)shape->octants << 2 * level);
    for (int c = 0; c < shape->components; c++) spread_component(build, c, &spread, *arena);
    for (int level = 1; level < shape->level; level++)
        for (uint32_t n = 0; n < (uint32_t)shape->octants << 2 * level; n++)
            spread.level[level][n] =
                fminf(spread.level[level][n], spread.level[level - 1][n / 4]);
    return spread;
}

/* The candidates below triangles that spread by more than `bound`, in the same order. With all
 * of these kept every leaf is within `bound`, since the mean of a triangle that has no kept
 * details is exact. */
static void limit_candidates(const Build *from, const Spread *spread, float bound, Build *out)
{
    int tree_level = from->options->shape.level;
    out->candidate_count = 0;
    for (uint32_t i = 0; i < from->candidate_count; i++) {
        uint32_t place = from->candidates[i].place;
        int      level = father_level(&from->options->shape, place);
        if (spread->level[level][place >> 2 * (tree_level - level)] > bound)
            out->candidates[out->candidate_count++] = from->candidates[i];
    }
}

static float error_with(Build *build, uint32_t kept, Arena scratch)
{
    reconstruct(build, kept, scratch);
    return deviation(build).max;
}

/* The smallest number of candidates (by bisection: the error need not fall with every single
 * one, but the number returned was tried) that keeps to max_error; all of them do. */
static uint32_t enough_candidates(Build *build, Arena scratch)
{
    uint32_t low = 0, high = build->candidate_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (error_with(build, middle, scratch) <= build->options->max_error)
            high = middle;
        else
            low = middle + 1;
    }
    return high;
}

/* Keeps to max_error: first whole triangles that need no details go, then of the rest the least
 * significant details. Together they need a fifth to two fifths fewer rows than significance
 * alone. The first share of the bound that leaves room for quantisation is taken. */
static bool choose_for_error(Build *build, uint32_t *kept, Arena scratch, Error *err)
{
    static const float shares[] = {0.99f, 0.9f, 0.6f, 0};
    Spread spread = find_spread(build, &scratch);
    Build  limited = *build;
    float  best = 0, bound = build->options->max_error;
    limited.candidates = ARENA_NEW(&scratch, Candidate, build->candidate_count);
    for (size_t i = 0; i < sizeof shares / sizeof *shares; i++) {
        limit_candidates(build, &spread, shares[i] * bound, &limited);
        best = error_with(&limited, limited.candidate_count, scratch);
        if (best > bound) continue;
        *kept = enough_candidates(&limited, scratch);
        memcpy(build->candidates, limited.candidates, *kept * sizeof(Candidate));
        return true;
    }
    return error_set(err, ERROR_INPUT,
                     "the error with every detail kept is %g, wanted at most %g: use a larger "
                     "bound or 32-bit rows", (double)best, (double)bound);
}

static uint32_t count_for_share(const Build *build)
{
    double rows = floor((double)build->options->keep_share * build->leaf_count + 0.5);
    double details = fmax(rows - build->options->shape.octants, 0);
    return details < build->candidate_count ? (uint32_t)details : build->candidate_count;
}

static bool choose_kept(Build *build, uint32_t *kept, Arena scratch, Error *err)
{
    if (build->options->max_error > 0) {
        build->byte_limit = build->options->max_error / 16;
        if (!choose_for_error(build, kept, scratch, err)) return false;
    } else {
        *kept = count_for_share(build);
        build->byte_limit = error_with(build, *kept, scratch) / 16; /* with 16 bits so far */
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

static size_t row_bytes(const Build *build, int level)
{
    size_t width = build->options->rows == TREE_ROWS_FLOAT                     ? 4
                   : build->byte_level > 0 && level >= build->byte_level ? 1
                                                                          : 2;
    return width * (size_t)build->options->shape.components;
}

static TreeHeader plan_blob(const Build *build, uint32_t nodes, uint32_t kept)
{
    const HaarShape *shape = &build->options->shape;
    size_t           components = (size_t)shape->components, rows = 0;
    bool             small = build->options->rows == TREE_ROWS_INT16;
    for (uint32_t i = 0; i < kept; i++)
        rows += row_bytes(build, father_level(shape, build->candidates[i].place));
    size_t           means = sizeof(TreeHeader);
    size_t           scales = means + sizeof(float) * (size_t)shape->octants * components;
    size_t node_start =
        align_up(scales + (small ? 4 * (size_t)shape->level * components : 0), 8);
    size_t row_start = align_up(node_start + nodes * sizeof(TreeNode), 8);
    return (TreeHeader){.magic = TREE_MAGIC,
                        .version = TREE_VERSION,
                        .size = align_up(row_start + rows, 8),
                        .level = (uint8_t)shape->level,
                        .octants = (uint8_t)shape->octants,
                        .weights = (uint8_t)shape->weights,
                        .rows = (uint8_t)build->options->rows,
                        .components = (uint32_t)components,
                        .node_count = nodes,
                        .row_count = kept,
                        .means_offset = (uint32_t)means,
                        .scales_offset = (uint32_t)scales,
                        .nodes_offset = (uint32_t)node_start,
                        .byte_level = small ? (uint32_t)build->byte_level : 0,
                        .rows_offset = row_start};
}

/* Writes a row and returns where the next one goes. */
static char *write_row(const Build *build, char *to, uint32_t place)
{
    size_t       components = (size_t)build->options->shape.components;
    const float *from = build->coefficients + place * components;
    int          level = father_level(&build->options->shape, place);
    size_t       bytes = row_bytes(build, level);
    const float *scale = build->scales + (size_t)level * components;
    if (build->options->rows == TREE_ROWS_FLOAT) {
        memcpy(to, from, bytes);
        return to + bytes;
    }
    for (size_t c = 0; c < components; c++) {
        int     q = quantised(from[c], scale[c]);
        int16_t wide = (int16_t)q;
        int8_t  narrow = (int8_t)q;
        if (bytes == components)
            memcpy(to + c, &narrow, sizeof narrow);
        else
            memcpy(to + 2 * c, &wide, sizeof wide);
    }
    return to + bytes;
}

/* Nodes level by level; children of one node follow each other, as do rows. */
static void write_nodes(const Build *build, char *blob, const TreeHeader *header,
                        const Alive *alive)
{
    TreeNode *node = (TreeNode *)(void *)(blob + header->nodes_offset);
    uint32_t  next_node = header->octants, next_row = 0;
    char     *row = blob + header->rows_offset;
    for (int level = 0; level <= header->level; level++)
        for (uint32_t n = 0; n < (uint32_t)header->octants << 2 * level; n++) {
            if (!alive->level[level][n]) continue;
            *node = (TreeNode){next_node << 4, next_row << 3};
            for (uint32_t i = 0; i < 4 && level < header->level; i++) {
                uint32_t place = child_place(header->level, level, n, i);
                if (alive->level[level + 1][4 * n + i]) node->children |= 1u << i, next_node++;
                if (i == 0 || !build->kept[place]) continue;
                node->rows |= 1u << (i - 1);
                row = write_row(build, row, place);
                next_row++;
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
    TreeHeader header = plan_blob(build, nodes, kept);
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
