/* SPDX-License-Identifier: Apache-2.0 */
/* sort.h -- numbers in rising order. None of them is NaN. */
#pragma once

void sort_floats(float *value, long count);
void sort_doubles(double *value, long count);

/* The value that would stand at `rank`, 0 .. count - 1, if all were sorted; reorders them. */
float sort_ranked(float *value, long count, long rank);

/* Sorts; then the value that half of the others are below. count: at least 1. */
double sort_median(double *value, int count);

/* Sorts floats and keeps those more than `apart` above the one kept before; how many. */
int sort_distinct(float *value, int count, float apart);
