/* SPDX-License-Identifier: Apache-2.0 */
/* discomfort.h -- figures of glare that disturbs without hiding anything. Secondary ones here:
 * they were fitted to rooms with windows and luminaires, not to cockpits in the sun.
 *
 * Both square the luminance and take the solid angle only once, so that small bright sources
 * (the sun, its glints) weigh more than people report, and as much more as pixels are smaller.
 * Print them with the smallest solid angle among the sources; never let them decide.
 *
 * Units    cd m^-2, sr, lx, m^2.
 * Threads  pure functions; sources are only read.
 * Fails    never: NaN where a figure has no meaning (no light to adapt to, an index below 1).
 */
#pragma once

typedef struct GlareSource {
    double luminance_cd_m2;
    double solid_angle_sr;
    double position_index; /* position_index, at least 1 */
    double area_m2;        /* projected towards the eye; 0: unknown, or not small */
} GlareSource;

/* CIE 147:2002 speaks of a small source below this projected area. */
#define GLARE_SOURCE_SMALL_M2 0.005
/* UGR's range of a source's solid angle (CIE 117-1995). */
#define UGR_SOLID_ANGLE_MIN_SR 0.0003
#define UGR_SOLID_ANGLE_MAX_SR 0.1

/* Unified Glare Rating, CIE 117-1995: 8 log10(0.25/Lb sum L^2 w/P^2). background_cd_m2: Lb, the
 * vertical illuminance at the eye without that of the sources, over pi. A source of less than
 * GLARE_SOURCE_SMALL_M2 counts by its intensity I and distance R, 200 I^2/R^2 instead of L^2 w
 * (CIE 147:2002, as it is commonly quoted): as though its light came from 0.005 m^2. Without
 * any source -infinity. */
double discomfort_ugr(double background_cd_m2, const GlareSource *sources, int count);

/* Daylight Glare Probability: 5.87e-5 Ev + 0.092 log10(1 + sum L^2 w/(Ev^1.87 P^2)) + 0.159, at
 * most 1. Ev: vertical illuminance at the eye, all light. J. Wienold and J. Christoffersen,
 * Energy and Buildings 38 (2006) 743. Below 0.35 imperceptible, 0.40 perceptible, 0.45
 * disturbing, above it intolerable. */
double discomfort_dgp(double vertical_lx, const GlareSource *sources, int count);

/* The factor of evalglare (NREL/Radiance) on it below 1000 lx:
 * exp(0.024 Ev - 4)/(1 + exp(0.024 Ev - 4)); 1 from there on. */
double discomfort_dgp_low_light(double vertical_lx);

/* ---- how much less a source disturbs that is not looked at -------------------------------
 *
 * 1 on the line of sight, more away from it, at most 16. Angles in degrees.
 *
 * Source   above the line of sight S. K. Guth, "A method for the evaluation of discomfort
 *          glare", Illum. Eng. 58 (1963) 351; below it T. Iwata and M. Tokura, "Position index
 *          for a glare source located below the line of vision", Light. Res. Technol. 29 (1997)
 *          172. Both as evalglare of NREL's Radiance has them.
 *          They do not meet at the horizontal: at 30 degrees beside the line of sight 1.468
 *          from above and 1.462 from below, at 50 degrees 2.340 and 2.430. Nor is the second
 *          without a jump of its own, at R/D = 0.6, from 1.48 to 1.72. */

#define POSITION_INDEX_MAX 16.0

/* Guth. tau_deg: angle of the plane through line of sight and source from the vertical, 0 above
 * to 90 beside; sigma_deg: angle of the source from the line of sight, 0 to 90. */
double position_index_above(double tau_deg, double sigma_deg);

/* Iwata and Tokura. R is how far the source lies from the line of sight, D how far away it is
 * along it: R/D = tan sigma, counted as 3 where it is more. sigma_deg: 0 to 180. */
double position_index_below(double sigma_deg);

/* The index of a source in a direction of any length, in the head's axes: `forward` along the
 * line of sight, `up` perpendicular to it. At the height of the line of sight it counts as
 * above; what lies behind the eyes has POSITION_INDEX_MAX. */
double position_index(double right, double up, double forward);
