/* SPDX-License-Identifier: Apache-2.0 */
/* node_place.h -- where a node stands, exactly enough to be far away.
 *
 * Floats are 0.03 mm apart at 500 m and a millimetre at 16 km. So places are composed in
 * doubles down the tree, the scene's origin is taken away, and only then are they rounded.
 * The axes of a node are short numbers wherever it stands and are composed in floats.
 *
 * Units    m.
 * Threads  pure functions.
 */
#pragma once
#include "base/vec.h"

/* As a Transform; the images of the unit vectors, and of 0. */
typedef struct NodePlace {
    double axis[3][3], origin[3];
} NodePlace;

static inline void node_place_vector(const NodePlace *place, const double v[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = place->axis[0][i] * v[0] + place->axis[1][i] * v[1] + place->axis[2][i] * v[2];
}

static inline void node_place_point(const NodePlace *place, const double p[3], double out[3]) {
    node_place_vector(place, p, out);
    for (int i = 0; i < 3; i++) out[i] += place->origin[i];
}

/* First b, then a. */
static inline NodePlace node_place_compose(const NodePlace *a, const NodePlace *b) {
    NodePlace out;
    for (int i = 0; i < 3; i++) node_place_vector(a, b->axis[i], out.axis[i]);
    node_place_point(a, b->origin, out.origin);
    return out;
}

static inline NodePlace node_place_of(const Transform *t) {
    return (NodePlace){{{(double)t->x.x, (double)t->x.y, (double)t->x.z},
                        {(double)t->y.x, (double)t->y.y, (double)t->y.z},
                        {(double)t->z.x, (double)t->z.y, (double)t->z.z}},
                       {(double)t->origin.x, (double)t->origin.y, (double)t->origin.z}};
}

/* The place of what lies at `own` in the node's frame; world: the node's place, whose axes it
 * has. */
static inline Transform node_place_within(const NodePlace *place, const Transform *world,
                                          const Transform *own) {
    Transform out = transform_compose(world, own);
    const double at[3] = {(double)own->origin.x, (double)own->origin.y, (double)own->origin.z};
    double origin[3];
    node_place_point(place, at, origin);
    out.origin = vec3_from_doubles(origin);
    return out;
}
