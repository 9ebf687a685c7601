/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/night.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "sky/sun_disc.h"
#include "spectrum/photometry.h"

#define LOWEST_MOON_DEG (-9.0)
#define EYE_LANE 8 /* of air.h: 560 nm */

static double luminance(const Curve *curve) {
    return luminance_cd_m2(curve->value, CURVE_COUNT, CURVE_FIRST_NM, 1);
}

NightMetrics night_moon_metrics(const MoonPosition *moon, double altitude_m, double horizon) {
    double pressure, celsius, radius_deg;
    standard_atmosphere(altitude_m, &pressure, &celsius);
    radius_deg = degrees_from_radians(moon_angular_radius(moon->topocentric_km));
    double lift = sun_refraction_deg(moon->elevation_deg, pressure, celsius);
    NightMetrics m = {.has_moon = true,
                      .moon_azimuth_deg = moon->azimuth_deg,
                      .moon_elevation_deg = moon->elevation_deg + lift,
                      .moon_distance_km = moon->topocentric_km,
                      .elongation_deg = moon->elongation_deg,
                      .phase_angle_deg = moon->phase_angle_deg,
                      .illuminated = moon->illuminated};
    m.is_moon_up = m.moon_elevation_deg + radius_deg > degrees_from_radians(horizon);
    return m;
}

/* The sun's spectrum at 1 au, and that of the moon's beam less what gases take on its way. */
static void moon_beam(const NightInput *in, double elevation_deg, Curve *sun, Curve *beam) {
    double gases[SPECTRL2_COUNT];
    Spectrl2 light = spectrl2(&in->above, 0, 1);
    spectrl2_gases(&in->above, fmin(89, 90 - elevation_deg), gases);
    for (int i = 0; i < CURVE_COUNT; i++) {
        double nm = CURVE_FIRST_NM + i;
        sun->value[i] = (float)spectrl2_read(light.outside, nm);
        beam->value[i] = (float)(spectrl2_read(light.outside, nm) * spectrl2_read(gases, nm));
    }
}

static void dim_to_moon(const MoonPosition *moon, Curve *beam) {
    Curve ratio;
    moon_over_sun(&(MoonDistances){moon->phase_angle_deg, moon->topocentric_km, moon->sun_moon_au},
                  &ratio);
    for (int i = 0; i < CURVE_COUNT; i++) beam->value[i] *= ratio.value[i];
}

/* The disc's mean radiance from its irradiance. */
static void set_disc(const NightInput *in, Night *out) {
    double sine = sin_d(out->moon_radius);
    double share = disc_share_above((out->moon_elevation - in->horizon) / out->moon_radius);
    lit_air_curve(&out->moonlight, out->moonlight.atmosphere.sun_passing, &out->moon_mean);
    out->metrics.moon_normal_lx = share * luminance(&out->moon_mean);
    for (int i = 0; i < CURVE_COUNT; i++) out->moon_mean.value[i] /= (float)(PI * sine * sine);
    out->disc = moon_disc(radians_from_degrees(in->moon->phase_angle_deg));
    out->has_moon = out->metrics.moon_normal_lx > 0;
}

static bool light_moon(const NightInput *in, const Curve *beam, Arena *arena, Night *out,
                       Error *err) {
    AtmosphereInput air = in->air;
    out->moon_azimuth = radians_from_degrees(in->moon->azimuth_deg);
    out->moon_elevation = radians_from_degrees(out->metrics.moon_elevation_deg);
    out->moon_radius = moon_angular_radius(in->moon->topocentric_km);
    out->sun_azimuth = radians_from_degrees(in->moon->sun_azimuth_deg);
    out->sun_elevation = radians_from_degrees(in->moon->sun_elevation_deg);
    air.sun_elevation = out->moon_elevation;
    air.sun_azimuth = out->moon_azimuth;
    if (!lit_air_build(&air, beam, arena, &out->moonlight, err)) return false;
    out->has_moonlight = out->metrics.is_moon_lit = true;
    const Atmosphere *lit = &out->moonlight.atmosphere;
    out->metrics.moon_sky_lx = lit_air_luminance(&out->moonlight, atmosphere_diffuse(lit));
    out->metrics.floor_cd_m2 += lit_air_luminance(&out->moonlight, lit->floor_exitance) / PI;
    set_disc(in, out);
    return true;
}

/* The optical depth of the air straight above the observer, at EYE_LANE. */
static double vertical_depth(const AtmosphereInput *in) {
    AirOptics optics = air_optics(&in->air);
    double column[AIR_PARTS], depth = 0;
    air_vertical(&optics, in->observer_m, AIR_TOP_M, column);
    for (int p = 0; p < AIR_PARTS; p++) depth += (double)optics.depth[p][EYE_LANE] * column[p];
    return depth;
}

bool night_build(const NightInput *input, Arena *arena, Night *out, Error *err) {
    Curve sun, beam;
    *out = (Night){0};
    if (input->moon)
        out->metrics = night_moon_metrics(input->moon, input->altitude_m, input->horizon);
    moon_beam(input, out->metrics.moon_elevation_deg, &sun, &beam);
    out->background = night_background(&(NightBackgroundInput){
        vertical_depth(&input->air), input->horizon, input->air.air.ground_albedo, &sun});
    out->metrics.background_lx = out->background.horizontal_lx;
    out->metrics.floor_cd_m2 = (double)out->background.floor_cd_m2;
    if (!input->moon || out->metrics.moon_elevation_deg < LOWEST_MOON_DEG) return true;
    dim_to_moon(input->moon, &beam);
    return light_moon(input, &beam, arena, out, err);
}

/* ---- queries ----------------------------------------------------------------------------- */

Spectrum night_radiance(const Night *night, float elevation, float azimuth,
                        const Wavelengths *wavelengths) {
    Spectrum value = curve_lookup(&night->background.curve, wavelengths) *
                     spectrum_all(night_background_luminance(&night->background, elevation));
    if (!night->has_moonlight) return value;
    return value + lit_air_radiance(&night->moonlight, elevation,
                                    azimuth - (float)night->moon_azimuth, wavelengths);
}

float night_luminance(const Night *night, float elevation, float azimuth) {
    float value = night_background_luminance(&night->background, elevation);
    if (!night->has_moonlight) return value;
    return value +
           (float)lit_air_luminance(&night->moonlight,
                                    atmosphere_radiance(&night->moonlight.atmosphere, elevation,
                                                        azimuth - (float)night->moon_azimuth));
}

void night_add_zenith(const Night *night, Curve *zenith) {
    float overhead = night_background_luminance(&night->background, 0.5f * PI_F);
    Curve moonlit = {{0}};
    if (night->has_moonlight)
        lit_air_curve(&night->moonlight,
                      atmosphere_radiance(&night->moonlight.atmosphere, 0.5f * PI_F, 0), &moonlit);
    for (int i = 0; i < CURVE_COUNT; i++)
        zenith->value[i] += moonlit.value[i] + overhead * night->background.curve.value[i];
}

Spectrum night_moon(const Night *night, float x, float distance2, const Wavelengths *wavelengths) {
    return curve_lookup(&night->moon_mean, wavelengths) *
           spectrum_all(moon_disc_shade(&night->disc, x, distance2));
}
