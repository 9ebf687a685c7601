/* SPDX-License-Identifier: Apache-2.0 */
/* material_list.h -- the materials of a scene as somebody sees them who looks for its screens:
 * where each is worn, how large it is, and whether it looks like a screen.
 *
 * Memory   the command's arena.
 */
#pragma once
#include <jansson.h>

#include "scene/scene.h"

/* [{"name", "meshes", "nodes", "area_m2", "looks_like_screen", "has_emissive_texture",
 * "is_flat", "has_uv", "is_display", "is_one_sided"}], in the scene's order. One-sided: a side
 * that glTF's viewers leave out (doubleSided is not set) and that is there here. */
json_t *material_list_json(const Scene *scene, Arena *arena);

/* The names of the one-sided ones alone. */
json_t *material_list_one_sided(const Scene *scene);
