/* SPDX-License-Identifier: Apache-2.0 */
/* noisy_pair.h -- two frames as differences with noise, one pixel and channel at a time.
 *
 * Units    linear Rec.709 in cd m^-2.
 * Layout   pixels of the data window, row 0 at the top.
 * Memory   a view of the frames.
 * Threads  pure.
 * Fails    for frames without a layer that states their noise, or of different windows.
 *
 * A layer of counts that holds none (a program multiplied every channel) is left out, and what
 * needs it: the noise that the other layers state is then of an unknown scale.
 */
#pragma once
#include "compare/metrics/planes.h"
#include "compare/statistic/sign_flip.h"
#include "image/frame.h"

typedef struct StatisticOptions {
    double level;   /* of the whole verdict: the share of false alarms; 0: 0.01 */
    PixelMask mask; /* over the display window; NULL: every pixel */
    const char *reference_name, *test_name; /* for messages */
} StatisticOptions;

typedef enum NoisyChannel {
    NOISY_R,
    NOISY_G,
    NOISY_B,
    NOISY_LUMINANCE,
    NOISY_REFLECTED /* luminance of display.reflected: noise of the whole pixel, as what a
                       display emits has hardly any */
} NoisyChannel;

typedef struct NoisySide {
    const float *light[3], *reflected[3], *variance[3], *halves[3];
    const float *samples;  /* NULL: samples_of_all */
    double samples_of_all; /* a pixel; NaN: not known */
    char broken[96];       /* a layer that is not what the program wrote, and why; "" */
} NoisySide;

typedef struct NoisyPair {
    NoisySide side[2]; /* reference, test */
    ExrWindow data, display_window;
    PixelMask mask;
    const float *display; /* ids of the reference; NULL: none */
    bool has_reflected, has_variance, has_halves, knows_samples;
    NoiseLaw law;
    bool shares_noise;
} NoisyPair;

/* Whether both state one seed and the same samples. */
bool noisy_pair_shares_noise(const FrameImage *reference, const FrameImage *test);

bool noisy_pair_open(const FrameImage *reference, const FrameImage *test,
                     const StatisticOptions *options, NoisyPair *out, Error *err);

/* x, y: of the data window, from 0. False where the mask leaves the pixel out or its light is
 * not finite. */
bool noisy_pair_counts(const NoisyPair *pair, int x, int y);

/* Index of a pixel of the data window. */
static inline size_t noisy_pair_index(const NoisyPair *pair, int x, int y) {
    return (size_t)y * (size_t)(pair->data.x1 - pair->data.x0) + (size_t)x;
}

/* scale: what the reference's light is multiplied by first. False where the layer has nothing
 * (off displays). */
bool noisy_pair_number(const NoisyPair *pair, size_t i, NoisyChannel channel, double scale,
                       NoisyNumber *out);

/* A pixel's standard error of the difference of luminance that both sides' variance layers state,
 * times what makes `sigmas` of it as rare as so many of a normal distribution, however few samples
 * it comes from. Infinite where these tell nothing. */
double noisy_pair_sigma(const NoisyPair *pair, size_t i, double sigmas);

/* Luminance of one side, or of its reflected part; NaN off displays. */
double noisy_pair_luminance(const NoisyPair *pair, int side, size_t i, NoisyChannel channel);

/* True when some channel differs by more than rounding. */
bool noisy_pair_differs(const NoisyPair *pair, size_t i);
