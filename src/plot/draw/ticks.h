/* SPDX-License-Identifier: Apache-2.0 */
/* ticks.h -- round numbers for axes, contour lines and colour bars, and their labels.
 *
 * Threads  pure functions.
 */
#pragma once
#include <stdbool.h>

#define TICKS_MAX 64

typedef struct Ticks {
    int count;
    double value[TICKS_MAX];
    bool is_labelled[TICKS_MAX]; /* false: a minor tick of a logarithmic axis */
    double step;                 /* linear: between ticks; logarithmic: 0 */
} Ticks;

/* Multiples of 1, 2, 2.5 or 5 times a power of ten in [low, high]: as many as possible, at most
 * `most` (2 or more). */
Ticks ticks_linear(double low, double high, int most);

/* Multiples of `step` in [low, high]. */
Ticks ticks_every(double step, double low, double high);

/* 0 < low < high: decades, labelled as often as `most` allows; 2 and 5 labelled too where there
 * is room, the other digits are minor ticks where one decade has room for them. */
Ticks ticks_log(double low, double high, int most);

/* The next 1, 2 or 5 times a power of ten at or above (below) value > 0. */
double round_up(double value);
double round_down(double value);

/* A number for a tick: "0.25" with as many decimals as the step needs, "10⁻⁴" (UTF-8) beyond
 * 10^-3 and 10^5 when step is 0. Returns text. */
char *tick_text(double value, double step, char text[32]);

/* Three significant digits without an exponent where that is short: "912", "0.0132", "3.1e-06"
 * as "3.1·10⁻⁶". */
char *figure_text(double value, char text[32]);
