/* SPDX-License-Identifier: Apache-2.0 */
#include "film/pixels.h"

#include <math.h>
#include <string.h>

#include "spectrum/spectral_table.h"

#define AT(member) offsetof(FilmSample, member)
#define OWN NO_MEMBER
#define SUMS_ROW(NAME, name, letters, users, member) \
    {name, letters, sizeof letters - 1, users, member},

const SumsRow sums_rows[SUMS_COUNT] = {FILM_SUMS(SUMS_ROW)};

static void gather_pixel(const Film *film, size_t index, PixelSums *out) {
    const PixelSums *sums = film_sums_at(film, index);
    size_t before = (size_t)film->first_display, apart = (size_t)film->display_numbers;
    size_t after = film_layer_numbers(film) - before - apart;
    Fixed *displays = out->layers + before;
    memcpy(out, sums, sizeof *out + before * sizeof(Fixed));
    memcpy(displays + apart, sums->layers + before, after * sizeof(Fixed));
    if (!out->hits) out->part_sample = NO_SAMPLE, out->part_id = -1;
    if (out->display_hits) {
        memcpy(displays, film_displays_at(film, index), apart * sizeof(Fixed));
    } else {
        memset(displays, 0, apart * sizeof(Fixed));
        out->display_sample = NO_SAMPLE, out->display_id = -1;
    }
}

void film_gather(const Film *film, size_t first, size_t count, void *out) {
    char *next = out;
    for (size_t i = 0; i < count; i++, next += film->stride)
        gather_pixel(film, first + i, (PixelSums *)(void *)next);
}

/* (sum of squares - (sum)^2 / n) / (n - 1) / n for each of R, G, B, of sums of XYZ and of
 * squares of RGB. */
static void variance_of(const double xyz[3], const double squares[3], double n,
                        double variance[3]) {
    for (int i = 0; i < 3; i++) {
        const float *row = rgb_from_xyz_matrix + 3 * i;
        double sum = (double)row[0] * xyz[0] + (double)row[1] * xyz[1] + (double)row[2] * xyz[2];
        double spread = squares[i] - sum * sum / n;
        variance[i] = n < 2 ? (double)NAN : spread > 0 ? spread / (n - 1) / n : 0;
    }
}

/* from: small and large ones of R, then of G and B. */
static void squares_of(const Fixed *from, int low_bits, double squares[3]) {
    for (int i = 0; i < 3; i++)
        squares[i] = double_from_fixed(from[2 * i], low_bits) +
                     double_from_fixed(from[2 * i + 1], SQUARE_HIGH_BITS);
}

void pixel_variance(const PixelSums *sums, double variance[3]) {
    double xyz[3], squares[3];
    for (int i = 0; i < 3; i++) xyz[i] = double_from_fixed(sums->xyz[i], FIXED_BITS);
    squares_of(&sums->squares[0][0], SQUARE_LOW_BITS, squares);
    variance_of(xyz, squares, (double)sums->samples, variance);
}

/* ---- displays ---------------------------------------------------------------------------- */

static Fixed light_of(const DisplaySums *sums, int i) {
    return sums->emitted[i] + sums->reflected[i];
}

void pixel_display_variance(const DisplaySums *sums, double variance[3]) {
    double xyz[3], squares[3];
    for (int i = 0; i < 3; i++) xyz[i] = double_from_fixed(light_of(sums, i), FIXED_BITS);
    squares_of(sums->squares, SQUARE_LOW_BITS, squares);
    variance_of(xyz, squares, sums->hits, variance);
}

#define SAME_DISPLAY 1e-12 /* of Q^2: less than other displays make with 10^12 samples */

SecondDisplay pixel_second_display(const DisplaySums *sums, int first) {
    SecondDisplay none = {.id = NO_SECOND}, several = {.id = SEVERAL};
    double hits = sums->hits, d = first, powers[3];
    for (int i = 0; i < 3; i++) powers[i] = (double)sums->shared[i];
    double p = powers[0] - d * hits;
    double q = powers[1] - 2 * d * powers[0] + d * d * hits;
    double t = powers[2] - 3 * d * powers[1] + 3 * d * d * powers[0] - d * d * d * hits;
    if (!(q > 0)) return none;
    double apart = q / p;
    if (!(fabs(p * t - q * q) <= SAME_DISPLAY * q * q) || !(fabs(d + apart) < 0x1p31))
        return several;
    SecondDisplay second = {.id = (int)round(d + apart), .samples = round(p * p / q)};
    double squares[3], of_ids[3], sum[3];
    squares_of(sums->squares, SQUARE_LOW_BITS, squares);
    squares_of(sums->shared + 6, SHARED_LOW_BITS, of_ids);
    for (int i = 0; i < 3; i++) {
        Fixed of_id = sums->shared[3 + i] - (Fixed)first * light_of(sums, i);
        sum[i] = double_from_fixed(of_id, FIXED_BITS) / apart;
        squares[i] = (of_ids[i] - d * squares[i]) / apart;
        second.xyz[i] = sum[i] / second.samples;
    }
    variance_of(sum, squares, second.samples, second.variance);
    return second;
}

/* odd: samples of sum_odd, of n. */
static bool halves_of(const Fixed sum[3], const Fixed sum_odd[3], double n, double odd, int least,
                      double xyz[3]) {
    double even = n - odd;
    if (odd < least || even < least) return false;
    for (int i = 0; i < 3; i++) {
        double odd_sum = double_from_fixed(sum_odd[i], FIXED_BITS);
        double even_sum = double_from_fixed(sum[i] - sum_odd[i], FIXED_BITS);
        xyz[i] = (odd_sum / odd - even_sum / even) * sqrt(odd * even) / n;
    }
    return true;
}

bool pixel_halves(const PixelSums *sums, int least, double xyz[3]) {
    return halves_of(sums->xyz, sums->odd_xyz, (double)sums->samples, (double)sums->odd_samples,
                     least, xyz);
}

bool pixel_display_halves(const PixelSums *sums, const Fixed reflected[3], const Fixed odd[4],
                          int least, double xyz[3]) {
    return halves_of(reflected, odd, (double)sums->display_hits,
                     double_from_fixed(odd[3], FIXED_BITS), least, xyz);
}

/* From the samples' spread, as if they were independent: the most it can be. */
static double sigma_of_spread(const double variance_rgb[3]) {
    return 0.2126 * sqrt(variance_rgb[0]) + 0.7152 * sqrt(variance_rgb[1]) +
           0.0722 * sqrt(variance_rgb[2]);
}

/* One difference d of two normal means gives sigma only in the mean over pixels, where E|d| =
 * sqrt(2 / pi) sigma_d. */
static double sigma_of_halves(double difference) {
    return 1.2533141373155003 * fabs(difference);
}

void pixel_noise_y(const PixelSums *sums, const double variance_rgb[3], double *sigma,
                   double *square) {
    double halves[3];
    bool has_halves = pixel_halves(sums, BLOCK_SAMPLES, halves);
    *sigma = has_halves ? sigma_of_halves(halves[1]) : sigma_of_spread(variance_rgb);
    *square = has_halves ? halves[1] * halves[1] : *sigma * *sigma;
}
