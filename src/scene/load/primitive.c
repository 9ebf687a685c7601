/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/primitive.h"

#include <stdio.h>

#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"
#include "scene/gltf/variant.h"
#include "scene/load/material.h"
#include "scene/load/node_transform.h"
#include "scene/load/pose.h"
#include "scene/gltf/part_draft.h"
#include "scene/load/texture_slot.h"

/* ---- morph targets: base + sum of weight * displacement -------------------------------- */

/* An animation's, else the node's, else the mesh's; NULL: none, all are 0. */
static const float *morph_weights(GltfFile *file, const GltfValue *node, const GltfValue *mesh) {
    const GltfValue *own = tree_member(node, "weights");
    const GltfValue *list = own ? own : tree_member(mesh, "weights");
    if (file->poses && file->poses[node->index].weights) return file->poses[node->index].weights;
    if (!list) return NULL;
    float *weights = ARENA_NEW(&file->load->scratch, float, list->count);
    for (int i = 0; i < list->count; i++) weights[i] = (float)list->items[i].number;
    return weights;
}

/* Adds one attribute's displacements; a tangent's have three components, its sign stays. */
static void morph(GltfFile *file, const GltfValue *primitive, const float *weights,
                  const char *name, float *values, int components) {
    const GltfValue *targets = tree_member(primitive, "targets");
    for (int t = 0; weights && targets && t < targets->count; t++) {
        float w = weights[t];
        int accessor = tree_int(&targets->items[t], name, NO_ID);
        if (w == 0 || accessor < 0) continue;
        const GltfAccessor *a = accessor_get(file, accessor);
        const float *change = accessor_floats(file, accessor);
        int shared = a->component_count < components ? a->component_count : components;
        for (size_t i = 0; i < a->count; i++)
            for (int c = 0; c < shared; c++)
                values[i * (size_t)components + (size_t)c] +=
                    w * change[i * (size_t)a->component_count + (size_t)c];
    }
}

static float *attribute(GltfFile *file, const GltfValue *primitive, const float *weights,
                        const char *name) {
    int accessor = tree_int(tree_member(primitive, "attributes"), name, NO_ID);
    if (accessor < 0) return NULL;
    float *values = accessor_floats(file, accessor);
    morph(file, primitive, weights, name, values, accessor_get(file, accessor)->component_count);
    return values;
}

static bool has_normal_map(const Material *material) {
    return material->normal_texture.texture_id != NO_ID ||
           material->clearcoat_normal_texture.texture_id != NO_ID;
}

static bool wants_tangents(const Material *material) {
    return has_normal_map(material) || material->brushing;
}

static VertexColor *read_colors(GltfFile *file, const GltfValue *primitive, const float *weights) {
    int accessor = tree_int(tree_member(primitive, "attributes"), "COLOR_0", NO_ID);
    const float *values = attribute(file, primitive, weights, "COLOR_0");
    if (!values) return NULL;
    const GltfAccessor *a = accessor_get(file, accessor);
    VertexColor *out = ARENA_NEW(&file->load->scratch, VertexColor, a->count);
    for (size_t i = 0; i < a->count; i++)
        for (int c = 0; c < 4; c++) {
            bool is_there = c < a->component_count;
            float value = is_there ? values[i * (size_t)a->component_count + (size_t)c] : 1;
            value = value < 0 ? 0.0f : value > 1 ? 1.0f : value;
            out[i].linear[c] = (uint16_t)(value * 65535.0f + 0.5f);
        }
    return out;
}

/* Decoded and morphed, still in the mesh's own frame; what nobody will need stays away. */
static void read_attributes(GltfFile *file, const GltfValue *primitive, const float *weights,
                            const bool uses_set[SCENE_UV_SETS], PartDraft *draft) {
    Loader *load = file->load;
    Part *part = &draft->part;
    const int *sets = list_item(&load->material_uv_sets, part->material_id);
    draft->positions = (Vec3 *)attribute(file, primitive, weights, "POSITION");
    part->normals = (Vec3 *)attribute(file, primitive, weights, "NORMAL");
    /* glTF 2.0, 3.7.2.1: flat normals come with tangents of their own. */
    if (part->normals && wants_tangents(list_item(&load->materials, part->material_id)))
        part->tangents = (Tangent *)attribute(file, primitive, weights, "TANGENT");
    for (int i = 0; i < SCENE_UV_SETS; i++) {
        char name[24];
        snprintf(name, sizeof name, "TEXCOORD_%d", sets[i]);
        if (uses_set[i]) part->uv[i] = (Vec2 *)attribute(file, primitive, weights, name);
    }
    part->colors = read_colors(file, primitive, weights);
}

/* ---- skins: a vertex goes where its joints put it -------------------------------------- */

typedef struct Skin {
    Transform *world_from_bind; /* one a joint */
    int joint_count;
    int set_count;
    uint32_t *joints[8]; /* JOINTS_n and WEIGHTS_n, four a vertex */
    float *weights[8];
} Skin;

static Transform *bind_transforms(GltfFile *file, const GltfValue *skin, int joint_count) {
    const GltfValue *joints = tree_member(skin, "joints");
    int accessor = tree_int(skin, "inverseBindMatrices", NO_ID);
    float *inverse = accessor >= 0 ? accessor_floats(file, accessor) : NULL;
    Transform *out = ARENA_NEW(&file->load->scratch, Transform, joint_count);
    for (int i = 0; i < joint_count; i++) {
        int joint = (int)joints->items[i].number;
        out[i] = file->world_from_node[joint];
        if (!inverse) continue;
        Transform bind = transform_from_matrix(inverse + 16 * i);
        out[i] = node_place_within(&file->places[joint], &out[i], &bind);
    }
    return out;
}

static Skin read_skin(GltfFile *file, const GltfValue *node, const GltfValue *primitive) {
    Skin skin = {0};
    const GltfValue *names = tree_member(primitive, "attributes");
    const GltfValue *value = tree_referred(tree_member(node, "skin"), "skins");
    skin.joint_count = tree_count(value, "joints");
    if (!skin.joint_count) return skin;
    for (int n = 0; n < 8; n++) {
        char name[24];
        snprintf(name, sizeof name, "JOINTS_%d", n);
        int joints = tree_int(names, name, NO_ID);
        snprintf(name, sizeof name, "WEIGHTS_%d", n);
        int weights = tree_int(names, name, NO_ID);
        if (joints < 0 || weights < 0) break;
        skin.joints[n] = accessor_integers(file, joints);
        skin.weights[n] = accessor_floats(file, weights);
        skin.set_count++;
    }
    if (skin.set_count) skin.world_from_bind = bind_transforms(file, value, skin.joint_count);
    return skin;
}

static Transform weighted_sum(Transform a, const Transform *b, float w) {
    return (Transform){vec3_along(a.x, b->x, w), vec3_along(a.y, b->y, w), vec3_along(a.z, b->z, w),
                       vec3_along(a.origin, b->origin, w)};
}

static Transform skin_transform(const Skin *skin, size_t vertex) {
    Transform sum = {0};
    float total = 0;
    for (int n = 0; n < skin->set_count; n++)
        for (size_t k = 4 * vertex; k < 4 * vertex + 4; k++) {
            float w = skin->weights[n][k];
            uint32_t joint = skin->joints[n][k];
            if (w == 0 || joint >= (uint32_t)skin->joint_count) continue;
            sum = weighted_sum(sum, &skin->world_from_bind[joint], w);
            total += w;
        }
    if (total == 0) return skin->world_from_bind[0];
    Transform none = {0};
    return weighted_sum(none, &sum, 1 / total);
}

/* ---- vertices -------------------------------------------------------------------------- */

static void place_vertex(PartDraft *draft, size_t i, const Transform *world) {
    Part *part = &draft->part;
    draft->positions[i] = transform_point(world, draft->positions[i]);
    if (part->normals) part->normals[i] = vec3_normalize(transform_normal(world, part->normals[i]));
    if (part->tangents) {
        float mirrored = transform_determinant(world) < 0 ? -1.0f : 1.0f;
        Tangent *t = &part->tangents[i];
        t->along = vec3_normalize(transform_vector(world, t->along));
        t->side = t->side < 0 ? -mirrored : mirrored;
    }
}

/* Returns whether the vertices came out mirrored. */
static bool place_vertices(PartDraft *draft, const Skin *skin, const Transform *world) {
    bool is_mirrored = transform_determinant(world) < 0;
    for (size_t i = 0; i < draft->vertex_count; i++) {
        Transform own = *world;
        if (skin->set_count) own = skin_transform(skin, i);
        if (i == 0) is_mirrored = transform_determinant(&own) < 0;
        place_vertex(draft, i, &own);
    }
    return is_mirrored;
}

/* ---- triangles ------------------------------------------------------------------------- */

enum { MODE_TRIANGLES = 4, MODE_STRIP = 5, MODE_FAN = 6 };

/* The corners' places in the list of indices (glTF 2.0, 3.7.2.1). */
static void corners(int mode, uint32_t triangle, uint32_t out[3]) {
    uint32_t i = triangle;
    switch (mode) {
    case MODE_STRIP:
        out[0] = i;
        out[1] = i + 1 + i % 2;
        out[2] = i + 2 - i % 2;
        break;
    case MODE_FAN:
        out[0] = i + 1;
        out[1] = i + 2;
        out[2] = 0;
        break;
    default:
        out[0] = 3 * i;
        out[1] = 3 * i + 1;
        out[2] = 3 * i + 2;
        break;
    }
}

/* Twice the area, squared, is above nothing: relative to the edges, so that tiny parts stay. */
static bool has_area(Vec3 a, Vec3 b, Vec3 c) {
    const double e[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y,
                         (double)b.z - (double)a.z};
    const double f[3] = {(double)c.x - (double)a.x, (double)c.y - (double)a.y,
                         (double)c.z - (double)a.z};
    double x = e[1] * f[2] - e[2] * f[1], y = e[2] * f[0] - e[0] * f[2];
    double z = e[0] * f[1] - e[1] * f[0];
    double edges =
        (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]) * (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    return x * x + y * y + z * z > 1e-24 * edges;
}

/* Packed corners are those of triangles, in any mode. */
static int mode_of(const GltfValue *primitive) {
    return tree_extension(primitive, DRACO_EXTENSION) ? MODE_TRIANGLES
                                                      : tree_int(primitive, "mode", MODE_TRIANGLES);
}

static void list_triangles(GltfFile *file, const GltfValue *primitive, bool is_mirrored,
                           PartDraft *draft) {
    int mode = mode_of(primitive);
    int accessor = tree_int(primitive, "indices", NO_ID);
    size_t count = accessor >= 0 ? accessor_get(file, accessor)->count : draft->vertex_count;
    const uint32_t *indices = accessor >= 0 ? accessor_integers(file, accessor) : NULL;
    size_t triangles = mode == MODE_TRIANGLES ? count / 3 : count < 3 ? 0 : count - 2;
    draft->indices = ARENA_NEW(&file->load->scratch, uint32_t, 3 * triangles);
    for (size_t t = 0; t < triangles; t++) {
        uint32_t at[3], *out = draft->indices + 3 * (size_t)draft->triangle_count;
        corners(mode, (uint32_t)t, at);
        for (int c = 0; c < 3; c++) {
            uint32_t place = at[is_mirrored && c ? 3 - c : c];
            out[c] = indices ? indices[place] : place;
        }
        const Vec3 *p = draft->positions;
        if (out[0] < draft->vertex_count && out[1] < draft->vertex_count &&
            out[2] < draft->vertex_count && has_area(p[out[0]], p[out[1]], p[out[2]]))
            draft->triangle_count++;
        else file->degenerate_count++;
    }
}

/* ---- a part ---------------------------------------------------------------------------- */

static const char *part_name(Loader *load, const GltfValue *node, const GltfValue *mesh) {
    const char *own = tree_text(node, "name", ""), *name = tree_text(mesh, "name", "");
    return !own[0] && name[0] ? load_keep(load, name) : load_name(load, node, "node");
}

static bool stands_near(GltfFile *file, const GltfValue *primitive, const PartDraft *draft) {
    for (uint32_t i = 0; i < draft->vertex_count; i++) {
        double at[3];
        if (load_is_within_reach(file->load, draft->positions[i], at)) continue;
        return file_error(file, primitive,
                          "vertex %u stands at (%g, %g, %g) in the world; numbers within %g m "
                          "are required",
                          i, at[0], at[1], at[2], (double)SCENE_MOST_M);
    }
    return true;
}

static void finish_shading(PartDraft *draft, const Material *material, Arena *scratch) {
    const TextureSlot *slot = &material->normal_texture;
    if (!wants_tangents(material) || draft->part.tangents) return;
    if (slot->texture_id == NO_ID) slot = &material->clearcoat_normal_texture;
    if (slot->texture_id == NO_ID) slot = &material->brushing->texture;
    if (!draft->part.normals) draft_flat_normals(draft, scratch);
    if (draft->part.uv[slot->uv_set]) draft_tangents(draft, slot, scratch);
    else if (has_normal_map(material)) draft_any_tangents(draft, scratch);
}

/* A buffer may lack its bytes (no uri, or one that points elsewhere), but not when something
 * of it is shown. */
static bool has_bytes(GltfFile *file, const GltfValue *primitive, const GltfValue *at) {
    return !at || accessor_claim_bytes(file, tree_whole(at, NO_ID), primitive, at->key);
}

static bool has_all_bytes(GltfFile *file, const GltfValue *primitive) {
    if (!has_bytes(file, primitive, tree_member(primitive, "indices"))) return false;
    for (const GltfValue *a = tree_items(primitive, "attributes"); a; a = tree_next(a))
        if (!has_bytes(file, primitive, a)) return false;
    for (const GltfValue *t = tree_items(primitive, "targets"); t; t = tree_next(t))
        for (int i = 0; i < t->count; i++)
            if (!has_bytes(file, primitive, &t->items[i])) return false;
    return true;
}

static bool fits(GltfFile *file, const GltfValue *primitive, size_t count) {
    Loader *load = file->load;
    load->vertex_total += count;
    return load->vertex_total <= LOAD_MAX_ELEMENTS ||
           file_error(file, primitive, "the scene has more than %zu vertices", LOAD_MAX_ELEMENTS);
}

/* Everything that it needs in between lies in scratch. False: there is nothing to show. */
static bool build_draft(GltfFile *file, const GltfValue *node, const Transform *world,
                        const GltfValue *mesh, PartDraft *draft) {
    Loader *load = file->load;
    const GltfValue *primitive = draft->primitive;
    const Material *material = list_item(&load->materials, draft->part.material_id);
    bool uses_set[SCENE_UV_SETS];
    texture_slots_used(load, material, uses_set);
    read_attributes(file, primitive, morph_weights(file, node, mesh), uses_set, draft);
    Skin skin = read_skin(file, node, primitive);
    bool is_mirrored = place_vertices(draft, &skin, world);
    if (!stands_near(file, primitive, draft)) return false;
    list_triangles(file, primitive, is_mirrored, draft);
    if (!draft->triangle_count) return false;
    finish_shading(draft, material, &load->scratch);
    return true;
}

void primitive_build(GltfFile *file, const GltfValue *node, const Transform *world,
                     const GltfValue *mesh, const GltfValue *primitive) {
    Loader *load = file->load;
    int mode = mode_of(primitive);
    int material = variant_material(file, primitive);
    const GltfAccessor *position =
        accessor_get(file, tree_int(tree_member(primitive, "attributes"), "POSITION", NO_ID));
    bool is_solid = mode >= MODE_TRIANGLES && mode <= MODE_FAN;
    if (!is_solid) file->skipped_count++;
    if (!is_solid || !position || !has_all_bytes(file, primitive) ||
        !fits(file, primitive, position->count))
        return;
    int material_id = material >= 0 ? file->material_base + material : material_default(file);
    Arena begun = load->scratch;
    PartDraft draft = {.part = {.name = part_name(load, node, mesh),
                                .node_name = load_keep(load, tree_text(node, "name", "")),
                                .mesh_name = load_keep(load, tree_text(mesh, "name", "")),
                                .material_id = material_id},
                       .vertex_count = (uint32_t)position->count,
                       .file = file,
                       .primitive = primitive,
                       .node = node};
    if (build_draft(file, node, world, mesh, &draft)) {
        draft_keep(&draft, load->arena, begun, &load->scratch);
        *(PartDraft *)list_add(&load->parts, &load->scratch) = draft;
    } else {
        load->scratch = begun;
    }
}
