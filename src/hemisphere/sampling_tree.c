#include "hemisphere/sampling_tree.h"

#include "base/mathf.h"

#define BELOW_ONE 0x1.fffffep-1f

typedef struct Choice {
    bool  first;
    float rest; /* the random number's unused part, in [0, 1) */
} Choice;

/* Takes a decision of the given probability off a random number. */
static inline Choice choose(float u, float probability)
{
    bool  first = u < probability;
    float rest = first ? u / probability : (u - probability) / (1 - probability);
    return (Choice){first, rest < BELOW_ONE ? rest : BELOW_ONE};
}

static uint32_t choose_child(const SamplingNode *node, float *u0, float *u1)
{
    Choice pair = choose(*u0, node->pair);
    Choice inside = choose(*u1, node->inside[pair.first ? 0 : 1]);
    *u0 = pair.rest;
    *u1 = inside.rest;
    return (pair.first ? 0u : 2u) + (inside.first ? 0u : 1u);
}

/* Midpoint of an edge from the cosine of half its length: |a + b| is twice that. */
static Vec3 edge_middle(Vec3 a, Vec3 b, float half_edge_cos)
{
    return vec3_scale(vec3_add(a, b), 0.5f / half_edge_cos);
}

static void corners_down(const GeodesicEdges *edges, uint32_t child, GeodesicTriangle *t)
{
    const float *k = edges->half_cos;
    Vec3         a = t->corner[0], b = t->corner[1], c = t->corner[2];
    if (child != 1) t->corner[0] = child == 0   ? edge_middle(b, c, k[0])
                                   : child == 2 ? edge_middle(a, b, k[2])
                                                : edge_middle(c, a, k[1]);
    if (child != 2) t->corner[1] = child == 0   ? edge_middle(c, a, k[1])
                                   : child == 1 ? edge_middle(a, b, k[2])
                                                : edge_middle(b, c, k[0]);
    if (child != 3) t->corner[2] = child == 0   ? edge_middle(a, b, k[2])
                                   : child == 1 ? edge_middle(c, a, k[1])
                                                : edge_middle(b, c, k[0]);
}

static uint32_t cell_of(const SamplingTree *tree, Vec3 direction)
{
    GeodesicWalk walk = geodesic_walk_start(direction);
    uint32_t     at = tree->nodes[0].child[walk.octant];
    for (int level = 0; !(at & SAMPLING_CELL); level++)
        at = tree->nodes[at].child[geodesic_walk_down(tree->geodesic, level, &walk)];
    return at & ~SAMPLING_CELL;
}

float sampling_tree_pdf(const SamplingTree *tree, Vec3 direction)
{
    return direction.z >= 0 ? tree->density[cell_of(tree, direction)] : 0.0f;
}

/* A point so near an edge that rounding puts it into the next cell, moved inwards by a part in
 * ten thousand. */
static Vec3 moved_inwards(const GeodesicTriangle *t, Vec3 p)
{
    Vec3 sum = vec3_add(vec3_add(t->corner[0], t->corner[1]), t->corner[2]);
    return vec3_normalize(vec3_along(vec3_scale(p, 0.9999f), vec3_normalize(sum), 0.0001f));
}

SamplingResult sampling_tree_sample(const SamplingTree *tree, float u0, float u1)
{
    uint32_t octant = choose_child(&tree->nodes[0], &u0, &u1), place = 0;
    uint32_t at = tree->nodes[0].child[octant];
    int      level = 0;
    GeodesicTriangle t = {{vec3(octant & 1 ? -1.0f : 1.0f, 0, 0),
                           vec3(0, octant & 2 ? -1.0f : 1.0f, 0), vec3(0, 0, 1)}};
    for (; !(at & SAMPLING_CELL); level++) {
        uint32_t child = choose_child(&tree->nodes[at], &u0, &u1);
        corners_down(&tree->geodesic->edges[level][place], child, &t);
        at = tree->nodes[at].child[child];
        place = 4 * place + child;
    }
    Vec3 p = geodesic_sample_triangle(&t, tree->geodesic->areas[level][place], u0, u1);
    if (!(p.z > 0)) p.z = 0;
    uint32_t cell = cell_of(tree, p);
    if (cell != (at & ~SAMPLING_CELL)) {
        p = moved_inwards(&t, p);
        cell = cell_of(tree, p);
    }
    return (SamplingResult){p, tree->density[cell]};
}
