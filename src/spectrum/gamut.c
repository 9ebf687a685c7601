/* SPDX-License-Identifier: Apache-2.0 */
#include "spectrum/gamut.h"

#include <math.h>

#include "spectrum/illuminant.h"
#include "spectrum/photometry.h"

/* ---- triangles --------------------------------------------------------------------------- */

const char *gamut_name(GamutStandard standard) {
    static const char *const NAMES[] = {"sRGB", "DCI-P3", "BT.2020"};
    return NAMES[standard];
}

GamutTriangle gamut_triangle(GamutStandard standard) {
    static const GamutTriangle XY[] = {{{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}},
                                       {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}},
                                       {{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}}};
    return XY[standard];
}

GamutTriangle gamut_in_uv(const GamutTriangle *xy) {
    GamutTriangle out;
    for (int p = 0; p < 3; p++) {
        double d = -2 * xy->at[p][0] + 12 * xy->at[p][1] + 3;
        out.at[p][0] = 4 * xy->at[p][0] / d;
        out.at[p][1] = 9 * xy->at[p][1] / d;
    }
    return out;
}

typedef struct GamutPolygon {
    int count;
    double at[8][2];
} GamutPolygon;

static double area_of(const GamutPolygon *p) {
    double sum = 0;
    for (int i = 0; i < p->count; i++) {
        const double *a = p->at[i], *b = p->at[(i + 1) % p->count];
        sum += a[0] * b[1] - b[0] * a[1];
    }
    return 0.5 * sum;
}

static GamutPolygon polygon_of(const GamutTriangle *triangle) {
    GamutPolygon out = {.count = 3};
    for (int p = 0; p < 3; p++)
        for (int c = 0; c < 2; c++) out.at[p][c] = triangle->at[p][c];
    return out;
}

/* Above 0 inside the edge of a triangle that turns to the left. */
static double side_of(const GamutTriangle *clip, int edge, const double at[2]) {
    const double *a = clip->at[edge], *b = clip->at[(edge + 1) % 3];
    return (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]);
}

static void append(GamutPolygon *out, double x, double y) {
    if (out->count == 8) return;
    out->at[out->count][0] = x;
    out->at[out->count++][1] = y;
}

/* I. E. Sutherland and G. W. Hodgman, Reentrant polygon clipping, CACM 17 (1974): one edge. */
static GamutPolygon clipped(const GamutPolygon *p, const GamutTriangle *clip, int edge) {
    GamutPolygon out = {.count = 0};
    for (int i = 0; i < p->count; i++) {
        const double *from = p->at[i], *to = p->at[(i + 1) % p->count];
        double a = side_of(clip, edge, from), b = side_of(clip, edge, to);
        if (a >= 0) append(&out, from[0], from[1]);
        if ((a >= 0) == (b >= 0)) continue;
        double t = a / (a - b);
        append(&out, from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]));
    }
    return out;
}

double gamut_area(const GamutTriangle *panel, const GamutTriangle *standard) {
    GamutPolygon own = polygon_of(panel), other = polygon_of(standard);
    return fabs(area_of(&own) / area_of(&other));
}

double gamut_coverage(const GamutTriangle *panel, const GamutTriangle *standard) {
    GamutPolygon both = polygon_of(panel), other = polygon_of(standard);
    if (area_of(&both) <= 0) return 0;
    for (int edge = 0; edge < 3; edge++) both = clipped(&both, standard, edge);
    return area_of(&both) / area_of(&other);
}

/* ---- colour temperature ------------------------------------------------------------------ */

#define LARGEST_DUV 0.05

/* CIE 1960 u, v of a black body of 1e6 / mired kelvin. */
static void locus_at(double mired, double uv[2]) {
    double xyz[3] = {0, 0, 0};
    for (int nm = 360; nm <= 830; nm += 5) {
        SpectralRow row = spectral_row(nm);
        double light = black_body_radiance(nm, 1e6 / mired);
        xyz[0] += light * (double)row.x;
        xyz[1] += light * (double)row.y;
        xyz[2] += light * (double)row.z;
    }
    double d = xyz[0] + 15 * xyz[1] + 3 * xyz[2];
    uv[0] = 4 * xyz[0] / d;
    uv[1] = 6 * xyz[1] / d;
}

static double distance_at(double mired, const double uv[2]) {
    double on[2];
    locus_at(mired, on);
    double du = uv[0] - on[0], dv = uv[1] - on[1];
    return sqrt(du * du + dv * dv);
}

/* The distance has one minimum along the locus as near to it as this is defined: mireds, which
 * the eye finds even, are cut by the golden section. */
ColourTemperature colour_temperature(const double uv[2]) {
    const double golden = 0.6180339887498949, uv60[2] = {uv[0], uv[1] * 2 / 3};
    double low = 1e6 / CCT_MOST_K * 0.98, high = 1e6 / CCT_LEAST_K * 1.02, on[2];
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = distance_at(a, uv60), at_b = distance_at(b, uv60);
    for (int i = 0; i < 40; i++) {
        if (at_a < at_b) {
            high = b, b = a, at_b = at_a;
            a = high - golden * (high - low), at_a = distance_at(a, uv60);
        } else {
            low = a, a = b, at_a = at_b;
            b = low + golden * (high - low), at_b = distance_at(b, uv60);
        }
    }
    double mired = 0.5 * (low + high), kelvin = 1e6 / mired, away = distance_at(mired, uv60);
    locus_at(mired, on);
    double duv = uv60[1] < on[1] ? -away : away;
    return (ColourTemperature){
        kelvin, duv, kelvin >= CCT_LEAST_K && kelvin <= CCT_MOST_K && away <= LARGEST_DUV};
}
