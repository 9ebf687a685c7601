/* SPDX-License-Identifier: Apache-2.0 */
#include "mirror/glint_map.h"

#include <math.h>

#include "base/mathf.h"

#define COARSER 8 /* edge of a cube by the next smaller one's */
#define FIRST_ROOM 4096
#define ACROSS_M2 4.0f /* times edge squared: area of a plane that one cube counts for */

/* Odd numbers without a pattern: the bits of a place's coordinates mix by them. */
#define MIX_X 0x9e3779b97f4a7c15u
#define MIX_Y 0xc2b2ae3d27d4eb4fu
#define MIX_Z 0x165667b19e3779f9u
#define MIX_ROW 0xd6e8feb86659fd93u
#define MIX_ALL 0xff51afd7ed558ccdu

/* Hashes a cube's key to 32 bits: now and then two cubes share one, which is good enough for a
 * mere estimate of light. */
static uint32_t tag_of(uint64_t key) {
    key = (key ^ key >> 32) * MIX_ALL;
    return (uint32_t)(key >> 29) | 1u << 31;
}

/* The cube, or the free place where it would stand. */
static GlintCube *find(const GlintTable *table, uint32_t tag) {
    for (uint32_t at = tag;; at++) {
        GlintCube *cube = &table->cubes[at & (table->room - 1)];
        if (cube->tag == tag || !cube->tag) return cube;
    }
}

static void grow(GlintTable *table, Arena *arena) {
    GlintTable larger = {.room = table->room ? 2 * table->room : FIRST_ROOM, .count = table->count};
    larger.cubes = ARENA_NEW(arena, GlintCube, larger.room);
    for (uint32_t i = 0; i < table->room; i++)
        if (table->cubes[i].tag) *find(&larger, table->cubes[i].tag) = table->cubes[i];
    *table = larger;
}

/* Index of the cube along one axis, for a place moved down by `shift` edges. */
static uint64_t coordinate(float m, float per_m, float shift) {
    return (uint64_t)(int64_t)floorf(clampf(m * per_m - shift, -1e18f, 1e18f));
}

static uint64_t cube_key(const GlintPlace *place, float edge_m, float shift) {
    Vec3 p = place->position;
    float per_m = 1 / edge_m;
    return place->row * MIX_ROW + coordinate(p.x, per_m, shift) * MIX_X +
           coordinate(p.y, per_m, shift) * MIX_Y + coordinate(p.z, per_m, shift) * MIX_Z;
}

static float add_lm(GlintTable *table, uint32_t tag, float lm, Arena *arena) {
    if (4 * (uint64_t)table->count >= 3 * (uint64_t)table->room) grow(table, arena);
    GlintCube *cube = find(table, tag);
    table->count += !cube->tag;
    cube->tag = tag;
    cube->lm += lm;
    cube->rays++;
    return cube->lm;
}

static float lx_of(float lm, float edge) {
    return lm / (ACROSS_M2 * edge * edge);
}

float glint_map_add(GlintMap *map, const GlintPlace *place, float lm, Arena *arena) {
    float most = 0, edge = place->edge_m;
    for (int size = 0; size < GLINT_SIZES; size++, edge *= COARSER) {
        uint64_t lowest = cube_key(place, edge, 0.5f);
        for (int i = 0; i < 8; i++)
            most = max_f(most, lx_of(add_lm(&map->size[size],
                                            tag_of(lowest + (i & 1 ? MIX_X : 0) +
                                                   (i & 2 ? MIX_Y : 0) + (i & 4 ? MIX_Z : 0)),
                                            lm, arena),
                                     edge));
    }
    return most;
}

static float lx_in(const GlintTable *table, const GlintPlace *place, float edge) {
    if (!table->room) return 0;
    return lx_of(find(table, tag_of(cube_key(place, edge, 0)))->lm, edge);
}

/* Where no cube of a size got light no smaller one did. A place without rays in the midst of
 * few others may be lit as those are, where none chanced to land: of n that a coarse cube gets
 * on average, with a probability of e^-n, whose root weighs it about as 1 / (1 + n)^2. */
float glint_map_lx(const GlintMap *map, const GlintPlace *place) {
    float edge = COARSER * place->edge_m;
    const GlintTable *wide = &map->size[2];
    float coarse = lx_in(&map->size[1], place, edge);
    if (coarse > 0) return max_f(coarse, lx_in(&map->size[0], place, place->edge_m));
    if (!wide->room) return 0;
    const GlintCube *cube = find(wide, tag_of(cube_key(place, COARSER * edge, 0)));
    float n = 1 + (float)cube->rays / (COARSER * COARSER);
    return lx_of(cube->lm, COARSER * edge) / (n * n);
}
