/* SPDX-License-Identifier: Apache-2.0 */
/* grey_steps.h -- luminance counted in just noticeable differences.
 *
 * Source   DICOM PS3.14, Grayscale Standard Display Function: j = 1 .. 1023 steps from 0.05 to
 *          3993 cd m^-2, a fit to Barten's model for a target of 2 degrees with 4 cycles per
 *          degree. The standard gives a formula for each direction; they differ by less than
 *          0.1 steps (tests/unit/test_vision.c).
 * Units    cd m^-2; steps without a unit.
 * Threads  pure functions.
 * Fails    never: NaN outside the range.
 */
#pragma once

#define GREY_STEPS_MIN 1.0
#define GREY_STEPS_MAX 1023.0
#define GREY_STEPS_MIN_CD_M2 0.0499
#define GREY_STEPS_MAX_CD_M2 3994.0

/* L of j: step 1 .. 1023. */
double grey_steps_luminance(double step);

/* j of L: GREY_STEPS_MIN_CD_M2 .. _MAX_CD_M2. */
double grey_steps_of(double luminance_cd_m2);

/* Steps between two luminances, 0 or more. */
double grey_steps_between(double one_cd_m2, double other_cd_m2);
