/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/synthetic_panel.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "spectrum/fresnel.h"
#include "spectrum/spectral_table.h"

double synthetic_panel_spectrum(const SyntheticPrimary *primary, double nm) {
    double sum = 0;
    for (int i = 0; i < primary->peak_count; i++) {
        double d = (nm - primary->peak_nm[i]) / primary->fwhm_nm[i];
        sum += primary->weight[i] * exp_d(-4 * log_d(2) * d * d);
    }
    return sum;
}

/* ---- the exact values -------------------------------------------------------------------- */

/* F of the cover, held where rounding leaves the range of a cosine. */
static double cover_fresnel(const SyntheticPanel *panel, double cosine) {
    return fresnel_unpolarised_d(fmin(1, fabs(cosine)), panel->refractive_index);
}

/* Angle between two directions, exact also when it is small. */
static double angle_between(const double a[2], const double b[2]) {
    double dt = sin_d(0.5 * (a[0] - b[0])), dp = sin_d(0.5 * (a[1] - b[1]));
    double h = dt * dt + sin_d(a[0]) * sin_d(b[0]) * dp * dp;
    return 2 * asin_d(sqrt(h > 1 ? 1 : h));
}

/* A of synthetic_panel.h. */
static double angular_falloff(const SyntheticPanel *panel, const double angles[2]) {
    const SyntheticEmission *e = &panel->emission;
    double c = cos_d(angles[0]), cp = cos_d(angles[1]);
    double power = e->cosine_power[0] * cp * cp + e->cosine_power[1] * (1 - cp * cp);
    double through = (1 - cover_fresnel(panel, c)) / (1 - cover_fresnel(panel, 1));
    double lobe = 0;
    if (e->lobe_gain > 0) {
        double d = angle_between(angles, (double[2]){e->lobe_theta, e->lobe_phi});
        lobe = e->lobe_gain * exp_d(-0.5 * d * d / (e->lobe_width * e->lobe_width));
    }
    return pow_d(c > 0 ? c : 0, power) * through * (1 + lobe);
}

SyntheticPanel closed_form_at(const SyntheticPanel *panel, const double place[2]) {
    const SyntheticPlaces *p = &panel->places;
    SyntheticPanel out = *panel;
    double x = place[0] - 0.5, y = place[1] - 0.5;
    double wave = cos_d(2 * PI * p->mura_cycles[0] * x) * cos_d(2 * PI * p->mura_cycles[1] * y);
    double even = (1 + p->slope[0] * x + p->slope[1] * y) * (1 + p->mura * wave);
    double tint[3] = {1 + p->tint * x, 1, 1 - p->tint * x};
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++) out.emission.primary[k].white_xyz[j] *= even * tint[j];
    out.emission.black_cd_m2 *= even * (1 + p->clouding * 16 * x * x * y * y);
    out.emission.lobe_gain *= 1 + p->lobe_slope * x;
    out.reflection.haze_share *= 1 + p->haze_slope * x;
    return out;
}

void closed_form_emission_xyz(const SyntheticPanel *panel, int primary, double code,
                              const double angles[2], double xyz[3]) {
    const SyntheticEmission *e = &panel->emission;
    const SyntheticPrimary *p = &e->primary[primary];
    double s = sin_d(angles[0]) * sin_d(angles[0]);
    double level = code > 0 ? pow_d(code / 255, e->gamma - e->gamma_drop * s) : 0;
    double a = angular_falloff(panel, angles);
    for (int j = 0; j < 3; j++) xyz[j] = p->white_xyz[j] * level * a * exp_d(p->shift[j] * s);
}

void closed_form_black_xyz(const SyntheticPanel *panel, const double angles[2], double xyz[3]) {
    const SyntheticEmission *e = &panel->emission;
    double white[3] = {0, 0, 0};
    double s = sin_d(angles[0]) * sin_d(angles[0]), diagonal = sin_d(2 * angles[1]);
    double value = e->black_cd_m2 * angular_falloff(panel, angles) *
                   (1 + e->leak * s * s * diagonal * diagonal);
    for (int p = 0; p < 3; p++)
        for (int j = 0; j < 3; j++) white[j] += e->primary[p].white_xyz[j];
    for (int j = 0; j < 3; j++) xyz[j] = value * white[j] / white[1];
}

/* R of synthetic_panel.h. */
static double coated_reflectance(const SyntheticPanel *panel, double cos_theta, double nm) {
    double f = cover_fresnel(panel, cos_theta);
    double d = (nm - 550) / 150;
    double c = panel->reflection.coating + panel->reflection.coating_blue * d * d;
    if (c > 1) c = 1;
    return f * (c + (1 - c) * f);
}

double closed_form_mirror(const SyntheticPanel *panel, double theta, double nm) {
    return (1 - panel->reflection.haze_share) * coated_reflectance(panel, cos_d(theta), nm);
}

double closed_form_brdf(const SyntheticPanel *panel, double theta_i, double theta_o, double phi,
                        double nm) {
    const SyntheticReflection *r = &panel->reflection;
    double ci = cos_d(theta_i), co = cos_d(theta_o);
    if (ci <= 0 || co <= 0) return 0;
    double si = sin_d(theta_i), so = sin_d(theta_o), w2 = r->haze_width * r->haze_width;
    double sp = sin_d(0.5 * phi);
    double b2 = (so - si) * (so - si) + 4 * so * si * sp * sp;
    double k = (r->haze_power - 1) / (PI * w2) * pow_d(1 + b2 / w2, -r->haze_power);
    double gloss = sqrt(coated_reflectance(panel, ci, nm) * coated_reflectance(panel, co, nm));
    double under = (1 - cover_fresnel(panel, ci)) * (1 - cover_fresnel(panel, co));
    return r->haze_share * gloss * k + r->lambertian_albedo / PI * under;
}

double closed_form_instrument_brdf(const SyntheticPanel *panel, double theta_i, double theta_o,
                                   double phi, double nm) {
    double sigma = radians_from_degrees(panel->instrument.fwhm_deg) / sqrt(8 * log_d(2));
    double d = angle_between((double[2]){theta_o, phi}, (double[2]){theta_i, 0});
    double image = exp_d(-0.5 * d * d / (sigma * sigma)) / (2 * PI * sigma * sigma);
    return closed_form_brdf(panel, theta_i, theta_o, phi, nm) +
           closed_form_mirror(panel, theta_i, nm) * image / cos_d(theta_i);
}

#define APERTURE_RINGS 32
#define APERTURE_SECTORS 24

/* BRDF times cosine in a direction at a distance from the mirror direction, turned about it. */
static double towards_aperture(const SyntheticPanel *panel, double theta, double distance,
                               double turn, double nm) {
    double s = sin_d(distance), x = s * cos_d(turn), y = s * sin_d(turn), z = cos_d(distance);
    double across = cos_d(theta) * x + sin_d(theta) * z;
    double cosine = cos_d(theta) * z - sin_d(theta) * x;
    if (!(cosine > 0)) return 0;
    return cosine * closed_form_brdf(panel, theta, acos_d(fmin(1, cosine)), atan2_d(y, across), nm);
}

/* Rings are closer where a narrow haze is: their radii go with a square. */
double closed_form_specular(const SyntheticPanel *panel, double theta, double aperture, double nm) {
    double sum = 0;
    for (int i = 0; i < APERTURE_RINGS; i++) {
        double x = (i + 0.5) / APERTURE_RINGS, radius = 0.5 * aperture * x * x;
        double area = sin_d(radius) * aperture * x / APERTURE_RINGS;
        for (int k = 0; k < APERTURE_SECTORS; k++)
            sum += area * (2 * PI / APERTURE_SECTORS) *
                   towards_aperture(panel, theta, radius, 2 * PI * k / APERTURE_SECTORS, nm);
    }
    return closed_form_mirror(panel, theta, nm) + sum;
}
