/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/graph.h"

#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "scene/change/node_change.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"
#include "scene/load/environment.h"
#include "scene/load/luminaire.h"
#include "scene/load/node_transform.h"
#include "scene/load/pose.h"
#include "scene/load/primitive.h"

/* ---- transforms ------------------------------------------------------------------------ */

/* pose: the values of animations; NULL: at rest. */
static Transform parent_from_node(const GltfValue *node, const NodePose *pose)
{
    float matrix[16], t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    if (tree_floats(node, "matrix", 16, matrix)) return transform_from_matrix(matrix);
    tree_floats(node, "translation", 3, t);
    tree_floats(node, "rotation", 4, q);
    tree_floats(node, "scale", 3, s);
    if (pose)
        return transform_from_trs(pose->translation ? pose->translation : t,
                                  pose->rotation ? pose->rotation : q,
                                  pose->scale ? pose->scale : s);
    return transform_from_trs(t, q, s);
}

/* ---- the order of nodes ---------------------------------------------------------------- */

/* Parents before children, siblings in the file's order, below the nodes of `roots` (an array
 * of node indices). The check has made sure that this is a tree. */
typedef struct NodeOrder {
    const NodePose *poses; /* NULL: at rest */
    int *nodes;
    int *stack;
    bool *is_seen;
    int count, capacity;
    bool skips_hidden;
} NodeOrder;

/* KHR_node_visibility: the node and everything below it. */
static bool is_hidden(const NodeOrder *order, const GltfValue *node)
{
    const NodePose *pose = order->poses ? &order->poses[node->index] : NULL;
    if (pose && pose->visible) return pose->visible[0] == 0;
    return !tree_boolean(tree_extension(node, "KHR_node_visibility"), "visible", true);
}

static NodeOrder order_start(GltfFile *file, int node_count)
{
    Arena *scratch = &file->load->scratch;
    return (NodeOrder){file->poses,
                       ARENA_NEW(scratch, int, node_count),
                       ARENA_NEW(scratch, int, node_count),
                       ARENA_NEW(scratch, bool, node_count),
                       0,
                       node_count,
                       false};
}

static void order_below(NodeOrder *order, const GltfValue *nodes, int root)
{
    int depth = 0;
    if (root < 0 || root >= order->capacity || order->is_seen[root]) return;
    order->stack[depth++] = root;
    order->is_seen[root] = true;
    while (depth) {
        int node = order->stack[--depth];
        const GltfValue *children = tree_member(&nodes->items[node], "children");
        if (order->skips_hidden && is_hidden(order, &nodes->items[node])) continue;
        order->nodes[order->count++] = node;
        for (int i = children ? children->count : 0; i-- > 0;) {
            int child = (int)children->items[i].number;
            if (child < 0 || child >= order->capacity || order->is_seen[child]) continue;
            order->is_seen[child] = true;
            order->stack[depth++] = child;
        }
    }
}

static int *parents_of(GltfFile *file, const GltfValue *nodes)
{
    int *parent = ARENA_NEW(&file->load->scratch, int, nodes->count);
    for (int i = 0; i < nodes->count; i++) parent[i] = NO_ID;
    for (int i = 0; i < nodes->count; i++) {
        const GltfValue *c = tree_items(&nodes->items[i], "children");
        for (; c; c = tree_next(c))
            if (c->number >= 0 && c->number < nodes->count) parent[(int)c->number] = i;
    }
    return parent;
}

static void place_nodes(GltfFile *file, const GltfValue *nodes, const int *parent)
{
    NodeOrder order = order_start(file, nodes->count);
    file->world_from_node = ARENA_NEW(&file->load->scratch, Transform, nodes->count);
    for (int i = 0; i < nodes->count; i++)
        if (parent[i] == NO_ID) order_below(&order, nodes, i);
    for (int i = 0; i < order.count; i++) {
        int node = order.nodes[i];
        Transform local = parent_from_node(&nodes->items[node],
                                           file->poses ? &file->poses[node] : NULL);
        file->world_from_node[node] =
            parent[node] == NO_ID
                ? local
                : transform_compose(&file->world_from_node[parent[node]], &local);
    }
}

/* The nodes of the scene to show: the file's default, else its first, else every root. */
static NodeOrder nodes_of_scene(GltfFile *file, const GltfValue *nodes, const int *parent)
{
    NodeOrder order = order_start(file, nodes->count);
    order.skips_hidden = true;
    const GltfValue *scene =
        tree_element(file->root, "scenes", tree_int(file->root, "scene", 0));
    if (!scene) {
        file_warning(file, NULL, "the file has no scene; all its nodes are shown");
        for (int i = 0; i < nodes->count; i++)
            if (parent[i] == NO_ID) order_below(&order, nodes, i);
    }
    for (const GltfValue *r = tree_items(scene, "nodes"); r; r = tree_next(r))
        order_below(&order, nodes, (int)r->number);
    return order;
}

/* ---- cameras and lights ---------------------------------------------------------------- */

static void add_camera(GltfFile *file, const GltfValue *node, const Transform *world)
{
    const GltfValue *camera = tree_referred(tree_member(node, "camera"), "cameras");
    const GltfValue *eye = tree_member(camera, "perspective");
    const GltfValue *flat = tree_member(camera, "orthographic");
    if (!eye && !flat) return; /* of a type that an extension adds */
    float xmag = fabsf(tree_float(flat, "xmag", 1)), ymag = fabsf(tree_float(flat, "ymag", 1));
    *(SceneCamera *)list_add(&file->load->cameras, &file->load->scratch) =
        (SceneCamera){.node_name = load_keep(file->load, tree_text(node, "name", "")),
                      .camera_name = load_keep(file->load, tree_text(camera, "name", "")),
                      .is_perspective = eye != NULL,
                      .yfov = tree_float(eye, "yfov", 0),
                      .ymag = ymag,
                      .aspect = eye ? tree_float(eye, "aspectRatio", 0) : xmag / ymag,
                      .znear = tree_float(eye ? eye : flat, "znear", 0),
                      .zfar = tree_float(eye ? eye : flat, "zfar", INFINITY),
                      .world_from_camera = {vec3_normalize(world->x), vec3_normalize(world->y),
                                            vec3_normalize(world->z), world->origin}};
}

static void add_light(GltfFile *file, const GltfValue *node, const Transform *world)
{
    const GltfValue *lights =
        tree_member(tree_extension(file->root, "KHR_lights_punctual"), "lights");
    const GltfValue *light = tree_item(
        lights, tree_int(tree_extension(node, "KHR_lights_punctual"), "light", NO_ID));
    const char *type = tree_text(light, "type", ""), *name = tree_text(node, "name", "");
    bool is_spot = strcmp(type, "spot") == 0, is_beam = strcmp(type, "directional") == 0;
    if (!light || (!is_spot && !is_beam && strcmp(type, "point") != 0)) return;
    const GltfValue *cone = tree_member(light, "spot");
    float color[3] = {1, 1, 1}, intensity = tree_float(light, "intensity", 1);
    tree_floats(light, "color", 3, color);
    PunctualLight *out = list_add(&file->load->lights, &file->load->scratch);
    *out = (PunctualLight){
        .kind = is_spot   ? LIGHT_SPOT
                : is_beam ? LIGHT_DIRECTIONAL
                          : LIGHT_POINT,
        .position = world->origin,
        .direction = vec3_normalize(vec3_neg(world->z)),
        .cos_inner = cos_of(is_spot ? tree_float(cone, "innerConeAngle", 0) : 0),
        .cos_outer = cos_of(is_spot ? tree_float(cone, "outerConeAngle", PI_F / 4) : PI_F)};
    for (int i = 0; i < 3; i++) out->intensity[i] = color[i] * intensity;
    bool is_named = tree_text(light, "name", "")[0];
    out->name = is_named || !name[0] ? load_name(file->load, light, "light")
                                     : load_keep(file->load, name);
}

static void claim_near(GltfFile *file, const GltfValue *node, const char *what, Vec3 p)
{
    if (!vec3_is_within(p, SCENE_MOST_M))
        file_error(file, node,
                   "its %s stands at (%g, %g, %g) in the scene; numbers within %g m are wanted",
                   what, (double)p.x, (double)p.y, (double)p.z, (double)SCENE_MOST_M);
}

/* The light that was added last; of a directional one glTF ignores the place. */
static bool last_has_place(const Loader *load)
{
    const PunctualLight *light = list_item(&load->lights, load->lights.count - 1);
    return light->kind != LIGHT_DIRECTIONAL;
}

/* Adds cameras and lights; the places of meshes are checked vertex by vertex. */
static void add_sights(GltfFile *file, const GltfValue *node, const Transform *world)
{
    const Loader *load = file->load;
    int           cameras = load->cameras.count, lights = load->lights.count;
    add_camera(file, node, world);
    if (!luminaire_place(file, node, world)) add_light(file, node, world);
    if (load->cameras.count > cameras) claim_near(file, node, "camera", world->origin);
    if (load->lights.count > lights && last_has_place(load))
        claim_near(file, node, "light", world->origin);
}

/* ---- meshes ---------------------------------------------------------------------------- */

/* The places in which a node's mesh stands, in scratch. */
typedef struct Instances {
    Transform *world_from_mesh;
    int count;
} Instances;

/* One of the attributes, or NULL: the default for all. */
static bool read_attribute(GltfFile *file, const GltfValue *attributes, const char *name,
                           const float **out, int *count)
{
    const GltfValue *at = tree_member(attributes, name);
    int id = tree_whole(at, NO_ID);
    const GltfAccessor *accessor = accessor_get(file, id);
    *out = NULL;
    if (!accessor) return true;
    if (!accessor_claim_bytes(file, id, at, name)) return false;
    *out = accessor_floats(file, id);
    *count = (int)accessor->count;
    return true;
}

/* One, at `world`, unless the node states others (EXT_mesh_gpu_instancing); none where bytes
 * are missing. */
static Instances instances_of(GltfFile *file, const GltfValue *node, const Transform *world)
{
    static const float ORIGIN[3] = {0, 0, 0}, UPRIGHT[4] = {0, 0, 0, 1}, SAME[3] = {1, 1, 1};
    Arena *scratch = &file->load->scratch;
    Instances out = {ARENA_NEW(scratch, Transform, 1), 1};
    const GltfValue *attributes =
        tree_member(tree_extension(node, INSTANCING_EXTENSION), "attributes");
    const float *moves, *turns, *scales;
    out.world_from_mesh[0] = *world;
    if (!attributes) return out;
    out.count = 0;
    if (!read_attribute(file, attributes, "TRANSLATION", &moves, &out.count) ||
        !read_attribute(file, attributes, "ROTATION", &turns, &out.count) ||
        !read_attribute(file, attributes, "SCALE", &scales, &out.count))
        return (Instances){NULL, 0};
    out.world_from_mesh = ARENA_NEW(scratch, Transform, out.count);
    for (int i = 0; i < out.count; i++) {
        Transform own = transform_from_trs(moves ? moves + 3 * i : ORIGIN,
                                           turns ? turns + 4 * i : UPRIGHT,
                                           scales ? scales + 3 * i : SAME);
        out.world_from_mesh[i] = transform_compose(world, &own);
    }
    return out;
}

/* ---- all of it ------------------------------------------------------------------------- */

static void add_mesh(GltfFile *file, const GltfValue *node, const Transform *world)
{
    const GltfValue *mesh = tree_referred(tree_member(node, "mesh"), "meshes");
    const GltfValue *primitives = tree_member(mesh, "primitives");
    if (!primitives) return;
    Instances instances = instances_of(file, node, world);
    for (int k = 0; k < instances.count; k++)
        for (int i = 0; i < primitives->count; i++)
            primitive_build(file, node, &instances.world_from_mesh[k], mesh,
                            &primitives->items[i]);
}

/* For options that ask for a node by its name. */
static void note_name(GltfFile *file, const GltfValue *node)
{
    Loader     *load = file->load;
    const char *name = tree_text(node, "name", "");
    if (name[0] && (load->options->light_count || load->options->change_count))
        load_note(load, &load->node_names, name);
}

static void build_environment(GltfFile *file)
{
    const GltfValue *scene =
        tree_element(file->root, "scenes", tree_int(file->root, "scene", 0));
    const GltfValue *extension = tree_extension(scene, "PARHELION_environment");
    if (extension) environment_build(file, extension);
}

static void warn_of_skipped(GltfFile *file)
{
    int animations = tree_count(file->root, "animations");
    if (animations && !file->load->options->state.has_time)
        file_warning(file, tree_member(file->root, "animations"),
                     "%d animation%s skipped: the pose at rest is shown (--time plays them)",
                     animations, animations == 1 ? "" : "s");
    if (file->skipped_count)
        file_warning(file, tree_member(file->root, "meshes"),
                     "%d primitive%s of points or lines skipped: only triangles are shown",
                     file->skipped_count, file->skipped_count == 1 ? "" : "s");
    if (file->degenerate_count)
        file_warning(file, tree_member(file->root, "meshes"),
                     "%d triangle%s without area dropped", file->degenerate_count,
                     file->degenerate_count == 1 ? "" : "s");
}

void graph_build(GltfFile *file)
{
    const GltfValue *nodes = tree_member(file->root, "nodes");
    build_environment(file);
    if (nodes) {
        const int *parent = parents_of(file, nodes);
        place_nodes(file, nodes, parent);
        nodes_change(file, parent);
        NodeOrder order = nodes_of_scene(file, nodes, parent);
        load_progress_begin(file->load, "place", "nodes", order.count);
        for (int i = 0; i < order.count; i++) {
            const GltfValue *node = &nodes->items[order.nodes[i]];
            const Transform *world = &file->world_from_node[order.nodes[i]];
            note_name(file, node);
            add_sights(file, node, world);
            add_mesh(file, node, world);
            load_progress_add(file->load, 1);
        }
        load_progress_end(file->load);
    }
    warn_of_skipped(file);
}
