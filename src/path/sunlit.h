/* SPDX-License-Identifier: Apache-2.0 */
/* sunlit.h -- sunlight via one more surface, sampled from the sun's side. HOT.
 *
 * x is the surface that samples, y one that the sun lights. Chance finds the path x, y, sun by
 * a direction chosen at x; here y is where a ray of the map ends (sunlit/sunlit_way.h).
 * It samples the map with a probability q. Both ways share the light by the power
 * heuristic, for every direction of the sun's disc by itself. y must be opaque, and the way
 * from x to y lead through air.
 */
#pragma once
#include "path/path_collector.h"

/* Does a vertex of the path sample the map, whatever comes of it? */
bool sunlit_is_sampled(const PathState *path, const Surface *surface);

/* Adds one such path from the surface, which was reached against wo. */
void sunlit_add(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding);
