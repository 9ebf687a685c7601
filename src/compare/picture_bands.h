/* SPDX-License-Identifier: Apache-2.0 */
/* picture_bands.h -- two large pictures of codes, compared in bands of rows.
 *
 * A band has as many rows around it as a filter reaches, so that no value depends on where it
 * begins; sums go on from band to band in the order of the pixels. All figures have the bits
 * that they would have of whole pictures. There are no maps at the end, and so no pictures of
 * them in a report.
 *
 * Memory   what is packed (4 bytes a pixel and side, 8 of 16 bits), 5 more a pixel for one map
 *          and the selection, and a band of both sides. Threads: the options' for FLIP.
 * Fails    never.
 */
#pragma once
#include "compare/comparison.h"

/* The findings of channels_compare, without its map of differing pixels. `out` has its sides
 * and its selection. */
ChannelDifferences picture_bands_channels(const CompareOptions *options, const Comparison *out,
                                          Arena *arena);

/* Values of `out`, and a note of what is left out. groups: GROUP_... bits. */
void picture_bands_measure(const CompareOptions *options, unsigned groups, Arena scratch,
                           Comparison *out);
