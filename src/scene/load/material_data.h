/* SPDX-License-Identifier: Apache-2.0 */
/* material_data.h -- which materials state nothing about what they reflect.
 *
 * A material that is left at glTF's defaults is perfectly white; nothing is, so it was not
 * described. One is taken as without data when its base colour is 1, 1, 1 without a texture
 * or a measured curve, and nothing else states what it does with light: it is no display,
 * glazing or coating, no conductor of measured constants; lets no light through; has no
 * overlay, film, clearcoat or specular colour of its own; is no lamp and not unlit. That some
 * roughness or metalness was given alone does not count: exporters write both. Nor does a trace
 * of emission, below 0.25 cd m^-2.
 *
 * Memory   names in the arena.
 * Threads  pure functions.
 */
#pragma once
#include "base/arena.h"
#include "scene/scene.h"

/* Whether its material has data, or its vertices colours other than white (COLOR_0), which
 * multiply the material's. */
bool part_has_data(const Scene *scene, int part_id);

/* Ids of those without data that some part has which has none itself. */
int *scene_without_data(const Scene *scene, int *count, Arena *arena);

/* "seat, trim and 7 more" */
const char *scene_names_of(const Scene *scene, const int *materials, int count, Arena *arena);

/* For what is written of a scene: what was assumed, not measured, of what its displays emit, a
 * line each: "NAME: WORDS\n"; NULL: nothing. */
const char *displays_assumed(const Scene *scene, Arena *arena);
