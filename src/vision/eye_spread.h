/* SPDX-License-Identifier: Apache-2.0 */
/* eye_spread.h -- how the eye spreads the light of a point over its retina.
 *
 * f(theta) is the luminance, seen at an angle from the point, for one lux that it brings to the
 * eye: sr^-1. Over the hemisphere in front it adds up to one, since no light is made: integral
 * of f 2 pi sin theta d theta = 1.
 *
 * Source   CIE 135/1-1999 "Total glare" (J. J. Vos and T. J. T. P. van den Berg), whose
 *          constants stand in HDR-VDP's sources; the report itself was not read.
 *          G. Spencer, P. Shirley, K. Zimmerman, D. Greenberg, "Physically-based glare effects
 *          for digital images", SIGGRAPH 1995, the photopic function.
 * Units    angles in degrees, as in the formulas, 0 to 90.
 * Threads  pure functions; the same bits on every machine.
 * Fails    never: NaN for angles below 0 or above 90.
 */
#pragma once
#include "vision/human_eye.h"

/* The CIE's function as it is published: its integral is up to 7 % above one. */
double eye_spread_published(double angle_deg, HumanEye eye);

/* The integral of the published function over the hemisphere, by quadrature (within 1e-6). */
double eye_spread_integral(HumanEye eye);

/* Spencer's; its integral is 0.9996. At 10 degrees it is 1.6 to 1.8 times the CIE's for a young
 * eye. For comparison: what is judged here is judged by the CIE's. */
double eye_spread_spencer(double angle_deg);
