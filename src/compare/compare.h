/* compare.h -- are two frames or pictures the same, given their noise?
 *
 * What is different whatever the limits: sizes, windows, channels, metadata that decides what
 * the picture shows, NaN and infinity in light. Beyond that the limits that were set decide;
 * without any, frames that tell their noise are judged by the statistical test, and all others
 * must be equal in every pixel.
 *
 * Units    frames in cd m^-2, pictures 0 .. 1. Exposures are photographic exposure values as in
 *          image/exposure.h.
 * Memory   results come from the arena that is passed in.
 * Threads  `threads` of its own for FLIP.
 * Fails    when the two cannot be compared at all (kinds, masks, no noise layers for a test
 *          that was asked for); a difference is no failure but the answer.
 */
#pragma once
#include "compare/channels.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/metrics.h"
#include "compare/statistic/statistic.h"
#include "compare/thresholds.h"
#include "image/measure.h"
#include "image/picture.h"

typedef struct CompareOptions {
    unsigned groups;      /* of metrics to compute; 0: all */
    const Threshold *thresholds;
    int      threshold_count;
    bool     wants_stat;  /* the statistical test judges, whatever the limits */
    double   level;       /* of that test; 0: 0.01 */
    StructureRules   rules;
    SelectionRequest selection;
    bool     has_range;   /* HDR-FLIP: these exposure values, else from the reference */
    double   range_ev[2]; /* low <= high */
    const char *exposure; /* that frames are developed with; NULL: auto of the reference */
    int      threads;     /* at least 1 */
} CompareOptions;

/* How a display's contrast changed. */
typedef struct ContrastChange {
    const char *display;
    bool        has; /* both frames tell it */
    Measurement reference, test;
    Measured    ratio; /* test over reference, with its 95 % interval's half width */
} ContrastChange;

/* What the verdict rests on. */
typedef enum JudgedBy { JUDGED_BY_LIMITS, JUDGED_BY_STATISTIC, JUDGED_BY_EQUALITY } JudgedBy;

typedef struct Comparison {
    Subject     reference, test;
    bool        same;
    JudgedBy    judged_by;
    const char *verdict; /* one sentence, without "same" or "different" before it */
    const char *mean;    /* whether the mean moved or only the noise; "" when that is said */
    Lines       reasons, notes;
    Structure   structure;
    bool        has_pixels; /* one size: everything below was made */
    Selection   selection;
    Channels    channels;
    double      value[METRIC_COUNT]; /* NaN: not computed, or not known */
    double      psnr_peak;
    bool        has_stat;
    StatisticResult stat;
    ContrastChange *contrasts;
    int         contrast_count;
    Planes      light[2];  /* finite everywhere: reference, test */
    PixelMask   mask;      /* what counts, without pixels that are not finite */
    float      *flip_map, *deltae_map; /* NULL: not computed */
    FlipExposures exposures; /* frames: what HDR-FLIP used, as light times 2^ev */
    double      shown_ev;  /* frames: the exposure that both were developed with */
    const char *shown_with; /* frames: view, display, configuration */
    double      seconds;
} Comparison;

/* Reads both and compares them. */
bool compare_files(const char *reference, const char *test, const CompareOptions *options,
                   Arena *arena, Comparison *out, Error *err);

/* Two sides that are read already. */
bool compare_subjects(const Subject *reference, const Subject *test,
                      const CompareOptions *options, Arena *arena, Comparison *out, Error *err);

/* EV of a factor 2^stops of light, and back: 18 % grey of exposure.h becomes 0.18. */
double ev_of_stops(double stops);
double stops_of_ev(double ev);
