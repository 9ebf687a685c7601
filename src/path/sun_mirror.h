/* SPDX-License-Identifier: Apache-2.0 */
/* sun_mirror.h -- sunlight by way of one mirror, as a light sample.
 *
 * Light that goes sun, mirror (src/mirror), surface that spreads it, was found by whoever
 * scattered into the sun's image by chance: a rare and blinding find. Here the points of all
 * mirrors are told that turn one direction of the sun's disc to the surface. Each counts as a
 * light of that direction; chance then leaves the sun in a mirror out (sun_mirror_is_known).
 *
 * Not known    what passes a second mirror on its way or is refracted, mirrors seen from
 *              within a solid, mirrors bent by a normal map, rough ones above GLINT_ALPHA.
 * Threads      pure functions.
 */
#pragma once
#include "light/light.h"
#include "mirror/mirrors.h"
#include "path/surface.h"

/* Who asks: a lit position in air, and one direction of the sun. */
typedef struct SunMirrorQuestion {
    const Scene         *scene;
    const SurfaceTables *tables;
    const Wavelengths   *wavelengths;
    Vec3                 from; /* m, world */
    LightSample          sun;
    Spectrum             radiance; /* of the sun there */
    bool                 is_rough; /* of rough mirrors' facets; else of smooth ones */
} SunMirrorQuestion;

/* One way. */
typedef struct SunMirror {
    LightSample light;    /* the mirror's point as a light */
    Spectrum    radiance; /* that it sends, over the density of its direction */
    Surface     surface;  /* the mirror's; light and sun are in front of it */
} SunMirror;

/* The way by a point of a triangle that mirrors_find told of; mirror's t is not asked. False:
 * no light comes by it. What stands between is not asked either. */
bool sun_mirror_at(const SunMirrorQuestion *question, const Hit *mirror, float spread,
                   SunMirror *out);

/* Was the sun, found behind this mirror by a ray in air that came along -wo, told to the pair's
 * part before? The pair's triangle is the mirror's. */
bool sun_mirror_is_known(const Scene *scene, const Mirrors *mirrors, MirrorPair pair,
                         const Surface *mirror, Vec3 wo);

/* Of f = bsdf_eval at a rough mirror that was asked: what the sun's samples and chance have to
 * find themselves. */
Spectrum sun_mirror_left(const Bsdf *mirror, Vec3 local_wo, Vec3 local_wi, Spectrum f);

/* The same as a share of what a BSDF sample there carries; 0 by the smooth boundary. */
Spectrum sun_mirror_share(const Bsdf *mirror, Vec3 local_wo, const BsdfSample *next);
