/* SPDX-License-Identifier: Apache-2.0 */
/* sky_picture_doubt.h -- does a picture of surroundings light the scene as what it shows would?
 *
 * Most pictures that are shared as HDRIs have no absolute scale: a sunset of 2 lx beside a
 * display of 500 cd/m2. Two kinds can be recognised from the picture alone; E is its
 * illuminance on a horizontal plane:
 *
 * 1. Unit range: the largest stored value is above 0.25 and at most 1, so that the values are
 *    those of a picture for a display, and E is below 300 lx.
 * 2. Daylight without its light: the dome (above 15 degrees) is lit as no night sky is, its
 *    median at least 0.05 cd/m2 (about five times that of a full moon's sky) and 0.02 E / pi;
 *    and
 *    - a sun: one peak above the horizon, 1000 times the dome's median or more, with nothing of
 *      a tenth of it farther than 5 degrees away, and E is below a quarter of what an overcast
 *      sky gives at its elevation h, (300 + 21000 sin h) lx (Krochmann and Seidl 1974; DIN
 *      5034-2); or
 *    - a blue dome: half of it has B >= 1.15 R and B >= G, and E is below 300 lx; or
 *    - a sky over a ground: the dome's median is twice that of the lower half (below -15
 *      degrees) or more, nothing above the horizon is 1000 times the dome's median (a lamp
 *      would be), and E is 1 to 50 lx.
 * There is no doubt below 0.3 lx, a full moon's light, when the values are not in unit range;
 * nor of a picture whose scale the user set. A dusk of less than 300 lx looks like daylight
 * without its light, and is reported as well.
 *
 * Units    lx, cd/m2, radians. Threads: no shared state. Memory: none.
 */
#pragma once
#include "scene/scene.h"

typedef enum HdriDoubt { HDRI_PLAUSIBLE, HDRI_UNIT_RANGE, HDRI_DIM_SUN, HDRI_DIM_SKY } HdriDoubt;

/* Quantities of the criterion; luminances are in the picture's scaled values. */
typedef struct HdriLook {
    double illuminance_lx;
    double largest_stored;             /* of R, G, B, as the file holds them */
    double dome_cd_m2, ground_cd_m2;   /* medians over solid angle */
    double peak_cd_m2, peak_elevation; /* of the upper half */
    double blue_share;                 /* of the dome */
    bool has_one_peak;
} HdriLook;

/* environment->kind is ENVIRONMENT_HDRI. */
HdriLook hdri_look(const Environment *environment);
HdriDoubt hdri_doubt(const HdriLook *look);
