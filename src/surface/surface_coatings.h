/* SPDX-License-Identifier: Apache-2.0 */
/* surface_coatings.h -- the tables of a scene's coated materials and measured metals.
 *
 * Memory   from the arena, one set of tables for materials that are coated alike.
 * Threads  const once built.  Fails  never.
 */
#pragma once
#include "scene/scene.h"
#include "shaders/layers/coating.h"

/* One for each material; NULL: neither coated nor of a measured metal. Returns NULL where no
 * material needs any. */
const SurfaceCoating *const *surface_coatings_build(const Scene *scene, bool is_polarised,
                                                    Arena *arena);
