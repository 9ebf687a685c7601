/* SPDX-License-Identifier: Apache-2.0 */
/* flip_reference.h -- LDR-FLIP once more, as slow and as near to the papers as it can be: in
 * double precision, with the C library, with filters over the plane that are summed as they
 * stand. It shares no line with src/compare.
 */
#pragma once
#include <math.h>
#include <stdlib.h>

#include "compare/metrics/planes.h"

enum { SLOW_RADIUS_MAX = 40 };

typedef struct SlowKernel {
    int radius;
    double w[2 * SLOW_RADIUS_MAX + 1][2 * SLOW_RADIUS_MAX + 1];
} SlowKernel;

static const double SLOW_PI = 3.14159265358979323846;
static const double SLOW_WHITE[3] = {0.950428545, 1.0, 1.088900371};

static void slow_xyz(const double rgb[3], double xyz[3]) {
    xyz[0] = (10135552 * rgb[0] + 8788810 * rgb[1] + 4435075 * rgb[2]) / 24577794;
    xyz[1] = (2613072 * rgb[0] + 8788810 * rgb[1] + 887015 * rgb[2]) / 12288897;
    xyz[2] = (1425312 * rgb[0] + 8788810 * rgb[1] + 70074185 * rgb[2]) / 73733382;
}

static void slow_ycxcz(const double rgb[3], double out[3]) {
    double xyz[3];
    slow_xyz(rgb, xyz);
    for (int i = 0; i < 3; i++) xyz[i] /= SLOW_WHITE[i];
    out[0] = 116 * xyz[1] - 16;
    out[1] = 500 * (xyz[0] - xyz[1]);
    out[2] = 200 * (xyz[1] - xyz[2]);
}

/* The published inverse of slow_xyz's matrix, to nine decimals. */
static void slow_rgb(const double ycxcz[3], double rgb[3]) {
    double y = (ycxcz[0] + 16) / 116;
    double x = (y + ycxcz[1] / 500) * SLOW_WHITE[0], z = (y - ycxcz[2] / 200) * SLOW_WHITE[2];
    rgb[0] = 3.241003275 * x - 1.537398934 * y - 0.498615861 * z;
    rgb[1] = -0.969224334 * x + 1.875930071 * y + 0.041554224 * z;
    rgb[2] = 0.055639423 * x - 0.204011202 * y + 1.057148933 * z;
    for (int c = 0; c < 3; c++) rgb[c] = fmin(fmax(rgb[c], 0), 1);
}

static void slow_hunt_lab(const double rgb[3], double lab[3]) {
    double xyz[3], f[3];
    slow_xyz(rgb, xyz);
    for (int i = 0; i < 3; i++) {
        double t = xyz[i] / SLOW_WHITE[i], d = 6.0 / 29;
        f[i] = t > d * d * d ? cbrt(t) : t / (3 * d * d) + 4.0 / 29;
    }
    lab[0] = 116 * f[1] - 16;
    lab[1] = 0.01 * lab[0] * 500 * (f[0] - f[1]);
    lab[2] = 0.01 * lab[0] * 200 * (f[1] - f[2]);
}

static double slow_hyab(const double a[3], const double b[3]) {
    return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
}

/* FLIP's colour difference of two colours that fill the whole picture: its closed form. */
static double slow_colour_difference(const double a[3], const double b[3]) {
    double la[3], lb[3], green[3], blue[3];
    slow_hunt_lab((const double[3]){0, 1, 0}, green);
    slow_hunt_lab((const double[3]){0, 0, 1}, blue);
    slow_hunt_lab(a, la);
    slow_hunt_lab(b, lb);
    double most = pow(slow_hyab(green, blue), 0.7), d = pow(slow_hyab(la, lb), 0.7);
    if (d < 0.4 * most) return d * 0.95 / (0.4 * most);
    return 0.95 + (d - 0.4 * most) / (0.6 * most) * 0.05;
}

/* a1 sqrt(pi/b1) exp(-pi^2 r^2 / b1) + the same of a2 and b2, sum 1. */
static void slow_smoothing(SlowKernel *k, double ppd, double a1, double b1, double a2, double b2) {
    double sum = 0;
    k->radius = (int)ceil(3 * sqrt(0.04 / (2 * SLOW_PI * SLOW_PI)) * ppd);
    for (int pass = 0; pass < 2; pass++)
        for (int y = -k->radius; y <= k->radius; y++)
            for (int x = -k->radius; x <= k->radius; x++) {
                double *w = &k->w[y + k->radius][x + k->radius];
                double r2 = (x * x + y * y) / (ppd * ppd);
                if (pass == 0) {
                    *w = a1 * sqrt(SLOW_PI / b1) * exp(-SLOW_PI * SLOW_PI * r2 / b1) +
                         a2 * sqrt(SLOW_PI / b2) * exp(-SLOW_PI * SLOW_PI * r2 / b2);
                    sum += *w;
                } else {
                    *w /= sum;
                }
            }
}

/* Derivative along x of a Gaussian over the plane; its positive weights have the sum 1, its
 * negative ones -1. along_y turns it. */
static void slow_feature(SlowKernel *k, double ppd, int derivative, int along_y) {
    double s = 0.5 * 0.082 * ppd, positive = 0, negative = 0;
    k->radius = (int)ceil(3 * s);
    for (int pass = 0; pass < 2; pass++)
        for (int y = -k->radius; y <= k->radius; y++)
            for (int x = -k->radius; x <= k->radius; x++) {
                double *w = along_y ? &k->w[x + k->radius][y + k->radius]
                                    : &k->w[y + k->radius][x + k->radius];
                if (pass == 0) {
                    double g = exp(-(x * x + y * y) / (2 * s * s));
                    *w = derivative == 1 ? -x * g : (x * x / (s * s) - 1) * g;
                    *(*w > 0 ? &positive : &negative) += fabs(*w);
                } else {
                    *w /= *w > 0 ? positive : negative;
                }
            }
}

/* Of one of YCxCz, or with channel 3 of the grey (Y + 16) / 116, about pixel (x, y). */
static double slow_convolve(const Planes *p, const SlowKernel *k, int channel, int x, int y) {
    double sum = 0;
    for (int j = -k->radius; j <= k->radius; j++)
        for (int i = -k->radius; i <= k->radius; i++) {
            int xx = x + i < 0 ? 0 : x + i >= p->width ? p->width - 1 : x + i;
            int yy = y + j < 0 ? 0 : y + j >= p->height ? p->height - 1 : y + j;
            size_t at = (size_t)yy * (size_t)p->width + (size_t)xx;
            const double rgb[3] = {(double)p->rgb[0][at], (double)p->rgb[1][at],
                                   (double)p->rgb[2][at]};
            double ycxcz[3];
            slow_ycxcz(rgb, ycxcz);
            double value = channel < 3 ? ycxcz[channel] : (ycxcz[0] + 16) / 116;
            sum += k->w[j + k->radius][i + k->radius] * value;
        }
    return sum;
}

typedef struct SlowFlip {
    SlowKernel smoothing[3], edge[2], point[2];
} SlowFlip;

/* free() it. ppd: at most 290. */
static SlowFlip *slow_flip_create(double ppd) {
    SlowFlip *slow = calloc(1, sizeof *slow);
    slow_smoothing(&slow->smoothing[0], ppd, 1, 0.0047, 0, 1);
    slow_smoothing(&slow->smoothing[1], ppd, 1, 0.0053, 0, 1);
    slow_smoothing(&slow->smoothing[2], ppd, 34.1, 0.04, 13.5, 0.025);
    for (int along_y = 0; along_y < 2; along_y++) {
        slow_feature(&slow->edge[along_y], ppd, 1, along_y);
        slow_feature(&slow->point[along_y], ppd, 2, along_y);
    }
    return slow;
}

static void slow_seen_rgb(const SlowFlip *slow, const Planes *p, int x, int y, double rgb[3]) {
    double ycxcz[3];
    for (int c = 0; c < 3; c++) ycxcz[c] = slow_convolve(p, &slow->smoothing[c], c, x, y);
    slow_rgb(ycxcz, rgb);
}

static double slow_strength(const SlowKernel kernel[2], const Planes *p, int x, int y) {
    return hypot(slow_convolve(p, &kernel[0], 3, x, y), slow_convolve(p, &kernel[1], 3, x, y));
}

static double slow_flip_pixel(const SlowFlip *slow, const Planes *r, const Planes *t, int x,
                              int y) {
    double a[3], b[3];
    slow_seen_rgb(slow, r, x, y, a);
    slow_seen_rgb(slow, t, x, y, b);
    double edge = fabs(slow_strength(slow->edge, r, x, y) - slow_strength(slow->edge, t, x, y));
    double point = fabs(slow_strength(slow->point, r, x, y) - slow_strength(slow->point, t, x, y));
    double feature = sqrt(fmax(edge, point) / sqrt(2));
    return pow(slow_colour_difference(a, b), 1 - feature);
}
