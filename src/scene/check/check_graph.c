/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_graph.h"

#include <string.h>

#include "scene/gltf/accessor.h"

/* A unit quaternion rounded to signed bytes is off by at most sqrt(4) * 0.5/127 in length. */
#define QUATERNION_ALLOWED 0.00788f

static const GltfValue *first_primitive(const GltfValue *mesh) {
    return tree_item(tree_member(mesh, "primitives"), 0);
}

/* ---- nodes ----------------------------------------------------------------------------- */

static void check_matrix(const DocumentCheck *check, const GltfValue *node) {
    static const char *const PARTS[] = {"translation", "rotation", "scale"};
    float matrix[16];
    for (int i = 0; i < 3; i++)
        if (tree_member(node, PARTS[i]))
            check_fails(check, node,
                        "has \"matrix\" and \"%s\"; one way is "
                        "required",
                        PARTS[i]);
    if (!tree_floats(node, "matrix", 16, matrix)) return;
    if (matrix[3] != 0 || matrix[7] != 0 || matrix[11] != 0 || matrix[15] != 1)
        check_fails(check, tree_member(node, "matrix"),
                    "the last row is (%g, %g, %g, %g), "
                    "(0, 0, 0, 1) is required",
                    (double)matrix[3], (double)matrix[7], (double)matrix[11], (double)matrix[15]);
}

static void check_rotation(const DocumentCheck *check, const GltfValue *node) {
    float q[4];
    if (!tree_floats(node, "rotation", 4, q)) return;
    float length = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(fabsf(length - 1) <= QUATERNION_ALLOWED))
        check_fails(check, tree_member(node, "rotation"),
                    "the quaternion's length is %g, 1 is "
                    "required",
                    (double)length);
}

static void check_weights(const DocumentCheck *check, const GltfValue *owner,
                          const GltfValue *mesh) {
    const GltfValue *weights = tree_member(owner, "weights");
    int targets = tree_count(first_primitive(mesh), "targets");
    if (weights && weights->kind == GLTF_ARRAY && weights->count != targets)
        check_fails(check, weights, "has %d weights, the mesh has %d morph targets", weights->count,
                    targets);
}

/* How many of a mesh's primitives name joints. */
static int bent_primitives(const GltfValue *mesh) {
    int count = 0;
    for (const GltfValue *p = tree_items(mesh, "primitives"); p; p = tree_next(p))
        count += tree_member(tree_member(p, "attributes"), "JOINTS_0") != NULL;
    return count;
}

void check_node(const DocumentCheck *check, const GltfValue *node) {
    const GltfValue *mesh = tree_referred(tree_member(node, "mesh"), "meshes");
    const GltfValue *skin = tree_member(node, "skin");
    if (tree_member(node, "matrix")) check_matrix(check, node);
    check_rotation(check, node);
    if (!mesh) return;
    check_weights(check, node, mesh);
    int bent = bent_primitives(mesh), all = tree_count(mesh, "primitives");
    if (skin && bent < all)
        check_warns(check, node, "has a skin, but its mesh names no joints: it is not bent");
    if (!skin && bent)
        check_warns(check, node, "its mesh names joints, but there is no skin: it is not bent");
}

/* ---- EXT_mesh_gpu_instancing ------------------------------------------------------------- */

typedef struct InstanceAttribute {
    const char *name, *type;
    bool may_be_integer; /* signed and normalised */
} InstanceAttribute;

static const InstanceAttribute INSTANCE_ATTRIBUTES[] = {
    {"TRANSLATION", "VEC3", false}, {"ROTATION", "VEC4", true}, {"SCALE", "VEC3", false}};

static void check_instance_format(const DocumentCheck *check, const GltfValue *at,
                                  const InstanceAttribute *wanted) {
    const GltfValue *accessor = tree_referred(at, "accessors");
    const char *type = tree_text(accessor, "type", "");
    int code = tree_int(accessor, "componentType", 0);
    bool is_integer = (code == 5120 || code == 5122) && wanted->may_be_integer &&
                      tree_boolean(accessor, "normalized", false);
    if (accessor && (strcmp(type, wanted->type) != 0 || (code != 5126 && !is_integer)))
        check_fails(check, at, "%s is %s of component type %s, %s of %s is required", at->key, type,
                    component_name(code), wanted->type, component_name(5126));
}

void check_instancing(const DocumentCheck *check, const GltfValue *extension) {
    const GltfValue *attributes = tree_member(extension, "attributes");
    const GltfValue *node = extension->parent->parent;
    double count = -1;
    if (tree_member(node, "skin"))
        check_fails(check, extension, "the node has a skin, which stands where its joints do");
    for (int i = 0; i < tree_count(extension, "attributes"); i++) {
        const GltfValue *at = &attributes->items[i];
        double own = tree_number(tree_referred(at, "accessors"), "count", count);
        if (count >= 0 && own != count)
            check_fails(check, at, "%.60s has %.0f elements, others have %.0f", at->key, own,
                        count);
        count = own;
        for (int k = 0; k < 3; k++)
            if (strcmp(INSTANCE_ATTRIBUTES[k].name, at->key ? at->key : "") == 0)
                check_instance_format(check, at, &INSTANCE_ATTRIBUTES[k]);
    }
    if (count > LOAD_MAX_INSTANCES)
        check_fails(check, attributes, "are %.0f instances, at most %d are read", count,
                    LOAD_MAX_INSTANCES);
}

void check_mesh(const DocumentCheck *check, const GltfValue *mesh) {
    const GltfValue *primitives = tree_member(mesh, "primitives");
    int targets = tree_count(first_primitive(mesh), "targets");
    check_weights(check, mesh, mesh);
    for (int i = 1; primitives && i < primitives->count; i++)
        if (tree_count(&primitives->items[i], "targets") != targets)
            check_fails(check, &primitives->items[i],
                        "has %d morph targets, the mesh's first "
                        "primitive has %d",
                        tree_count(&primitives->items[i], "targets"), targets);
}

void check_skin(const DocumentCheck *check, const GltfValue *skin) {
    const GltfValue *value = tree_member(skin, "inverseBindMatrices");
    const GltfValue *accessor = tree_referred(value, "accessors");
    int joints = tree_count(skin, "joints");
    if (!joints && tree_member(skin, "joints")) check_fails(check, skin, "has no joints");
    if (!accessor) return;
    if (strcmp(tree_text(accessor, "type", ""), "MAT4") != 0 ||
        tree_int(accessor, "componentType", 0) != 5126)
        check_fails(check, value,
                    "refers to an accessor of %s of component type %s, MAT4 of %s is required",
                    tree_text(accessor, "type", "nothing"),
                    component_name(tree_int(accessor, "componentType", 0)), component_name(5126));
    if (tree_number(accessor, "count", 0) < joints)
        check_fails(check, value, "has %g matrices for %d joints",
                    tree_number(accessor, "count", 0), joints);
}

/* ---- the tree of nodes: one parent at most, and no way back ---------------------------- */

static int index_of(const GltfValue *value, int count) {
    int index = tree_whole(value, NO_ID);
    return index >= 0 && index < count ? index : NO_ID;
}

static void find_parents(const DocumentCheck *check, const GltfValue *nodes, int *parent) {
    for (int i = 0; i < nodes->count; i++) parent[i] = NO_ID;
    for (int i = 0; i < nodes->count; i++) {
        const GltfValue *c = tree_items(&nodes->items[i], "children");
        for (; c; c = tree_next(c)) {
            int child = index_of(c, nodes->count);
            if (child == NO_ID) continue;
            if (parent[child] != NO_ID && parent[child] != i)
                check_fails(check, c, "node %d has two parents, nodes %d and %d", child,
                            parent[child], i);
            parent[child] = i;
        }
    }
}

/* Walks up from every node; a walk that meets its own trail has found a circle. */
static void find_cycles(const DocumentCheck *check, const GltfValue *nodes, const int *parent,
                        int *trail) {
    for (int i = 0; i < nodes->count; i++) {
        int node = i;
        while (node != NO_ID && !trail[node]) {
            trail[node] = i + 1;
            node = parent[node];
        }
        if (node != NO_ID && trail[node] == i + 1)
            check_fails(check, &nodes->items[node], "the node is its own descendant");
    }
}

static void check_roots(const DocumentCheck *check, const GltfValue *root, const int *parent,
                        int count) {
    for (const GltfValue *s = tree_items(root, "scenes"); s; s = tree_next(s))
        for (const GltfValue *n = tree_items(s, "nodes"); n; n = tree_next(n)) {
            int node = index_of(n, count);
            if (node != NO_ID && parent[node] != NO_ID)
                check_fails(check, n, "node %d is a child of node %d, a scene lists roots only",
                            node, parent[node]);
        }
}

void check_hierarchy(const DocumentCheck *check, const GltfValue *root) {
    const GltfValue *nodes = tree_member(root, "nodes");
    Arena scratch = check->file->load->scratch;
    if (!nodes || nodes->kind != GLTF_ARRAY) return;
    int *parent = ARENA_NEW(&scratch, int, nodes->count);
    find_parents(check, nodes, parent);
    find_cycles(check, nodes, parent, ARENA_NEW(&scratch, int, nodes->count));
    check_roots(check, root, parent, nodes->count);
}
