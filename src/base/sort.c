/* SPDX-License-Identifier: Apache-2.0 */
#include "base/sort.h"

#include <stdlib.h>

static int by_float(const void *a, const void *b) {
    float p = *(const float *)a, q = *(const float *)b;
    return p < q ? -1 : p > q;
}

static int by_double(const void *a, const void *b) {
    double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

void sort_floats(float *value, long count) {
    qsort(value, (size_t)count, sizeof *value, by_float);
}

void sort_doubles(double *value, long count) {
    qsort(value, (size_t)count, sizeof *value, by_double);
}

/* Hoare's selection: the part that holds the rank shrinks until its values are alike. */
float sort_ranked(float *value, long count, long rank) {
    long low = 0, high = count - 1;
    while (low < high) {
        float pivot = value[low + (high - low) / 2];
        long i = low, k = high;
        while (i <= k) {
            while (value[i] < pivot) i++;
            while (pivot < value[k]) k--;
            if (i > k) break;
            float moved = value[i];
            value[i++] = value[k];
            value[k--] = moved;
        }
        if (rank <= k) high = k;
        else if (rank >= i) low = i;
        else break;
    }
    return value[rank];
}

double sort_median(double *value, int count) {
    sort_doubles(value, count);
    return value[count / 2];
}

int sort_distinct(float *value, int count, float apart) {
    int kept = 0;
    sort_floats(value, count);
    for (int i = 0; i < count; i++)
        if (!kept || value[i] - value[kept - 1] > apart) value[kept++] = value[i];
    return kept;
}
