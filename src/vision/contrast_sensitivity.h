/* SPDX-License-Identifier: Apache-2.0 */
/* contrast_sensitivity.h -- the least contrast that an eye can see.
 *
 * Source   P. G. J. Barten, "Formula for the contrast sensitivity of the human eye", Proc. SPIE
 *          5294 (2003) 231, the simplified formula; read in gfxdisp/motion_quality_20.
 * Units    cycles per degree, cd m^-2, degrees.
 * Threads  pure functions.
 */
#pragma once

/* One over the Michelson contrast of the faintest grating that is just seen:
 *     5200 exp(-0.0016 u^2 (1 + 100/L)^0.08)
 *     / sqrt((1 + 144/X^2 + 0.64 u^2) (63/L^0.83 + 1/(1 - exp(-0.02 u^2))))
 * u: cycles_per_degree, above 0; L: luminance_cd_m2, above 0; X: size_deg, the square root of
 * the grating's area, above 0. NaN otherwise. */
double contrast_sensitivity(double cycles_per_degree, double luminance_cd_m2, double size_deg);
