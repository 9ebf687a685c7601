/* SPDX-License-Identifier: Apache-2.0 */
/* pixel_light.h -- the light that an aim's paths bring to the eye: tristimulus values and
 * spectrum.
 *
 * A path carries 16 wavelengths, drawn by a density that follows the observer. Of each lane the
 * radiance over that density is a sample of the integral over the band in which it lies, so
 * that a band's mean is without bias; bands that eyes hardly see get few lanes, and larger
 * errors. Displays count by their panels' spectra, here too where frames take their measured
 * tristimulus values as they are.
 *
 * Standard errors come from batches of paths, as those of chains do (chains.h), and all
 * estimates' (estimate/estimate.h). How many paths there are is given, and hangs on none.
 *
 * Units    cd m^-2; W m^-2 sr^-1 nm^-1; nm.
 * Memory   scratch only.
 * Threads  starts its own; the same numbers for any count.
 */
#pragma once
#include "review/chain/chains.h"

#define PIXEL_BAND_NM 10
#define PIXEL_FIRST_NM 360 /* where the first band begins */
#define PIXEL_BANDS 47     /* to 830 nm */

typedef struct PixelFigure {
    double mean, sigma; /* and its standard error */
} PixelFigure;

typedef struct PixelLight {
    PixelFigure xyz[3];
    PixelFigure radiance[PIXEL_BANDS]; /* means over the bands */
} PixelLight;

/* ask: of a pixel (ProbeAim.pixel). As many paths as chains_find takes of it, the same ones. */
PixelLight pixel_light_find(const ChainAsk *ask);
