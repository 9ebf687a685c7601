/* SPDX-License-Identifier: Apache-2.0 */
/* bvh_parts.h -- what a Bvh is made of, for bvh.c, which asks it, and bvh_build.c. */
#pragma once
#include "bvh/bvh.h"
#include "bvh/embree_version.h"

/* Two geometries: opaque triangles, which nobody asks about, and the others, whose shadow rays
 * are put to BvhPasses. Scene.triangles holds them in this order. */
enum { GEOMETRY_OPAQUE, GEOMETRY_ASKED, GEOMETRY_COUNT };

struct Bvh {
    RTCDevice device;
    RTCScene  scene;
    RTCScene  sheets; /* GEOMETRY_ASKED alone; NULL: no material has holes */
    uint32_t  first_triangle[GEOMETRY_COUNT];
    BvhRecorder *recorder;
    int       threads; /* that built it */
};

/* A query's context, with what the filters need behind Embree's own part. */
typedef struct QueryContext {
    EmbreeContext embree;
    BvhPasses    *passes; /* of shadow rays */
    void         *user;
    const Bvh    *bvh;
    float         sheets_from; /* of other rays */
} QueryContext;
