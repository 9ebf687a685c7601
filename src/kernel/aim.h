/* SPDX-License-Identifier: Apache-2.0 */
/* aim.h -- what one eye sees of one surface, sampled outside a frame: by the light that is
 * there now, or as a response to light from any direction. A luxmeter may stand in the eye's
 * place.
 *
 * Units    cd m^-2, or lx of a luxmeter; responses per lane of a path's wavelengths
 *          (spectrum/wavelengths.h): of the radiance, W m^-2 sr^-1 nm^-1, that comes from
 *          there.
 * Threads  const jobs; each call writes to its caller's memory.
 */
#pragma once
#include "camera/camera.h"
#include "hemisphere/geodesic.h"
#include "path/collect/distant.h"
#include "path/collect/history.h"
#include "path/path.h"

/* Edges of a parallelogram, m. */
typedef struct ProbePatch {
    Vec3 along, down;
} ProbePatch;

/* A pixel of a frame: path i is its sample i, with the frame's seed. */
typedef struct ProbePixel {
    const Camera *camera;
    int x, y;
} ProbePixel;

/* An eye and the points that it looks at, one path each; more paths than points begin again. */
typedef struct ProbeAim {
    const PathContext *context;
    Vec3 eye;            /* m, scene */
    const Vec3 *targets; /* of surfaces that the eye sees */
    int target_count;
    const ProbePatch *patches; /* of which targets are the middles: paths go anywhere within;
                                  NULL: to the targets themselves */
    bool is_spread;            /* paths take points by chance, evenly, however few they are */
    const LitPoint *meter;     /* a luxmeter instead: eye and targets do not count; or NULL */
    const ProbePixel *pixel;   /* a frame's pixel instead of targets; or NULL */
    const Curve *colour;       /* of glasses before an eye: weighs each wavelength; NULL: 1 */
    uint32_t seed;
} ProbeAim;

/* The light that one path found, XYZ. */
typedef struct ProbeLook {
    float reflected[3]; /* all but what the first surface emits; of a luxmeter all */
    float mirror[3];    /* of it, via a display's mirror */
    bool is_found;      /* the first surface is a display, or a luxmeter's; else these are 0 */
    int target;         /* of the aim, that it went to; of a luxmeter or a pixel 0 */
} ProbeLook;

/* HOT. Path i of [first, end) fills out[i - first]. */
void aim_look(const ProbeAim *aim, int first, int end, ProbeLook *out, PathStatistics *statistics);

/* HOT. Reports all light that paths [first, end) find. */
void aim_trace(const ProbeAim *aim, int first, int end, const PathListener *listener,
               PathStatistics *statistics);

/* ---- responses --------------------------------------------------------------------------- */

/* The sphere in triangles: those of the upper hemisphere (+Y up), then their mirror images. */
typedef struct ProbeCells {
    const Geodesic *geodesic;
    const GeodesicSampler *samplers; /* of the upper ones */
    int level;
    int count;        /* of the whole sphere */
    const int *asked; /* by every path of this call */
    int asked_count;
    const float *every; /* [cell] it is sampled by one in so many calls */
} ProbeCells;

#define PROBE_ORDERS 2 /* light that the first vertex sends to the eye; all other */

/* The direction, world, that stands for a cell. */
Vec3 aim_cell_center(const ProbeCells *cells, int cell);

/* Where answers are added, and room for as many directions as are sampled. */
typedef struct ProbeAnswers {
    float *sums;
    Vec3 *towards;
    long near_suns; /* aim_sample_suns by mirror: paths whose mirror direction lies near one,
                       whatever stands before it */
} ProbeAnswers;

/* HOT. Adds the sum over paths to sums[order][cell][lane]: what comes to the eye of a radiance
 * of 1 from all of the cell. */
void aim_sample_cells(const ProbeAim *aim, const ProbeCells *cells, int first, int end,
                      ProbeAnswers *out, PathStatistics *statistics);

/* Discs of one size in the sky. */
#define PROBE_NEAR_SUN 4 /* radii from a sun's centre that are near it */
typedef struct ProbeSuns {
    const Vec3 *towards; /* unit, world: their centres; by_mirror: their y rises */
    int count;
    float radius;   /* radians, above 0 */
    bool by_mirror; /* the first vertex's mirror is sampled, else what scatters */
} ProbeSuns;

/* HOT. Adds the sum over paths to sums[sun][lane]: what the first vertex sends to the eye of an
 * irradiance of 1 on a plane that faces the sun. */
void aim_sample_suns(const ProbeAim *aim, const ProbeSuns *suns, int first, int end,
                     ProbeAnswers *out, PathStatistics *statistics);

/* ---- mirror images ----------------------------------------------------------------------- */

/* Called for each way from the eye out of the scene that meets smooth surfaces alone and is
 * reflected by at least one of them: part_id is that of the first such, `direction` (unit,
 * world) that in which the way leaves, share the part of the radiance from there that comes to
 * the eye, per lane. */
typedef struct ProbeImages {
    void (*found)(void *user, int part_id, Vec3 direction, const float *share);
    void *user;
} ProbeImages;

/* HOT. For paths [first, end) of an eye. */
void aim_sample_images(const ProbeAim *aim, int first, int end, const ProbeImages *images,
                       PathStatistics *statistics);
