/* SPDX-License-Identifier: Apache-2.0 */
/* stroke_font.h -- writes numbers and units into a picture, smooth at any size.
 *
 * Letters are strokes on a grid, drawn with a round pen. There are the figures, small letters
 * (capitals show as small ones) and ".:-+/%()"; "^2" is a raised two; anything else is a box.
 */
#pragma once
#include "image/picture.h"

typedef struct StrokeFont {
    float height;    /* pixels, of a figure */
    float colour[3]; /* codes */
} StrokeFont;

/* x: left end, y: middle line of the digits, both in pixels. Returns the text's width in
 * pixels; without a picture nothing else is done. */
float stroke_font_draw(Picture *picture, StrokeFont font, float x, float y, const char *text);
