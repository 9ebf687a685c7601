/* SPDX-License-Identifier: Apache-2.0 */
/* light_picture.h -- a picture of surroundings as light: pixels in cd m^-2, by the scale and
 * the colours that its file states.
 *
 * Radiance (.hdr) holds radiance, W m^-2 sr^-1, times all its EXPOSURE= and COLORCORR= (several
 * multiply; each is divided out again), in the primaries of PRIMARIES=; times 179 lm/W it is
 * luminance (Radiance's file formats and WHTEFFICACY, G. Ward); a code stands for the middle of
 * its step, as in Radiance's tools (image.h). Without PRIMARIES= colours are
 * taken as Rec.709, which is what other programs mean that write none; Radiance itself would
 * mean its own primaries and equal-energy white. OpenEXR (.exr): `whiteLuminance` is the
 * cd m^-2 of a white of 1 (1 where it is missing), `chromaticities` the primaries. Other
 * formats of floats are cd m^-2 of Rec.709.
 *
 * Units    linear Rec.709, cd m^-2. Memory: the arena's. Threads: no shared state.
 * Fails    as image_read_memory, and where a line of a Radiance header is wrong: file and line.
 */
#pragma once
#include "image/image.h"

#define RADIANCE_LM_W 179.0 /* Radiance's white efficacy, lm/W */

typedef struct LightPicture {
    Image  image;
    double unit_cd_m2; /* luminance of a white whose stored values are 1 */
} LightPicture;

/* A picture of codes (image.format other than IMAGE_RGBA32F) comes back as it is: whether it
 * may serve as light is the caller's decision. */
bool light_picture_read(const void *bytes, size_t size, const char *name, Arena *arena,
                        LightPicture *out, Error *err);
