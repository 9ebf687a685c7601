/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/nodes.h"

#include <math.h>
#include <string.h>

#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"
#include "scene/load/node_transform.h"
#include "scene/load/pose.h"

/* ---- places ---------------------------------------------------------------------------- */

/* pose: the values of animations; NULL: at rest. */
static Transform parent_from_node(const GltfValue *node, const NodePose *pose) {
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

static void set_from(double *out, const float *from, int count) {
    for (int i = 0; from && i < count; i++) out[i] = (double)from[i];
}

/* T R S, as transform_from_trs. */
static NodePlace place_from_trs(const double t[3], const double q[4], const double s[3]) {
    double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    double k = n > 0 ? 1 / n : 0;
    double x = q[0] * k, y = q[1] * k, z = q[2] * k, w = n > 0 ? q[3] * k : 1;
    return (NodePlace){
        {{s[0] * (1 - 2 * (y * y + z * z)), s[0] * 2 * (x * y + w * z), s[0] * 2 * (x * z - w * y)},
         {s[1] * 2 * (x * y - w * z), s[1] * (1 - 2 * (x * x + z * z)), s[1] * 2 * (y * z + w * x)},
         {s[2] * 2 * (x * z + w * y), s[2] * 2 * (y * z - w * x),
          s[2] * (1 - 2 * (x * x + y * y))}},
        {t[0], t[1], t[2]}};
}

static NodePlace place_in_parent(const GltfValue *node, const NodePose *pose) {
    double m[16], t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    if (tree_numbers(node, "matrix", 16, m))
        return (NodePlace){{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}},
                           {m[12], m[13], m[14]}};
    tree_numbers(node, "translation", 3, t);
    tree_numbers(node, "rotation", 4, q);
    tree_numbers(node, "scale", 3, s);
    if (pose) {
        set_from(t, pose->translation, 3);
        set_from(q, pose->rotation, 4);
        set_from(s, pose->scale, 3);
    }
    return place_from_trs(t, q, s);
}

/* ---- cameras --------------------------------------------------------------------------- */

/* The turn in a matrix: of the mirrors that it may hold the one that leaves the smallest. */
static Transform unscaled_matrix(const Transform *m) {
    Transform turn = {vec3_normalize(m->x), vec3_normalize(m->y), vec3_normalize(m->z),
                      vec3(0, 0, 0)};
    Vec3 *column[3] = {&turn.x, &turn.y, &turn.z};
    float own[3] = {turn.x.x, turn.y.y, turn.z.z}, trace = own[0] + own[1] + own[2];
    int least = own[1] < own[0] ? 1 : 0;
    if (!(transform_determinant(m) < 0)) return turn;
    if (own[2] < own[least]) least = 2;
    bool is_all = -trace > trace - 2 * own[least];
    for (int i = 0; i < 3; i++)
        if (is_all || i == least) *column[i] = vec3_neg(*column[i]);
    return turn;
}

/* The node in its parent, and what is left of it without a scale. */
static void camera_step(const GltfFile *file, const GltfValue *node, Transform *place,
                        Transform *unscaled) {
    static const float one[3] = {1, 1, 1};
    NodePose pose = file->poses ? file->poses[node->index] : (NodePose){0};
    *place = parent_from_node(node, &pose);
    pose.scale = one;
    *unscaled =
        tree_member(node, "matrix") ? unscaled_matrix(place) : parent_from_node(node, &pose);
}

/* The column's direction; against `turn`, where a scale below 0 has turned it, the other one.
 * False: a shear has bent it away from there, or a scale of 0 has left none. */
static bool unscale_axis(Vec3 turn, Vec3 own, Vec3 now, Vec3 *out) {
    float along = vec3_dot(vec3_normalize(own), turn);
    *out = vec3_normalize(along < 0 ? vec3_neg(now) : now);
    return fabsf(along) > 0.9999f;
}

static bool is_moved(Vec3 own, Vec3 now) {
    return vec3_length(vec3_sub(own, now)) > 1e-4f * vec3_length(own);
}

Transform nodes_camera_place(const GltfFile *file, const GltfValue *node, const Transform *world) {
    const GltfValue *nodes = node->parent;
    Transform own, turn, place, step, out = *world;
    camera_step(file, node, &own, &turn);
    for (int p = file->parents[node->index]; p != NO_ID; p = file->parents[p]) {
        camera_step(file, &nodes->items[p], &place, &step);
        own = transform_compose(&place, &own);
        turn = transform_compose(&step, &turn);
    }
    bool is_square = unscale_axis(turn.x, own.x, world->x, &out.x);
    is_square &= unscale_axis(turn.y, own.y, world->y, &out.y);
    is_square &= unscale_axis(turn.z, own.z, world->z, &out.z);
    if (!is_square && !is_moved(own.x, world->x) && !is_moved(own.y, world->y) &&
        !is_moved(own.z, world->z))
        out = (Transform){turn.x, turn.y, turn.z, world->origin};
    /* a change mirrors the scene: the picture stays the right way round */
    if (transform_determinant(&out) < 0) out.x = vec3_neg(out.x);
    return out;
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
static bool is_hidden(const NodeOrder *order, const GltfValue *node) {
    const NodePose *pose = order->poses ? &order->poses[node->index] : NULL;
    if (pose && pose->visible) return pose->visible[0] == 0;
    return !tree_boolean(tree_extension(node, "KHR_node_visibility"), "visible", true);
}

static NodeOrder order_start(GltfFile *file, int node_count) {
    Arena *scratch = &file->load->scratch;
    return (NodeOrder){file->poses,
                       ARENA_NEW(scratch, int, node_count),
                       ARENA_NEW(scratch, int, node_count),
                       ARENA_NEW(scratch, bool, node_count),
                       0,
                       node_count,
                       false};
}

static void order_below(NodeOrder *order, const GltfValue *nodes, int root) {
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

static void find_parents(GltfFile *file, const GltfValue *nodes) {
    int *parent = file->parents = ARENA_NEW(&file->load->scratch, int, nodes->count);
    for (int i = 0; i < nodes->count; i++) parent[i] = NO_ID;
    for (int i = 0; i < nodes->count; i++) {
        const GltfValue *c = tree_items(&nodes->items[i], "children");
        for (; c; c = tree_next(c))
            if (c->number >= 0 && c->number < nodes->count) parent[(int)c->number] = i;
    }
}

static void place_node(GltfFile *file, const GltfValue *nodes, int node) {
    const NodePose *pose = file->poses ? &file->poses[node] : NULL;
    int parent = file->parents[node];
    Transform *world = file->world_from_node;
    NodePlace *places = file->places;
    world[node] = parent_from_node(&nodes->items[node], pose);
    places[node] = place_in_parent(&nodes->items[node], pose);
    if (parent == NO_ID) return;
    world[node] = transform_compose(&world[parent], &world[node]);
    places[node] = node_place_compose(&places[parent], &places[node]);
}

static void place_all(GltfFile *file, const GltfValue *nodes) {
    NodeOrder order = order_start(file, nodes->count);
    file->world_from_node = ARENA_NEW(&file->load->scratch, Transform, nodes->count);
    file->places = ARENA_NEW(&file->load->scratch, NodePlace, nodes->count);
    for (int i = 0; i < nodes->count; i++)
        if (file->parents[i] == NO_ID) order_below(&order, nodes, i);
    for (int i = 0; i < order.count; i++) place_node(file, nodes, order.nodes[i]);
}

/* The nodes of the scene to show: the file's default, else its first, else every root. */
static void find_shown(GltfFile *file, const GltfValue *nodes) {
    NodeOrder order = order_start(file, nodes->count);
    order.skips_hidden = true;
    const GltfValue *scene = tree_element(file->root, "scenes", tree_int(file->root, "scene", 0));
    if (!scene) {
        file_warning(file, NULL, "the file has no scene; all its nodes are shown");
        for (int i = 0; i < nodes->count; i++)
            if (file->parents[i] == NO_ID) order_below(&order, nodes, i);
    }
    for (const GltfValue *r = tree_items(scene, "nodes"); r; r = tree_next(r))
        order_below(&order, nodes, (int)r->number);
    file->shown = order.nodes;
    file->shown_count = order.count;
}

/* ---- instances ------------------------------------------------------------------------- */

/* One of the attributes, or NULL: the default for all. */
static bool read_attribute(GltfFile *file, const GltfValue *attributes, const char *name,
                           const float **out, int *count) {
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

/* As many as the attributes have elements. Where none of them places an instance all stand where
 * the node does, and one is as good: attributes of others (_ID) are not read. */
static NodeInstances instances_of(GltfFile *file, const GltfValue *node) {
    static const float ORIGIN[3] = {0, 0, 0}, UPRIGHT[4] = {0, 0, 0, 1}, SAME[3] = {1, 1, 1};
    Arena *scratch = &file->load->scratch;
    NodeInstances out = {NULL, 1};
    const GltfValue *attributes =
        tree_member(tree_extension(node, INSTANCING_EXTENSION), "attributes");
    const float *moves, *turns, *scales;
    if (!attributes) return out;
    out.count = 0;
    if (!read_attribute(file, attributes, "TRANSLATION", &moves, &out.count) ||
        !read_attribute(file, attributes, "ROTATION", &turns, &out.count) ||
        !read_attribute(file, attributes, "SCALE", &scales, &out.count))
        return (NodeInstances){NULL, 0};
    if (!moves && !turns && !scales) return (NodeInstances){NULL, 1};
    out.node_from_mesh = ARENA_NEW(scratch, Transform, out.count);
    for (int i = 0; i < out.count; i++)
        out.node_from_mesh[i] =
            transform_from_trs(moves ? moves + 3 * i : ORIGIN, turns ? turns + 4 * i : UPRIGHT,
                               scales ? scales + 3 * i : SAME);
    return out;
}

static void find_instances(GltfFile *file, const GltfValue *nodes) {
    file->instances = ARENA_NEW(&file->load->scratch, NodeInstances, nodes->count);
    for (int i = 0; i < file->shown_count; i++) {
        int node = file->shown[i];
        if (tree_member(&nodes->items[node], "mesh"))
            file->instances[node] = instances_of(file, &nodes->items[node]);
    }
}

/* ---- all of it ------------------------------------------------------------------------- */

void nodes_place(GltfFile *file) {
    const GltfValue *nodes = tree_member(file->root, "nodes");
    if (!nodes) return;
    find_parents(file, nodes);
    place_all(file, nodes);
    find_shown(file, nodes);
    find_instances(file, nodes);
}

void nodes_enter_scene(GltfFile *file) {
    int count = tree_count(file->root, "nodes");
    for (int i = 0; i < count; i++) {
        double *at = file->places[i].origin;
        for (int k = 0; k < 3; k++) at[k] -= file->load->origin[k];
        file->world_from_node[i].origin = vec3_from_doubles(at);
    }
}

NodePlace nodes_instance_place(const GltfFile *file, int node, int instance) {
    const Transform *own = file->instances[node].node_from_mesh;
    if (!own) return file->places[node];
    NodePlace place = node_place_of(&own[instance]);
    return node_place_compose(&file->places[node], &place);
}
