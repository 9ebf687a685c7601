/* SPDX-License-Identifier: Apache-2.0 */
/* mirrored.h -- the sun, lamps without a surface and compact emitters via one mirror. HOT.
 *
 * BSDF samples find light that goes sun, mirror (src/mirror), scattering surface only where
 * they hit the sun's image: rare and very bright samples; lamps without a surface they never
 * find. Here all points of mirrors that turn one direction of the sun's disc, or one place of a
 * lamp or an emitter, to the surface count as lights of that direction; BSDF samples then leave
 * the sun in these mirrors out, and share emitters by the power heuristic.
 *
 * Not known: what passes a second mirror on its way or is refracted, mirrors seen from within
 * a solid, mirrors bent by a normal map, rough ones above GLINT_ALPHA.
 */
#pragma once
#include "path/path_collector.h"

/* Adds the light that mirrors send to the surface, which the path reached against wo. */
void mirrored_add(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding);
