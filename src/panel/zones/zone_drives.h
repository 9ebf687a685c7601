/* SPDX-License-Identifier: Apache-2.0 */
/* zone_drives.h -- what a controller makes of a picture: the drive of each zone.
 *
 * Codes, drives, places: dimming_zones.h, backlight.h. Threads: pure functions. Fails: never.
 */
#pragma once
#include "panel/zones/dimming_zones.h"

/* Light of a primary at whole codes along the normal, over that at 255: it never falls, is 0 at
 * 0 and 1 at 255. */
typedef struct LevelShares {
    float share[3][256];
} LevelShares;

/* A picture as a display shows it: codes 0 to 255 at a place, and how fine it is. */
typedef struct ShownPicture {
    int columns, rows; /* pixels over the active area, at least 1 */
    void (*codes)(const void *user, const float place[2], float codes[3]);
    const void *user;
} ShownPicture;

/* Share of its full light that a primary shows at a code, whole or not. */
double level_share_at(const LevelShares *levels, int primary, double code);

/* Each zone's drive for a picture: by the largest share of the three primaries (or, with a
 * table, their largest code), of all pixels in the zone: the maximum or the mean; no less than
 * `least`. drive: room for all zones. Returns their mean. */
double backlight_drives(const DimmingZones *zones, const LevelShares *levels,
                        const ShownPicture *picture, double *drive);
