/* SPDX-License-Identifier: Apache-2.0 */
/* privacy.h -- how surely somebody who looks at a display from aside cannot read it: its visual
 * security.
 *
 *     V = (Y + R) / (Y - K),  S = log10 V
 *
 * Y and K are the luminances that the display sends towards who must not read it, of white and
 * of black, here of the brighter and the darker part of what is shown; R is what it reflects
 * towards the same eye. 1/V is the contrast that is left, relative to the picture's white: with
 * the contrast ratio C = (Y + R)/(K + R) it is 1 - 1/C. So V falls as the contrast rises, and
 * as light falls on the display it rises: the worst is a dark night.
 *
 * Source   V and S: US 11,106,103 B2 (read). That S of 1 and more is "obscured", and from 1.5
 *          on "invisible", is commonly said of it; no source of these two was read.
 * Units    cd m^-2; V and S without a unit.
 * Threads  pure functions.
 * Fails    never: NaN of what is NaN or below 0.
 */
#pragma once

#define SECURITY_OBSCURED 1.0  /* S as it is commonly said: not read */
#define SECURITY_INVISIBLE 1.5 /* likewise */

/* V, at least 1 where black is not below 0; infinite where Y is not above K: there is no
 * picture. */
double privacy_security(double white, double black, double reflected);

/* S of a V. */
double privacy_s(double security);

/* V of a contrast ratio, 1 to infinity: infinite of 1, 1 of an infinite one; and S of it. Both
 * fall as the ratio rises. */
double privacy_security_of_contrast(double ratio);
double privacy_s_of_contrast(double ratio);

/* The way back, of S from 0 on. */
double privacy_contrast_of_s(double s);
