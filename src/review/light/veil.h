/* veil.h -- the veil that stray light inside the eye lays over what it looks at, from all that
 * it sees, also outside any frame.
 *
 * L = integral of f(theta) L(direction) cos theta over the hemisphere in front, from 0.1
 * degrees on (vision/disability_glare.h, the general equation). The sun, when the eye sees it
 * straight or through windows, counts by its illuminance at its own angle.
 *
 * Units    cd m^-2.
 * Memory   scratch only. Threads: starts its own; the same figure for any count.
 */
#pragma once
#include "review/light/stage.h"

/* An eye that looks at a point; the request's observer. */
double veil_read(const Stage *stage, Vec3 eye, Vec3 at, Arena scratch);
