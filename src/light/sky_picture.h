/* SPDX-License-Identifier: Apache-2.0 */
/* sky_picture.h -- an equirectangular picture as the sky (HDRI).
 *
 * The left edge is north, the centre south (with no rotation, +Z of the scene, +X to its left:
 * OpenEXR's latlong). Looked up bilinearly and sampled by luminance; negative and non-finite
 * values count as 0.
 * Units     RGB in cd m^-2, linear Rec.709. Threads: const once built.
 */
#pragma once
#include "scene/scene.h"

typedef struct SkyPicture {
    const float *pixels; /* RGBA, cd m^-2 after scale */
    int width, height;
    float scale;
    float u_offset;                           /* image u = azimuth in the scene / 2 pi + u_offset */
    const float *row_cdf;                     /* height + 1 values from 0 to 1 */
    const float *column_cdf;                  /* height rows of width + 1 values */
    const uint16_t *row_guide, *column_guide; /* where to begin looking in them */
} SkyPicture;

/* turn: compass azimuth of the scene's -Z, radians. */
bool sky_picture_build(const Environment *environment, float turn, Arena *arena, SkyPicture *out,
                       Error *err);

/* HOT. Where a direction lies in the picture, and the density with which it would be
 * sampled. */
Vec2 sky_picture_place(const SkyPicture *picture, Vec3 direction, float *pdf);

/* HOT. Chooses a direction; *at: where it lies in the picture, in pixels from the upper left
 * corner. */
void sky_picture_sample(const SkyPicture *picture, float u0, float u1, Vec3 *direction, Vec2 *at,
                        float *pdf);

/* HOT. Linear Rec.709 there, cd m^-2, bilinear between pixel centres. */
void sky_picture_rgb(const SkyPicture *picture, Vec2 at, float rgb[3]);
