/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/wavelet1d.h"

#include <math.h>
#include <string.h>

/* CDF 9/7 as four lifting steps (Daubechies and Sweldens 1998, "Factoring Wavelet Transforms
 * into Lifting Steps"), and the low-pass gain that remains after them. */
static const double CDF97[4] = {-1.586134342059924, -0.052980118572961, 0.882911075530934,
                                0.443506852043971};
#define CDF97_GAIN 1.230174104914001

/* A row split into its even and odd places. */
typedef struct Split {
    double even[(WAVELET_MAX_COUNT + 1) / 2];
    double odd[WAVELET_MAX_COUNT / 2];
    int even_count, odd_count; /* equal, or one even more */
} Split;

/* odd += factor * (its two even neighbours), mirrored at the last. */
static void lift_odd(Split *s, double factor) {
    for (int i = 0; i < s->odd_count; i++) {
        int next = i + 1 < s->even_count ? i + 1 : i;
        s->odd[i] += factor * (s->even[i] + s->even[next]);
    }
}

/* even += factor * (its two odd neighbours), mirrored at the first and the last. */
static void lift_even(Split *s, double factor) {
    for (int i = 0; i < s->even_count; i++) {
        int before = i > 0 ? i - 1 : 0, after = i < s->odd_count ? i : s->odd_count - 1;
        s->even[i] += factor * (s->odd[before] + s->odd[after]);
    }
}

/* Haar: the detail is the difference of the pair, the approximation its mean. */
static void haar_step(Split *s, int sign) {
    for (int i = 0; i < s->odd_count && sign > 0; i++) s->odd[i] -= s->even[i];
    for (int i = 0; i < s->odd_count; i++) s->even[i] += sign * 0.5 * s->odd[i];
    for (int i = 0; i < s->odd_count && sign < 0; i++) s->odd[i] += s->even[i];
}

static void scale_even(Split *s, double factor) {
    for (int i = 0; i < s->even_count; i++) s->even[i] *= factor;
}

static void analyse(WaveletKind kind, Split *s) {
    if (kind == WAVELET_HAAR) {
        haar_step(s, 1);
    } else if (kind == WAVELET_CDF53) {
        lift_odd(s, -0.5);
        lift_even(s, 0.25);
    } else {
        for (int i = 0; i < 4; i += 2) {
            lift_odd(s, CDF97[i]);
            lift_even(s, CDF97[i + 1]);
        }
        scale_even(s, 1 / CDF97_GAIN);
    }
}

static void synthesise(WaveletKind kind, Split *s) {
    if (kind == WAVELET_HAAR) {
        haar_step(s, -1);
    } else if (kind == WAVELET_CDF53) {
        lift_even(s, -0.25);
        lift_odd(s, 0.5);
    } else {
        scale_even(s, CDF97_GAIN);
        for (int i = 2; i >= 0; i -= 2) {
            lift_even(s, -CDF97[i + 1]);
            lift_odd(s, -CDF97[i]);
        }
    }
}

void wavelet1d_forward(WaveletKind kind, float *values, int count) {
    Split s;
    for (; count > 1; count = s.even_count) {
        s.even_count = (count + 1) / 2;
        s.odd_count = count / 2;
        for (int i = 0; i < s.even_count; i++) s.even[i] = (double)values[2 * i];
        for (int i = 0; i < s.odd_count; i++) s.odd[i] = (double)values[2 * i + 1];
        analyse(kind, &s);
        for (int i = 0; i < s.even_count; i++) values[i] = (float)s.even[i];
        for (int i = 0; i < s.odd_count; i++) values[s.even_count + i] = (float)s.odd[i];
    }
}

static void inverse_step(WaveletKind kind, float *values, int count) {
    Split s = {.even_count = (count + 1) / 2, .odd_count = count / 2};
    for (int i = 0; i < s.even_count; i++) s.even[i] = (double)values[i];
    for (int i = 0; i < s.odd_count; i++) s.odd[i] = (double)values[s.even_count + i];
    synthesise(kind, &s);
    for (int i = 0; i < s.even_count; i++) values[2 * i] = (float)s.even[i];
    for (int i = 0; i < s.odd_count; i++) values[2 * i + 1] = (float)s.odd[i];
}

void wavelet1d_inverse(WaveletKind kind, float *values, int count) {
    int counts[16], steps = 0;
    for (; count > 1; count = (count + 1) / 2) counts[steps++] = count;
    while (steps > 0) inverse_step(kind, values, counts[--steps]);
}

void wavelet1d_norms(WaveletKind kind, int count, float *norms) {
    float row[WAVELET_MAX_COUNT];
    for (int i = 0; i < count; i++) {
        memset(row, 0, sizeof row);
        row[i] = 1;
        wavelet1d_inverse(kind, row, count);
        double sum = 0;
        for (int j = 0; j < count; j++) sum += (double)row[j] * (double)row[j];
        norms[i] = (float)sqrt(sum);
    }
}
