/* SPDX-License-Identifier: Apache-2.0 */
/* subpixels.h -- a display's sub-pixels, as an eye sees them that comes close: the scene's, or
 * the panel's where the scene states none.
 *
 * Stripe   red, green and blue stand side by side, left to right as someone facing the display
 *          sees them, in a third of the pixel each; the open areas are alike in shape.
 * Pentile  RGBG, one green and one red or blue sub-pixel for each pixel, as the diamonds of
 *          OLED displays (displaymate.com/Diamond_56N.html, R. M. Soneira after Samsung): green
 *          about (1/4, 1/4) of a pixel, right and down, and red or blue about (3/4, 3/4),
 *          in turn from pixel to pixel and from row to row. Undivided the diamonds touch:
 *          |dx| + |dy| <= 1/2. All are of one size here; in displays green is smaller. A red or
 *          blue one shows the mean, in light, of its pixel and the one that lacks it, of
 *          columns 0 and 1, 2 and 3, ... of its row.
 *
 * An open area sends what its primary sends on average over the pixels that it shows, by how
 * much smaller it is the brighter: the mean over a pixel, over a pair of pentile's, is the
 * panel's emission. The black pattern's light stays even.
 *
 * The layout is seen where a frame's pixel is smaller than SUBPIXELS_WHOLE display pixels and
 * fades to even light until SUBPIXELS_GONE. From there on a frame could not show what repeats
 * from pixel to pixel but as moire (Nyquist): what is sent then is the even light, to the bit.
 *
 * Threads  pure functions. HOT: no allocation, no libm.
 */
#pragma once
#include "light/emission.h"

#define SUBPIXELS_WHOLE 0.25f
#define SUBPIXELS_GONE 0.5f

/* A point of a display with sub-pixels that an eye looks at. */
typedef struct CloseView {
    const Scene         *scene;
    const Display       *display;
    const TrianglePoint *point;
    uint32_t             triangle;
    Vec3                 local; /* to the eye: unit, display_frame's */
    Vec3                 across[2]; /* local, m: what lies between neighbouring pixels of the
                                       frame, in two directions; along the ray nothing counts.
                                       0: it is no frame's ray, NaN: not known */
    Vec2                 beside;    /* from the point to where in its pixels the layout is
                                       sampled, in the content's coordinates */
} CloseView;

/* Codes and how much each counts; weights add up to one and may be negative, the sum of
 * emission times weight is not. */
#define SUBPIXEL_TERMS 4
typedef struct SubpixelMix {
    int   count;
    float weight[SUBPIXEL_TERMS];
    float codes[SUBPIXEL_TERMS][3];
} SubpixelMix;

void subpixels_seen(const CloseView *view, SubpixelMix *out);

/* As display_emission_xyz, and a spectral radiance. */
void     subpixels_xyz(const CloseView *view, float xyz[3]);
Spectrum subpixels_spectrum(const CloseView *view, const Wavelengths *wavelengths);
