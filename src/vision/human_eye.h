/* SPDX-License-Identifier: Apache-2.0 */
/* human_eye.h -- whose eye it is: what the spread of light inside it depends on.
 *
 * Units    years; pigment of the iris without a unit: 0 very dark, 0.5 brown, 1 green, 1.2
 *          light blue (the scale of CIE 146:2002, as the comments of HDR-VDP have it).
 * Memory   plain data. Threads: pure functions.
 * Fails    parsing and checking do, with what was found and what is required.
 */
#pragma once
#include <stdbool.h>

#include "base/error.h"

#define HUMAN_EYE_AGE_MIN 10.0
#define HUMAN_EYE_AGE_MAX 100.0
#define HUMAN_EYE_PIGMENT_MAX 1.2
#define HUMAN_EYE_PIGMENT_USUAL 0.5 /* brown, what most people have */

typedef struct HumanEye {
    double age_years; /* HUMAN_EYE_AGE_MIN .. _MAX */
    double pigment;   /* 0 .. HUMAN_EYE_PIGMENT_MAX */
} HumanEye;

/* "AGE" or "AGE,PIGMENT" and nothing else; without the second a brown eye. The error's text
 * begins with what was found. */
bool human_eye_parse(const char *text, HumanEye *out, Error *err);
