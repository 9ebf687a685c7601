/* SPDX-License-Identifier: Apache-2.0 */
/* comparison.h -- what a comparison has to do, and everything that it finds out.
 *
 * Units    frames in cd m^-2, pictures 0 .. 1. Exposures are photographic exposure values as in
 *          image/exposure.h.
 * Threads  plain data.
 */
#pragma once
#include "compare/channels.h"
#include "compare/metrics/change.h"
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
    const char *name;     /* of the pair, for its headline; NULL: the test file's */
} CompareOptions;

/* How a display's contrast changed. */
typedef struct ContrastChange {
    const char *display;
    bool has; /* both frames state it */
    FrameMeasurement reference, test;
    Measured ratio; /* test over reference, with its 95 % interval's half width */
} ContrastChange;

/* One figure of a comparison in words and numbers (rows.h). */
typedef enum CompareTable { TABLE_CONTRAST, TABLE_MEAN, TABLE_METRIC } CompareTable;

typedef struct CompareRow {
    CompareTable table;
    const char *figure;     /* "contrast", "mean", or a metric's name */
    const char *of;         /* which display or region; "" all */
    const char *label;      /* for people, "contrast of cluster" */
    double reference, test; /* NaN: the figure is of both together */
    double value;           /* the figure, or test / reference - 1; NaN: not known */
    double half_width;      /* of its 95 % interval; NaN: not known */
    double p;               /* of its test; NaN: none */
    bool has_limit, is_min, is_beyond;
    double limit;
    const char *text, *limit_text; /* NULL: no limit */
    const char *change;            /* the value alone, where `text` has both sides; else "" */
    const char *verdict;           /* "within", "beyond", "moved", "below the noise" or "" */
    bool is_finding;               /* a change that its interval does not explain */
    bool is_key;                   /* is looked at first */
} CompareRow;

/* The first words of an answer. All but the last one pass. */
typedef enum CompareOutcome {
    COMPARE_SAME,       /* no value differs */
    COMPARE_SAME_LIGHT, /* but those of layers */
    COMPARE_WITHIN_NOISE,
    COMPARE_WITHIN_LIMITS,
    COMPARE_DIFFERENT
} CompareOutcome;

/* The basis of the verdict. */
typedef enum JudgedBy { JUDGED_BY_LIMITS, JUDGED_BY_STATISTIC, JUDGED_BY_EQUALITY } JudgedBy;

typedef struct Comparison {
    CompareInput reference, test;
    bool same; /* it passes */
    CompareOutcome outcome;
    JudgedBy judged_by;
    const char *verdict; /* the headline (headline.h), in full sentences */
    const char *finding; /* the same without the name before it */
    Lines reasons, notes;
    int structural; /* reasons, the first ones, that are none of the light of common pixels */
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
    ChangeGrid grid;
    LightChange change; /* of the light */
    Standout standout;  /* frames */
    CompareRow *rows;
    int row_count;
    Planes light[2];              /* finite everywhere: reference, test */
    PixelMask mask;               /* what counts, without pixels that are not finite */
    float *flip_map, *deltae_map; /* NULL: not computed */
    FlipExposures exposures;      /* frames: what HDR-FLIP used, as light times 2^ev */
    double shown_ev;              /* frames: the exposure that both were developed with */
    const char *shown_with;       /* frames: view, display, configuration */
    double seconds;
} Comparison;
