/* SPDX-License-Identifier: Apache-2.0 */
/* missed_eye.h -- who might see light that is missed; where a camera's picture shows a place,
 * and how much light there makes of it.
 *
 * Threads  pure functions.
 */
#pragma once
#include "camera/camera.h"

/* Who might see it: a camera, or the front of a display. */
typedef struct MissedEye {
    const char *name;
    const Camera *camera; /* NULL: the display */
    int display_id;
} MissedEye;

typedef struct EyePlace {
    float x, y;     /* in the picture, [0, 1) from its upper left */
    Ray ray;        /* from the place to the camera, up to there */
    float per_flux; /* mean luminance of the whole picture, cd m^-2, by each lm that falls on the
                       place, times what it scatters to the camera, sr^-1, and the cosine there */
} EyePlace;

/* False: it lies outside the picture. Occlusion is not tested. */
bool eye_place_of(const Camera *camera, Vec3 position, EyePlace *out);
