/* SPDX-License-Identifier: Apache-2.0 */
/* bench_timing.h -- the clock of the benches and the median of their runs.
 *
 * Units   seconds of processor time; the clock says whose: CLOCK_THREAD_CPUTIME_ID leaves other
 *         work on the machine out, CLOCK_MONOTONIC is the time that passes.
 */
#pragma once
#include <stdlib.h>
#include <time.h>

static inline double clock_seconds(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Of this thread alone. */
static inline double thread_seconds(void) {
    return clock_seconds(CLOCK_THREAD_CPUTIME_ID);
}

static inline int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts the runs, so that the first is the least and the last the most; returns the median. */
static inline double median_of(double *runs, int count) {
    qsort(runs, (size_t)count, sizeof *runs, ascending);
    return runs[count / 2];
}
