/* SPDX-License-Identifier: Apache-2.0 */
/* statistic_result.h -- what the statistical test is asked, and what it answers; statistic.h
 * describes the method.
 *
 * Units    linear Rec.709 in cd m^-2; probabilities 0 .. 1.
 * Threads  plain data.
 */
#pragma once
#include "compare/metrics/planes.h"
#include "image/frame.h"

typedef struct StatisticOptions {
    double level;       /* of the whole verdict: the share of false alarms; 0: 0.01 */
    PixelMask mask;     /* over the display window; NULL: every pixel */
    const char *reference_name, *test_name; /* for messages */
} StatisticOptions;

/* One part of the frame whose mean is tested for itself. */
typedef struct StatisticRegion {
    const char *name;      /* "frame", a display's in the reference, "cluster reflected" */
    long    pixels;
    double  reference, test; /* mean luminance, cd m^-2 */
    double  shift;         /* test / reference - 1; NaN for a black reference */
    double  shift_sigma;   /* its standard error */
    double  change;        /* the best estimate of a change in proportion, and its error: the */
    double  change_sigma;  /* surer pixels count more; NaN: it is no proportion */
    double  p_value;       /* two-sided */
    bool    moved;         /* after the correction for how many are tested */
} StatisticRegion;

typedef enum StatisticVerdict {
    STATISTIC_EQUAL,    /* R, G, B are the same bit for bit */
    STATISTIC_SAME,     /* only the noise differs */
    STATISTIC_DIFFERENT /* the mean moved */
} StatisticVerdict;

typedef struct StatisticResult {
    StatisticVerdict verdict;
    double p_value;         /* of the whole: small is different */
    double fraction_failed; /* of blocks x channels beyond the corrected level */
    double mean_shift;      /* of the frame's mean luminance, a ratio minus 1 */
    double p_blocks, p_histogram, p_regions; /* the three parts that p_value is made of */
    double mean_square;     /* of the blocks' quotients: 1 when only the noise differs */
    long   pixels;          /* that were looked at */
    long   differing;       /* of these, beyond rounding (1e-5) in some channel */
    bool   shares_noise;    /* one seed: see above */
    int    block_side;      /* pixels */
    int    blocks_x, blocks_y; /* from the data window's corner */
    float *block_p;         /* blocks_x * blocks_y: the least p of the block's channels; NaN
                               where the mask leaves nothing */
    StatisticRegion *regions;
    int    region_count;
    char   reason[256];     /* in words, where it moved and how much; without a move, what
                               differs between frames that share their noise, or "" */
    char   note[256];       /* what makes the test weaker than it could be, or "" */
} StatisticResult;
