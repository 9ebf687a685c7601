/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/figures/panel_figure.h"

#include <math.h>

#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_reflection.h"
#include "panel/query/panel_sampling.h"
#include "spectrum/photometry.h"

Vec3 panel_figure_direction(double theta, double phi) {
    double limit = PI / 2 - 1e-4;
    theta = fmin(fmax(theta, -limit), limit);
    return vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
}

/* ---- light ------------------------------------------------------------------------------- */

static void xyz_at(const Panel *panel, const float *place, Vec3 direction, const float rgb[3],
                   double xyz[3]) {
    float found[3];
    if (place) panel_place_emission_xyz(panel, place, direction, rgb, found);
    else panel_emission_xyz(panel, direction, rgb, found);
    for (int c = 0; c < 3; c++) xyz[c] = (double)found[c];
}

static double luminance_at(const Panel *panel, const float *place, Vec3 direction,
                           const float rgb[3]) {
    double xyz[3];
    xyz_at(panel, place, direction, rgb, xyz);
    return xyz[1];
}

double panel_figure_luminance(const Panel *panel, double theta, double phi, const float rgb[3]) {
    return luminance_at(panel, NULL, panel_figure_direction(theta, phi), rgb);
}

static double contrast_at(const Panel *panel, const float *place, Vec3 direction) {
    double black = luminance_at(panel, place, direction, PANEL_BLACK);
    return black > 0 ? luminance_at(panel, place, direction, PANEL_WHITE) / black : NAN;
}

double panel_figure_contrast(const Panel *panel, double theta, double phi) {
    return contrast_at(panel, NULL, panel_figure_direction(theta, phi));
}

static PanelColour colour_at(const Panel *panel, const float *place, Vec3 direction,
                             const float rgb[3]) {
    PanelColour out;
    xyz_at(panel, place, direction, rgb, out.xyz);
    double sum = out.xyz[0] + out.xyz[1] + out.xyz[2];
    for (int c = 0; c < 2; c++) out.xy[c] = sum > 0 ? out.xyz[c] / sum : NAN;
    uv_from_xyz(out.xyz, out.uv);
    return out;
}

PanelColour panel_figure_colour(const Panel *panel, double theta, double phi, const float rgb[3]) {
    return colour_at(panel, NULL, panel_figure_direction(theta, phi), rgb);
}

static double shift_at(const Panel *panel, const float *place, Vec3 direction, const float rgb[3]) {
    PanelColour there = colour_at(panel, place, direction, rgb);
    PanelColour normal = colour_at(panel, place, vec3(0, 0, 1), rgb);
    return hypot(there.uv[0] - normal.uv[0], there.uv[1] - normal.uv[1]);
}

double panel_figure_shift(const Panel *panel, double theta, double phi, const float rgb[3]) {
    return shift_at(panel, NULL, panel_figure_direction(theta, phi), rgb);
}

GamutTriangle panel_figure_primaries(const Panel *panel) {
    GamutTriangle out;
    for (int p = 0; p < 3; p++) {
        float rgb[3] = {0, 0, 0};
        rgb[p] = 255;
        PanelColour primary = panel_figure_colour(panel, 0, 0, rgb);
        for (int c = 0; c < 2; c++) out.at[p][c] = primary.xy[c];
    }
    return out;
}

static double level_luminance(const Panel *panel, int channel, double code, Vec3 direction) {
    float rgb[3];
    for (int c = 0; c < 3; c++) rgb[c] = channel == PANEL_GREY || channel == c ? (float)code : 0;
    return luminance_at(panel, NULL, direction, rgb);
}

double panel_figure_gamma(const Panel *panel, int channel, double theta, double phi) {
    Vec3 direction = panel_figure_direction(theta, phi);
    double code[PANEL_INFO_LEVELS_MAX], xx = 0, xy = 0;
    int count = panel_info_levels(panel, channel == PANEL_GREY ? 1 : channel, code);
    double black = level_luminance(panel, channel, 0, direction);
    double full = level_luminance(panel, channel, 255, direction) - black;
    for (int i = 0; i < count; i++) {
        double light = (level_luminance(panel, channel, code[i], direction) - black) / full;
        double x = log(code[i] / 255);
        if (!(light > 0)) continue;
        xx += x * x;
        xy += x * log(light);
    }
    return count > 1 && xx > 0 ? xy / xx : NAN;
}

/* ---- where a limit is crossed ------------------------------------------------------------ */

/* Above 0 where the limit is held; NaN: nothing to hold it against, which crosses nothing. */
typedef double Margin(const void *context, double angle);

#define PRECISE 1e-7 /* radians: what a direction in 32 bits resolves */

/* The first angle up to `last` below whose margin is 0: by steps, the step that crosses it
 * halved. 0: there already. NaN: there is none. */
static double first_below(Margin *margin, const void *context, double last, double step) {
    double low = 0, high = fmin(step, last);
    if (margin(context, 0) < 0) return 0;
    for (; !(margin(context, high) < 0); high = fmin(high + step, last)) {
        if (high >= last) return NAN;
        low = high;
    }
    while (high - low > PRECISE) {
        double middle = 0.5 * (low + high);
        if (margin(context, middle) < 0) high = middle;
        else low = middle;
    }
    return 0.5 * (low + high);
}

typedef struct Viewing {
    const Panel *panel;
    const float *place;
    PanelLimit limit;
    double phi, normal;
} Viewing;

static double viewing_margin(const void *context, double theta) {
    const Viewing *v = context;
    Vec3 direction = panel_figure_direction(theta, v->phi);
    switch (v->limit.kind) {
    case PANEL_LEAST_CONTRAST: return contrast_at(v->panel, v->place, direction) - v->limit.value;
    case PANEL_MOST_SHIFT:
        return v->limit.value - shift_at(v->panel, v->place, direction, PANEL_WHITE);
    default:
        return luminance_at(v->panel, v->place, direction, PANEL_WHITE) / v->normal -
               v->limit.value;
    }
}

double panel_figure_viewing_angle(const Panel *panel, const float place[2], PanelLimit limit,
                                  double phi) {
    Viewing v = {panel, place, limit, phi, luminance_at(panel, place, vec3(0, 0, 1), PANEL_WHITE)};
    return first_below(viewing_margin, &v, panel_info_emission_cone(panel),
                       radians_from_degrees(0.25));
}

/* ---- grey inversion ---------------------------------------------------------------------- */

typedef struct Greys {
    const Panel *panel;
    double phi;
    int count;
    double code[PANEL_INFO_LEVELS_MAX + 1]; /* rising, black first */
} Greys;

static PanelInversion inversion_at(const Greys *greys, double theta) {
    PanelInversion out = {.theta = theta, .phi = greys->phi, .first = NAN};
    Vec3 direction = panel_figure_direction(theta, greys->phi);
    double brightest = 0, code = 0; /* of the levels before */
    for (int i = 0; i < greys->count; i++) {
        double light = level_luminance(greys->panel, PANEL_GREY, greys->code[i], direction);
        double share = brightest > 0 ? 1 - light / brightest : 0;
        if (share > out.share) out.share = share, out.low = code, out.high = greys->code[i];
        if (light > brightest) brightest = light, code = greys->code[i];
    }
    return out;
}

static double inversion_margin(const void *context, double theta) {
    return PANEL_INVERSION_LEAST - inversion_at(context, theta).share;
}

PanelInversion panel_figure_inversion(const Panel *panel, double phi) {
    Greys greys = {.panel = panel, .phi = phi};
    PanelInversion most = {.phi = phi, .first = NAN};
    double cone = panel_info_emission_cone(panel), step = radians_from_degrees(0.5);
    greys.count = panel_info_levels(panel, 1, greys.code + 1) + 1;
    if (greys.count < 3) return most;
    for (double theta = 0; theta < cone + step; theta += step) {
        PanelInversion one = inversion_at(&greys, fmin(theta, cone));
        if (one.share > most.share) most = one;
    }
    most.first = first_below(inversion_margin, &greys, cone, step);
    return most.share >= PANEL_INVERSION_LEAST ? most : (PanelInversion){.phi = phi, .first = NAN};
}

/* ---- reflection -------------------------------------------------------------------------- */

typedef enum Reflected { REFLECTED_ALL, REFLECTED_EVENLY, REFLECTED_MIRROR } Reflected;

static Spectrum reflected(const Panel *panel, Reflected what, const Vec3 at[2],
                          const Wavelengths *wavelengths) {
    PanelLanes lanes;
    panel_lanes(panel, wavelengths, &lanes);
    if (what == REFLECTED_MIRROR) return panel_mirror_at(panel, at[1].z, &lanes);
    Spectrum f = panel_brdf_at(panel, at[0], at[1], &lanes);
    return what == REFLECTED_ALL ? f : panel_lambertian_at(panel, f, at[1], &lanes);
}

#define FIRST_NM 380
#define LAST_NM 780
#define STEP_NM 10

/* At a wavelength, or the eye's mean. at: to the eye, to the light. */
static double mean_of(const Panel *panel, Reflected what, const Vec3 at[2], double nm) {
    Wavelengths wavelengths = {.nm = spectrum_all((float)nm)};
    if (nm > 0) return (double)reflected(panel, what, at, &wavelengths)[0];
    double sum = 0, weights = 0;
    for (int first = FIRST_NM; first <= LAST_NM; first += STEP_NM * SPECTRUM_LANES) {
        for (int i = 0; i < SPECTRUM_LANES; i++) wavelengths.nm[i] = (float)(first + STEP_NM * i);
        Spectrum value = reflected(panel, what, at, &wavelengths);
        for (int i = 0; i < SPECTRUM_LANES && first + STEP_NM * i <= LAST_NM; i++) {
            double weight = (double)spectral_table[first + STEP_NM * i - SPECTRAL_FIRST_NM].y;
            sum += weight * (double)value[i];
            weights += weight;
        }
    }
    return sum / weights;
}

double panel_figure_brdf(const Panel *panel, Vec3 wo, Vec3 wi, double nm) {
    return mean_of(panel, REFLECTED_ALL, (const Vec3[]){wo, wi}, nm);
}

double panel_figure_lambertian(const Panel *panel, Vec3 wo, Vec3 wi) {
    return mean_of(panel, REFLECTED_EVENLY, (const Vec3[]){wo, wi}, 0);
}

double panel_figure_mirror(const Panel *panel, double theta, double nm) {
    Vec3 wi = {0, 0, (float)cos(theta)};
    return mean_of(panel, REFLECTED_MIRROR, (const Vec3[]){wi, wi}, nm);
}

double panel_figure_diffuse(const Panel *panel, double theta) {
    return (double)panel_haze_albedo(panel, (float)cos(theta));
}

#define EVEN_SAMPLES 2048
#define EVEN_AZIMUTHS 8 /* of an anisotropic panel */

/* Base 2 or 3 with its digits mirrored at the point (van der Corput, Halton 1960). */
static float mirrored_digits(int number, int base) {
    double value = 0, digit = 1.0 / base;
    for (; number; number /= base, digit /= base) value += digit * (number % base);
    return (float)fmin(value, 1 - 1e-7);
}

/* Directions drawn as the panel's own sampling has it, so that narrow lobes are met. */
double panel_figure_reflectance(const Panel *panel, double theta) {
    double azimuths[PANEL_INFO_AZIMUTHS_MAX], sum = 0;
    bool is_anisotropic = panel_info_azimuths(panel, azimuths) > 1;
    for (int i = 0; i < EVEN_SAMPLES; i++) {
        float u[3] = {((float)i + 0.5f) / EVEN_SAMPLES, mirrored_digits(i, 2),
                      mirrored_digits(i, 3)},
              pdf;
        Vec3 wi, wo = panel_figure_direction(
                     theta, is_anisotropic ? 2 * PI * (i % EVEN_AZIMUTHS) / EVEN_AZIMUTHS : 0);
        if (panel_sample(panel, wo, u, &wi, &pdf))
            sum += panel_figure_brdf(panel, wo, wi, 0) * (double)(wi.z / pdf);
    }
    return sum / EVEN_SAMPLES + panel_figure_mirror(panel, theta, 0);
}

typedef struct HazeSide {
    const Panel *panel;
    double theta, half;
    int side; /* 1: away from the normal */
} HazeSide;

static double haze_margin(const void *context, double away) {
    const HazeSide *at = context;
    return panel_figure_brdf(at->panel, panel_figure_direction(at->theta + at->side * away, 0),
                             panel_figure_direction(at->theta, PI), 0) -
           at->half;
}

PanelHaze panel_figure_haze(const Panel *panel, double theta) {
    double reach = radians_from_degrees(60), step = radians_from_degrees(0.05);
    HazeSide up = {panel, theta, 0, 1}, down = {panel, theta, 0, -1};
    double peak = haze_margin(&up, 0), rest = haze_margin(&up, reach);
    if (!(peak > 1.2 * rest)) return (PanelHaze){peak, NAN};
    up.half = down.half = rest + 0.5 * (peak - rest);
    return (PanelHaze){peak, first_below(haze_margin, &up, reach, step) +
                                 first_below(haze_margin, &down, reach, step)};
}

/* ---- evenness over the active area ------------------------------------------------------- */

#define COLUMNS 96
#define ROWS 54

void panel_nine_place(int index, float place[2]) {
    static const float at[3] = {0.1f, 0.5f, 0.9f};
    place[0] = at[index % 3];
    place[1] = at[index / 3];
}

PanelEvenness panel_figure_evenness(const Panel *panel, const float rgb[3]) {
    PanelEvenness out = {.nine_least = INFINITY, .least = INFINITY};
    for (int i = 0; i < PANEL_NINE; i++) {
        float place[2];
        panel_nine_place(i, place);
        out.nine[i] = luminance_at(panel, place, vec3(0, 0, 1), rgb);
        out.nine_least = fmin(out.nine_least, out.nine[i]);
        out.nine_most = fmax(out.nine_most, out.nine[i]);
        out.nine_mean += out.nine[i] / PANEL_NINE;
    }
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        float place[2] = {((float)(i % COLUMNS) + 0.5f) / COLUMNS,
                          ((float)(i / COLUMNS) + 0.5f) / ROWS};
        double y = luminance_at(panel, place, vec3(0, 0, 1), rgb);
        out.least = fmin(out.least, y);
        out.most = fmax(out.most, y);
        out.mean += y / (COLUMNS * ROWS);
    }
    return out;
}
