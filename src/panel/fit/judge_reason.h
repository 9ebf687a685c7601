/* SPDX-License-Identifier: Apache-2.0 */
/* judge_reason.h -- the reasons against a fitted panel, as they are found; from where it needs
 * care, and from where it is not usable.
 *
 * Units    of limits: shares and relative errors of 1; degrees; cd m^-2. They stand in
 *          assets/guides/measuring-a-panel.md too.
 * Memory   the texts are in the JSON lists. Threads: one at a time. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"

typedef enum JudgeGrade { JUDGE_GOOD = 0, JUDGE_CARE, JUDGE_UNUSABLE } JudgeGrade;

typedef struct Judge {
    JudgeGrade grade;   /* of the worst reason */
    json_t *reasons[3]; /* texts, by grade */
    json_t *figures;    /* an object of what was judged */
    Arena *arena;
} Judge;

/* One more reason, as printf; none of JUDGE_GOOD. */
void judge_reason_add(Judge *judge, JudgeGrade grade, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* A figure for a sentence: two digits, or all before the point. */
const char *judge_rounded(const Judge *judge, double value);

/* The grade of a value that should be small. */
JudgeGrade judge_reason_grade(double value, double care, double unusable);

/* ---- limits ------------------------------------------------------------------------------ */

/* Samples beyond the bound beside five sigmas of noise; a bound below 2 % counts as 2 %, since
 * luminance meters are calibrated no better. One sample in fifty is an edge of the tables; half
 * of them is another panel, if the rms error below needs care too. */
#define JUDGE_LEAST_BOUND 0.02
#define JUDGE_BEYOND_CARE 0.02
#define JUDGE_BEYOND_UNUSABLE 0.5

/* Root of the mean squared relative error that noise does not explain. 10 % is where two
 * displays side by side look different; at 50 % the typical sample is another one. */
#define JUDGE_RMS_CARE 0.1
#define JUDGE_RMS_UNUSABLE 0.5

/* Error of a table's hemispherical integral: luminous flux, or albedo. It decides how much
 * light comes into the room: 5 % is the uncertainty of an integrating sphere in a good
 * laboratory, 25 % is a third of a stop. */
#define JUDGE_INTEGRAL_CARE 0.05
#define JUDGE_INTEGRAL_UNUSABLE 0.25

/* Directional-hemispherical reflectance that the tables state. Nothing gives back more light
 * than it got: 1 % is what sums over tables err by; a quarter too much is no noise but another
 * unit (BRDF times pi, a reflectance factor, per cent). */
#define JUDGE_ALBEDO_CARE 1.01
#define JUDGE_ALBEDO_UNUSABLE 1.25

/* Below a thousandth a panel is blacker than the blackest coatings that are sold. */
#define JUDGE_ALBEDO_LEAST 0.001

/* Noise that the tables themselves show, relative: up to here it can be separated from the
 * panel's own structure, beyond a half nothing can. */
#define JUDGE_NOISE_CARE 0.05
#define JUDGE_NOISE_UNUSABLE 0.5

/* Emission samples that stand out of their neighbours: hot pixels are few. */
#define JUDGE_OUTLIERS_CARE 0.01
#define JUDGE_OUTLIERS_UNUSABLE 0.1

/* Reflection values that are zero or below: a fifth is what a narrow peak leaves dark; a set
 * without one value in twenty has no haze to be fitted. */
#define JUDGE_ZEROS_CARE 0.2
#define JUDGE_ZEROS_UNUSABLE 0.95

/* Between azimuths further apart than this (eight around the circle) two-lobed and four-lobed
 * patterns cannot be resolved. Where all azimuths agree within 5 % and the noise, 6 are enough:
 * patterns of displays repeat twice or four times around the circle, not six times. */
#define JUDGE_GAP_DEG 45.0
#define JUDGE_GAP_ISOTROPIC 0.05
#define JUDGE_REPEAT_DEG 60.5

/* Luminance of white along the normal: displays show 2 to 30000 cd/m2, so a factor of 1000 in
 * the unit leaves this range at one end; a lamp may lie above, a display dimmed for the night
 * below. */
#define JUDGE_WHITE_LEAST 2.0
#define JUDGE_WHITE_MOST 30000.0

/* Black over white: 1 : 5 is no display in the dark. */
#define JUDGE_BLACK_MOST 0.2

/* Power law between two levels along the normal: displays have 1.8 to 2.6, and 10 is reached
 * only where tables are in different units or under each other's name; a level that shows less
 * than the one below falls. */
#define JUDGE_POWER_MOST 10.0
#define JUDGE_FALLING 0.98

/* White and the sum of the primaries: LCDs add up within 3 %. */
#define JUDGE_WHITE_APART 0.05

/* A level's colour counts from this share of full level on: below it is black's. */
#define JUDGE_LEVEL_LEAST 0.01

/* Each primary's share of white: blue, the least, has 3 to 10 %. */
#define JUDGE_PRIMARY_LEAST 0.003

/* Error of the BRDF near the mirror direction between its samples, estimated from samples
 * left out: the limit for mirror and haze too. */
#define JUDGE_HELD_OUT_CARE 0.05

/* The same between samples of an emission, or scattered ones of a reflection, in the one
 * direction that is worst, where two standard deviations are estimated: at 10 % one ring layout
 * in three would be a false alarm (tests/image/foreign_layouts.py). Of the light the limit of
 * samples left out. */
#define JUDGE_GAP_CARE 0.15

/* Noise of scattered samples, rms: laboratories' gonioreflectometers repeat within
 * 1 to 2 %. */
#define JUDGE_SPREAD_CARE 0.03

/* How reasons begin that name what the instrument could not see. */
#define JUDGE_COARSE "coarse: "
