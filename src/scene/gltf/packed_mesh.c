/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/packed_mesh.h"

#include <string.h>

#include "draco/draco_mesh.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"

typedef struct Unpacking {
    GltfFile      *file;
    GltfBufferView *views;    /* file->data's, then one an accessor */
    GltfAccessor  *accessors; /* file->data's */
    FileBytes     *bytes;     /* file->views */
    DracoMesh    **meshes;    /* one a buffer view: several primitives may read it */
    int            view_count;
} Unpacking;

static bool is_unpacked(const Unpacking *work, int accessor)
{
    return work->accessors[accessor].buffer_view >= work->view_count;
}

/* The accessor reads these bytes from now on, `count` elements without gaps. */
static void give_bytes(Unpacking *work, int id, void *bytes, size_t count)
{
    GltfAccessor *accessor = &work->accessors[id];
    accessor->buffer_view = work->view_count + id;
    accessor->offset = 0;
    accessor->count = count;
    accessor->sparse_count = 0;
    work->bytes[accessor->buffer_view] =
        (FileBytes){bytes, count * accessor_element_size(accessor)};
}

static bool is_strip(const GltfValue *primitive)
{
    return tree_int(primitive, "mode", 4) == 5;
}

/* As many triangles as the indices are made for. */
static size_t triangle_count(const Unpacking *work, const GltfValue *primitive)
{
    size_t corners = work->accessors[tree_int(primitive, "indices", 0)].count;
    return is_strip(primitive) ? corners : corners / 3;
}

static int attribute_of(const GltfValue *primitive, const char *name)
{
    return tree_int(tree_member(primitive, "attributes"), name, NO_ID);
}

/* The mesh of the primitive's packed bytes; NULL, and reported: there is none. */
static DracoMesh *decode(Unpacking *work, const GltfValue *primitive, const GltfValue *packed)
{
    Error err;
    int view = tree_int(packed, "bufferView", 0);
    FileBytes bytes = work->bytes[view];
    size_t vertices = work->accessors[attribute_of(primitive, "POSITION")].count;
    if (work->meshes[view]) return work->meshes[view];
    if (!bytes.data)
        file_error(work->file, packed,
                   "the packed bytes are missing: their buffer is not there");
    else if (!draco_mesh_decode(bytes.data, bytes.size, triangle_count(work, primitive),
                                vertices, &work->meshes[view], &err))
        file_error(work->file, packed, "%s", err.text);
    return work->meshes[view];
}

/* A strip's accessor counts otherwise; the corners are those of triangles all the same. */
static bool unpack_corners(Unpacking *work, const GltfValue *primitive, const DracoMesh *mesh)
{
    Error err;
    int id = tree_int(primitive, "indices", 0);
    size_t count = 3 * draco_mesh_triangles(mesh);
    GltfAccessor *indices = &work->accessors[id];
    if (is_unpacked(work, id)) return true;
    if (indices->count != count && !is_strip(primitive))
        return file_error(work->file, tree_member(primitive, "indices"),
                          "has %zu indices, the packed mesh has %zu", indices->count, count);
    uint32_t *corners = ARENA_NEW(&work->file->load->scratch, uint32_t, count);
    indices->component_type = 5125;
    give_bytes(work, id, corners, count);
    return draco_mesh_corners(mesh, corners, &err) ||
           file_error(work->file, primitive, "%s", err.text);
}

static bool unpack_attribute(Unpacking *work, const GltfValue *primitive,
                             const DracoMesh *mesh, const GltfValue *packed)
{
    Error err;
    int id = attribute_of(primitive, packed->key);
    const GltfAccessor *accessor = &work->accessors[id];
    size_t count = draco_mesh_vertices(mesh);
    if (is_unpacked(work, id)) return true;
    if (accessor->count != count || accessor->matrix_rows || !accessor->component_count)
        return file_error(work->file,
                          tree_member(tree_member(primitive, "attributes"), packed->key),
                          "has %zu elements, the packed mesh has %zu vertices",
                          accessor->count, count);
    void *values = arena_alloc(&work->file->load->scratch, accessor_element_size(accessor), 16,
                               count);
    if (!draco_mesh_values(mesh, (uint32_t)packed->number, accessor->component_type,
                           accessor->component_count, values, &err))
        return file_error(work->file, packed, "%s", err.text);
    give_bytes(work, id, values, count);
    return true;
}

static void unpack_primitive(Unpacking *work, const GltfValue *primitive)
{
    const GltfValue *packed = tree_extension(primitive, DRACO_EXTENSION);
    const GltfValue *attributes = tree_member(packed, "attributes");
    if (!packed) return;
    const DracoMesh *mesh = decode(work, primitive, packed);
    if (!mesh || !unpack_corners(work, primitive, mesh)) return;
    for (int i = 0; i < attributes->count; i++)
        if (!unpack_attribute(work, primitive, mesh, &attributes->items[i])) return;
}

static Unpacking begin(GltfFile *file)
{
    Arena *scratch = &file->load->scratch;
    GltfData *data = &file->data;
    int count = data->view_count + data->accessor_count;
    Unpacking work = {.file = file,
                      .views = ARENA_NEW(scratch, GltfBufferView, count),
                      .accessors = ARENA_NEW(scratch, GltfAccessor, data->accessor_count),
                      .bytes = ARENA_NEW(scratch, FileBytes, count),
                      .meshes = ARENA_NEW(scratch, DracoMesh *, data->view_count),
                      .view_count = data->view_count};
    size_t accessors = sizeof *data->accessors * (size_t)data->accessor_count;
    if (data->view_count) {
        memcpy(work.views, data->views, sizeof *data->views * (size_t)data->view_count);
        memcpy(work.bytes, file->views, sizeof *file->views * (size_t)data->view_count);
    }
    if (accessors) memcpy(work.accessors, data->accessors, accessors);
    data->views = work.views;
    data->accessors = work.accessors;
    data->view_count = count;
    file->views = work.bytes;
    return work;
}

/* A document may not take much memory for zeros: the check leaves that open where accessors
 * without a view may be packed. */
static void check_empty(const Unpacking *work)
{
    const GltfValue *accessors = tree_member(work->file->root, "accessors");
    for (int i = 0; i < work->file->data.accessor_count; i++)
        if (work->accessors[i].buffer_view < 0 &&
            work->accessors[i].count > LOAD_MAX_EMPTY_ELEMENTS)
            file_error(work->file, &accessors->items[i],
                       "has %zu elements without a buffer view; at most %zu such elements are "
                       "allowed", work->accessors[i].count, LOAD_MAX_EMPTY_ELEMENTS);
}

void packed_meshes_build(GltfFile *file)
{
    if (!document_uses(file, DRACO_EXTENSION)) return;
    Unpacking work = begin(file);
    for (const GltfValue *m = tree_items(file->root, "meshes"); m; m = tree_next(m))
        for (const GltfValue *p = tree_items(m, "primitives"); p; p = tree_next(p))
            unpack_primitive(&work, p);
    for (int i = 0; i < work.view_count; i++) draco_mesh_destroy(work.meshes[i]);
    check_empty(&work);
}
