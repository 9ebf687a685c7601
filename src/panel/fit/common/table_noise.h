/* SPDX-License-Identifier: Apache-2.0 */
/* table_noise.h -- how noisy a measured table is, estimated from it alone.
 *
 * Smooth data leave nearly nothing of high differences of neighbours; noise of standard
 * deviation s leaves s sqrt(sum of squared binomials), so the median of their sizes over that
 * root and over a normal distribution's median is s. Structure only adds to a difference:
 * the least over orders 3, 5 and 7, rings and meridians, values and logarithms is taken.
 *
 * Threads  pure functions. Fails: never; 0 when fewer than 16 differences can be had.
 */
#pragma once
#include "panel/set/angle_table.h"

/* Noise of a channel, relative to its values, inside 70 degrees. */
double table_noise_relative(const AngleTable *table, int channel, Arena scratch);

/* In the channel's unit on the dimmest rings (the last tenth of theta), where only what does
 * not scale with light is left. */
double table_noise_dim(const AngleTable *table, int channel, Arena scratch);

/* In the channel's unit over all rows. */
double table_noise_plain(const AngleTable *table, int channel, Arena scratch);
