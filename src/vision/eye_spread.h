/* SPDX-License-Identifier: Apache-2.0 */
/* eye_spread.h -- how the eye spreads the light of a point over its retina, and the veil of it.
 *
 * f(theta) is the luminance, seen at an angle from the point, for one lux that it brings to the
 * eye: sr^-1. One function for frames, gazes and verdicts: eye_spread_at.
 *
 * Source   CIE 135/1-1999 "Total glare" (J. J. Vos and T. J. T. P. van den Berg), whose
 *          constants stand in HDR-VDP's sources; the report itself was not read.
 * Units    angles in degrees, as in the formulas, 0 to 90.
 * Threads  pure functions; the same bits on every machine.
 * Fails    never: NaN for angles below 0 or above 90.
 */
#pragma once
#include "vision/human_eye.h"

/* The CIE's total glare function as it is published. Its integral over the hemisphere in front
 * is above one: 1.005 at 24 years and pigment 0, 1.032 at 25 and 0.5, 1.050 at 60 and 0.5,
 * 1.169 at 75 and 1.2. Nothing divides by that: the veil at every angle is the published one;
 * who spreads a picture says where the rest goes (eye_filter.h). */
double eye_spread_at(double angle_deg, HumanEye eye);

/* What age makes of it: at every angle, and so in every veil, the spread is a straight line
 * over this, so that two ages tell all others. (A/70)^4. */
double eye_spread_aging(double age_years);
