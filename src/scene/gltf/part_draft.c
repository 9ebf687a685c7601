/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/part_draft.h"

#include <string.h>

#include "base/mathf.h"

/* New item i is the old one from[i]; NULL stays NULL. */
static void *gather(const void *items, size_t size, const uint32_t *from, uint32_t count,
                    Arena *scratch) {
    if (!items) return NULL;
    char *out = arena_alloc(scratch, size, 16, count);
    for (uint32_t i = 0; i < count; i++)
        memcpy(out + size * i, (const char *)items + size * from[i], size);
    return out;
}

static void gather_vertices(PartDraft *draft, const uint32_t *from, uint32_t count,
                            Arena *scratch) {
    Part *part = &draft->part;
    draft->positions = gather(draft->positions, sizeof(Vec3), from, count, scratch);
    part->normals = gather(part->normals, sizeof(Vec3), from, count, scratch);
    part->tangents = gather(part->tangents, sizeof(Tangent), from, count, scratch);
    part->colors = gather(part->colors, sizeof(VertexColor), from, count, scratch);
    for (int s = 0; s < SCENE_UV_SETS; s++)
        part->uv[s] = gather(part->uv[s], sizeof(Vec2), from, count, scratch);
    draft->vertex_count = count;
}

/* ---- flat normals (glTF 2.0, 3.7.2.1) --------------------------------------------------- */

void draft_flat_normals(PartDraft *draft, Arena *scratch) {
    uint32_t count = 3 * draft->triangle_count;
    gather_vertices(draft, draft->indices, count, scratch);
    for (uint32_t i = 0; i < count; i++) draft->indices[i] = i;
    draft->part.normals = ARENA_NEW(scratch, Vec3, count);
    for (uint32_t i = 0; i < count; i += 3) {
        const Vec3 *p = draft->positions + i;
        Vec3 e = vec3_normalize(vec3_sub(p[1], p[0]));
        Vec3 f = vec3_normalize(vec3_sub(p[2], p[0]));
        Vec3 n = vec3_normalize(vec3_cross(e, f));
        for (uint32_t c = 0; c < 3; c++) draft->part.normals[i + c] = n;
    }
}

/* ---- tangents: along growing u, averaged over the triangles that meet ------------------ */

void draft_any_tangents(PartDraft *draft, Arena *scratch) {
    draft->part.tangents = ARENA_NEW(scratch, Tangent, draft->vertex_count);
    for (uint32_t i = 0; i < draft->vertex_count; i++) {
        Vec3 n = draft->part.normals[i];
        Vec3 along = vec3_dot(n, n) > 0 ? frame_from_z(n).x : vec3(1, 0, 0);
        draft->part.tangents[i] = (Tangent){along, 1};
    }
}

/* Vertices with equal keys count as one for tangents. */
typedef struct WeldKey {
    Vec3 position, normal;
    Vec2 uv;
} WeldKey;

static WeldKey weld_key(const PartDraft *draft, uint32_t vertex, int uv_set) {
    return (WeldKey){draft->positions[vertex], draft->part.normals[vertex],
                     draft->part.uv[uv_set][vertex]};
}

static uint32_t hash_key(const WeldKey *key) {
    uint32_t words[8], hash = 2166136261u; /* FNV-1a over words, then mixed */
    memcpy(words, key, sizeof words);
    for (int i = 0; i < 8; i++) hash = (hash ^ words[i]) * 16777619u, hash ^= hash >> 15;
    return hash;
}

/* weld[i] is the first vertex that equals vertex i. */
static uint32_t *weld_vertices(const PartDraft *draft, int uv_set, Arena *scratch) {
    uint32_t *weld = ARENA_NEW(scratch, uint32_t, draft->vertex_count);
    size_t size = 16;
    while (size < 2 * (size_t)draft->vertex_count) size *= 2;
    uint32_t *table = ARENA_NEW(scratch, uint32_t, size); /* vertex + 1, 0: free */
    for (uint32_t i = 0; i < draft->vertex_count; i++) {
        WeldKey key = weld_key(draft, i, uv_set);
        size_t slot = hash_key(&key) & (size - 1);
        for (;; slot = (slot + 1) & (size - 1)) {
            if (!table[slot]) table[slot] = i + 1;
            WeldKey other = weld_key(draft, table[slot] - 1, uv_set);
            if (memcmp(&key, &other, sizeof key) == 0) break;
        }
        weld[i] = table[slot] - 1;
    }
    return weld;
}

void draft_slot_box(const PartDraft *draft, const TextureSlot *slot, float box[4]) {
    const Vec2 *uv = draft->part.uv[slot->uv_set];
    for (uint32_t i = 0; uv && i < 3 * draft->triangle_count; i++) {
        Vec2 at = slot_from_uv(slot, uv[draft->indices[i]]);
        box[0] = fminf(box[0], at.x), box[1] = fmaxf(box[1], at.x);
        box[2] = fminf(box[2], at.y), box[3] = fmaxf(box[3], at.y);
    }
}

/* P = P0 + u dP/du + v dP/dv on the triangle; right x up = -dP/du x dP/dv since v runs down,
 * so the determinant of the coordinates is negative where the picture is not mirrored. */
int draft_triangle_tangent(const PartDraft *draft, uint32_t triangle, const TextureSlot *slot,
                           Vec3 *tangent) {
    const uint32_t *index = draft->indices + 3 * (size_t)triangle;
    const Vec3 *p = draft->positions;
    const Vec2 *uv = draft->part.uv[slot->uv_set];
    if (!uv) return 0;
    Vec2 a = slot_from_uv(slot, uv[index[0]]), b = slot_from_uv(slot, uv[index[1]]),
         c = slot_from_uv(slot, uv[index[2]]);
    Vec3 e = vec3_sub(p[index[1]], p[index[0]]), f = vec3_sub(p[index[2]], p[index[0]]);
    float eu = b.x - a.x, ev = b.y - a.y, fu = c.x - a.x, fv = c.y - a.y;
    float det = eu * fv - fu * ev;
    if (!(fabsf(det) > 0)) return 0;
    Vec3 t = vec3_sub(vec3_scale(e, fv), vec3_scale(f, ev));
    *tangent = vec3_normalize(vec3_scale(t, det < 0 ? -1.0f : 1.0f));
    return det < 0 ? 1 : 2;
}

/* The angle at a corner, the weight that does not depend on how a face is cut. */
static float corner_angle(const Vec3 *positions, const uint32_t index[3], int corner) {
    Vec3 p = positions[index[corner]];
    Vec3 a = vec3_normalize(vec3_sub(positions[index[(corner + 1) % 3]], p));
    Vec3 b = vec3_normalize(vec3_sub(positions[index[(corner + 2) % 3]], p));
    return acos_f(vec3_dot(a, b));
}

/* sums[2 w + side - 1]: of welded vertex w, apart for either side. sides: one a triangle. */
static void sum_tangents(const PartDraft *draft, const TextureSlot *slot, const uint32_t *weld,
                         Vec3 *sums, unsigned char *sides) {
    for (uint32_t t = 0; t < draft->triangle_count; t++) {
        const uint32_t *index = draft->indices + 3 * (size_t)t;
        Vec3 tangent = {0};
        int side = draft_triangle_tangent(draft, t, slot, &tangent);
        sides[t] = (unsigned char)side;
        if (!side) continue;
        for (int c = 0; c < 3; c++) {
            Vec3 n = draft->part.normals[index[c]];
            Vec3 flat = vec3_normalize(vec3_along(tangent, n, -vec3_dot(n, tangent)));
            Vec3 *sum = &sums[2 * (size_t)weld[index[c]] + (size_t)side - 1];
            *sum = vec3_along(*sum, flat, corner_angle(draft->positions, index, c));
        }
    }
}

static Tangent tangent_from_sum(Vec3 n, Vec3 sum, int side) {
    Vec3 t = vec3_along(sum, n, -vec3_dot(n, sum));
    if (!(vec3_dot(t, t) > 1e-12f)) t = frame_from_z(n).x;
    return (Tangent){vec3_normalize(t), side == 2 ? -1.0f : 1.0f};
}

/* A vertex where the picture is mirrored on one side only becomes two vertices. */
void draft_tangents(PartDraft *draft, const TextureSlot *slot, Arena *scratch) {
    uint32_t count = draft->vertex_count, corners = 3 * draft->triangle_count, used = 0;
    uint32_t *weld = weld_vertices(draft, slot->uv_set, scratch);
    Vec3 *sums = ARENA_NEW(scratch, Vec3, 2 * (size_t)count);
    unsigned char *sides = ARENA_NEW(scratch, unsigned char, draft->triangle_count);
    uint32_t *place[2] = {ARENA_NEW(scratch, uint32_t, count), ARENA_NEW(scratch, uint32_t, count)};
    uint32_t *from = ARENA_NEW(scratch, uint32_t, corners);
    Tangent *tangents = ARENA_NEW(scratch, Tangent, corners);
    sum_tangents(draft, slot, weld, sums, sides);
    for (uint32_t k = 0; k < corners; k++) {
        uint32_t old = draft->indices[k];
        int side = sides[k / 3] == 2 ? 2 : 1;
        if (!place[side - 1][old]) {
            Vec3 sum = sums[2 * (size_t)weld[old] + (size_t)side - 1];
            from[used] = old;
            tangents[used] = tangent_from_sum(draft->part.normals[old], sum, side);
            place[side - 1][old] = ++used;
        }
        draft->indices[k] = place[side - 1][old] - 1;
    }
    gather_vertices(draft, from, used, scratch);
    draft->part.tangents = tangents;
}

/* ---- what is kept ----------------------------------------------------------------------- */

static void *copy(const void *items, size_t size, uint32_t count, Arena *arena) {
    return items ? memcpy(arena_alloc(arena, size, 16, count), items, size * count) : NULL;
}

void draft_keep(PartDraft *draft, Arena *arena, Arena begun, Arena *scratch) {
    Part *part = &draft->part;
    uint32_t count = draft->vertex_count;
    part->normals = copy(part->normals, sizeof(Vec3), count, arena);
    part->tangents = copy(part->tangents, sizeof(Tangent), count, arena);
    part->colors = copy(part->colors, sizeof(VertexColor), count, arena);
    for (int s = 0; s < SCENE_UV_SETS; s++)
        part->uv[s] = copy(part->uv[s], sizeof(Vec2), count, arena);
    size_t places = sizeof(Vec3) * count;
    size_t lists = 3 * sizeof(uint32_t) * (size_t)draft->triangle_count;
    char *both = arena_alloc(scratch, 1, 16, places + lists);
    memcpy(both, draft->positions, places);
    memcpy(both + places, draft->indices, lists);
    *scratch = begun;
    both = arena_keep(scratch, both, places + lists, 16);
    draft->positions = (Vec3 *)both;
    draft->indices = (uint32_t *)(both + places);
}
