/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/packed_mesh.h"

#include <string.h>

#include "draco/draco_mesh.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"

/* Vertices or triangles in a packed byte: those of usual meshes are below 2. */
#define USUAL_A_BYTE 16
#define MOST_A_BYTE 256

typedef struct Unpacking {
    GltfFile *file;
    GltfBufferView *views;   /* file->data's, then one an accessor */
    GltfAccessor *accessors; /* file->data's */
    FileBytes *bytes;        /* file->views */
    bool *is_changed;        /* one an accessor: it has another count than it says */
    DracoMesh **meshes;      /* one a buffer view: several primitives may read it */
    int view_count;
} Unpacking;

static bool is_unpacked(const Unpacking *work, int accessor) {
    return work->accessors[accessor].buffer_view >= work->view_count;
}

/* The accessor reads these bytes from now on, `count` elements without gaps. */
static void *give_bytes(Unpacking *work, int id, size_t count) {
    GltfAccessor *accessor = &work->accessors[id];
    size_t size = accessor_element_size(accessor);
    void *bytes = arena_alloc(&work->file->load->scratch, size, 16, count);
    accessor->buffer_view = work->view_count + id;
    accessor->offset = 0;
    work->is_changed[id] = accessor->count != count;
    accessor->count = count;
    accessor->sparse_count = 0;
    work->bytes[accessor->buffer_view] = (FileBytes){bytes, size * count};
    return bytes;
}

static bool is_strip(const GltfValue *primitive) {
    return tree_int(primitive, "mode", 4) == 5;
}

/* As many triangles as the indices are made for. */
static size_t triangle_count(const Unpacking *work, const GltfValue *primitive) {
    size_t corners = work->accessors[tree_int(primitive, "indices", 0)].count;
    return is_strip(primitive) ? corners : corners / 3;
}

static int attribute_of(const GltfValue *primitive, const char *name) {
    return tree_int(tree_member(primitive, "attributes"), name, NO_ID);
}

/* The accessors' counts are often those from before the packing: the packed mesh is whole, and
 * counts. It may hold twice as much as they say, or what many bytes can hold; a few bytes that
 * claim millions are not unpacked. */
static size_t most_of(size_t stated, size_t bytes) {
    size_t most = 2 * stated > USUAL_A_BYTE * bytes ? 2 * stated : USUAL_A_BYTE * bytes;
    size_t ceiling = MOST_A_BYTE * bytes;
    if (ceiling < LOAD_MAX_EMPTY_ELEMENTS) ceiling = LOAD_MAX_EMPTY_ELEMENTS;
    if (ceiling > LOAD_MAX_ELEMENTS / 3) ceiling = LOAD_MAX_ELEMENTS / 3;
    return most < ceiling ? most : ceiling;
}

static size_t vertex_count(const Unpacking *work, const GltfValue *primitive) {
    return work->accessors[attribute_of(primitive, "POSITION")].count;
}

/* Of a strip the accessor counts otherwise. */
static void compare_counts(const Unpacking *work, const GltfValue *primitive,
                           const GltfValue *packed, const DracoMesh *mesh) {
    size_t vertices = vertex_count(work, primitive), own = draco_mesh_vertices(mesh);
    size_t corners = work->accessors[tree_int(primitive, "indices", 0)].count;
    size_t own_corners = 3 * draco_mesh_triangles(mesh);
    if (vertices != own || (corners != own_corners && !is_strip(primitive)))
        file_warning(work->file, packed,
                     "the accessors have %zu vertices and %zu indices, the packed mesh has %zu "
                     "and %zu: the packed mesh is shown",
                     vertices, corners, own, own_corners);
}

/* The mesh of the primitive's packed bytes; NULL, and reported: there is none. */
static DracoMesh *decode(Unpacking *work, const GltfValue *primitive, const GltfValue *packed) {
    Error err;
    int view = tree_int(packed, "bufferView", 0);
    FileBytes bytes = work->bytes[view];
    size_t triangles = most_of(triangle_count(work, primitive), bytes.size);
    size_t vertices = most_of(vertex_count(work, primitive), bytes.size);
    if (work->meshes[view]) return work->meshes[view];
    if (!bytes.data)
        file_error(work->file, packed, "the packed bytes are missing: their buffer is not there");
    else if (!draco_mesh_decode(bytes.data, bytes.size, triangles, vertices, &work->meshes[view],
                                &err))
        file_error(work->file, packed, "%s", err.text);
    return work->meshes[view];
}

/* A strip's corners are those of triangles all the same. */
static bool unpack_corners(Unpacking *work, const GltfValue *primitive, const DracoMesh *mesh) {
    Error err;
    int id = tree_int(primitive, "indices", 0);
    if (is_unpacked(work, id)) return true;
    work->accessors[id].component_type = 5125;
    return draco_mesh_corners(mesh, give_bytes(work, id, 3 * draco_mesh_triangles(mesh)), &err) ||
           file_error(work->file, primitive, "%s", err.text);
}

static bool unpack_attribute(Unpacking *work, const GltfValue *primitive, const DracoMesh *mesh,
                             const GltfValue *packed) {
    Error err;
    int id = attribute_of(primitive, packed->key);
    const GltfAccessor *accessor = &work->accessors[id];
    if (is_unpacked(work, id)) return true;
    if (accessor->matrix_rows || !accessor->component_count)
        return file_error(work->file,
                          tree_member(tree_member(primitive, "attributes"), packed->key),
                          "is made of matrices, which no packed mesh has");
    return draco_mesh_values(mesh, (uint32_t)packed->number, accessor->component_type,
                             accessor->component_count,
                             give_bytes(work, id, draco_mesh_vertices(mesh)), &err) ||
           file_error(work->file, packed, "%s; the accessor's component type is %s", err.text,
                      component_name(accessor->component_type));
}

static void unpack_primitive(Unpacking *work, const GltfValue *primitive) {
    const GltfValue *packed = tree_extension(primitive, DRACO_EXTENSION);
    const GltfValue *attributes = tree_member(packed, "attributes");
    if (!packed) return;
    const DracoMesh *mesh = decode(work, primitive, packed);
    if (!mesh) return;
    compare_counts(work, primitive, packed, mesh);
    if (!unpack_corners(work, primitive, mesh)) return;
    for (int i = 0; i < attributes->count; i++)
        if (!unpack_attribute(work, primitive, mesh, &attributes->items[i])) return;
}

/* A part of the work, for each primitive. */
static void each_primitive(Unpacking *work,
                           void (*part)(Unpacking *work, const GltfValue *primitive)) {
    for (const GltfValue *m = tree_items(work->file->root, "meshes"); m; m = tree_next(m))
        for (const GltfValue *p = tree_items(m, "primitives"); p; p = tree_next(p)) part(work, p);
}

/* What else a primitive has is one a vertex of what is packed. */
static void check_counts(const Unpacking *work, const GltfValue *list, size_t count) {
    for (int i = 0; list && i < list->count; i++) {
        size_t own = work->accessors[tree_whole(&list->items[i], 0)].count;
        if (own != count)
            file_error(work->file, &list->items[i],
                       "%.60s has %zu elements, the packed mesh has %zu vertices",
                       list->items[i].key, own, count);
    }
}

static void check_primitive(Unpacking *work, const GltfValue *primitive) {
    int id = attribute_of(primitive, "POSITION");
    if (id == NO_ID) return;
    check_counts(work, tree_member(primitive, "attributes"), work->accessors[id].count);
    for (const GltfValue *t = tree_items(primitive, "targets"); t; t = tree_next(t))
        check_counts(work, t, work->accessors[id].count);
}

static void check_reader(const Unpacking *work, const GltfValue *at) {
    if (at && work->is_changed[tree_whole(at, 0)])
        file_error(work->file, at,
                   "is read as part of a packed mesh too, which has another "
                   "number of elements");
}

/* What is no primitive's counts on what the accessors say. */
static void check_readers(const Unpacking *work) {
    const GltfValue *root = work->file->root;
    for (const GltfValue *a = tree_items(root, "animations"); a; a = tree_next(a))
        for (const GltfValue *s = tree_items(a, "samplers"); s; s = tree_next(s)) {
            check_reader(work, tree_member(s, "input"));
            check_reader(work, tree_member(s, "output"));
        }
    for (const GltfValue *n = tree_items(root, "nodes"); n; n = tree_next(n)) {
        const GltfValue *places =
            tree_member(tree_extension(n, INSTANCING_EXTENSION), "attributes");
        for (int i = 0; places && i < places->count; i++) check_reader(work, &places->items[i]);
    }
}

static void check_sharers(Unpacking *work) {
    each_primitive(work, check_primitive);
    check_readers(work);
}

static Unpacking begin(GltfFile *file) {
    Arena *scratch = &file->load->scratch;
    GltfData *data = &file->data;
    int count = data->view_count + data->accessor_count;
    Unpacking work = {.file = file,
                      .views = ARENA_NEW(scratch, GltfBufferView, count),
                      .accessors = ARENA_NEW(scratch, GltfAccessor, data->accessor_count),
                      .bytes = ARENA_NEW(scratch, FileBytes, count),
                      .is_changed = ARENA_NEW(scratch, bool, data->accessor_count),
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
static void check_empty(const Unpacking *work) {
    const GltfValue *accessors = tree_member(work->file->root, "accessors");
    for (int i = 0; i < work->file->data.accessor_count; i++)
        if (work->accessors[i].buffer_view < 0 &&
            work->accessors[i].count > LOAD_MAX_EMPTY_ELEMENTS)
            file_error(work->file, &accessors->items[i],
                       "has %zu elements without a buffer view; at most %zu such elements are "
                       "allowed",
                       work->accessors[i].count, LOAD_MAX_EMPTY_ELEMENTS);
}

void packed_meshes_build(GltfFile *file) {
    if (!document_uses(file, DRACO_EXTENSION)) return;
    Unpacking work = begin(file);
    int errors = file->load->problems->error_count;
    each_primitive(&work, unpack_primitive);
    if (file->load->problems->error_count == errors) check_sharers(&work);
    for (int i = 0; i < work.view_count; i++) draco_mesh_destroy(work.meshes[i]);
    check_empty(&work);
}
