/* SPDX-License-Identifier: Apache-2.0 */
/* Before the first path: the tree of emitters, and the directions of displays. */
#include "light/emitter_tree.h"

#include <math.h>
#include <stdlib.h>

#include "base/mathf.h"
#include "panel/query/panel_emission.h"

#define PROFILE_CODES 8 /* of the content, whose directions are averaged */
#define LEAF_CELLS 64   /* pieces of one picture need no branches of their own */
#define FINE_SIDE 16    /* a triangle in so many pieces a side shows a picture */
#define BLOCK_SIDE 4    /* of such a triangle's cells, so many a side stay together */
#define FLAT 0.999998   /* the least cosine between a flat branch's normals and their mean */
#define FAR 0.01        /* mean square extent over square distance of a branch that is far */
#define FAR_RADIUS 0.2  /* of the square radius, which counts at least as extent there */
#define FOCUSED 0.95    /* only branches whose cells all face about one way are ever far */
#define DEEPEST 24      /* levels; cells at one place are not split for ever */

/* Neighbouring cells of one emitter, or one cell: what is sorted into branches. */
typedef struct CellBlock {
    uint32_t first, count; /* in TreeWork.cells */
    uint32_t emitter;
    float middle[3];
    float reach;                        /* m: no point of its cells is farther from the middle */
    double power, moment[3], square[3]; /* sums of weight, weight x and weight x^2 */
} CellBlock;

/* A branch while it is made: blocks order[first .. first + count - 1]. */
typedef struct Gathering {
    uint32_t first, count;
    uint32_t rank, cells; /* of the first of its cells; how many */
    int part_id;          /* NO_ID: of several */
    bool is_done;         /* cannot be split */
    double power, centre[3], normal[3];
    double spread2; /* mean square distance of cells from the centre, m^2, */
    double within2; /* and that of a cell's points from its middle */
    int longest;    /* axis along which the cells spread most */
} Gathering;

/* Facts of an emitter that are used again and again. */
typedef struct EmitterFacts {
    Vec3 normal;
    float edge;    /* m, the longest of a cell */
    float within2; /* m^2, mean square distance of its points from its middle: a 36th of the
                      sum of its edges' squares */
    int part_id;
    bool is_display, both_sides;
} EmitterFacts;

typedef struct TreeWork {
    const Scene *scene;
    Emitters *emitters;
    Arena *arena;
    const double *weight;
    EmitterFacts *facts; /* of every emitter */
    uint32_t *cells;     /* block by block */
    CellBlock *blocks;
    uint32_t block_count;
    uint32_t *order; /* of blocks */
    float (*part_centre)[3];
    const EmitterProfile **profile; /* of every part that is a display, once requested */
} TreeWork;

/* Branches of one node while they are made. */
typedef struct Branches {
    Gathering of[EMITTER_BRANCHES];
    int count;
} Branches;

static const Emitter *emitter_of(const TreeWork *work, uint32_t cell) {
    return &work->emitters->emitters[work->emitters->cell_emitter[cell]];
}

static const CellBlock *block_at(const TreeWork *work, uint32_t place) {
    return &work->blocks[work->order[place]];
}

static const EmitterFacts *facts_of(const TreeWork *work, const CellBlock *block) {
    return &work->facts[block->emitter];
}

static const Material *material_of(const TreeWork *work, int part_id) {
    return &work->scene->materials[work->scene->parts[part_id].material_id];
}

static TrianglePoint cell_point(const TreeWork *work, uint32_t cell) {
    const Emitter *e = emitter_of(work, cell);
    EmitterCell at = emitter_cell(e, cell);
    float inside = at.is_turned ? 2 / 3.0f : 1 / 3.0f, step = 1 / (float)at.side;
    return triangle_point(work->scene, e->triangle, ((float)at.i + inside) * step,
                          ((float)at.j + inside) * step);
}

static EmitterFacts facts_about(const TreeWork *work, const Emitter *e) {
    EmitterFacts facts = {.part_id = (int)work->scene->triangles[e->triangle].part_id};
    const Material *m = &work->scene->materials[work->scene->parts[facts.part_id].material_id];
    TrianglePoint corner[3];
    for (int k = 0; k < 3; k++)
        corner[k] = triangle_point(work->scene, e->triangle, k == 1, k == 2);
    for (int k = 0; k < 3; k++) {
        Vec3 edge = vec3_sub(corner[k].position, corner[(k + 1) % 3].position);
        facts.edge = max_f(facts.edge, vec3_length(edge) / (float)e->side);
        facts.within2 += vec3_dot(edge, edge) / (36 * (float)(e->side * e->side));
    }
    facts.normal = corner[0].ng;
    facts.is_display = m->display_id != NO_ID;
    facts.both_sides = m->double_sided && !facts.is_display;
    return facts;
}

/* ---- blocks ------------------------------------------------------------------------------ */

/* Takes on the cell in column i, row j, whose middle is as cell_point has it. */
static void add_cell(TreeWork *work, const Emitter *e, int i, int j, bool is_turned,
                     CellBlock *block) {
    uint32_t cell = e->first_cell + (uint32_t)(2 * e->side * i - i * i + 2 * j + is_turned);
    float inside = is_turned ? 2 / 3.0f : 1 / 3.0f, step = 1 / (float)e->side;
    Vec3 at = triangle_position(work->scene, e->triangle, ((float)i + inside) * step,
                                ((float)j + inside) * step);
    const float p[3] = {at.x, at.y, at.z};
    double w = work->weight[cell];
    work->cells[block->first + block->count++] = cell;
    block->power += w;
    for (int k = 0; k < 3; k++) {
        block->middle[k] += p[k];
        block->moment[k] += w * (double)p[k];
        block->square[k] += w * (double)p[k] * (double)p[k];
    }
}

static CellBlock *start_block(TreeWork *work, const Emitter *e, float reach_edges) {
    uint32_t id = work->block_count++;
    CellBlock *block = &work->blocks[id];
    uint32_t first = id ? block[-1].first + block[-1].count : 0;
    *block = (CellBlock){.first = first, .emitter = (uint32_t)(e - work->emitters->emitters)};
    block->reach = work->facts[block->emitter].edge * reach_edges;
    return block;
}

/* BLOCK_SIDE columns from i on and rows from j on, as far as there are any. Together they are
 * convex, so that no point is farther from their centroid than two thirds of their diameter,
 * which is twice as many edges as BLOCK_SIDE at most. */
static void add_block(TreeWork *work, const Emitter *e, int i, int j) {
    CellBlock *block = start_block(work, e, 4 / 3.0f * BLOCK_SIDE);
    for (int a = i; a < i + BLOCK_SIDE && a < e->side; a++)
        for (int b = j; b < j + BLOCK_SIDE && a + b < e->side; b++)
            for (int turned = 0; turned < (a + b < e->side - 1 ? 2 : 1); turned++)
                add_cell(work, e, a, b, turned, block);
    for (int k = 0; k < 3; k++) block->middle[k] /= (float)block->count;
}

/* No corner is as far as an edge from a cell's middle. */
static void add_single_cells(TreeWork *work, const Emitter *e) {
    for (uint32_t c = e->first_cell; c < e->first_cell + (uint32_t)(e->side * e->side); c++) {
        EmitterCell at = emitter_cell(e, c);
        add_cell(work, e, at.i, at.j, at.is_turned, start_block(work, e, 1));
    }
}

static size_t count_blocks(const Emitters *emitters) {
    size_t count = 0;
    for (int n = 0; n < emitters->count; n++) {
        size_t side = (size_t)emitters->emitters[n].side;
        size_t rows = side < FINE_SIDE ? side : (side + BLOCK_SIDE - 1) / BLOCK_SIDE;
        count += side < FINE_SIDE ? side * side : rows * (rows + 1) / 2;
    }
    return count;
}

/* Makes all blocks, and the centres of parts, weighted by power. */
static void make_blocks(TreeWork *work) {
    double *power = ARENA_NEW(work->arena, double, work->scene->part_count + 1);
    for (int n = 0; n < work->emitters->count; n++) {
        const Emitter *e = &work->emitters->emitters[n];
        if (e->side < FINE_SIDE) {
            add_single_cells(work, e);
            continue;
        }
        for (int i = 0; i < e->side; i += BLOCK_SIDE)
            for (int j = 0; i + j < e->side; j += BLOCK_SIDE) add_block(work, e, i, j);
    }
    for (uint32_t i = 0; i < work->block_count; i++) {
        const CellBlock *block = &work->blocks[i];
        int part_id = facts_of(work, block)->part_id;
        work->order[i] = i;
        power[part_id] += block->power;
        float share = power[part_id] > 0 ? (float)(block->power / power[part_id]) : 0;
        for (int k = 0; k < 3; k++)
            work->part_centre[part_id][k] +=
                share * (block->middle[k] - work->part_centre[part_id][k]);
    }
}

/* Power, centre, extent, mean normal and part of a branch's cells. */
static void measure(const TreeWork *work, Gathering *g) {
    double squares[3] = {0};
    g->power = g->spread2 = g->within2 = 0;
    g->cells = 0;
    for (int k = 0; k < 3; k++) g->centre[k] = g->normal[k] = 0;
    g->part_id = facts_of(work, block_at(work, g->first))->part_id;
    for (uint32_t i = 0; i < g->count; i++) {
        const CellBlock *block = block_at(work, g->first + i);
        double w = block->power;
        const EmitterFacts *facts = facts_of(work, block);
        const double normal[3] = {(double)facts->normal.x, (double)facts->normal.y,
                                  (double)facts->normal.z};
        if (facts->part_id != g->part_id) g->part_id = NO_ID;
        g->power += w;
        g->cells += block->count;
        g->within2 += w * (double)facts->within2;
        for (int k = 0; k < 3; k++) {
            g->centre[k] += block->moment[k];
            g->normal[k] += w * normal[k];
            squares[k] += block->square[k];
        }
    }
    if (!(g->power > 0)) return;
    g->within2 /= g->power;
    for (int k = 0; k < 3; k++) {
        g->centre[k] /= g->power;
        g->normal[k] /= g->power;
        squares[k] = squares[k] / g->power - g->centre[k] * g->centre[k];
        g->spread2 += fmax(0, squares[k]);
    }
    g->longest = squares[1] > squares[0] ? 1 : 0;
    if (squares[2] > squares[g->longest]) g->longest = 2;
}

/* ---- which branches ---------------------------------------------------------------------- */

/* Sorts the blocks below the centre along the longest axis to the front; returns how many.
 * by_parts: displays are kept whole, since the directions of a branch are those of one. */
static uint32_t divide(TreeWork *work, const Gathering *g, bool by_parts) {
    uint32_t *order = work->order + g->first, below = 0;
    double centre = g->centre[g->longest];
    for (uint32_t i = 0; i < g->count; i++) {
        uint32_t id = order[i];
        const float *at = work->blocks[id].middle;
        const EmitterFacts *facts = facts_of(work, &work->blocks[id]);
        if (by_parts && facts->is_display) at = work->part_centre[facts->part_id];
        if (!((double)at[g->longest] < centre)) continue;
        order[i] = order[below];
        order[below++] = id;
    }
    return below;
}

/* False: one half would be empty or dark. */
static bool split(TreeWork *work, Branches *branches, int i) {
    Gathering *g = &branches->of[i], half = *g, rest = *g;
    uint32_t below = g->part_id == NO_ID ? divide(work, g, true) : 0;
    if (!below || below == g->count) below = divide(work, g, false);
    if (!below || below == g->count) return false;
    half.count = below;
    rest.first += below;
    rest.count -= below;
    measure(work, &half);
    measure(work, &rest);
    if (!(half.power > 0 && rest.power > 0)) return false;
    *g = half;
    branches->of[branches->count++] = rest;
    return true;
}

/* Splits again and again the branch with the greatest product of power and extent. */
static void split_all(TreeWork *work, Branches *branches) {
    while (branches->count < EMITTER_BRANCHES) {
        int best = -1;
        double most = 0;
        for (int i = 0; i < branches->count; i++) {
            const Gathering *g = &branches->of[i];
            if (g->is_done || !(g->power * g->spread2 > most)) continue;
            best = i;
            most = g->power * g->spread2;
        }
        if (best < 0) return;
        branches->of[best].is_done = !split(work, branches, best);
    }
}

static int by_first(const void *a, const void *b) {
    const Gathering *x = a, *y = b;
    return x->first < y->first ? -1 : x->first > y->first;
}

/* ---- directions of displays -------------------------------------------------------------- */

/* Codes of the content, each standing for the same share of the light. */
static void choose_codes(const TreeWork *work, int part_id, float codes[PROFILE_CODES][3]) {
    const Part *part = &work->scene->parts[part_id];
    const Display *display = &work->scene->displays[material_of(work, part_id)->display_id];
    const Emitter *first = &work->emitters->emitters[work->emitters->first_of_part[part_id]];
    const Emitter *last = first + part->triangle_count - 1;
    uint32_t begin = first->first_cell,
             end = last->first_cell + (uint32_t)(last->side * last->side);
    double total = 0, sum = 0;
    int k = 0;
    for (uint32_t c = begin; c < end; c++) total += work->weight[c];
    for (uint32_t c = begin; c < end && k < PROFILE_CODES; c++) {
        sum += work->weight[c];
        TrianglePoint point = {0};
        if (sum * PROFILE_CODES > total * (k + 0.5)) point = cell_point(work, c);
        for (; k < PROFILE_CODES && sum * PROFILE_CODES > total * (k + 0.5); k++)
            display_codes(work->scene, display, &point, codes[k]);
    }
}

/* The direction of a node of the turned octahedral map, as emitters.c reads it. */
static Vec3 node_direction(int i, int j) {
    float s = 2 * (float)i / (EMITTER_PROFILE_SIDE - 1) - 1;
    float t = 2 * (float)j / (EMITTER_PROFILE_SIDE - 1) - 1;
    float x = 0.5f * (s + t), y = 0.5f * (s - t);
    return vec3_normalize(vec3(x, y, max_f(0, 1 - fabsf(x) - fabsf(y))));
}

static const EmitterProfile *profile_of(const TreeWork *work, int part_id) {
    const Panel *panel = work->scene->displays[material_of(work, part_id)->display_id].panel;
    EmitterProfile *profile = ARENA_NEW(work->arena, EmitterProfile, 1);
    float codes[PROFILE_CODES][3], mean = 0;
    choose_codes(work, part_id, codes);
    for (int k = 0; k < PROFILE_CODES; k++) mean += panel_mean_luminance(panel, codes[k]);
    for (int j = 0; j < EMITTER_PROFILE_SIDE; j++)
        for (int i = 0; i < EMITTER_PROFILE_SIDE; i++) {
            float xyz[3], sum = 0;
            Vec3 d = node_direction(i, j);
            for (int k = 0; k < PROFILE_CODES; k++) {
                panel_emission_xyz(panel, d, codes[k], xyz);
                sum += xyz[1];
            }
            profile->value[j * EMITTER_PROFILE_SIDE + i] = mean > 0 ? d.z * sum / mean : d.z;
        }
    return profile;
}

/* The display's frame in the block nearest to the branch's centre. */
static Frame display_frame_of(const TreeWork *work, const Gathering *g) {
    const Material *material = material_of(work, g->part_id);
    const CellBlock *nearest = block_at(work, g->first);
    double least = INFINITY;
    for (uint32_t i = 0; i < g->count; i++) {
        const CellBlock *block = block_at(work, g->first + i);
        double d2 = 0;
        for (int k = 0; k < 3; k++)
            d2 += ((double)block->middle[k] - g->centre[k]) *
                  ((double)block->middle[k] - g->centre[k]);
        if (d2 < least) nearest = block;
        if (d2 < least) least = d2;
    }
    uint32_t cell = work->cells[nearest->first + nearest->count / 2];
    TrianglePoint point = cell_point(work, cell);
    return display_frame(work->scene, &work->scene->displays[material->display_id],
                         emitter_of(work, cell)->triangle, &point);
}

/* ---- nodes ------------------------------------------------------------------------------- */

/* Bounds of a branch: how far cells reach, whether all face the same way, from where none of
 * them is seen. */
typedef struct Bounds {
    float radius, behind; /* m */
    float cosine;         /* the least between a cell's normal and the mean one */
    bool both_sides;
} Bounds;

static Bounds bounds_of(const TreeWork *work, const Gathering *g, Vec3 centre, Vec3 normal) {
    Bounds bounds = {.cosine = 1};
    float reach = 0, size = 0;
    for (uint32_t i = 0; i < g->count; i++) {
        const CellBlock *block = block_at(work, g->first + i);
        const EmitterFacts *facts = facts_of(work, block);
        const float *p = block->middle;
        Vec3 off = vec3_sub(centre, vec3(p[0], p[1], p[2]));
        float far = vec3_length(off) + block->reach;
        float behind = vec3_dot(off, normal);
        float cosine = vec3_dot(facts->normal, normal);
        bounds.cosine = cosine < bounds.cosine ? cosine : bounds.cosine;
        bounds.both_sides |= facts->both_sides;
        reach = far > reach ? far : reach;
        bounds.behind = behind > bounds.behind ? behind : bounds.behind;
        for (int k = 0; k < 3; k++) size = fabsf(p[k]) > size ? fabsf(p[k]) : size;
    }
    float rounding = 1e-5f * size;
    bounds.radius = 1.001f * reach + rounding;
    bounds.behind += 3e-3f * reach + rounding;
    return bounds;
}

static void set_lane3(Spectrum lanes[3], int i, Vec3 value) {
    lanes[0][i] = value.x;
    lanes[1][i] = value.y;
    lanes[2][i] = value.z;
}

static void set_directions(const TreeWork *work, const Gathering *g, int i, Frame frame,
                           EmitterNode *node) {
    if (g->part_id != NO_ID && material_of(work, g->part_id)->display_id != NO_ID) {
        if (!work->profile[g->part_id]) work->profile[g->part_id] = profile_of(work, g->part_id);
        node->profile[i] = work->profile[g->part_id];
        node->has_displays = true;
        frame = display_frame_of(work, g);
    }
    set_lane3(node->axis[0], i, frame.x);
    set_lane3(node->axis[1], i, frame.y);
    set_lane3(node->axis[2], i, frame.z);
}

static const Emitter *first_emitter(const TreeWork *work, const Gathering *g) {
    return &work->emitters->emitters[block_at(work, g->first)->emitter];
}

static void finish_branch(const TreeWork *work, const Gathering *g, int i, EmitterNode *node) {
    Vec3 centre = vec3((float)g->centre[0], (float)g->centre[1], (float)g->centre[2]);
    Vec3 mean = vec3((float)g->normal[0], (float)g->normal[1], (float)g->normal[2]);
    float length = vec3_length(mean);
    Frame frame = frame_from_z(length > 1e-3f ? vec3_scale(mean, 1 / length) : vec3(0, 0, 1));
    Bounds bounds = bounds_of(work, g, centre, frame.z);
    bool has_back = (double)bounds.cosine > FLAT && !bounds.both_sides;
    set_lane3(node->centre, i, centre);
    set_lane3(node->normal, i, has_back ? frame.z : vec3(0, 0, 0));
    node->spread2[i] = (float)(g->spread2 + g->within2);
    node->radius[i] = bounds.radius;
    node->behind[i] = has_back ? bounds.behind : INFINITY;
    node->power[i] = (float)g->power;
    node->focus[i] = min_f(1, length);
    node->both_sides[i] = bounds.both_sides ? -1 : 0;
    node->first[i] = g->rank;
    if (g->cells == 1) node->large2[i] = first_emitter(work, g)->cell_area * (1 / EMITTER_LARGE);
    double extent2 =
        fmax(g->spread2 + g->within2, FAR_RADIUS * (double)(bounds.radius * bounds.radius));
    node->far2[i] = (double)bounds.cosine > FOCUSED ? (float)(extent2 / FAR) : INFINITY;
    set_directions(work, g, i, frame, node);
}

static bool is_leaf(const TreeWork *work, const Gathering *g) {
    const double *n = g->normal;
    uint32_t most = first_emitter(work, g)->side >= FINE_SIDE ? LEAF_CELLS : 1;
    return g->count == 1 || !(g->spread2 > 0) ||
           (g->cells <= most && g->part_id != NO_ID &&
            n[0] * n[0] + n[1] * n[1] + n[2] * n[2] > FLAT);
}

/* Blocks order[first ..] become a node; later its branches become nodes of their own. */
static EmitterNode *build_node(TreeWork *work, Gathering whole, int level) {
    EmitterNode *node = ARENA_NEW(work->arena, EmitterNode, 1);
    Branches branches = {.of = {whole}, .count = 1};
    split_all(work, &branches);
    qsort(branches.of, (size_t)branches.count, sizeof *branches.of, by_first);
    node->count = branches.count;
    for (int i = 0; i < branches.count; i++) {
        Gathering *g = &branches.of[i];
        g->rank = i ? g[-1].rank + g[-1].cells : whole.rank;
        finish_branch(work, g, i, node);
        if (branches.count > 1 && level < DEEPEST && !is_leaf(work, g))
            node->child[i] = build_node(work, *g, level + 1);
    }
    node->share = node->power / spectrum_all(spectrum_sum(node->power));
    return node;
}

/* Builds, once the order of cells is known, the choice among those of every branch. */
static void finish_choices(EmitterNode *node, uint32_t end, const double *weight, Arena *arena) {
    for (int i = 0; i < node->count; i++) {
        uint32_t last = i + 1 < node->count ? node->first[i + 1] : end;
        node->choice[i] = alias_build(weight + node->first[i], (int)(last - node->first[i]), arena);
        if (node->child[i]) finish_choices(node->child[i], last, weight, arena);
    }
}

void emitter_tree_build(const Scene *scene, const double *weight, Arena *arena,
                        Emitters *emitters) {
    uint32_t cells = emitters->cell_count;
    TreeWork work = {.scene = scene, .emitters = emitters, .arena = arena, .weight = weight};
    double *by_rank = ARENA_NEW(arena, double, cells);
    uint32_t rank = 0;
    work.cells = ARENA_NEW(arena, uint32_t, cells);
    work.part_centre = (float(*)[3])ARENA_NEW(arena, float, 3 * ((size_t)scene->part_count + 1));
    work.profile = ARENA_NEW(arena, const EmitterProfile *, scene->part_count + 1);
    emitters->cell_rank = ARENA_NEW(arena, uint32_t, cells);
    emitters->by_rank = ARENA_NEW(arena, EmitterChoice, cells);
    work.facts = ARENA_NEW(arena, EmitterFacts, emitters->count);
    for (int e = 0; e < emitters->count; e++)
        work.facts[e] = facts_about(&work, &emitters->emitters[e]);
    size_t blocks = count_blocks(emitters);
    work.blocks = ARENA_NEW(arena, CellBlock, blocks);
    work.order = ARENA_NEW(arena, uint32_t, blocks);
    make_blocks(&work);
    Gathering all = {.first = 0, .count = work.block_count};
    measure(&work, &all);
    emitters->root = build_node(&work, all, 0);
    for (uint32_t i = 0; i < work.block_count; i++) {
        const CellBlock *block = block_at(&work, i);
        for (uint32_t c = block->first; c < block->first + block->count; c++, rank++) {
            uint32_t cell = work.cells[c];
            by_rank[rank] = weight[cell];
            emitters->cell_rank[cell] = rank;
            emitters->by_rank[rank] = (EmitterChoice){cell, emitters->cell_emitter[cell]};
        }
    }
    finish_choices(emitters->root, cells, by_rank, arena);
}
