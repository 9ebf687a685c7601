/* SPDX-License-Identifier: Apache-2.0 */
/* sunlit_build.h -- makes the map of the sun's rays that end inside (sunlit_map.h).
 *
 * Before the first path, rays of its own: some leave the displays and cameras and scatter about
 * them; where they end are the receivers, and the box about these is the region. Then one ray
 * of the sun goes through every pixel of the region, up to 2^18 of them, and more through those
 * about which one lands; where few do, these are cut into finer ones. Where a ray lands it is
 * connected to a receiver; what none of them sees is left out. An opening wider than two pixels
 * shows where some of the receivers see its patch, a narrower one the less often.
 *
 * Memory   from the arena. Threads: any number, the same bits.
 */
#pragma once
#include "sunlit/sunlit_land.h"
#include "sunlit/sunlit_map.h"

/* No nodes: no sun, no display and no camera, or none of its rays ends where they see. */
SunlitMap sunlit_build(const SunlitTools *tools, Arena *arena);
