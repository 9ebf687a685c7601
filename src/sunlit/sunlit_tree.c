/* SPDX-License-Identifier: Apache-2.0 */
#include "sunlit/sunlit_tree.h"

#include "base/mathf.h"

/* Four quarters are one leaf where they are alike. */
#define MERGED_LEVELS 4 /* of pixels: the most that a leaf has */
#define EVEN 0.6f       /* least over greatest power */
#define FLAT 0.97f      /* least cosine of its cone of normals */
#define SMOOTH 2.4f     /* its radius, over that of the greatest quarter: 2 on a plane */

/* A quarter of any size. */
typedef struct SunlitNode {
    Vec3 centre, axis;
    float radius, cosine, power;
    uint32_t child;
} SunlitNode;

typedef struct SunlitTree {
    const SunlitGrid *grid;
    SunlitQuarters *nodes;
    uint32_t count, room;
    Arena *arena; /* nothing else allocates from it meanwhile */
} SunlitTree;

static SunlitNode node_of(const SunlitTree *tree, const SunlitPixel *pixel) {
    Vec3 across = vec3_sub(pixel->high, pixel->low);
    float length = vec3_length(pixel->normals);
    /* its corners may lie farther out than its rays landed */
    SunlitNode node = {.centre = vec3_scale(vec3_add(pixel->low, pixel->high), 0.5f),
                       .radius = 0.5f * vec3_length(across) + tree->grid->pitch,
                       .power = pixel->power,
                       .cosine = -1};
    if (!(length > 0)) return node;
    node.axis = vec3_scale(pixel->normals, 1 / length);
    float mean = length / (float)pixel->landed; /* 1: all alike */
    node.cosine = pixel->both_sides ? -1 : clampf(2 * mean - 1, -1, 0.9999f);
    return node;
}

/* Half the angles' sum, by cosines: of a cone about `axis` that holds another. */
static float cone_about(Vec3 axis, const SunlitNode *node) {
    float away = vec3_dot(axis, node->axis);
    float sines = safe_sqrtf(1 - away * away) * safe_sqrtf(1 - node->cosine * node->cosine);
    bool is_all = node->cosine <= -1 || away <= -node->cosine;
    return is_all ? -1 : away * node->cosine - sines;
}

static SunlitNode joined(const SunlitNode four[4]) {
    SunlitNode all = {.cosine = 1};
    Vec3 low = vec3(INFINITY, INFINITY, INFINITY), high = vec3_neg(low), axis = {0};
    for (int k = 0; k < 4; k++) {
        const SunlitNode *n = &four[k];
        if (!(n->power > 0)) continue;
        Vec3 r = vec3(n->radius, n->radius, n->radius);
        Vec3 a = vec3_sub(n->centre, r), b = vec3_add(n->centre, r);
        low = vec3(min_f(low.x, a.x), min_f(low.y, a.y), min_f(low.z, a.z));
        high = vec3(max_f(high.x, b.x), max_f(high.y, b.y), max_f(high.z, b.z));
        axis = vec3_along(axis, n->axis, n->power);
        all.power += n->power;
    }
    if (!(all.power > 0)) return all;
    all.centre = vec3_scale(vec3_add(low, high), 0.5f);
    all.axis = vec3_length(axis) > 0 ? vec3_normalize(axis) : vec3(0, 0, 1);
    for (int k = 0; k < 4; k++) {
        if (!(four[k].power > 0)) continue;
        float out = vec3_length(vec3_sub(four[k].centre, all.centre)) + four[k].radius;
        all.radius = max_f(all.radius, out);
        all.cosine = min_f(all.cosine, cone_about(all.axis, &four[k]));
    }
    return all;
}

static bool is_one_leaf(const SunlitNode *all, const SunlitNode four[4]) {
    float least = INFINITY, most = 0, radius = 0;
    for (int k = 0; k < 4; k++) {
        if (four[k].child) return false;
        least = min_f(least, four[k].power);
        most = max_f(most, four[k].power);
        radius = max_f(radius, four[k].radius);
    }
    return least >= EVEN * most && all->cosine >= FLAT && all->radius <= SMOOTH * radius;
}

static SunlitQuarters side_by_side(const SunlitNode four[4]) {
    SunlitQuarters out;
    for (int k = 0; k < 4; k++) {
        const SunlitNode *n = &four[k];
        const Vec3 c = n->centre, axis = n->axis;
        const float centre[3] = {c.x, c.y, c.z}, normal[3] = {axis.x, axis.y, axis.z};
        for (int i = 0; i < 3; i++) {
            out.centre[i][k] = centre[i];
            out.axis[i][k] = normal[i];
        }
        out.square[k] = n->power > 0 ? n->radius * n->radius : 1;
        out.cosine[k] = n->cosine;
        out.sine[k] = safe_sqrtf(1 - n->cosine * n->cosine);
        out.power[k] = n->power;
        out.child[k] = n->child;
    }
    return out;
}

/* Returns their number. */
static uint32_t add_four(SunlitTree *tree, const SunlitNode four[4]) {
    if (tree->count == tree->room) {
        tree->nodes =
            ARENA_GROW(tree->arena, SunlitQuarters, tree->nodes, tree->count, 2 * tree->room);
        tree->room *= 2;
    }
    tree->nodes[tree->count] = side_by_side(four);
    return tree->count++;
}

/* The square of 2^level pixels a side from (i, j) on. */
static SunlitNode grow(SunlitTree *tree, int level, int i, int j) {
    const SunlitGrid *grid = tree->grid;
    if (level <= grid->fine) {
        const SunlitPixel *pixel = sunlit_pixel(grid, i, j);
        if (!pixel) return (SunlitNode){.power = 0};
        bool is_lit = pixel->landed && pixel->power > 0;
        if (!level) return is_lit ? node_of(tree, pixel) : (SunlitNode){.power = 0};
    }
    SunlitNode four[4];
    int half = 1 << (level - 1);
    for (int k = 0; k < 4; k++)
        four[k] = grow(tree, level - 1, i + (k & 1) * half, j + (k >> 1) * half);
    SunlitNode all = joined(four);
    if (!(all.power > 0)) return all;
    if (level > MERGED_LEVELS || !is_one_leaf(&all, four)) all.child = add_four(tree, four);
    return all;
}

const SunlitQuarters *sunlit_tree(const SunlitGrid *grid, Arena *arena) {
    SunlitTree tree = {grid, NULL, 1, 256, arena};
    tree.nodes = ARENA_NEW(arena, SunlitQuarters, tree.room);
    SunlitNode root = grow(&tree, SUNLIT_LEVELS + grid->fine, 0, 0);
    if (!(root.power > 0)) return NULL;
    tree.nodes[0] = tree.nodes[root.child]; /* of so large a square always its last */
    return tree.nodes;
}
