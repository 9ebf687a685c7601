/* SPDX-License-Identifier: Apache-2.0 */
#include "base/sort.h"

#include <stdlib.h>

static int by_float(const void *a, const void *b)
{
    float p = *(const float *)a, q = *(const float *)b;
    return p < q ? -1 : p > q;
}

static int by_double(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

void sort_floats(float *value, long count)
{
    qsort(value, (size_t)count, sizeof *value, by_float);
}

void sort_doubles(double *value, long count)
{
    qsort(value, (size_t)count, sizeof *value, by_double);
}

double sort_median(double *value, int count)
{
    sort_doubles(value, count);
    return value[count / 2];
}

int sort_distinct(float *value, int count, float apart)
{
    int kept = 0;
    sort_floats(value, count);
    for (int i = 0; i < count; i++)
        if (!kept || value[i] - value[kept - 1] > apart) value[kept++] = value[i];
    return kept;
}
