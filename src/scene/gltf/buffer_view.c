/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/buffer_view.h"

#include <meshoptimizer.h>
#include <string.h>

#include "scene/gltf/document.h"

/* A packed byte holds at most as many: vertices have two bits for sixteen bytes that do not
 * change, indices a byte for each of them or for a triangle. So a small file cannot require
 * much memory. */
#define MOST_UNPACKED 64

/* Packed bytes, and the elements that they hold. */
typedef struct Packed {
    FileBytes bytes;
    size_t count, stride;
} Packed;

static bool find_packed(GltfFile *file, const GltfValue *at, Packed *out) {
    FileBytes buffer = file->buffers[tree_int(at, "buffer", 0)];
    size_t offset = (size_t)tree_number(at, "byteOffset", 0);
    *out = (Packed){.count = (size_t)tree_number(at, "count", 0),
                    .stride = (size_t)tree_number(at, "byteStride", 0)};
    if (!buffer.data)
        return file_error(file, at, "the packed bytes are missing: their buffer is not there");
    out->bytes = (FileBytes){buffer.data + offset, (size_t)tree_number(at, "byteLength", 0)};
    return out->count * out->stride / MOST_UNPACKED <= out->bytes.size ||
           file_error(file, at, "%zu packed bytes are too few for %zu elements of %zu bytes",
                      out->bytes.size, out->count, out->stride);
}

static bool unpack(const Packed *packed, const char *mode, void *out) {
    const unsigned char *bytes = packed->bytes.data;
    size_t size = packed->bytes.size, count = packed->count, stride = packed->stride;
    if (strcmp(mode, "TRIANGLES") == 0)
        return meshopt_decodeIndexBuffer(out, count, stride, bytes, size) == 0;
    if (strcmp(mode, "INDICES") == 0)
        return meshopt_decodeIndexSequence(out, count, stride, bytes, size) == 0;
    return meshopt_decodeVertexBuffer(out, count, stride, bytes, size) == 0;
}

static void filter(const Packed *packed, const char *name, void *out) {
    if (strcmp(name, "OCTAHEDRAL") == 0)
        meshopt_decodeFilterOct(out, packed->count, packed->stride);
    else if (strcmp(name, "QUATERNION") == 0)
        meshopt_decodeFilterQuat(out, packed->count, packed->stride);
    else if (strcmp(name, "EXPONENTIAL") == 0)
        meshopt_decodeFilterExp(out, packed->count, packed->stride);
}

static FileBytes unpack_view(GltfFile *file, const GltfValue *at) {
    Packed packed;
    const char *mode = tree_text(at, "mode", "");
    if (!find_packed(file, at, &packed)) return (FileBytes){0};
    size_t size = packed.count * packed.stride;
    unsigned char *out = arena_alloc(&file->load->scratch, 1, 64, size);
    if (!unpack(&packed, mode, out)) {
        file_error(file, at, "the packed bytes are no %zu elements of the mode %s", packed.count,
                   mode);
        return (FileBytes){0};
    }
    filter(&packed, tree_text(at, "filter", "NONE"), out);
    return (FileBytes){out, size};
}

static FileBytes plain_view(const GltfFile *file, const GltfBufferView *view) {
    FileBytes bytes = file->buffers[view->buffer];
    return bytes.data ? (FileBytes){bytes.data + view->offset, view->length} : bytes;
}

void buffer_views_build(GltfFile *file) {
    const GltfValue *views = tree_member(file->root, "bufferViews");
    file->views = ARENA_NEW(&file->load->scratch, FileBytes, file->data.view_count);
    for (int i = 0; i < file->data.view_count; i++) {
        const GltfValue *packed = tree_extension(tree_item(views, i), MESHOPT_EXTENSION);
        file->views[i] =
            packed ? unpack_view(file, packed) : plain_view(file, &file->data.views[i]);
    }
}
