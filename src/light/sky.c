/* SPDX-License-Identifier: Apache-2.0 */
#include "light/sky.h"

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/units.h"
#include "spectrum/photometry.h"

#define SUN_KELVIN 5500.0

/* ---- the sun ---------------------------------------------------------------------------- */

/* A black body scaled to a luminance of 1 cd m^-2. */
static void black_body_curve(double kelvin, Curve *out) {
    for (int i = 0; i < CURVE_COUNT; i++)
        out->value[i] = (float)black_body_radiance(CURVE_FIRST_NM + i, kelvin);
    float scale = (float)(1 / luminance_cd_m2(out->value, CURVE_COUNT, CURVE_FIRST_NM, 1));
    for (int i = 0; i < CURVE_COUNT; i++) out->value[i] *= scale;
}

/* Puts a disc of this radius at a place of the sky. */
static void place_sun(Sky *sky, double radius, float scene_azimuth, float elevation) {
    double half = sin_d(radius / 2);
    sky->has_sun = true;
    sky->sun_direction = vec3_normalize(sky_model_direction(scene_azimuth, elevation));
    sky->sun_radius = (float)radius;
    sky->sun_chord2 = (float)(4 * half * half);
    sky->sun_solid_angle = (float)(4 * PI * half * half);
}

static void build_sun(const Environment *environment, float turn, Sky *sky) {
    double radius = (double)environment->sun_angular_radius, disc = sin_d(radius);
    place_sun(sky, radius, environment->sun_azimuth - turn, environment->sun_elevation);
    sky->sun_luminance = (float)((double)environment->sun_illuminance_lx / (PI * disc * disc));
    black_body_curve(SUN_KELVIN, &sky->sun_curve);
    sun_limb_curves(sky->sun_limb);
}

static void place_moon(Sky *sky, const Night *night, float turn) {
    Vec3 sun = sky_model_direction((float)night->sun_azimuth - turn, (float)night->sun_elevation);
    place_sun(sky, night->moon_radius, (float)night->moon_azimuth - turn,
              (float)night->moon_elevation);
    float along = vec3_dot(sun, sky->sun_direction);
    Vec3 across = vec3_sub(sun, vec3_scale(sky->sun_direction, along));
    sky->is_moon = true;
    sky->moon_lit =
        vec3_length(across) > 0 ? vec3_normalize(across) : frame_from_z(sky->sun_direction).x;
}

/* Squared distance from the disc's centre over that of its rim; 1 or more: beside it. */
static float sun_share2(const Sky *sky, Vec3 direction) {
    Vec3 apart = vec3_sub(direction, sky->sun_direction);
    return sky->has_sun ? vec3_dot(apart, apart) / sky->sun_chord2 : 1;
}

/* sin a / sin r from chords: sin^2 a = chord^2 (1 - chord^2 / 4). A model's sun is so small
 * that the chords' own ratio is the same. */
static float sine_share(const Sky *sky, float share2) {
    float rim = sky->sun_chord2;
    return safe_sqrtf(share2 * (1 - 0.25f * share2 * rim) / (1 - 0.25f * rim));
}

static Spectrum moon_radiance(const Sky *sky, Vec3 direction, float share2,
                              const Wavelengths *wavelengths) {
    Vec3 apart = vec3_sub(direction, sky->sun_direction);
    float x = vec3_dot(apart, sky->moon_lit) / sqrtf(sky->sun_chord2);
    return night_moon(sky->model->daylight->night, x, share2, wavelengths);
}

Spectrum sun_radiance(const Sky *sky, Vec3 direction, const Wavelengths *wavelengths) {
    float share2 = sun_share2(sky, direction);
    if (!(share2 < 1)) return spectrum_all(0);
    if (sky->model) {
        if (direction.y < sky->model->edge[SKY_MODEL_ROWS]) return spectrum_all(0);
        if (sky->is_moon) return moon_radiance(sky, direction, share2, wavelengths);
        return daylight_sun(sky->model->daylight, safe_sqrtf(share2), wavelengths);
    }
    return sun_limb_shade(sky->sun_limb, sine_share(sky, share2), wavelengths) *
           curve_lookup(&sky->sun_curve, wavelengths) * spectrum_all(sky->sun_luminance);
}

float sun_pdf(const Sky *sky, Vec3 direction) {
    return sun_share2(sky, direction) < 1 ? 1 / sky->sun_solid_angle : 0;
}

/* Uniform on the cone: 1 - cos = u (1 - cos r), kept as a small number for precision. A share
 * of 2e-5 of the radius is left out at the rim, so that rounding never leaves the disc. */
Vec3 sun_sample(const Sky *sky, float u0, float u1) {
    float sine, cosine, away = 0.5f * sky->sun_chord2 * u0 * 0.99996f;
    float across = safe_sqrtf(away * (2 - away));
    Frame frame = frame_from_z(sky->sun_direction);
    sincos_turns(u1, &sine, &cosine);
    return frame_to_world(&frame, vec3(across * cosine, across * sine, 1 - away));
}

/* ---- the sky ---------------------------------------------------------------------------- */

static bool build_model(const Environment *environment, float turn, Arena *arena, Sky *sky,
                        Error *err) {
    if (!sky_model_build(environment, turn, arena, &sky->model, err)) return false;
    const Daylight *daylight = sky->model->daylight;
    if (daylight->has_sun)
        place_sun(sky, daylight->sun_radius, (float)daylight->sun_azimuth - turn,
                  (float)daylight->sun_elevation);
    else if (daylight->night && daylight->night->has_moon) place_moon(sky, daylight->night, turn);
    return true;
}

bool sky_build(const Environment *environment, Arena *arena, Sky *out, Error *err) {
    /* Compass azimuth of scene azimuth 0 (-Z): the heading, less the forward vector's own. */
    float turn = environment->heading - atan2_f(environment->forward.x, -environment->forward.z);
    Sky sky = {.kind = environment->kind};
    for (int i = 0; i < 3; i++)
        sky.constant_rgb[i] = environment->luminance_cd_m2 * environment->color[i];
    if (sky.kind == ENVIRONMENT_CONSTANT && !(luminance_from_rgb(sky.constant_rgb) > 0))
        sky.kind = ENVIRONMENT_NONE;
    if (sky.kind == ENVIRONMENT_HDRI &&
        !sky_picture_build(environment, turn, arena, &sky.picture, err))
        return false;
    if (sky.kind >= ENVIRONMENT_CIE) {
        if (!build_model(environment, turn, arena, &sky, err)) return false;
    } else if (environment->has_sun && environment->sun_illuminance_lx > 0) {
        build_sun(environment, turn, &sky);
    }
    *out = sky;
    return true;
}

SkySample sky_seen(const Sky *sky, Vec3 direction, Vec3 ns, const Wavelengths *wavelengths) {
    SkySample seen = {.direction = direction, .radiance = spectrum_all(0)};
    float picture[3];
    const float *rgb = sky->constant_rgb;
    if (sky->kind == ENVIRONMENT_NONE) return seen;
    if (sky->model) {
        seen.radiance = sky_model_seen(sky->model, direction, wavelengths, &seen.pdf);
        return seen;
    }
    if (sky->kind == ENVIRONMENT_HDRI) {
        sky_picture_rgb(&sky->picture, sky_picture_place(&sky->picture, direction, &seen.pdf),
                        picture);
        rgb = picture;
    } else {
        seen.pdf = max_f(vec3_dot(direction, ns), 0) * INV_PI_F;
    }
    seen.radiance = spectrum_from_rgb_emission(wavelengths, rgb);
    return seen;
}

static Vec3 sample_cosine(Vec3 ns, float u0, float u1) {
    float sine, cosine, radius = safe_sqrtf(u0);
    Frame frame = frame_from_z(ns);
    sincos_turns(u1, &sine, &cosine);
    return frame_to_world(&frame, vec3(radius * cosine, radius * sine, safe_sqrtf(1 - u0)));
}

bool sky_choose(const Sky *sky, Vec3 ns, const float u[2], SkySample *sample) {
    if (sky->kind == ENVIRONMENT_NONE) return false;
    if (sky->kind == ENVIRONMENT_HDRI) {
        sky_picture_sample(&sky->picture, u[0], u[1], &sample->direction, &sample->at,
                           &sample->pdf);
    } else if (sky->model) {
        sample->direction = sky_model_sample(sky->model, u[0], u[1]);
        sample->pdf = sky_model_pdf(sky->model, sample->direction);
    } else {
        sample->direction = sample_cosine(ns, u[0], u[1]);
        sample->pdf = max_f(vec3_dot(sample->direction, ns), 0) * INV_PI_F;
    }
    return sample->pdf > 0;
}

void sky_towards(const Sky *sky, Vec3 direction, Vec3 ns, SkySample *sample) {
    sample->direction = direction;
    if (sky->kind == ENVIRONMENT_HDRI)
        sample->at = sky_picture_place(&sky->picture, direction, &sample->pdf);
    else if (sky->model) sample->pdf = sky_model_pdf(sky->model, direction);
    else sample->pdf = max_f(vec3_dot(direction, ns), 0) * INV_PI_F;
}

Spectrum sky_radiance(const Sky *sky, const SkySample *chosen, const Wavelengths *wavelengths) {
    float rgb[3];
    if (sky->kind != ENVIRONMENT_HDRI)
        return sky_seen(sky, chosen->direction, chosen->direction, wavelengths).radiance;
    sky_picture_rgb(&sky->picture, chosen->at, rgb);
    return spectrum_from_rgb_emission(wavelengths, rgb);
}
