#include "hemisphere/tree_query.h"

#include <string.h>

static const uint32_t NO_NODE = UINT32_MAX;

static uint32_t octant_in_tree(const Tree *tree, uint32_t octant)
{
    return octant & ((uint32_t)tree->octants - 1); /* 2 octants: y is folded */
}

static TreeNode node_at(const Tree *tree, uint32_t index)
{
    return index == NO_NODE ? (TreeNode){0, 0} : tree->nodes[index];
}

/* The node of a child, if it has one. */
static uint32_t child_node(TreeNode node, uint32_t child)
{
    uint32_t before = node.children & ((1u << child) - 1);
    if (!(node.children >> child & 1)) return NO_NODE;
    return (node.children >> 4) + (uint32_t)__builtin_popcount(before);
}

static void add_tap(TreeTaps *taps, uint32_t row, float weight, int level)
{
    int i = taps->count++;
    taps->row[i] = row;
    taps->weight[i] = weight;
    taps->level[i] = (uint8_t)level;
}

static void start_taps(TreeTaps *taps)
{
    taps->count = 0;
    for (int q = 0; q < 4; q++) taps->mean_weight[q] = 0;
}

/* Adds the rows of a node whose children count with weight[0..3]: child i = 1..3 adds its
 * detail, child 0 takes ratio_i of it away (haar.h). */
static void add_rows(TreeTaps *taps, TreeNode node, int level, const float weight[4],
                     const float ratio[3])
{
    uint32_t row = node.rows >> 3;
    for (int i = 0; i < 3; i++) {
        if (!(node.rows >> i & 1)) continue;
        float w = weight[i + 1] - weight[0] * ratio[i];
        if (w != 0) add_tap(taps, row, w, level);
        row++;
    }
}

static const float *area_ratio(const Tree *tree, int level, uint32_t place)
{
    static const float equal[3] = {1, 1, 1};
    return tree->weights == HAAR_AREA ? tree->geodesic->nodes[level][place].area_ratio : equal;
}

/* From a node to the child that the walk went to. */
static uint32_t step_down(const Tree *tree, uint32_t index, int level, uint32_t child_place,
                          TreeTaps *taps)
{
    TreeNode node = tree->nodes[index];
    uint32_t child = child_place & 3;
    if (node.rows & 7) {
        float weight[4] = {0, 0, 0, 0};
        weight[child] = 1;
        add_rows(taps, node, level, weight, area_ratio(tree, level, child_place >> 2));
    }
    return child_node(node, child);
}

void tree_walk_mean(const Tree *tree, int level, Vec3 direction, TreeTaps *taps)
{
    GeodesicWalk walk = geodesic_walk_start(direction);
    uint32_t     index = octant_in_tree(tree, walk.octant);
    start_taps(taps);
    taps->mean_weight[index] = 1;
    for (int i = 0; i < level && index != NO_NODE; i++) {
        geodesic_walk_down(tree->geodesic, i, &walk);
        index = step_down(tree, index, i, walk.place, taps);
    }
}

void tree_walk_triangle(const Tree *tree, int level, uint32_t id, TreeTaps *taps)
{
    uint32_t index = octant_in_tree(tree, id >> 2 * level);
    uint32_t place = id & ((1u << 2 * level) - 1);
    start_taps(taps);
    taps->mean_weight[index] = 1;
    for (int i = 0; i < level && index != NO_NODE; i++)
        index = step_down(tree, index, i, place >> 2 * (level - i - 1), taps);
}

/* ---- interpolation ------------------------------------------------------------------------ */

#define MAX_TRIANGLES 13 /* the leaf and up to 6 around each of two corners */

/* Triangles of one level with weights, sorted by id once `sort_triangles` was called. */
typedef struct Triangles {
    int      count;
    uint32_t id[MAX_TRIANGLES];
    float    weight[MAX_TRIANGLES];
    uint32_t node[MAX_TRIANGLES];
} Triangles;

static void add_triangle(Triangles *t, uint32_t id, float weight)
{
    t->id[t->count] = id;
    t->weight[t->count++] = weight;
}

/* The leaves around one corner of a leaf, inside its octant; at the octant's borders the mirror
 * images of these lie around it too. */
typedef struct Ring {
    int      count;
    uint32_t id[6];
    uint32_t borders; /* bit k: the corner lies on the octant's border opposite corner k */
} Ring;

/* Turns around the corner, first crossing edge `first`, until back or at a border. An edge
 * keeps its number on both sides and the corner takes the number that is not on either edge:
 * the edges to cross are first, corner, third, first, ... (geodesic_neighbour). */
static void turn(int level, uint32_t id, int corner, int first, Ring *ring)
{
    int      third = 3 - corner - first;
    int      edges[3] = {first, corner, third};
    uint32_t next = id;
    for (int i = 0; i < 6; i++) {
        next = geodesic_neighbour(level, next, edges[i % 3]);
        if (next == GEODESIC_NONE) {
            ring->borders |= 1u << edges[i % 3];
            return;
        }
        if (next == id) return;
        ring->id[ring->count++] = next;
    }
}

static Ring ring_around(int level, uint32_t id, int corner)
{
    Ring ring = {.count = 1, .id = {id}};
    turn(level, id, corner, (corner + 1) % 3, &ring);
    if (ring.borders) turn(level, id, corner, (corner + 2) % 3, &ring);
    return ring;
}

/* Adds the area mean of the leaves around a corner, times weight. */
static void add_corner(const Tree *tree, uint32_t id, int corner, float weight, Triangles *out)
{
    int          level = tree->level;
    uint32_t     flips = ((uint32_t)tree->octants - 1) << 2 * level;
    uint32_t     mask = (1u << 2 * level) - 1;
    const float *areas = tree->geodesic->areas[level];
    Ring         ring = ring_around(level, id, corner);
    uint32_t     mirrors = (ring.borders & 3) << 2 * level & flips;
    float        sum = 0;
    for (int i = 0; i < ring.count; i++) sum += areas[ring.id[i] & mask];
    float scale = weight / (sum * (float)(1 << __builtin_popcount(mirrors)));
    for (uint32_t flip = 0;; flip = (flip - mirrors) & mirrors) { /* every subset of mirrors */
        for (int i = 0; i < ring.count; i++)
            add_triangle(out, ring.id[i] ^ flip, scale * areas[ring.id[i] & mask]);
        if (flip == mirrors) return;
    }
}

/* By id, equal ids joined. */
static void sort_triangles(Triangles *t)
{
    int count = 0;
    for (int i = 0; i < t->count; i++) {
        uint32_t id = t->id[i];
        float    weight = t->weight[i];
        int      at = count;
        while (at > 0 && t->id[at - 1] > id) at--;
        if (at > 0 && t->id[at - 1] == id) {
            t->weight[at - 1] += weight;
            continue;
        }
        memmove(&t->id[at + 1], &t->id[at], (size_t)(count - at) * sizeof t->id[0]);
        memmove(&t->weight[at + 1], &t->weight[at], (size_t)(count - at) * sizeof t->weight[0]);
        t->id[at] = id;
        t->weight[at] = weight;
        count++;
    }
    t->count = count;
}

/* The fathers of sorted triangles, with the sums of their children's weights. */
static void fathers_of(const Triangles *children, Triangles *fathers)
{
    fathers->count = 0;
    for (int i = 0; i < children->count; i++) {
        uint32_t id = children->id[i] >> 2;
        if (fathers->count == 0 || fathers->id[fathers->count - 1] != id)
            add_triangle(fathers, id, 0);
        fathers->weight[fathers->count - 1] += children->weight[i];
    }
}

/* Adds the rows of all fathers of a level and finds their children's nodes. */
static void walk_level(const Tree *tree, int level, const Triangles *fathers,
                       Triangles *children, TreeTaps *taps)
{
    uint32_t mask = (1u << 2 * level) - 1;
    int      child = 0;
    for (int i = 0; i < fathers->count; i++) {
        TreeNode node = node_at(tree, fathers->node[i]);
        float    weight[4] = {0, 0, 0, 0};
        for (; child < children->count && children->id[child] >> 2 == fathers->id[i]; child++) {
            uint32_t digit = children->id[child] & 3;
            weight[digit] = children->weight[child];
            children->node[child] = child_node(node, digit);
        }
        if (node.rows & 7)
            add_rows(taps, node, level, weight, area_ratio(tree, level, fathers->id[i] & mask));
    }
}

/* In the leaf's barycentric coordinates (u, v, w) with the least one m, the triangle between
 * centre and two corners gives the centre 3m and the corners u-m, v-m, w-m (one of them 0). */
static void find_leaves(const Tree *tree, Vec3 direction, Triangles *out)
{
    GeodesicPoint point = geodesic_find(tree->geodesic, tree->level, direction);
    const float  *w = point.weight;
    float         least = w[0] < w[1] ? w[0] : w[1];
    if (w[2] < least) least = w[2];
    uint32_t id = point.id & (((uint32_t)tree->octants << 2 * tree->level) - 1);
    out->count = 0;
    add_triangle(out, id, 3 * least);
    for (int i = 0; i < 3; i++)
        if (w[i] > least) add_corner(tree, id, i, w[i] - least, out);
    sort_triangles(out);
}

void tree_walk_interpolated(const Tree *tree, Vec3 direction, TreeTaps *taps)
{
    Triangles levels[GEODESIC_MAX_LEVEL + 1];
    find_leaves(tree, direction, &levels[tree->level]);
    for (int i = tree->level; i > 0; i--) fathers_of(&levels[i], &levels[i - 1]);
    start_taps(taps);
    for (int i = 0; i < levels[0].count; i++) {
        levels[0].node[i] = levels[0].id[i];
        taps->mean_weight[levels[0].id[i]] = levels[0].weight[i];
    }
    for (int i = 0; i < tree->level; i++) walk_level(tree, i, &levels[i], &levels[i + 1], taps);
}

/* ---- sums ----------------------------------------------------------------------------------- */

static void add_means(const Tree *tree, const TreeTaps *taps, int first, int count, float *out)
{
    for (int i = 0; i < count; i++) out[i] = 0;
    for (int q = 0; q < tree->octants; q++) {
        float        weight = taps->mean_weight[q];
        const float *mean = tree->means + q * tree->components + first;
        if (weight == 0) continue;
        for (int i = 0; i < count; i++) out[i] += weight * mean[i];
    }
}

void tree_sum(const Tree *tree, const TreeTaps *taps, int first, int count, float *out)
{
    size_t components = (size_t)tree->components;
    add_means(tree, taps, first, count, out);
    for (int t = 0; t < taps->count; t++) {
        float  weight = taps->weight[t];
        size_t offset = taps->row[t] * components + (size_t)first;
        if (tree->format == TREE_ROWS_FLOAT) {
            const float *row = (const float *)tree->rows + offset;
            for (int i = 0; i < count; i++) out[i] += weight * row[i];
        } else {
            const int16_t *row = (const int16_t *)tree->rows + offset;
            const float *scale = tree->scales + taps->level[t] * components + (size_t)first;
            for (int i = 0; i < count; i++) out[i] += weight * (scale[i] * (float)row[i]);
        }
    }
}

void tree_mean(const Tree *tree, int level, Vec3 direction, float *out)
{
    TreeTaps taps;
    tree_walk_mean(tree, level, direction, &taps);
    tree_sum(tree, &taps, 0, tree->components, out);
}

void tree_interpolate(const Tree *tree, Vec3 direction, float *out)
{
    TreeTaps taps;
    tree_walk_interpolated(tree, direction, &taps);
    tree_sum(tree, &taps, 0, tree->components, out);
}
