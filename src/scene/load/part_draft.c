#include "scene/load/part_draft.h"

#include <string.h>

#include "base/mathf.h"

static Vec3 load3(const float v[3])
{
    return vec3(v[0], v[1], v[2]);
}

static void store3(float out[3], Vec3 v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

/* ---- flat normals (glTF 2.0, 3.7.2.1): every triangle gets vertices of its own --------- */

void draft_flat_normals(PartDraft *draft, Arena *scratch)
{
    uint32_t count = 3 * draft->triangle_count;
    Vertex *vertices = ARENA_NEW(scratch, Vertex, count);
    for (uint32_t i = 0; i < count; i++) {
        vertices[i] = draft->vertices[draft->indices[i]];
        draft->indices[i] = i;
    }
    for (Vertex *v = vertices; v < vertices + count; v += 3) {
        Vec3 a = load3(v[0].position);
        Vec3 e = vec3_normalize(vec3_sub(load3(v[1].position), a));
        Vec3 f = vec3_normalize(vec3_sub(load3(v[2].position), a));
        Vec3 n = vec3_normalize(vec3_cross(e, f));
        for (int i = 0; i < 3; i++) store3(v[i].normal, n);
    }
    draft->vertices = vertices;
    draft->vertex_count = count;
}

/* ---- tangents: along growing u, averaged over the triangles that meet ------------------ */

/* Any frame will do where no texture asks for one. */
void draft_any_tangents(PartDraft *draft)
{
    for (uint32_t i = 0; i < draft->vertex_count; i++) {
        Vertex *v = &draft->vertices[i];
        Vec3 n = load3(v->normal);
        store3(v->tangent, vec3_dot(n, n) > 0 ? frame_from_z(n).x : vec3(1, 0, 0));
        v->tangent[3] = 1;
    }
}

/* What makes two vertices one for tangents: place, normal and texture coordinates. */
typedef struct WeldKey {
    float position[3], normal[3], uv[2];
} WeldKey;

static WeldKey weld_key(const Vertex *v, int uv_set)
{
    WeldKey key;
    memcpy(key.position, v->position, sizeof key.position);
    memcpy(key.normal, v->normal, sizeof key.normal);
    memcpy(key.uv, v->uv[uv_set], sizeof key.uv);
    return key;
}

static uint32_t hash_key(const WeldKey *key)
{
    uint32_t words[8], hash = 2166136261u; /* FNV-1a over words, then mixed */
    memcpy(words, key, sizeof words);
    for (int i = 0; i < 8; i++) hash = (hash ^ words[i]) * 16777619u, hash ^= hash >> 15;
    return hash;
}

/* weld[i] is the first vertex that equals vertex i. */
static uint32_t *weld_vertices(const PartDraft *draft, int uv_set, Arena *scratch)
{
    uint32_t *weld = ARENA_NEW(scratch, uint32_t, draft->vertex_count);
    size_t size = 16;
    while (size < 2 * (size_t)draft->vertex_count) size *= 2;
    uint32_t *table = ARENA_NEW(scratch, uint32_t, size); /* vertex + 1, 0: free */
    for (uint32_t i = 0; i < draft->vertex_count; i++) {
        WeldKey key = weld_key(&draft->vertices[i], uv_set);
        size_t slot = hash_key(&key) & (size - 1);
        for (;; slot = (slot + 1) & (size - 1)) {
            if (!table[slot]) table[slot] = i + 1;
            WeldKey other = weld_key(&draft->vertices[table[slot] - 1], uv_set);
            if (memcmp(&key, &other, sizeof key) == 0) break;
        }
        weld[i] = table[slot] - 1;
    }
    return weld;
}

static void slot_coordinates(const TextureSlot *slot, const Vertex *v, float out[2])
{
    const float *m = slot->uv_from_uv, *uv = v->uv[slot->uv_set];
    out[0] = m[0] * uv[0] + m[1] * uv[1] + m[2];
    out[1] = m[3] * uv[0] + m[4] * uv[1] + m[5];
}

/* The unit direction of growing u, and on which side the picture is seen: 0 where the
 * coordinates span no area, 1 as it is, 2 mirrored.
 * P = P0 + u dP/du + v dP/dv on the triangle; right x up = -dP/du x dP/dv since v runs down,
 * so the determinant of the coordinates is negative where the picture is not mirrored. */
int triangle_tangent(const TextureSlot *slot, const Vertex *const v[3], Vec3 *tangent)
{
    float a[2], b[2], c[2];
    slot_coordinates(slot, v[0], a);
    slot_coordinates(slot, v[1], b);
    slot_coordinates(slot, v[2], c);
    Vec3 e = vec3_sub(load3(v[1]->position), load3(v[0]->position));
    Vec3 f = vec3_sub(load3(v[2]->position), load3(v[0]->position));
    float eu = b[0] - a[0], ev = b[1] - a[1], fu = c[0] - a[0], fv = c[1] - a[1];
    float det = eu * fv - fu * ev;
    if (!(fabsf(det) > 0)) return 0;
    Vec3 t = vec3_sub(vec3_scale(e, fv), vec3_scale(f, ev));
    *tangent = vec3_normalize(vec3_scale(t, det < 0 ? -1.0f : 1.0f));
    return det < 0 ? 1 : 2;
}

/* The angle at a corner, the weight that does not depend on how a face is cut. */
static float corner_angle(const Vertex *const v[3], int corner)
{
    Vec3 p = load3(v[corner]->position);
    Vec3 a = vec3_normalize(vec3_sub(load3(v[(corner + 1) % 3]->position), p));
    Vec3 b = vec3_normalize(vec3_sub(load3(v[(corner + 2) % 3]->position), p));
    return acos_f(vec3_dot(a, b));
}

/* sums[2 w + side - 1]: of welded vertex w, apart for either side. sides: one a triangle. */
static void sum_tangents(const PartDraft *draft, const TextureSlot *slot, const uint32_t *weld,
                         Vec3 *sums, unsigned char *sides)
{
    for (uint32_t t = 0; t < draft->triangle_count; t++) {
        const uint32_t *index = draft->indices + 3 * (size_t)t;
        const Vertex *const v[3] = {&draft->vertices[index[0]], &draft->vertices[index[1]],
                                    &draft->vertices[index[2]]};
        Vec3 tangent = {0};
        int side = triangle_tangent(slot, v, &tangent);
        sides[t] = (unsigned char)side;
        if (!side) continue;
        for (int c = 0; c < 3; c++) {
            Vec3 n = load3(v[c]->normal);
            Vec3 flat = vec3_normalize(vec3_along(tangent, n, -vec3_dot(n, tangent)));
            Vec3 *sum = &sums[2 * (size_t)weld[index[c]] + (size_t)side - 1];
            *sum = vec3_along(*sum, flat, corner_angle(v, c));
        }
    }
}

static void set_tangent(Vertex *v, Vec3 sum, int side)
{
    Vec3 n = load3(v->normal);
    Vec3 t = vec3_along(sum, n, -vec3_dot(n, sum));
    if (!(vec3_dot(t, t) > 1e-12f)) t = frame_from_z(n).x;
    store3(v->tangent, vec3_normalize(t));
    v->tangent[3] = side == 2 ? -1.0f : 1.0f;
}

/* A vertex where the picture is mirrored on one side only becomes two vertices. */
void draft_tangents(PartDraft *draft, const TextureSlot *slot, Arena *scratch)
{
    uint32_t count = draft->vertex_count;
    uint32_t *weld = weld_vertices(draft, slot->uv_set, scratch);
    Vec3 *sums = ARENA_NEW(scratch, Vec3, 2 * (size_t)count);
    unsigned char *sides = ARENA_NEW(scratch, unsigned char, draft->triangle_count);
    uint32_t *place[2] = {ARENA_NEW(scratch, uint32_t, count),
                          ARENA_NEW(scratch, uint32_t, count)};
    Vertex *vertices = ARENA_NEW(scratch, Vertex, 2 * (size_t)count);
    draft_any_tangents(draft);
    sum_tangents(draft, slot, weld, sums, sides);
    uint32_t used = 0;
    for (uint32_t k = 0; k < 3 * draft->triangle_count; k++) {
        uint32_t old = draft->indices[k];
        int side = sides[k / 3] == 2 ? 2 : 1;
        if (!place[side - 1][old]) {
            vertices[used] = draft->vertices[old];
            set_tangent(&vertices[used], sums[2 * (size_t)weld[old] + (size_t)side - 1], side);
            place[side - 1][old] = ++used;
        }
        draft->indices[k] = place[side - 1][old] - 1;
    }
    draft->vertices = vertices;
    draft->vertex_count = used;
}
