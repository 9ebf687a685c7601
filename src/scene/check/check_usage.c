/* SPDX-License-Identifier: Apache-2.0 */
/* glTF 2.0, 3.6.1: what stands in a buffer view is of one kind: vertices, indices, pictures,
 * light profiles, matrices or key frames, and an accessor is read in one way. Nothing here
 * depends on it, so that a fault only warns. */
#include "scene/check/check_usage.h"

#include <string.h>

static const char VERTICES[] = "vertices", INDICES[] = "indices", PICTURE[] = "a picture",
                  PROFILE[] = "a light profile",
                  MATRICES[] = "inverse bind matrices", TIMES[] = "times of an animation",
                  VALUES[] = "values of an animation", SPARSE[] = "sparse values";

/* The use of each accessor and each buffer view; NULL: not used yet. */
typedef struct Usage {
    const DocumentCheck *check;
    const GltfValue *accessors, *views; /* NULL: the document has none */
    const char **accessor_use, **view_use;
    int *vertex_accessor; /* the first that a view's vertices belong to, plus one */
    bool *is_shared;      /* reported already */
} Usage;

/* One view may hold the times and the values of an animation. */
static const char *kind_of_bytes(const char *use)
{
    return use == TIMES || use == VALUES ? "key frames" : use;
}

static void use_view(Usage *usage, const GltfValue *at, int view, const char *use)
{
    const GltfValue *value = tree_item(usage->views, view);
    if (!value) return;
    const char *before = usage->view_use[view];
    int target = tree_int(value, "target", 0);
    if (!before && target == 34962) before = VERTICES;
    if (!before && target == 34963) before = INDICES;
    if (!before) usage->view_use[view] = use;
    if (!before || strcmp(before, use) == 0) return;
    check_warns(usage->check, at, "%s stand%s in a buffer view for %s (/bufferViews/%d)", use,
                use == PICTURE || use == PROFILE ? "s" : "", before, view);
    usage->view_use[view] = use; /* reported once */
}

/* Interleaved attributes need a stride. */
static void share_view(Usage *usage, const GltfValue *at, int view, int accessor)
{
    const GltfValue *value = tree_item(usage->views, view);
    if (!value || tree_member(value, "byteStride")) return;
    int *first = &usage->vertex_accessor[view];
    if (!*first) *first = accessor + 1;
    if (*first == accessor + 1 || usage->is_shared[view]) return;
    usage->is_shared[view] = true;
    check_warns(usage->check, at,
                "accessor %d shares a buffer view with accessor %d, which has no byteStride",
                accessor, *first - 1);
}

static void use_accessor(Usage *usage, const GltfValue *at, const char *use)
{
    int id = tree_whole(at, NO_ID);
    const GltfValue *accessor = tree_item(usage->accessors, id);
    if (!accessor) return;
    const char **before = &usage->accessor_use[id];
    if (*before && *before != use)
        check_warns(usage->check, at, "accessor %d is read as %s here and as %s elsewhere", id,
                    use, *before);
    *before = use;
    int view = tree_int(accessor, "bufferView", NO_ID);
    use_view(usage, at, view, kind_of_bytes(use));
    if (use == VERTICES) share_view(usage, at, view, id);
}

static void use_all(Usage *usage, const GltfValue *map)
{
    for (int i = 0; map && map->kind == GLTF_OBJECT && i < map->count; i++)
        use_accessor(usage, &map->items[i], VERTICES);
}

static void use_mesh(Usage *usage, const GltfValue *mesh)
{
    for (const GltfValue *p = tree_items(mesh, "primitives"); p; p = tree_next(p)) {
        use_accessor(usage, tree_member(p, "indices"), INDICES);
        use_all(usage, tree_member(p, "attributes"));
        for (const GltfValue *t = tree_items(p, "targets"); t; t = tree_next(t))
            use_all(usage, t);
    }
}

static void use_skin(Usage *usage, const GltfValue *skin)
{
    use_accessor(usage, tree_member(skin, "inverseBindMatrices"), MATRICES);
}

static void use_animation(Usage *usage, const GltfValue *animation)
{
    for (const GltfValue *s = tree_items(animation, "samplers"); s; s = tree_next(s)) {
        use_accessor(usage, tree_member(s, "input"), TIMES);
        use_accessor(usage, tree_member(s, "output"), VALUES);
    }
}

static void use_view_of(Usage *usage, const GltfValue *object, const char *use)
{
    const GltfValue *view = tree_member(object, "bufferView");
    if (view) use_view(usage, view, tree_whole(view, NO_ID), use);
}

static void use_image(Usage *usage, const GltfValue *image)
{
    use_view_of(usage, image, PICTURE);
}

static void use_profiles(Usage *usage, const GltfValue *root)
{
    const GltfValue *extension = tree_extension(root, "EXT_lights_ies");
    for (const GltfValue *p = tree_items(extension, "lights"); p; p = tree_next(p))
        use_view_of(usage, p, PROFILE);
}

static void use_sparse(Usage *usage, const GltfValue *accessor)
{
    static const char *const PARTS[] = {"indices", "values"};
    const GltfValue *sparse = tree_member(accessor, "sparse");
    for (int i = 0; i < 2; i++) use_view_of(usage, tree_member(sparse, PARTS[i]), SPARSE);
}

static void use_each(Usage *usage, const GltfValue *root, const char *collection,
                     void (*use)(Usage *usage, const GltfValue *item))
{
    const GltfValue *list = tree_member(root, collection);
    for (int i = 0; list && list->kind == GLTF_ARRAY && i < list->count; i++)
        use(usage, &list->items[i]);
}

void check_usage(const DocumentCheck *check, const GltfValue *root)
{
    Arena scratch = check->file->load->scratch;
    int accessors = tree_count(root, "accessors"), views = tree_count(root, "bufferViews");
    Usage usage = {.check = check,
                   .accessors = tree_member(root, "accessors"),
                   .views = tree_member(root, "bufferViews"),
                   .accessor_use = ARENA_NEW(&scratch, const char *, accessors),
                   .view_use = ARENA_NEW(&scratch, const char *, views),
                   .vertex_accessor = ARENA_NEW(&scratch, int, views),
                   .is_shared = ARENA_NEW(&scratch, bool, views)};
    use_each(&usage, root, "meshes", use_mesh);
    use_each(&usage, root, "skins", use_skin);
    use_each(&usage, root, "animations", use_animation);
    use_each(&usage, root, "images", use_image);
    use_profiles(&usage, root);
    use_each(&usage, root, "accessors", use_sparse);
}
