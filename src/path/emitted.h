/* SPDX-License-Identifier: Apache-2.0 */
/* emitted.h -- light that a path meets itself: what a surface emits, and sun and sky where it
 * leaves the scene. HOT.
 *
 * Both count beside the light samples of the vertex before, by the power heuristic.
 */
#pragma once
#include "path/path_state.h"

/* Adds what the hit emits towards wo. */
void emitted_add(PathState *path, const Surface *surface, const Hit *hit, Vec3 wo);

/* Adds sun and sky where the path leaves the scene. */
void emitted_distant(PathState *path);

/* The surface's point as lights need it. Solids keep their outward normal, seen from inside
 * too. */
LitPoint emitted_lit_point(const PathState *path, const Surface *surface);

/* The last vertex and the surface that the path meets now. */
SunlitPair emitted_pair(const PathState *path, const Surface *surface);

/* Share of the sun's light from `sun` (unit) at the pair's surface that chance keeps. */
float emitted_chance(const PathContext *context, const SunlitPair *pair, Vec3 sun);
