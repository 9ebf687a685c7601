/* SPDX-License-Identifier: Apache-2.0 */
/* comparison.h -- what a comparison has to do, and everything that it finds out.
 *
 * Units    frames in cd m^-2, pictures 0 .. 1. Exposures are photographic exposure values as in
 *          image/exposure.h.
 * Threads  plain data.
 */
#pragma once
#include "compare/channels.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/pixel_errors.h"
#include "compare/statistic/statistic.h"
#include "compare/thresholds.h"
#include "measure/measure.h"
#include "image/picture.h"

typedef struct CompareOptions {
    unsigned groups; /* of metrics to compute; 0: all */
    const Threshold *thresholds;
    int threshold_count;
    bool wants_stat; /* the statistical test judges, under any limits */
    double level;    /* of that test; 0: 0.01 */
    CompareRules rules;
    SelectionRequest selection;
    bool has_range;       /* HDR-FLIP: these exposure values, else from the reference */
    double range_ev[2];   /* low <= high */
    const char *exposure; /* that frames are developed with; NULL: auto of the reference */
    int threads;          /* at least 1 */
    long whole_pixels;    /* pictures of more are compared in bands; 0: INPUT_WHOLE_PIXELS */
    int band_rows;        /* of those; 0: 128 */
} CompareOptions;

/* How a display's contrast changed. */
typedef struct ContrastChange {
    const char *display;
    bool has; /* both frames state it */
    FrameMeasurement reference, test;
    Measured ratio; /* test over reference, with its 95 % interval's half width */
} ContrastChange;

/* The basis of the verdict. */
typedef enum JudgedBy { JUDGED_BY_LIMITS, JUDGED_BY_STATISTIC, JUDGED_BY_EQUALITY } JudgedBy;

typedef struct Comparison {
    CompareInput reference, test;
    bool same;
    JudgedBy judged_by;
    const char *verdict; /* one sentence, without "same" or "different" before it */
    const char *mean;    /* whether the mean moved or only the noise; "" when that is stated */
    Lines reasons, notes;
    Structure structure;
    bool has_pixels; /* one size: everything below was made */
    Selection selection;
    ChannelDifferences channels;
    double value[METRIC_COUNT]; /* NaN: not computed, or not known */
    double psnr_peak;
    bool has_stat;
    StatisticResult stat;
    ContrastChange *contrasts;
    int contrast_count;
    Planes light[2];              /* finite everywhere: reference, test */
    PixelMask mask;               /* what counts, without pixels that are not finite */
    float *flip_map, *deltae_map; /* NULL: not computed */
    FlipExposures exposures;      /* frames: what HDR-FLIP used, as light times 2^ev */
    double shown_ev;              /* frames: the exposure that both were developed with */
    const char *shown_with;       /* frames: view, display, configuration */
    double seconds;
} Comparison;
