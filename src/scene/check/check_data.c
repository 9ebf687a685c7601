/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_data.h"

#include <stdio.h>
#include <string.h>

#include "scene/gltf/accessor.h"
#include "scene/gltf/animation_target.h"
#include "scene/gltf/document.h"

/* ---- numbers --------------------------------------------------------------------------- */

/* Reports the first number that is not finite. */
static void check_finite(GltfFile *file, const GltfValue *value, const GltfAccessor *accessor,
                         const float *numbers) {
    size_t total = accessor->count * (size_t)accessor->component_count;
    for (size_t i = 0; i < total; i++) {
        if (isfinite(numbers[i])) continue;
        file_error(file, value, "element %zu has the component %g; finite numbers are required",
                   i / (size_t)accessor->component_count, (double)numbers[i]);
        return;
    }
}

static void check_sparse_order(GltfFile *file, const GltfValue *value,
                               const GltfAccessor *accessor) {
    const uint32_t *indices = accessor_sparse_indices(file, accessor);
    for (size_t i = 0; indices && i < accessor->sparse_count; i++) {
        if (indices[i] >= accessor->count) {
            file_error(file, tree_member(value, "sparse"),
                       "index %zu is %u, the accessor has %zu "
                       "elements",
                       i, indices[i], accessor->count);
            return;
        }
        if (i && indices[i] <= indices[i - 1]) {
            file_error(file, tree_member(value, "sparse"),
                       "index %zu is %u after %u; indices that "
                       "rise are required",
                       i, indices[i], indices[i - 1]);
            return;
        }
    }
}

static void check_one(GltfFile *file, int id) {
    const GltfValue *value = tree_element(file->root, "accessors", id);
    const GltfAccessor *accessor = accessor_get(file, id);
    if (!accessor->component_count) return; /* of a type that an extension adds */
    if (!accessor->sparse_count && accessor->buffer_view < 0) return; /* zeros */
    if (accessor->sparse_count) check_sparse_order(file, value, accessor);
    if (accessor_is_float(accessor))
        check_finite(file, value, accessor, accessor_raw_floats(file, id));
}

/* ---- indices --------------------------------------------------------------------------- */

static int attribute(const GltfValue *primitive, const char *name) {
    return tree_int(tree_member(primitive, "attributes"), name, NO_ID);
}

static void check_vertex_indices(GltfFile *file, const GltfValue *primitive) {
    const GltfAccessor *indices = accessor_get(file, tree_int(primitive, "indices", NO_ID));
    const GltfAccessor *position = accessor_get(file, attribute(primitive, "POSITION"));
    if (!indices || !position) return;
    const uint32_t *list = accessor_integers(file, tree_int(primitive, "indices", NO_ID));
    size_t wrong = 0, first = 0, restart = 0;
    uint32_t greatest =
        (uint32_t)(0xFFFFFFFFu >> (32 - 8 * component_size(indices->component_type)));
    for (size_t i = indices->count; i-- > 0;)
        if (list[i] >= position->count) {
            wrong++;
            first = i;
        } else if (list[i] == greatest) {
            restart++;
        }
    if (restart)
        file_warning(file, tree_member(primitive, "indices"),
                     "the greatest index of its type, %u, "
                     "stands there %zu times: glTF reserves it",
                     greatest, restart);
    if (wrong)
        file_error(file, tree_member(primitive, "indices"),
                   "index %zu is %u, the primitive has "
                   "%zu vertices (%zu such indices)",
                   first, list[first], position->count, wrong);
}

static void check_joint_indices(GltfFile *file, const GltfValue *node, const GltfValue *primitive) {
    const GltfValue *skin = tree_referred(tree_member(node, "skin"), "skins");
    uint32_t count = (uint32_t)tree_count(skin, "joints");
    for (int n = 0; n < 8 && count; n++) {
        char name[24];
        snprintf(name, sizeof name, "JOINTS_%d", n);
        const GltfAccessor *accessor = accessor_get(file, attribute(primitive, name));
        if (!accessor) return;
        const uint32_t *joints = accessor_integers(file, attribute(primitive, name));
        for (size_t i = 0; i < 4 * accessor->count; i++) {
            if (joints[i] < count) continue;
            file_error(file, tree_member(tree_member(primitive, "attributes"), name),
                       "vertex %zu names joint %u, the skin has %u joints", i / 4, joints[i],
                       count);
            return;
        }
    }
}

static void check_primitives(GltfFile *file) {
    for (const GltfValue *m = tree_items(file->root, "meshes"); m; m = tree_next(m)) {
        for (const GltfValue *p = tree_items(m, "primitives"); p; p = tree_next(p)) {
            Arena saved = file->load->scratch;
            check_vertex_indices(file, p);
            file->load->scratch = saved;
        }
        load_progress_add(file->load, 1);
    }
}

static void check_skinned_nodes(GltfFile *file) {
    const GltfValue *node = tree_items(file->root, "nodes");
    for (; node; node = tree_next(node)) {
        const GltfValue *mesh = tree_referred(tree_member(node, "mesh"), "meshes");
        if (!tree_member(node, "skin")) continue;
        for (const GltfValue *p = tree_items(mesh, "primitives"); p; p = tree_next(p)) {
            Arena saved = file->load->scratch;
            check_joint_indices(file, node, p);
            file->load->scratch = saved;
        }
    }
}

/* ---- quaternions and times ---------------------------------------------------------- */

/* Rounded to signed bytes it is off by at most sqrt(4) * 0.5/127. */
static bool is_unit(const float q[4]) {
    float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    return fabsf(sqrtf(square) - 1) <= 0.00788f;
}

/* Of a fault that leaves open where something stands, when animations are played. */
static Severity if_played(const GltfFile *file) {
    return file->load->options->state.has_time ? SEVERITY_ERROR : SEVERITY_WARNING;
}

static void check_turns(GltfFile *file, const GltfValue *animation, const GltfValue *channel) {
    AnimationTarget moved;
    const GltfValue *sampler =
        tree_item(tree_member(animation, "samplers"), tree_int(channel, "sampler", NO_ID));
    int id = tree_int(sampler, "output", NO_ID);
    bool is_cubic = strcmp(tree_text(sampler, "interpolation", "LINEAR"), "CUBICSPLINE") == 0;
    const GltfAccessor *accessor = accessor_get(file, id);
    if (!accessor || accessor->component_count != 4 ||
        !animation_target(file->root, channel, &moved) || moved.path != MOVES_ROTATION)
        return;
    const float *q = accessor_floats(file, id);
    for (size_t i = is_cubic; i < accessor->count; i += is_cubic ? 3 : 1)
        if (!is_unit(q + 4 * i)) {
            file_problem(file, if_played(file), channel,
                         "quaternion %zu of the rotation is not of length 1", i);
            return;
        }
}

/* Key frames follow one another. */
static void check_times(GltfFile *file, const GltfValue *sampler) {
    int id = tree_int(sampler, "input", NO_ID);
    const GltfAccessor *accessor = accessor_get(file, id);
    if (!accessor || accessor->component_count != 1) return;
    const float *times = accessor_floats(file, id);
    for (size_t i = 0; i < accessor->count; i++) {
        if (i == 0 || times[i] > times[i - 1]) continue;
        file_problem(file, if_played(file), sampler,
                     "time %zu is %g after %g; times that rise are required", i, (double)times[i],
                     (double)times[i - 1]);
        return;
    }
}

static void check_animation_data(GltfFile *file, const GltfValue *animation) {
    Arena saved = file->load->scratch;
    for (const GltfValue *s = tree_items(animation, "samplers"); s; s = tree_next(s)) {
        check_times(file, s);
        file->load->scratch = saved;
    }
    for (const GltfValue *c = tree_items(animation, "channels"); c; c = tree_next(c)) {
        check_turns(file, animation, c);
        file->load->scratch = saved;
    }
}

/* An instance whose rotation is no unit quaternion is an error: its place is not guessed. */
static void check_instances(GltfFile *file, const GltfValue *node) {
    const GltfValue *turns = tree_member(
        tree_member(tree_extension(node, INSTANCING_EXTENSION), "attributes"), "ROTATION");
    int id = tree_whole(turns, NO_ID);
    const GltfAccessor *accessor = accessor_get(file, id);
    if (!accessor || accessor->component_count != 4 || !accessor_has_bytes(file, accessor)) return;
    const float *q = accessor_floats(file, id);
    for (size_t i = 0; i < accessor->count; i++, q += 4)
        if (!is_unit(q)) {
            file_error(file, turns,
                       "the turn of instance %zu is (%g, %g, %g, %g); a quaternion of length "
                       "1 is required",
                       i, (double)q[0], (double)q[1], (double)q[2], (double)q[3]);
            return;
        }
}

static void check_turns_and_times(GltfFile *file) {
    const GltfValue *root = file->root;
    Arena saved = file->load->scratch;
    for (const GltfValue *a = tree_items(root, "animations"); a; a = tree_next(a))
        check_animation_data(file, a);
    for (const GltfValue *node = tree_items(root, "nodes"); node; node = tree_next(node)) {
        check_instances(file, node);
        file->load->scratch = saved;
    }
}

static void check_accessors(GltfFile *file) {
    double total = 0;
    for (int i = 0; i < file->data.accessor_count; i++)
        total += accessor_numbers(accessor_get(file, i));
    load_progress_begin(file->load, "check", "numbers", total);
    for (int i = 0; i < file->data.accessor_count; i++) {
        Arena saved = file->load->scratch;
        check_one(file, i);
        file->load->scratch = saved;
        load_progress_add(file->load, accessor_numbers(accessor_get(file, i)));
    }
    load_progress_end(file->load);
}

void check_data(GltfFile *file) {
    check_accessors(file);
    load_progress_begin(file->load, "check", "meshes", tree_count(file->root, "meshes"));
    check_primitives(file);
    load_progress_end(file->load);
    check_skinned_nodes(file);
    check_turns_and_times(file);
}
