/* SPDX-License-Identifier: Apache-2.0 */
/* twice.h -- what is measured twice: how far apart two measurements of one thing are, and the
 * one way in which that is said.
 *
 * Memory   texts from the arena. Threads: pure functions. Fails: never.
 */
#pragma once
#include "base/arena.h"

typedef struct Twice {
    const char *thing;  /* "red" */
    const char *by[2];  /* "its spectrum", "its table" */
    double apart, most; /* most: up to which they are one, by what instruments miss */
    const char *unit;   /* behind a figure, with its space: " in u'v'", " %", " h" */
} Twice;

/* A share of the larger; 0 where both are 0. */
double twice_share(double a, double b);

/* Of two colours, XYZ above 0: delta u'v' (CIE 1976). */
double twice_colour(const double a[3], const double b[3]);

/* Further apart than one thing is; also where that is not a number. */
bool twice_differ(const Twice *twice);

/* Of a picture and of what it fills, width over height each: pixels need not be quite square. */
Twice twice_shape(const char *thing, double picture, double place, Arena *arena);

/* "red: its spectrum and its table are 0.0012 in u'v' apart, required: at most 0.01". */
const char *twice_text(const Twice *twice, Arena *arena);
