/* SPDX-License-Identifier: Apache-2.0 */
/* grey_steps.h -- what an eye can just tell apart: luminance counted in just noticeable
 * differences, and the faintest grating.
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

/* ---- the least contrast that an eye can see ----------------------------------------------
 *
 * Source   P. G. J. Barten, "Formula for the contrast sensitivity of the human eye", Proc. SPIE
 *          5294 (2003) 231, the simplified formula; read in gfxdisp/motion_quality_20. */

/* One over the Michelson contrast of the faintest grating that is just seen:
 *     5200 exp(-0.0016 u^2 (1 + 100/L)^0.08)
 *     / sqrt((1 + 144/X^2 + 0.64 u^2) (63/L^0.83 + 1/(1 - exp(-0.02 u^2))))
 * u: cycles_per_degree, above 0; L: luminance_cd_m2, above 0; X: size_deg, the square root of
 * the grating's area, above 0. NaN otherwise. */
double contrast_sensitivity(double cycles_per_degree, double luminance_cd_m2, double size_deg);
