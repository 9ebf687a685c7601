/* SPDX-License-Identifier: Apache-2.0 */
/* cloud_relief.h -- how much brighter or darker than its mean a cloud deck with a relief looks
 * in each direction: the table that cloud_view.h makes.
 *
 * Frame     elevation from the observer's horizontal, azimuth from the light's, radians.
 * Memory    4 MB, of the arena that it was built with. Threads: const once built. Fails: never.
 */
#pragma once
#include <stdint.h>

#define CLOUD_RELIEF_ROWS 448
#define CLOUD_RELIEF_COLUMNS 4096

typedef struct CloudRelief {
    float horizon;
    float first, rows; /* a row: (sqrt(first + angle below horizon) - sqrt(first)) rows */
    float diffuse;     /* share of the modulation that the sky's light has */
    uint16_t *factor;  /* [row][column], over CLOUD_RELIEF_ONE */
} CloudRelief;

#define CLOUD_RELIEF_ONE 8192.0f

/* HOT. The factor of the directly lit deck, in [0, 8), mean 1 over the deck's solid angle. */
float cloud_relief_factor(const CloudRelief *relief, float elevation, float azimuth);

/* The row of an elevation below the horizon, [0, CLOUD_RELIEF_ROWS]. */
float cloud_relief_row(const CloudRelief *relief, float elevation);
