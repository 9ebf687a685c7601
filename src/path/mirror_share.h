/* SPDX-License-Identifier: Apache-2.0 */
/* mirror_share.h -- light in a mirror counts once: what a vertex sampled there (mirrored.h) its
 * paths leave out. HOT.
 */
#pragma once
#include "path/path_state.h"

/* Are lights of the set sampled in mirrors at all? */
bool mirrors_are_sampled(const PathContext *context, BeamSet set);

/* Is the mirror's normal the interpolated one, and what wo points to in front of it in air? */
bool mirror_is_plain(const Scene *scene, const Surface *mirror, Vec3 wo);

/* Share of the sun, if the path meets it by `next`, that the vertex before did not sample. */
Spectrum mirrored_sun_share(const PathState *path, const Surface *surface, Vec3 wo,
                            const BsdfSample *next);

/* Is a number in [0, 1) too large for mirrored_prob, wherever on the surface's side the path is?
 * That is known in a moment. */
bool mirrored_is_left(const PathState *path, const Surface *surface, Vec3 wo, BeamSet set, float u);

/* How much rarer than mirror_beams_prob the surface samples the set's mirrors; 0: it has none. Of
 * the sun in readings 1: they have few paths, one of which would bring much. */
float mirrored_rarity(const PathState *path, BeamSet set);

/* The least of mirrored_prob, where it is above 0. */
float mirrored_least(const PathState *path, const Surface *surface, BeamSet set);

/* Probability with which the surface, which the path reached against wo, samples the set's
 * mirrors (mirrored.h). */
float mirrored_prob(const PathState *path, const Surface *surface, Vec3 wo, BeamSet set);

/* The path is about to be turned by `next`: which mirror that is for path->way, and whether
 * compact emitters in it are sampled. */
MirrorWay mirrored_way(const PathState *path, const Surface *surface, Vec3 wo,
                       const BsdfSample *next);

/* The density by area, m^-2, with which a vertex samples a compact emitter's point in a mirror;
 * 0: not. chance: that of finding it so by chance. */
typedef struct MirrorDensity {
    float sampled, chance;
} MirrorDensity;

/* Of the point that the path, which left path->way, met on an emitter; cosine: of its way there. */
MirrorDensity mirrored_density(const PathState *path, int part_id, Vec3 point, float cosine);

/* What of f, the surface's bsdf_eval for a light sample, the vertex before did not sample in it
 * as in a rough mirror. */
Spectrum mirrored_left(const PathState *path, const Surface *surface, Vec3 wo,
                       const LightSample *light, Vec3 local_wi, Spectrum f);
