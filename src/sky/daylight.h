/* SPDX-License-Identifier: Apache-2.0 */
/* daylight.h -- the sun and the sky of a place, a time and a weather, ready to be evaluated.
 *
 * Three kinds: CIE's general skies and Perez's (a shape times one spectrum, normalised by own
 * quadrature to the diffuse illuminance; on the ground only, below the horizon a uniform
 * Lambertian ground lit by sun and sky), and the clear atmosphere (atmosphere.h) for any
 * observer up to 60 km.
 *
 * Lux       of Perez's skies: irradiance times luminous_efficacy.h's fit, or given.
 * Spectra   sun: SPECTRL2's direct beam; clear skies its diffuse, overcast ones its global
 *           spectrum, between them by clearness: their colour alone, scaled to the lux. The
 *           atmosphere: its own scattering times the sun's spectrum outside the air and what
 *           water vapour and oxygen let through.
 * Low sun   Perez's sky stands for a sun down to 4 degrees below the horizon too, as at the
 *           horizon and without direct light.
 * Night     once no part of the sun is up, the clear atmosphere has the moon (of a time) and
 *           the night's background too (night.h); the moon then is the disc with a beam.
 * Frame     azimuth from north over east, elevation from the horizontal, radians; the sun's
 *           elevation here is the apparent one (refraction lifts it).
 * Units     spectral radiance in W m^-2 sr^-1 nm^-1, 360..830 nm; lx; cd m^-2.
 * Memory    the arena's. Threads: const once built; HOT: daylight_radiance, daylight_sun.
 * Fails     on inputs that make no sky, naming the member.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "sky/luminous_efficacy.h"
#include "sky/night.h"
#include "sky/sky_shape.h"
#include "sky/sun_position.h"
#include "spectrum/curve.h"

typedef enum DaylightKind { DAYLIGHT_CIE, DAYLIGHT_PEREZ, DAYLIGHT_CLEAR } DaylightKind;

typedef enum FloorKind { FLOOR_LAND, FLOOR_SEA, FLOOR_CLOUD } FloorKind;

/* From where the water vapour of a sky is known: for readers. */
typedef enum WaterSource { WATER_ASSUMED, WATER_GIVEN, WATER_DEW_POINT } WaterSource;

typedef struct DaylightInput {
    DaylightKind kind;
    bool has_time, has_sun; /* one of them at least, except for uniform and overcast CIE */
    SkyTime when;
    SkyPlace where;
    double sun_azimuth, sun_elevation; /* has_sun: apparent; overrides the time's */
    double sun_lux;                    /* direct normal; negative: the model's own, of Perez what is
                                          measured, whose shape and diffuse light it leaves */
    int cie_type;                      /* 1..16 */
    double diffuse_lux;                /* CIE, or Perez with has_lux: horizontal */
    double direct_w_m2, diffuse_w_m2;  /* Perez: normal, horizontal; they give the shape, */
    bool has_lux;                      /* and the lux, unless these are given: */
    double direct_lux;                 /* normal; and diffuse_lux */
    double turbidity;                  /* or, when above 0, visibility_km at 550 nm instead */
    double visibility_km;
    double ozone_atm_cm, water_cm, albedo; /* albedo below 0: the floor's own */
    WaterSource water_source;
    FloorKind floor;
    double cloud_top_m;
    double cloud_relief_m; /* clear, of clouds: cloud_relief.h; 0: an even floor */
    bool no_moon;          /* clear: as if there were none */
    int integral_steps;    /* CIE, Perez: of the quadrature; 0: 1000, which takes 0.1 s
                              (its error by steps: sky_shape_integral) */
    bool sun_alone;        /* clear: of its light nothing but the sun's is required */
    int threads;
} DaylightInput;

DaylightInput daylight_input_default(DaylightKind kind);

/* For people and scripts. */
typedef struct DaylightMetrics {
    double sun_azimuth_deg, sun_elevation_deg, sun_zenith_deg; /* apparent */
    double true_elevation_deg, refraction_deg, distance_au, horizon_deg;
    double direct_normal_lx, diffuse_horizontal_lx, global_horizontal_lx;
    double direct_normal_w_m2, diffuse_horizontal_w_m2; /* 300..4000 nm */
    LuminousEfficacy efficacy; /* Perez, of the disc when it is up; NaN: no such light,
                                  or sun_lux is given */
    double zenith_cd_m2, sun_xy[2], zenith_xy[2], floor_cd_m2;
    double air_mass;
    bool is_sun_up;     /* part of its disc at least */
    NightMetrics night; /* clear; its light is part of the figures above */
} DaylightMetrics;

typedef struct Daylight {
    DaylightInput input;
    DaylightMetrics metrics;
    double horizon; /* elevation of the edge between sky and floor, radians */
    /* CIE, Perez */
    SkyShape shape;
    float shape_scale;            /* cd m^-2 per unit of the shape */
    Curve sky_curve, floor_curve; /* spectral radiance of 1 cd m^-2; of the floor, whole */
    /* clear */
    LitAir sunlight;
    Night *night; /* NULL: part of the sun is up */
    /* the sun */
    bool has_sun;
    double sun_azimuth, sun_elevation, sun_radius;
    Curve sun_mean; /* disc's mean radiance */
    Curve limb[6];  /* sun_disc.h's coefficients, every nm */
} Daylight;

bool daylight_build(const DaylightInput *input, Arena *arena, Daylight *out, Error *err);

/* Elevation of the sun's upper rim over the edge of the floor (the dipped horizon), degrees:
 * below 0 the sun is down. */
double daylight_sun_clearance_deg(const DaylightInput *input);

/* Air along a ray from above over that straight up, for an apparent elevation of 0..90 degrees
 * (Kasten and Young 1989): by it light falls off. */
double daylight_air_mass(double elevation_deg);

/* Sky or floor. elevation and azimuth in radians. */
Spectrum daylight_radiance(const Daylight *daylight, float elevation, float azimuth,
                           const Wavelengths *wavelengths);

/* HOT. How far that is linearly polarised, across the plane of sun and direction, [0, 1]: the
 * sun's light in the clear atmosphere (atmosphere_polarised); the moon's and the night's own
 * is taken as unpolarised. Shapes have none: 0. */
Spectrum daylight_polarisation(const Daylight *daylight, float elevation, float azimuth,
                               const Wavelengths *wavelengths);

/* Its luminance, cd m^-2; of a cloud deck with a relief its mean. */
float daylight_luminance(const Daylight *daylight, float elevation, float azimuth);

/* Radiance of the disc at a sine of the angle to its centre over the sine of its radius. */
Spectrum daylight_sun(const Daylight *daylight, float share, const Wavelengths *wavelengths);
