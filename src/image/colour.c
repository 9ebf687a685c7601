/* SPDX-License-Identifier: Apache-2.0 */
#include "image/colour.h"

static double determinant(const ColourMatrix *a) {
    const double(*m)[3] = a->m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

ColourMatrix colour_inverse(const ColourMatrix *a) {
    const double(*m)[3] = a->m;
    double d = determinant(a);
    ColourMatrix out = {{{0}}};
    if (fabs(d) < 1e-12) return out;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            int p = (j + 1) % 3, q = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
            out.m[i][j] = (m[p][r] * m[q][s] - m[p][s] * m[q][r]) / d;
        }
    }
    return out;
}

ColourMatrix colour_product(const ColourMatrix *a, const ColourMatrix *b) {
    ColourMatrix out = {{{0}}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) out.m[i][j] += a->m[i][k] * b->m[k][j];
    return out;
}

/* SMPTE RP 177: the columns are the primaries' (x, y, z), scaled so that (1,1,1) is the white
 * with Y = 1. */
ColourMatrix xyz_from_primaries(const double c[8]) {
    ColourMatrix out = {{{0}}}, columns;
    for (int k = 0; k < 3; k++) {
        columns.m[0][k] = c[2 * k];
        columns.m[1][k] = c[2 * k + 1];
        columns.m[2][k] = 1 - c[2 * k] - c[2 * k + 1];
    }
    ColourMatrix from_xyz = colour_inverse(&columns);
    double white[3] = {c[6] / c[7], 1, (1 - c[6] - c[7]) / c[7]};
    for (int k = 0; k < 3; k++) {
        double scale = 0;
        for (int j = 0; j < 3; j++) scale += from_xyz.m[k][j] * white[j];
        for (int i = 0; i < 3; i++) out.m[i][k] = columns.m[i][k] * scale;
    }
    return out;
}

ColourMatrix rec709_from_primaries(const double chromaticities[8]) {
    ColourMatrix xyz = xyz_from_primaries(chromaticities);
    ColourMatrix rec709 = xyz_from_primaries(REC709_CHROMATICITIES);
    ColourMatrix from_xyz = colour_inverse(&rec709);
    return colour_product(&from_xyz, &xyz);
}

bool chromaticities_are_usable(const double c[8]) {
    for (int k = 0; k < 8; k++)
        if (!(fabs(c[k]) < 100)) return false;
    if (!(fabs(c[7]) > 1e-6)) return false;
    ColourMatrix xyz = xyz_from_primaries(c);
    return fabs(determinant(&xyz)) > 1e-9;
}

bool chromaticities_are_rec709(const double c[8]) {
    for (int k = 0; k < 8; k++)
        if (!(fabs(c[k] - REC709_CHROMATICITIES[k]) <= 0.001)) return false;
    return true;
}
