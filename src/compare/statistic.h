/* statistic.h -- did the mean move, or is it only the noise?
 *
 * Compares two frames by the noise that they state themselves. Frames of different seeds are
 * independent; frames of one seed, scene and program share their noise, and every difference
 * between them is real.
 *
 * Units    linear Rec.709 in cd m^-2; probabilities 0 .. 1.
 * Memory   maps come from the arena.
 * Threads  pure.
 * Fails    when the frames lack the layers that it needs: the text says what to render again.
 */
#pragma once
#include "compare/planes.h"
#include "image/frame.h"

typedef struct StatisticOptions {
    double level;       /* of the whole verdict: the share of false alarms; 0: 0.01 */
    PixelMask mask;
    const char *reference_name, *test_name; /* for messages */
} StatisticOptions;

/* One part of the frame whose mean is tested for itself. */
typedef struct StatisticRegion {
    const char *name;      /* "frame", a display's name, "cluster reflected" */
    long    pixels;
    double  reference, test; /* mean luminance, cd m^-2 */
    double  shift;         /* test / reference - 1 */
    double  shift_sigma;   /* its standard error */
    double  p_value;       /* two-sided */
    bool    moved;         /* after the correction for how many are tested */
} StatisticRegion;

typedef enum StatisticVerdict {
    STATISTIC_EQUAL,    /* every sample-carrying bit is the same */
    STATISTIC_SAME,     /* only the noise differs */
    STATISTIC_DIFFERENT /* the mean moved */
} StatisticVerdict;

typedef struct StatisticResult {
    StatisticVerdict verdict;
    double p_value;         /* of the whole: small is different */
    double fraction_failed; /* of blocks x channels beyond the corrected level */
    double mean_shift;      /* of the frame's mean luminance, a ratio minus 1 */
    double p_blocks, p_histogram, p_regions; /* the three parts that p_value is made of */
    bool   shares_noise;    /* one seed: see above */
    int    block_side;      /* pixels */
    int    blocks_x, blocks_y;
    float *block_p;         /* blocks_x * blocks_y: the least p of the block's channels; NaN
                               where the mask leaves nothing */
    StatisticRegion *regions;
    int    region_count;
    char   reason[256];     /* in words, where it moved and how much; "" when it did not */
} StatisticResult;

bool statistic_compare(const FrameImage *reference, const FrameImage *test,
                       const StatisticOptions *options, Arena *arena, StatisticResult *out,
                       Error *err);
