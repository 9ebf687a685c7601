/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: drawing directions. No allocation, no lock, no libm. */
#include "hemisphere/tree/sampling_tree.h"
#include "base/mathf.h"

#define BELOW_ONE 0x1.fffffep-1f

/* Takes a decision off a random number and leaves its unused part, in [0, 1). 1: the second of
 * the two. Without a branch: the outcome is as good as random. */
static inline uint32_t second_of_two(float *u, float first_probability) {
    const float low[2] = {0, first_probability};
    const float width[2] = {first_probability, 1 - first_probability};
    uint32_t second = *u < first_probability ? 0u : 1u;
    float rest = (*u - low[second]) / width[second];
    *u = rest < BELOW_ONE ? rest : BELOW_ONE;
    return second;
}

static inline uint32_t choose_child(const SamplingChoice *choice, float *u0, float *u1) {
    uint32_t pair = second_of_two(u0, choice->pair);
    return 2 * pair + second_of_two(u1, choice->inside[pair]);
}

static uint32_t cell_of(const SamplingTree *tree, Vec3 direction, GeodesicWalk *walk) {
    *walk = geodesic_walk_start(direction);
    uint32_t at = tree->nodes[0].child[walk->octant];
    for (int level = 0; !(at & SAMPLING_CELL); level++)
        at = tree->nodes[at].child[geodesic_walk_down(tree->geodesic, level, walk)];
    return at & ~SAMPLING_CELL;
}

static float margin_of(const GeodesicWalk *walk) {
    float u = walk->weight[0], v = walk->weight[1], w = walk->weight[2];
    return min_f(u, min_f(v, w)) / (u + v + w);
}

static float density_of(const SamplingTree *tree, const SamplingMix *mix, uint32_t cell) {
    const float *density = tree->density + (size_t)cell * (size_t)tree->functions;
    float sum = 0;
    for (int i = 0; i < mix->count; i++) sum += mix->weight[i] * density[mix->function[i]];
    return sum;
}

float sampling_tree_pdf(const SamplingTree *tree, const SamplingMix *mix, Vec3 direction) {
    GeodesicWalk walk;
    return direction.z >= 0 ? density_of(tree, mix, cell_of(tree, direction, &walk)) : 0.0f;
}

static int choose_function(const SamplingMix *mix, float u) {
    int last = 0;
    float sum = 0;
    for (int i = 0; i < mix->count; i++) {
        if (!(mix->weight[i] > 0)) continue;
        last = mix->function[i];
        sum += mix->weight[i];
        if (u < sum) break;
    }
    return last;
}

static Vec3 mirrored(Vec3 p, bool is_mirrored) {
    return vec3(p.x, is_mirrored ? -p.y : p.y, p.z);
}

/* A point so near an edge that rounding puts it into the next cell, moved inwards by a part in
 * ten thousand: the middle of u stands for the inside. */
static Vec3 moved_inwards(const GeodesicSampler *cell, Vec3 p) {
    Vec3 inside = geodesic_sampler_draw(cell, 0.5f, 0.5f);
    return vec3_normalize(vec3_along(vec3_scale(p, 0.9999f), inside, 0.0001f));
}

SamplingResult sampling_tree_sample(const SamplingTree *tree, const SamplingMix *mix,
                                    const float u[3]) {
    const SamplingChoice *choices =
        tree->choices + (size_t)choose_function(mix, u[2]) * tree->node_count;
    float u0 = u[0], u1 = u[1];
    uint32_t octant = choose_child(&choices[0], &u0, &u1), at = tree->nodes[0].child[octant];
    bool is_mirrored = tree->octants == 2 && octant >= 2;
    while (!(at & SAMPLING_CELL)) at = tree->nodes[at].child[choose_child(&choices[at], &u0, &u1)];
    at &= ~SAMPLING_CELL;
    Vec3 p = geodesic_sampler_draw(&tree->cells[at], u0, u1);
    if (!(p.z > 0)) p.z = 0;
    GeodesicWalk walk;
    uint32_t found = cell_of(tree, p, &walk);
    if (found != at) {
        p = moved_inwards(&tree->cells[at], p);
        found = cell_of(tree, p, &walk);
    }
    return (SamplingResult){mirrored(p, is_mirrored), density_of(tree, mix, found),
                            margin_of(&walk)};
}
