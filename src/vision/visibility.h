/* SPDX-License-Identifier: Apache-2.0 */
/* visibility.h -- how far a target stands above what somebody just sees: the least difference
 * of luminance for its size, the observer's age, a glance and what the eye is adapted to; and
 * the visibility level, how many times that difference it has.
 *
 *     dL = 2.6 (sqrt(phi)/alpha + sqrt(L))^2 x AF x FCP x TF
 *     VL = |Lt - Lb| / dL
 *
 * alpha is the target's size; phi and L hang on the luminance that the eye is adapted to: that
 * of the background, with the veil of stray light added. AF: age; FCP: a target darker than its
 * background is seen by less; TF: a glance of less than 2 s. The factor 2.6 was read with the
 * formula; that it is for a target which is seen nearly always, and that 1 in its place is for
 * one that every other glance sees, is as it is commonly quoted.
 *
 * Source   W. Adrian, "Visibility of targets: model for calculation", Lighting Res. Technol. 21
 *          (1989) 181; not read itself but as two programs have it, the whole in
 *          fglichttechnik/VisibilityLevel-Evaluation-MATLAB (TU Berlin), calcDeltaL.m.
 * Range    ages of 23 to 75 years: NaN elsewhere. No ends of luminance are published. What is
 *          doubtful within the range is told by visibility_doubts.
 * People   tests/bench/visibility.py holds it against discs that people saw.
 * Units    cd m^-2, arc minutes, years, seconds.
 * Threads  pure functions; the same bits on every machine.
 * Fails    never: NaN outside of the ranges.
 */
#pragma once
#include <stdbool.h>

#define VISIBILITY_AGE_MIN 23.0 /* years */
#define VISIBILITY_AGE_MAX 75.0
/* where AF falls from 1.9275 to 1.9009, though it should rise */
#define VISIBILITY_AGE_JUMP 64.0
#define VISIBILITY_GLANCE_LONG 2.0  /* s: from here on the glance's time counts for nothing */
#define VISIBILITY_SIZE_LARGE 60.0  /* arc minutes: whether TF holds above is open */
#define VISIBILITY_DARKER_MIN 0.004 /* cd m^-2: no FCP is published up to here; 1 counts */
/* cd m^-2: the formula was held against people (above) between these. */
#define VISIBILITY_PEOPLE_MIN 0.02
#define VISIBILITY_PEOPLE_MAX 200.0

typedef struct VisibilityTarget {
    double size_arcmin;   /* alpha, above 0 */
    double adapted_cd_m2; /* background and veil, above 0 */
    double age_years;     /* VISIBILITY_AGE_MIN .. _MAX */
    double glance_s;      /* above 0; infinite: as long as it takes */
    bool is_darker;       /* than its background */
} VisibilityTarget;

/* dL. */
double visibility_threshold(const VisibilityTarget *target);

/* VL of a target that differs from its background by so much, either way. */
double visibility_level(const VisibilityTarget *target, double difference_cd_m2);

/* AF: (A - 19)^2/2160 + 0.99 below 64 years, (A - 56.6)^2/116.3 + 1.43 from there on. */
double visibility_age_factor(double age_years);

/* FCP of a target that is darker, without age and glance; 1 up to VISIBILITY_DARKER_MIN:
 *     1 - m alpha^-beta / (2.4 dL),   m = 10^-(10^-(c (lg L + 1)^2 + 0.0245))
 * beta = 0.6 L^-0.1488; c = 0.125 from 0.1 cd/m2 on, 0.075 below; dL of the lighter target, its
 * factor 2.6 included. */
double visibility_polarity_factor(double size_arcmin, double adapted_cd_m2);

/* TF = (a + t)/t, 1 from VISIBILITY_GLANCE_LONG on; a = sqrt(a1^2 + a2^2)/2.1 of
 *     a1 = 0.36 - 0.0972 x^2/(x^2 - 2.513 x + 2.7895),    x = lg alpha + 0.523
 *     a2 = 0.355 - 0.1217 y^2/(y^2 - 10.4 y + 52.28),     y = lg L + 6
 * Above VISIBILITY_SIZE_LARGE the program that it was read in puts 1 and asks whether that is
 * right; here the formula goes on, which asks for more. */
double visibility_glance_factor(double size_arcmin, double adapted_cd_m2, double glance_s);

/* ---- where it is doubtful ---------------------------------------------------------------- */

typedef enum VisibilityDoubt {
    VISIBILITY_DOUBT_AGE,       /* outside of the published ages: no level */
    VISIBILITY_DOUBT_JUMP,      /* within a year of the jump of AF */
    VISIBILITY_DOUBT_GLANCE,    /* TF above VISIBILITY_SIZE_LARGE */
    VISIBILITY_DOUBT_DARKER,    /* FCP where none is published */
    VISIBILITY_DOUBT_LUMINANCE, /* outside of where it was held against people */
    VISIBILITY_DOUBTS
} VisibilityDoubt;

/* Bits 1 << VisibilityDoubt; 0: none. */
unsigned visibility_doubts(const VisibilityTarget *target);
