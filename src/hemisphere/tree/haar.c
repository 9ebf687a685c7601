/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/haar.h"

#include <math.h>

/* areas[level]: of octant 0's triangles; a father's area is the sum of its children's. */
typedef struct AreaPyramid {
    double *areas[GEODESIC_MAX_LEVEL + 1];
} AreaPyramid;

static AreaPyramid area_pyramid(int level, Arena *arena) {
    AreaPyramid pyramid = {{0}};
    for (int i = level; i >= 0; i--) {
        uint32_t count = 1u << 2 * i;
        double *areas = pyramid.areas[i] = ARENA_NEW(arena, double, count);
        if (i == level) {
            geodesic_areas(level, areas);
            continue;
        }
        const double *child = pyramid.areas[i + 1];
        for (uint32_t n = 0; n < count; n++, child += 4)
            areas[n] = child[0] + child[1] + child[2] + child[3];
    }
    return pyramid;
}

/* The four children of one node: their places and areas. */
typedef struct Family {
    float *value[4];
    double area[4]; /* all 1 with equal weights */
} Family;

static Family family_of(const HaarShape *shape, const AreaPyramid *pyramid, float *values,
                        int level, uint32_t node) {
    size_t step = (size_t)shape->components << 2 * (shape->level - level - 1);
    uint32_t in_octant = node & ((1u << 2 * level) - 1);
    const double *area = &pyramid->areas[level + 1][4 * in_octant];
    Family family;
    for (int i = 0; i < 4; i++) {
        family.value[i] = values + ((size_t)node * 4 + (size_t)i) * step;
        family.area[i] = shape->weights == HAAR_AREA ? area[i] : 1.0;
    }
    return family;
}

static void forward_family(const Family *f, int components) {
    double total = f->area[0] + f->area[1] + f->area[2] + f->area[3];
    for (int c = 0; c < components; c++) {
        double mean = 0;
        for (int i = 0; i < 4; i++) mean += f->area[i] * (double)f->value[i][c];
        mean /= total;
        f->value[0][c] = (float)mean;
        for (int i = 1; i < 4; i++) f->value[i][c] = (float)((double)f->value[i][c] - mean);
    }
}

static void inverse_family(const Family *f, int components) {
    for (int c = 0; c < components; c++) {
        double mean = (double)f->value[0][c], rest = 0;
        for (int i = 1; i < 4; i++) {
            rest += f->area[i] * (double)f->value[i][c];
            f->value[i][c] = (float)(mean + (double)f->value[i][c]);
        }
        f->value[0][c] = (float)(mean - rest / f->area[0]);
    }
}

void haar_forward(const HaarShape *shape, float *values, Arena scratch) {
    AreaPyramid pyramid = area_pyramid(shape->level, &scratch);
    for (int level = shape->level - 1; level >= 0; level--)
        for (uint32_t n = 0; n < (uint32_t)shape->octants << 2 * level; n++) {
            Family family = family_of(shape, &pyramid, values, level, n);
            forward_family(&family, shape->components);
        }
}

void haar_inverse(const HaarShape *shape, float *values, Arena scratch) {
    AreaPyramid pyramid = area_pyramid(shape->level, &scratch);
    for (int level = 0; level < shape->level; level++)
        for (uint32_t n = 0; n < (uint32_t)shape->octants << 2 * level; n++) {
            Family family = family_of(shape, &pyramid, values, level, n);
            inverse_family(&family, shape->components);
        }
}

static void octant_norms(const HaarShape *shape, const AreaPyramid *pyramid, float *norms) {
    norms[0] = (float)sqrt(pyramid->areas[0][0]);
    for (int level = 0; level < shape->level; level++) {
        size_t step = (size_t)1 << 2 * (shape->level - level - 1);
        for (size_t n = 0; n < (size_t)1 << 2 * level; n++) {
            const double *area = &pyramid->areas[level + 1][4 * n];
            for (size_t i = 1; i < 4; i++) {
                double echo = shape->weights == HAAR_AREA ? area[i] * area[i] / area[0] : area[0];
                norms[(4 * n + i) * step] = (float)sqrt(area[i] + echo);
            }
        }
    }
}

void haar_norms(const HaarShape *shape, float *norms, Arena scratch) {
    AreaPyramid pyramid = area_pyramid(shape->level, &scratch);
    for (int octant = 0; octant < shape->octants; octant++)
        octant_norms(shape, &pyramid, norms + ((size_t)octant << 2 * shape->level));
}
