/* SPDX-License-Identifier: Apache-2.0 */
/* path_state.h -- the state of a path on its way; collectors (path_collector.h) see it, too.
 *
 * Units    metres, scene; spectral radiance per lane.
 * Threads  one thread's.
 */
#pragma once
#include "base/sampler.h"
#include "path/guiding.h"
#include "path/path_context.h"
#include "path/sheets.h"

/* Light that a path has found. Most of it is radiance per lane; a display that is seen by ways
 * on which nothing depended on wavelength keeps its measured XYZ: lanes would only blur it. */
typedef struct PathLight {
    Spectrum radiance; /* W m^-2 sr^-1 nm^-1 per lane */
    float xyz[3];      /* cd m^-2 */
} PathLight;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

static inline void path_light_add(PathLight *sum, const PathLight *more) {
    sum->radiance += more->radiance;
    for (int i = 0; i < 3; i++) sum->xyz[i] += more->xyz[i];
}

static inline void path_light_take(PathLight *from, const PathLight *part) {
    from->radiance -= part->radiance;
    for (int i = 0; i < 3; i++) from->xyz[i] -= part->xyz[i];
}

static inline void path_light_to_xyz(const PathLight *gathered, const Wavelengths *wavelengths,
                                     float xyz[3]) {
    for (int i = 0; i < 3; i++) xyz[i] = gathered->xyz[i];
    spectrum_add_xyz(wavelengths, gathered->radiance, xyz);
}

#pragma GCC diagnostic pop

/* Counts of one thread; add them up. */
typedef struct PathStatistics {
    uint64_t samples;
    uint64_t camera_rays, bounce_rays, shadow_rays;
    uint64_t sky_finds; /* ways on which light of the sky reached a vertex */
    double lost;        /* light of lamps without a surface that may come through clear
                           solids and by several mirrors, but by no way that is known: a
                           bound, cd m^-2 or lx, a sum */
    double rare;        /* the same of compact emitters, which chance alone finds there,
                           less what it found; below 0 where that is more */
    double sent_on;     /* of a probe's paths: the share of the light from where they go that
                           their first vertex sends to the eye, a sum */
} PathStatistics;

/* The sampler's numbers by their purpose: every surface that a path meets has its own, so that
 * what one sample spends shifts nothing in the samples beside it. A path that follows a sheet
 * besides counts on from STEPS_FAR further. */
enum {
    NUMBERS_LIGHTS = 0, /* two pairs a set */
    NUMBERS_MIRRORS = 2 * LIGHT_SETS,
    NUMBERS_SPLIT = NUMBERS_MIRRORS + 3, /* one is left */
    NUMBERS_HOLE,
    NUMBERS_SCATTER,
    NUMBERS_ROULETTE = NUMBERS_SCATTER + 2,
    NUMBERS_STEP
};
#define NUMBERS_MAP 4   /* a step's own, behind those of all steps: of the sunlit map */
#define NUMBERS_NEAR 8  /* and again: of each set of lights in mirrors */
#define NUMBERS_FIRST 2 /* before them: the place in the pixel, the wavelengths */
#define STEPS_FAR 4096  /* more than a path meets */
#define SPLITS 2        /* thin sheets along an eye's ray that are followed both ways */

/* A vertex and the opaque surface that its path met next: how the vertex might have sampled
 * that from the sun's side (sunlit.h). */
typedef struct SunlitPair {
    float prob; /* that it sampled the map; 0: it did not */
    float own;  /* sr^-1, density with which chance chose the direction */
    float sr;   /* m^2 sr^-1: density of directions by one of the surface's area */
    LitPoint from;
    Vec3 at, ng; /* of the surface; m, and unit */
} SunlitPair;

/* The last vertex that scattered, and how the path went on from there. */
typedef struct PathVertex {
    LitPoint at;
    int part_id;         /* NO_ID: an eye or a luxmeter */
    float pdf;           /* with which the direction was chosen, sr^-1 */
    bool is_delta;       /* no light sample could have found what comes now */
    bool is_back;        /* of its part's side, as light_selection_of_side has it */
    float mirrors;       /* mirrored_rarity of compact emitters; 0: none sampled in mirrors */
    float mirrors_least; /* mirrored_least of them */
    bool samples_map;    /* where it could (sunlit.h) */
    SunlitPair before;   /* it and the vertex before it */
    Spectrum sun_share;  /* of the sun, if met next; the vertex before sampled the rest */
} PathVertex;

/* The smooth mirror that the path left last, for emitters that the vertex before it, or the
 * eye, sampled in it. */
typedef struct MirrorWay {
    float pdf;      /* with which chance chose the way at that vertex and at the mirror, sr^-1 */
    float prob;     /* with which the vertex samples its mirrors; 0: it does not */
    bool is_of_eye; /* an eye looks into a mirror that pupils sample */
    bool is_back;
    int part_id; /* the vertex's */
    Vec3 from;   /* where it lies, m, scene */
    uint32_t triangle;
    Vec3 at; /* of the mirror, m, scene */
} MirrorWay;

/* The first surface that an eye sees: windows passed and holes do not count. */
typedef struct PathFirst {
    bool is_awaited; /* it is awaited, and not met yet */
    bool is_met;
    Hit hit;              /* t counted from the ray's origin */
    Vec3 direction;       /* of the ray there */
    Spectrum through;     /* share of its light that the panes before it let pass; */
    bool through_is_grey; /* these treat all wavelengths alike */
    bool by_mirror;       /* it is a display, from whose mirror the path goes on: */
    PathLight before;     /* found until then */
} PathFirst;

/* Departures of a path from the plain one that gathers light. */
typedef struct PathManner {
    bool is_dark;    /* emission does not count: the path samples distant light */
    bool is_spared;  /* no roulette ends it */
    bool has_sheets; /* thin sheets' own light is followed in every sample, not in some */
} PathManner;

struct PathCollector;

typedef struct PathState {
    const PathContext *context;
    const Wavelengths *wavelengths;
    Sampler *sampler;
    PathStatistics *statistics;
    struct PathCollector *collector; /* NULL: the light alone is requested */
    PathManner manner;
    Ray ray;
    Spectrum throughput; /* of the path so far, per lane */
    bool is_grey;        /* all surfaces so far treat wavelengths alike: lanes differ by
                            rounding at most */
    PathLight gathered;  /* found so far */
    PathFirst first;
    PathVertex last;
    MirrorWay way;
    Guiding *guiding; /* the last vertex's; and room for the next one's */
    Guiding *spare;
    float straight;    /* m since the last vertex (windows do not scatter) */
    bool by_plates;    /* solid plates were passed since then: emitters beyond are sampled by
                          chance alone */
    float bright;      /* the throughput that roulette takes as full; not 1 behind a probe's
                          first surface or a display */
    int bounce;        /* scattering vertices so far */
    int first_bounce;  /* at which sheets are followed both ways */
    int steps;         /* surfaces met so far */
    int splits_left;   /* thin sheets that may still be followed both ways */
    int smooth;        /* smooth boundaries since the last vertex that scattered; plates count one
                          together, before a mirror; far below 0 where none has scattered yet */
    int medium_id;     /* material of the solid that the ray is in; NO_ID: air */
    SheetStack *stack; /* what else lies where the ray is; empty in scenes without sheets */
    float sheets_from; /* m along the ray: sheets before it were in the stack */
} PathState;

/* The sampler's next numbers are those of this purpose, at the surface met last. */
static inline void numbers_for(PathState *path, int purpose) {
    path->sampler->dimension = (uint32_t)(NUMBERS_FIRST + path->steps * NUMBERS_STEP + purpose);
}

static inline void numbers_for_map(PathState *path) {
    path->sampler->dimension = 0x40000000u + (uint32_t)path->steps * NUMBERS_MAP;
}

static inline void numbers_for_mirrors(PathState *path, BeamSet set) {
    path->sampler->dimension =
        0x60000000u + ((uint32_t)path->steps * BEAM_SETS + (uint32_t)set) * NUMBERS_NEAR;
}

/* The surface's share of the light, per lane, on the path's way. */
static inline void path_weigh(PathState *path, const Surface *surface, Spectrum weight) {
    path->throughput *= weight;
    path->is_grey &= surface->is_grey;
}

/* The power heuristic (Veach 1997, 9.2.4) for two strategies. */
static inline float mis_weight(float pdf, float other) {
    float ratio = other / pdf;
    return 1 / (1 + ratio * ratio);
}
