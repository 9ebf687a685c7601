/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_bound.h -- the acceptance test of vertex trees that tests use. */
#pragma once
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Accepts what is within a tolerance of the values at the vertices, component by component. */
typedef struct Bound {
    const float *values;
    int components;
    float tolerance;
} Bound;

static inline bool within_bound(const void *context, uint32_t vertex, const float *reconstructed) {
    const Bound *b = context;
    const float *value = b->values + vertex * (size_t)b->components;
    for (int i = 0; i < b->components; i++)
        if (!(fabsf(reconstructed[i] - value[i]) <= b->tolerance)) return false;
    return true;
}
