/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/colour_map.h"

#include <math.h>

#include "image/srgb.h"

/* Ten colours of each map, evenly along it, as 0xRRGGBB. Viridis and inferno: van der Walt and
 * Smith 2015 (matplotlib, CC0). Cividis: Nunez, Anderton and Renslow 2018, "Optimizing
 * colormaps with consideration for color vision deficiency". The other two are our own. */
static const uint32_t ANCHORS[MAP_COUNT][10] = {
    [MAP_AMOUNT] = {0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58,
                    0xb5de2b, 0xfde725},
    [MAP_RATIO] = {0x00204d, 0x00336f, 0x39486b, 0x575c6d, 0x707173, 0x8a8779, 0xa69d75, 0xc4b56c,
                   0xe4cf5b, 0xffea46},
    [MAP_DIFFERENCE] = {0xfdf6e3, 0xfbe3be, 0xf7c999, 0xefac80, 0xe28d71, 0xcd6f6d, 0xb0556c,
                        0x8d416a, 0x673163, 0x3f2455},
    [MAP_SCATTER] = {0x0a0722, 0x1f0c48, 0x4a0c6b, 0x781c6d, 0xa52c60, 0xcf4446, 0xed6925, 0xfb9b06,
                     0xf7d13d, 0xfcffa4},
    [MAP_SIGNED] = {0x1d3f83, 0x3f68b0, 0x7395cd, 0xa9c0e2, 0xdfe5ee, 0xf0e2db, 0xe8b9a2, 0xd68869,
                    0xb9543e, 0x8e2323},
};

/* IEC 61966-2-1's luminance, then CIE 1976. */
static double lightness_of_linear(const double rgb[3]) {
    double y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    return y > 216.0 / 24389 ? 116 * cbrt(y) - 16 : y * 24389.0 / 27;
}

static double lightness_from_srgb(const double srgb[3]) {
    double rgb[3];
    for (int c = 0; c < 3; c++) rgb[c] = linear_from_srgb_d(srgb[c]);
    return lightness_of_linear(rgb);
}

static void anchor(ColourMap map, int i, double rgb[3]) {
    i = i < 0 ? 0 : i > 9 ? 9 : i;
    for (int c = 0; c < 3; c++)
        rgb[c] = linear_from_srgb_d((double)(ANCHORS[map][i] >> (16 - 8 * c) & 255) / 255);
}

/* Cube roots of linear light, a cheap near-perceptual space, Catmull-Rom between anchors. */
static void smooth_colour(ColourMap map, double t, double rgb[3]) {
    double at = t * 9, f;
    int i = at >= 9 ? 8 : (int)at;
    double p[4][3];
    f = at - i;
    for (int k = 0; k < 4; k++) anchor(map, i - 1 + k, p[k]);
    for (int c = 0; c < 3; c++) {
        double a = cbrt(p[0][c]), b = cbrt(p[1][c]), d = cbrt(p[2][c]), e = cbrt(p[3][c]);
        double v =
            b + 0.5 * f * (d - a + f * (2 * a - 5 * b + 4 * d - e + f * (3 * (b - d) + e - a)));
        rgb[c] = v > 0 ? v * v * v : 0;
    }
}

/* The lightness required at t: linear between the ends (of each half of the signed map). */
static double wanted_lightness(ColourMap map, double t) {
    double ends[2][3];
    int low = 0, high = 9;
    anchor(map, low, ends[0]);
    anchor(map, high, ends[1]);
    double a = lightness_of_linear(ends[0]), b = lightness_of_linear(ends[1]);
    if (map != MAP_SIGNED) return a + t * (b - a);
    return t < 0.5 ? a + 2 * t * (93 - a) : b + 2 * (1 - t) * (93 - b);
}

/* Scales light, and where a component would pass 1 adds white, until the lightness is right. */
static void set_lightness(double rgb[3], double lightness) {
    for (int round = 0; round < 12; round++) {
        double now = lightness_of_linear(rgb);
        double gain = pow((lightness + 16) / (now + 16), 3);
        for (int c = 0; c < 3; c++) {
            rgb[c] *= gain;
            if (rgb[c] > 1) rgb[c] = 1;
        }
        if (fabs(lightness_of_linear(rgb) - lightness) < 1e-4) return;
        double miss = lightness - lightness_of_linear(rgb);
        if (miss > 0.05)
            for (int c = 0; c < 3; c++) rgb[c] += (1 - rgb[c]) * miss / 100;
    }
}

void colour_map_at(ColourMap map, double t, double srgb[3]) {
    t = t > 0 ? (t < 1 ? t : 1) : 0;
    double rgb[3];
    smooth_colour(map, t, rgb);
    set_lightness(rgb, wanted_lightness(map, t));
    for (int c = 0; c < 3; c++)
        srgb[c] = srgb_from_linear_d(rgb[c] < 0 ? 0 : rgb[c] > 1 ? 1 : rgb[c]);
}

uint32_t colour_map_pixel(ColourMap map, double t) {
    double srgb[3];
    uint32_t pixel = 0xff;
    colour_map_at(map, t, srgb);
    for (int c = 0; c < 3; c++) pixel = pixel << 8 | (uint32_t)(srgb[c] * 255 + 0.5);
    return pixel;
}

int colour_map_wants_light_ink(ColourMap map, double t) {
    double srgb[3];
    colour_map_at(map, t, srgb);
    return lightness_from_srgb(srgb) < 58;
}
