/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/instances.h"

#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"
#include "scene/load/node_transform.h"

/* One of the attributes, or NULL: the default for all. */
static bool read_attribute(GltfFile *file, const GltfValue *attributes, const char *name,
                           const float **out, int *count)
{
    const GltfValue *at = tree_member(attributes, name);
    int id = tree_whole(at, NO_ID);
    const GltfAccessor *accessor = accessor_get(file, id);
    *out = NULL;
    if (!accessor) return true;
    if (!accessor_has_bytes(file, accessor)) {
        file_error(file, at, "the bytes of %s are missing: their buffer is not there", name);
        return false;
    }
    *out = accessor_floats(file, id);
    *count = (int)accessor->count;
    return true;
}

Instances instances_of(GltfFile *file, const GltfValue *node, const Transform *world)
{
    static const float ORIGIN[3] = {0, 0, 0}, UPRIGHT[4] = {0, 0, 0, 1}, SAME[3] = {1, 1, 1};
    Arena *scratch = &file->load->scratch;
    Instances out = {ARENA_NEW(scratch, Transform, 1), 1};
    const GltfValue *attributes =
        tree_member(tree_extension(node, INSTANCING_EXTENSION), "attributes");
    const float *moves, *turns, *scales;
    out.world_from_mesh[0] = *world;
    if (!attributes) return out;
    out.count = 0;
    if (!read_attribute(file, attributes, "TRANSLATION", &moves, &out.count) ||
        !read_attribute(file, attributes, "ROTATION", &turns, &out.count) ||
        !read_attribute(file, attributes, "SCALE", &scales, &out.count))
        return (Instances){NULL, 0};
    out.world_from_mesh = ARENA_NEW(scratch, Transform, out.count);
    for (int i = 0; i < out.count; i++) {
        Transform own = transform_from_trs(moves ? moves + 3 * i : ORIGIN,
                                           turns ? turns + 4 * i : UPRIGHT,
                                           scales ? scales + 3 * i : SAME);
        out.world_from_mesh[i] = transform_compose(world, &own);
    }
    return out;
}
