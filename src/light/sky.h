/* sky.h -- what lies beyond the scene: the sky (constant or HDRI) and the sun's disc.
 *
 * Compass  azimuth runs from north over east. At heading h the vehicle's forward vector points
 *          to azimuth h; the sky turns, the scene stays.
 * HDRI     equirectangular; the left edge is north, the centre south (with no rotation, +Z of
 *          the scene, +X to its left: OpenEXR's latlong). Looked up bilinearly; negative and
 *          non-finite values count as 0.
 * Sun      a uniform disc; its irradiance on a plane that faces it is exact whatever its size:
 *          L = E / (pi sin^2 r). Spectrum: black body of 5500 K, close to a high sun's direct
 *          beam (CIE 1931 x, y = 0.332, 0.341).
 * Threads  const after sky_build.
 */
#pragma once
#include "scene/scene.h"
#include "spectrum/wavelengths.h"

typedef struct Sky {
    EnvironmentKind kind; /* NONE, CONSTANT or HDRI */
    float constant_rgb[3]; /* cd m^-2, linear Rec.709 */

    const float *pixels;   /* HDRI: RGBA, cd m^-2 after scale */
    int    width, height;
    float  scale;
    float  u_offset;       /* image u = azimuth in the scene / 2 pi + u_offset */
    const float *row_cdf;     /* height + 1 values from 0 to 1 */
    const float *column_cdf;  /* height rows of width + 1 values */
    const uint16_t *row_guide, *column_guide; /* where to begin looking in them */
    long   refused_pixels; /* had a negative or non-finite value */

    bool   has_sun;
    Vec3   sun_direction;  /* unit, scene */
    float  sun_radius;     /* radians */
    float  sun_solid_angle;
    float  sun_chord2;     /* squared distance of unit vectors one radius apart */
    float  sun_luminance;  /* cd m^-2 */
    Curve  sun_curve;      /* spectral radiance of 1 cd m^-2 */
} Sky;

/* Fails on an environment whose model is not there yet, naming it. */
bool sky_build(const Environment *environment, Arena *arena, Sky *out, Error *err);

/* A direction towards the sky: what comes from there, and with which density sky_sample would
 * choose it for a surface with shading normal ns (constant skies are sampled by the cosine
 * around it, pictures by their luminance). */
typedef struct SkySample {
    Vec3  direction;
    float rgb[3]; /* cd m^-2, linear Rec.709 */
    float pdf;    /* sr^-1 */
} SkySample;

SkySample sky_seen(const Sky *sky, Vec3 direction, Vec3 ns);
bool      sky_sample(const Sky *sky, Vec3 ns, float u0, float u1, SkySample *sample);

/* Zero off the disc. */
Spectrum sun_radiance(const Sky *sky, Vec3 direction, const Wavelengths *wavelengths);
float    sun_pdf(const Sky *sky, Vec3 direction);
Vec3     sun_sample(const Sky *sky, float u0, float u1);
