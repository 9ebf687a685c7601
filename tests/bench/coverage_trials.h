/* SPDX-License-Identifier: Apache-2.0 */
/* coverage_trials.h -- how often intervals of many trials hold a true value, reported as a line
 * of words with tabs between them: for tests/bench/coverage.py.
 *
 * The truth is the mean of trials with other seeds, or, where the trials are their own, of all
 * of them: each is one part in hundreds of it. Its own error is reported, as a share of a
 * trial's.
 */
#pragma once
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/arena.h"
#include "base/error.h"

typedef struct Trial {
    double found, low, high, paths;
} Trial;

/* A mean, and its standard error. */
typedef struct Truth {
    double value, error;
} Truth;

static inline _Noreturn void trials_stop(const Error *err) {
    char line[2048];
    error_line(err, line, sizeof line);
    fprintf(stderr, "%s\n", line);
    exit(2);
}

static inline Truth trials_mean(const Trial *list, int count) {
    double sum = 0, squares = 0;
    for (int i = 0; i < count; i++) {
        sum += list[i].found;
        squares += list[i].found * list[i].found;
    }
    double mean = sum / count;
    return (Truth){mean, sqrt(fmax(squares / count - mean * mean, 0) / (count - 1))};
}

/* Of a trial about the truth, relative. */
static inline double trials_error(const Trial *list, int count, double truth) {
    double squares = 0;
    for (int i = 0; i < count; i++) squares += (list[i].found - truth) * (list[i].found - truth);
    return sqrt(squares / count) / truth;
}

/* moment, way, trials, held, lie below the truth, above, paths, error of a trial, half an
 * interval, the mean's offset, the truth's error; the last four in percent of the truth. */
static inline void trials_report(const char *moment, const char *way, const Trial *list, int count,
                                 Truth truth) {
    double paths = 0, half = 0;
    int held = 0, below = 0;
    for (int i = 0; i < count; i++) {
        held += list[i].low <= truth.value && truth.value <= list[i].high;
        below += list[i].high < truth.value;
        paths += list[i].paths / count;
        half += 0.5 * (list[i].high - list[i].low) / count;
    }
    double to_percent = 100 / truth.value;
    printf("%s\t%s\t%d\t%d\t%d\t%d\t%.0f\t%.3f\t%.3f\t%.3f\t%.3f\n", moment, way, count, held,
           below, count - held - below, paths, 100 * trials_error(list, count, truth.value),
           half * to_percent, (trials_mean(list, count).value - truth.value) * to_percent,
           truth.error * to_percent);
    fflush(stdout);
}
