/* SPDX-License-Identifier: Apache-2.0 */
/* sun_mirror.h -- sunlight by way of one mirror, as a light sample.
 *
 * BSDF samples find light that goes sun, mirror (src/mirror), scattering surface only where
 * they hit the sun's image: rare and very bright samples. Here all points of mirrors that turn
 * one direction of the sun's disc to the surface count as lights of that direction; BSDF
 * samples then leave the sun in these mirrors out (sun_mirror_is_known).
 *
 * Not known    what passes a second mirror on its way or is refracted, mirrors seen from
 *              within a solid, mirrors bent by a normal map, rough ones above GLINT_ALPHA.
 * Threads      pure functions.
 */
#pragma once
#include "light/light.h"
#include "mirror/mirrors.h"
#include "path/surface.h"

/* A lit position in air, and one direction of the sun. */
typedef struct SunMirrorQuestion {
    const Scene         *scene;
    const SurfaceTables *tables;
    const Wavelengths   *wavelengths;
    Vec3                 from; /* m, world */
    LightSample          sun;
    Spectrum             radiance; /* of the sun there */
    bool                 is_rough; /* by facets of rough mirrors; else by smooth ones */
} SunMirrorQuestion;

/* Sunlight by one point of a mirror. */
typedef struct SunMirror {
    LightSample light;    /* the mirror's point as a light */
    Spectrum    radiance; /* that it sends, divided by the density of its direction */
    Surface     surface;  /* the mirror's; light and sun are in front of it */
} SunMirror;

/* Sunlight by a point that mirrors_find reported; mirror->t is not used. False: none comes by
 * it. Occlusion is not tested. */
bool sun_mirror_at(const SunMirrorQuestion *question, const Hit *mirror, float spread,
                   SunMirror *out);

/* Did the pair's part ask for the sun that a ray in air, which came along -wo, finds behind
 * this mirror? The pair's triangle is the mirror's. */
bool sun_mirror_is_known(const Scene *scene, const Mirrors *mirrors, MirrorPair pair,
                         const Surface *mirror, Vec3 wo);

/* The rest of f = bsdf_eval at a rough mirror that was asked: left to sun samples and
 * chance. */
Spectrum sun_mirror_left(const Bsdf *mirror, Vec3 local_wo, Vec3 local_wi, Spectrum f);

/* The same as a share of what a BSDF sample there carries; 0 by the smooth boundary. */
Spectrum sun_mirror_share(const Bsdf *mirror, Vec3 local_wo, const BsdfSample *next);
