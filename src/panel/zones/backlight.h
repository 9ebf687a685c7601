/* SPDX-License-Identifier: Apache-2.0 */
/* backlight.h -- what a backlight of zones shines where, for the picture that is shown.
 *
 * The picture's codes give each zone's drive a_z; the backlight at a place x of the active
 * area, relative to full (all zones at 1), is
 *
 *     b(x) = sum of a_z P(|x - x_z|) / sum of P(|x - x_z|)
 *
 * P is the zone's spread, x_z its middle. The walls of a backlight are white: what would go
 * over an edge comes back, so both sums go over the zones' mirror images too. White was
 * measured with all zones full, so b is 1 there, and what ripples between zones is in the
 * panel's own tables. One zone is global dimming: b = a everywhere.
 *
 * A panel emits b times what it was measured to emit with the backlight full. Where the
 * controller compensates, a primary that is to shine the share t of its full light gets the
 * code of t / b, 255 at most: lit pixels keep their level along the normal while b >= t, and
 * have b of their full light otherwise. (At an angle they shine as the code does that they
 * get.) A pixel that is black has code 0 always: it leaks b times the black that was measured,
 * at each angle: that is the halo.
 *
 * Taken to be so: a zone's light adds to the others', its colour is the same everywhere, no
 * time passes (no filter over frames), drives have no steps and none is above full.
 *
 * Source   the sum and T in [1/CR, 1]: the usual model of mini-LED backlights, as in G. Tan et
 *          al., High dynamic range liquid crystal displays with a mini-LED backlight, Optics
 *          Express 26 (2018).
 * Places   u from 0 at the left to 1 at the right, v from 0 at the top to 1 at the bottom.
 * Memory   the arena's. Threads: const once it is made. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "panel/zones/zone_drives.h"

typedef struct Backlight {
    int width, height;  /* samples, evenly over the active area */
    const float *light; /* at the middles of width x height cells, from the top */
    bool is_log;        /* light is ln b, of a Gaussian spread; else b */
    bool compensates;
    const float (*log_share)[256]; /* ln of LevelShares, of compensation; [0] is unused */
    double mean_drive;             /* the backlight's power over its full power */
} Backlight;

#define BACKLIGHT_DARK 1e-6f /* the least b that is kept */

/* Makes the map: fine enough that bilinear between its samples (of a Gaussian's ln b, of a
 * table's b) it is the sum within 1 % of it and 0.0001 of full, unless a wide table over many
 * zones would take too long: then it is coarser. drive is kept. */
const Backlight *backlight_make(const DimmingZones *zones, const LevelShares *levels,
                                const double *drive, Arena *arena);
