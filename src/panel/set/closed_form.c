#include "panel/set/closed_form.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "spectrum/fresnel.h"

/* F of the cover, held where rounding leaves the range of a cosine. */
static double cover_fresnel(const Recipe *recipe, double cosine)
{
    return fresnel_unpolarised_d(fmin(1, fabs(cosine)), recipe->refractive_index);
}

/* Angle between two directions, exact also when it is small. */
static double angle_between(const double a[2], const double b[2])
{
    double dt = sin_d(0.5 * (a[0] - b[0])), dp = sin_d(0.5 * (a[1] - b[1]));
    double h = dt * dt + sin_d(a[0]) * sin_d(b[0]) * dp * dp;
    return 2 * asin_d(sqrt(h > 1 ? 1 : h));
}

/* A of synthetic_panel.h. */
static double angular_falloff(const Recipe *recipe, const double angles[2])
{
    const RecipeEmission *e = &recipe->emission;
    double c = cos_d(angles[0]), cp = cos_d(angles[1]);
    double power = e->cosine_power[0] * cp * cp + e->cosine_power[1] * (1 - cp * cp);
    double through = (1 - cover_fresnel(recipe, c)) / (1 - cover_fresnel(recipe, 1));
    double lobe = 0;
    if (e->lobe_gain > 0) {
        double d = angle_between(angles, (double[2]){e->lobe_theta, e->lobe_phi});
        lobe = e->lobe_gain * exp_d(-0.5 * d * d / (e->lobe_width * e->lobe_width));
    }
    return pow_d(c > 0 ? c : 0, power) * through * (1 + lobe);
}

void truth_emission_xyz(const Recipe *recipe, int primary, double code,
                        const double angles[2], double xyz[3])
{
    const RecipeEmission *e = &recipe->emission;
    const RecipePrimary  *p = &e->primary[primary];
    double s = sin_d(angles[0]) * sin_d(angles[0]);
    double level = code > 0 ? pow_d(code / 255, e->gamma - e->gamma_drop * s) : 0;
    double a = angular_falloff(recipe, angles);
    for (int j = 0; j < 3; j++) xyz[j] = p->white_xyz[j] * level * a * exp_d(p->shift[j] * s);
}

void truth_black_xyz(const Recipe *recipe, const double angles[2], double xyz[3])
{
    const RecipeEmission *e = &recipe->emission;
    double white[3] = {0, 0, 0};
    double s = sin_d(angles[0]) * sin_d(angles[0]), diagonal = sin_d(2 * angles[1]);
    double value = e->black_cd_m2 * angular_falloff(recipe, angles) *
                   (1 + e->leak * s * s * diagonal * diagonal);
    for (int p = 0; p < 3; p++)
        for (int j = 0; j < 3; j++) white[j] += e->primary[p].white_xyz[j];
    for (int j = 0; j < 3; j++) xyz[j] = value * white[j] / white[1];
}

/* R of synthetic_panel.h. */
static double coated_reflectance(const Recipe *recipe, double cos_theta, double nm)
{
    double f = cover_fresnel(recipe, cos_theta);
    double d = (nm - 550) / 150;
    double c = recipe->reflection.coating + recipe->reflection.coating_blue * d * d;
    if (c > 1) c = 1;
    return f * (c + (1 - c) * f);
}

double truth_mirror(const Recipe *recipe, double theta, double nm)
{
    return (1 - recipe->reflection.haze_share) * coated_reflectance(recipe, cos_d(theta), nm);
}

double truth_brdf(const Recipe *recipe, double theta_i, double theta_o, double phi, double nm)
{
    const RecipeReflection *r = &recipe->reflection;
    double ci = cos_d(theta_i), co = cos_d(theta_o);
    if (ci <= 0 || co <= 0) return 0;
    double si = sin_d(theta_i), so = sin_d(theta_o), w2 = r->haze_width * r->haze_width;
    double sp = sin_d(0.5 * phi);
    double b2 = (so - si) * (so - si) + 4 * so * si * sp * sp;
    double k = (r->haze_power - 1) / (PI * w2) * pow_d(1 + b2 / w2, -r->haze_power);
    double gloss = sqrt(coated_reflectance(recipe, ci, nm) *
                        coated_reflectance(recipe, co, nm));
    double under = (1 - cover_fresnel(recipe, ci)) * (1 - cover_fresnel(recipe, co));
    return r->haze_share * gloss * k + r->floor_albedo / PI * under;
}

double truth_instrument_brdf(const Recipe *recipe, double theta_i, double theta_o, double phi,
                             double nm)
{
    double sigma = radians_from_degrees(recipe->instrument.fwhm_deg) / sqrt(8 * log_d(2));
    double d = angle_between((double[2]){theta_o, phi}, (double[2]){theta_i, 0});
    double image = exp_d(-0.5 * d * d / (sigma * sigma)) / (2 * PI * sigma * sigma);
    return truth_brdf(recipe, theta_i, theta_o, phi, nm) +
           truth_mirror(recipe, theta_i, nm) * image / cos_d(theta_i);
}
