/* SPDX-License-Identifier: Apache-2.0 */
/* history.h -- all light that a path finds, way by way, for a listener: by which surfaces it
 * came, and where it began.
 *
 * Units    XYZ in cd m^-2, of a luxmeter in lx; they add up to the path's but for rounding.
 * Threads  one thread's, like the path.
 */
#pragma once
#include "path/path_collector.h"

/* How light went on at a surface. */
typedef enum PathEvent { PATH_SCATTERS, PATH_REFLECTS, PATH_TRANSMITS } PathEvent;

typedef struct PathStep {
    int part_id;     /* scene part */
    PathEvent event; /* reflects: as a mirror does */
    int pane_id;     /* part of the last pane on the way there; NO_ID: none */
    Vec3 position;   /* m, scene */
} PathStep;

#define PATH_STEPS_MAX 6

/* The way by which a piece of light came, and where it began. */
typedef struct PathHistory {
    PathStep step[PATH_STEPS_MAX]; /* the first of them; panes that the eye looks straight
                                       through count too */
    int count;                     /* all of them, also those that have no room */
    Vec3 towards; /* unit: from the eye, or the luxmeter, along the first stretch */
    LightSet source;
    int source_id;  /* emitters: scene part; punctual: scene light; else 0 */
    int pane_id;    /* part of the last pane that the light passed on its way to
                       the last step; NO_ID: none */
    int reached_by; /* as pane_id, to where the path is now */
    Vec3 from;      /* where it began, m, scene; is_distant: the unit direction
                       towards it */
    bool is_distant;
    bool is_sampled;                /* by one mirror, in which pupils sample lamps and compact
                                       emitters (mirrored.h); in on_mirror: the mirror is such */
    bool is_extrapolated;           /* the first step sent it on as its panel extrapolates it
                                       (bsdf_is_extrapolated); only where that is requested */
    const float *lanes;             /* its radiance, W m^-2 sr^-1 nm^-1 per lane; of a display
                                       that is seen by its measured XYZ NULL, unless
                                       requested */
    const Wavelengths *wavelengths; /* of the lanes */
} PathHistory;

static inline int path_steps_kept(const PathHistory *history) {
    return history->count < PATH_STEPS_MAX ? history->count : PATH_STEPS_MAX;
}

/* How far a listener's paths go. Through clear solids they always go on. */
typedef enum PathReach {
    PATH_TO_ITS_END,
    PATH_BY_MIRRORS /* from mirror to mirror and through panes, of which thin ones show both
                       ways always, until a surface scatters; that samples none: all light
                       that comes without being scattered, for little time */
} PathReach;

typedef struct PathListener {
    void (*on_light)(void *user, const PathHistory *history, const float xyz[3]);
    /* A smooth boundary, the last step, turned it towards there (unit); the eye sees this share of
     * what comes from there, in its brightest lane. NULL: not requested. */
    void (*on_mirror)(void *user, const PathHistory *history, Vec3 towards, float share);
    void *user;
    bool with_lanes;        /* displays' lanes are requested, too */
    bool with_extrapolated; /* is_extrapolated is requested, too */
    bool is_polarised;      /* light counts by how it is polarised, as the context's eye has it */
    PathReach reach;
} PathListener;

/* Which mirror images lie along a ray: what scatters is not followed, and no light counts. */
typedef struct PathImages {
    /* A path leaves the scene: share per lane of the radiance from there. */
    void (*add)(void *user, const PathHistory *history, Vec3 direction, const float *share);
    void *user;
} PathImages;

typedef struct HistoryCollector {
    PathCollector base;
    PathHistory history;          /* of the path so far */
    const PathListener *listener; /* one of these two; else NULL */
    const PathImages *images;
} HistoryCollector;

HistoryCollector history_collector(const PathListener *listener, PathCollector *next);

/* The path must be dark (PathManner). */
HistoryCollector image_collector(const PathImages *images);
