/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/scene_origin.h"

#include <math.h>
#include <stdlib.h>

#include "scene/gltf/accessor.h"
#include "scene/load/node_transform.h"
#include "scene/load/nodes.h"

/* Vertices so many sizes from their node are off by up to 2^-14 of one: as much as a seal or a
 * film is thick. */
#define FAR_IN_SIZES 1024

/* One primitive at one place, m. */
typedef struct PartBox {
    double middle[3]; /* world */
    double away;      /* of its middle from its node, */
    double half;      /* half its diagonal */
} PartBox;

/* ---- boxes ------------------------------------------------------------------------------- */

/* The least and the greatest of a primitive's positions; false: it has none. */
static bool bounds_of(GltfFile *file, const GltfValue *primitive, double low[3], double high[3]) {
    int id = tree_int(tree_member(primitive, "attributes"), "POSITION", NO_ID);
    Arena begun = file->load->scratch;
    const GltfAccessor *accessor = accessor_get(file, id);
    if (!accessor || !accessor->count || !accessor_has_bytes(file, accessor)) return false;
    const float *values = accessor_floats(file, id);
    for (int k = 0; k < 3; k++) low[k] = high[k] = (double)values[k];
    for (size_t i = 3; i < 3 * accessor->count; i++) {
        low[i % 3] = fmin(low[i % 3], (double)values[i]);
        high[i % 3] = fmax(high[i % 3], (double)values[i]);
    }
    file->load->scratch = begun;
    return true;
}

static PartBox box_at(const NodePlace *place, const double low[3], const double high[3]) {
    double middle[3], squares = 0, moved[3];
    PartBox box;
    for (int k = 0; k < 3; k++) {
        const double *axis = place->axis[k];
        double half = 0.5 * (high[k] - low[k]);
        middle[k] = 0.5 * (low[k] + high[k]);
        squares += half * half * (axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    }
    node_place_vector(place, middle, moved);
    node_place_point(place, middle, box.middle);
    box.away = sqrt(moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2]);
    box.half = sqrt(squares);
    return box;
}

/* A skinned mesh is taken where its first joint puts it. */
static NodePlace place_of_skin(GltfFile *file, const GltfValue *skin) {
    const GltfValue *joints = tree_member(skin, "joints");
    int inverse = tree_int(skin, "inverseBindMatrices", NO_ID);
    Arena begun = file->load->scratch;
    NodePlace place = file->places[tree_whole(tree_item(joints, 0), 0)];
    if (inverse >= 0) {
        Transform bind = transform_from_matrix(accessor_floats(file, inverse));
        NodePlace own = node_place_of(&bind);
        place = node_place_compose(&place, &own);
    }
    file->load->scratch = begun;
    return place;
}

static void add_boxes(GltfFile *file, const GltfValue *node, const GltfValue *primitive,
                      ItemList *boxes) {
    const GltfValue *skin = tree_referred(tree_member(node, "skin"), "skins");
    double low[3], high[3];
    if (!bounds_of(file, primitive, low, high)) return;
    for (int i = 0; i < file->instances[node->index].count; i++) {
        NodePlace place =
            skin ? place_of_skin(file, skin) : nodes_instance_place(file, node->index, i);
        *(PartBox *)list_add(boxes, &file->load->scratch) = box_at(&place, low, high);
    }
}

static ItemList boxes_of(GltfFile *file) {
    const GltfValue *nodes = tree_member(file->root, "nodes");
    ItemList boxes = list_of(sizeof(PartBox));
    for (int i = 0; i < file->shown_count; i++) {
        const GltfValue *node = &nodes->items[file->shown[i]];
        const GltfValue *mesh = tree_referred(tree_member(node, "mesh"), "meshes");
        const GltfValue *p = tree_items(mesh, "primitives");
        for (; p; p = tree_next(p)) add_boxes(file, node, p, &boxes);
    }
    return boxes;
}

/* ---- medians ----------------------------------------------------------------------------- */

static int compare_numbers(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Of the number at this offset of all boxes. */
static double median(const ItemList *boxes, size_t offset, Arena scratch) {
    double *values = ARENA_NEW(&scratch, double, boxes->count);
    for (int i = 0; i < boxes->count; i++)
        values[i] = *(const double *)((const char *)list_item(boxes, i) + offset);
    qsort(values, (size_t)boxes->count, sizeof *values, compare_numbers);
    return 0.5 * (values[(boxes->count - 1) / 2] + values[boxes->count / 2]);
}

/* ---- the origin -------------------------------------------------------------------------- */

static void warn_of_far_vertices(Loader *load, const GltfFile *file, double away, double half) {
    if (!(away > FAR_IN_SIZES * half)) return;
    problems_add(load->problems, SEVERITY_WARNING, file->path, "",
                 "half of the meshes have their vertices %.3g m or more from the origin of "
                 "their node, where 32-bit numbers are %.2g m apart: what lies closer together "
                 "is lost in the file itself; move the vertices nearer to it and give the "
                 "distance to the node",
                 away, away * 0x1p-23);
}

static void set_origin(Loader *load, const double middle[3], double half) {
    double step = 1, squares = 0;
    for (int k = 0; k < 3; k++) squares += middle[k] * middle[k];
    double away = sqrt(squares);
    if (!(away > ORIGIN_IN_SIZES * half) || !(away <= (double)SCENE_MOST_M)) return;
    while (half > 0 && step > ORIGIN_IN_SIZES * half) step *= 0.5;
    for (int k = 0; k < 3; k++) load->origin[k] = step * floor(middle[k] / step + 0.5);
}

void scene_origin_find(Loader *load, GltfFile *const *files, int count) {
    Arena begun = load->scratch;
    ItemList boxes = {0};
    int first = -1;
    while (!boxes.count && ++first < count) boxes = boxes_of(files[first]);
    if (boxes.count) {
        const size_t at = offsetof(PartBox, middle);
        double half = median(&boxes, offsetof(PartBox, half), load->scratch), middle[3];
        for (size_t k = 0; k < 3; k++)
            middle[k] = median(&boxes, at + k * sizeof *middle, load->scratch);
        set_origin(load, middle, half);
        warn_of_far_vertices(load, files[first],
                             median(&boxes, offsetof(PartBox, away), load->scratch), half);
    }
    load->scratch = begun;
}
