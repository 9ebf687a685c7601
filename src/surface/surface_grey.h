/* SPDX-License-Identifier: Apache-2.0 */
/* surface_grey.h -- which materials treat all wavelengths alike.
 *
 * A display that is seen by such surfaces alone counts by its measured XYZ (emitted.c); by any
 * other its spectrum goes through the lanes. Both have the same mean, so which one it is must
 * not depend on the lanes: a comparison of them would keep XYZ for those wavelengths whose
 * rounding agrees, and bias what is left to the others.
 *
 * Memory   from the arena.  Threads  const once built.  Fails  never.
 */
#pragma once
#include "scene/scene.h"

/* One for each material, decided by its data: true where every colour that scatters or absorbs
 * has R = G = B in all texels and vertices, every measured curve is level, and nothing
 * interferes or disperses. */
const bool *surface_grey_build(const Scene *scene, Arena *arena);
