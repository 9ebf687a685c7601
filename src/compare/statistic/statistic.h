/* SPDX-License-Identifier: Apache-2.0 */
/* statistic.h -- did the mean move, or is it only the noise?
 *
 * Every pixel gives one difference, test minus reference. Pixels are independent: each has its
 * own random numbers. If only the noise differs, a difference is as likely to be d as -d, for
 * exchanging the two frames changes nothing. So, with any factors c that do not change by that
 * exchange (areas, or weights made of both frames alike), the sum of c d divided by the root of
 * the sum of (c d)^2 is a weighted sum of fair random signs: its square has the expectation 1
 * exactly and its tail lies below 3.18 times the normal one, for any noise: fireflies,
 * glints, edges (Bentkus and Dzindzalieta 2015, "A tight Gaussian bound for weighted sums of
 * Rademacher random variables", Bernoulli 21(2)). It needs no estimate of the noise, and what
 * scrambled Sobol points gain over independent ones counts. A second quotient has the root of
 * the summed variances, as if samples were independent and of one kind in both frames, below:
 * it sees what changed in a few pixels, of which the first cannot be sure.
 * Three families make the verdict, each with the same share of the level (Sidak):
 *   blocks     of 8 x 8 and 32 x 32 pixels, each channel: the least p after Sidak's correction
 *   histogram  too many small p among the blocks: the mean square of the first quotient is
 *              above 1. Small changes all over the frame; noise that is less than stated does
 *              not alarm
 *   regions    the frame, every display by itself, what every display reflects: the plain mean,
 *              and a change in proportion with the most certain pixels weighing most
 * Frames of different sample counts, or one of which is noisier all over, have noise of
 * different shapes: the larger of both denominators, the variance of a sample from both frames
 * together (a reference of few samples that missed all glints knows nothing of them), times
 * what the halves show that Sobol points gain; weights come from the pixels around.
 * Frames of one seed and range share their noise: differences are those of the scene, or of
 * paths that rounding turned elsewhere; the same quotients show whether the mean moved.
 *
 * Units    linear Rec.709 in cd m^-2; probabilities 0 .. 1.
 * Memory   maps come from the arena.
 * Threads  pure.
 * A reason names a mean only where its interval of 95 % leaves 0 out; else the test that failed.
 *
 * Fails    when the frames lack the layers that it needs: the text names what to render again.
 */
#pragma once
#include "compare/statistic/regions.h"

typedef enum StatisticVerdict {
    STATISTIC_EQUAL,     /* R, G, B are the same bit for bit */
    STATISTIC_SAME,      /* only the noise differs */
    STATISTIC_DIFFERENT, /* the pixels differ by more than their noise */
    STATISTIC_UNKNOWN    /* a layer that states the noise holds what no render writes, and what
                            could be tested without it found nothing */
} StatisticVerdict;

typedef struct StatisticResult {
    StatisticVerdict verdict;
    double p_value;                          /* of the whole: small is different */
    double fraction_failed;                  /* of blocks x channels beyond the corrected level */
    double mean_shift;                       /* of the frame's mean luminance, a ratio minus 1 */
    double p_blocks, p_histogram, p_regions; /* the three parts that p_value is made of */
    double mean_square;     /* of the blocks' quotients: 1 when only the noise differs */
    long pixels;            /* that were looked at */
    long differing;         /* of these, beyond rounding (1e-5) in some channel */
    bool shares_noise;      /* one seed: see above */
    int block_side;         /* pixels */
    int blocks_x, blocks_y; /* from the data window's corner */
    float *block_p;         /* blocks_x * blocks_y: the least p of the block's channels; NaN
                               where the mask leaves nothing */
    float *sigma;           /* noisy_pair_sigma of each pixel of the display window; 0 outside */
    StatisticRegion *regions;
    int region_count;
    ExrWindow block;  /* the surest one, pixels of the display window */
    char reason[256]; /* different: in words, where it moved and how much; else "" */
    char note[256];   /* what makes the test weaker than it could be, or "" */
    int broken_side;  /* unknown: 0 the reference, 1 the test */
    char broken[96];  /* layer, value, place, and what it is not; "" none */
} StatisticResult;

bool statistic_compare(const FrameImage *reference, const FrameImage *test,
                       const StatisticOptions *options, Arena *arena, StatisticResult *out,
                       Error *err);
