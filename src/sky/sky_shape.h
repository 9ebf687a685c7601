/* SPDX-License-Identifier: Apache-2.0 */
/* sky_shape.h -- how luminance is spread over a sky: CIE's general skies and Perez's.
 *
 * Both are a gradation over the zenith angle times an indicatrix over the angle to the sun,
 *     L / L0 = (1 + a exp(b / cos theta)) (1 + c (exp(d gamma) - c0) + e cos^2 gamma).
 * Source    ISO 15469:2004 (CIE S 011), types 1 to 15; Perez, Seals and Michalsky, "All-weather
 *           model for sky luminance distribution", Solar Energy 50 (1993), with its erratum.
 * Units     radians, W m^-2; luminances relative until they are scaled.
 * Threads   pure functions. Fails: only sky_shape_perez, on irradiances without a sky.
 */
#pragma once
#include "base/error.h"

typedef struct SkyShape {
    double a, b, c, d, e;
    double offset; /* c0: exp(d pi / 2) of CIE's indicatrix, 0 of Perez's */
    double linear; /* the traditional overcast sky: 1 + linear cos theta instead; else 0 */
} SkyShape;

/* type 1..15, or 16: the traditional overcast sky, L = Lz (1 + 2 cos theta) / 3. */
SkyShape sky_shape_cie(int type);

typedef struct PerezInput {
    double sun_zenith;                                  /* radians, below pi / 2 */
    double direct_normal_w_m2, diffuse_horizontal_w_m2; /* at least 0; above 0 */
    int day;                                            /* of the year, from 1 */
} PerezInput;

/* The parameters that the model derives from its input. */
typedef struct PerezState {
    double air_mass, brightness, clearness; /* m, Delta, epsilon */
    int bin;                                /* 1..8 */
} PerezState;

/* *state may be NULL. Clearness is held in [1, 12.01), brightness in [0.01, 0.6]: the fit has
 * no skies outside; nor has that of the shape below a brightness of 0.2 where clearness lies
 * between 1.065 and 2.8, so it is raised for the shape alone. b is held at 0, which keeps the
 * horizon finite under a bright sun that is about to set. */
bool sky_shape_perez(const PerezInput *input, SkyShape *out, PerezState *state, Error *err);

/* Relative luminance at cos theta (above 0) and at an angle gamma to the sun. Never negative.
 */
double sky_shape_value(const SkyShape *shape, double cos_theta, double gamma);

/* HOT: the same without the C library, so that frames are the same everywhere. */
float sky_shape_at(const SkyShape *shape, float cos_theta, float gamma);

/* Integral over the upper hemisphere of value cos theta, sr, with the sun at sun_zenith;
 * steps: of both angles (1000: about 1e-6; 40: below 5e-4 of Perez's skies). */
double sky_shape_integral(const SkyShape *shape, double sun_zenith, int steps);
