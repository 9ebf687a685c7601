/* SPDX-License-Identifier: Apache-2.0 */
#include "light/sky_picture_doubt.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "spectrum/photometry.h"

#define DOME_DEG 15.0
#define PEAK_RATIO 1000.0
#define PEAK_SHARE 0.1
#define PEAK_WIDTH_DEG 5.0
#define MOONLIT_LX 0.3
#define LIT_CD_M2 0.05
#define LIT_SHARE 0.02
#define DAY_LX 300.0 /* overcast, the sun at the horizon */

/* Weights over luminance, an eighth of an octave a bin from 2^-40 on. */
enum { BINS_AN_OCTAVE = 8, BINS = 80 * BINS_AN_OCTAVE, FIRST_OCTAVE = -40 };

typedef struct LuminanceHistogram {
    double weight[BINS], total;
} LuminanceHistogram;

static void histogram_add(LuminanceHistogram *histogram, double luminance, double weight) {
    int octave, bin = 0;
    if (luminance > 0) {
        double mantissa = frexp(luminance, &octave); /* in [0.5, 1) */
        bin = (octave - 1 - FIRST_OCTAVE) * BINS_AN_OCTAVE +
              (int)((2 * mantissa - 1) * BINS_AN_OCTAVE);
    }
    histogram->weight[bin < 0 ? 0 : bin > BINS - 1 ? BINS - 1 : bin] += weight;
    histogram->total += weight;
}

/* The middle of the median's bin. */
static double histogram_median(const LuminanceHistogram *histogram) {
    double below = 0;
    int bin = 0;
    while (bin < BINS - 1 && below + histogram->weight[bin] < 0.5 * histogram->total)
        below += histogram->weight[bin++];
    double share = (bin % BINS_AN_OCTAVE + 0.5) / BINS_AN_OCTAVE;
    return bin ? ldexp(1 + share, bin / BINS_AN_OCTAVE + FIRST_OCTAVE) : 0;
}

/* State of one pass over the pixels. */
typedef struct Look {
    HdriLook out;
    const Environment *environment;
    LuminanceHistogram dome, ground;
    double blue;
    int peak_x, peak_y;
} Look;

static const float *pixel_at(const Environment *environment, int x, int y) {
    const Image *image = &environment->hdri;
    return (const float *)image->pixels + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
}

static double luminance_of(const Environment *environment, int x, int y) {
    double luminance =
        (double)luminance_from_rgb(pixel_at(environment, x, y)) * (double)environment->hdri_scale;
    return luminance > 0 && isfinite(luminance) ? luminance : 0;
}

static bool is_blue(const float rgb[3]) {
    return rgb[2] >= 1.15f * rgb[0] && rgb[2] >= rgb[1] && rgb[2] > 0;
}

static double elevation_of(const Image *image, double row) {
    return PI * (0.5 - row / image->height);
}

static void look_at_row(Look *look, int y) {
    const Image *image = &look->environment->hdri;
    double top = elevation_of(image, y), bottom = elevation_of(image, y + 1);
    double middle = elevation_of(image, y + 0.5), deg = degrees_from_radians(middle);
    double angle = 2 * PI / image->width, solid = angle * (sin_d(top) - sin_d(bottom));
    double low = sin_d(fmax(bottom, 0)), high = sin_d(fmax(top, 0));
    double cosine_weighted = angle / 2 * (high * high - low * low);
    for (int x = 0; x < image->width; x++) {
        const float *rgb = pixel_at(look->environment, x, y);
        double luminance = luminance_of(look->environment, x, y);
        for (int i = 0; i < 3; i++)
            if (isfinite(rgb[i]))
                look->out.largest_stored = fmax(look->out.largest_stored, (double)rgb[i]);
        look->out.illuminance_lx += cosine_weighted * luminance;
        if (middle > 0 && luminance > look->out.peak_cd_m2) {
            look->out.peak_cd_m2 = luminance;
            look->peak_x = x;
            look->peak_y = y;
        }
        if (deg > DOME_DEG) histogram_add(&look->dome, luminance, solid);
        if (deg > DOME_DEG && is_blue(rgb)) look->blue += solid;
        if (deg < -DOME_DEG) histogram_add(&look->ground, luminance, solid);
    }
}

static double cosine_between(const Image *image, int x, int y, int other_x, int other_y) {
    double a = elevation_of(image, y + 0.5), b = elevation_of(image, other_y + 0.5);
    double turn = 2 * PI * (x - other_x) / image->width;
    return sin_d(a) * sin_d(b) + cos_d(a) * cos_d(b) * cos_d(turn);
}

static bool has_one_peak(const Look *look) {
    const Image *image = &look->environment->hdri;
    double least = cos_d(radians_from_degrees(PEAK_WIDTH_DEG));
    for (int y = 0; y < image->height / 2; y++)
        for (int x = 0; x < image->width; x++)
            if (luminance_of(look->environment, x, y) > PEAK_SHARE * look->out.peak_cd_m2 &&
                cosine_between(image, x, y, look->peak_x, look->peak_y) < least)
                return false;
    return look->out.peak_cd_m2 > 0;
}

HdriLook hdri_look(const Environment *environment) {
    Look look = {.environment = environment};
    for (int y = 0; y < environment->hdri.height; y++) look_at_row(&look, y);
    look.out.largest_stored /= environment->hdri_unit_cd_m2;
    look.out.dome_cd_m2 = histogram_median(&look.dome);
    look.out.ground_cd_m2 = histogram_median(&look.ground);
    look.out.blue_share = look.dome.total > 0 ? look.blue / look.dome.total : 0;
    look.out.peak_elevation = elevation_of(&environment->hdri, look.peak_y + 0.5);
    look.out.has_one_peak = has_one_peak(&look);
    return look.out;
}

static double overcast_lx(double elevation) {
    return DAY_LX + 21000 * fmax(sin_d(elevation), 0);
}

HdriDoubt hdri_doubt(const HdriLook *look) {
    double lux = look->illuminance_lx;
    if (look->largest_stored > 0.25 && look->largest_stored <= 1.0001 && lux < DAY_LX)
        return HDRI_UNIT_RANGE;
    bool is_lit = look->dome_cd_m2 >= LIT_CD_M2 && look->dome_cd_m2 >= LIT_SHARE * lux / PI;
    if (lux < MOONLIT_LX || !is_lit) return HDRI_PLAUSIBLE;
    bool is_bright = look->peak_cd_m2 >= PEAK_RATIO * look->dome_cd_m2;
    if (is_bright && look->has_one_peak && lux < 0.25 * overcast_lx(look->peak_elevation))
        return HDRI_DIM_SUN;
    bool is_over_ground = look->dome_cd_m2 >= 2 * look->ground_cd_m2 && !is_bright;
    if ((look->blue_share >= 0.5 && lux < DAY_LX) || (is_over_ground && lux >= 1 && lux < 50))
        return HDRI_DIM_SKY;
    return HDRI_PLAUSIBLE;
}
