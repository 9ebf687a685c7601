/* SPDX-License-Identifier: Apache-2.0 */
/* path.h -- light along one ray: the loop that everyone reads first.
 *
 * Units    spectral radiance in W m^-2 sr^-1 nm^-1 inside; the result is CIE XYZ in cd m^-2.
 * Threads  const context; one PathStatistics a thread.
 */
#pragma once
#include "base/sampler.h"
#include "path/path_context.h"

/* All that paths need besides scene, ray tracer and lights, which must outlive the context. The
 * tables come from the arena. Strategy: PATH_MIS. */
PathContext path_context_build(const Scene *scene, const Bvh *bvh, const Lights *lights,
                               int max_bounces, Arena *arena);

/* The same scene under other lights; what surfaces need is shared with `before`. */
PathContext path_context_relight(const PathContext *before, const Lights *lights, Arena *arena);

/* What a path's light did on its way, as the eye's ray meets it. */
typedef enum PathEvent { PATH_SCATTERS, PATH_REFLECTS, PATH_TRANSMITS } PathEvent;

typedef struct PathStep {
    int       part_id; /* scene part */
    PathEvent event;   /* reflects: as a mirror does */
    int       pane_id; /* part of the last pane on the way there; NO_ID: none */
    Vec3      position; /* m, world */
} PathStep;

#define PATH_STEPS_TOLD 6

/* One way by which light came, and where it began. */
typedef struct PathTale {
    PathStep step[PATH_STEPS_TOLD]; /* the first of them; panes that the eye looks straight
                                       through count too */
    int      count;                 /* all of them, also those that have no room */
    Vec3     towards; /* unit: from the eye, or the luxmeter, along the first stretch */
    LightSet source;
    int      source_id;             /* emitters: scene part; punctual: scene light; else 0 */
    int      pane_id;               /* part of the last pane that the light passed on its way to
                                       the last step; NO_ID: none */
    int      reached_by;            /* as pane_id, to where the path is now */
    Vec3     from;                  /* where it began, m, world; is_far: the unit direction
                                       towards it */
    bool     is_far;
    const float       *lanes;       /* its radiance, W m^-2 sr^-1 nm^-1 per lane; of a display
                                       that is seen by its measured XYZ NULL, unless wanted */
    const Wavelengths *wavelengths; /* of the lanes */
} PathTale;

/* Is told all light that a path finds, way by way: XYZ, cd m^-2; they add up to the result. */
typedef struct PathListener {
    void (*hear)(void *user, const PathTale *tale, const float xyz[3]);
    void  *user;
    bool   with_lanes;  /* displays' lanes are wanted, too */
    bool   of_emitters; /* it is told of these alone */
    float *all;         /* of path_illuminance_told: XYZ of all light is put here; or NULL */
} PathListener;

/* Counts of one thread; add them up. */
typedef struct PathStatistics {
    uint64_t samples;
    uint64_t camera_rays, bounce_rays, shadow_rays;
} PathStatistics;

/* What one path found. */
typedef struct PathResult {
    float    xyz[3];    /* cd m^-2, along the ray against its direction */
    bool     hit;       /* the ray met a surface (windows passed and holes do not count): */
    Hit      first;     /* t counted from the ray's origin */
    Vec3     direction; /* of the ray there */
    Spectrum through;   /* share per lane of what it sends that the panes before it let pass */
    float    mirror[3]; /* of xyz: what came by way of that surface's mirror, if it is a
                           display; else 0 */
    float    stokes[3]; /* S1, S2, S3, luminances, cd m^-2, where the context's eye asks */
    float    lambertian[3]; /* of xyz: what that display scattered by its lambertian part, if
                               path_trace_apart was asked; else 0 */
} PathResult;

/* As path_trace, for a listener. */
void path_trace_told(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                     Sampler *sampler, const PathListener *listener,
                     PathStatistics *statistics);

/* As path_illuminance, for a listener: XYZ in lx. */
void path_illuminance_told(const PathContext *context, LitPoint point,
                           const Wavelengths *wavelengths, Sampler *sampler,
                           const PathListener *listener, PathStatistics *statistics);

/* Radiance along `ray` at the given wavelengths, as tristimulus values. */
void path_trace(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                Sampler *sampler, PathResult *out, PathStatistics *statistics);

/* What is told of a path besides. */
typedef struct PathApart {
    PathResult         *result;
    bool                with_lambertian; /* of a display that the eye sees, from the haze */
    const PathListener *listener;        /* NULL: nobody */
} PathApart;

/* As path_trace, the same bits; and tells what is asked. */
void path_trace_apart(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                      Sampler *sampler, const PathApart *apart, PathStatistics *statistics);

#define PATH_PLACES_MAX 8

/* Where a path scattered widely: just off the surfaces, on the side that was looked at. */
typedef struct PathPlaces {
    int      count;
    LitPoint place[PATH_PLACES_MAX];
} PathPlaces;

/* Follows a path for the places it comes by; the context must have a guide, lit or not. */
void path_find_places(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                      Sampler *sampler, PathPlaces *out, PathStatistics *statistics);

/* A place that is lit, and the unit direction from there to what lights it. */
typedef struct PathArrival {
    LitPoint point;
    Vec3     towards;
} PathArrival;

/* Luminances, cd m^-2, that arrive: of the sky that is seen there; and of all else that the
 * point's own light samples would hardly find: each kind of light is weighed as if the
 * direction had been chosen with a density of 1 per steradian. */
void path_arriving(const PathContext *context, const PathArrival *at,
                   const Wavelengths *wavelengths, Sampler *sampler, float cd_m2[GUIDE_AIMS],
                   PathStatistics *statistics);

#define PATH_WAYS 16 /* of a vertex: a ray or two each, beside hundreds of its questions */

/* Light from infinitely far as a question: from where does it reach the eye, and how much? */
typedef struct PathFar {
    const Vec3 *towards; /* unit; every scattering vertex asks all of them */
    int         count;
    /* share: of the radiance from towards[i], per steradian, what comes to the eye by way of
     * vertex `bounce` (0: the first surface that scatters), per lane. pdf: with which ways find
     * that direction from there, too, sr^-1; 0: none does. */
    void (*add)(void *user, int i, int bounce, const float *share, float pdf);
    /* Paths that leave by a mirror or straight on, after `bounce` vertices: share of the
     * radiance from there. pdf: 0, or of a way that left by a sharp lobe, sr^-1. */
    void (*add_escaped)(void *user, Vec3 direction, int bounce, const float *share, float pdf);
    /* Of a ray: what leaves so is told here instead, with the surfaces on its way, and what
     * scatters is not followed; or NULL. */
    void (*add_image)(void *user, const PathTale *tale, Vec3 direction, const float *share);
    void *user;
    bool  is_of_mirror; /* where a display comes first, its mirror alone is followed */
    bool  has_ways; /* vertices send out PATH_WAYS rays each, which mirrors and sharp lobes lead
                       on: what leaves so is told of these, not of paths */
} PathFar;

/* Follows a path and asks; no light of the scene counts. */
void path_ask_far(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                  Sampler *sampler, const PathFar *far, PathStatistics *statistics);

/* The same of a luxmeter's head at the point: shares are of tristimulus values in lx. */
void path_ask_far_at(const PathContext *context, LitPoint point, const Wavelengths *wavelengths,
                     Sampler *sampler, const PathFar *far, PathStatistics *statistics);

/* Illuminance of a plane at the point, facing its normal, as tristimulus values in lx: what a
 * white Lambert surface would send back, times pi. */
void path_illuminance(const PathContext *context, LitPoint point,
                      const Wavelengths *wavelengths, Sampler *sampler, float xyz_lx[3],
                      PathStatistics *statistics);
