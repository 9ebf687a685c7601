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
    double position_index; /* vision/position_index.h, at least 1 */
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
