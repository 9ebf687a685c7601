/* SPDX-License-Identifier: Apache-2.0 */
#include "mirror/mirrors_build.h"

#include "base/mathf.h"
#include "base/parallel.h"
#include "mirror/mirrors.h"

#define BEND 0.16f           /* between normals of one patch's corners, at most */
#define PATCH_CUTS 10        /* of one triangle to get there */
#define NEAR_M 1.0f          /* a mirror this large is as bad to bound as a bend of one radian */
#define WIDEST 0.2f          /* cosine between a node's axis and normals that are bounded at all */
#define BOUND_MOST 64        /* patches of a node whose normals are bounded one by one */
#define LEAVES_TOGETHER 1024 /* that a thread makes at once */

/* ---- patches ---------------------------------------------------------------------------- */

typedef struct PatchList {
    Arena *arena;
    MirrorPatch *patches;
    uint32_t count;
} PatchList;

static Vec3 edges_cross(const MirrorTriangle *t) {
    return vec3_cross(vec3_sub(t->position[1], t->position[0]),
                      vec3_sub(t->position[2], t->position[0]));
}

static MirrorPatch whole_triangle(const Scene *scene, uint32_t id) {
    const Material *material = &scene->materials[scene_part(scene, id)->material_id];
    return (MirrorPatch){.corners = mirror_triangle(scene, id),
                         .uv = {{0, 0}, {1, 0}, {0, 1}},
                         .id = id,
                         .alpha = mirrors_rough_alpha(material)};
}

static Vec3 halfway(Vec3 a, Vec3 b) {
    return vec3_scale(vec3_add(a, b), 0.5f);
}

static float squared_distance(Vec3 a, Vec3 b) {
    Vec3 d = vec3_sub(a, b);
    return vec3_dot(d, d);
}

/* The edge across which the normals differ most, from its first corner; and by how much. */
static int most_bent_edge(const MirrorTriangle *t, float *bend2) {
    int edge = 0;
    *bend2 = 0;
    for (int i = 0; i < 3; i++) {
        float here = squared_distance(t->normal[i], t->normal[(i + 1) % 3]);
        if (!(here > *bend2)) continue;
        *bend2 = here;
        edge = i;
    }
    return edge;
}

static void set_corner(MirrorPatch *patch, int i, const MirrorPatch *of, int a, int b) {
    patch->corners.position[i] = halfway(of->corners.position[a], of->corners.position[b]);
    patch->corners.normal[i] = halfway(of->corners.normal[a], of->corners.normal[b]);
    patch->uv[i] = (Vec2){0.5f * (of->uv[a].x + of->uv[b].x), 0.5f * (of->uv[a].y + of->uv[b].y)};
}

static void add_patches(PatchList *list, const MirrorPatch *patch, int cuts) {
    float bend2;
    int edge = most_bent_edge(&patch->corners, &bend2), next = (edge + 1) % 3;
    if (bend2 > BEND * BEND && cuts > 0) {
        MirrorPatch half[2] = {*patch, *patch};
        set_corner(&half[0], next, patch, edge, next);
        set_corner(&half[1], edge, patch, edge, next);
        for (int i = 0; i < 2; i++) add_patches(list, &half[i], cuts - 1);
        return;
    }
    list->patches =
        ARENA_GROW(list->arena, MirrorPatch, list->patches, list->count, list->count + 1);
    list->patches[list->count++] = *patch;
}

/* Patches of a triangle: [first[id], first[id + 1]); none where no pair has it. */
static PatchList cut_patches(const Scene *scene, const bool *is_used, uint32_t *first,
                             Arena *arena) {
    PatchList list = {.arena = arena};
    for (uint32_t id = 0; id < scene->triangle_count; id++) {
        first[id] = list.count;
        if (!is_used[id]) continue;
        MirrorPatch patch = whole_triangle(scene, id);
        Vec3 cross = edges_cross(&patch.corners);
        if (vec3_dot(cross, cross) > 0) add_patches(&list, &patch, PATCH_CUTS);
    }
    first[scene->triangle_count] = list.count;
    return list;
}

/* ---- the tree --------------------------------------------------------------------------- */

typedef struct Item {
    float key[6]; /* centre and normal, in one measure */
    uint32_t patch;
} Item;

typedef struct MirrorBounds {
    Vec3 low, high; /* of the box, m */
    Vec3 axis;      /* unit, of a cone about all normals, */
    float cosine;   /* of its half angle; below WIDEST: there is none */
} MirrorBounds;

/* What a tree's leaf is, whichever tree it stands in. */
typedef struct MirrorLeaf {
    MirrorNode node;
    MirrorBounds bounds;
    Item item;
} MirrorLeaf;

/* One tree while it is made. */
typedef struct MirrorBuilder {
    const MirrorPatch *patches;
    const Vec3 *normals;      /* unit, of the patches' three corners */
    const MirrorLeaf *leaves; /* of the patches */
    Item *items;
    MirrorNode *nodes;
    uint32_t node_count;
} MirrorBuilder;

static Item item_of(const MirrorPatch *patches, uint32_t i) {
    const MirrorTriangle *t = &patches[i].corners;
    Vec3 p = vec3_add(vec3_add(t->position[0], t->position[1]), t->position[2]);
    Vec3 n = vec3_normalize(vec3_add(vec3_add(t->normal[0], t->normal[1]), t->normal[2]));
    float per_m = 1 / (3 * NEAR_M);
    return (Item){{p.x * per_m, p.y * per_m, p.z * per_m, n.x, n.y, n.z}, i};
}

/* Not fminf: a call for the sake of NaN. */
static float lesser(float a, float b) {
    return b < a ? b : a;
}

static float greater(float a, float b) {
    return b > a ? b : a;
}

static void widen(MirrorBounds *bounds, Vec3 p) {
    Vec3 *low = &bounds->low, *high = &bounds->high;
    *low = vec3(lesser(low->x, p.x), lesser(low->y, p.y), lesser(low->z, p.z));
    *high = vec3(greater(high->x, p.x), greater(high->y, p.y), greater(high->z, p.z));
}

static MirrorBounds bounds_of(const MirrorTriangle *t) {
    MirrorBounds bounds = {.low = t->position[0], .high = t->position[0]};
    for (int k = 1; k < 3; k++) widen(&bounds, t->position[k]);
    return bounds;
}

static const Vec3 *normals_of(const MirrorBuilder *builder, uint32_t i) {
    return builder->normals + 3 * (size_t)builder->items[i].patch;
}

/* A frame about the mean normal, +x where the slopes against it spread most. False: too wide
 * to be bounded. */
static bool frame_of_normals(const MirrorBuilder *builder, uint32_t first, uint32_t count,
                             Frame *frame) {
    Vec3 sum = vec3(0, 0, 0);
    float xx = 0, xy = 0, yy = 0;
    for (uint32_t i = first; i < first + count; i++)
        for (int k = 0; k < 3; k++) sum = vec3_add(sum, normals_of(builder, i)[k]);
    if (!(vec3_length(sum) > 0)) return false;
    *frame = frame_from_z(vec3_normalize(sum));
    for (uint32_t i = first; i < first + count; i++)
        for (int k = 0; k < 3; k++) {
            Vec3 n = frame_to_local(frame, normals_of(builder, i)[k]);
            if (!(n.z > WIDEST)) return false;
            xx += n.x * n.x;
            xy += n.x * n.y;
            yy += n.y * n.y;
        }
    Vec3 long_axis = vec3(xx - yy + sqrtf((xx - yy) * (xx - yy) + 4 * xy * xy), 2 * xy, 0);
    if (!(vec3_length(long_axis) > 0)) return true;
    Vec3 x = frame_to_world(frame, vec3_normalize(long_axis));
    *frame = (Frame){x, vec3_cross(frame->z, x), frame->z};
    return true;
}

/* The greatest angle between the frame's +z and a normal, as its cosine. */
static float widest_cosine(const MirrorBuilder *builder, uint32_t first, uint32_t count, Vec3 z) {
    float cosine = 1;
    for (uint32_t i = first; i < first + count; i++)
        for (int k = 0; k < 3; k++) cosine = lesser(cosine, vec3_dot(normals_of(builder, i)[k], z));
    return cosine;
}

/* Bounds the slopes against the axis (x / z and y / z of the frame) by planes. */
static void set_planes(const Frame *frame, const float low[2], const float high[2],
                       MirrorNode *node) {
    for (int a = 0; a < 2; a++) {
        Vec3 across = a ? frame->y : frame->x;
        node->plane[2 * a] = vec3_normalize(vec3_along(across, frame->z, -high[a]));
        node->plane[2 * a + 1] = vec3_normalize(vec3_along(vec3_neg(across), frame->z, low[a]));
    }
}

/* A normal is a weighted sum of corners' normals, so planes through the origin that bound those
 * bound it: their slopes between the extremes. */
static void bound_normals(const MirrorBuilder *builder, uint32_t first, uint32_t count,
                          MirrorNode *node, MirrorBounds *bounds) {
    Frame frame;
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    bounds->cosine = -1;
    if (!frame_of_normals(builder, first, count, &frame)) return;
    for (uint32_t i = first; i < first + count; i++)
        for (int k = 0; k < 3; k++) {
            Vec3 n = frame_to_local(&frame, normals_of(builder, i)[k]);
            float slope[2] = {n.x / n.z, n.y / n.z};
            for (int a = 0; a < 2; a++) {
                low[a] = lesser(low[a], slope[a]);
                high[a] = greater(high[a], slope[a]);
            }
        }
    set_planes(&frame, low, high, node);
    bounds->axis = frame.z;
    bounds->cosine = widest_cosine(builder, first, count, frame.z);
}

/* cos(x + y), x between the axis and the cone's, y the cone's half angle; -1: too wide. */
static float cosine_about(Vec3 axis, const MirrorBounds *cone) {
    float c = clampf(vec3_dot(axis, cone->axis), -1, 1), k = clampf(cone->cosine, -1, 1);
    if (c + k <= 0) return -1; /* beyond half a turn */
    return c * k - safe_sqrtf(1 - c * c) * safe_sqrtf(1 - k * k);
}

/* A cone about two cones, and its planes; where it is too wide nothing is known. */
static void join_normals(const MirrorBounds half[2], MirrorBounds *bounds, MirrorNode *node) {
    Vec3 sum = vec3_add(half[0].axis, half[1].axis);
    bounds->cosine = -1;
    if (!(half[0].cosine > WIDEST && half[1].cosine > WIDEST && vec3_length(sum) > 0.1f)) return;
    bounds->axis = vec3_normalize(sum);
    bounds->cosine =
        lesser(cosine_about(bounds->axis, &half[0]), cosine_about(bounds->axis, &half[1])) - 1e-6f;
    if (!(bounds->cosine > WIDEST)) return;
    Frame frame = frame_from_z(bounds->axis);
    float slope = safe_sqrtf(1 - bounds->cosine * bounds->cosine) / bounds->cosine;
    set_planes(&frame, (float[2]){-slope, -slope}, (float[2]){slope, slope}, node);
}

static void set_ball(const MirrorBounds *bounds, MirrorNode *node) {
    node->centre = halfway(bounds->low, bounds->high);
    node->radius = 0.5f * vec3_length(vec3_sub(bounds->high, bounds->low));
}

static void make_leaf(const MirrorPatch *patches, const Vec3 *normals, uint32_t i,
                      MirrorLeaf *leaf) {
    leaf->item = item_of(patches, i);
    leaf->node = (MirrorNode){.patch = i, .alpha = patches[i].alpha};
    leaf->bounds = bounds_of(&patches[i].corners);
    const MirrorBuilder alone = {.patches = patches, .normals = normals, .items = &leaf->item};
    bound_normals(&alone, 0, 1, &leaf->node, &leaf->bounds);
    set_ball(&leaf->bounds, &leaf->node);
}

static bool comes_before(const Item *a, const Item *b, int axis) {
    return a->key[axis] < b->key[axis] || (a->key[axis] == b->key[axis] && a->patch < b->patch);
}

/* The key in which the items differ most. */
static int widest_axis(const Item *items, uint32_t count) {
    float widest = -1;
    int axis = 0;
    for (int a = 0; a < 6; a++) {
        float low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < count; i++) {
            low = lesser(low, items[i].key[a]);
            high = greater(high, items[i].key[a]);
        }
        if (!(high - low > widest)) continue;
        widest = high - low;
        axis = a;
    }
    return axis;
}

/* Brings the `middle` items that come first before the others (Hoare's selection). */
static void part_items(Item *items, uint32_t count, uint32_t middle, int axis) {
    int64_t low = 0, high = (int64_t)count - 1;
    while (low < high) {
        Item pivot = items[(low + high) / 2];
        int64_t i = low, k = high;
        while (i <= k) {
            while (comes_before(&items[i], &pivot, axis)) i++;
            while (comes_before(&pivot, &items[k], axis)) k--;
            if (i > k) break;
            Item moved = items[i];
            items[i++] = items[k];
            items[k--] = moved;
        }
        if ((int64_t)middle <= k) high = k;
        else if ((int64_t)middle >= i) low = i;
        else return;
    }
}

static MirrorBounds build_node(MirrorBuilder *builder, uint32_t node_id, uint32_t first,
                               uint32_t count);

static MirrorBounds build_halves(MirrorBuilder *builder, MirrorNode *node, uint32_t first,
                                 uint32_t count) {
    Item *items = builder->items + first;
    uint32_t middle = count / 2, child = builder->node_count;
    part_items(items, count, middle, widest_axis(items, count));
    node->children = child;
    builder->node_count += 2;
    MirrorBounds half[2] = {build_node(builder, child, first, middle),
                            build_node(builder, child + 1, first + middle, count - middle)};
    MirrorBounds bounds = half[0];
    widen(&bounds, half[1].low);
    widen(&bounds, half[1].high);
    if (count > BOUND_MOST) join_normals(half, &bounds, node);
    node->alpha = greater(builder->nodes[child].alpha, builder->nodes[child + 1].alpha);
    return bounds;
}

static MirrorBounds build_node(MirrorBuilder *builder, uint32_t node_id, uint32_t first,
                               uint32_t count) {
    MirrorNode *node = &builder->nodes[node_id];
    const MirrorLeaf *leaf = &builder->leaves[builder->items[first].patch];
    MirrorBounds cone = {.cosine = -1}, bounds;
    if (count == 1) {
        *node = leaf->node;
        return leaf->bounds;
    }
    if (count <= BOUND_MOST) bound_normals(builder, first, count, node, &cone);
    node->patch = leaf->node.patch;
    bounds = build_halves(builder, node, first, count);
    if (count <= BOUND_MOST) {
        bounds.axis = cone.axis;
        bounds.cosine = cone.cosine;
    }
    set_ball(&bounds, node);
    return bounds;
}

static const Vec3 *unit_normals(const MirrorPatch *patches, uint32_t count, Arena *arena) {
    Vec3 *normals = ARENA_NEW(arena, Vec3, 3 * (size_t)count);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            normals[3 * (size_t)i + k] = vec3_normalize(patches[i].corners.normal[k]);
    return normals;
}

/* A tree is one over the patches of a part's pairs; all of them stand one after the other. */
typedef struct TreePlan {
    const MirrorPair *pairs;
    uint32_t count;      /* of them */
    uint32_t first_item; /* twice as many nodes as items come before, at most */
} TreePlan;

typedef struct TreesWork {
    const Mirrors *mirrors;
    const uint32_t *first; /* patch of a triangle */
    const TreePlan *plans;
    MirrorLeaf *leaves;
    const Vec3 *normals;
    Item *items;
    MirrorNode *nodes;
    uint32_t *roots;
    uint32_t patch_count;
} TreesWork;

static void make_some_leaves(void *user, int item, int worker) {
    const TreesWork *work = user;
    (void)worker;
    for (uint32_t i = (uint32_t)item * LEAVES_TOGETHER;
         i < ((uint32_t)item + 1) * LEAVES_TOGETHER && i < work->patch_count; i++)
        make_leaf(work->mirrors->patches, work->normals, i, &work->leaves[i]);
}

static void build_tree(void *user, int tree, int worker) {
    const TreesWork *work = user;
    const TreePlan *plan = &work->plans[tree];
    uint32_t items = 0, root = 2 * plan->first_item;
    MirrorBuilder builder = {.patches = work->mirrors->patches,
                             .normals = work->normals,
                             .leaves = work->leaves,
                             .items = work->items + plan->first_item,
                             .nodes = work->nodes,
                             .node_count = root + 1};
    (void)worker;
    for (uint32_t i = 0; i < plan->count; i++) {
        uint32_t triangle = plan->pairs[i].triangle;
        for (uint32_t k = work->first[triangle]; k < work->first[triangle + 1]; k++)
            builder.items[items++] = work->leaves[k].item;
    }
    work->roots[tree] = items ? root : MIRROR_NO_TREE;
    if (items) build_node(&builder, root, 0, items);
}

/* Returns the number of items of all trees. */
static uint32_t plan_trees(const Mirrors *mirrors, const uint32_t *first, int trees,
                           TreePlan *plans) {
    uint32_t done = 0, items = 0;
    for (int i = 0; i < trees; i++) {
        const MirrorPair *pairs = mirrors->pairs + done;
        uint32_t count = 0, left = mirrors->pair_count - done;
        plans[i] = (TreePlan){.pairs = pairs, .first_item = items};
        while (count < left && mirror_root(pairs[count].part_id, pairs[count].is_rough) == i) {
            items += first[pairs[count].triangle + 1] - first[pairs[count].triangle];
            count++;
        }
        plans[i].count = count;
        done += count;
    }
    return items;
}

static void build_trees(const Scene *scene, Mirrors *mirrors, const uint32_t *first,
                        uint32_t patch_count, int threads, Arena *arena) {
    int trees = 2 * (scene->part_count + 1);
    uint32_t *roots = ARENA_NEW(arena, uint32_t, trees);
    TreePlan *plans = ARENA_NEW(arena, TreePlan, trees);
    uint32_t items = plan_trees(mirrors, first, trees, plans);
    MirrorNode *nodes = ARENA_NEW(arena, MirrorNode, 2 * (size_t)items + 1);
    Arena scratch = *arena;
    TreesWork work = {.mirrors = mirrors,
                      .first = first,
                      .plans = plans,
                      .nodes = nodes,
                      .roots = roots,
                      .patch_count = patch_count};
    work.items = arena_untouched(&scratch, sizeof(Item), _Alignof(Item), items);
    work.leaves = arena_untouched(&scratch, sizeof(MirrorLeaf), _Alignof(MirrorLeaf), patch_count);
    work.normals = unit_normals(mirrors->patches, patch_count, &scratch);
    parallel_for(threads, (int)((patch_count + LEAVES_TOGETHER - 1) / LEAVES_TOGETHER),
                 make_some_leaves, &work);
    parallel_for(threads, trees, build_tree, &work);
    mirrors->roots = roots;
    mirrors->nodes = nodes;
}

const Mirrors *mirrors_build(const Scene *scene, const MirrorPair *pairs, uint32_t count,
                             int threads, Arena *arena) {
    if (!count) return NULL;
    Mirrors *mirrors = ARENA_NEW(arena, Mirrors, 1);
    MirrorPair *kept = ARENA_NEW(arena, MirrorPair, count);
    uint32_t *first = ARENA_NEW(arena, uint32_t, scene->triangle_count + 1);
    bool *is_used = ARENA_NEW(arena, bool, scene->triangle_count + 1);
    for (uint32_t i = 0; i < count; i++) {
        kept[i] = pairs[i];
        is_used[pairs[i].triangle] = true;
    }
    PatchList list = cut_patches(scene, is_used, first, arena);
    *mirrors = (Mirrors){.pairs = kept, .pair_count = count, .patches = list.patches};
    build_trees(scene, mirrors, first, list.count, threads, arena);
    return mirrors;
}
