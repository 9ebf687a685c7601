/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_base.h -- light that is spread by metallic_roughness, where no coat lies and through
 * the lacquer over it.
 *
 * The Lambert base under its boundary, back and across to the other side, and the rebound: what
 * a metal's or a sheet's facets send to one another before it comes out. The coat's own lobe,
 * and the base's parts for light that goes in and out through it, turns between both summed up
 * (facets/coat.h); `covered`: over brushed, filmed, coated and woven bases, which those tables
 * do not know: integrated where they are met (covered_lobe.h). Values are sr^-1 or shares of
 * light; means over the hemisphere are shares.
 *
 * Sources  Kelemen and Szirmay-Kalos 2001 (the coupling), Kulla and Conty 2017 (the rebound).
 * Threads  covered_set fills its own view; else pure functions.  Fails  never.
 */
#pragma once
#include "shaders/metallic/metallic_energy.h"
#include "shaders/metallic/metallic_facet.h"

/* Albedo of what leaves on the other side. */
Spectrum base_lambert_across(const MetallicRoughness *m);

/* Albedo of both sides together. */
Spectrum base_lambert_albedo(const MetallicRoughness *m);

/* Share of the light along w that comes to the Lambert base below film, coating or overlay. */
Spectrum base_enters_layers(const MetallicView *view, Vec3 w, Energy e);

/* The factor of base_diffuse that depends on wo. */
Spectrum base_lambert_towards(const MetallicView *view);

/* The rebound's share along wi, for reflectance 1. */
float base_rebound_lobe(const MetallicView *view, Vec3 wi, Energy in);

/* What a sheet reflects and lets through on average: its shares of the rebound on the eye's
 * side and on the other one. */
PaneLight base_pane_mean(const MetallicView *view);

/* The rebound of metals and sheets on the eye's side. */
Spectrum base_rebound(const MetallicView *view, Vec3 wi, Energy in);

static inline Spectrum lambert_back(const MetallicRoughness *m) {
    return m->across > 0 ? m->base_color * spectrum_all(1 - m->across) : m->base_color;
}

static inline bool has_lambert(const MetallicRoughness *m) {
    return (1 - m->metallic) * (1 - m->transmission) > 0;
}

/* Only metals and sheets have one: the non-metal's is in the Lambert base. */
static inline bool has_rebound(const MetallicRoughness *m) {
    return m->metallic > 0 || m->transmission > 0;
}

/* Is the boundary over the Lambert base more than a bare one? */
static inline bool has_layers(const MetallicRoughness *m) {
    return m->coating || has_film(m) || has_overlay(m);
}

/* Share of the light from w that comes to the Lambert base where no coat lies; e: of facets. */
static inline Spectrum enters(const MetallicView *view, Vec3 w, Energy e) {
    return has_layers(view->m) ? base_enters_layers(view, w, e) : let_in(&view->boundary, e);
}

/* Lambert under boundary and overlay: albedo / pi * in(wo) in(wi) / mean of in (Kelemen
 * 2001). */
static inline Spectrum base_diffuse(const MetallicView *view, Spectrum albedo, Vec3 wi, Energy in) {
    if (!has_lambert(view->m)) return spectrum_all(0);
    return albedo * view->lambert * enters(view, wi, in);
}

/* ---- the coat ---------------------------------------------------------------------------- */

#define COAT_UPRIGHT 0.9999f /* z of a coat's normal that is not tilted */

/* The effect of both sides' coats on a sheet's light along two directions: share that gets in
 * and out, and share of what the sheet sends that they hold back each time. A clear sheet then
 * sends pass / (1 - held), as much as a white metal's lobe under that coat: the boosts'
 * product (coat.h), or, for smooth sheets and beyond its tables, the lesser share. */
typedef struct CoatOnSheet {
    float pass, held;
} CoatOnSheet;

/* With a tilted normal the coat's own cosines differ from the surface's: dividing by the larger
 * of each pair keeps it reciprocal and below its untilted albedo. */
float coat_tilt(const MetallicRoughness *m, Vec3 wo, Vec3 wi);

/* Rough coat: *pdf of choosing wi by it. */
float coat_eval(const MetallicRoughness *m, Vec3 wo, Vec3 wi, float *pdf);

/* Factor for light in and out along these, t t / sqrt of both 1 - r (1 - p), where p = (t /
 * u)^2 is the share that a lobe's light gets out with each time and r what facets reflect in
 * the mean, of metal or non-metal. */
Spectrum coat_on_facets(Spectrum r, const ThroughCoat *out, const ThroughCoat *in);

/* A mirror of reflectance r under a coat that lets pass t: t t (1 + r (1 - t) + ...). A rough
 * lobe has the lesser t of its two directions: so it never sends out more than came in along
 * either. */
Spectrum coat_on_mirror(Spectrum r, float t);

CoatOnSheet coat_on_sheet(const MetallicRoughness *m, const ThroughCoat *out,
                          const ThroughCoat *in);

/* Light along these two that a facet of the sheet's share sends through the coats. */
SheetLight coat_sheet(const MetallicView *view, float cosine, const ThroughCoat *below);

/* Light that the sheet's facets hide, turns between the coats in it: share of the rebound's
 * lobe on either side. */
SheetLight coat_sheet_rebound(const MetallicView *view);

/* The Lambert base through it; albedo: of one side. */
Spectrum coat_diffuse(const MetallicView *view, Spectrum albedo, Energy in,
                      const ThroughCoat *below);

/* The rebound's lobe, sr^-1, of the light that the coat let in along both. */
float coat_rebound_lobe(const MetallicView *view, Energy in);

/* All of the rebound on the eye's side. */
Spectrum coat_rebound(const MetallicView *view, Energy in, const ThroughCoat *below);

/* The light along w that the covered lobe leaves. */
CoveredRest covered_rest(const MetallicView *view, Vec3 w);

/* Sets the view's `covered`, once its coat is known. */
void covered_set(MetallicView *view);

/* The Lambert base, the rebound's lobe and all of the rebound, as above; in: of wi. */
Spectrum covered_lambert(const MetallicView *view, Spectrum albedo, const CoveredRest *in);
float covered_rebound_lobe(const MetallicView *view, const CoveredRest *in);
Spectrum covered_rebound(const MetallicView *view, const CoveredRest *in);

static inline float coat_cosine(const MetallicRoughness *m, Vec3 w) {
    return fabsf(vec3_dot(m->clearcoat_normal, w));
}

/* Is there a coat over a base that coat.h's tables do not cover? */
static inline bool is_covered(const MetallicRoughness *m) {
    return m->clearcoat > 0 && (is_brushed(m) || has_film(m) || has_overlay(m) || coated_face(m));
}

/* Is there a sheet that a coat lies on? On both of its sides alike. */
static inline bool has_sheet_under_coat(const MetallicRoughness *m) {
    return m->clearcoat > 0 && clear_share(m) > 0;
}

/* Bare and coated, by the coat's share. */
static inline Spectrum coat_mixed(const MetallicRoughness *m, Spectrum bare, Spectrum coated) {
    return bare + (coated - bare) * spectrum_all(m->clearcoat);
}

/* The coat's albedo for a direction, times its share. */
static inline float coat_albedo(const MetallicRoughness *m, Vec3 w) {
    if (!(m->clearcoat > 0)) return 0;
    return m->clearcoat *
           coat_reflectance(m->clearcoat_energy, coat_cosine(m, w), m->clearcoat_alpha);
}

static inline float coat_open(const MetallicRoughness *m, Vec3 w) {
    return 1 - coat_reflectance(m->clearcoat_energy, coat_cosine(m, w), m->clearcoat_alpha);
}

static inline float coat_facet(float cosine) {
    return fresnel_unpolarised(cosine, CLEARCOAT_IOR);
}

/* A tilted coat's turns are left out: the table knows no tilt. */
static inline ThroughCoat coat_through(const MetallicRoughness *m, Vec3 w) {
    float cosine = coat_cosine(m, w);
    ThroughCoat t;
    t.open = 1 - coat_reflectance(m->clearcoat_energy, cosine, m->clearcoat_alpha);
    t.share = coat_share(m->coat, cosine, m->alpha, m->clearcoat_alpha);
    if (m->clearcoat_normal.z < COAT_UPRIGHT) t.share.boost = t.open;
    return t;
}
