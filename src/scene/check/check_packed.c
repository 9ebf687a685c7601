/* SPDX-License-Identifier: Apache-2.0 */
/* Packed bytes: an unpacker is handed nothing that does not fit. */
#include "scene/check/check_packed.h"

#include <string.h>

#include "base/count.h"
#include "scene/gltf/document.h"

#define BIG 9007199254740992.0 /* 2^53: what a double counts exactly */

/* ---- EXT_meshopt_compression (the list under "JSON schema updates") ---------------------- */

static void check_place(const DocumentCheck *check, const GltfValue *packed)
{
    const GltfValue *buffer =
        tree_element(check->file->root, "buffers", tree_int(packed, "buffer", NO_ID));
    double offset = tree_number(packed, "byteOffset", 0);
    double length = tree_number(packed, "byteLength", 0);
    double whole = tree_number(buffer, "byteLength", -1);
    if (buffer && whole >= 0 && offset + length > whole)
        check_fails(check, packed, "takes bytes %.15g to %.15g of a buffer of %.15g bytes",
                    offset, offset + length, whole);
}

static void check_stride(const DocumentCheck *check, const GltfValue *packed, double stride)
{
    const GltfValue *at = tree_member(packed, "byteStride");
    const char *mode = tree_text(packed, "mode", ""), *filter = tree_text(packed, "filter", "");
    bool is_vertices = strcmp(mode, "ATTRIBUTES") == 0;
    if (is_vertices && fmod(stride, 4) != 0)
        check_fails(check, at, "is %g, with ATTRIBUTES a multiple of 4 is wanted", stride);
    if (!is_vertices && stride != 2 && stride != 4)
        check_fails(check, at, "is %g, with %.20s 2 or 4 is wanted", stride, mode);
    if (strcmp(filter, "OCTAHEDRAL") == 0 && stride != 4 && stride != 8)
        check_fails(check, at, "is %g, with OCTAHEDRAL 4 or 8 is wanted", stride);
    if (strcmp(filter, "QUATERNION") == 0 && stride != 8)
        check_fails(check, at, "is %g, with QUATERNION 8 is wanted", stride);
}

static void check_meshopt(const DocumentCheck *check, const GltfValue *packed)
{
    const GltfValue *view = packed->parent->parent, *filter = tree_member(packed, "filter");
    const char *mode = tree_text(packed, "mode", "");
    double count = tree_number(packed, "count", 0);
    double stride = tree_number(packed, "byteStride", 0);
    double length = tree_number(view, "byteLength", count * stride);
    double own = tree_number(view, "byteStride", stride);
    check_place(check, packed);
    check_stride(check, packed, stride);
    if (own != stride)
        check_fails(check, packed, "unpacks to a byteStride of %g, the buffer view has %g",
                    stride, own);
    if (length != count * stride)
        check_fails(check, packed, "unpacks to %.15g bytes, the buffer view has %.15g",
                    count * stride, length);
    if (strcmp(mode, "TRIANGLES") == 0 && fmod(count, 3) != 0)
        check_fails(check, tree_member(packed, "count"),
                    "is %.15g, with TRIANGLES a multiple of 3 is wanted", count);
    if (filter && strcmp(mode, "ATTRIBUTES") != 0 && strcmp(filter->text, "NONE") != 0)
        check_fails(check, filter, "is \"%.20s\", with %.20s only NONE is wanted",
                    filter->text, mode);
}

static const Rule MESHOPT[] = {
    {.name = "buffer", .kind = RULE_INDEX, .flags = RULE_REQUIRED, .of = "buffers"},
    {.name = "byteOffset", .kind = RULE_INTEGER, .flags = RULE_HAS_RANGE, .max = BIG},
    {.name = "byteLength", .kind = RULE_INTEGER, .flags = RULE_REQUIRED | RULE_HAS_RANGE,
     .min = 1, .max = BIG},
    {.name = "byteStride", .kind = RULE_INTEGER, .flags = RULE_REQUIRED | RULE_HAS_RANGE,
     .min = 1, .max = 256},
    {.name = "count", .kind = RULE_INTEGER, .flags = RULE_REQUIRED | RULE_HAS_RANGE, .min = 1,
     .max = LOAD_MAX_ELEMENTS},
    {.name = "mode", .kind = RULE_CHOICE, .flags = RULE_REQUIRED | RULE_CLOSED,
     .of = "ATTRIBUTES|TRIANGLES|INDICES"},
    {.name = "filter", .kind = RULE_CHOICE, .flags = RULE_CLOSED,
     .of = "NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL"},
};
const Schema SCHEMA_MESHOPT = {MESHOPT_EXTENSION, MESHOPT, COUNT_OF(MESHOPT), false,
                               check_meshopt};
static const Rule MESHOPT_BUFFER[] = {{.name = "fallback", .kind = RULE_BOOLEAN}};
const Schema SCHEMA_MESHOPT_BUFFER = {MESHOPT_EXTENSION, MESHOPT_BUFFER,
                                      COUNT_OF(MESHOPT_BUFFER), false, NULL};

/* ---- KHR_draco_mesh_compression ---------------------------------------------------------- */

static void check_ids(const DocumentCheck *check, const GltfValue *ids, const GltfValue *own)
{
    for (int i = 0; i < ids->count; i++) {
        const GltfValue *id = &ids->items[i];
        if (!tree_is_integer(id) || id->number < 0 || id->number > 4294967295.0)
            check_fails(check, id, "the id of an attribute is wanted, 0 to 4294967295");
        if (!tree_member(own, id->key))
            check_fails(check, id, "the primitive has no %.60s", id->key);
    }
}

static void check_draco(const DocumentCheck *check, const GltfValue *packed)
{
    const GltfValue *primitive = packed->parent->parent;
    const GltfValue *ids = tree_member(packed, "attributes");
    const GltfValue *mode = tree_member(primitive, "mode");
    double code = tree_number(primitive, "mode", 4);
    if (ids && ids->kind == GLTF_OBJECT)
        check_ids(check, ids, tree_member(primitive, "attributes"));
    else if (ids)
        check_fails(check, ids, "an object of attributes is wanted");
    if (ids && !tree_member(ids, "POSITION"))
        check_fails(check, ids, "\"POSITION\" is missing");
    if (code != 4 && code != 5)
        check_fails(check, mode, "is %g, packed meshes are of mode 4 or 5", code);
    if (!tree_member(primitive, "indices"))
        check_fails(check, primitive, "\"indices\" is missing, which packed meshes have");
}

static const Rule DRACO[] = {
    {.name = "bufferView", .kind = RULE_INDEX, .flags = RULE_REQUIRED, .of = "bufferViews"},
    {.name = "attributes", .kind = RULE_ANY, .flags = RULE_REQUIRED},
};
const Schema SCHEMA_DRACO = {DRACO_EXTENSION, DRACO, COUNT_OF(DRACO), false, check_draco};
