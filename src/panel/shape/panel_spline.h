/* SPDX-License-Identifier: Apache-2.0 */
/* panel_spline.h -- the smooth part of a tree's components as a few numbers, and the table that
 * a query reads instead. Private to src/panel.
 *
 * P_k(theta, phi) = sum over terms of angle(phi) (sum of B-splines(theta) + power ln cos
 * theta),
 * angle = 1, cos phi, sin phi, cos 2 phi ... (term 0, 1, 2, 3 ...). The B-splines are cubic, on
 * knots every 5 degrees, every 2.5 beyond 70; they are mirrored at the pole with the parity
 * that a smooth function of direction has there. ln cos theta is how light ends at the horizon.
 *
 * Stored     PanelSplineHead | uint8 term[terms] | uint8 width[terms][components] (bytes a
 *            number: 0 absent, 1, 2) | numbers of the present blocks, PANEL_SPLINE_NUMBERS
 *            each: multiples of step 2^-exponent; all 2-byte blocks first.
 * Threads    pure functions. Fails: only panel_spline_open, on bytes that are not whole.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/vec.h"

#define PANEL_SPLINE_COEFFICIENTS 24 /* B-splines */
#define PANEL_SPLINE_NUMBERS 25      /* and the power of cos theta */
#define PANEL_SPLINE_TERMS_MAX 17
#define PANEL_SPLINE_ANGLES 181 /* of the table: even in tan(theta / 2), which costs no arc */

/* B-splines that are not zero at an angle, in stored coefficients. */
typedef struct PanelSplineTaps {
    int first;
    float weight[4];
} PanelSplineTaps;

/* theta in [0, pi/2]; harmonic: m of cos m phi, which fixes the parity at the pole. */
PanelSplineTaps panel_spline_taps(int harmonic, double theta);

/* The harmonic of a term. */
static inline int panel_spline_harmonic(int term) {
    return (term + 1) / 2;
}

/* Ready for queries. table[angle][term][stride], power[term][stride]. */
typedef struct PanelSpline {
    int terms, stride; /* stride: a multiple of 4 */
    int harmonics;     /* the highest */
    uint8_t term[PANEL_SPLINE_TERMS_MAX];
    const float *table, *power;
} PanelSpline;

/* The table of numbers [terms][components][PANEL_SPLINE_NUMBERS]. term: rising. */
void panel_spline_expand(const uint8_t *term, int terms, int components, const float *numbers,
                         Arena *arena, PanelSpline *out);

/* Packs such numbers; blocks not worth a step are left out, and terms without blocks too.
 * step[k]: the coarsest rounding that component k bears. *bytes in the arena. */
typedef struct PanelSplineNumbers {
    const uint8_t *term; /* rising */
    int terms, components;
    const float *numbers, *step;
} PanelSplineNumbers;
size_t panel_spline_pack(const PanelSplineNumbers *in, Arena *arena, const void **bytes);

/* Checks and expands stored bytes; *used: how many of them. False: not a spline of so many
 * components. */
bool panel_spline_open(const void *bytes, size_t size, int components, Arena *arena,
                       PanelSpline *out, size_t *used);
