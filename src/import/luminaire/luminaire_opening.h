/* SPDX-License-Identifier: Apache-2.0 */
/* luminaire_opening.h -- the luminous opening that a luminaire file states by three sizes.
 *
 * Units    metres. Threads: pure functions.
 */
#pragma once
#include "spectrum/intensity_web.h"
#include "spectrum/luminous_opening.h"

/* Sizes of IES LM-63: width (along C = 90), length (along C = 0), height; round ones are
 * negative, by the table of the 2002 edition and, where that has none, of the 1995 one. year:
 * the file's edition, which decides what both have and mean otherwise. In type A the length
 * runs along (0, 0) and the height along V = 90. NULL, or why it is a point although it has
 * sizes. */
const char *opening_of_ies(int year, WebType type, const double size_m[3], LuminousOpening *out);

/* Sizes of EULUMDAT: length (along C = 90), width (along C = 0; 0: a circle of diameter
 * length), height. */
LuminousOpening opening_of_eulumdat(double length_m, double width_m, double height_m);
