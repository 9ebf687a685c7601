/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic_polarised.h"

#include "shaders/metallic/metallic_eval.h"
#include "shaders/metallic/metallic_look.h"
#include "shaders/polarisation.h"

/* Adds the base's facets, met at `cosine`, which send `all` in sum. A metal without n, k is
 * taken for a perfect mirror. */
static void add_facets(const MetallicView *view, float cosine, Spectrum all,
                       PolarisedParts *parts)
{
    static const Waves mirror = {1, 1, -1, 0};
    const MetallicRoughness *m = view->m;
    Spectrum nonmetal = facet_of_nonmetal(m, &view->boundary, cosine);
    Spectrum metal = facet_of_metal(m, cosine);
    Spectrum share = all / spectrum_max(nonmetal + metal, spectrum_all(1e-30f));
    const SurfaceCoating *coating = m->coating;
    if (m->metallic > 0 && coating && coating->metal_waves)
        polarised_add_coated(parts, coating->metal_waves, m->wavelengths, fminf(cosine, 1),
                             share * metal);
    else if (m->metallic > 0)
        polarised_add(parts, mirror, share * metal);
    if (!(m->metallic < 1)) return;
    if (coating && coating->glass_waves && !(m->transmission > 0)) {
        polarised_add_coated(parts, coating->glass_waves, m->wavelengths, fminf(cosine, 1),
                             share * nonmetal);
        return;
    }
    float ior = m->energy->ior;
    Waves face = ior >= 1 ? waves_reflected(fminf(cosine, 1), ior) : mirror;
    Waves sheet = waves_sheet_reflected(face);
    float opaque = (1 - m->transmission) * (face.s + face.p);
    float clear = m->transmission * (sheet.s + sheet.p), both = opaque + clear;
    if (!(both > 0)) return;
    polarised_add(parts, face, share * nonmetal * spectrum_all(opaque / both));
    if (clear > 0) polarised_add(parts, sheet, share * nonmetal * spectrum_all(clear / both));
}

static bool is_near(Vec3 a, Vec3 b)
{
    Vec3 apart = vec3_sub(a, b);
    return vec3_dot(apart, apart) < 1e-6f;
}

/* The images that a smooth coat and a smooth base send along this way. */
static void polarise_smooth(const MetallicView *view, Vec3 wi, PolarisedParts *parts)
{
    const MetallicRoughness *m = view->m;
    float cosine = vec3_dot(m->clearcoat_normal, view->wo);
    Vec3  by_coat = vec3_sub(vec3_scale(m->clearcoat_normal, 2 * cosine), view->wo);
    Vec3  by_base = vec3(-view->wo.x, -view->wo.y, view->wo.z);
    if (m->clearcoat > 0 && is_smooth(m->clearcoat_alpha) && is_near(by_coat, wi))
        polarised_add(parts, waves_reflected(clampf(cosine, 0, 1), CLEARCOAT_IOR),
                      spectrum_all(m->clearcoat * coat_facet(cosine)));
    if (is_smooth(m->alpha) && is_near(by_base, wi))
        add_facets(view, view->wo.z, eval_smooth(view, wi), parts);
}

static void polarise_rough(const MetallicView *view, Vec3 wi, PolarisedParts *parts)
{
    const MetallicRoughness *m = view->m;
    Vec3    half = vec3_normalize(vec3_add(view->wo, wi));
    float   pdf, cosine = fminf(fabsf(vec3_dot(view->wo, half)), 1);
    ThroughCoat below;
    if (!is_smooth(m->alpha)) {
        if (m->clearcoat > 0) below = coat_through(m, wi);
        add_facets(view, cosine, eval_facets(view, wi, &below), parts);
    }
    if (m->clearcoat > 0 && !is_smooth(m->clearcoat_alpha))
        polarised_add(parts, waves_reflected(cosine, CLEARCOAT_IOR),
                      spectrum_all(coat_eval(m, view->wo, wi, &pdf)));
}

/* A rough sheet's straight light is taken for all that it lets through. */
static bool polarise_through(const MetallicRoughness *m, Vec3 wo, BsdfPolarisation *out)
{
    if (!(m->energy->ior >= 1)) return false;
    *out = polarised_by(waves_sheet_through(waves_reflected(fminf(wo.z, 1), m->energy->ior)));
    return true;
}

bool metallic_polarised(const void *parameters, Vec3 wo, const BsdfSample *way,
                        BsdfPolarisation *out)
{
    const MetallicRoughness *m = parameters;
    PolarisedParts parts = {spectrum_all(0), spectrum_all(0), spectrum_all(0), spectrum_all(0)};
    if (!(wo.z > 0)) return false;
    if (way->passes || way->wi.z < 0) return polarise_through(m, wo, out);
    MetallicView own;
    const MetallicView *view = metallic_seen(m, wo, &own);
    if (way->is_delta) {
        polarise_smooth(view, way->wi, &parts);
        *out = polarised_of(&parts, parts.share);
    } else {
        float pdf;
        polarise_rough(view, way->wi, &parts);
        *out = polarised_of(&parts, eval_all(view, way->wi, &pdf));
    }
    return true;
}
