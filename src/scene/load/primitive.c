#include "scene/load/primitive.h"

#include <stdio.h>
#include <string.h>

#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"
#include "scene/load/material.h"
#include "scene/load/part_draft.h"
#include "scene/load/texture_slot.h"

/* The attributes of one primitive, decoded, morphed and still in the mesh's own frame. */
typedef struct Attributes {
    size_t count;
    float *position, *normal, *tangent; /* 3, 3, 4 a vertex; NULL: absent */
    float *uv[SCENE_UV_SETS];           /* 2 a vertex */
    float *color;
    int color_components;
} Attributes;

/* ---- morph targets: the rest pose is base + sum of weight * displacement --------------- */

static const GltfValue *rest_weights(const GltfValue *node, const GltfValue *mesh)
{
    const GltfValue *own = tree_member(node, "weights");
    return own ? own : tree_member(mesh, "weights");
}

/* Adds one attribute's displacements; a tangent's have three components, its sign stays. */
static void morph(GltfFile *file, const GltfValue *primitive, const GltfValue *weights,
                  const char *name, float *values, int components)
{
    const GltfValue *targets = tree_member(primitive, "targets");
    for (int t = 0; targets && t < targets->count; t++) {
        const GltfValue *weight = tree_item(weights, t);
        float w = weight ? (float)weight->number : 0;
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

static float *attribute(GltfFile *file, const GltfValue *primitive, const GltfValue *weights,
                        const char *name)
{
    int accessor = tree_int(tree_member(primitive, "attributes"), name, NO_ID);
    if (accessor < 0) return NULL;
    float *values = accessor_floats(file, accessor);
    morph(file, primitive, weights, name, values,
          accessor_get(file, accessor)->component_count);
    return values;
}

static Attributes read_attributes(GltfFile *file, const GltfValue *primitive,
                                  const GltfValue *weights, const int sets[SCENE_UV_SETS])
{
    const GltfValue *names = tree_member(primitive, "attributes");
    Attributes a = {.count = accessor_get(file, tree_int(names, "POSITION", NO_ID))->count,
                    .position = attribute(file, primitive, weights, "POSITION"),
                    .normal = attribute(file, primitive, weights, "NORMAL"),
                    .tangent = attribute(file, primitive, weights, "TANGENT"),
                    .color = attribute(file, primitive, weights, "COLOR_0")};
    for (int i = 0; i < SCENE_UV_SETS; i++) {
        char name[24];
        snprintf(name, sizeof name, "TEXCOORD_%d", sets[i]);
        a.uv[i] = attribute(file, primitive, weights, name);
    }
    if (a.color)
        a.color_components =
            accessor_get(file, tree_int(names, "COLOR_0", NO_ID))->component_count;
    if (!a.normal)
        a.tangent = NULL; /* glTF 2.0, 3.7.2.1: flat normals come with own tangents */
    return a;
}

/* ---- skins at rest: a vertex goes where its joints put it ------------------------------ */

typedef struct Skin {
    Transform *world_from_bind; /* one a joint */
    int joint_count;
    int set_count;
    uint32_t *joints[8]; /* JOINTS_n and WEIGHTS_n, four a vertex */
    float *weights[8];
} Skin;

static Transform *bind_transforms(GltfFile *file, const GltfValue *skin, int joint_count)
{
    const GltfValue *joints = tree_member(skin, "joints");
    int accessor = tree_int(skin, "inverseBindMatrices", NO_ID);
    float *inverse = accessor >= 0 ? accessor_floats(file, accessor) : NULL;
    Transform *out = ARENA_NEW(&file->load->scratch, Transform, joint_count);
    for (int i = 0; i < joint_count; i++) {
        out[i] = file->world_from_node[(int)joints->items[i].number];
        if (!inverse) continue;
        const float *m = inverse + 16 * i;
        Transform bind = {vec3(m[0], m[1], m[2]), vec3(m[4], m[5], m[6]),
                          vec3(m[8], m[9], m[10]), vec3(m[12], m[13], m[14])};
        out[i] = transform_compose(&out[i], &bind);
    }
    return out;
}

static Skin read_skin(GltfFile *file, const GltfValue *node, const GltfValue *primitive)
{
    Skin skin = {0};
    const GltfValue *names = tree_member(primitive, "attributes");
    const GltfValue *value = tree_element(file->root, "skins", tree_int(node, "skin", NO_ID));
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

static Transform weighted_sum(Transform a, const Transform *b, float w)
{
    return (Transform){vec3_along(a.x, b->x, w), vec3_along(a.y, b->y, w),
                       vec3_along(a.z, b->z, w), vec3_along(a.origin, b->origin, w)};
}

static Transform skin_transform(const Skin *skin, size_t vertex)
{
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

static void store(float out[3], Vec3 v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

static void place_color(const Attributes *a, size_t i, uint16_t out[4])
{
    for (int c = 0; c < 4; c++) {
        float value = a->color && c < a->color_components
                          ? a->color[i * (size_t)a->color_components + (size_t)c]
                          : 1.0f;
        value = value < 0 ? 0.0f : value > 1 ? 1.0f : value;
        out[c] = (uint16_t)(value * 65535.0f + 0.5f);
    }
}

static void place_vertex(const Attributes *a, size_t i, const Transform *world, Vertex *out)
{
    const float *p = a->position + 3 * i, *n = a->normal ? a->normal + 3 * i : NULL;
    const float *t = a->tangent ? a->tangent + 4 * i : NULL;
    store(out->position, transform_point(world, vec3(p[0], p[1], p[2])));
    if (n) store(out->normal, vec3_normalize(transform_normal(world, vec3(n[0], n[1], n[2]))));
    if (t) {
        float mirrored = transform_determinant(world) < 0 ? -1.0f : 1.0f;
        store(out->tangent, vec3_normalize(transform_vector(world, vec3(t[0], t[1], t[2]))));
        out->tangent[3] = t[3] < 0 ? -mirrored : mirrored;
    }
    for (int s = 0; s < SCENE_UV_SETS; s++)
        for (int c = 0; a->uv[s] && c < 2; c++) out->uv[s][c] = a->uv[s][2 * i + (size_t)c];
    place_color(a, i, out->color);
}

/* Returns whether the vertices came out mirrored. */
static bool place_vertices(const Attributes *a, const Skin *skin, const Transform *world,
                           Vertex *out)
{
    bool is_mirrored = transform_determinant(world) < 0;
    for (size_t i = 0; i < a->count; i++) {
        Transform own = *world;
        if (skin->set_count) own = skin_transform(skin, i);
        if (i == 0) is_mirrored = transform_determinant(&own) < 0;
        place_vertex(a, i, &own, &out[i]);
    }
    return is_mirrored;
}

/* ---- triangles ------------------------------------------------------------------------- */

enum { MODE_TRIANGLES = 4, MODE_STRIP = 5, MODE_FAN = 6 };

/* The corners' places in the list of indices (glTF 2.0, 3.7.2.1). */
static void corners(int mode, uint32_t triangle, uint32_t out[3])
{
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
static bool has_area(const Vertex *a, const Vertex *b, const Vertex *c)
{
    double e[3], f[3];
    for (int i = 0; i < 3; i++) {
        e[i] = (double)b->position[i] - (double)a->position[i];
        f[i] = (double)c->position[i] - (double)a->position[i];
    }
    double x = e[1] * f[2] - e[2] * f[1], y = e[2] * f[0] - e[0] * f[2];
    double z = e[0] * f[1] - e[1] * f[0];
    double edges =
        (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]) * (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    return x * x + y * y + z * z > 1e-24 * edges;
}

static void list_triangles(GltfFile *file, const GltfValue *primitive, bool is_mirrored,
                           PartDraft *draft)
{
    int mode = tree_int(primitive, "mode", MODE_TRIANGLES);
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
        const Vertex *v = draft->vertices;
        if (out[0] < draft->vertex_count && out[1] < draft->vertex_count &&
            out[2] < draft->vertex_count && has_area(&v[out[0]], &v[out[1]], &v[out[2]]))
            draft->triangle_count++;
        else
            file->degenerate_count++;
    }
}

/* ---- a part ---------------------------------------------------------------------------- */

static const char *kept_name(GltfFile *file, const GltfValue *value)
{
    const char *name = tree_text(value, "name", "");
    return arena_string(file->load->arena, name, strlen(name));
}

static const char *part_name(GltfFile *file, const GltfValue *node, const GltfValue *mesh)
{
    Arena *arena = file->load->arena;
    const char *name = tree_text(node, "name", "");
    if (!name[0]) name = tree_text(mesh, "name", "");
    if (!name[0]) return arena_format(arena, "node %d", node->index);
    return arena_string(arena, name, strlen(name));
}

static bool has_finite_vertices(GltfFile *file, const GltfValue *primitive,
                                const PartDraft *draft)
{
    for (uint32_t i = 0; i < draft->vertex_count; i++) {
        const float *p = draft->vertices[i].position;
        if (vec3_is_finite(vec3(p[0], p[1], p[2]))) continue;
        file_error(file, primitive,
                   "vertex %u stands at (%g, %g, %g) in the scene; finite "
                   "numbers are wanted",
                   i, (double)p[0], (double)p[1], (double)p[2]);
        return false;
    }
    return true;
}

static void finish_shading(GltfFile *file, PartDraft *draft, const Attributes *a,
                           const Material *material)
{
    Arena *scratch = &file->load->scratch;
    const TextureSlot *slot = &material->normal_texture;
    if (slot->texture_id == NO_ID) slot = &material->clearcoat_normal_texture;
    if (!a->normal) draft_flat_normals(draft, scratch);
    draft->part.has_tangents = a->tangent != NULL;
    if (a->tangent) return;
    if (slot->texture_id != NO_ID && a->uv[slot->uv_set])
        draft_tangents(draft, slot, scratch);
    else
        draft_any_tangents(draft);
}

/* A buffer may lack its bytes (no uri, or one that leads elsewhere), but not when something of
 * it is shown. */
static bool has_bytes(GltfFile *file, const GltfValue *primitive, const GltfValue *at)
{
    const GltfAccessor *accessor =
        tree_is_integer(at) ? accessor_get(file, (int)at->number) : NULL;
    if (!accessor || accessor->buffer_view < 0 ||
        document_view(file, accessor->buffer_view).data)
        return true;
    file_error(file, primitive, "the bytes of %s are missing: their buffer is not there",
               at->key);
    return false;
}

static bool has_all_bytes(GltfFile *file, const GltfValue *primitive)
{
    const GltfValue *attributes = tree_member(primitive, "attributes");
    if (!has_bytes(file, primitive, tree_member(primitive, "indices"))) return false;
    for (int i = 0; i < tree_count(primitive, "attributes"); i++)
        if (!has_bytes(file, primitive, &attributes->items[i])) return false;
    return true;
}

static bool fits(GltfFile *file, const GltfValue *primitive, size_t count)
{
    Loader *load = file->load;
    load->vertex_total += count;
    if (load->vertex_total <= LOAD_MAX_ELEMENTS) return true;
    file_error(file, primitive, "the scene has more than %zu vertices", LOAD_MAX_ELEMENTS);
    return false;
}

void primitive_build(GltfFile *file, const GltfValue *node, const Transform *world,
                     const GltfValue *mesh, const GltfValue *primitive)
{
    Loader *load = file->load;
    int mode = tree_int(primitive, "mode", MODE_TRIANGLES);
    int material = tree_int(primitive, "material", NO_ID);
    const GltfAccessor *position =
        accessor_get(file, tree_int(tree_member(primitive, "attributes"), "POSITION", NO_ID));
    bool is_solid = mode >= MODE_TRIANGLES && mode <= MODE_FAN;
    if (!is_solid) file->skipped_count++;
    if (!is_solid || !position || !has_all_bytes(file, primitive) ||
        !fits(file, primitive, position->count))
        return;
    int material_id = material >= 0 ? file->material_base + material : material_default(file);
    const int *sets = list_item(&load->material_uv_sets, material_id);
    Material *m = list_item(&load->materials, material_id);
    Attributes a = read_attributes(file, primitive, rest_weights(node, mesh), sets);
    Skin skin = read_skin(file, node, primitive);
    PartDraft draft = {
        .part = {.name = part_name(file, node, mesh),
                 .node_name = kept_name(file, node),
                 .mesh_name = kept_name(file, mesh),
                 .material_id = material_id},
        .vertices = ARENA_NEW(&load->scratch, Vertex, a.count),
        .vertex_count = (uint32_t)a.count,
        .file = file,
        .primitive = primitive,
        .node = node};
    bool is_mirrored = place_vertices(&a, &skin, world, draft.vertices);
    if (!has_finite_vertices(file, primitive, &draft)) return;
    list_triangles(file, primitive, is_mirrored, &draft);
    if (!draft.triangle_count) return;
    finish_shading(file, &draft, &a, m);
    *(PartDraft *)list_add(&load->parts, &load->scratch) = draft;
}
