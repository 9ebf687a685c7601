/* SPDX-License-Identifier: Apache-2.0 */
/* Before the first path: the tree of emitters, and the directions of displays. */
#include "light/emitter_tree.h"

#include <math.h>
#include <stdlib.h>

#include "panel/query/panel_emission.h"

#define PROFILE_CODES 8  /* of the content, whose directions are averaged */
#define LEAF_CELLS 8     /* pieces of one picture need no branches of their own */
#define FINE_SIDE 16     /* a triangle in so many pieces a side shows a picture */
#define FLAT 0.999998    /* the least cosine between a flat branch's normals and their mean */
#define FAR 0.01         /* mean square extent over square distance of a branch that is far */
#define FAR_RADIUS 0.2   /* of the square radius, which counts at least as extent there */
#define FOCUSED 0.95     /* only branches whose cells all face about one way are ever far */
#define DEEPEST 24       /* levels; cells at one place are not split for ever */

/* A branch while it is made: cells order[first .. first + count - 1]. */
typedef struct Gathering {
    uint32_t first, count;
    int      part_id; /* NO_ID: of several */
    bool     is_done; /* cannot be split */
    double   power, centre[3], normal[3];
    double   spread2; /* mean square distance of cells from the centre, m^2, */
    double   within2; /* and that of a cell's points from its middle */
    int      longest; /* axis along which the cells spread most */
} Gathering;

/* Facts of an emitter that are used again and again. */
typedef struct EmitterFacts {
    Vec3  normal;
    float edge;    /* m, the longest of a cell */
    float within2; /* m^2, mean square distance of its points from its middle: a 36th of the
                      sum of its edges' squares */
    int   part_id;
    bool  is_display, both_sides;
} EmitterFacts;

typedef struct TreeWork {
    const Scene    *scene;
    Emitters       *emitters;
    Arena          *arena;
    const double   *weight;
    uint32_t       *order;
    EmitterFacts   *facts; /* of every emitter */
    float         (*position)[3]; /* of every cell's centroid */
    float         (*part_centre)[3];
    const EmitterProfile **profile; /* of every part that is a display, once asked for */
} TreeWork;

/* Branches of one node while they are made. */
typedef struct Branches {
    Gathering of[EMITTER_BRANCHES];
    int       count;
} Branches;

static const Emitter *emitter_of(const TreeWork *work, uint32_t cell)
{
    return &work->emitters->emitters[work->emitters->cell_emitter[cell]];
}

static const EmitterFacts *facts_of(const TreeWork *work, uint32_t cell)
{
    return &work->facts[work->emitters->cell_emitter[cell]];
}

static int part_id_of(const TreeWork *work, uint32_t cell)
{
    return facts_of(work, cell)->part_id;
}

static const Material *material_of(const TreeWork *work, int part_id)
{
    return &work->scene->materials[work->scene->parts[part_id].material_id];
}

static TrianglePoint cell_point(const TreeWork *work, uint32_t cell)
{
    const Emitter *e = emitter_of(work, cell);
    EmitterCell at = emitter_cell(e, cell);
    float inside = at.is_turned ? 2 / 3.0f : 1 / 3.0f, step = 1 / (float)at.side;
    return triangle_point(work->scene, e->triangle, ((float)at.i + inside) * step,
                          ((float)at.j + inside) * step);
}

/* The middle of a cell, as cell_point has it. */
static Vec3 cell_position(const TreeWork *work, uint32_t cell)
{
    const Emitter *e = emitter_of(work, cell);
    EmitterCell at = emitter_cell(e, cell);
    float inside = at.is_turned ? 2 / 3.0f : 1 / 3.0f, step = 1 / (float)at.side;
    return triangle_position(work->scene, e->triangle, ((float)at.i + inside) * step,
                             ((float)at.j + inside) * step);
}

static EmitterFacts facts_about(const TreeWork *work, const Emitter *e)
{
    EmitterFacts facts = {.part_id = (int)work->scene->triangles[e->triangle].part_id};
    const Material *m =
        &work->scene->materials[work->scene->parts[facts.part_id].material_id];
    TrianglePoint corner[3];
    for (int k = 0; k < 3; k++)
        corner[k] = triangle_point(work->scene, e->triangle, k == 1, k == 2);
    for (int k = 0; k < 3; k++) {
        Vec3 edge = vec3_sub(corner[k].position, corner[(k + 1) % 3].position);
        facts.edge = fmaxf(facts.edge, vec3_length(edge) / (float)e->side);
        facts.within2 += vec3_dot(edge, edge) / (36 * (float)(e->side * e->side));
    }
    facts.normal = corner[0].ng;
    facts.is_display = m->display_id != NO_ID;
    facts.both_sides = m->double_sided && !facts.is_display;
    return facts;
}

/* Sets the centroids of cells, and of parts weighted by power. */
static void find_positions(TreeWork *work)
{
    double *power = ARENA_NEW(work->arena, double, work->scene->part_count + 1);
    for (uint32_t c = 0; c < work->emitters->cell_count; c++) {
        Vec3 p = cell_position(work, c);
        int  part_id = part_id_of(work, c);
        work->position[c][0] = p.x;
        work->position[c][1] = p.y;
        work->position[c][2] = p.z;
        power[part_id] += work->weight[c];
        float share = power[part_id] > 0 ? (float)(work->weight[c] / power[part_id]) : 0;
        for (int k = 0; k < 3; k++)
            work->part_centre[part_id][k] +=
                share * (work->position[c][k] - work->part_centre[part_id][k]);
    }
}

/* Power, centre, extent, mean normal and part of a branch's cells. */
static void measure(const TreeWork *work, Gathering *g)
{
    double squares[3] = {0};
    g->power = g->spread2 = g->within2 = 0;
    for (int k = 0; k < 3; k++) g->centre[k] = g->normal[k] = 0;
    g->part_id = part_id_of(work, work->order[g->first]);
    for (uint32_t i = 0; i < g->count; i++) {
        uint32_t cell = work->order[g->first + i];
        double   w = work->weight[cell];
        const EmitterFacts *facts = facts_of(work, cell);
        const double normal[3] = {(double)facts->normal.x, (double)facts->normal.y,
                                  (double)facts->normal.z};
        if (facts->part_id != g->part_id) g->part_id = NO_ID;
        g->power += w;
        g->within2 += w * (double)facts->within2;
        for (int k = 0; k < 3; k++) {
            double p = (double)work->position[cell][k];
            g->centre[k] += w * p;
            g->normal[k] += w * normal[k];
            squares[k] += w * p * p;
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

/* Sorts the cells below the centre along the longest axis to the front; returns how many.
 * by_parts: displays are kept whole, since the directions of a branch are those of one. */
static uint32_t divide(TreeWork *work, const Gathering *g, bool by_parts)
{
    uint32_t *order = work->order + g->first, below = 0;
    double    centre = g->centre[g->longest];
    for (uint32_t i = 0; i < g->count; i++) {
        uint32_t     cell = order[i];
        const float *at = work->position[cell];
        if (by_parts && facts_of(work, cell)->is_display)
            at = work->part_centre[part_id_of(work, cell)];
        if (!((double)at[g->longest] < centre)) continue;
        order[i] = order[below];
        order[below++] = cell;
    }
    return below;
}

/* False: one half would be empty or dark. */
static bool split(TreeWork *work, Branches *branches, int i)
{
    Gathering *g = &branches->of[i], half = *g, rest = *g;
    uint32_t   below = g->part_id == NO_ID ? divide(work, g, true) : 0;
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
static void split_all(TreeWork *work, Branches *branches)
{
    while (branches->count < EMITTER_BRANCHES) {
        int    best = -1;
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

static int by_first(const void *a, const void *b)
{
    const Gathering *x = a, *y = b;
    return x->first < y->first ? -1 : x->first > y->first;
}

/* ---- directions of displays -------------------------------------------------------------- */

/* Codes of the content, each standing for the same share of the light. */
static void choose_codes(const TreeWork *work, int part_id, float codes[PROFILE_CODES][3])
{
    const Part     *part = &work->scene->parts[part_id];
    const Display  *display = &work->scene->displays[material_of(work, part_id)->display_id];
    const Emitter  *first = &work->emitters->emitters[work->emitters->first_of_part[part_id]];
    const Emitter  *last = first + part->triangle_count - 1;
    uint32_t begin = first->first_cell, end = last->first_cell +
                                              (uint32_t)(last->side * last->side);
    double   total = 0, sum = 0;
    int      k = 0;
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
static Vec3 node_direction(int i, int j)
{
    float s = 2 * (float)i / (EMITTER_PROFILE_SIDE - 1) - 1;
    float t = 2 * (float)j / (EMITTER_PROFILE_SIDE - 1) - 1;
    float x = 0.5f * (s + t), y = 0.5f * (s - t);
    return vec3_normalize(vec3(x, y, fmaxf(0, 1 - fabsf(x) - fabsf(y))));
}

static const EmitterProfile *profile_of(const TreeWork *work, int part_id)
{
    const Panel    *panel =
        work->scene->displays[material_of(work, part_id)->display_id].panel;
    EmitterProfile *profile = ARENA_NEW(work->arena, EmitterProfile, 1);
    float           codes[PROFILE_CODES][3], mean = 0;
    choose_codes(work, part_id, codes);
    for (int k = 0; k < PROFILE_CODES; k++) mean += panel_mean_luminance(panel, codes[k]);
    for (int j = 0; j < EMITTER_PROFILE_SIDE; j++)
        for (int i = 0; i < EMITTER_PROFILE_SIDE; i++) {
            float xyz[3], sum = 0;
            Vec3  d = node_direction(i, j);
            for (int k = 0; k < PROFILE_CODES; k++) {
                panel_emission_xyz(panel, d, codes[k], xyz);
                sum += xyz[1];
            }
            profile->value[j * EMITTER_PROFILE_SIDE + i] = mean > 0 ? d.z * sum / mean : d.z;
        }
    return profile;
}

/* The display's frame at the cell nearest to the branch's centre. */
static Frame display_frame_of(const TreeWork *work, const Gathering *g)
{
    const Material *material = material_of(work, g->part_id);
    uint32_t nearest = work->order[g->first];
    double   least = INFINITY;
    for (uint32_t i = 0; i < g->count; i++) {
        uint32_t cell = work->order[g->first + i];
        double   d2 = 0;
        for (int k = 0; k < 3; k++)
            d2 += ((double)work->position[cell][k] - g->centre[k]) *
                  ((double)work->position[cell][k] - g->centre[k]);
        if (d2 < least) nearest = cell;
        if (d2 < least) least = d2;
    }
    TrianglePoint point = cell_point(work, nearest);
    return display_frame(work->scene, &work->scene->displays[material->display_id],
                         emitter_of(work, nearest)->triangle, &point);
}

/* ---- nodes ------------------------------------------------------------------------------- */

/* Bounds of a branch: how far cells reach, whether all face the same way, from where none of
 * them is seen. */
typedef struct Bounds {
    float radius, behind; /* m */
    float cosine;         /* the least between a cell's normal and the mean one */
    bool  both_sides;
} Bounds;

static Bounds bounds_of(const TreeWork *work, const Gathering *g, Vec3 centre, Vec3 normal)
{
    Bounds   bounds = {.cosine = 1};
    float    reach = 0, size = 0;
    for (uint32_t i = 0; i < g->count; i++) {
        uint32_t cell = work->order[g->first + i];
        const EmitterFacts *facts = facts_of(work, cell);
        const float *p = work->position[cell];
        Vec3  off = vec3_sub(centre, vec3(p[0], p[1], p[2]));
        float far = vec3_length(off) + facts->edge; /* corners are less than an edge away */
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

static void set_lane3(Spectrum lanes[3], int i, Vec3 value)
{
    lanes[0][i] = value.x;
    lanes[1][i] = value.y;
    lanes[2][i] = value.z;
}

static void set_directions(const TreeWork *work, const Gathering *g, int i, Frame frame,
                           EmitterNode *node)
{
    if (g->part_id != NO_ID && material_of(work, g->part_id)->display_id != NO_ID) {
        if (!work->profile[g->part_id])
            work->profile[g->part_id] = profile_of(work, g->part_id);
        node->profile[i] = work->profile[g->part_id];
        node->has_displays = true;
        frame = display_frame_of(work, g);
    }
    set_lane3(node->axis[0], i, frame.x);
    set_lane3(node->axis[1], i, frame.y);
    set_lane3(node->axis[2], i, frame.z);
}

static void finish_branch(const TreeWork *work, const Gathering *g, int i, EmitterNode *node)
{
    Vec3   centre = vec3((float)g->centre[0], (float)g->centre[1], (float)g->centre[2]);
    Vec3   mean = vec3((float)g->normal[0], (float)g->normal[1], (float)g->normal[2]);
    float  length = vec3_length(mean);
    Frame  frame = frame_from_z(length > 1e-3f ? vec3_scale(mean, 1 / length) : vec3(0, 0, 1));
    Bounds bounds = bounds_of(work, g, centre, frame.z);
    bool   has_back = (double)bounds.cosine > FLAT && !bounds.both_sides;
    set_lane3(node->centre, i, centre);
    set_lane3(node->normal, i, has_back ? frame.z : vec3(0, 0, 0));
    node->spread2[i] = (float)(g->spread2 + g->within2);
    node->radius[i] = bounds.radius;
    node->behind[i] = has_back ? bounds.behind : INFINITY;
    node->power[i] = (float)g->power;
    node->focus[i] = fminf(1, length);
    node->both_sides[i] = bounds.both_sides ? -1 : 0;
    node->first[i] = g->first;
    if (g->count == 1)
        node->large2[i] =
            emitter_of(work, work->order[g->first])->cell_area * (1 / EMITTER_LARGE);
    double extent2 = fmax(g->spread2 + g->within2,
                          FAR_RADIUS * (double)(bounds.radius * bounds.radius));
    node->far2[i] = (double)bounds.cosine > FOCUSED ? (float)(extent2 / FAR) : INFINITY;
    set_directions(work, g, i, frame, node);
}

static bool is_leaf(const TreeWork *work, const Gathering *g)
{
    const double  *n = g->normal;
    const Emitter *first = emitter_of(work, work->order[g->first]);
    uint32_t       most = first->side >= FINE_SIDE ? LEAF_CELLS : 1;
    return g->count == 1 || !(g->spread2 > 0) ||
           (g->count <= most && g->part_id != NO_ID &&
            n[0] * n[0] + n[1] * n[1] + n[2] * n[2] > FLAT);
}

/* Cells order[first ..] become a node; later its branches become nodes of their own. */
static EmitterNode *build_node(TreeWork *work, Gathering whole, int level)
{
    EmitterNode *node = ARENA_NEW(work->arena, EmitterNode, 1);
    Branches     branches = {.of = {whole}, .count = 1};
    split_all(work, &branches);
    qsort(branches.of, (size_t)branches.count, sizeof *branches.of, by_first);
    node->count = branches.count;
    for (int i = 0; i < branches.count; i++) {
        const Gathering *g = &branches.of[i];
        finish_branch(work, g, i, node);
        if (branches.count > 1 && level < DEEPEST && !is_leaf(work, g))
            node->child[i] = build_node(work, *g, level + 1);
    }
    node->share = node->power / spectrum_all(spectrum_sum(node->power));
    return node;
}

/* Builds, once the order of cells is known, the choice among those of every branch. */
static void finish_choices(EmitterNode *node, uint32_t end, const double *weight,
                           Arena *arena)
{
    for (int i = 0; i < node->count; i++) {
        uint32_t last = i + 1 < node->count ? node->first[i + 1] : end;
        node->choice[i] =
            alias_build(weight + node->first[i], (int)(last - node->first[i]), arena);
        if (node->child[i]) finish_choices(node->child[i], last, weight, arena);
    }
}

void emitter_tree_build(const Scene *scene, const double *weight, Arena *arena,
                        Emitters *emitters)
{
    uint32_t cells = emitters->cell_count;
    TreeWork work = {.scene = scene, .emitters = emitters, .arena = arena, .weight = weight};
    double  *by_rank = ARENA_NEW(arena, double, cells);
    work.order = ARENA_NEW(arena, uint32_t, cells);
    work.position = (float(*)[3])ARENA_NEW(arena, float, 3 * (size_t)cells);
    work.part_centre =
        (float(*)[3])ARENA_NEW(arena, float, 3 * ((size_t)scene->part_count + 1));
    work.profile = ARENA_NEW(arena, const EmitterProfile *, scene->part_count + 1);
    emitters->cell_rank = ARENA_NEW(arena, uint32_t, cells);
    emitters->by_rank = ARENA_NEW(arena, EmitterChoice, cells);
    for (uint32_t c = 0; c < cells; c++) work.order[c] = c;
    work.facts = ARENA_NEW(arena, EmitterFacts, emitters->count);
    for (int e = 0; e < emitters->count; e++)
        work.facts[e] = facts_about(&work, &emitters->emitters[e]);
    find_positions(&work);
    Gathering all = {.first = 0, .count = cells};
    measure(&work, &all);
    emitters->root = build_node(&work, all, 0);
    for (uint32_t r = 0; r < cells; r++) {
        uint32_t cell = work.order[r];
        by_rank[r] = weight[cell];
        emitters->cell_rank[cell] = r;
        emitters->by_rank[r] = (EmitterChoice){cell, emitters->cell_emitter[cell]};
    }
    finish_choices(emitters->root, cells, by_rank, arena);
}
