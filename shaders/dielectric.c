/* SPDX-License-Identifier: Apache-2.0 */
/* dielectric -- lenses, light guides, thick covers, bottles: the boundary of a closed solid of
 * clear glass or plastic.
 *   ior    above 0, inside against outside; acrylic 1.49, polycarbonate 1.585, water 1.33
 *   tint   0..1 a wavelength, of transmitted light at each crossing; default 1
 *   alpha  0..1 GGX; below 0.001 smooth; frosted covers about 0.1 to 0.3
 *   alpha_along  0.001..1, default none: brushed; alpha along the frame's x, then `alpha` is
 *          across it (KHR_materials_anisotropy)
 *   coating  a stack of thin layers on the boundary (PARHELION_coating)
 *   film   a clear film of some 100 nm on the share `share` of it (KHR_materials_iridescence):
 *          soap 1.33, iridescent glass 1.8 to 2.4
 *   index    ior by wavelength (dispersion): crown glass 1.522 at 486 nm, 1.514 at 656 nm;
 *            flint and diamond spread white light two and three times as far
 * Exact unpolarised Fresnel reflectance; rough boundaries after Walter et al. 2007 with
 * height-correlated shadowing. Radiance grows by (n_eye side / n_light side)^2 on crossing
 * (light is squeezed into a narrower cone); a path in and out of a solid has 1 in all.
 *
 * A coating interferes with itself (spectrum/thin_film.h). Its R and T at every angle and
 * wavelength stand in for Fresnel's; what is neither, it absorbs. Typical: MgF2 on glass
 * reflects 1.3 % a face, four layers 0.1 %, silver between two oxides 19 % and absorbs 4 %.
 *
 * A film (clear_film.h) takes nothing: what it does not reflect goes through, as much from
 * inside as from outside along one ray, and total reflection stays total. It is exact at every
 * wavelength and angle, also on facets and on dispersive glass. A soap bubble is a solid of
 * index 1 with a film of 1.33.
 *
 * Where the index differs by wavelength each lane is a boundary of its own. One lane is drawn,
 * by what the lanes still count, and decides where it goes. A mirror sends all of them there.
 * Refraction sends each elsewhere: a smooth boundary goes on with the drawn one alone, divided
 * by its chance (straight through, with all); of a rough one all lanes go on that may have been
 * sent there, by the balance heuristic over them (Veach 1997, 9.2.2): eval over the mean
 * density.
 *
 * Polarised light is followed exactly where glass is bare; coated and filmed glass is taken as
 * bare for how it polarises, and dispersive glass as of one index.
 *
 * What rough facets pass to one another comes out of the boundary without a direction of its
 * own, on both sides (solid_energy.h; of brushed ones by azimuth as well, brushed_loss.h): a
 * clear solid of any roughness returns what it gets, within 0.2 %, coated or filmed as well;
 * a dispersive one within 0.6 %, and a brushed one whose alphas a texture changes within
 * 1 %. Without that it would lose up to a third at alpha 1.
 *
 * Not modelled: an overlay (layers/overlay.h). A boundary between equal indices, filmed or not,
 * is smooth.
 */
#include "base/mathf.h"
#include "shaders/solid_facet.h"

#include "spectrum/fresnel.h"
#include "shaders/facets/microfacet.h"
#include "shaders/polarisation.h"

/* Facets between equal media bend nothing, and would have no half-way normal to be found by. */
static bool is_delta(const Dielectric *d) {
    return is_smooth(d->alpha) || fabsf(d->ior - 1) < 1e-4f;
}

/* ---- facets: even, or brushed -------------------------------------------------------- */

static inline float facets_send(const Dielectric *d, const SolidRay *s, Vec3 half) {
    return solid_is_brushed(d) ? brushed_reflection(s->wo, s->wi, half, solid_alphas(d))
                               : ggx_reflection(s->wo, s->wi, half, d->alpha);
}

static inline float facet_pdf(const Dielectric *d, Vec3 wo, Vec3 half) {
    return solid_is_brushed(d) ? brushed_visible_pdf(wo, half, solid_alphas(d))
                               : ggx_visible_pdf(wo, half, d->alpha);
}

/* ---- one facet --------------------------------------------------------------------------- */

static Spectrum eval_reflected(const Dielectric *d, const SolidRay *s, float *pdf) {
    Vec3 half = vec3_normalize(vec3_add(s->wo, s->wi));
    float cosine = vec3_dot(s->wo, half);
    FacetShares f = solid_facet(d, s, cosine);
    *pdf = f.prob * facet_pdf(d, s->wo, half) / (4 * cosine);
    return f.reflected * spectrum_all(facets_send(d, s, half));
}

/* The facet that refracts light from wi to wo; out: wo.h; spread: |wi.h| / (wo.h + eta wi.h)^2.
 * False: there is none. */
typedef struct RefractingFacet {
    Vec3 half;
    float out, spread;
} RefractingFacet;

static bool refracting_facet(const SolidRay *s, RefractingFacet *at) {
    at->half = vec3_normalize(vec3_along(s->wo, s->wi, s->eta));
    if (at->half.z < 0) at->half = vec3_neg(at->half);
    float in = vec3_dot(s->wi, at->half);
    at->out = vec3_dot(s->wo, at->half);
    float root = at->out + s->eta * in;
    at->spread = -in / (root * root);
    return at->out > 0 && in < 0 && at->spread <= 3e38f;
}

/* Walter 2007, equations 16, 17 and 21 for wo + eta wi along the facet's normal, with the
 * factor 1/eta^2 of radiance: f = |wi.h| |wo.h| T G D / (|wo.z| |wi.z| (wo.h + eta wi.h)^2). */
static Spectrum eval_transmitted(const Dielectric *d, const SolidRay *s, float *pdf) {
    RefractingFacet at;
    *pdf = 0;
    if (!refracting_facet(s, &at)) return spectrum_all(0);
    FacetShares f = solid_facet(d, s, at.out);
    *pdf = (1 - f.prob) * facet_pdf(d, s->wo, at.half) * s->eta * s->eta * at.spread;
    /* facets_send is D G2 / (4 zo zi). */
    Spectrum lobe = spectrum_all(4 * facets_send(d, s, at.half));
    return d->tint * (f.through * lobe * spectrum_all(at.out) * spectrum_all(at.spread));
}

static Vec3 turn_back(const SolidRay *s, Vec3 wi) {
    return s->turned ? vec3(wi.x, wi.y, -wi.z) : wi;
}

/* ---- dispersion ------------------------------------------------------------------------- */

/* A smooth boundary, or a facet, as every lane finds it. */
typedef struct LaneFacets {
    Spectrum chance;              /* of each lane to be drawn */
    Spectrum eta;                 /* the other side's index over this side's */
    Spectrum mirror;              /* Fresnel's share, or the film's */
    Spectrum reflects;            /* probability of reflection, where the lane is drawn */
    float behind[SPECTRUM_LANES]; /* cosines of the refracted directions */
} LaneFacets;

static float lane_reflects(float mirror, float tint) {
    return reflect_prob(mirror, (1 - mirror) * tint);
}

/* cosine: to the facet. */
static void meet_lanes(const Dielectric *d, const SolidRay *s, float cosine, LaneFacets *out) {
    Spectrum n = curve_lookup(d->index, d->wavelengths);
    out->chance = d->light ? *d->light / spectrum_all(spectrum_sum(*d->light))
                           : spectrum_all(1.0f / SPECTRUM_LANES);
    out->eta = s->turned ? spectrum_all(1) / n : n;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        SolidRay own = {.eta = out->eta[i], .turned = s->turned};
        float f = fresnel_mean(fresnel_dielectric(cosine, own.eta, &out->behind[i]));
        out->mirror[i] = solid_has_film(d) ? solid_filmed_lane(d, &own, i, cosine) : f;
        out->reflects[i] = lane_reflects(out->mirror[i], d->tint[i]);
    }
}

/* The lane on whose strip of [0, the sum) the place lies; it becomes the place in that. */
static int lane_at(Spectrum strips, float *place) {
    int last = 0;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        if (!(strips[i] > 0)) continue;
        last = i;
        if (*place < strips[i]) break;
        *place -= strips[i];
    }
    *place = clampf(*place / strips[last], 0, 0x1.fffffep-1f);
    return last;
}

/* One lane's facet, refracting: f, and the density if that lane is drawn (eval_transmitted). */
static float lane_transmitted(const Dielectric *d, const SolidRay *s, int lane, float *pdf) {
    RefractingFacet at;
    float tint = d->tint[lane];
    *pdf = 0;
    if (!refracting_facet(s, &at)) return 0;
    float f = solid_has_film(d) ? solid_filmed_lane(d, s, lane, at.out)
                                : fresnel_unpolarised(at.out, s->eta);
    *pdf =
        (1 - lane_reflects(f, tint)) * facet_pdf(d, s->wo, at.half) * s->eta * s->eta * at.spread;
    return tint * (1 - f) * 4 * facets_send(d, s, at.half) * at.out * at.spread;
}

static Spectrum split_eval(const Dielectric *d, SolidRay s, float *pdf) {
    LaneFacets lanes;
    if (s.wi.z > 0) {
        Vec3 half = vec3_normalize(vec3_add(s.wo, s.wi));
        float cosine = vec3_dot(s.wo, half);
        meet_lanes(d, &s, cosine, &lanes);
        *pdf =
            spectrum_sum(lanes.chance * lanes.reflects) * facet_pdf(d, s.wo, half) / (4 * cosine);
        return lanes.mirror * spectrum_all(facets_send(d, &s, half));
    }
    Spectrum value;
    meet_lanes(d, &s, s.wo.z, &lanes);
    *pdf = 0;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float own;
        s.eta = lanes.eta[i];
        value[i] = lane_transmitted(d, &s, i, &own);
        *pdf += lanes.chance[i] * own;
    }
    return value;
}

/* At normal incidence no lane is bent away from the others. */
static bool is_straight(Vec3 wo) {
    return wo.x * wo.x + wo.y * wo.y < 1e-12f;
}

static bool split_smooth(const Dielectric *d, SolidRay *s, float u, BsdfSample *sample) {
    LaneFacets lanes;
    meet_lanes(d, s, s->wo.z, &lanes);
    Spectrum one = spectrum_all(1), refracts = lanes.chance * (one - lanes.reflects);
    Spectrum through = (one - lanes.mirror) * d->tint / (lanes.eta * lanes.eta);
    float turned_back = spectrum_sum(lanes.chance * lanes.reflects);
    float goes_on = spectrum_sum(refracts), place = u * (turned_back + goes_on);
    *sample = (BsdfSample){.is_delta = true};
    if (place < turned_back) {
        sample->wi = turn_back(s, vec3(-s->wo.x, -s->wo.y, s->wo.z));
        sample->pdf = turned_back;
        sample->weight = lanes.mirror / spectrum_all(turned_back);
        return true;
    }
    if (!(goes_on > 0)) return false;
    place -= turned_back;
    int lane = lane_at(refracts, &place);
    Vec3 up = vec3(0, 0, 1);
    float eta = lanes.eta[lane];
    sample->wi =
        turn_back(s, vec3_normalize(refracted(s->wo, up, eta, s->wo.z, lanes.behind[lane])));
    sample->pdf = is_straight(s->wo) ? goes_on : refracts[lane];
    sample->weight = spectrum_all(0);
    if (is_straight(s->wo)) sample->weight = through / spectrum_all(goes_on);
    else sample->weight[lane] = through[lane] / refracts[lane];
    return true;
}

/* Draws a lane, and whether it is reflected by a facet met at that cosine. */
static bool lane_choice(const Dielectric *d, const SolidRay *s, float cosine, float u, float *eta,
                        float *behind) {
    LaneFacets lanes;
    meet_lanes(d, s, cosine, &lanes);
    int lane = lane_at(lanes.chance, &u);
    *eta = lanes.eta[lane];
    *behind = lanes.behind[lane];
    return u < lanes.reflects[lane];
}

/* ---- the model -------------------------------------------------------------------------- */

static Spectrum rough_eval(const Dielectric *d, const SolidRay *s, float *pdf) {
    Spectrum value = d->index      ? split_eval(d, *s, pdf)
                     : s->wi.z > 0 ? eval_reflected(d, s, pdf)
                                   : eval_transmitted(d, s, pdf);
    if (d->energy) solid_loss_add(d, s, &value, pdf);
    return value;
}

static Spectrum solid_eval(const void *parameters, Vec3 wo, Vec3 wi, float *pdf) {
    const Dielectric *d = parameters;
    *pdf = 0;
    if (is_delta(d) || wo.z == 0 || wi.z == 0) return spectrum_all(0);
    SolidRay s = solid_ray(d, wo, wi);
    return rough_eval(d, &s, pdf);
}

/* For a boundary of one index. */
static bool smooth_sample(const Dielectric *d, SolidRay *s, float u, BsdfSample *sample) {
    FacetShares f = solid_facet(d, s, s->wo.z);
    bool reflects = u < f.prob;
    if (!reflects && !(f.behind > 0 && f.prob < 1)) return false;
    Vec3 up = vec3(0, 0, 1);
    s->wi = reflects ? vec3(-s->wo.x, -s->wo.y, s->wo.z)
                     : vec3_normalize(refracted(s->wo, up, s->eta, s->wo.z, f.behind));
    if (!(reflects ? s->wi.z > 0 : s->wi.z < 0)) return false;
    float prob = reflects ? f.prob : 1 - f.prob;
    *sample = (BsdfSample){.wi = turn_back(s, s->wi), .pdf = prob, .is_delta = true};
    sample->weight = reflects ? f.reflected / spectrum_all(prob)
                              : f.through / spectrum_all(prob * s->eta * s->eta) * d->tint;
    return true;
}

/* Chooses s->wi by a visible facet of a rough boundary, of one index or of a drawn lane. u[2]
 * decides between reflection and refraction. False: the light is lost. */
static bool facet_sample(const Dielectric *d, SolidRay *s, const float u[3]) {
    Vec3 half = brushed_sample_visible(s->wo, solid_alphas(d), u[0], u[1]);
    float cosine = vec3_dot(s->wo, half), behind, eta = s->eta;
    bool reflects;
    if (!(cosine > 0)) return false;
    if (d->index) {
        reflects = lane_choice(d, s, cosine, u[2], &eta, &behind);
    } else {
        FacetShares f = solid_facet(d, s, cosine);
        reflects = u[2] < f.prob;
        behind = f.behind;
    }
    if (!reflects && !(behind > 0)) return false;
    s->wi = reflects ? vec3_sub(vec3_scale(half, 2 * cosine), s->wo)
                     : vec3_normalize(refracted(s->wo, half, eta, cosine, behind));
    return reflects ? s->wi.z > 0 : s->wi.z < 0;
}

static bool rough_sample(const Dielectric *d, SolidRay *s, const float u[3], BsdfSample *sample) {
    float v[3] = {u[0], u[1], u[2]}, pdf;
    bool is_lost = d->energy && solid_loss_sample(d, s, v);
    if (!is_lost && !facet_sample(d, s, v)) return false;
    Spectrum value = rough_eval(d, s, &pdf);
    if (!(pdf > 0)) return false;
    *sample = (BsdfSample){.wi = turn_back(s, s->wi),
                           .pdf = pdf,
                           .weight = value * spectrum_all(fabsf(s->wi.z) / pdf)};
    return true;
}

static bool solid_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample) {
    const Dielectric *d = parameters;
    if (wo.z == 0) return false;
    SolidRay s = solid_ray(d, wo, wo);
    if (!is_delta(d)) return rough_sample(d, &s, u, sample);
    return d->index ? split_smooth(d, &s, u[2], sample) : smooth_sample(d, &s, u[2], sample);
}

static void solid_facts(const void *parameters, BsdfFacts *facts) {
    const Dielectric *d = parameters;
    facts->scatters = !is_delta(d);
}

static Spectrum solid_mirror(const void *parameters, Vec3 wo) {
    const Dielectric *d = parameters;
    if (!is_delta(d) || wo.z == 0) return spectrum_all(0);
    SolidRay s = solid_ray(d, wo, wo);
    if (d->index) {
        LaneFacets lanes;
        meet_lanes(d, &s, s.wo.z, &lanes);
        return lanes.mirror;
    }
    return solid_facet(d, &s, s.wo.z).reflected;
}

static Spectrum solid_albedo(const void *parameters, Vec3 wo) {
    const Dielectric *d = parameters;
    if (!d->coating || wo.z == 0) return spectrum_all(1);
    SolidRay s = solid_ray(d, wo, wo);
    FacetShares f = solid_facet(d, &s, s.wo.z);
    return f.reflected + f.through;
}

/* The cosine to the facet that light met on its way from s->wi to s->wo. */
static float met_at(const Dielectric *d, const SolidRay *s) {
    if (is_delta(d)) return s->wo.z;
    Vec3 half = vec3_normalize(vec3_along(s->wo, s->wi, s->wi.z > 0 ? 1 : s->eta));
    return min_f(fabsf(vec3_dot(s->wo, half)), 1);
}

static bool solid_polarise(const void *parameters, Vec3 wo, const BsdfSample *way,
                           BsdfPolarisation *out) {
    const Dielectric *d = parameters;
    if (wo.z == 0) return false;
    SolidRay s = solid_ray(d, wo, way->wi);
    float cosine = met_at(d, &s);
    *out = polarised_by(s.wi.z > 0 ? waves_reflected(cosine, s.eta) : waves_through(cosine, s.eta));
    return true;
}

static void solid_set(void *parameters, const BsdfSetting *setting) {
    if (setting->light) ((Dielectric *)parameters)->light = setting->light;
}

const BsdfModel dielectric_model = {
    .traits = BSDF_REFRACTS,
    .scatter = {.eval = solid_eval, .sample = solid_sample, .albedo = solid_albedo},
    .boundary = {.mirror = solid_mirror},
    .facts = solid_facts,
    .set = solid_set,
    .polarise = solid_polarise,
};
