/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/change/node_change.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "scene/gltf/accessor.h"
#include "text/nearest_word.h"

#define FACES 0.5f     /* of its area: less in one direction is a closed body */
#define UPRIGHT 0.985f /* cosine of 10 degrees: a normal nearer to the vertical has no tilt */
#define MODE_TRIANGLES 4

/* ---- the surface of a node --------------------------------------------------------------- */

typedef struct NodeSurface {
    Vec3 low, high;   /* of all corners */
    Vec3 normal_area; /* sum of normals by area, twice */
    float area;       /* twice */
} NodeSurface;

static void add_point(NodeSurface *to, Vec3 p) {
    to->low = vec3(fminf(to->low.x, p.x), fminf(to->low.y, p.y), fminf(to->low.z, p.z));
    to->high = vec3(fmaxf(to->high.x, p.x), fmaxf(to->high.y, p.y), fmaxf(to->high.z, p.z));
}

static void add_triangles(GltfFile *file, const GltfValue *primitive, const Vec3 *points,
                          size_t count, NodeSurface *to) {
    int indices_id = tree_int(primitive, "indices", NO_ID);
    size_t corners = indices_id >= 0 ? accessor_get(file, indices_id)->count : count;
    uint32_t *indices = indices_id >= 0 ? accessor_integers(file, indices_id) : NULL;
    if (tree_int(primitive, "mode", MODE_TRIANGLES) != MODE_TRIANGLES) return;
    for (size_t i = 0; i + 2 < corners; i += 3) {
        Vec3 p[3];
        for (size_t c = 0; c < 3; c++) {
            size_t at = indices ? indices[i + c] : i + c;
            if (at >= count) return;
            p[c] = points[at];
        }
        Vec3 n = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        to->normal_area = vec3_add(to->normal_area, n);
        to->area += vec3_length(n);
    }
}

static void add_primitive(GltfFile *file, const GltfValue *primitive, const Transform *world,
                          NodeSurface *to) {
    int id = tree_int(tree_member(primitive, "attributes"), "POSITION", NO_ID);
    const GltfAccessor *a = accessor_get(file, id);
    if (!a || !accessor_has_bytes(file, a)) return;
    Vec3 *points = (Vec3 *)accessor_floats(file, id);
    for (size_t i = 0; i < a->count; i++) {
        points[i] = transform_point(world, points[i]);
        add_point(to, points[i]);
    }
    add_triangles(file, primitive, points, a->count, to);
}

static bool is_below(const int *parent, int node, int top) {
    while (node != NO_ID && node != top) node = parent[node];
    return node == top;
}

static NodeSurface surface_of(GltfFile *file, const int *parent, int top) {
    NodeSurface surface = {.low = vec3(INFINITY, INFINITY, INFINITY)};
    const GltfValue *nodes = tree_member(file->root, "nodes");
    Arena begun = file->load->scratch;
    surface.high = vec3_neg(surface.low);
    for (int i = 0; i < nodes->count; i++) {
        const GltfValue *mesh = tree_referred(tree_member(&nodes->items[i], "mesh"), "meshes");
        const GltfValue *primitives = tree_member(mesh, "primitives");
        if (!primitives || !is_below(parent, i, top)) continue;
        for (int k = 0; k < primitives->count; k++)
            add_primitive(file, &primitives->items[k], &file->world_from_node[i], &surface);
    }
    file->load->scratch = begun;
    return surface;
}

/* ---- how it moves ------------------------------------------------------------------------ */

/* Rodrigues' formula. */
static Vec3 turned(Vec3 v, Vec3 axis, float angle) {
    float c = cos_of(angle), s = sin_of(angle);
    Vec3 sum = vec3_add(vec3_scale(v, c), vec3_scale(vec3_cross(axis, v), s));
    return vec3_along(sum, axis, (1 - c) * vec3_dot(axis, v));
}

static Transform about(Vec3 middle, Vec3 axis, float angle) {
    Transform t = {turned(vec3(1, 0, 0), axis, angle), turned(vec3(0, 1, 0), axis, angle),
                   turned(vec3(0, 0, 1), axis, angle), vec3(0, 0, 0)};
    t.origin = vec3_sub(middle, transform_vector(&t, middle));
    return t;
}

/* Where the surface faces; against the vehicle where it faces nowhere that has an up. */
static Vec3 face_normal(const NodeSurface *surface, const SceneChange *change) {
    float length = vec3_length(surface->normal_area);
    Vec3 n = vec3_scale(surface->normal_area, length > 0 ? 1 / length : 0);
    if (length > FACES * surface->area && fabsf(n.y) < UPRIGHT) return n;
    return vec3_normalize(vec3(-change->ahead[0], 0, -change->ahead[2]));
}

static Vec3 vec3_of(const float v[3]) {
    return vec3(v[0], v[1], v[2]);
}

/* Turned about its middle. */
static Transform turns_of(const NodeSurface *surface, const SceneChange *change) {
    const Vec3 up = vec3(0, 1, 0);
    Vec3 n = face_normal(surface, change);
    Vec3 left = vec3_normalize(vec3_cross(n, up)); /* of who faces it */
    Vec3 middle = vec3_scale(vec3_add(surface->low, surface->high), 0.5f);
    Transform tilt = about(middle, left, change->tilt);
    Transform turn = about(middle, up, change->turn);
    Transform roll = about(middle, n, -change->roll);
    Transform all = transform_compose(&tilt, &turn);
    return transform_compose(&all, &roll);
}

static bool has_turns(const SceneChange *change) {
    return change->tilt != 0 || change->turn != 0 || change->roll != 0;
}

/* top: the named node's place; origin_m: the scene's. */
static Transform move_of(const NodeSurface *surface, const SceneChange *change,
                         const Transform *top, const double origin_m[3]) {
    const SceneHinge *h = &change->hinge;
    Transform all =
        has_turns(change) ? turns_of(surface, change) : about(vec3(0, 0, 0), vec3(0, 1, 0), 0);
    if (h->angle != 0) {
        Vec3 through = h->is_own ? top->origin : scene_from_world(origin_m, h->through_m);
        Transform swing = about(through, vec3_of(h->axis), h->angle);
        all = transform_compose(&swing, &all);
    }
    all.origin = vec3_add(all.origin, vec3_of(change->move_m));
    return all;
}

/* ---- which nodes ------------------------------------------------------------------------- */

static int count_named(const GltfValue *nodes, const char *name, int *first) {
    int count = 0;
    for (int i = nodes->count; i-- > 0;)
        if (!strcmp(tree_text(&nodes->items[i], "name", ""), name)) {
            *first = i;
            count++;
        }
    return count;
}

static void report_missing(GltfFile *file, const GltfValue *nodes, const SceneChange *change,
                           const char *name) {
    char advice[600];
    const char **names = ARENA_NEW(&file->load->scratch, const char *, nodes->count);
    for (int i = 0; i < nodes->count; i++) names[i] = tree_text(&nodes->items[i], "name", "");
    problems_add(file->load->problems, SEVERITY_ERROR, change->file, change->place,
                 "no node of %.200s is named \"%.100s\" — %s", file->path, name,
                 nearest_word_advice(name, names, nodes->count, advice, (int)sizeof advice));
}

/* Its place among the nodes; NO_ID, and reported, where it is not the only one. */
static int find_node(GltfFile *file, const SceneChange *change, const char *name) {
    const GltfValue *nodes = tree_member(file->root, "nodes");
    int first = NO_ID, count = count_named(nodes, name, &first);
    if (count == 1) return first;
    if (!count) report_missing(file, nodes, change, name);
    else
        problems_add(file->load->problems, SEVERITY_ERROR, change->file, change->place,
                     "%d nodes of %.200s are named \"%.100s\", required: "
                     "one",
                     count, file->path, name);
    return NO_ID;
}

/* Marks it and what hangs below. */
static bool mark(GltfFile *file, const int *parent, const SceneChange *change, const char *name,
                 bool *is_moved) {
    const GltfValue *nodes = tree_member(file->root, "nodes");
    int top = find_node(file, change, name);
    if (top == NO_ID) return false;
    for (int i = 0; i < nodes->count; i++) is_moved[i] |= is_below(parent, i, top);
    return true;
}

static void change_nodes(GltfFile *file, const SceneChange *change) {
    const int *parent = file->parents;
    const GltfValue *nodes = tree_member(file->root, "nodes");
    bool *is_moved = ARENA_NEW(&file->load->scratch, bool, nodes->count);
    if (!mark(file, parent, change, change->name, is_moved)) return;
    for (int i = 0; i < change->with_count; i++)
        if (!mark(file, parent, change, change->with[i], is_moved)) return;
    int top = find_node(file, change, change->name);
    NodeSurface surface = surface_of(file, parent, top);
    if (has_turns(change) && !(surface.low.x <= surface.high.x)) {
        problems_add(file->load->problems, SEVERITY_ERROR, change->file, change->place,
                     "node \"%.100s\" of %.200s has no surface to turn about: required: one "
                     "with triangles",
                     change->name, file->path);
        return;
    }
    Transform move = move_of(&surface, change, &file->world_from_node[top], file->load->origin);
    NodePlace exact = node_place_of(&move);
    for (int i = 0; i < nodes->count; i++)
        if (is_moved[i]) {
            file->world_from_node[i] = transform_compose(&move, &file->world_from_node[i]);
            file->places[i] = node_place_compose(&exact, &file->places[i]);
        }
}

void nodes_change(GltfFile *file) {
    const SceneOptions *options = file->load->options;
    const GltfValue *nodes = tree_member(file->root, "nodes");
    for (int i = 0; i < options->change_count; i++) {
        const SceneChange *change = &options->changes[i];
        int first;
        if (change->kind != CHANGE_NODES) continue;
        int count = count_named(nodes, change->name, &first);
        if (!count) continue;
        file->load->change_uses[i]++;
        change_nodes(file, change);
    }
}
