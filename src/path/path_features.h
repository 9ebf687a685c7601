/* SPDX-License-Identifier: Apache-2.0 */
/* path_features.h -- what the layers of a frame show of the first surface of a path. */
#pragma once
#include "path/path.h"

typedef struct PathFeatures {
    float depth;     /* m along the ray */
    Vec3 position;   /* m, scene */
    Vec3 normal;     /* unit, world, shading */
    float albedo[3]; /* linear Rec.709 */
    float uv[2];
    int part_id;
    float sources[3]; /* XYZ, cd m^-2, that it sends itself and the panes before it let pass,
                         if it is no display; else 0 */
    int display_id;   /* NO_ID off displays; else: */
    float emitted[3], white[3], black[3]; /* XYZ, cd m^-2, of what the panes before it let pass:
                                             sent; for full white; for black */
    float theta, phi;                     /* radians, display frame, phi in [0, 2 pi) */
    bool is_measured;                     /* that direction, of the panel's emission */
} PathFeatures;

/* XYZ, cd m^-2, that a display sends to the eye through the panes before it, where it is the
 * path's first surface; false: that is none, or a display's back. */
bool path_display_emission(const PathContext *context, const PathResult *result,
                           const Wavelengths *wavelengths, float xyz[3]);

void path_features(const PathContext *context, const PathResult *result,
                   const Wavelengths *wavelengths, PathFeatures *out);
