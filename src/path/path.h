/* SPDX-License-Identifier: Apache-2.0 */
/* path.h -- light along one ray: the loop that everyone reads first.
 *
 * A path starts from a ray or from a point that is lit. Collectors (path_collector.h, collect/)
 * take from it what is required besides its light.
 *
 * Units    spectral radiance in W m^-2 sr^-1 nm^-1 inside; the result is CIE XYZ in cd m^-2.
 * Threads  const context; one PathStatistics a thread.
 */
#pragma once
#include "path/path_state.h"

/* All that paths need besides scene, ray tracer and lights, which must outlive the context. The
 * tables come from the arena. Strategy: PATH_MIS. */
PathContext path_context_build(const Scene *scene, const Bvh *bvh, const Lights *lights,
                               int max_bounces, Arena *arena);

/* All of that but the lights: to be relit before any path. */
PathContext path_context_unlit(const Scene *scene, const Bvh *bvh, int max_bounces, Arena *arena);

/* The same for a frame's pixels: lamps and small emitters are sampled in those mirrors alone by
 * which beams came to a part (mirror_beams.h), and points of no part do not sample them. */
PathContext path_context_of_frame(const Scene *scene, const Bvh *bvh, const Lights *lights,
                                  int max_bounces, Arena *arena);

/* Likewise for an estimate, built in a moment: rough solids without their tables (SURFACE_SKETCH).
 */
PathContext path_context_sketch(const Scene *scene, const Bvh *bvh, const Lights *lights,
                                int max_bounces, Arena *arena);

/* The same scene under another sky or other levels; what surfaces need, and what mirrors do with
 * the light of lamps, is shared with `before`. */
PathContext path_context_relight(const PathContext *before, const Lights *lights, Arena *arena);

/* The same scene under the same sky, with other levels of its displays: what the sun's rays do is
 * shared with `before`, too. The same bits as path_context_relight. */
PathContext path_context_relevel(const PathContext *before, const Lights *lights, Arena *arena);

/* Finds, for all contexts that are relit from this one, what mirrors do with the scene's lamps. */
void path_context_know_lamps(PathContext *context, const Lights *lights, Arena *arena);

/* Where a path begins, and its inputs. */
typedef struct PathStart {
    const PathContext *context;
    const Wavelengths *wavelengths;
    Sampler *sampler;                /* behind the numbers that chose ray and wavelengths */
    PathStatistics *statistics;      /* added to */
    struct PathCollector *collector; /* NULL: the light alone is requested */
    PathManner manner;
    const LitPoint *from; /* the ray begins there, as if the point had scattered it, by a
                             density of 1 per steradian; NULL: it comes to an eye */
} PathStart;

/* The result of one path. */
typedef struct PathResult {
    float xyz[3];         /* cd m^-2, along the ray against its direction */
    bool hit;             /* the ray met a surface (windows passed and holes do not count): */
    Hit first;            /* t counted from the ray's origin */
    Vec3 direction;       /* of the ray there */
    Spectrum through;     /* share of its light that the panes before it let pass, per lane; */
    bool through_is_grey; /* these treat all wavelengths alike */
    float mirror[3];      /* of xyz: what came via that surface's mirror, if it is a
                             display; else 0 */
} PathResult;

/* Radiance along `ray` as tristimulus values, and the first surface that the eye sees there.
 * out may be NULL, where only collectors take results. */
void path_from_ray(const PathStart *start, Ray ray, PathResult *out);

/* Illuminance of a plane at the point, facing its normal, as tristimulus values in lx: what a
 * white Lambert surface would send back, times pi. */
void path_from_point(const PathStart *start, LitPoint point, float xyz_lx[3]);

/* The context for a luxmeter there: a few paths tell how much of its light comes by mirrors, and
 * how often it searches them; with it path_from_point takes less time, and keeps its mean. */
PathContext path_context_of_meter(const PathContext *context, LitPoint head);

/* For collectors that follow another path from a state of its own: it leaves the surface,
 * which it reached against wo, by `next` and is traced to its end. */
void path_follow(PathState *path, const Surface *surface, Vec3 wo, const BsdfSample *next);
