/* SPDX-License-Identifier: Apache-2.0 */
/* sunlit_receivers.h -- places that light should reach, about the displays and cameras. Private
 * to sunlit_build.c.
 *
 * Half of the walks begin on displays, as far as there are any, the others at the cameras; each
 * meets up to WALK_STEPS surfaces and leaves them as a white one scatters.
 *
 * Memory  from the arena. Threads: the caller's alone; the same places on every machine whose
 * rays hit the same.
 */
#pragma once
#include "base/arena.h"
#include "sunlit/sunlit_land.h"

/* A place just off a surface, m, and its normal, unit, to the side that was looked at. */
typedef struct SunlitReceiver {
    Vec3 place, ns;
} SunlitReceiver;

typedef struct SunlitReceivers {
    SunlitReceiver *at;
    int count;
} SunlitReceivers;

SunlitReceivers sunlit_receivers(const SunlitTools *tools, Arena *arena);
