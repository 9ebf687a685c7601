/* SPDX-License-Identifier: Apache-2.0 */
/* position_index.h -- how much less a glare source disturbs that is not looked at.
 *
 * 1 on the line of sight, more away from it, at most 16.
 *
 * Source   above the line of sight S. K. Guth, "A method for the evaluation of discomfort
 *          glare", Illum. Eng. 58 (1963) 351; below it T. Iwata and M. Tokura, "Position index
 *          for a glare source located below the line of vision", Light. Res. Technol. 29 (1997)
 *          172. Both as evalglare of NREL's Radiance has them.
 *          They do not meet at the horizontal: at 30 degrees beside the line of sight 1.468
 *          from above and 1.462 from below, at 50 degrees 2.340 and 2.430. Nor is the second
 *          without a jump of its own, at R/D = 0.6, from 1.48 to 1.72.
 * Units    degrees.
 * Threads  pure functions.
 * Fails    never.
 */
#pragma once

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
