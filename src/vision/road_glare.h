/* SPDX-License-Identifier: Apache-2.0 */
/* road_glare.h -- what glare takes from a driver who looks at a lit road by night: the veil of
 * a source as road lighting counts it, the threshold increment, and the luminance of a road as
 * an eye between day and night vision sees it.
 *
 * Source   threshold increment: CIE 140 and EN 13201-3, mesopic luminance: CIE 191, as public
 *          implementations of them agree (three and four of these); the documents themselves
 *          were not read.
 * Units    degrees, lx, cd m^-2, years, per cent.
 * Threads  pure functions; the same bits on every machine.
 * Fails    never: NaN outside the ranges that are named.
 */
#pragma once

#define ROAD_VEIL_FROM_DEG 0.1 /* nearer is looked at */
#define ROAD_VEIL_NEAR_DEG 1.5 /* up to here the formula of small angles */
#define ROAD_LUMINANCE_MIN 0.05
#define ROAD_LUMINANCE_MID 5.0 /* up to here the increment's first branch, beyond its second */

/* The veil of one lux on a plane at the eye, perpendicular to the line of sight, from a source
 * at that angle from it:
 *     up to 1.5 degrees   10 / t^3 + 5 / t^2 (1 + (age/62.5)^4)
 *     beyond              9.86 / t^2 (1 + (age/66.4)^4)
 * Road lighting applies it up to 60 degrees; here it goes on to 90. The branches do not meet:
 * at 25 years the veil falls by 15 % at 1.5 degrees. ROAD_VEIL_FROM_DEG to 90 degrees; age 0 or
 * more. */
double road_veil_at(double angle_deg, double age_years);

/* By how many per cent more contrast an object on the road needs under a veil than without:
 * 65 veil / road^0.8 for roads of 0.05 to 5 cd m^-2, 95 veil / road^1.05 of brighter ones;
 * these do not meet either (2 % at 5 cd m^-2). road_cd_m2: the road's mean luminance, photopic,
 * from ROAD_LUMINANCE_MIN on; the veil is 0 or more. */
double road_threshold_increment(double veil_cd_m2, double road_cd_m2);

/* The way back: the veil that makes an increment. */
double road_veil_of_increment(double increment_pct, double road_cd_m2);

/* CIE 191's system of mesopic photometry: with m from 0 (night vision, at 0.005 cd m^-2 and
 * below) to 1 (day vision, at 5 and above), m = 0.7670 + 0.3334 log10(L),
 *     L = (m P + (1 - m) S V) / (m + (1 - m) V),   V = 683/1699,
 * P the photopic and S = P s_p the scotopic luminance; solved by iteration. Both above 0. */
double road_mesopic_luminance(double photopic_cd_m2, double s_p);
