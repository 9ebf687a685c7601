/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/tree_query.h"

#include <string.h>

#include "base/mathf.h"
#include "hemisphere/rows.h"
#include "hemisphere/tree/tree_sum.h"
#include "hemisphere/tree/vertex_open.h"
#include "hemisphere/tree/vertex_query.h"

static const uint32_t NO_NODE = UINT32_MAX;

static uint32_t octant_in_tree(const Tree *tree, uint32_t octant) {
    return octant & ((uint32_t)tree->octants - 1); /* 2 octants: y is folded */
}

/* Bits that are set in a number below 8 (the baseline instruction set cannot count bits). */
static uint32_t bits_of_3(uint32_t number) {
    return 0xe994u >> 2 * number & 3;
}

/* The node of a child, if it has one. */
static uint32_t child_node(TreeNode node, uint32_t child) {
    uint32_t before = node.children & ((1u << child) - 1);
    return node.children >> child & 1 ? (node.children >> 4) + bits_of_3(before) : NO_NODE;
}

static void start_taps(TreeTaps *taps) {
    taps->count = 0;
    for (int q = 0; q < 4; q++) taps->mean_weight[q] = 0;
}

/* Writes a tap; it is kept when there is such a row and its weight is not 0. Whether that is so
 * cannot be predicted, so there is no branch. */
static inline int put_tap(TreeTaps *taps, int count, uint32_t row, float weight, int level,
                          uint32_t stored) {
    taps->row[count] = row;
    taps->weight[count] = weight;
    taps->level[count] = (uint8_t)level;
    return count + (int)(stored & (bits_from_float(weight) << 1 != 0));
}

/* Adds the rows of a node whose children count with the lanes of weight: child i = 1..3 adds
 * its detail, child 0 takes ratio_i of it away (haar.h). ratio: of all four children. */
static inline void add_rows(TreeTaps *taps, TreeNode node, int level, Float4 weight,
                            const float *ratio) {
    uint32_t first = node.rows & 1, second = node.rows >> 1 & 1, third = node.rows >> 2 & 1;
    uint32_t row = node.rows >> 3;
    Float4 w = weight - weight[0] * load_floats(ratio);
    int count = put_tap(taps, taps->count, row, w[1], level, first);
    count = put_tap(taps, count, row + first, w[2], level, second);
    taps->count = put_tap(taps, count, row + first + second, w[3], level, third);
}

static const float *area_ratio(const Tree *tree, int level, uint32_t place) {
    static const float equal[4] = {1, 1, 1, 1};
    return tree->has_area_weights ? tree->geodesic->ratios[level][place].of_child : equal;
}

static const Float4 ONE_IN_LANE[4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

/* From a node to its child at `child_place` in the octant, with a weight. */
static uint32_t step_down(const Tree *tree, uint32_t index, int level, uint32_t child_place,
                          float weight, TreeTaps *taps) {
    TreeNode node = tree->nodes[index];
    uint32_t child = child_place & 3;
    add_rows(taps, node, level, weight * ONE_IN_LANE[child],
             area_ratio(tree, level, child_place >> 2));
    return child_node(node, child);
}

/* ---- interpolation ----------------------------------------------------------------------- */

#define MAX_LEAVES 11 /* the leaf and up to 5 more around each of two corners */

/* The leaves that an interpolated value is made of; some may be there twice. */
typedef struct Leaves {
    int count;
    uint32_t id[MAX_LEAVES];
    float weight[MAX_LEAVES];
} Leaves;

static void add_leaf(Leaves *leaves, uint32_t id, float weight) {
    int i = leaves->count++;
    leaves->id[i] = id;
    leaves->weight[i] = weight;
}

/* The leaves around one corner of a leaf, inside its octant: the three at the midpoint of one
 * edge of a larger triangle, and the three of its neighbour across the edge. At the octant's
 * borders the mirror images of these lie around the corner too. */
typedef struct Ring {
    int father_count; /* 2; 1: no neighbour in the octant; 0: the octant's own corner */
    uint32_t father[2];
    uint32_t edge;
    int depth;        /* of the fathers' children above the leaves */
    uint32_t borders; /* bit k: the corner lies on the octant's border opposite corner k */
} Ring;

/* A corner of a leaf was made as the midpoint of an edge of some larger triangle; below that,
 * every triangle at the corner has it in the same place, so that it is as many levels up as the
 * leaf's id has trailing digits corner + 1. Only the octants' corners never were midpoints. */
static Ring ring_around(int level, uint32_t id, uint32_t corner) {
    uint32_t differ = (id ^ 0x55555555u * (corner + 1)) & ((1u << 2 * level) - 1);
    if (differ == 0) return (Ring){.borders = 7u & ~(1u << corner)};
    Ring ring = {.father_count = 2, .depth = __builtin_ctz(differ) / 2};
    uint32_t digit = id >> 2 * ring.depth & 3;
    ring.father[0] = id >> (2 * ring.depth + 2);
    ring.edge = digit == 0 ? corner : 3 - corner - (digit - 1);
    ring.father[1] = geodesic_neighbour(level - ring.depth - 1, ring.father[0], (int)ring.edge);
    if (ring.father[1] == GEODESIC_NONE) {
        ring.father_count = 1;
        ring.borders = 1u << ring.edge;
    }
    return ring;
}

/* id of a triangle `depth` levels above the leaves to that of its leaf at its corner `corner`:
 * a corner child keeps its father's corner in the same place. */
static uint32_t leaf_at_corner(uint32_t id, int depth, uint32_t corner) {
    uint32_t repeated = 0x55555555u * (corner + 1);
    return id << 2 * depth | (repeated & ((1u << 2 * depth) - 1));
}

/* The midpoint of `edge` is the central child's corner `edge`, and in the corner children at
 * the edge's two ends, p and q, it is corner q and p. Returns the count, at most 6. */
static int ring_leaves(const Ring *ring, uint32_t leaf, uint32_t id[6]) {
    uint32_t p = ring->edge == 0 ? 1 : 0, q = 3 - ring->edge - p;
    int count = 0;
    if (ring->father_count == 0) id[count++] = leaf;
    for (int i = 0; i < ring->father_count; i++) {
        uint32_t first = 4 * ring->father[i];
        id[count++] = leaf_at_corner(first, ring->depth, ring->edge);
        id[count++] = leaf_at_corner(first + p + 1, ring->depth, q);
        id[count++] = leaf_at_corner(first + q + 1, ring->depth, p);
    }
    return count;
}

/* Octant bits over whose planes the tree's mirror images count. */
static uint32_t mirrors_of(const Tree *tree, const Ring *ring) {
    return (ring->borders & 3 & ((uint32_t)tree->octants - 1)) << 2 * tree->level;
}

/* Level of the smallest triangle that holds the whole ring; -1: no octant does. */
static int ring_level(const Tree *tree, const Ring *ring) {
    int level = ring->father_count == 0 ? tree->level : tree->level - ring->depth - 1;
    if (mirrors_of(tree, ring)) return -1;
    if (ring->father_count < 2) return level;
    return level - (33 - __builtin_clz(ring->father[0] ^ ring->father[1])) / 2;
}

/* Adds the area mean of the leaves around a corner, times weight; leaf 0 is `leaf` itself. */
static void add_ring(const Tree *tree, const Ring *ring, uint32_t leaf, float weight, Leaves *out) {
    uint32_t mask = (1u << 2 * tree->level) - 1, mirrors = mirrors_of(tree, ring), id[6];
    const float *areas = tree->geodesic->areas[tree->level];
    int count = ring_leaves(ring, leaf, id);
    float area[6], sum = 0;
    for (int i = 0; i < count; i++) sum += area[i] = areas[id[i] & mask];
    float scale = weight / (sum * (float)(1 << __builtin_popcount(mirrors)));
    for (uint32_t flip = 0;; flip = (flip - mirrors) & mirrors) { /* every subset of mirrors */
        for (int i = 0; i < count; i++)
            if ((id[i] ^ flip) == leaf) out->weight[0] += scale * area[i];
            else add_leaf(out, id[i] ^ flip, scale * area[i]);
        if (flip == mirrors) return;
    }
}

/* A triangle of the tree on the way to some of the leaves. */
typedef struct Visit {
    uint32_t node, place; /* place in its octant */
    int level;
    uint32_t leaves; /* bit i: leaf i lies inside */
} Visit;

/* Adds the rows of a triangle with the weights that go to its children, and queues the children
 * that have nodes. inside: four sets of leaves, 16 bits each. Returns how many were queued. */
static int visit(const Tree *tree, const Leaves *leaves, Visit at, TreeTaps *taps, Visit *queue) {
    TreeNode node = tree->nodes[at.node];
    int shift = 2 * (tree->level - at.level - 1), queued = 0;
    Float4 weight = {0, 0, 0, 0};
    uint64_t inside = 0;
    for (uint32_t rest = at.leaves; rest; rest &= rest - 1) {
        int i = __builtin_ctz(rest);
        uint32_t child = leaves->id[i] >> shift & 3;
        weight += leaves->weight[i] * ONE_IN_LANE[child];
        inside |= (uint64_t)1 << (16 * child + (uint32_t)i);
    }
    add_rows(taps, node, at.level, weight, area_ratio(tree, at.level, at.place));
    for (uint32_t child = 0; child < 4; child++, inside >>= 16)
        if (inside & 0xffff && node.children >> child & 1)
            queue[queued++] = (Visit){child_node(node, child), 4 * at.place + child, at.level + 1,
                                      (uint32_t)inside & 0xffff};
    return queued;
}

/* As visit, for a single leaf. */
static int visit_one(const Tree *tree, const Leaves *leaves, Visit at, TreeTaps *taps,
                     Visit *queue) {
    int leaf = __builtin_ctz(at.leaves), shift = 2 * (tree->level - at.level - 1);
    uint32_t place = 4 * at.place + (leaves->id[leaf] >> shift & 3);
    uint32_t node = step_down(tree, at.node, at.level, place, leaves->weight[leaf], taps);
    if (node == NO_NODE) return 0;
    *queue = (Visit){node, place, at.level + 1, at.leaves};
    return 1;
}

/* Everything below the triangles in the queue, level by level: taps of one level follow each
 * other, which tree_sum needs. */
static void visit_below(const Tree *tree, const Leaves *leaves, Visit *queue, int count,
                        TreeTaps *taps) {
    for (int i = 0; i < count && queue[i].level < tree->level; i++) {
        Visit at = queue[i];
        if ((at.leaves & (at.leaves - 1)) == 0)
            count += visit_one(tree, leaves, at, taps, queue + count);
        else count += visit(tree, leaves, at, taps, queue + count);
    }
}

#define MAX_VISITS (MAX_LEAVES * (GEODESIC_MAX_LEVEL + 1))

/* Leaves in several octants, around a corner on the planes between these. */
static void visit_octants(const Tree *tree, const Leaves *leaves, TreeTaps *taps) {
    Visit queue[MAX_VISITS];
    int count = 0;
    for (uint32_t octant = 0; octant < (uint32_t)tree->octants; octant++) {
        uint32_t inside = 0;
        taps->mean_weight[octant] = 0;
        for (int i = 0; i < leaves->count; i++) {
            if (leaves->id[i] >> 2 * tree->level != octant) continue;
            inside |= 1u << i;
            taps->mean_weight[octant] += leaves->weight[i];
        }
        if (inside) queue[count++] = (Visit){octant, 0, 0, inside};
    }
    visit_below(tree, leaves, queue, count, taps);
}

/* Leaves that all lie in one triangle. */
static void visit_triangle(const Tree *tree, const Leaves *leaves, Visit triangle, TreeTaps *taps) {
    Visit queue[MAX_VISITS];
    queue[0] = triangle;
    visit_below(tree, leaves, queue, 1, taps);
}

/* Weights of the interpolation inside one leaf. In the leaf's barycentric coordinates (u, v,
 * w) with the least one m, the triangle between the centre and two corners gives the centre
 * 3m and the corners u-m, v-m, w-m, one of which is 0. */
typedef struct Stencil {
    uint32_t leaf;
    float center_weight;
    int corner_count;
    Ring ring[2];
    float ring_weight[2];
    int common_level; /* of the smallest triangle that holds all leaves; -1: no octant does */
} Stencil;

static Stencil stencil_at(const Tree *tree, const GeodesicPoint *point) {
    const float *w = point->weight;
    float least = w[0] < w[1] ? w[0] : w[1];
    if (w[2] < least) least = w[2];
    Stencil stencil = {.leaf = point->id, .center_weight = 3 * least, .common_level = tree->level};
    for (uint32_t i = 0; i < 3; i++) {
        if (!(w[i] > least)) continue;
        Ring *ring = &stencil.ring[stencil.corner_count];
        *ring = ring_around(tree->level, stencil.leaf, i);
        stencil.ring_weight[stencil.corner_count++] = w[i] - least;
        int level = ring_level(tree, ring);
        if (level < stencil.common_level) stencil.common_level = level;
    }
    return stencil;
}

/* The way down to a leaf: the tree's node on each level (NO_NODE below the last one) and how
 * many taps the levels above it have. */
typedef struct Path {
    GeodesicWalk walk;
    uint32_t node[GEODESIC_MAX_LEVEL + 1];
    int tap_count[GEODESIC_MAX_LEVEL + 1];
} Path;

/* Does no leaf around the walk's direction touch the border of its triangle of `level`? Leaves
 * are at most pi/2 / 2^(tree's level - level) wide in its barycentric coordinates (at an
 * octant's corner), so that twice the power of two is safe. */
static bool is_far_inside(const Tree *tree, const GeodesicWalk *walk, int level) {
    const float *w = walk->weight;
    float margin = (w[0] + w[1] + w[2]) *
                   float_from_bits((128u + (uint32_t)level - (uint32_t)tree->level) << 23);
    return w[0] > margin && w[1] > margin && w[2] > margin;
}

/* Goes to the leaf with weight 1. False: the tree ended early, in a triangle that holds every
 * leaf around, so that the taps are complete. */
static bool walk_to_leaf(const Tree *tree, Path *path, TreeTaps *taps) {
    uint32_t node = path->walk.octant;
    for (int i = 0; i < tree->level; i++) {
        path->node[i] = node;
        path->tap_count[i] = taps->count;
        geodesic_walk_down(tree->geodesic, i, &path->walk);
        if (node == NO_NODE) continue;
        node = step_down(tree, node, i, path->walk.place, 1, taps);
        if (node == NO_NODE && is_far_inside(tree, &path->walk, i + 1)) return false;
    }
    path->node[tree->level] = node;
    path->tap_count[tree->level] = taps->count;
    return true;
}

/* Down to the triangle that holds all leaves there is one way, for weights that sum to one.
 * Where the tree ends on it, the function is constant around: most queries of a small tree.
 * Else the taps below it are made anew, for every leaf. */
void tree_walk_interpolated(const Tree *tree, Vec3 direction, TreeTaps *taps) {
    if (tree->basis == TREE_VERTEX) {
        vertex_tree_walk(tree, direction, taps);
        return;
    }
    Path path = {.walk = geodesic_walk_start(direction)};
    path.walk.octant = octant_in_tree(tree, path.walk.octant);
    start_taps(taps);
    taps->mean_weight[path.walk.octant] = 1;
    if (!walk_to_leaf(tree, &path, taps)) return;
    GeodesicPoint point = geodesic_walk_point(&path.walk, tree->level);
    Stencil stencil = stencil_at(tree, &point);
    int common = stencil.common_level;
    if (common >= 0 && path.node[common] == NO_NODE) return;
    Leaves leaves = {.count = 0};
    add_leaf(&leaves, stencil.leaf, stencil.center_weight);
    for (int r = 0; r < stencil.corner_count; r++)
        add_ring(tree, &stencil.ring[r], stencil.leaf, stencil.ring_weight[r], &leaves);
    taps->count = common < 0 ? 0 : path.tap_count[common];
    if (common < 0) visit_octants(tree, &leaves, taps);
    else
        visit_triangle(tree, &leaves,
                       (Visit){path.node[common], path.walk.place >> 2 * (tree->level - common),
                               common, (1u << leaves.count) - 1},
                       taps);
}

/* ---- walk and sum ------------------------------------------------------------------------ */

void tree_interpolate(const Tree *tree, Vec3 direction, float *out) {
    TreeTaps taps;
    tree_walk_interpolated(tree, direction, &taps);
    tree_sum(tree, &taps, 0, tree->components, out);
}
