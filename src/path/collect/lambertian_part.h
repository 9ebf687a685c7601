/* SPDX-License-Identifier: Apache-2.0 */
/* lambertian_part.h -- what a display that the eye sees scatters by its lambertian part, apart
 * from its haze.
 *
 * Units    XYZ, cd m^-2.
 * Threads  one thread's, like the path.
 */
#pragma once
#include "path/path_collector.h"

typedef struct LambertianPart {
    PathCollector base;
    PathLight found;  /* of the light samples there */
    PathLight before; /* what the path had found in all when it went on from there, */
    Spectrum  share;  /* and how much counts of what it finds since, per lane */
    float    *xyz;    /* goes here in the end */
} LambertianPart;

LambertianPart lambertian_part(float xyz[3], PathCollector *next);
