/* eye_reading.h -- what stray light does to an eye that looks at a point, from all that it
 * sees, also outside any frame.
 *
 * The veil that it lays over the point: the integral of f(theta) L cos theta over the
 * hemisphere in front, from 0.1 degrees on (vision/disability_glare.h, the general equation).
 * The sun, when the eye sees it straight or through windows, counts by its illuminance at its
 * own angle. Discomfort (vision/discomfort.h): what is brighter than EYE_GLARE_CD_M2 is a
 * source. Both figures are secondary ones, fitted to rooms; nothing is decided by them.
 *
 * Lamps, displays and the sun that the eye sees by themselves are read by light samples, lamps
 * without a body too; all else by paths that are drawn as the veil weighs them.
 *
 * Units        cd m^-2, lx.
 * Memory       scratch only. Threads: starts its own; the same figures for any count.
 */
#pragma once
#include "review/light/stage.h"

#define EYE_GLARE_CD_M2 2000.0

typedef struct EyeReading {
    double veil;        /* cd m^-2 */
    double vertical_lx; /* of the pupil's plane, all light */
    double dgp, ugr;    /* ugr: NaN without a source */
} EyeReading;

/* An eye that looks at a point; the request's observer. */
EyeReading eye_read(const Stage *stage, Vec3 eye, Vec3 at, Arena scratch);
