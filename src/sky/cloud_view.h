/* SPDX-License-Identifier: Apache-2.0 */
/* cloud_view.h -- looks at a cloud deck with a relief from above: the table of cloud_relief.h.
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
 * Units     metres, radians.
 * Memory    the arena's, 4 MB, 60 MB more while it builds. Threads: the table is the same for
 *           any number of them.
 * Fails     never.
 */
#pragma once
#include "base/arena.h"
#include "sky/cloud_relief.h"

typedef struct CloudViewInput {
    double height_m;           /* of the observer over the deck */
    double relief_m;           /* cloud_field.h; held at half of the height at most */
    double horizon;            /* elevation of the deck's edge */
    double azimuth, elevation; /* of the light: compass, as seen */
    int threads;
} CloudViewInput;

void cloud_view_build(const CloudViewInput *input, Arena *arena, CloudRelief *out);
