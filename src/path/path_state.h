/* SPDX-License-Identifier: Apache-2.0 */
/* path_state.h -- a path on its way: what it is, whoever wants what of it (path_collector.h).
 *
 * Units    metres, world; spectral radiance per lane.
 * Threads  one thread's.
 */
#pragma once
#include "base/sampler.h"
#include "path/guiding.h"
#include "path/path_context.h"
#include "path/path_light.h"
#include "path/sheets.h"

/* Counts of one thread; add them up. */
typedef struct PathStatistics {
    uint64_t samples;
    uint64_t camera_rays, bounce_rays, shadow_rays;
} PathStatistics;

/* The numbers of a sample by their purpose: every surface that a path meets has its own, so
 * that what one sample spends shifts nothing in the samples beside it. Sheets that are followed
 * besides count on from far off. */
enum {
    NUMBERS_LIGHTS = 0, /* two pairs a set */
    NUMBERS_MIRRORS = 2 * LIGHT_SETS,
    NUMBERS_SPLIT = NUMBERS_MIRRORS + 3,
    NUMBERS_HOLE,
    NUMBERS_SCATTER,
    NUMBERS_ROULETTE = NUMBERS_SCATTER + 2,
    NUMBERS_STEP
};
#define NUMBERS_FIRST 2 /* before them: the place in the pixel, the wavelengths */
#define STEPS_FAR 4096  /* more than a path meets */
#define SPLITS 2        /* thin sheets along an eye's ray that are followed both ways */

/* The last vertex that scattered, and how the path went on from there. */
typedef struct PathVertex {
    LitPoint at;
    int      part_id;   /* NO_ID: an eye or a luxmeter */
    float    pdf;       /* with which the direction was chosen, sr^-1 */
    bool     is_delta;  /* no light sample could have found what comes now */
    Spectrum sun_share; /* of the sun met now; the vertex before it got the rest */
} PathVertex;

/* The first surface that an eye sees: windows passed and holes do not count. */
typedef struct PathFirst {
    bool     is_awaited; /* it comes yet, and somebody asks for it */
    bool     is_met;
    Hit      hit;        /* t counted from the ray's origin */
    Vec3     direction;  /* of the ray there */
    Spectrum through;    /* what the panes before it let pass */
    bool     by_mirror;  /* it is a display, from whose mirror the path goes on: */
    PathLight before;    /* what it had found till then */
} PathFirst;

/* What a path does otherwise than one that light is gathered by. */
typedef struct PathManner {
    bool is_dark;   /* what emits counts nothing: light is asked for, from far away */
    bool is_spared; /* no roulette ends it */
    bool has_sheets; /* what thin sheets themselves show is followed always, not now and then */
} PathManner;

struct PathCollector;

typedef struct PathState {
    const PathContext    *context;
    const Wavelengths    *wavelengths;
    Sampler              *sampler;
    PathStatistics       *statistics;
    struct PathCollector *collector; /* NULL: the light alone is wanted */
    PathManner manner;
    Ray        ray;
    Spectrum   throughput; /* what the path so far lets through, per lane */
    PathLight  gathered;   /* found so far */
    PathFirst  first;
    PathVertex last;
    Guiding   *guiding;    /* with which that looked for light; and room for the next one */
    Guiding   *spare;
    float      straight;   /* m since the last vertex (windows do not scatter) */
    float      bright;     /* what a path lets through that is not dim; 1 but of a probe's and
                              behind a display */
    int        bounce;     /* scattering vertices so far */
    int        first_bounce; /* before which sheets are followed both ways */
    int        steps;      /* surfaces met so far */
    int        splits_left; /* thin sheets that may still be followed both ways */
    int        medium_id;  /* material of the solid that the ray is in; NO_ID: air */
    SheetStack *stack;     /* what else lies where the ray is; empty in scenes without sheets */
    float      sheets_from; /* m along the ray: sheets before it were in the stack */
} PathState;

/* The next numbers asked for are those of this purpose, at the surface met last. */
static inline void numbers_for(PathState *path, int purpose)
{
    path->sampler->dimension =
        (uint32_t)(NUMBERS_FIRST + path->steps * NUMBERS_STEP + purpose);
}

/* The power heuristic (Veach 1997, 9.2.4) for two strategies. */
static inline float mis_weight(float pdf, float other)
{
    float ratio = other / pdf;
    return 1 / (1 + ratio * ratio);
}
