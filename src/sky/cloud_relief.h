/* SPDX-License-Identifier: Apache-2.0 */
/* cloud_relief.h -- how much brighter or darker than its mean a cloud deck with a relief looks
 * in each direction.
 *
 * From the observer's foot every azimuth is followed outwards over the height field
 * (cloud_field.h) on the Earth's sphere. What stands highest hides what is behind it, and what
 * is seen is averaged over the angle of a cell of the table: so nothing is finer than that, and
 * far billows merge before they reach the horizon. The mean over some degrees of elevation, a
 * Fourier series of four orders in the azimuth, is then divided out: from every side of the
 * observer the deck sends what an even one does, and only its structure is added.
 *
 * Approximate  the relief is synthetic and belongs to pictures (cloud_field.h); it repeats
 *              after 123 km; the light's direction is the observer's everywhere.
 * Frame     elevation from the observer's horizontal, azimuth from the light's, radians.
 * Memory    the arena's, 4 MB, 60 MB more while it builds. Threads: const once built, the same
 *           for any number of them.
 * Fails     never.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"

#define CLOUD_RELIEF_ROWS 448
#define CLOUD_RELIEF_COLUMNS 4096

typedef struct CloudReliefInput {
    double height_m;       /* of the observer over the deck */
    double relief_m;       /* cloud_field.h; held at half of the height at most */
    double horizon;        /* elevation of the deck's edge */
    double azimuth, elevation; /* of the light: compass, as seen */
    int    threads;
} CloudReliefInput;

typedef struct CloudRelief {
    float     horizon;
    float     first, rows; /* row = (sqrt(first + depression below the horizon) - its root) * */
    float     diffuse;     /* share of the modulation that the sky's light has */
    uint16_t *factor;      /* [row][column], over CLOUD_RELIEF_ONE */
} CloudRelief;

#define CLOUD_RELIEF_ONE 8192.0f

void cloud_relief_build(const CloudReliefInput *input, Arena *arena, CloudRelief *out);

/* HOT. The factor of the directly lit deck, [0, 8), mean 1 over the deck's solid angle. */
float cloud_relief_factor(const CloudRelief *relief, float elevation, float azimuth);

/* The row of an elevation below the horizon, [0, CLOUD_RELIEF_ROWS]. */
float cloud_relief_row(const CloudRelief *relief, float elevation);
