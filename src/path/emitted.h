/* SPDX-License-Identifier: Apache-2.0 */
/* emitted.h -- light that a path meets itself: what a surface emits, and sun and sky where it
 * leaves the scene. HOT.
 *
 * Both count beside the light samples of the vertex before, by the power heuristic.
 */
#pragma once
#include "path/path_state.h"

/* What the hit sends towards wo. */
void emitted_add(PathState *path, const Surface *surface, const Hit *hit, Vec3 wo);

/* The path leaves the scene. */
void emitted_distant(PathState *path);

/* A point of the scene as who lights it asks. Solids keep their normal outside, whichever side
 * is seen. */
LitPoint emitted_lit_point(const PathState *path, const Surface *surface);

/* Radiance that a triangle's point sends towards wo, as this path sees it: of a display's
 * sub-pixels, where it comes close. */
Spectrum emitted_seen(const PathState *path, const Surface *surface, uint32_t triangle,
                       Vec3 wo);
