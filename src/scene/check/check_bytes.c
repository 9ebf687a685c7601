/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_bytes.h"

#include <string.h>

#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"

/* Numbers here are below 2^53 each, by the tables, so that sums of doubles are exact. */

void check_place_in_buffer(const DocumentCheck *check, const GltfValue *view) {
    const GltfValue *buffer = tree_referred(tree_member(view, "buffer"), "buffers");
    double offset = tree_number(view, "byteOffset", 0);
    double length = tree_number(view, "byteLength", 0);
    double whole = tree_number(buffer, "byteLength", -1);
    if (buffer && whole >= 0 && offset + length > whole)
        check_fails(check, view, "takes bytes %.15g to %.15g of a buffer of %.15g bytes", offset,
                    offset + length, whole);
}

void check_buffer_view(const DocumentCheck *check, const GltfValue *view) {
    const GltfValue *buffer = tree_referred(tree_member(view, "buffer"), "buffers");
    check_place_in_buffer(check, view);
    bool has_chunk = buffer && buffer->index == 0 && check->file->bin.data;
    bool is_packed = tree_extension(view, MESHOPT_EXTENSION) != NULL;
    if (buffer && !tree_member(buffer, "uri") && !has_chunk && !check->file->is_binary &&
        !is_packed)
        check_warns(check, view, "its buffer has no \"uri\", so there are no bytes to read");
    double stride = tree_number(view, "byteStride", 4);
    if (fmod(stride, 4) != 0)
        check_fails(check, tree_member(view, "byteStride"), "is %g, a multiple of 4 is required",
                    stride);
}

static int components_of(const char *type) {
    static const char *const NAMES[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
    static const int COUNTS[] = {1, 2, 3, 4, 4, 9, 16};
    for (int i = 0; i < 7; i++)
        if (strcmp(NAMES[i], type) == 0) return COUNTS[i];
    return 0;
}

/* Bytes from one tight element to the next, and of the last one. */
static bool element_size(const GltfValue *accessor, double *size, double *extent) {
    const char *type = tree_text(accessor, "type", "");
    GltfAccessor a = {.component_type = tree_int(accessor, "componentType", 0),
                      .component_count = components_of(type),
                      .matrix_rows = strncmp(type, "MAT", 3) == 0 ? type[3] - '0' : 0};
    if (!a.component_count || !component_size(a.component_type)) return false;
    *size = (double)accessor_element_size(&a);
    *extent = (double)accessor_element_extent(&a);
    return true;
}

/* A run of `count` elements in a view, all the way to the last byte. */
typedef struct ByteRun {
    const GltfValue *at; /* what to point at */
    const GltfValue *view;
    double offset, count, extent, stride, align;
} ByteRun;

static void check_run(const DocumentCheck *check, const ByteRun *run) {
    double length = tree_number(run->view, "byteLength", 0);
    double end = run->offset + run->stride * (run->count - 1) + run->extent;
    double start = tree_number(run->view, "byteOffset", 0) + run->offset;
    if (end > length)
        check_fails(check, run->at, "needs bytes %.15g to %.15g of a buffer view of %.15g bytes",
                    run->offset, end, length);
    if (fmod(start, run->align) != 0)
        check_fails(check, run->at,
                    "starts at byte %.0f of the buffer, a multiple of %.0f is "
                    "required",
                    start, run->align);
}

/* run: count, extent, stride and align are set. */
static void check_sparse_part(const DocumentCheck *check, const GltfValue *part, ByteRun run) {
    const GltfValue *view = tree_referred(tree_member(part, "bufferView"), "bufferViews");
    if (!view || !run.stride) return;
    run.at = part;
    run.view = view;
    run.offset = tree_number(part, "byteOffset", 0);
    check_run(check, &run);
}

static void check_sparse(const DocumentCheck *check, const GltfValue *accessor, ByteRun run) {
    const GltfValue *sparse = tree_member(accessor, "sparse");
    const GltfValue *indices = tree_member(sparse, "indices");
    double count = tree_number(sparse, "count", 0), whole = tree_number(accessor, "count", 0);
    double index_size = (double)component_size(tree_int(indices, "componentType", 0));
    if (!sparse) return;
    if (count > whole)
        check_fails(check, tree_member(sparse, "count"), "is %.0f, the accessor has %.0f elements",
                    count, whole);
    run.count = count;
    check_sparse_part(check, tree_member(sparse, "values"), run);
    run.extent = run.stride = run.align = index_size;
    check_sparse_part(check, indices, run);
}

/* Then accessors without a view may hold what is unpacked: gltf/packed_mesh.c checks. */
static bool has_packed_meshes(const DocumentCheck *check) {
    return document_uses(check->file, DRACO_EXTENSION);
}

static void check_in_view(const DocumentCheck *check, const GltfValue *accessor, ByteRun run) {
    const GltfValue *view = tree_referred(tree_member(accessor, "bufferView"), "bufferViews");
    double count = tree_number(accessor, "count", 1), size = run.stride;
    double stride = tree_number(view, "byteStride", size);
    if (!view && !tree_member(accessor, "bufferView") && !has_packed_meshes(check) &&
        count > (double)LOAD_MAX_EMPTY_ELEMENTS)
        check_fails(check, tree_member(accessor, "count"),
                    "is %.0f without a buffer view; at most "
                    "%zu such elements are allowed",
                    count, LOAD_MAX_EMPTY_ELEMENTS);
    if (!view) return;
    if (stride < size)
        check_fails(check, accessor,
                    "has elements of %.0f bytes in a buffer view whose byteStride "
                    "is %.0f",
                    size, stride);
    run = (ByteRun){accessor, view,     tree_number(accessor, "byteOffset", 0), count, run.extent,
                    stride,   run.align};
    check_run(check, &run);
}

void check_accessor(const DocumentCheck *check, const GltfValue *accessor) {
    ByteRun run = {.align = (double)component_size(tree_int(accessor, "componentType", 0))};
    if (!element_size(accessor, &run.stride, &run.extent)) return; /* reported by the table */
    check_in_view(check, accessor, run);
    check_sparse(check, accessor, run);
}
