/* SPDX-License-Identifier: Apache-2.0 */
/* lab.h -- from linear Rec.709 to CIE L*a*b*.
 *
 * Units    linear light, 1 is white; L* 0 .. 100. Colours are taken relative to white:
 *          X / Xn, Y / Yn, Z / Zn.
 * Threads  pure functions.
 */
#pragma once
#include <stdint.h>
#include <string.h>

#include "image/colour.h"

/* Third root of a normal number above 0, relative error below 2e-14: a third of the exponent
 * (within 4 %), then Halley's iteration twice, which cubes the error each time. */
static inline double cube_root(double value) {
    union {
        double value;
        uint64_t bits;
    } root = {value};
    root.bits = root.bits / 3 + 0x2A9F789300000000ull;
    double x = root.value;
    for (int i = 0; i < 2; i++) {
        double cube = x * x * x;
        x *= (cube + 2 * value) / (2 * cube + value);
    }
    return x;
}

/* The f of CIE 15: a third root with a straight line below (6/29)^3. */
static inline double lab_curve(double ratio) {
    const double delta = 6.0 / 29;
    if (ratio > delta * delta * delta) return cube_root(ratio);
    return ratio / (3 * delta * delta) + 4.0 / 29;
}

static inline void lab_from_ratios(const double ratios[3], double lab[3]) {
    double x = lab_curve(ratios[0]), y = lab_curve(ratios[1]), z = lab_curve(ratios[2]);
    lab[0] = 116 * y - 16;
    lab[1] = 500 * (x - y);
    lab[2] = 200 * (y - z);
}

static inline void apply_matrix(const ColourMatrix *matrix, const double in[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = matrix->m[i][0] * in[0] + matrix->m[i][1] * in[1] + matrix->m[i][2] * in[2];
}

/* Rows divided by their sums: takes RGB to XYZ over that of white. */
static inline ColourMatrix relative_to_white(ColourMatrix xyz_from_rgb) {
    for (int i = 0; i < 3; i++) {
        double *row = xyz_from_rgb.m[i], white = row[0] + row[1] + row[2];
        for (int c = 0; c < 3; c++) row[c] /= white;
    }
    return xyz_from_rgb;
}

/* ratios_from_rgb: relative_to_white's; rgb is linear, 1 is white. Greys have a* = b* = 0
 * within 1e-11. */
static inline void lab_from_rgb(const ColourMatrix *ratios_from_rgb, const float rgb[3],
                                double lab[3]) {
    const double exact[3] = {(double)rgb[0], (double)rgb[1], (double)rgb[2]};
    double ratios[3];
    apply_matrix(ratios_from_rgb, exact, ratios);
    lab_from_ratios(ratios, lab);
}
