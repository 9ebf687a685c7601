/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_eval.h"

#include "base/mathf.h"
#include "base/units.h"

/* The lobe of a sheet's facets, turned over to the other side, and the cosine to them. */
typedef struct SheetLobe {
    float value, cosine;
} SheetLobe;

/* ---- the overlay ------------------------------------------------------------------------ */

/* The light of both directions that a facet beneath the overlay keeps. */
static Spectrum below_overlay(const MetallicView *view, Vec3 wi, Spectrum below) {
    const MetallicRoughness *m = view->m;
    if (!has_overlay(m)) return below;
    float most = overlay_most(&m->overlay), in = overlay_albedo(&m->overlay, fabsf(wi.z));
    return below * spectrum_all(1 - most * max_f(view->overlay.albedo, in));
}

/* Its lobe from wi towards the eye. */
static Spectrum eval_overlay(const MetallicView *view, Vec3 wi) {
    const MetallicRoughness *m = view->m;
    return overlay_tint(&m->overlay, m->wavelengths) *
           spectrum_all(overlay_lobe(&m->overlay, view->wo, wi));
}

/* ---- back ------------------------------------------------------------------------------- */

/* A facet of the base met at `cosine`, as the light of both directions finds it: below NULL: no
 * coat lies on it. */
static Spectrum facet_below(const MetallicView *view, float cosine, const ThroughCoat *below) {
    const MetallicRoughness *m = view->m;
    Spectrum nonmetal = facet_of_nonmetal(m, &view->boundary, cosine);
    Spectrum metal = facet_of_metal(m, cosine);
    if (!below) return nonmetal + metal;
    if (m->metallic > 0)
        metal *= is_covered(m)
                     ? coat_on_mirror(energy_metal_mean(m), min_f(view->through.open, below->open))
                     : coat_on_facets(energy_metal_mean(m), &view->through, below);
    if (has_sheet_under_coat(m)) {
        SheetFaces faces = facet_sheet(m, &view->boundary, cosine);
        nonmetal -= faces.front * spectrum_all(clear_share(m));
        nonmetal = spectrum_max(nonmetal, spectrum_all(0));
        metal += coat_sheet(view, cosine, below).back;
    }
    nonmetal *= is_covered(m) || !(m->metallic < 1)
                    ? spectrum_all(view->through.open * below->open)
                    : coat_on_facets(view->face_mean, &view->through, below);
    return nonmetal + metal;
}

Spectrum eval_facets(const MetallicView *view, Vec3 wi, const ThroughCoat *below) {
    const MetallicRoughness *m = view->m;
    Vec3 half = vec3_normalize(vec3_add(view->wo, wi));
    Spectrum facet = facet_below(view, vec3_dot(view->wo, half), NULL);
    if (m->clearcoat > 0)
        facet = coat_mixed(m, facet, facet_below(view, vec3_dot(view->wo, half), below));
    return below_overlay(view, wi, facet) * spectrum_all(base_lobe(m, view->wo, wi, half));
}

Spectrum eval_smooth(const MetallicView *view, Vec3 wi) {
    Spectrum bare = facet_below(view, wi.z, NULL);
    if (!(view->m->clearcoat > 0)) return below_overlay(view, wi, bare);
    ThroughCoat below = coat_through(view->m, wi);
    return below_overlay(view, wi, coat_mixed(view->m, bare, facet_below(view, wi.z, &below)));
}

/* Lambert, rebound and overlay under a coat. */
static Spectrum covered_above(const MetallicView *view, Vec3 wi) {
    const MetallicRoughness *m = view->m;
    CoveredRest in = covered_rest(view, wi);
    Spectrum sum = covered_lambert(view, lambert_back(m), &in) + covered_rebound(view, &in);
    if (has_overlay(m))
        sum += eval_overlay(view, wi) * spectrum_all(view->through.open * coat_open(m, wi));
    return sum;
}

/* All but facets. below: of wi; undefined without a coat. */
static Spectrum spread_by_base(const MetallicView *view, Vec3 wi, Energy in,
                               const ThroughCoat *below) {
    const MetallicRoughness *m = view->m;
    Spectrum lambert = lambert_back(m);
    Spectrum sum = base_diffuse(view, lambert, wi, in);
    if (has_rebound(m)) sum += base_rebound(view, wi, in);
    if (has_overlay(m)) sum += eval_overlay(view, wi);
    if (!(m->clearcoat > 0)) return sum;
    if (is_covered(m)) return coat_mixed(m, sum, covered_above(view, wi));
    return coat_mixed(m, sum,
                      coat_diffuse(view, lambert, in, below) + coat_rebound(view, in, below));
}

/* The base seen from above: rough mirror, Lambert, rebound; and its part of the pdf. */
static Spectrum base_above(const MetallicView *view, Vec3 wi, float *pdf) {
    const MetallicRoughness *m = view->m;
    ThroughCoat below;
    Energy in = base_energy(m, wi);
    *pdf = view->choices.diffuse * wi.z * INV_PI_F;
    if (m->clearcoat > 0) below = coat_through(m, wi);
    if (has_overlay(m)) *pdf += view->choices.overlay * (0.5f * INV_PI_F);
    Spectrum sum = spread_by_base(view, wi, in, &below);
    if (!is_smooth(m->alpha)) {
        Vec3 half = vec3_normalize(vec3_add(view->wo, wi));
        sum += eval_facets(view, wi, &below);
        *pdf += view->choices.mirror * base_lobe_pdf(m, view->wo, half);
    }
    return sum;
}

/* ---- to the other side ------------------------------------------------------------------- */

/* The rebound of a sheet across, below the coats of both sides, from below. */
static Spectrum rebound_below_coat(const MetallicView *view, Vec3 wi, Energy in,
                                   const ThroughCoat *below) {
    const MetallicRoughness *m = view->m;
    float lobe;
    if (is_covered(m)) {
        bool is_tilted = m->clearcoat_normal.z < COAT_UPRIGHT; /* as seen from that side */
        Vec3 up = is_tilted ? vec3_neg(wi) : vec3(wi.x, wi.y, -wi.z);
        CoveredRest rest = covered_rest(view, up);
        lobe = covered_rebound_lobe(view, &rest);
    } else {
        lobe = coat_rebound_lobe(view, in) * view->through.open * below->open;
    }
    return lobe > 0 ? coat_sheet_rebound(view).through * spectrum_all(lobe) : spectrum_all(0);
}

/* Light through a coated sheet, but for what a smooth one passes straight on. bare: the same
 * where no coat lies. lobe: of its facets; cosine: at which they are met. */
static Spectrum below_coat(const MetallicView *view, Vec3 wi, Energy in, Spectrum bare,
                           const SheetLobe *lobe) {
    const MetallicRoughness *m = view->m;
    ThroughCoat below = coat_through(m, wi);
    Spectrum sum = rebound_below_coat(view, wi, in, &below);
    if (lobe->value > 0)
        sum += below_overlay(view, wi, coat_sheet(view, lobe->cosine, &below).through) *
               spectrum_all(lobe->value);
    return coat_mixed(m, bare, sum);
}

/* A rough sheet sends on what a mirror would send back, turned over to the other side, and its
 * part of the rebound. */
static Spectrum base_below(const MetallicView *view, Vec3 wi, float *pdf) {
    const MetallicRoughness *m = view->m;
    *pdf = 0;
    if (!sends_below(m)) return spectrum_all(0);
    Vec3 up = vec3(wi.x, wi.y, -wi.z);
    Energy in = base_energy(m, up);
    SheetLobe none = {0, 0};
    if (is_smooth(m->alpha)) return below_coat(view, wi, in, spectrum_all(0), &none);
    Vec3 half = vec3_normalize(vec3_add(view->wo, up));
    float all = view->energy.all, pdf_lobe = base_lobe_pdf(m, view->wo, half);
    *pdf = view->choices.through * (all * pdf_lobe + (1 - all) * up.z * INV_PI_F);
    SheetLobe lobe = {base_lobe(m, view->wo, up, half), vec3_dot(view->wo, half)};
    Spectrum straight = facet_through(m, &view->boundary, lobe.cosine);
    Spectrum spread = base_pane_mean(view).passed * spectrum_all(clear_share(m));
    Spectrum bare = below_overlay(view, up, straight) * spectrum_all(lobe.value) +
                    spread * spectrum_all(base_rebound_lobe(view, up, in));
    return m->clearcoat > 0 ? below_coat(view, wi, in, bare, &lobe) : bare;
}

/* Lambert's light from the other side. */
static Spectrum base_across(const MetallicView *view, Vec3 wi) {
    const MetallicRoughness *m = view->m;
    Vec3 up = vec3(wi.x, wi.y, -wi.z);
    Energy in = base_energy(m, up);
    Spectrum lambert = base_lambert_across(m);
    Spectrum sum = base_diffuse(view, lambert, up, in);
    if (!(m->clearcoat > 0)) return sum;
    if (is_covered(m)) {
        CoveredRest rest = covered_rest(view, up);
        return coat_mixed(m, sum, covered_lambert(view, lambert, &rest));
    }
    ThroughCoat below = coat_through(m, up);
    return coat_mixed(m, sum, coat_diffuse(view, lambert, in, &below));
}

/* ---- both -------------------------------------------------------------------------------- */

Spectrum eval_all(const MetallicView *view, Vec3 wi, float *pdf) {
    const MetallicRoughness *m = view->m;
    Spectrum f = wi.z > 0 ? base_above(view, wi, pdf) : base_below(view, wi, pdf);
    if (view->choices.across > 0 && wi.z < 0) *pdf += view->choices.across * -wi.z * INV_PI_F;
    if (m->across > 0 && wi.z < 0) f += base_across(view, wi);
    if (m->clearcoat > 0 && !is_smooth(m->clearcoat_alpha)) {
        float coat_pdf;
        f += spectrum_all(coat_eval(m, view->wo, wi, &coat_pdf));
        *pdf += view->choices.coat * coat_pdf;
    }
    return f;
}

/* ---- how often each part is sampled ----------------------------------------------------- */

/* Probabilities follow the lanes' mean albedo of each part, so that none is ever starved. */
static MetallicChoices scaled_to_one(MetallicChoices c) {
    float sum = c.coat + c.mirror + c.diffuse + c.through + c.across + c.overlay;
    float scale = sum > 0 ? 1 / sum : 0;
    return (MetallicChoices){c.coat * scale,    c.mirror * scale, c.diffuse * scale,
                             c.through * scale, c.across * scale, c.overlay * scale};
}

static MetallicChoices beside_overlay(const MetallicView *view, MetallicChoices c) {
    const MetallicRoughness *m = view->m;
    float left = 1 - overlay_most(&m->overlay) * view->overlay.albedo;
    return (MetallicChoices){.coat = c.coat,
                             .mirror = c.mirror * left,
                             .diffuse = c.diffuse * left,
                             .through = c.through * left,
                             .across = c.across * left,
                             .overlay = (1 - c.coat) * view->overlay.albedo *
                                        spectrum_mean(overlay_tint(&m->overlay, m->wavelengths))};
}

/* Mean shares of light for choosing, where a part is coated. */
static MetallicChoices choose_coated(const MetallicView *view, float coat) {
    const MetallicRoughness *m = view->m;
    float z = view->wo.z, lost = 1 - view->energy.all, under = 1 - coat;
    float clear = (1 - m->metallic) * m->transmission, solid = 1 - m->metallic - clear;
    float base = spectrum_mean(lambert_back(m));
    float facets = spectrum_mean(facet_of_nonmetal(m, &view->boundary, z));
    float metal = m->metallic > 0 ? spectrum_mean(facet_of_metal(m, z)) : 0;
    float through = clear > 0 ? spectrum_mean(facet_through(m, &view->boundary, z)) : 0;
    float face = coated_face(m) || has_film(m)
                     ? spectrum_mean(view->coated)
                     : spectrum_mean(spectrum_all(1) - let_in(&view->boundary, view->energy));
    return (MetallicChoices){
        .coat = coat,
        .mirror = under * (facets + metal),
        .diffuse = under * (base * solid * (1 - face) + lost * (metal * metal + facets * clear)),
        .through = under * through,
        .across =
            m->across > 0 ? under * solid * (1 - face) * spectrum_mean(base_lambert_across(m)) : 0};
}

static MetallicChoices choose_bare(const MetallicView *view) {
    const MetallicRoughness *m = view->m;
    Energy e = view->energy;
    if (m->coating || has_film(m)) {
        float above = vec3_dot(m->clearcoat_normal, view->wo);
        return choose_coated(view, above > 0 ? view->coat : 0);
    }
    float base = spectrum_mean(m->base_color);
    float f0 = spectrum_mean(view->boundary.f0);
    float face = f0 * e.all + (m->specular - f0) * e.shape;
    float tint = spectrum_mean(m->tint), in = 1 - face, seen = face * tint;
    float once = in * in * tint / max_f(1 - seen * seen, 1e-6f); /* through, about */
    float sheet = face + once * seen;
    float metal = base * e.all + (1 - base) * e.shape;
    float clear = (1 - m->metallic) * m->transmission, solid = 1 - m->metallic - clear;
    float coat = vec3_dot(m->clearcoat_normal, view->wo) > 0 ? view->coat : 0;
    float under = 1 - coat;
    MetallicChoices c = {
        .coat = coat,
        .mirror = under * (solid * face + clear * sheet + m->metallic * metal),
        .diffuse = under * (base * (solid * (1 - m->across) * (1 - face) +
                                    m->metallic * base * (1 - e.all)) +
                            clear * sheet * (1 - e.all)),
        .through = under * clear * once,
        .across = 0,
    };
    if (m->across > 0)
        c.across = under * solid * (1 - face) * spectrum_mean(base_lambert_across(m));
    return c;
}

/* A coat holds light back that passes a sheet: part of it is sent back by its turns. What its
 * facets hide, and the overlay sends from below, leaves on both sides. */
static MetallicChoices choose_turns(const MetallicView *view, MetallicChoices c) {
    const MetallicRoughness *m = view->m;
    CoatOnSheet coat = coat_on_sheet(m, &view->through, &view->through);
    SheetFaces faces = facet_sheet(m, &view->boundary, view->wo.z);
    SheetLight turned = sheet_turns(&faces, coat.held), spread = coat_sheet_rebound(view);
    float front = spectrum_mean(faces.front), through = spectrum_mean(faces.through);
    float back = spectrum_mean(turned.back), on = spectrum_mean(turned.through);
    float hidden =
        is_covered(m) ? view->covered.rest.metal : view->through.open * (1 - view->energy.all);
    if (through > 0) { /* the sum of both stays as it was */
        float left = (front + through) * on / ((back + on) * through);
        float moved = c.through * m->clearcoat * max_f(1 - left, 0);
        c.mirror += moved;
        c.through -= moved;
    }
    c.diffuse += m->clearcoat * hidden * spectrum_mean(spread.back);
    if (is_covered(m)) c.across += m->clearcoat * hidden * spectrum_mean(spread.through);
    return c;
}

/* The view's layers must be known. */
static MetallicChoices choose(const MetallicView *view) {
    MetallicChoices choices = choose_bare(view);
    if (has_overlay(view->m)) choices = beside_overlay(view, choices);
    if (has_sheet_under_coat(view->m)) choices = choose_turns(view, choices);
    return scaled_to_one(choices);
}

/* ---- the view --------------------------------------------------------------------------- */

static void set_film(MetallicView *view) {
    view->coated = spectrum_all(0);
    if (!(view->m->metallic < 1)) return;
    for (int i = 0; i < LOBE_FACETS; i++)
        view->film[i] = facet_reflectance(view->m, &view->boundary, facet_cosine[i]);
    view->coated = energy_filmed(view, view->wo);
}

/* The roughness of an even surface whose facets send back as much on average. */
static float even_alpha(const MetallicRoughness *m) {
    if (!is_brushed(m)) return m->alpha;
    float wanted = energy_brushed_average(m).all, low = SMOOTH_ALPHA, high = 1;
    for (int step = 0; step < 12; step++) {
        float middle = 0.5f * (low + high);
        if (energy_average(m->energy, middle).all > wanted) low = middle;
        else high = middle;
    }
    return low;
}

/* Layers that a surface does not have leave their members as they were. */
static void set_layers(MetallicView *view) {
    const MetallicRoughness *m = view->m;
    if (m->clearcoat > 0) {
        view->through = coat_through(m, view->wo);
        view->coat_mean = coat_mean(m->coat, m->alpha, m->clearcoat_alpha);
        if (m->metallic < 1)
            view->face_mean =
                view->boundary.f0 +
                view->boundary.rise * spectrum_all(energy_average(m->energy, 0).shape);
    }
    if (coated_face(m)) view->coated = energy_coated(m, view->wo);
    if (has_film(m)) set_film(view);
}

void metallic_look(MetallicView *view, const MetallicRoughness *m, Vec3 wo) {
    view->m = m;
    view->wo = wo;
    view->boundary = boundary_of(m);
    view->energy = base_energy(m, wo);
    view->coat = coat_albedo(m, wo);
    set_layers(view);
    if (is_covered(m)) covered_set(view);
    if (has_overlay(m)) {
        view->overlay = energy_overlay(m, wo);
        view->overlay_mean = overlay_mean(&m->overlay, even_alpha(m));
    }
    view->choices = choose(view);
    if (has_lambert(m)) view->lambert = base_lambert_towards(view);
}
