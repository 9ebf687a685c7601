/* SPDX-License-Identifier: Apache-2.0 */
/* glint_map.h -- how much light landed where, on which side of which part.
 *
 * Light is counted in cubes of three sizes, a fine one for small glints, one eight times as
 * large where few rays came, and once more where none did. Each landing counts in the eight cubes
 * next to it, so that a place near a glint is not taken for a dark one. Cubes that got light stand
 * in a hash table.
 *
 * Memory   from the arena: 12 bytes a cube, and up to four times as much for what is free
 *          or was left behind when a table grew.
 * Threads  one may add; const after the last glint_map_add.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "base/vec.h"

#define GLINT_SIZES 3

typedef struct GlintCube {
    uint32_t tag; /* of which row and place; 0: free */
    float lm;
    uint32_t rays;
} GlintCube;

typedef struct GlintTable {
    GlintCube *cubes;
    uint32_t room, count; /* room: a power of two, or 0 */
} GlintTable;

typedef struct GlintMap {
    GlintTable size[GLINT_SIZES]; /* fine, coarse, wide */
} GlintMap;

/* row: a number for each side of a part; edge_m: of its fine cubes, > 0, fixed for a row. */
typedef struct GlintPlace {
    uint32_t row;
    float edge_m;
    Vec3 position; /* m */
} GlintPlace;

/* The greatest illuminance, lx, that glint_map_lx now has in a cube of those it added to. */
float glint_map_add(GlintMap *map, const GlintPlace *place, float lm, Arena *arena);

/* HOT. Illuminance there, about, lx: 0 where nothing landed nearby. */
float glint_map_lx(const GlintMap *map, const GlintPlace *place);
