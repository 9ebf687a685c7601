/* SPDX-License-Identifier: Apache-2.0 */
/* display -- the reflection of a measured display panel.
 *
 * Instrument clusters, centre displays, cockpit displays: what sun, sky and cabin add to the
 * picture. Its parameters are the .panel file's; there is nothing to set here.
 *
 *   mirror  unscattered part of gloss glass, R(theta, lambda): a perfect mirror image
 *   haze    scattered part around the mirror direction, from the panel's tables, with the
 *           lambertian part below it
 *   cover   a coating on the cover glass (PARHELION_coating): the mirror times what the coating
 *           makes of bare glass, at every angle and wavelength. Haze and emission stay as
 *           measured: that the coating lets some per cent more through is not counted
 *   finish  a share of the mirror, coated or not, that facets of a rough surface scatter about
 *           its direction instead (GGX, each facet with the mirror's reflectance at its own
 *           angle). Modelled, not measured. Up to 60 degrees what leaves the mirror comes back
 *           in the lobe within 1 % (4 % where it is 20 degrees wide); beyond, facets that face
 *           the eye reflect less than the flat surface, as those of any rough glass, and the
 *           light goes in. Emission stays as it was: sparkle and a softer image are not in it
 *
 * Typical: bare gloss glass mirrors 4.5 % at normal incidence, with an anti-reflection coating
 * 0.3 to 1 %; an anti-glare surface scatters some 3 to 5 % into haze a few degrees wide.
 *
 * A panel that was measured at several spots is the mixture of those around a place, in haze,
 * mirror and the density of directions.
 *
 * The tables, their interpolation and their sampling are src/panel's. A panel without
 * reflection data reflects nothing. The mirror polarises as its cover does, glass of index 1.5,
 * bare or coated; haze and lambertian part send unpolarised light on. Not modelled: anisotropic
 * sparkle, the change of haze with the display's content.
 */
#include "base/mathf.h"
#include "panel/query/panel_sampling.h"
#include "shaders/display.h"
#include "shaders/facets/microfacet.h"
#include "shaders/polarisation.h"

#define COVER_IOR 1.5f

/* ---- one panel, or the mixture of several ------------------------------------------------ */

static Spectrum brdf_of(const DisplaySurface *display, Vec3 wo, Vec3 wi) {
    if (display->mix.count) return panel_mix_brdf(&display->mix, wo, wi, display->wavelengths);
    return panel_brdf_at(display->panel, wo, wi, &display->lanes);
}

static float haze_albedo_of(const DisplaySurface *display, float cosine) {
    if (display->mix.count) return panel_mix_haze_albedo(&display->mix, cosine);
    return panel_haze_albedo(display->panel, cosine);
}

/* ---- the model --------------------------------------------------------------------------- */

/* A coating that mirrors more than glass leaves the haze its light. */
static Spectrum clear_mirror_at(const DisplaySurface *display, float cosine) {
    Spectrum mirror = display->mix.count
                          ? panel_mix_mirror(&display->mix, cosine, display->wavelengths)
                          : panel_mirror_at(display->panel, cosine, &display->lanes);
    if (!display->cover) return mirror;
    Spectrum rest = spectrum_all(1 - haze_albedo_of(display, cosine));
    Spectrum coated = mirror * coating_at(display->cover, display->wavelengths, cosine);
    return spectrum_min(coated, spectrum_max(mirror, rest));
}

static Spectrum mirror_at(const DisplaySurface *display, float cosine) {
    return clear_mirror_at(display, cosine) * spectrum_all(1 - display->matte);
}

/* What the finish scatters. */
static Spectrum finish_brdf(const DisplaySurface *display, Vec3 wo, Vec3 wi) {
    if (!(display->matte > 0)) return spectrum_all(0);
    Vec3 half = vec3_normalize(vec3_add(wo, wi));
    float lobe = ggx_reflection(wo, wi, half, display->matte_alpha);
    return clear_mirror_at(display, vec3_dot(wo, half)) * spectrum_all(display->matte * lobe);
}

static float finish_pdf(const DisplaySurface *display, Vec3 wo, Vec3 wi) {
    if (!(display->matte > 0)) return 0;
    return ggx_reflection_pdf(wo, vec3_normalize(vec3_add(wo, wi)), display->matte_alpha);
}

/* The chances of taking the mirror and the finish: their shares of all reflected light. */
typedef struct DisplayChances {
    Spectrum mirror;
    float of_mirror, of_finish;
} DisplayChances;

static DisplayChances chances_of(const DisplaySurface *display, Vec3 wo) {
    Spectrum clear = clear_mirror_at(display, wo.z);
    float mean = spectrum_mean(clear), all = mean + haze_albedo_of(display, wo.z);
    float share = all > 0 ? mean / all : 0;
    return (DisplayChances){clear * spectrum_all(1 - display->matte), share * (1 - display->matte),
                            share * display->matte};
}

/* Of all but the mirror. */
static float scattered_pdf(const DisplaySurface *display, const DisplayChances *chances, Vec3 wo,
                           Vec3 wi) {
    float haze = display->mix.count ? panel_mix_pdf(&display->mix, wo, wi)
                                    : panel_pdf(display->panel, wo, wi);
    return (1 - chances->of_mirror - chances->of_finish) * haze +
           chances->of_finish * finish_pdf(display, wo, wi);
}

static bool reflects(const DisplaySurface *display, Vec3 wo) {
    return wo.z > 0 && panel_reflects(display->panel);
}

static bool model_reaches(const void *parameters, Vec3 wo, Vec3 wi) {
    return reflects(parameters, wo) && wi.z > 0;
}

static Spectrum model_eval(const void *parameters, Vec3 wo, Vec3 wi, float *pdf) {
    const DisplaySurface *display = parameters;
    *pdf = 0;
    if (!model_reaches(parameters, wo, wi)) return spectrum_all(0);
    DisplayChances chances = chances_of(display, wo);
    *pdf = scattered_pdf(display, &chances, wo, wi);
    return brdf_of(display, wo, wi) + finish_brdf(display, wo, wi);
}

static bool sample_haze(const DisplaySurface *display, Vec3 wo, const float u[3], Vec3 *wi,
                        float *pdf) {
    return display->mix.count ? panel_mix_sample(&display->mix, wo, u, wi, pdf)
                              : panel_sample(display->panel, wo, u, wi, pdf);
}

/* A direction of haze and finish, and its density where the mirror is not taken. */
static bool sample_scattered(const DisplaySurface *display, const DisplayChances *chances, Vec3 wo,
                             const float u[3], Vec3 *wi, float *pdf) {
    if (!(display->matte > 0)) return sample_haze(display, wo, u, wi, pdf);
    float left = 1 - chances->of_mirror;
    float share = left > 0 ? min_f(chances->of_finish / left, 1) : 0;
    if (u[2] < share) *wi = ggx_sample_reflection(wo, display->matte_alpha, u[0], u[1]);
    else {
        float rest[3] = {u[0], u[1], clampf((u[2] - share) / (1 - share), 0, 0x1.fffffep-1f)};
        if (!sample_haze(display, wo, rest, wi, pdf)) return false;
    }
    *pdf = wi->z > 0 ? scattered_pdf(display, chances, wo, *wi) / left : 0;
    return true;
}

static bool model_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample) {
    const DisplaySurface *display = parameters;
    if (!reflects(display, wo)) return false;
    DisplayChances chances = chances_of(display, wo);
    float prob = chances.of_mirror;
    if (u[2] < prob) {
        *sample = (BsdfSample){.wi = vec3(-wo.x, -wo.y, wo.z),
                               .pdf = prob,
                               .is_delta = true,
                               .weight = chances.mirror / spectrum_all(prob)};
        return true;
    }
    float rest[3] = {u[0], u[1], clampf((u[2] - prob) / (1 - prob), 0, 0x1.fffffep-1f)};
    Vec3 wi;
    float pdf;
    if (!sample_scattered(display, &chances, wo, rest, &wi, &pdf) || !(wi.z > 0)) return false;
    pdf *= 1 - prob;
    if (!(pdf > 0)) return false;
    Spectrum f = brdf_of(display, wo, wi) + finish_brdf(display, wo, wi);
    *sample = (BsdfSample){.wi = wi, .weight = f * spectrum_all(wi.z / pdf), .pdf = pdf};
    return true;
}

static Spectrum model_mirror(const void *parameters, Vec3 wo) {
    const DisplaySurface *display = parameters;
    if (!reflects(display, wo)) return spectrum_all(0);
    return mirror_at(display, wo.z);
}

static void model_facts(const void *parameters, BsdfFacts *facts) {
    const DisplaySurface *display = parameters;
    facts->scatters = panel_reflects(display->panel);
}

static Spectrum model_albedo(const void *parameters, Vec3 wo) {
    const DisplaySurface *display = parameters;
    if (!reflects(display, wo)) return spectrum_all(0);
    return clear_mirror_at(display, wo.z) + spectrum_all(haze_albedo_of(display, wo.z));
}

/* Of the panel's lambertian part, no haze; 0 where eval is 0. */
static Spectrum lambertian_share(const DisplaySurface *display, Vec3 wo, Vec3 wi) {
    float pdf;
    Spectrum f = model_eval(display, wo, wi, &pdf);
    Spectrum lambertian = display->mix.count
                              ? panel_mix_lambertian(&display->mix, f, wi, display->wavelengths)
                              : panel_lambertian_at(display->panel, f, wi, &display->lanes);
    return lambertian / spectrum_max(f, spectrum_all(1e-30f));
}

/* Of several panels all have to be measured there. */
static bool is_extrapolated(const DisplaySurface *display, Vec3 wo, Vec3 wi) {
    bool is_measured = true;
    if (!model_reaches(display, wo, wi)) return false;
    if (!display->mix.count) return !panel_brdf_is_measured(display->panel, wo, wi);
    for (int i = 0; i < display->mix.count; i++)
        is_measured &= panel_brdf_is_measured(display->mix.panel[i], wo, wi);
    return !is_measured;
}

static Spectrum model_part(const void *parameters, BsdfPart part, Vec3 wo, Vec3 wi) {
    switch (part) {
    case BSDF_LAMBERTIAN: return lambertian_share(parameters, wo, wi);
    case BSDF_EXTRAPOLATED: return spectrum_all(is_extrapolated(parameters, wo, wi));
    default: return spectrum_all(0);
    }
}

/* The mirror polarises as the cover's glass does; haze is scattered more than once. */
static bool model_polarise(const void *parameters, Vec3 wo, const BsdfSample *way,
                           BsdfPolarisation *out) {
    const DisplaySurface *display = parameters;
    float cosine = clampf(wo.z, 0, 1);
    if (!way->is_delta) return false;
    if (!display->waves) {
        *out = polarised_by(waves_reflected(cosine, COVER_IOR));
        return true;
    }
    PolarisedParts one = {spectrum_all(0), spectrum_all(0), spectrum_all(0), spectrum_all(0)};
    polarised_add_coated(&one, display->waves, display->wavelengths, cosine, spectrum_all(1));
    *out = polarised_of(&one, spectrum_all(1));
    return true;
}

const BsdfModel display_model = {
    .traits = BSDF_HAS_LAMBERTIAN,
    .scatter = {.eval = model_eval,
                .sample = model_sample,
                .reaches = model_reaches,
                .albedo = model_albedo},
    .boundary = {.mirror = model_mirror},
    .facts = model_facts,
    .part = model_part,
    .polarise = model_polarise,
};
