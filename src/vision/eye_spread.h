/* SPDX-License-Identifier: Apache-2.0 */
/* eye_spread.h -- how the eye spreads the light of a point over its retina, and the veil of it.
 *
 * f(theta) is the luminance, seen at an angle from the point, for one lux that it brings to the
 * eye: sr^-1. One function for frames, gazes and verdicts: eye_spread_at.
 *
 * Source   CIE 135/1-1999 "Total glare" (J. J. Vos and T. J. T. P. van den Berg), whose
 *          constants stand in HDR-VDP's sources; the report itself was not read.
 *          G. Spencer, P. Shirley, K. Zimmerman, D. Greenberg, "Physically-based glare effects
 *          for digital images", SIGGRAPH 1995, the photopic function.
 * Units    angles in degrees, as in the formulas, 0 to 90.
 * Threads  pure functions; the same bits on every machine.
 * Fails    never: NaN for angles below 0 or above 90, or outside an equation's range (both ends
 *          belong to it).
 */
#pragma once
#include "vision/human_eye.h"

/* The CIE's total glare function as it is published. Its integral over the hemisphere in front
 * is above one: 1.005 at 24 years and pigment 0, 1.032 at 25 and 0.5, 1.050 at 60 and 0.5,
 * 1.169 at 75 and 1.2. Nothing divides by that: the veil at every angle is the published one;
 * who spreads a picture says where the rest goes (eye_filter.h). */
double eye_spread_at(double angle_deg, HumanEye eye);

/* Spencer's; its integral is 0.9996. At 10 degrees it is 1.6 to 1.8 times the CIE's for a young
 * eye. For comparison: what is judged here is judged by the CIE's. */
double eye_spread_spencer(double angle_deg);

/* ---- equations of the veil alone, for comparison ------------------------------------------
 *
 * Each function is the equivalent veiling luminance for one lux at the eye, sr^-1 (cd m^-2 per
 * lx), of a glare source at an angle from the line of sight. The lux are those in the plane of
 * the pupil, perpendicular to the line of sight: a source of luminance L and solid angle w adds
 *     f(theta) L w cos theta,
 * here as by the spread above.
 *
 * Source   CIE 146:2002 "CIE equations for disability glare"; J. J. Vos, "On the cause of
 *          disability glare and its dependence on glare angle, age and ocular pigmentation",
 *          Clin. Exp. Optom. 86 (2003) 363. The report itself was not read: the age-adjusted
 *          Stiles-Holladay equation stands in the abstract of Vos' paper, the other two are as
 *          they are commonly quoted, and agree with the point spread above within 30 % at 1
 *          degree and 20 % from 2 to 90. */

#define DISABILITY_GLARE_MIN_DEG 0.1   /* nearer, the point spread itself is to be used */
#define DISABILITY_GLARE_MAX_DEG 100.0
#define DISABILITY_GLARE_SMALL_MAX_DEG 30.0
#define STILES_HOLLADAY_MIN_DEG 1.0
#define STILES_HOLLADAY_MAX_DEG 30.0

/* General equation, 0.1 to 100 degrees:
 *     10/t^3 + (5/t^2 + 0.1 p/t) (1 + (A/62.5)^4) + 0.0025 p */
double disability_glare(double angle_deg, HumanEye eye);

/* Small-angle equation, 0.1 to 30 degrees, for any pigment:
 *     10/t^3 + (5/t^2) (1 + (A/62.5)^4) */
double disability_glare_small_angle(double angle_deg, double age_years);

/* Age-adjusted Stiles-Holladay equation, 1 to 30 degrees:
 *     10 (1 + (A/70)^4) / t^2 */
double disability_glare_stiles_holladay(double angle_deg, double age_years);
