/* SPDX-License-Identifier: Apache-2.0 */
/* sky.h -- what lies beyond the scene: the sky (constant, a picture or a model) and the sun.
 *
 * Compass  azimuth runs from north over east. At heading h the vehicle's forward vector points
 *          to azimuth h; the sky turns, the scene stays.
 * Sun      its irradiance on a plane that faces it is exact for any size: the disc's mean
 *          radiance is E / (pi sin^2 r), darkened to its limb (sky/sun_disc.h) in every
 *          environment. Of a model (cie, perez, sky) the spectrum is the model's, and the
 *          horizon cuts the disc; else that of a black body of 5500 K, close to a high sun's
 *          direct beam (CIE 1931 x, y = 0.332, 0.341).
 * Moon     takes the sun's place in all that follows once no part of the sun is up (a model of
 *          type sky alone, sky/night.h): one disc at a time gives a beam.
 * Threads  const after sky_build.
 */
#pragma once
#include "light/sky_model.h"
#include "light/sky_picture.h"
#include "scene/scene.h"
#include "sky/sun_disc.h"
#include "spectrum/wavelengths.h"

typedef struct Sky {
    EnvironmentKind kind;
    float constant_rgb[3]; /* cd m^-2, linear Rec.709 */
    SkyPicture picture;    /* HDRI */
    const SkyModel *model; /* CIE, PEREZ, SKY; else NULL */

    bool has_sun;
    Vec3 sun_direction; /* unit, scene */
    float sun_radius;   /* radians */
    float sun_solid_angle;
    float sun_chord2;               /* squared distance of unit vectors one radius apart */
    float sun_luminance;            /* the disc's mean, cd m^-2; unless a model's */
    Curve sun_curve;                /* spectral radiance of 1 cd m^-2 */
    Curve sun_limb[SUN_LIMB_TERMS]; /* sun_disc.h's; unless a model's */
    bool is_moon;                   /* the disc is the moon's */
    Vec3 moon_lit;                  /* unit, scene: across the disc towards the side that is lit */
} Sky;

/* Fails on an environment that makes no sky, with the reason. */
bool sky_build(const Environment *environment, Arena *arena, Sky *out, Error *err);

/* A direction towards the sky: what comes from there, and with which density sky_choose would
 * choose it for a surface with shading normal ns (constant skies are sampled by the cosine
 * around it, others by their luminance). */
typedef struct SkySample {
    Vec3 direction;
    Spectrum radiance; /* W m^-2 sr^-1 nm^-1 */
    float pdf;         /* sr^-1 */
    Vec2 at;           /* sky_choose: where in the picture */
} SkySample;

SkySample sky_seen(const Sky *sky, Vec3 direction, Vec3 ns, const Wavelengths *wavelengths);

/* Chooses one by u in [0, 1)^2: all but its radiance, which sky_radiance gives once it
 * is known to arrive. False: nothing there. */
bool sky_choose(const Sky *sky, Vec3 ns, const float u[2], SkySample *sample);

/* As if sky_choose had chosen this direction, where there is a sky. */
void sky_towards(const Sky *sky, Vec3 direction, Vec3 ns, SkySample *sample);
Spectrum sky_radiance(const Sky *sky, const SkySample *chosen, const Wavelengths *wavelengths);

/* Zero off the disc, and below the horizon of a model. */
Spectrum sun_radiance(const Sky *sky, Vec3 direction, const Wavelengths *wavelengths);
float sun_pdf(const Sky *sky, Vec3 direction);
Vec3 sun_sample(const Sky *sky, float u0, float u1);
