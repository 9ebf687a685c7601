/* SPDX-License-Identifier: Apache-2.0 */
/* light_parts.h -- which part of what an eye looks at sends it most light, or least.
 *
 * What is looked at lies in equal cells, a target each; a part is a window of some columns and
 * rows of them, slid over all in steps of one. Cells that the eye does not see do not count,
 * nor do windows of which clearly less is seen than of others.
 *
 * Units    of the values that are passed in; the worst part has the greatest mean, or the
 *          least (takes_least).
 * Threads  pure functions.
 */
#pragma once
#include "kernel/aim.h"

typedef struct LightParts {
    ProbeAim aim;       /* a target and its patch for each cell that is seen */
    const int *cell_of; /* [target] row by row */
    int columns, rows;  /* of cells */
    int wide, high;     /* cells of a window; no more than there are */
    bool takes_least;   /* of what must not be read: least light hides it least */
} LightParts;

int light_parts_count(const LightParts *parts);

/* First column and row of a part. */
void light_parts_place(const LightParts *parts, int part, int *column, int *row);

/* Sets means[part], over the cells of each that are seen, of values[target]; NaN: the part does
 * not count. Returns the worst, of equal ones the nearest to the middle; -1: nothing is
 * seen. counts: [part] how many cells are seen; NULL: not requested. */
int light_parts_worst(const LightParts *parts, const double *values, double *means, int *counts,
                      Arena scratch);

/* Light that samples found at a target. */
typedef struct TargetLight {
    float paths, sum, squares;
} TargetLight;

#define LIGHT_PARTS_ALL (-1) /* in place of a part: all that is seen */

/* The worst part by known[target] and what samples found besides; LIGHT_PARTS_ALL where no part
 * stands out. Parts that differ by no more than chance does would be chosen by luck, not by
 * light: the even rise of what samples found counts, and what they found beside that, each by
 * the share that chance does not explain (Efron and Morris, J. Am. Stat. Assoc. 70 (1975) 311).
 * Samples have a say only where a part is worse than that of what is known, or than all, by two
 * standard errors. */
int light_parts_choose(const LightParts *parts, const TargetLight *sampled, const double *known,
                       Arena scratch);
