/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_base.h"

#include "base/mathf.h"
#include "base/units.h"

Spectrum base_lambert_across(const MetallicRoughness *m) {
    return spectrum_from_rgb(m->wavelengths, m->across_color) * spectrum_all(m->across);
}

Spectrum base_lambert_albedo(const MetallicRoughness *m) {
    return m->across > 0 ? lambert_back(m) + base_lambert_across(m) : m->base_color;
}

/* ---- what comes to the Lambert base ------------------------------------------------------ */

/* Share that comes to the Lambert base, sent neither by the overlay nor by facets.
 * reflected: what a coated or filmed face sends back in all, without the overlay. */
static Spectrum enters_below_overlay(const MetallicView *view, Spectrum reflected, Energy e,
                                     OverlayShare share) {
    const MetallicRoughness *m = view->m;
    float most = overlay_most(&m->overlay);
    Spectrum in = let_in(&view->boundary, overlay_passes(&m->overlay, e, share));
    if (coated_face(m) || has_film(m))
        in = spectrum_all(1) - reflected * spectrum_all(1 - most * share.all);
    return spectrum_clamp(in - spectrum_all(most * share.albedo), 0, 1);
}

/* reflected: what a coated or filmed face sends back in all. */
static Spectrum enters_layers(const MetallicView *view, Spectrum reflected, Energy e,
                              const OverlayShare *share) {
    const MetallicRoughness *m = view->m;
    if (has_overlay(m)) return enters_below_overlay(view, reflected, e, *share);
    if (coated_face(m) || has_film(m)) return spectrum_all(1) - reflected;
    return let_in(&view->boundary, e);
}

Spectrum base_enters_layers(const MetallicView *view, Vec3 w, Energy e) {
    const MetallicRoughness *m = view->m;
    OverlayShare share;
    Spectrum reflected = coated_face(m) ? energy_coated(m, w)
                         : has_film(m)  ? energy_filmed(view, w)
                                        : spectrum_all(0);
    if (has_overlay(m)) share = energy_overlay(m, w);
    return enters_layers(view, reflected, e, &share);
}

static Spectrum enters_layers_on_average(const MetallicView *view) {
    const MetallicRoughness *m = view->m;
    Spectrum reflected = coated_face(m) ? energy_coated_average(m) * spectrum_all(m->specular)
                         : has_film(m)  ? energy_filmed_average(view, m->alpha)
                                        : spectrum_all(0);
    return enters_layers(view, reflected, base_average(m), &view->overlay_mean);
}

Spectrum base_lambert_towards(const MetallicView *view) {
    const MetallicRoughness *m = view->m;
    Spectrum share = spectrum_all((1 - m->metallic) * (1 - m->transmission) * INV_PI_F);
    Spectrum in, mean;
    if (has_layers(m)) {
        in = enters_layers(view, view->coated, view->energy, &view->overlay);
        mean = enters_layers_on_average(view);
    } else {
        in = let_in(&view->boundary, view->energy);
        mean = let_in(&view->boundary, base_average(m));
    }
    return in * share / spectrum_max(mean, spectrum_all(1e-3f));
}

/* ---- what facets hide -------------------------------------------------------------------- */

/* Light that one facet hides from the eye meets others and comes out in the end, spread like
 * the missing albedo on both sides (Kulla and Conty 2017): sr^-1, for reflectance 1. out, in:
 * what is missing along wo and wi. */
static float rebound_lobe(float out, float in, float missing) {
    return missing > 1e-6f ? out * in / missing * INV_PI_F : 0;
}

/* Share of the light that gets past the overlay and that facets hide. */
static float hidden_below_overlay(const MetallicRoughness *m, Energy e, OverlayShare share) {
    float sent = overlay_most(&m->overlay) * share.albedo;
    return max_f(1 - sent - overlay_passes(&m->overlay, e, share).all, 0);
}

float base_rebound_lobe(const MetallicView *view, Vec3 wi, Energy in) {
    const MetallicRoughness *m = view->m;
    Energy mean = base_average(m);
    if (!has_overlay(m)) return rebound_lobe(1 - view->energy.all, 1 - in.all, 1 - mean.all);
    return rebound_lobe(hidden_below_overlay(m, view->energy, view->overlay),
                        hidden_below_overlay(m, in, energy_overlay(m, wi)),
                        hidden_below_overlay(m, mean, view->overlay_mean));
}

/* The share of the rebound that a metal leaves. */
static Spectrum base_metal_rebound(const MetallicRoughness *m) {
    float mean = base_average(m).all;
    Spectrum one = spectrum_all(1), f = energy_metal_mean(m);
    return f * f * spectrum_all(mean * m->metallic) / (one - f * spectrum_all(1 - mean));
}

PaneLight base_pane_mean(const MetallicView *view) {
    const MetallicRoughness *m = view->m;
    const MetallicFace *b = &view->boundary;
    Spectrum t = spectrum_pow(m->tint, pane_mean_slant(body_ior(m))), face;
    if (coated_sheet(m)) { /* of either side: they differ by what the coating absorbs */
        PaneMeeting meeting = {coated_sheet(m), m->wavelengths, 1, true, t};
        return pane_coated_mean(&meeting);
    }
    face = has_film(m) ? energy_filmed_average(view, 0)
                       : b->f0 + b->rise * spectrum_all(energy_average(m->energy, 0).shape);
    return pane_between(face, face, t);
}

Spectrum base_rebound(const MetallicView *view, Vec3 wi, Energy in) {
    const MetallicRoughness *m = view->m;
    Spectrum sum = spectrum_all(0);
    float clear = clear_share(m);
    float lobe = base_rebound_lobe(view, wi, in);
    if (!(lobe > 0)) return sum;
    if (m->metallic > 0) sum = base_metal_rebound(m);
    if (clear > 0) sum += base_pane_mean(view).reflected * spectrum_all(clear);
    return sum * spectrum_all(lobe);
}

/* ---- the coat's own lobe ----------------------------------------------------------------- */

float coat_tilt(const MetallicRoughness *m, Vec3 wo, Vec3 wi) {
    float out = vec3_dot(m->clearcoat_normal, wo), in = vec3_dot(m->clearcoat_normal, wi);
    if (!(out > 0 && in > 0 && wo.z > 0 && wi.z > 0)) return 0;
    return (out > wo.z ? 1 : out / wo.z) * (in > wi.z ? 1 : in / wi.z);
}

float coat_eval(const MetallicRoughness *m, Vec3 wo, Vec3 wi, float *pdf) {
    *pdf = 0;
    float tilt = coat_tilt(m, wo, wi);
    if (!(tilt > 0)) return 0;
    Frame frame = frame_from_z(m->clearcoat_normal);
    Vec3 out = frame_to_local(&frame, wo), in = frame_to_local(&frame, wi);
    Vec3 half = vec3_normalize(vec3_add(out, in));
    *pdf = ggx_reflection_pdf(out, half, m->clearcoat_alpha);
    return m->clearcoat * tilt * coat_facet(vec3_dot(out, half)) *
           ggx_reflection(out, in, half, m->clearcoat_alpha);
}

/* ---- the base through the coat ----------------------------------------------------------- */

Spectrum coat_on_facets(Spectrum r, const ThroughCoat *out, const ThroughCoat *in) {
    Spectrum one = spectrum_all(1), product;
    float stays[2], t[2] = {out->open, in->open}, u[2] = {out->share.boost, in->share.boost};
    for (int i = 0; i < 2; i++) {
        float p = u[i] > 0 ? t[i] / u[i] : 1;
        stays[i] = 1 - min_f(p * p, 1);
    }
    product = (one - r * spectrum_all(stays[0])) * (one - r * spectrum_all(stays[1]));
    for (int i = 0; i < SPECTRUM_LANES; i++)
        product[i] = t[0] * t[1] / sqrtf(max_f(product[i], 1e-12f));
    return product;
}

Spectrum coat_on_mirror(Spectrum r, float t) {
    return spectrum_all(t * t) / (spectrum_all(1) - r * spectrum_all(1 - t));
}

CoatOnSheet coat_on_sheet(const MetallicRoughness *m, const ThroughCoat *out,
                          const ThroughCoat *in) {
    float pass = out->open * in->open, boost = out->share.boost * in->share.boost;
    float least = min_f(out->open, in->open);
    if (is_covered(m) || is_smooth(m->alpha)) return (CoatOnSheet){least * least, 1 - least};
    return (CoatOnSheet){pass, boost > pass ? 1 - pass / boost : 0};
}

SheetLight coat_sheet(const MetallicView *view, float cosine, const ThroughCoat *below) {
    const MetallicRoughness *m = view->m;
    CoatOnSheet coat = coat_on_sheet(m, &view->through, below);
    SheetFaces faces = facet_sheet(m, &view->boundary, cosine);
    SheetLight light = sheet_turns(&faces, coat.held);
    Spectrum share = spectrum_all(clear_share(m) * coat.pass);
    return (SheetLight){light.back * share, light.through * share};
}

SheetLight coat_sheet_rebound(const MetallicView *view) {
    const MetallicRoughness *m = view->m;
    float open = view->coat_mean.open;
    PaneLight mean = base_pane_mean(view);
    Spectrum share = spectrum_all(clear_share(m) * open);
    SheetFaces faces = {mean.reflected, mean.reflected, mean.passed};
    SheetLight light = sheet_turns(&faces, 1 - open);
    return (SheetLight){light.back * share, light.through * share};
}

/* What facets of mean reflectance r send out in all turns by what they do in the first, where a
 * coat holds back `held` of it: the sum of r held, which of white facets (coat.h's boost) is all
 * that came to them. */
static Spectrum all_turns(Spectrum r, float held) {
    return spectrum_all(1) / (spectrum_all(1) - r * spectrum_all(clampf(held, 0, 1)));
}

/* Share that both boundaries let into the Lambert base. A tilted coat, of boost `open`, has but
 * one turn. */
static Spectrum let_in_coated(const MetallicView *view, Energy e, const ThroughCoat *t) {
    const MetallicFace *b = &view->boundary;
    bool turns = t->share.boost > t->open && e.all > 0;
    Spectrum sent = b->f0 * spectrum_all(e.all - t->share.all) +
                    b->rise * spectrum_all(e.shape - t->share.shape);
    sent *= all_turns(view->face_mean, turns ? t->share.all / e.all : 0);
    return (spectrum_all(1) - sent) * spectrum_all(t->open);
}

Spectrum coat_diffuse(const MetallicView *view, Spectrum albedo, Energy in,
                      const ThroughCoat *below) {
    const MetallicRoughness *m = view->m;
    const MetallicFace *b = &view->boundary;
    const CoatMean *coat = &view->coat_mean;
    float share = (1 - m->metallic) * (1 - m->transmission);
    if (!(share > 0)) return spectrum_all(0);
    bool turns = m->clearcoat_normal.z >= COAT_UPRIGHT && coat->lobe > 0;
    Spectrum sent = b->f0 * spectrum_all(coat->all) + b->rise * spectrum_all(coat->shape);
    sent *= all_turns(view->face_mean, turns ? 1 - coat->all / coat->lobe : 0);
    Spectrum mean = spectrum_all(coat->open) - sent;
    return albedo * coat_turns(coat->open, base_lambert_albedo(m)) *
           let_in_coated(view, view->energy, &view->through) * let_in_coated(view, in, below) *
           spectrum_all(share * INV_PI_F) / spectrum_max(mean, spectrum_all(1e-3f));
}

float coat_rebound_lobe(const MetallicView *view, Energy in) {
    return rebound_lobe(1 - view->energy.all, 1 - in.all,
                        view->coat_mean.open - view->coat_mean.lobe);
}

/* What a rebound of that lobe sends back on the eye's side, below the coat. */
static Spectrum rebound_back(const MetallicView *view, float lobe) {
    const MetallicRoughness *m = view->m;
    Spectrum sum = spectrum_all(0);
    if (lobe == 0) return sum;
    if (m->metallic > 0)
        sum = base_metal_rebound(m) * coat_turns(view->coat_mean.open, energy_metal_mean(m)) *
              spectrum_all(lobe);
    if (clear_share(m) > 0) sum += coat_sheet_rebound(view).back * spectrum_all(lobe);
    return sum;
}

Spectrum coat_rebound(const MetallicView *view, Energy in, const ThroughCoat *below) {
    return rebound_back(view, coat_rebound_lobe(view, in)) *
           spectrum_all(view->through.open * below->open);
}

/* ---- over brushed, filmed, coated and woven bases ---------------------------------------- */

/* Share that the overlay sends out of the light that the coat let in along w. */
static float open_overlay(const MetallicRoughness *m, float cosine) {
    if (!has_overlay(m)) return 0;
    return overlay_most(&m->overlay) * overlay_albedo(&m->overlay, cosine) *
           overlay_open(&m->overlay, cosine, m->clearcoat_alpha);
}

static Spectrum face_at(const MetallicView *view, float cosine) {
    const MetallicRoughness *m = view->m;
    if (coated_face(m))
        return coating_at(m->coating->face->front, m->wavelengths, cosine) *
               spectrum_all(m->specular);
    return facet_reflectance(m, &view->boundary, cosine);
}

CoveredRest covered_rest(const MetallicView *view, Vec3 w) {
    const MetallicRoughness *m = view->m;
    const CoveredBase *covered = &view->covered;
    float open = coat_open(m, w), kept = energy_kept(m, w.z);
    float above = 1 - open_overlay(m, w.z);
    Spectrum face;
    if (is_smooth(m->alpha)) {
        face = face_at(view, w.z) * spectrum_all(open * kept);
        return (CoveredRest){(spectrum_all(above) - face) * spectrum_all(open),
                             open * (above - kept)};
    }
    CoveredLobe lobe = covered_lobe(&covered->cover, w);
    face = energy_of_lobe(covered->face, &lobe.facets);
    return (CoveredRest){spectrum_max(spectrum_all(above) - face, spectrum_all(0)) *
                             spectrum_all(open),
                         open * (above - kept) + lobe.lost};
}

static void set_cover(const MetallicRoughness *m, Cover *cover) {
    cover->normal = m->clearcoat_normal;
    cover->has_overlay = has_overlay(m);
    cover->alpha = is_smooth(m->alpha) ? (Vec2){SMOOTH_ALPHA, SMOOTH_ALPHA} : facet_alphas(m);
    for (int i = 0; i < ENERGY_COSINES; i++) {
        float cosine = energy_cosine_of_node(i);
        cover->open[i] = 1 - coat_reflectance(m->clearcoat_energy, cosine, m->clearcoat_alpha);
        if (cover->has_overlay) cover->kept[i] = energy_kept(m, cosine);
    }
}

/* Over the hemisphere, weighted by the cosine, by the trapezoid rule: what the overlay takes
 * of the light that the coat let in, and what it sends out through that. */
static void mean_of_overlay(const MetallicRoughness *m, const Cover *cover, float *taken,
                            float *sent) {
    *taken = *sent = 0;
    if (!has_overlay(m)) return;
    for (int i = 0; i < ENERGY_COSINES; i++) {
        float root = (float)i / (ENERGY_COSINES - 1);
        float open = 4 * root * root * root * cover->open[i] / (ENERGY_COSINES - 1);
        if (i == ENERGY_COSINES - 1) open *= 0.5f;
        *taken += open * (1 - cover->kept[i]);
        *sent += open * open_overlay(m, energy_cosine_of_node(i));
    }
}

void covered_set(MetallicView *view) {
    const MetallicRoughness *m = view->m;
    CoveredBase *covered = &view->covered;
    float taken, sent;
    set_cover(m, &covered->cover);
    mean_of_overlay(m, &covered->cover, &taken, &sent);
    for (int i = 0; i < LOBE_FACETS; i++)
        covered->face[i] = m->metallic < 1 ? face_at(view, facet_cosine[i]) : spectrum_all(0);
    CoveredLobe mean = covered_mean(&covered->cover);
    covered->mean.base = spectrum_max(spectrum_all(view->coat_mean.open - sent) -
                                          energy_of_lobe(covered->face, &mean.facets),
                                      spectrum_all(1e-3f));
    covered->mean.metal = taken - sent + (is_smooth(m->alpha) ? 0 : mean.lost);
    covered->rest = covered_rest(view, view->wo);
}

Spectrum covered_lambert(const MetallicView *view, Spectrum albedo, const CoveredRest *in) {
    const MetallicRoughness *m = view->m;
    float share = (1 - m->metallic) * (1 - m->transmission);
    return albedo * coat_turns(view->coat_mean.open, base_lambert_albedo(m)) *
           view->covered.rest.base * in->base * spectrum_all(share * INV_PI_F) /
           view->covered.mean.base;
}

float covered_rebound_lobe(const MetallicView *view, const CoveredRest *in) {
    const CoveredBase *c = &view->covered;
    return rebound_lobe(c->rest.metal, in->metal, c->mean.metal);
}

Spectrum covered_rebound(const MetallicView *view, const CoveredRest *in) {
    return rebound_back(view, covered_rebound_lobe(view, in));
}
