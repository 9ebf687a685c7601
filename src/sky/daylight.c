/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/daylight.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "sky/sun_beam.h"
#include "sky/sun_disc.h"
#include "spectrum/photometry.h"

#define ON_THE_GROUND_M 2500.0 /* an observer on land below this stands on the ground */
#define INTEGRAL_STEPS 1000
#define PEREZ_LOWEST_DEG (-4.0)            /* an hour's mean has light when the sun rises in it */
#define PEREZ_ZENITH_MAX (89.9 * PI / 180) /* of its fit */

DaylightInput daylight_input_default(DaylightKind kind) {
    return (DaylightInput){.kind = kind,
                           .sun_lux = -1,
                           .cie_type = 12,
                           .diffuse_lux = 10000,
                           .turbidity = 2.5,
                           .ozone_atm_cm = 0.34,
                           .water_cm = kind == DAYLIGHT_PEREZ ? WATER_USUAL_CM : 1.4,
                           .albedo = -1,
                           .cloud_top_m = 2000,
                           .threads = 1};
}

/* ---- where the sun stands --------------------------------------------------------------- */

static double floor_albedo(const DaylightInput *in) {
    static const double usual[] = {0.2, 0.06, 0.7};
    return in->albedo >= 0 ? in->albedo : usual[in->floor];
}

static double floor_altitude(const DaylightInput *in) {
    if (in->floor == FLOOR_CLOUD) return in->cloud_top_m;
    bool stands = in->floor == FLOOR_LAND && in->where.altitude_m < ON_THE_GROUND_M;
    return stands ? fmax(0, in->where.altitude_m) : 0;
}

static double floor_relief(const DaylightInput *in) {
    return in->floor == FLOOR_CLOUD ? in->cloud_relief_m : 0;
}

static int day_of_year(const SkyTime *time) {
    SkyTime first = {time->year, 1, 1, 0, 0, 0, 0},
            now = {time->year, time->month, time->day, 0, 0, 0, 0};
    return (int)(sky_julian_day(&now) - sky_julian_day(&first) + 1.5);
}

static void place_sun(Daylight *out) {
    const DaylightInput *in = &out->input;
    DaylightMetrics *f = &out->metrics;
    double pressure, celsius;
    f->distance_au = 1;
    out->sun_azimuth = in->sun_azimuth;
    out->sun_elevation = in->sun_elevation;
    f->true_elevation_deg = degrees_from_radians(in->sun_elevation);
    if (in->has_time) {
        double day = sky_julian_day(&in->when);
        SunPosition p = sun_position(day, sky_delta_t_s(day), &in->where);
        standard_atmosphere(in->where.altitude_m, &pressure, &celsius);
        f->distance_au = p.distance_au;
        if (!in->has_sun) {
            f->true_elevation_deg = p.elevation_deg;
            f->refraction_deg = sun_refraction_deg(p.elevation_deg, pressure, celsius);
            out->sun_azimuth = radians_from_degrees(p.azimuth_deg);
            out->sun_elevation = radians_from_degrees(p.elevation_deg + f->refraction_deg);
        }
    }
    out->sun_radius = sun_angular_radius(f->distance_au);
    f->sun_azimuth_deg = degrees_from_radians(out->sun_azimuth);
    f->sun_elevation_deg = degrees_from_radians(out->sun_elevation);
    f->sun_zenith_deg = 90 - f->sun_elevation_deg;
    f->air_mass = f->sun_zenith_deg < 90 ? air_mass(f->sun_zenith_deg) : 0;
}

double daylight_air_mass(double elevation_deg) {
    return air_mass(90 - elevation_deg);
}

double daylight_sun_clearance_deg(const DaylightInput *input) {
    Daylight probe = {.input = *input};
    place_sun(&probe);
    double rise = fmax(0, input->where.altitude_m - floor_altitude(input));
    double dip = input->kind == DAYLIGHT_CLEAR ? horizon_dip_deg(rise) : 0;
    return degrees_from_radians(probe.sun_elevation + probe.sun_radius) + dip;
}

static double sun_share(const Daylight *out) {
    return disc_share_above((out->sun_elevation - out->horizon) / out->sun_radius);
}

/* ---- the air ----------------------------------------------------------------------------- */

/* Koschmieder's visibility: 3.912 over the extinction at 550 nm, of which molecules take
 * 0.0116 km^-1; the aerosol's scale height is air.h's 1.5 km. */
static double aerosol_depth(const DaylightInput *in) {
    if (!(in->visibility_km > 0)) return aerosol_depth_from_turbidity(in->turbidity);
    double at_550 = fmax(0, 3.912 / in->visibility_km - 0.0116) * 1.5;
    return at_550 * pow_d(550 / 500.0, 1.14);
}

static Air sea_level_air(const DaylightInput *in) {
    return (Air){1013.25,           in->water_cm, in->ozone_atm_cm,
                 aerosol_depth(in), 1.14,         floor_albedo(in)};
}

/* The air above the observer, for SPECTRL2. */
static Air air_above(const DaylightInput *in) {
    Air air = sea_level_air(in);
    double celsius, column[AIR_PARTS], altitude = fmax(0, in->where.altitude_m);
    AirOptics optics = air_optics(&air);
    standard_atmosphere(in->where.altitude_m, &air.pressure_mbar, &celsius);
    air_vertical(&optics, altitude, AIR_TOP_M, column);
    air.aerosol_depth *= column[AIR_AEROSOL];
    air.ozone_atm_cm *= column[AIR_OZONE];
    air.water_cm *= exp_d(-altitude / SUN_BEAM_WATER_SCALE_M);
    return air;
}

/* ---- spectra ----------------------------------------------------------------------------- */

static void curve_from_rows(const double value[SPECTRL2_COUNT], Curve *out) {
    for (int i = 0; i < CURVE_COUNT; i++)
        out->value[i] = (float)spectrl2_read(value, CURVE_FIRST_NM + i);
}

static double curve_luminance(const Curve *curve) {
    return luminance_cd_m2(curve->value, CURVE_COUNT, CURVE_FIRST_NM, 1);
}

static void scale_curve(Curve *curve, double factor) {
    for (int i = 0; i < CURVE_COUNT; i++) curve->value[i] *= (float)factor;
}

static void add_curve(Curve *to, const Curve *from, double factor) {
    for (int i = 0; i < CURVE_COUNT; i++) to->value[i] += (float)factor * from->value[i];
}

static void curve_xy(const Curve *curve, double xy[2]) {
    double xyz[3];
    xyz_from_radiance(curve->value, CURVE_COUNT, CURVE_FIRST_NM, 1, xyz);
    double sum = xyz[0] + xyz[1] + xyz[2];
    xy[0] = sum > 0 ? xyz[0] / sum : 0;
    xy[1] = sum > 0 ? xyz[1] / sum : 0;
}

/* SPECTRL2 for the sun where it stands, above the horizon at least a little. */
static Spectrl2 ground_spectra(const Daylight *out) {
    Air air = air_above(&out->input);
    double d = out->metrics.distance_au;
    return spectrl2(&air, fmin(89, out->metrics.sun_zenith_deg), 1 / (d * d));
}

/* The disc's mean radiance from an irradiance, and its figures. */
static void set_sun(Daylight *out, const Curve *irradiance) {
    double sine = sin_d(out->sun_radius), share = sun_share(out);
    out->sun_mean = *irradiance;
    scale_curve(&out->sun_mean, 1 / (PI * sine * sine));
    out->metrics.direct_normal_lx = share * curve_luminance(irradiance);
    out->metrics.is_sun_up = share > 0;
    out->has_sun = share > 0 && out->metrics.direct_normal_lx > 0;
    curve_xy(irradiance, out->metrics.sun_xy);
    sun_limb_curves(out->limb);
}

/* ---- CIE and Perez ----------------------------------------------------------------------- */

/* How clear: 0 the colour of sun and sky together (a white cloud's), 1 the blue sky's. */
static void sky_spectrum(Daylight *out, double clear, const Spectrl2 *ground) {
    double mixed[SPECTRL2_COUNT], cosine = sin_d(out->sun_elevation);
    for (int i = 0; i < SPECTRL2_COUNT; i++)
        mixed[i] = ground->diffuse[i] + (1 - clear) * fmax(0, cosine) * ground->direct[i];
    curve_from_rows(mixed, &out->sky_curve);
    out->metrics.diffuse_horizontal_w_m2 = out->metrics.diffuse_horizontal_lx *
                                           spectrl2_total(mixed) / curve_luminance(&out->sky_curve);
    scale_curve(&out->sky_curve, 1 / curve_luminance(&out->sky_curve));
    curve_xy(&out->sky_curve, out->metrics.zenith_xy);
}

/* A uniform Lambertian ground under sun and sky. */
static void light_floor(Daylight *out, const Curve *irradiance) {
    double albedo = floor_albedo(&out->input), sine = fmax(0, sin_d(out->sun_elevation));
    out->floor_curve = out->sky_curve;
    scale_curve(&out->floor_curve, albedo / PI * out->metrics.diffuse_horizontal_lx);
    add_curve(&out->floor_curve, irradiance, albedo / PI * sine * sun_share(out));
    out->metrics.floor_cd_m2 = curve_luminance(&out->floor_curve);
}

static void finish_shape(Daylight *out, const Curve *irradiance) {
    DaylightMetrics *f = &out->metrics;
    int steps = out->input.integral_steps ? out->input.integral_steps : INTEGRAL_STEPS;
    double integral = sky_shape_integral(&out->shape, PI / 2 - out->sun_elevation, steps);
    out->shape_scale = (float)(f->diffuse_horizontal_lx / integral);
    f->zenith_cd_m2 = (double)daylight_luminance(out, (float)(PI / 2), 0);
    set_sun(out, irradiance);
    light_floor(out, irradiance);
    f->global_horizontal_lx =
        f->diffuse_horizontal_lx + f->direct_normal_lx * fmax(0, sin_d(out->sun_elevation));
}

static bool needs_sun(const DaylightInput *in) {
    int type = in->cie_type;
    return in->kind == DAYLIGHT_PEREZ || !(type == 1 || type == 3 || type == 5 || type == 16);
}

static bool check_sun_up(const Daylight *out, Error *err) {
    double lowest = out->input.kind == DAYLIGHT_PEREZ ? PEREZ_LOWEST_DEG : 0;
    if (!needs_sun(&out->input) || out->metrics.sun_elevation_deg > lowest) return true;
    return error_set(err, ERROR_INPUT,
                     "the sun stands %.2f degrees below the horizon "
                     "(azimuth %.2f): this sky model has no night, required: a time by day or "
                     "the type \"sky\"",
                     -out->metrics.sun_elevation_deg, out->metrics.sun_azimuth_deg);
}

static bool build_cie(Daylight *out, Error *err) {
    const DaylightInput *in = &out->input;
    static const double clear[16] = {0, 0, 0, 0, 0, 0, 0.3, 0.5, 0.3, 0.5, 0.8, 1, 1, 1, 1, 0};
    Curve irradiance;
    if (in->cie_type < 1 || in->cie_type > 16)
        return error_set(err, ERROR_INPUT,
                         "CIE sky %d is unknown, required: 1 to 15, or 16 "
                         "(the traditional overcast sky)",
                         in->cie_type);
    if (!check_sun_up(out, err)) return false;
    Spectrl2 ground = ground_spectra(out);
    out->shape = sky_shape_cie(in->cie_type);
    out->metrics.diffuse_horizontal_lx = in->diffuse_lux;
    curve_from_rows(ground.direct, &irradiance);
    double lux = curve_luminance(&irradiance);
    scale_curve(&irradiance, in->sun_lux > 0 && lux > 0 ? in->sun_lux / lux : 0);
    if (in->sun_lux > 0 && lux > 0)
        out->metrics.direct_normal_w_m2 =
            spectrl2_total(ground.direct) * in->sun_lux / lux * sun_share(out);
    sky_spectrum(out, clear[in->cie_type - 1], &ground);
    finish_shape(out, &irradiance);
    return true;
}

/* Of whole discs, whether they are up or not. */
static LuminousEfficacy perez_efficacy(const Daylight *out, const PerezInput *light,
                                       const PerezState *state) {
    const DaylightInput *in = &out->input;
    double sine = fmax(0, sin_d(out->sun_elevation));
    LuminousEfficacy fit = luminous_efficacy(state, light->sun_zenith, in->water_cm);
    if (in->has_lux)
        fit =
            (LuminousEfficacy){in->direct_lux / in->direct_w_m2, in->diffuse_lux / in->diffuse_w_m2,
                               (in->diffuse_lux + sine * in->direct_lux) /
                                   (in->diffuse_w_m2 + sine * in->direct_w_m2)};
    if (!(in->direct_w_m2 > 0) || in->sun_lux >= 0) fit.direct = (double)NAN;
    return fit;
}

/* Normal, of a whole disc: what is measured, unless the sun has an illuminance of its own. */
static void set_perez_direct(Daylight *out, const Spectrl2 *ground, Curve *irradiance) {
    const DaylightInput *in = &out->input;
    DaylightMetrics *f = &out->metrics;
    curve_from_rows(ground->direct, irradiance);
    double whole = curve_luminance(irradiance), w_m2 = in->direct_w_m2, lux = in->sun_lux;
    if (lux >= 0) w_m2 = whole > 0 ? spectrl2_total(ground->direct) * lux / whole : 0;
    else if (in->has_lux) lux = in->direct_lux;
    else lux = w_m2 > 0 ? f->efficacy.direct * w_m2 : 0;
    scale_curve(irradiance, whole > 0 ? lux / whole : 0);
    f->direct_normal_w_m2 = w_m2 * sun_share(out);
}

static bool build_perez(Daylight *out, Error *err) {
    const DaylightInput *in = &out->input;
    DaylightMetrics *f = &out->metrics;
    PerezState state;
    Curve irradiance;
    if (!check_sun_up(out, err)) return false;
    PerezInput input = {fmin(PEREZ_ZENITH_MAX, PI / 2 - out->sun_elevation), in->direct_w_m2,
                        in->diffuse_w_m2, in->has_time ? day_of_year(&in->when) : 80};
    if (!sky_shape_perez(&input, &out->shape, &state, err)) return false;
    Spectrl2 ground = ground_spectra(out);
    f->efficacy = perez_efficacy(out, &input, &state);
    set_perez_direct(out, &ground, &irradiance);
    f->diffuse_horizontal_lx = f->efficacy.diffuse * in->diffuse_w_m2;
    sky_spectrum(out, fmin(1, (state.clearness - 1) / 3.5), &ground);
    f->diffuse_horizontal_w_m2 = in->diffuse_w_m2;
    finish_shape(out, &irradiance);
    return true;
}

/* ---- the clear atmosphere ---------------------------------------------------------------- */

/* The sun's spectrum outside the air, less what water vapour and oxygen take: they absorb on
 * the beam's way down, where nearly all scattering happens too (as SPECTRL2 has it). */
static void fill_beam(const Daylight *out, Curve *beam) {
    double gases[SPECTRL2_COUNT];
    Air air = air_above(&out->input);
    Spectrl2 ground = ground_spectra(out);
    spectrl2_gases(&air, fmin(89, out->metrics.sun_zenith_deg), gases);
    for (int i = 0; i < SPECTRL2_COUNT; i++) gases[i] *= ground.outside[i];
    curve_from_rows(gases, beam);
}

/* Irradiances from 300 to 4000 nm: the beam's by its own way through the air, the sky's by
 * SPECTRL2's ratio of watts to lux. */
static void report_watts(Daylight *out) {
    DaylightMetrics *f = &out->metrics;
    Spectrl2 ground = ground_spectra(out);
    Curve diffuse;
    Air air = sea_level_air(&out->input);
    SunBeam beam = sun_beam(&air,
                            &(SunBeamPath){out->sunlight.atmosphere.input.observer_m,
                                           out->sunlight.atmosphere.input.floor_m,
                                           fmax(out->sun_elevation, out->horizon)},
                            f->distance_au);
    curve_from_rows(ground.diffuse, &diffuse);
    f->air_mass = f->is_sun_up ? beam.air_mass : 0;
    f->direct_normal_w_m2 = beam.lux > 0 ? beam.w_m2 * f->direct_normal_lx / beam.lux : 0;
    f->diffuse_horizontal_w_m2 =
        spectrl2_total(ground.diffuse) * f->diffuse_horizontal_lx / curve_luminance(&diffuse);
}

/* The moon's place, and when no part of the sun is left, the night: by day it is less than a
 * thousandth of the sky's light, and left out. */
static bool add_night(Daylight *out, Arena *arena, Error *err) {
    const DaylightInput *in = &out->input;
    const AtmosphereInput *air = &out->sunlight.atmosphere.input;
    DaylightMetrics *f = &out->metrics;
    MoonPosition moon;
    bool has_moon = in->has_time && !in->no_moon;
    if (has_moon) {
        double day = sky_julian_day(&in->when);
        moon = moon_position(day, sky_delta_t_s(day), &in->where);
        f->night = night_moon_metrics(&moon, in->where.altitude_m, out->horizon);
    }
    if (f->is_sun_up) return true;
    NightInput input = {*air, air_above(in), in->where.altitude_m, out->horizon,
                        has_moon ? &moon : NULL};
    out->night = arena_alloc(arena, sizeof *out->night, 64, 1);
    if (!night_build(&input, arena, out->night, err)) return false;
    f->night = out->night->metrics;
    return true;
}

/* Its share of the figures. */
static void report_night(const Night *night, DaylightMetrics *f) {
    const NightMetrics *n = &night->metrics;
    double sky_lx = n->moon_sky_lx + n->background_lx;
    f->diffuse_horizontal_lx += sky_lx;
    f->floor_cd_m2 += n->floor_cd_m2;
    f->global_horizontal_lx += sky_lx + n->moon_normal_lx * fmax(0, sin_d(night->moon_elevation));
}

/* Figures of the sky above the horizontal and of the floor, by the sun and by the night. */
static void report_light(Daylight *out) {
    DaylightMetrics *f = &out->metrics;
    const LitAir *air = &out->sunlight;
    const Atmosphere *day = &air->atmosphere;
    Curve zenith;
    f->diffuse_horizontal_lx = lit_air_luminance(air, atmosphere_diffuse(day));
    f->floor_cd_m2 = lit_air_luminance(air, day->floor_exitance) / PI;
    f->global_horizontal_lx =
        f->diffuse_horizontal_lx + f->direct_normal_lx * fmax(0, sin_d(out->sun_elevation));
    lit_air_curve(air, atmosphere_radiance(day, (float)(PI / 2), 0), &zenith);
    if (out->night) {
        report_night(out->night, f);
        night_add_zenith(out->night, &zenith);
    }
    report_watts(out);
    f->zenith_cd_m2 = curve_luminance(&zenith);
    curve_xy(&zenith, f->zenith_xy);
}

static bool build_clear(Daylight *out, Arena *arena, Error *err) {
    const DaylightInput *in = &out->input;
    DaylightMetrics *f = &out->metrics;
    AtmosphereInput input = {sea_level_air(in),  fmax(0, in->where.altitude_m),
                             floor_altitude(in), out->sun_elevation,
                             in->threads,        0,
                             in->sun_alone,      floor_relief(in),
                             out->sun_azimuth};
    Curve beam, irradiance;
    fill_beam(out, &beam);
    if (!lit_air_build(&input, &beam, arena, &out->sunlight, err)) return false;
    out->horizon = out->sunlight.atmosphere.horizon;
    f->horizon_deg = degrees_from_radians(out->horizon);
    lit_air_curve(&out->sunlight, out->sunlight.atmosphere.sun_passing, &irradiance);
    double lux = curve_luminance(&irradiance);
    if (in->sun_lux >= 0 && lux > 0) scale_curve(&irradiance, in->sun_lux / lux);
    set_sun(out, &irradiance);
    if (in->sun_alone) return true;
    if (!add_night(out, arena, err)) return false;
    report_light(out);
    return true;
}

bool daylight_build(const DaylightInput *input, Arena *arena, Daylight *out, Error *err) {
    *out = (Daylight){.input = *input};
    bool sunless = input->kind == DAYLIGHT_CIE && !needs_sun(input);
    if (!input->has_time && !input->has_sun && !sunless)
        return error_set(err, ERROR_INPUT,
                         "the sky wants a time and a place, or the sun's azimuth "
                         "and elevation");
    if (sunless && !input->has_time && !input->has_sun) out->input.sun_elevation = PI / 4;
    place_sun(out);
    switch (input->kind) {
    case DAYLIGHT_CIE: return build_cie(out, err);
    case DAYLIGHT_PEREZ: return build_perez(out, err);
    case DAYLIGHT_CLEAR: return build_clear(out, arena, err);
    }
    return false;
}

/* ---- queries ----------------------------------------------------------------------------- */

static float angle_to_sun(const Daylight *out, float elevation, float azimuth) {
    float sun = (float)out->sun_elevation, turn = azimuth - (float)out->sun_azimuth, s[3], c[3];
    sincos_turns(elevation * (0.5f * INV_PI_F), &s[0], &c[0]);
    sincos_turns(sun * (0.5f * INV_PI_F), &s[1], &c[1]);
    sincos_turns(turn * (0.5f * INV_PI_F), &s[2], &c[2]);
    return acos_f(clampf(s[0] * s[1] + c[0] * c[1] * c[2], -1, 1));
}

static float shape_luminance(const Daylight *out, float elevation, float azimuth) {
    float sine, cosine;
    sincos_turns(elevation * (0.5f * INV_PI_F), &sine, &cosine);
    return out->shape_scale *
           sky_shape_at(&out->shape, sine, angle_to_sun(out, elevation, azimuth));
}

static float clear_luminance(const Daylight *out, float elevation, float azimuth) {
    float value = (float)lit_air_luminance(&out->sunlight,
                                           atmosphere_radiance(&out->sunlight.atmosphere, elevation,
                                                               azimuth - (float)out->sun_azimuth));
    return out->night ? value + night_luminance(out->night, elevation, azimuth) : value;
}

float daylight_luminance(const Daylight *out, float elevation, float azimuth) {
    if (out->input.kind == DAYLIGHT_CLEAR) return clear_luminance(out, elevation, azimuth);
    if (elevation < 0) return (float)out->metrics.floor_cd_m2;
    return shape_luminance(out, elevation, azimuth);
}

Spectrum daylight_radiance(const Daylight *out, float elevation, float azimuth,
                           const Wavelengths *wavelengths) {
    if (out->input.kind != DAYLIGHT_CLEAR) {
        if (elevation < 0) return curve_lookup(&out->floor_curve, wavelengths);
        return curve_lookup(&out->sky_curve, wavelengths) *
               spectrum_all(shape_luminance(out, elevation, azimuth));
    }
    Spectrum value =
        lit_air_radiance(&out->sunlight, elevation, azimuth - (float)out->sun_azimuth, wavelengths);
    if (!out->night) return value;
    return value + night_radiance(out->night, elevation, azimuth, wavelengths);
}

Spectrum daylight_polarisation(const Daylight *out, float elevation, float azimuth,
                               const Wavelengths *wavelengths) {
    float from_sun = azimuth - (float)out->sun_azimuth;
    if (out->input.kind != DAYLIGHT_CLEAR) return spectrum_all(0);
    Spectrum degree = lit_air_polarisation(&out->sunlight, elevation, from_sun, wavelengths);
    if (!out->night) return degree;
    Spectrum lit = lit_air_radiance(&out->sunlight, elevation, from_sun, wavelengths);
    Spectrum all = lit + night_radiance(out->night, elevation, azimuth, wavelengths);
    return degree * lit / spectrum_max(all, spectrum_all(1e-30f));
}

Spectrum daylight_sun(const Daylight *out, float share, const Wavelengths *wavelengths) {
    return sun_limb_shade(out->limb, share, wavelengths) *
           curve_lookup(&out->sun_mean, wavelengths);
}
