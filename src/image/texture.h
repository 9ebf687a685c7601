/* SPDX-License-Identifier: Apache-2.0 */
/* texture.h -- looks a texture up at a point.
 *
 * uv       glTF's: u to the right, v down, (0,0) the outer corner of the first texel.
 * Threads  plain const data.
 */
#pragma once
#include <stdbool.h>

#include "base/vec.h"
#include "image/image.h"

typedef enum TextureWrap { WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR } TextureWrap;

typedef struct Texture {
    Image image;
    TextureWrap wrap_u, wrap_v;
    bool nearest; /* magnification filter: NEAREST, else linear */
} Texture;

/* Straight RGBA in [0,1], the codes as they are (data: normals, roughness ...). */
void texture_data(const Texture *texture, float u, float v, float rgba[4]);

/* Colour: 8- and 16-bit codes are decoded from sRGB to linear BEFORE interpolation; floats
 * are linear already. Alpha is never decoded. */
void texture_colour(const Texture *texture, float u, float v, float rgba[4]);

/* The nearest pixel's codes on a scale of 0..255 (16-bit codes scaled), alpha left out: what
 * a display shows there. */
void texture_codes(const Texture *texture, float u, float v, float rgb[3]);

#define TEXTURE_AT_ONCE 128

/* Those of many places at once, at most TEXTURE_AT_ONCE, rounded to whole codes. */
void texture_whole_codes(const Texture *texture, const float *u, const float *v, int count,
                         uint8_t (*rgb)[3]);
