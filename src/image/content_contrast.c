/* SPDX-License-Identifier: Apache-2.0 */
#include "image/content_contrast.h"

#include <math.h>
#include <string.h>

#include "base/confidence.h"
#include "base/sort.h"

#define SIGMAS_95 1.959964 /* of the normal distribution */
#define LEAST_PIXELS 16    /* of a region, and of the inside of a half */
#define LEAST_SEPARABILITY 0.8
#define LEAST_DISTANCE 6.0 /* standard errors of a pixel, between the halves */
#define OUTLIERS 0.005     /* at either end */

/* Sums over the pixels of one half. */
typedef struct Half {
    double sum, noise;   /* noise: of all pixels, edges included */
    BrightSamples alone; /* each pixel's standard error as one bright sample's light */
    long pixels, counted;
} Half;

/* ---- the split --------------------------------------------------------------------------- */

/* The luminances that there are, in order. */
static long sorted_values(const ContentPixels *pixels, float *values) {
    long count = 0, all = (long)pixels->width * pixels->height;
    for (long i = 0; i < all; i++)
        if (isfinite(pixels->luminance[i])) values[count++] = pixels->luminance[i];
    sort_floats(values, count);
    return count;
}

/* Outliers become the values that all but they have. */
static void clip(float *values, long count) {
    long cut = (long)(OUTLIERS * (double)count);
    for (long i = 0; i < cut; i++) {
        values[i] = values[cut];
        values[count - 1 - i] = values[count - 1 - cut];
    }
}

/* The variance of a pixel's noise, as a mean over the region; 0 where it is not known. */
static double noise_variance(const ContentPixels *pixels) {
    double sum = 0;
    long count = 0, all = (long)pixels->width * pixels->height;
    for (long i = 0; i < all && pixels->variance; i++) {
        if (!isfinite(pixels->luminance[i])) continue;
        sum += (double)pixels->variance[i];
        count++;
    }
    return count ? sum / (double)count : 0;
}

/* The variance between the halves is w0 w1 (m1 - m0)^2: its greatest share of the whole one,
 * without the noise's. */
static void split(const float *values, long count, double noise, ContentContrast *out) {
    double n = (double)count, sum = 0, squares = 0, below = 0, most = 0;
    for (long i = 0; i < count; i++) sum += (double)values[i];
    for (long i = 0; i < count; i++) {
        double d = (double)values[i] - sum / n;
        squares += d * d;
    }
    for (long i = 1; i < count; i++) {
        below += (double)values[i - 1];
        if (values[i] == values[i - 1]) continue;
        double k = (double)i, step = (sum - below) / (n - k) - below / k;
        double between = k / n * (1 - k / n) * step * step;
        if (between <= most) continue;
        most = between;
        out->threshold = 0.5 * ((double)values[i - 1] + (double)values[i]);
    }
    out->separability = most / fmax(squares / n - noise, most);
}

/* ---- the halves -------------------------------------------------------------------------- */

/* 1 above the threshold, 0 below, -1: no pixel of the region. */
static int half_of(const ContentPixels *pixels, double threshold, int x, int y) {
    if (x < 0 || y < 0 || x >= pixels->width || y >= pixels->height) return -1;
    float value = pixels->luminance[(size_t)y * (size_t)pixels->width + (size_t)x];
    return isfinite(value) ? (double)value > threshold : -1;
}

/* No neighbour is of the other half. */
static bool is_inside(const ContentPixels *pixels, double threshold, int x, int y) {
    int own = half_of(pixels, threshold, x, y);
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            if (half_of(pixels, threshold, x + i, y + j) == 1 - own) return false;
    return true;
}

static void add_pixel(const ContentPixels *pixels, size_t i, bool counts, Half *half) {
    double variance = pixels->variance ? (double)pixels->variance[i] : 0;
    half->pixels++;
    half->noise += variance;
    if (!counts) return;
    half->counted++;
    half->sum += (double)pixels->luminance[i];
    half->alone.squares += variance;
    half->alone.fourths += variance * variance;
}

static void add_halves(const ContentPixels *pixels, double threshold, bool only_inside,
                       Half halves[2]) {
    for (int y = 0; y < pixels->height; y++) {
        for (int x = 0; x < pixels->width; x++) {
            int half = half_of(pixels, threshold, x, y);
            if (half < 0) continue;
            add_pixel(pixels, (size_t)y * (size_t)pixels->width + (size_t)x,
                      !only_inside || is_inside(pixels, threshold, x, y), &halves[half]);
        }
    }
}

/* ---- figures ----------------------------------------------------------------------------- */

static Measured mean_of(const Half *half, bool has_variance) {
    double n = (double)half->counted, mean = half->sum / n;
    double width = has_variance ? SIGMAS_95 * sqrt(half->alone.squares) / n : (double)NAN;
    return (Measured){mean, mean - width, mean + width + bright_missing(&half->alone, 1, 1) / n};
}

/* First order: the halves' errors are independent. */
static Measured derived(double value, Measured a, double slope_a, Measured b, double slope_b) {
    double of_a = slope_a * measured_half_width(a), of_b = slope_b * measured_half_width(b);
    return measured_about(value, sqrt(of_a * of_a + of_b * of_b));
}

static void set_figures(Measured low, Measured high, ContentContrast *out) {
    Measured c = out->characters, g = out->ground;
    double sum = low.value + high.value;
    out->ratio = derived(high.value / low.value, high, 1 / low.value, low,
                         high.value / (low.value * low.value));
    out->michelson = derived((high.value - low.value) / sum, high, 2 * low.value / (sum * sum), low,
                             2 * high.value / (sum * sum));
    out->weber =
        derived((c.value - g.value) / g.value, c, 1 / g.value, g, c.value / (g.value * g.value));
}

static bool is_too_noisy(const Half halves[2], double distance, ContentContrast *out) {
    double sigma = 0;
    for (int k = 0; k < 2; k++) sigma += 0.5 * sqrt(halves[k].noise / (double)halves[k].pixels);
    out->noise_sigmas = distance / sigma;
    return out->noise_sigmas < LEAST_DISTANCE;
}

static ContentVerdict measure_halves(const ContentPixels *pixels, ContentContrast *out) {
    Half halves[2];
    memset(halves, 0, sizeof halves);
    add_halves(pixels, out->threshold, true, halves);
    out->edges_left_out = halves[0].counted >= LEAST_PIXELS && halves[1].counted >= LEAST_PIXELS;
    if (!out->edges_left_out) {
        memset(halves, 0, sizeof halves);
        add_halves(pixels, out->threshold, false, halves);
    }
    Measured low = mean_of(&halves[0], pixels->variance);
    Measured high = mean_of(&halves[1], pixels->variance);
    if (pixels->variance && is_too_noisy(halves, high.value - low.value, out)) return CONTENT_NOISY;
    if (out->separability < LEAST_SEPARABILITY) return CONTENT_NOT_TWO;
    bool bright = halves[1].pixels <= halves[0].pixels; /* characters on a darker ground */
    out->characters = bright ? high : low;
    out->ground = bright ? low : high;
    out->character_pixels = halves[bright].pixels;
    out->ground_pixels = halves[!bright].pixels;
    set_figures(low, high, out);
    return CONTENT_FOUND;
}

ContentContrast content_contrast(const ContentPixels *pixels, Arena scratch) {
    ContentContrast out = {.verdict = CONTENT_TOO_SMALL, .noise_sigmas = (double)NAN};
    size_t all = (size_t)pixels->width * (size_t)pixels->height;
    float *values = ARENA_NEW(&scratch, float, all);
    long count = sorted_values(pixels, values);
    if (count < LEAST_PIXELS || values[0] == values[count - 1]) return out;
    clip(values, count);
    split(values, count, noise_variance(pixels), &out);
    out.verdict = measure_halves(pixels, &out);
    return out;
}
