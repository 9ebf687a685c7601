/* SPDX-License-Identifier: Apache-2.0 */
/* road_verdict.h -- what a review says of a gaze at a road that is lit by night: its threshold
 * increment by age, which displays make it, and how bright they may be.
 *
 * Units    cd m^-2, years, per cent. Levels as a request's: 1 is as a panel was measured.
 *          Intervals: 95 %, of sampling, and of the panels' stated errors of what they emit,
 *          each display's taken as independent.
 * Memory   texts and lists live in the review's arena.
 * Threads  plain data.
 */
#pragma once
#include "review/verdict.h"

/* One display's part of the veil, for an age. */
typedef struct RoadDisplay {
    const char *display;  /* its material's name */
    double level;         /* at which it stands */
    double share;         /* of the veil, 0..1 */
    double increment_pct; /* that its light makes alone */
    MeanInterval increment_range;
    /* Of its own veil for the first age; they add up to 1; NaN: it makes none. */
    double straight_share;         /* to the eye, or through panes */
    double mirrored_share;         /* by mirrors and panes that mirror */
    double scattered_share;        /* by surfaces that it lights */
    const char *mirrored_by;       /* what mirrors most of it towards the eye; NULL: nothing */
    double mirrored_by_share;      /* of its own veil */
    double level_most;             /* at which, all else as it stands, the limit is just kept; 0:
                                      not even when it is dark; NaN: no limit, or it is off */
    MeanInterval level_most_range; /* as surely as the veil is known */
} RoadDisplay;

typedef struct RoadAge {
    double age_years;
    double veil; /* cd m^-2, by road lighting's formula (vision/road_glare.h) */
    MeanInterval veil_range;
    double increment_pct;
    MeanInterval increment_range;
    double increment_by_spread_pct; /* with the veil by CIE 135/1 in place of that */
    LimitVerdict limit;             /* judge_gaze's; name NULL: the profile has none */
    RoadDisplay *displays;          /* those that are not dark, the first age's greatest first */
    int display_count;
} RoadAge;

/* Between too bright and too dark. */
typedef enum RoadWindow {
    ROAD_WINDOW_NONE,  /* nobody reads it, or no limit is known of what is read */
    ROAD_WINDOW_OPEN,  /* there are levels that surely keep both */
    ROAD_WINDOW_CLOSE, /* there may be */
    ROAD_WINDOW_EMPTY, /* surely none does */
    ROAD_WINDOWS
} RoadWindow;
extern const char *const road_windows[ROAD_WINDOWS + 1]; /* NULL, "open", ... */

/* A row of the table of levels: of one display, for an age and a road. */
typedef struct RoadDimming {
    const char *display; /* NULL: all of them by one factor, and levels are factors */
    double age_years, road_cd_m2;
    double level; /* at which it stands; of all: 1 */
    double level_most;
    MeanInterval level_most_range; /* RoadDisplay's */
    double level_least;            /* at which its symbols just keep all of their limits of
                                      contrast, seen by that eye under that condition; infinite:
                                      none does; NaN: none is judged */
    double level_least_sure;       /* at which they surely do; NaN, infinite likewise */
    const char *symbol;            /* that takes the most; NULL: none is judged */
    RoadWindow window;
} RoadDimming;

/* Why a road was not evaluated. */
typedef enum RoadLeftOut {
    ROAD_EVALUATED,
    ROAD_BY_DAY,     /* the sun is above the horizon */
    ROAD_OTHER_TIME, /* the request names other conditions */
    ROAD_LEFT_OUTS
} RoadLeftOut;
extern const char *const road_left_outs[ROAD_LEFT_OUTS + 1]; /* NULL, "the sun ...", ... */

struct GazeRoad {
    double luminance_cd_m2;    /* of the road, as the request states it */
    double s_p;                /* NaN: not stated */
    double mesopic_cd_m2;      /* of the road; NaN likewise */
    bool is_after_dark;        /* of a sweep: without sun and sky */
    RoadLeftOut left_out;      /* else nothing below is known */
    double without_data_share; /* of the veil, via materials without optical data */
    double unusable_share;     /* of the first age's veil, from displays whose panels are not
                                  usable */
    RoadAge *ages;             /* rising */
    int age_count;
    RoadDimming *dimming; /* by display, age, road; without a limit none */
    int dimming_count;
};

/* Has the increment a limit that counts? */
bool road_has_limit(const GazeRoad *road);

/* The age whose increment decides: the worst (quantity.h, limit_is_worse); NULL: there is no
 * limit. */
const RoadAge *gaze_worst_age(const GazeFinding *gaze);
