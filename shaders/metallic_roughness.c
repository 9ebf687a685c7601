/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_roughness -- glTF 2.0's surface with specular, ior, clear coat, thin transmission.
 *
 * On a dashboard it is nearly everything: moulded plastic, leather, soft paint, woven cloth,
 * satin and bright chrome, piano lacquer, tinted thin covers.
 *
 *   base_color        0..1 a wavelength, default 1   albedo; of a metal its mirror reflectance
 *   metallic          0..1, default 1                0 plastic, 1 metal
 *   alpha             0..1, default 1                glTF's roughness squared; a perfect mirror
 *                                                    below 0.001
 *   alpha_along       0..1, default none             brushed: alpha along the frame's x, then
 *                                                    `alpha` is across it (KHR_..._anisotropy)
 *   energy->ior       1..2.5, glTF's default 1.5     of the non-metal; 0: reflects everything
 *   specular          0..1, default 1                weakens the non-metal's reflection
 *   specular_color    0 and up, default 1            tints it at normal incidence
 *   transmission      0..1, default 0                share of the non-metal: a thin sheet
 *   tint              0..1 a wavelength, default 1   what its body lets through once, upright
 *   across            0..1, default 0                share of the base's light that leaves on
 *                                                    the other side, of albedo across_color:
 *                                                    paper 0.4, a lampshade or leaf 0.5
 *   clearcoat, clearcoat_alpha, clearcoat_normal     a lacquer of index 1.5, of a sheet on both
 *                                                    sides alike; default none
 *   film              a clear film of some 100 nm on the share `share` of metal and non-metal
 *                     (KHR_materials_iridescence)
 *   overlay           sheen (KHR_materials_sheen), fibres of cloth that stand up, under the
 *                     coat; default none. Alcantara 0.1..0.3, alpha 0.1; velvet 0.8, alpha 0.3
 *   coating           a stack of thin layers (PARHELION_coating) or a metal of measured n, k
 *                     (PARHELION_spectrum): its own reflectance at every angle and wavelength
 *
 * Typical: matt dashboard plastic base 0.04, alpha 0.3; glossy black base 0.02, alpha 0.01;
 * leather base 0.1, alpha 0.25; satin aluminium metallic 1, base 0.9, alpha 0.1; piano
 * lacquer base 0.02 under a smooth clear coat.
 *
 * Model. Facets are GGX with height-correlated shadowing (Walter 2007, Heitz 2014), sampled by
 * visible normals. Non-metals reflect by the exact Fresnel curve, scaled so that its ends are
 * F0 = min(F0(ior) specular_color, 1) specular and F90 = specular. What the boundary does not
 * send back goes into a Lambert base, coupled symmetrically (Kelemen and Szirmay-Kalos 2001),
 * so a white plastic returns exactly what it gets. Metals use Schlick's curve a wavelength. The
 * transmissive share is a sheet with two faces and one body that absorbs (layers/pane.h), each
 * polarisation by itself; smooth sheets pass light straight on. Metals and sheets get back what
 * facets send to other facets (Kulla and Conty 2017).
 * A coat covers its share of the surface. What it lets in and out again is one less its albedo
 * each way; what it holds back meets the base again: a metal's lobe and rebound are scaled for
 * it by coat.h, so are a non-metal's facets, each further turn by what they reflect in the mean;
 * the Lambert base is coupled to both boundaries at once. A white metal or plastic of any F0
 * under any coat returns what it gets, to 85 degrees within 0.1 % (plastic) and 0.2 % (metal);
 * of a coloured base each further turn takes its albedo. All of it is reciprocal.
 * What coat.h's tables do not know, brushed, filmed and coated faces and sheen, sends out
 * through the coat what covered_lobe.h integrates on the spot; all else of the light that the
 * coat let in is the Lambert base's or the rebound's, coupled symmetrically. Facets of a metal
 * then have the turns of a mirror at the lower of both directions, fibres and facets of a
 * non-metal what the coat lets pass each way. White ones under any coat, also all together,
 * return what they get within 0.2 % to 85 degrees.
 * A sheet stands between the coats of its two sides, and all turns between the three are summed
 * up (metallic_facet.h): of smooth ones as a stack of boundaries whose light does not
 * interfere. A rough one's facets send what a metal's lobe of its own R + T sends under that
 * coat, parted to both sides as the turns do, and what they hide leaves on both sides as the
 * rebound, likewise. So a white sheet, clear or frosted, under any coat and mixed with all else
 * on this page, sends on what it gets, to 85 degrees within 0.2 %, as a metal does; below a
 * full sheen or with fine brushing within 0.4 %. As much goes through from either side.
 * Light that goes across is Lambert's on the other side, coupled to the boundaries of both as
 * the base is to one: f = across color / pi * in(wo) in(wi) / mean of in. Boundary and coat lie
 * on either side alike, so white paper, lacquered or not, returns what it gets; it passes
 * nothing straight.
 * A brushed base has two alphas (microfacet.h); what its facets send back in all comes from
 * lobe_facets.h, so a white one, metal or plastic, returns what it gets within 0.2 % to 85
 * degrees too.
 * A coating's reflectance (coating.h) stands in for Fresnel's and Schlick's curves in all of
 * this; with it, metals follow the exact curve of their n, k. What it absorbs is lost.
 *
 * A film (clear_film.h) does so at each wavelength, on a body that absorbs nothing and has the
 * base's reflectance at normal incidence: of the non-metal exact, of a metal approximate unless
 * its n, k are given. Energies of rough filmed faces come from lobe_facets.h, to 0.2 %.
 *
 * Sheen (sheen.h) lies on all but the coat, on both sides of a sheet alike. With E its albedo
 * and c the greatest of its colour, facets beneath are scaled by 1 - c max(E(wo), E(wi)), and
 * the Lambert base is coupled to sheen and boundary at once: each direction enters with what
 * neither the sheen nor the facets send, as does the light that facets hide. So white plastic,
 * metal or paper under white sheen returns what it gets, to 85 degrees within 0.2 % at every
 * roughness, and it is reciprocal. A coloured sheen takes from all beneath what its strongest
 * primary reflects (the extension's rule).
 *
 * Polarised light is followed by facets and coat as glass of their index has it, by a metal of
 * n, k and by a coated face as their waves add up; another metal is taken for a perfect mirror,
 * a coated sheet for a bare one; what the base and further facets send is unpolarised.
 *
 * Emission is not this page's: the coat dims it by 1 - clearcoat F (src/light/emission.c), F
 * the exact curve at the coat's normal, however rough, and the light stays unpolarised.
 *
 * Not modelled: subsurface spread, coloured absorption along a slanted path in the coat, turns
 * of light between a coat and the facets of a brushed, filmed, coated or woven non-metal (what
 * they would send, to 4 % of F0, goes to the Lambert base), and between a rough base and a coat
 * whose normal is tilted; of a metal without n, k the exact curve (Schlick is within some per
 * cent of it).
 */
#include "shaders/metallic_roughness.h"

#include "base/mathf.h"
#include "shaders/metallic/metallic_eval.h"
#include "shaders/polarisation.h"

#define WIDE_ALPHA 0.15f /* lobes of more than about ten degrees */

MetallicRoughness metallic_roughness_default(const EnergyTable *energy) {
    return (MetallicRoughness){.base_color = spectrum_all(1),
                               .tint = spectrum_all(1),
                               .specular_color = spectrum_all(1),
                               .metallic = 1,
                               .alpha = 1,
                               .specular = 1,
                               .clearcoat_normal = {0, 0, 1},
                               .energy = energy};
}

static void model_set(void *parameters, const BsdfSetting *setting) {
    MetallicRoughness *m = parameters;
    MetallicView *view = setting->room;
    if (!setting->wo) return;
    m->seen = NULL;
    if (!(setting->wo->z > 0)) return;
    metallic_look(view, m, *setting->wo);
    m->seen = view;
}

static bool model_reaches(const void *parameters, Vec3 wo, Vec3 wi) {
    const MetallicRoughness *m = parameters;
    bool lets_through = sends_below(m) || m->across > 0;
    return wo.z > 0 && (wi.z > 0 || (wi.z < 0 && lets_through));
}

static Spectrum model_eval(const void *parameters, Vec3 wo, Vec3 wi, float *pdf) {
    const MetallicRoughness *m = parameters;
    *pdf = 0;
    if (!model_reaches(parameters, wo, wi)) return spectrum_all(0);
    MetallicView own;
    const MetallicView *view = metallic_seen(m, wo, &own);
    return eval_all(view, wi, pdf);
}

/* ---- images ------------------------------------------------------------------------------ */

static Spectrum model_mirror(const void *parameters, Vec3 wo) {
    const MetallicRoughness *m = parameters;
    bool is_upright = m->clearcoat_normal.z >= COAT_UPRIGHT;
    float coat = is_upright && is_smooth(m->clearcoat_alpha) ? m->clearcoat : 0;
    if (!(wo.z > 0)) return spectrum_all(0);
    Spectrum by_coat = spectrum_all(coat > 0 ? coat * coat_facet(wo.z) : 0);
    if (!is_smooth(m->alpha)) return by_coat;
    MetallicView own;
    const MetallicView *view = metallic_seen(m, wo, &own);
    return by_coat + eval_smooth(view, vec3(-wo.x, -wo.y, wo.z));
}

static Spectrum model_part(const void *parameters, BsdfPart part, Vec3 wo, Vec3 wi) {
    const MetallicRoughness *m = parameters;
    ThroughCoat below;
    bool is_glint = !is_smooth(m->alpha) && m->alpha <= GLINT_ALPHA && !is_brushed(m);
    if (part != BSDF_GLINT || !(wo.z > 0 && wi.z > 0 && is_glint)) return spectrum_all(0);
    MetallicView own;
    const MetallicView *view = metallic_seen(m, wo, &own);
    if (m->clearcoat > 0) below = coat_through(m, wi);
    return eval_facets(view, wi, &below);
}

static Spectrum model_pass(const void *parameters, Vec3 wo) {
    const MetallicRoughness *m = parameters;
    if (!is_smooth(m->alpha) || !(m->transmission > 0) || !(wo.z > 0)) return spectrum_all(0);
    MetallicFace b = boundary_of(m);
    float kept = has_overlay(m) ? sqrtf(energy_kept(m, wo.z)) : 1;
    Spectrum through = facet_through(m, &b, wo.z);
    if (m->clearcoat > 0) {
        float open = coat_open(m, wo);
        SheetFaces faces = facet_sheet(m, &b, wo.z);
        Spectrum turned = sheet_turns(&faces, 1 - open).through;
        through = coat_mixed(m, through, turned * spectrum_all(clear_share(m) * open * open));
    }
    return through * spectrum_all(kept * kept);
}

/* ---- a direction ------------------------------------------------------------------------- */

static bool sample_smooth(BsdfSample *sample, Vec3 wi, Spectrum value, float prob) {
    *sample =
        (BsdfSample){.wi = wi, .weight = value / spectrum_all(prob), .pdf = prob, .is_delta = true};
    return true;
}

/* The smooth coat's mirror image, about the coat's own normal. */
static bool sample_smooth_coat(const MetallicView *view, BsdfSample *sample) {
    const MetallicRoughness *m = view->m;
    Vec3 wo = view->wo;
    float cosine = vec3_dot(m->clearcoat_normal, wo);
    Vec3 wi = vec3_sub(vec3_scale(m->clearcoat_normal, 2 * cosine), wo);
    float value = m->clearcoat * coat_facet(cosine) * coat_tilt(m, wo, wi);
    if (!(value > 0)) return false;
    /* Tilted cosines: the lobe is per cosine to the coat, the surface's cosine carries it. */
    return sample_smooth(sample, wi, spectrum_all(value * wi.z / cosine), view->choices.coat);
}

static bool sample_smooth_base(const MetallicView *view, BsdfSample *sample) {
    Vec3 wi = vec3(-view->wo.x, -view->wo.y, view->wo.z);
    return sample_smooth(sample, wi, eval_smooth(view, wi), view->choices.mirror);
}

typedef enum Part {
    PART_COAT,
    PART_MIRROR,
    PART_DIFFUSE,
    PART_THROUGH,
    PART_ACROSS,
    PART_OVERLAY,
    PART_NONE
} Part;

/* Chooses the part that u falls on; u becomes the place inside it: so directions of every part
 * are spread as well as their share of u is. */
static Part choose_part(const MetallicChoices *choices, float *u) {
    const float prob[] = {choices->coat,    choices->mirror, choices->diffuse,
                          choices->through, choices->across, choices->overlay};
    for (int part = 0; part < PART_NONE; part++) {
        if (*u < prob[part]) {
            *u = min_f(*u / prob[part], 0x1.fffffep-1f);
            return (Part)part;
        }
        *u -= prob[part];
    }
    return PART_NONE;
}

static Vec3 anywhere_above(float u0, float u1) {
    float sine, cosine, side = safe_sqrtf(1 - u1 * u1);
    sincos_turns(u0, &sine, &cosine);
    return vec3(side * cosine, side * sine, u1);
}

static Vec3 turned_over(Vec3 w) {
    return vec3(w.x, w.y, -w.z);
}

/* A direction by the rough coat, the rough mirror, the Lambert base, overlay or rough sheet. */
static Vec3 sample_rough(const MetallicView *view, Part part, const float u[3]) {
    const MetallicRoughness *m = view->m;
    if (part == PART_COAT) {
        Frame frame = frame_from_z(m->clearcoat_normal);
        Vec3 out = frame_to_local(&frame, view->wo);
        return frame_to_world(&frame, ggx_sample_reflection(out, m->clearcoat_alpha, u[0], u[1]));
    }
    if (part == PART_MIRROR) return base_sample(m, view->wo, u[0], u[1]);
    if (part == PART_DIFFUSE) return microfacet_cosine(u[0], u[1]);
    if (part == PART_OVERLAY) return anywhere_above(u[0], u[1]);
    if (part == PART_ACROSS) return turned_over(microfacet_cosine(u[0], u[1]));
    bool by_facet = u[2] < view->energy.all;
    Vec3 up = by_facet ? base_sample(m, view->wo, u[0], u[1]) : microfacet_cosine(u[0], u[1]);
    return turned_over(up);
}

static bool model_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample) {
    const MetallicRoughness *m = parameters;
    if (!(wo.z > 0)) return false;
    MetallicView own;
    const MetallicView *view = metallic_seen(m, wo, &own);
    float v[3] = {u[0], u[1], u[2]};
    Part part = choose_part(&view->choices, &v[0]);
    if (part == PART_NONE) return false;
    if (part == PART_COAT && is_smooth(m->clearcoat_alpha)) return sample_smooth_coat(view, sample);
    if (part == PART_MIRROR && is_smooth(m->alpha)) return sample_smooth_base(view, sample);
    if (part == PART_THROUGH && is_smooth(m->alpha)) {
        sample_smooth(sample, vec3_neg(wo), model_pass(m, wo), view->choices.through);
        return sample->passes = true;
    }
    Vec3 wi = sample_rough(view, part, v);
    if (!(part == PART_THROUGH || part == PART_ACROSS ? wi.z < 0 : wi.z > 0)) return false;
    float pdf;
    Spectrum f = eval_all(view, wi, &pdf);
    if (!(pdf > 0)) return false;
    *sample = (BsdfSample){.wi = wi, .weight = f * spectrum_all(fabsf(wi.z) / pdf), .pdf = pdf};
    return true;
}

/* ---- for choosing where to look ---------------------------------------------------------- */

static void model_facts(const void *parameters, BsdfFacts *facts) {
    const MetallicRoughness *m = parameters;
    bool has_base = (1 - m->metallic) * (1 - m->transmission) > 0;
    bool has_coat = m->clearcoat > 0 && !is_smooth(m->clearcoat_alpha);
    facts->scatters = has_base || has_coat || !is_smooth(m->alpha) || has_overlay(m);
    facts->sends_across = m->across > 0;
    facts->alpha = m->alpha;
}

/* f0 of the non-metal and of the metal, and what the face sends back in all. */
static void lobe_shares(const MetallicView *view, float *nonmetal, float *metal, float *face) {
    const MetallicRoughness *m = view->m;
    Energy e = view->energy;
    *metal = spectrum_mean(m->base_color);
    *nonmetal = spectrum_mean(view->boundary.f0);
    *face = *nonmetal * e.all + (m->specular - *nonmetal) * e.shape;
    if (coated_metal(m))
        *metal = spectrum_mean(coating_at(m->coating->metal->front, m->wavelengths, 1));
    if (!coated_face(m)) return;
    *nonmetal = m->specular * spectrum_mean(coating_at(m->coating->face->front, m->wavelengths, 1));
    *face = spectrum_mean(view->coated);
}

/* A rough coat is left out: it is rare. Where light crosses there are none: lobes are on wo's
 * side, and light from behind would be left to few samples. */
static void model_lobes(const void *parameters, Vec3 wo, BsdfLobes *lobes) {
    const MetallicRoughness *m = parameters;
    if (!(wo.z > 0) || m->across > 0) return;
    MetallicView own;
    const MetallicView *view = metallic_seen(m, wo, &own);
    float base = spectrum_mean(m->base_color), solid = 1 - m->metallic, under = 1 - view->coat;
    float f0, metal, face;
    lobe_shares(view, &f0, &metal, &face);
    lobes->prob = view->choices.diffuse;
    lobes->diffuse = under * solid * (1 - m->transmission) * (1 - face) * base;
    if (has_overlay(m)) { /* it spreads light as widely */
        float left = 1 - overlay_most(&m->overlay) * view->overlay.albedo;
        lobes->prob += view->choices.overlay;
        lobes->diffuse =
            lobes->diffuse * left +
            under * view->overlay.albedo * spectrum_mean(overlay_tint(&m->overlay, m->wavelengths));
    }
    float alpha = is_brushed(m) ? sqrtf(m->alpha_along * m->alpha) : m->alpha;
    if (alpha < WIDE_ALPHA) return;
    lobes->prob += view->choices.mirror;
    lobes->f0 = under * (solid * f0 + m->metallic * metal);
    lobes->f90 = under * (solid * m->specular + m->metallic);
    lobes->alpha = alpha;
}

static Spectrum sent_by(PaneLight pane) {
    return pane.reflected + pane.passed;
}

/* Of a rough one over some facets. */
static Spectrum coated_pane_albedo(const MetallicRoughness *m, const MetallicFace *b, Vec3 wo) {
    if (is_smooth(m->alpha)) return sent_by(facet_pane(m, b, wo.z));
    LobeFacets facets = lobe_facets(&common_facet_table, wo, facet_alphas(m));
    Spectrum sum = spectrum_all(0);
    float all = 1e-6f; /* what they hide is taken as they send the rest */
    for (int i = 0; i < LOBE_FACETS; i++) {
        sum += sent_by(facet_pane(m, b, facet_cosine[i])) * spectrum_all(facets.weight[i]);
        all += facets.weight[i];
    }
    return sum / spectrum_all(all);
}

/* The base's albedo by its shares: opaque, sheet, metal. */
static void albedo_parts(const MetallicRoughness *m, Vec3 wo, Spectrum *solid, Spectrum *clear,
                         Spectrum *metal) {
    Energy e = base_energy(m, wo);
    MetallicFace b = boundary_of(m);
    Spectrum one = spectrum_all(1), in = let_in(&b, e), base = m->base_color;
    if (coated_face(m)) in = one - energy_coated(m, wo);
    if (has_film(m)) {
        MetallicView own;
        const MetallicView *view = metallic_seen(m, wo, &own);
        in = one - view->coated;
    }
    *clear = coated_sheet(m)
                 ? coated_pane_albedo(m, &b, wo)
                 : sent_by(pane_between(one - in, one - in, pane_body(m->tint, wo.z, body_ior(m))));
    *solid = (one - in) + in * base_lambert_albedo(m);
    *metal = base + (one - base) * spectrum_all(e.shape);
    if (coated_metal(m) || has_film(m)) *metal = facet_metal_at(m, wo.z);
}

static Spectrum model_albedo(const void *parameters, Vec3 wo) {
    const MetallicRoughness *m = parameters;
    if (!(wo.z > 0)) return spectrum_all(0);
    Spectrum solid, clear, metal;
    albedo_parts(m, wo, &solid, &clear, &metal);
    Spectrum dielectric = solid + (clear - solid) * spectrum_all(m->transmission);
    Spectrum mixed = dielectric + (metal - dielectric) * spectrum_all(m->metallic);
    if (has_overlay(m)) {
        float own = overlay_albedo(&m->overlay, wo.z);
        mixed = overlay_tint(&m->overlay, m->wavelengths) * spectrum_all(own) +
                mixed * spectrum_all(1 - overlay_most(&m->overlay) * own);
    }
    if (!(m->clearcoat > 0)) return mixed;
    float own = coat_albedo(m, wo) / m->clearcoat;
    float open = coat_mean(m->coat, m->alpha, m->clearcoat_alpha).open;
    Spectrum coated = spectrum_all(own) + mixed * coat_turns(open, mixed) * spectrum_all(1 - own);
    return coat_mixed(m, mixed, coated);
}

/* ---- polarisation ------------------------------------------------------------------------ */

/* Adds the base's facets, met at `cosine`, which send `all` in sum. A metal without n, k is
 * taken for a perfect mirror. */
static void add_facets(const MetallicView *view, float cosine, Spectrum all,
                       PolarisedParts *parts) {
    static const Waves mirror = {1, 1, -1, 0};
    const MetallicRoughness *m = view->m;
    Spectrum nonmetal = facet_of_nonmetal(m, &view->boundary, cosine);
    Spectrum metal = facet_of_metal(m, cosine);
    Spectrum share = all / spectrum_max(nonmetal + metal, spectrum_all(1e-30f));
    const SurfaceCoating *coating = m->coating;
    if (m->metallic > 0 && coating && coating->metal_waves)
        polarised_add_coated(parts, coating->metal_waves, m->wavelengths, min_f(cosine, 1),
                             share * metal);
    else if (m->metallic > 0) polarised_add(parts, mirror, share * metal);
    if (!(m->metallic < 1)) return;
    if (coating && coating->glass_waves && !(m->transmission > 0)) {
        polarised_add_coated(parts, coating->glass_waves, m->wavelengths, min_f(cosine, 1),
                             share * nonmetal);
        return;
    }
    float ior = m->energy->ior;
    Waves face = ior >= 1 ? waves_reflected(min_f(cosine, 1), ior) : mirror;
    PolarisedPane pane = {face, pane_body(m->tint, min_f(cosine, 1), body_ior(m)), false};
    Spectrum opaque = spectrum_all((1 - m->transmission) * (face.s + face.p));
    Spectrum clear = spectrum_all(0), both;
    if (m->transmission > 0)
        clear = pane_between(spectrum_all(face.s), spectrum_all(face.p), pane.through).reflected *
                spectrum_all(2 * m->transmission);
    both = spectrum_max(opaque + clear, spectrum_all(1e-30f));
    polarised_add(parts, face, share * nonmetal * opaque / both);
    if (m->transmission > 0) polarised_add_pane(parts, &pane, share * nonmetal * clear / both);
}

static bool is_near(Vec3 a, Vec3 b) {
    Vec3 apart = vec3_sub(a, b);
    return vec3_dot(apart, apart) < 1e-6f;
}

/* The images that a smooth coat and a smooth base send along this way. */
static void polarise_smooth(const MetallicView *view, Vec3 wi, PolarisedParts *parts) {
    const MetallicRoughness *m = view->m;
    float cosine = vec3_dot(m->clearcoat_normal, view->wo);
    Vec3 by_coat = vec3_sub(vec3_scale(m->clearcoat_normal, 2 * cosine), view->wo);
    Vec3 by_base = vec3(-view->wo.x, -view->wo.y, view->wo.z);
    if (m->clearcoat > 0 && is_smooth(m->clearcoat_alpha) && is_near(by_coat, wi))
        polarised_add(parts, waves_reflected(clampf(cosine, 0, 1), CLEARCOAT_IOR),
                      spectrum_all(m->clearcoat * coat_facet(cosine)));
    if (is_smooth(m->alpha) && is_near(by_base, wi))
        add_facets(view, view->wo.z, eval_smooth(view, wi), parts);
}

static void polarise_rough(const MetallicView *view, Vec3 wi, PolarisedParts *parts) {
    const MetallicRoughness *m = view->m;
    Vec3 half = vec3_normalize(vec3_add(view->wo, wi));
    float pdf, cosine = min_f(fabsf(vec3_dot(view->wo, half)), 1);
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
static bool polarise_through(const MetallicRoughness *m, Vec3 wo, BsdfPolarisation *out) {
    if (!(m->energy->ior >= 1)) return false;
    float cosine = min_f(wo.z, 1);
    PolarisedParts parts = {spectrum_all(0), spectrum_all(0), spectrum_all(0), spectrum_all(0)};
    PolarisedPane pane = {waves_reflected(cosine, m->energy->ior),
                          pane_body(m->tint, cosine, body_ior(m)), true};
    polarised_add_pane(&parts, &pane, spectrum_all(1));
    *out = polarised_of(&parts, spectrum_all(1));
    return true;
}

static bool model_polarise(const void *parameters, Vec3 wo, const BsdfSample *way,
                           BsdfPolarisation *out) {
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

/* ---- the model --------------------------------------------------------------------------- */

const BsdfModel metallic_roughness_model = {
    .scatter = {model_eval, model_sample, model_reaches, model_albedo, model_lobes},
    .boundary = {.mirror = model_mirror, .pass = model_pass},
    .facts = model_facts,
    .set = model_set,
    .part = model_part,
    .polarise = model_polarise,
};
