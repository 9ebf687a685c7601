/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/hood.h"

#include <math.h>
#include <string.h>

#include "scene/gltf/part_draft.h"
#include "scene/load/material.h"
#include "scene/load/wearer.h"

#define REFLECTANCE 0.04f
#define THICK_M 0.002f
#define GAP_M 0.002f
#define FLAT 0.985f /* cosine of 10 degrees between normal and vertical */
#define FACING 0.5f /* less is a closed body */

/* The display's box in axes of its own: right and up of who faces it, and its normal. */
typedef struct Face {
    Vec3 right, up, normal;
    float low[3], high[3];  /* along those axes */
    float facing;           /* of its area, what faces along the normal */
    const PartDraft *draft; /* one of its parts */
} Face;

/* ---- the display's surface --------------------------------------------------------------- */

static bool is_of(const Loader *load, const PartDraft *draft, const char *name) {
    const Material *m = list_item(&load->materials, draft->part.material_id);
    if (m->display_id == NO_ID) return false;
    if (!strncmp(name, WEARER_NODE, strlen(WEARER_NODE)))
        return !strcmp(draft->part.node_name, name + strlen(WEARER_NODE));
    return !strcmp(m->name, name);
}

/* The sum of normals by area, and the area: both twice. */
static Vec3 normal_area(const PartDraft *draft, float *area) {
    Vec3 sum = vec3(0, 0, 0);
    for (uint32_t t = 0; t < draft->triangle_count; t++) {
        const uint32_t *at = &draft->indices[3 * t];
        const Vec3 *p = draft->positions;
        Vec3 n = vec3_cross(vec3_sub(p[at[1]], p[at[0]]), vec3_sub(p[at[2]], p[at[0]]));
        sum = vec3_add(sum, n);
        *area += vec3_length(n);
    }
    return sum;
}

static void add_points(Face *face, const PartDraft *draft) {
    for (uint32_t i = 0; i < draft->vertex_count; i++) {
        Vec3 p = draft->positions[i];
        const float along[3] = {vec3_dot(p, face->right), vec3_dot(p, face->up),
                                vec3_dot(p, face->normal)};
        for (int a = 0; a < 3; a++) {
            face->low[a] = fminf(face->low[a], along[a]);
            face->high[a] = fmaxf(face->high[a], along[a]);
        }
    }
}

/* False: no display has the name. */
static bool find_face(const Loader *load, const char *name, Face *out) {
    Vec3 sum = vec3(0, 0, 0);
    float area = 0;
    *out = (Face){.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < load->parts.count; i++) {
        const PartDraft *draft = list_item(&load->parts, i);
        if (!is_of(load, draft, name)) continue;
        out->draft = draft;
        sum = vec3_add(sum, normal_area(draft, &area));
    }
    if (!out->draft) return false;
    out->normal = vec3_normalize(sum);
    out->facing = area > 0 ? vec3_length(sum) / area : 0;
    out->right = vec3_normalize(vec3_cross(vec3(0, 1, 0), out->normal));
    out->up = vec3_cross(out->normal, out->right);
    for (int i = 0; i < load->parts.count; i++) {
        const PartDraft *draft = list_item(&load->parts, i);
        if (is_of(load, draft, name)) add_points(out, draft);
    }
    return true;
}

/* ---- plates ------------------------------------------------------------------------------ */

/* A prism between two quadrilaterals: corners 0 to 3 once around, 4 to 7 opposite to them. */
static const uint32_t SIDES[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                   1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};

/* Corners in the face's axes. */
static void add_prism(Loader *load, const Face *face, int material_id, const float at[8][3]) {
    PartDraft draft = {.part = face->draft->part,
                       .vertex_count = 8,
                       .triangle_count = 12,
                       .file = face->draft->file,
                       .primitive = face->draft->primitive,
                       .node = face->draft->node};
    draft.part = (Part){
        .name = "hood", .node_name = "hood", .mesh_name = "hood", .material_id = material_id};
    draft.positions = ARENA_NEW(&load->scratch, Vec3, 8);
    draft.indices = ARENA_NEW(&load->scratch, uint32_t, 36);
    memcpy(draft.indices, SIDES, sizeof SIDES);
    for (int i = 0; i < 8; i++) {
        Vec3 p = vec3_scale(face->right, at[i][0]);
        p = vec3_along(p, face->up, at[i][1]);
        draft.positions[i] = vec3_along(p, face->normal, at[i][2]);
    }
    *(PartDraft *)list_add(&load->parts, &load->scratch) = draft;
}

static void add_plate(Loader *load, const Face *face, int material_id, float depth) {
    float l = face->low[0] - GAP_M - THICK_M, r = face->high[0] + GAP_M + THICK_M;
    float b = face->high[1] + GAP_M, t = b + THICK_M;
    float n = face->low[2], f = face->high[2] + depth;
    const float at[8][3] = {{l, b, n}, {r, b, n}, {r, t, n}, {l, t, n},
                            {l, b, f}, {r, b, f}, {r, t, f}, {l, t, f}};
    add_prism(load, face, material_id, at);
}

/* side: -1 left, 1 right. */
static void add_cheek(Loader *load, const Face *face, int material_id, float depth, int side) {
    float l = side < 0 ? face->low[0] - GAP_M - THICK_M : face->high[0] + GAP_M;
    float r = l + THICK_M, b = face->low[1], t = face->high[1] + GAP_M;
    float n = face->low[2], f = face->high[2] + depth, at_foot = face->high[2] + THICK_M;
    const float at[8][3] = {{l, b, n},       {r, b, n},       {r, t, n}, {l, t, n},
                            {l, b, at_foot}, {r, b, at_foot}, {r, t, f}, {l, t, f}};
    add_prism(load, face, material_id, at);
}

static void build_hood(Loader *load, const SceneChange *change, const Face *face) {
    const char *fault = !(face->facing > FACING)
                            ? "faces nowhere: it is a closed body, required: a surface that a "
                              "hood could stand over"
                        : fabsf(face->normal.y) > FLAT
                            ? "lies flat: no edge of it is the upper one, along which a hood "
                              "could stand"
                            : NULL;
    if (fault) {
        problems_add(load->problems, SEVERITY_ERROR, change->file, change->place,
                     "display \"%.100s\" %s", change->name, fault);
        return;
    }
    int id = material_add_matt(load, "hood", REFLECTANCE);
    add_plate(load, face, id, change->depth_m);
    add_cheek(load, face, id, change->depth_m, -1);
    add_cheek(load, face, id, change->depth_m, 1);
}

void hoods_build(Loader *load) {
    for (int i = 0; i < load->options->change_count; i++) {
        const SceneChange *change = &load->options->changes[i];
        Face face;
        if (change->kind != CHANGE_HOOD || !find_face(load, change->name, &face)) continue;
        load->change_uses[i]++;
        build_hood(load, change, &face);
    }
}
